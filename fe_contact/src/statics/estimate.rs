//! Memory that the bodies of a scene need, before any of it is allocated.

use gearset::Gear;
use scene::{Fidelity, Scene, SceneKind};

use super::bodies::{fit, geometry, matching, wanted};
use crate::body::kept_teeth;
use crate::element::matrices;
use crate::error::FeError;
use crate::fe_mesh::{Element, Elements, FeGearMesh, Sector};
use crate::material::Elastic;

/// Most memory that the bodies of a scene may need while they are made, bytes: 2 GiB.
///
/// Contact tables of all phases and the factors and modes of all bodies at fidelities `modal` and `full` come on
/// top; 2 GiB of bodies leave room for them on a machine with 16 GiB. With 40 flank elements the bodies of an OH-58
/// set take 1.3 GB.
pub const MOST_BYTES: u64 = 2 << 30;

/// Scene key that sets the size of all elements.
const FLANK_ELEMENTS: &str = "fe_contact.flank_elements";

/// Finest flank that is meshed for an estimate. For finer flanks, elements and nodes are taken to grow
/// from there with the square of the number of flank elements, load nodes in proportion to it.
const FINEST: u32 = 96;

/// Size of one body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyEstimate {
    /// "sun", "planet" or "ring".
    pub name: &'static str,
    /// Elements.
    pub elements: u64,
    /// Generalised nodes.
    pub nodes: u64,
    /// Degrees of freedom.
    pub unknowns: u64,
    /// Memory that the body holds once it is made (mesh, responses of teeth), bytes.
    pub held_bytes: u64,
    /// Further memory while it is made (the condensed sector and the ring of its cuts), and at fidelities `modal` and
    /// `full` while the matrices of the whole gear are (their entries, the matrices, a factor), bytes.
    pub making_bytes: u64,
}

/// Size of all bodies of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct FeEstimate {
    /// Ring, sun and planet, as far as the scene needs them, in the order in which they are made.
    pub bodies: Vec<BodyEstimate>,
    /// Largest memory at any time while the bodies are made, bytes.
    pub peak_bytes: u64,
    /// Memory that the bodies hold once they are made, bytes.
    pub held_bytes: u64,
}

/// Estimates the memory that [`super::Bodies::new`] needs for a scene, from the meshes of single teeth;
/// nothing is assembled or factorised. At fidelities `modal` and `full` it includes the assembly and one factor
/// of the largest whole gear, which are made later. The memory of contact tables, of the carrier and
/// of elastic states comes on top.
///
/// # Errors
/// Those of [`super::Bodies::new`] for scenes without geometry and for settings that give no mesh or no
/// matching depth. Size is no error here.
pub fn estimate(scene: &Scene) -> Result<FeEstimate, FeError> {
    let input = scene.fe_contact;
    let meshed = input.flank_elements.min(FINEST);
    let geometry = geometry(scene)?;
    fit(&input)?;
    let material = Elastic::new(&scene.material, input.plane);
    let [ring, sun] = wanted(scene, &geometry);
    let gears = [("ring", ring), ("sun", sun), ("planet", Some(&geometry.planet))];
    let mut outlines = Vec::new();
    let mut bodies = Vec::new();
    for (name, gear) in gears.into_iter().filter_map(|(name, gear)| Some((name, gear?))) {
        let elements = Elements::of(&input, meshed as usize);
        let (outline, sector) = FeGearMesh::one_tooth(name, gear, elements)?;
        whole(name, &sector, &material, geometry.face_width)?;
        let is_whole = matches!(scene.dynamics.fidelity, Fidelity::Modal(_) | Fidelity::Full);
        bodies.push(sized(name, gear, &sector, &input, is_whole));
        outlines.push(outline);
    }
    matching(&input, geometry.base_pitch, outlines.iter())?;
    Ok(summed(bodies))
}

/// The estimate of a scene that [`super::Bodies::new`] takes.
///
/// # Errors
/// [`FeError::Unfit`] for bodies that would need more than [`MOST_BYTES`], else those of [`estimate`].
pub fn within_memory(scene: &Scene) -> Result<FeEstimate, FeError> {
    let found = estimate(scene)?;
    if found.peak_bytes <= MOST_BYTES {
        return Ok(found);
    }
    let gib = |bytes: u64| bytes as f64 / f64::from(1 << 30);
    Err(FeError::Unfit {
        key: FLANK_ELEMENTS.into(),
        value: scene.fe_contact.flank_elements.to_string(),
        allowed: format!("at most {} for these gears", largest_allowed(scene)),
        why: format!(
            "making the bodies would take about {:.1} GiB of memory, and no more than {:.0} GiB may be taken",
            gib(found.peak_bytes),
            gib(MOST_BYTES)
        ),
    })
}

/// Tooth pairs of a mesh whose contact cells are kept at a position: those in contact and the next on either side.
const PAIRS: u64 = 3;

/// Estimates the memory of the contact cells of a set or pair at so many positions of the mesh cycle, or steps in it,
/// bytes: a matrix of all cells on all cells for every tooth pair. Measured on four planets it is 1.0 times that at
/// rest and 1.0 to 1.4 times in time.
pub fn cycle_bytes(scene: &Scene, positions: usize) -> u64 {
    let meshes = match scene.kind {
        SceneKind::Planetary => 2 * scene.planets.count() as u64,
        SceneKind::GearPair => 1,
    };
    let cells = u64::from(scene.fe_contact.contact_cells);
    let at_one = meshes * PAIRS * 8 * cells * cells;
    at_one.saturating_mul(positions as u64)
}

