//! Mesh of a whole gear, from the sectors of its teeth.

use gearset::Gear;
use scene::{ElementFamily, FeContactInput, FlankLayer};

use super::outline::{Outline, Side};
use super::quality::Quality;
use super::sector::{Refinement, Sector};
use crate::element::{MOST, Shape, matrices};
use crate::error::FeError;
use crate::material::Elastic;

/// One element of a mesh.
#[derive(Debug, Clone, Copy)]
pub struct Element {
    /// Shape functions.
    pub shape: Shape,
    /// Nodes in the order of the functions.
    pub nodes: [usize; MOST],
    /// Tooth whose sector it belongs to.
    pub tooth: usize,
    /// Index within that sector.
    pub local: usize,
}

/// A tooth, and the function that changes the even refinement into that of the tooth.
pub type RefinedTooth<'r> = (usize, &'r dyn Fn(&Outline, &mut Refinement));

/// Elements of a gear whose teeth are meshed alike.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Elements {
    /// Family.
    pub family: ElementFamily,
    /// Number along a flank, which gives the size of all.
    pub along_flank: usize,
    /// Those next to the flanks.
    pub layer: FlankLayer,
}

impl Elements {
    /// Those of a scene, with another number along a flank.
    pub fn of(input: &FeContactInput, along_flank: usize) -> Self {
        Self { family: input.element, along_flank, layer: input.flank_layer }
    }
}

/// Mesh of a gear. The tooth of sector k has its axis at angle 2πk/Z.
#[derive(Debug, Clone)]
pub struct FeGearMesh {
    /// "sun", "planet" or "ring".
    pub name: &'static str,
    /// Outline of the teeth.
    pub outline: Outline,
    /// Family of the elements.
    pub family: ElementFamily,
    /// Distinct sectors; the first is that of tooth 0.
    pub sectors: Vec<Sector>,
    /// Index of each tooth's sector in `sectors`.
    pub sector_of: Vec<usize>,
    /// Generalised nodes, m.
    pub points: Vec<[f64; 2]>,
    /// Whether a node is a derivative.
    pub is_derivative: Vec<bool>,
    /// Elements, sector by sector.
    pub elements: Vec<Element>,
    /// Node of the mesh for each node of each sector.
    pub nodes: Vec<Vec<usize>>,
    /// Whether a node lies on the race.
    pub on_race: Vec<bool>,
}

impl FeGearMesh {
    /// Exactly periodic mesh of a gear.
    ///
    /// # Errors
    /// If the scene gives no bore or rim, or no fillet radius.
    pub fn new(name: &'static str, gear: &Gear, elements: Elements) -> Result<Self, FeError> {
        let (outline, sector) = Self::one_tooth(name, gear, elements)?;
        let sector_of = vec![0; gear.teeth as usize];
        Ok(Self::assemble(name, outline, elements.family, vec![sector], sector_of))
    }

    /// The mesh of one tooth with its share of the rim, and its outline.
    ///
    /// # Errors
    /// See [`FeGearMesh::new`].
    pub fn one_tooth(
        name: &'static str,
        gear: &Gear,
        elements: Elements,
    ) -> Result<(Outline, Sector), FeError> {
        let (outline, body_radius) = prepare(name, gear)?;
        let mut even = Refinement::even(&outline, body_radius, elements.along_flank);
        even.is_divided = elements.layer == FlankLayer::Divided;
        let sector = Sector::new(&outline, body_radius, &even, elements.family);
        Ok((outline, sector))
    }

