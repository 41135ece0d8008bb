//! The linearised FE/contact set with a rigid carrier against the lumped model with parameters from it.
//!
//! As long as every loaded pair is on the theoretical path, both models press along the same line of action. A mesh
//! then has the one stiffness 1ᵀS1, and the two models must agree to rounding. A pair in corner contact presses along
//! the normal of the flank it touches: its approach is not the mesh's δ, and motions with δ = 0 change it as well.

use fe_contact::statics::{Bodies, Races};
use fe_contact::vibration::LinearSet;
use gearset::Body;
use lumped::{LumpedModel, NaturalModes, SpringId};
use scene::Scene;

use super::error::ModalError;
use super::linear::{Preload, preloaded};
use super::lumped_from_fe::lumped_from_tangents;

/// Differences between the two models over all modes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Agreement {
    /// Largest deviation of an FE/contact frequency from the lumped one, with its sign, percent.
    pub worst_percent: f64,
    /// Frequency with that deviation, Hz.
    pub at_hz: f64,
    /// Largest deviation between 5 and 15 kHz, where mesh stiffness dominates, with its sign, percent.
    pub worst_mesh_ruled_percent: f64,
    /// Largest deviation if all pairs press along the line of action, percent.
    pub along_the_line_percent: f64,
    /// Number of modes compared.
    pub modes: usize,
    /// Number of loaded pairs that do not press along the line of action.
    pub pairs_off_the_line: usize,
}

/// Band in which mesh stiffness dominates, Hz.
const MESH_RULED_HZ: std::ops::RangeInclusive<f64> = 5e3..=15e3;

/// A pair presses along another normal if an entry of its approach row differs by more from the lumped row.
const SAME_ROW: f64 = 1e-9;

/// Compares the two models at one position and preload, with a rigid carrier.
///
/// `[eq:agreement-on-the-path]` n = (sin α, cos α) in the mesh frame of a sun mesh, (sin α, −cos α) in that of a ring
/// mesh, with lever arms of r_b, is the row of every pair on the path in both models.
/// Source: derived here.
/// Checked by: `lumped_from_fe.line_of_action`,
/// `validation/tests/lumped_from_fe.rs::where_all_pairs_press_along_the_line_of_action_the_models_are_one`.
///
/// # Errors
/// If the set has no equilibrium there or an eigenproblem fails.
pub fn agreement(
    scene: &Scene,
    bodies: &Bodies,
    preload: &Preload,
) -> Result<Agreement, ModalError> {
    agreement_after(scene, bodies, preload, |_| {})
}

/// The same after a change of the lumped scene by `spoil`: a negative control, which must not agree.
///
/// # Errors
/// As [`agreement`].
pub fn agreement_after(
    scene: &Scene,
    bodies: &Bodies,
    preload: &Preload,
    spoil: impl Fn(&mut Scene),
) -> Result<Agreement, ModalError> {
    let rigid = with_rigid_carrier(scene);
    let set = preloaded(&rigid, bodies, preload)?;
    let linear = set.linearised()?;
    let mut from_fe = lumped_from_tangents(
        &rigid,
        bodies,
        set.races(),
        &set.reference().pressure_angles(),
        &linear.mesh_tangents,
    )?;
    spoil(&mut from_fe);
    compare(&linear, set.races(), &LumpedModel::from_scene(&from_fe)?)
}

/// The scene with a rigid carrier.
pub fn with_rigid_carrier(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    if let Some(carrier) = scene.geometry.as_mut().and_then(|g| g.carrier.as_mut()) {
        carrier.is_rigid = true;
    }
    scene
}

fn compare(
    linear: &LinearSet,
    races: &Races,
    model: &LumpedModel,
) -> Result<Agreement, ModalError> {
    // Forces that turn with their lines of action are not in the lumped model.
    let mut linear = linear.clone();
    linear.supports -= &linear.turning;
    let linear = &linear;
    let lumped: Vec<f64> = NaturalModes::of(model)?
        .lambda
        .iter()
        .map(|l| l.max(0.0).sqrt() / std::f64::consts::TAU)
        .collect();
    let off = |fe: &[f64], band: &dyn Fn(f64) -> bool| {
        let list = fe.iter().zip(&lumped).filter(|(_, l)| band(**l));
        let percent = list.map(|(fe, l)| (100.0 * (fe / l - 1.0), *fe));
        percent.max_by(|a, b| a.0.abs().total_cmp(&b.0.abs())).unwrap_or((f64::NAN, f64::NAN))
    };
    let (frequencies, _) = linear.undamped()?;
    if frequencies.len() != lumped.len() {
        return Err(ModalError::Incomplete("set with as many coordinates in both models"));
    }
    let straight = along_the_line(linear, races, model);
    let corners = (0..linear.rows.nrows()).filter(|i| {
        let differs = (linear.rows.row(*i) - straight.rows.row(*i)).amax() > SAME_ROW;
        differs && linear.contact.row(*i).amax() > 0.0
    });
    let (put_right, _) = straight.undamped()?;
    let (worst_percent, at_hz) = off(&frequencies, &|_| true);
    Ok(Agreement {
        worst_percent,
        at_hz,
        worst_mesh_ruled_percent: off(&frequencies, &|f| MESH_RULED_HZ.contains(&f)).0,
        along_the_line_percent: off(&put_right, &|_| true).0.abs(),
        modes: lumped.len(),
        pairs_off_the_line: corners.count(),
    })
}

/// The linearised set with the approach of every pair replaced by the lumped model's for its mesh. The mesh
/// of a pair follows from the coordinates in its row: one planet, and the sun or not.
fn along_the_line(linear: &LinearSet, races: &Races, model: &LumpedModel) -> LinearSet {
    let mut straight = linear.clone();
    let sun_moves = races.places(Body::Sun).iter().any(Option::is_some);
    for i in 0..linear.rows.nrows() {
        let moves = |body: Body| {
            races.places(body).into_iter().flatten().any(|k| linear.rows[(i, k)] != 0.0)
        };
        let Some(n) = (0..races.planets()).find(|n| moves(Body::Planet(*n))) else { continue };
        // A central gear that is held in all directions has no coordinate.
        let is_sun_mesh = moves(Body::Sun) || !sun_moves && !moves(Body::Ring);
        let id = if is_sun_mesh { SpringId::SunMesh(n) } else { SpringId::RingMesh(n) };
        if let Some(spring) = model.springs.iter().find(|s| s.id == id) {
            straight.rows.row_mut(i).fill(0.0);
            for (k, b) in &spring.rows[0] {
                straight.rows[(i, *k)] = *b;
            }
        }
    }
    straight
}