/// Largest number of flank elements whose bodies fit into [`MOST_BYTES`], by bisection: the memory grows
/// with that number. Numbers too small for a matching depth count as fitting.
fn largest_allowed(scene: &Scene) -> u32 {
    let mut coarser = scene.clone();
    let (mut fits, mut exceeds) = (0, scene.fe_contact.flank_elements);
    while exceeds - fits > 1 {
        let middle = fits + (exceeds - fits) / 2;
        coarser.fe_contact.flank_elements = middle;
        match estimate(&coarser) {
            Ok(found) if found.peak_bytes > MOST_BYTES => exceeds = middle,
            _ => fits = middle,
        }
    }
    fits
}

/// Refuses elements of a tooth that are inside out.
fn whole(
    body: &'static str,
    sector: &Sector,
    material: &Elastic,
    face_width: f64,
) -> Result<(), FeError> {
    for (element, e) in sector.elements.iter().enumerate() {
        let points: Vec<_> = e.nodes[..e.shape.count()].iter().map(|n| sector.points[*n]).collect();
        matrices(&e.shape, &points, material, face_width, false)
            .map_err(|cause| FeError::Distorted { body, element, cause })?;
    }
    Ok(())
}

/// Bytes of one entry of a matrix before entries at the same place are added up: two indices and a
/// value.
const ENTRY: f64 = 24.0;

/// Size of a body with `sector` repeated for every tooth; `is_whole`: with the matrices of the whole gear.
fn sized(
    name: &'static str,
    gear: &Gear,
    sector: &Sector,
    input: &scene::FeContactInput,
    is_whole: bool,
) -> BodyEstimate {
    let teeth = f64::from(gear.teeth);
    // Finer flanks than the meshed one: elements grow in two directions, load nodes in one.
    let finer = (f64::from(input.flank_elements) / f64::from(FINEST)).max(1.0);
    let per_tooth = sector.points.len() as f64 * finer * finer;
    let own = (sector.points.len() - sector.first.len()) as f64 * finer * finer;
    let on_race = (sector.race.len() - 1) as f64 * finer;
    let elements = sector.elements.len() as f64 * teeth * finer * finer;
    let mut load_nodes: Vec<usize> =
        sector.flanks.iter().flatten().flat_map(|stretch| stretch.nodes).collect();
    load_nodes.sort_unstable();
    load_nodes.dedup();
    let columns = 2.0 * load_nodes.len() as f64 * finer;
    let nodes = teeth * own;
    let unknowns = 2.0 * (nodes - teeth * on_race);
    // Responses of the teeth near a loaded one at all nodes, and of all teeth at the load nodes.
    let responses = 8.0 * columns * (kept_teeth(gear.teeth) as f64 * 2.0 * per_tooth);
    let around = 8.0 * columns * columns * teeth;
    let mesh = elements * size_of::<Element>() as f64 + nodes * 18.0 + teeth * per_tooth * 8.0;
    // Lower triangles of the element matrices: all of the stiffness, one direction in two of the mass.
    let entries: f64 = sector
        .elements
        .iter()
        .map(|e| {
            let count = e.shape.count() as f64;
            count * (2.0 * count + 1.0) + count * (count + 1.0)
        })
        .sum();
    let entries = entries * finer * finer * ENTRY * SORTING;
    let factor = |unknowns: f64| FACTOR * unknowns * unknowns.max(2.0).log2();
    let held = responses + around + mesh;
    // One sector: displacements under its loads and its cuts, in the numbering of its unknowns and of
    // its nodes; then the ring: cuts of all sectors, harmonic by harmonic and sector by sector.
    let cut = 2.0 * (sector.first.len() - 1) as f64 * finer;
    let solved = 8.0 * 2.0 * per_tooth * (columns + 4.0 * cut);
    let of_nodes = 8.0 * 2.0 * per_tooth * (columns + 2.0 * cut);
    let ring = 8.0 * cut * columns * teeth;
    let condensing = entries.max(factor(2.0 * per_tooth)) + solved + of_nodes;
    let making = (of_nodes + ring).max(condensing.max(of_nodes + 2.0 * ring) - held);
    let whole = if is_whole { (entries * teeth).max(factor(unknowns)) } else { 0.0 };
    BodyEstimate {
        name,
        elements: elements as u64,
        nodes: nodes as u64,
        unknowns: unknowns as u64,
        held_bytes: held as u64,
        making_bytes: making.max(whole) as u64,
    }
}

/// Memory of entries while they are turned into a matrix, over that of the entries alone.
const SORTING: f64 = 1.7;

/// Memory of matrices and factor in bytes over n log₂ n, n the number of unknowns.
const FACTOR: f64 = 40.0;

/// Bodies are made one after the other: each beside those that are already held.
fn summed(bodies: Vec<BodyEstimate>) -> FeEstimate {
    let (mut held, mut peak) = (0u64, 0u64);
    for body in &bodies {
        held = held.saturating_add(body.held_bytes);
        peak = peak.max(held.saturating_add(body.making_bytes));
    }
    FeEstimate { bodies, peak_bytes: peak, held_bytes: held }
}