    /// Mesh with some teeth refined differently from the others, all with the same rim rows; tooth
    /// 0 must be among them.
    ///
    /// # Errors
    /// See [`FeGearMesh::new`].
    pub fn refined(
        name: &'static str,
        gear: &Gear,
        family: ElementFamily,
        flank_elements: usize,
        teeth: &[RefinedTooth<'_>],
    ) -> Result<Self, FeError> {
        let (outline, body_radius) = prepare(name, gear)?;
        let even = Refinement::even(&outline, body_radius, flank_elements);
        let mut sector_of = vec![teeth.len(); gear.teeth as usize];
        let mut sectors = Vec::new();
        for (which, (tooth, refine)) in teeth.iter().enumerate() {
            let mut fine = even.clone();
            refine(&outline, &mut fine);
            fine.rim.clone_from(&even.rim);
            sectors.push(Sector::new(&outline, body_radius, &fine, family));
            sector_of[tooth % gear.teeth as usize] = which;
        }
        sectors.push(Sector::new(&outline, body_radius, &even, family));
        Ok(Self::assemble(name, outline, family, sectors, sector_of))
    }

    fn assemble(
        name: &'static str,
        outline: Outline,
        family: ElementFamily,
        sectors: Vec<Sector>,
        sector_of: Vec<usize>,
    ) -> Self {
        let teeth = outline.gear().teeth as usize;
        let mut mesh = Self {
            name,
            outline,
            family,
            sectors,
            sector_of,
            points: Vec::new(),
            is_derivative: Vec::new(),
            elements: Vec::new(),
            nodes: vec![Vec::new(); teeth],
            on_race: Vec::new(),
        };
        // Columns run clockwise on external gears, and so do the sectors: each shares its first
        // radial edge with the last of the one before.
        let backwards = mesh.outline.radial_sign() > 0.0;
        let order = |step: usize| match backwards {
            true => (teeth - step) % teeth,
            false => step,
        };
        for step in 0..teeth {
            let tooth = order(step);
            let sector = mesh.sector(tooth).clone();
            let mut ids = vec![usize::MAX; sector.points.len()];
            if step > 0 {
                let before = order(step - 1);
                let last = &mesh.sector(before).last;
                for (own, other) in sector.first.iter().zip(last) {
                    ids[*own] = mesh.nodes[before][*other];
                }
            }
            if step == teeth - 1 {
                let next = order(0);
                for (own, other) in sector.last.iter().zip(&mesh.sector(next).first) {
                    ids[*own] = mesh.nodes[next][*other];
                }
            }
            let angle = mesh.tooth_angle(tooth);
            for (local, id) in ids.iter_mut().enumerate() {
                if *id == usize::MAX {
                    *id = mesh.points.len();
                    mesh.points.push(rotated(sector.points[local], angle));
                    mesh.is_derivative.push(sector.is_derivative[local]);
                    mesh.on_race.push(false);
                }
            }
            for local in &sector.race {
                mesh.on_race[ids[*local]] = true;
            }
            for (local, e) in sector.elements.iter().enumerate() {
                let mut nodes = [0; MOST];
                for (node, own) in nodes.iter_mut().zip(e.nodes).take(e.shape.count()) {
                    *node = ids[own];
                }
                mesh.elements.push(Element { shape: e.shape, nodes, tooth, local });
            }
            mesh.nodes[tooth] = ids;
        }
        mesh
    }

    /// Angle of a tooth's axis, rad.
    pub fn tooth_angle(&self, tooth: usize) -> f64 {
        tooth as f64 * self.outline.gear().pitch_angle()
    }

    /// The sector a tooth is made of.
    pub fn sector(&self, tooth: usize) -> &Sector {
        &self.sectors[self.sector_of[tooth]]
    }

    /// Shape quality over all elements.
    pub fn quality(&self) -> Quality {
        Quality::of(&self.sectors)
    }

    /// Largest distance from the Hermite flank to the involute, m: sampled at 15 inner points of
    /// every stretch, measured across the flank.
    pub fn flank_error(&self) -> f64 {
        let sector = &self.sectors[0];
        let mut worst = 0.0f64;
        for stretch in &sector.flanks[Side::Ccw.index()] {
            let weights = |t: f64| hermite(t, 0.5 * (stretch.to - stretch.from));
            for i in 1..16 {
                let t = -1.0 + 0.125 * f64::from(i);
                let l = stretch.from + 0.5 * (1.0 + t) * (stretch.to - stretch.from);
                let mut at = [0.0; 2];
                for (w, node) in weights(t).iter().zip(stretch.nodes) {
                    for (x, p) in at.iter_mut().zip(sector.points[node]) {
                        *x += w * p;
                    }
                }
                let (p, tangent) = (self.outline.flank_point(l), self.outline.flank_tangent(l));
                let across = (at[0] - p[0]) * tangent[1] - (at[1] - p[1]) * tangent[0];
                worst = worst.max(across.abs());
            }
        }
        worst
    }

    /// Mass (kg) and polar inertia about the gear's centre (kg m²) of the mesh.
    ///
    /// # Errors
    /// If an element is inside out.
    pub fn mass_properties(
        &self,
        material: &Elastic,
        thickness: f64,
    ) -> Result<(f64, f64), FeError> {
        let (mut mass, mut inertia) = (0.0, 0.0);
        for (which, sector) in self.sectors.iter().enumerate() {
            let times = self.sector_of.iter().filter(|w| **w == which).count() as f64;
            for (i, e) in sector.elements.iter().enumerate() {
                let count = e.shape.count();
                let points: Vec<_> = e.nodes[..count].iter().map(|n| sector.points[*n]).collect();
                let m = matrices(&e.shape, &points, material, thickness, false)
                    .map_err(|cause| FeError::Distorted { body: self.name, element: i, cause })?;
                for a in 0..count {
                    for b in 0..count {
                        let share = times * m.mass[(2 * a, 2 * b)];
                        // Translation moves position nodes only; rotation turns every node.
                        let (p, q) = (points[a], points[b]);
                        if !sector.is_derivative[e.nodes[a]] && !sector.is_derivative[e.nodes[b]] {
                            mass += share;
                        }
                        inertia += share * (p[0] * q[0] + p[1] * q[1]);
                    }
                }
            }
        }
        Ok((mass, inertia))
    }
}

/// Hermite weights (value, value, derivative, derivative) at t ∈ [−1, 1] with dℓ/dt = `half`.
pub fn hermite(t: f64, half: f64) -> [f64; 4] {
    let cube = 0.25 * (t * t * t - 3.0 * t);
    [
        0.5 + cube,
        0.5 - cube,
        half * 0.25 * (1.0 - t - t * t + t * t * t),
        half * 0.25 * (-1.0 - t + t * t + t * t * t),
    ]
}

fn prepare(name: &'static str, gear: &Gear) -> Result<(Outline, f64), FeError> {
    let key = format!("geometry.{name}.{}", if name == "ring" { "rim" } else { "bore" });
    let body_radius = gear.body_radius.ok_or(FeError::Missing {
        key: format!("{key}_diameter_mm"),
        why: "it is the rigid race of the finite-element body",
    })?;
    if gear.fillet_radius <= 0.0 {
        return Err(FeError::Unfit {
            key: format!("geometry.{name}.fillet_radius_mm"),
            value: "0".into(),
            allowed: "above 0".into(),
            why: "stresses at a sharp root have no limit; give the root a fillet".into(),
        });
    }
    // Rows of rim elements are as many as this, and would be laid out before anything counts them.
    let pitch = gear.root_radius * gear.pitch_angle();
    let most = MOST_PITCHES.max(f64::from(gear.teeth)) * pitch;
    if (gear.root_radius - body_radius).abs() > most {
        return Err(FeError::Unfit {
            key: format!("{key}_diameter_mm"),
            value: format!("{}", 2e3 * body_radius),
            allowed: format!("within {:.4} of the root circle", 2e3 * most),
            why: format!(
                "a rim thicker than {:.0} tooth pitches has no influence on the teeth that the mesh could show",
                most / pitch
            ),
        });
    }
    Ok((Outline::new(gear), body_radius))
}

/// Thickest rim that is meshed, in tooth pitches at the root circle, or as many as there are teeth: a solid gear.
const MOST_PITCHES: f64 = 100.0;

/// (x, y) turned by an angle.
pub fn rotated([x, y]: [f64; 2], angle: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    [cos * x - sin * y, sin * x + cos * y]
}
