//! Natural frequencies by linearisation about a preload.

use fe_contact::FeError;
use fe_contact::statics::{Bodies, Imperfections};
use fe_contact::vibration::{LinearSet, Loading, NominalRotation, VibratingSet};
use scene::{LoadCase, Scene};

use super::error::ModalError;
use super::kinds::{MotionKinds, type_of};
use super::mode::FeMode;
use crate::table_growth::large_enough;

/// A standing set under torque.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Preload {
    /// Torque; the speed is not used.
    pub load: LoadCase,
    /// Position in the mesh cycle, cycles.
    pub position: f64,
    /// Time step, s.
    pub step_s: f64,
}

/// A standing set at rest under its preload.
///
/// # Errors
/// If the scene cannot be set up, or there is no equilibrium.
pub fn preloaded<'b>(
    scene: &Scene,
    bodies: &'b Bodies,
    preload: &Preload,
) -> Result<VibratingSet<'b>, FeError> {
    let Preload { load, position, step_s } = *preload;
    let (sense, torque_nm) = (load.sense(), load.sun_load_nm());
    let sun = bodies.geometry.sun.as_ref().map_or(1.0, |sun| sun.base_radius);
    let force = (torque_nm / sun / scene.planets.psi_rad.len() as f64).max(1.0);
    let rotation = NominalRotation::Standing { position, step: step_s };
    // Flanks with tip relief touch on a wider patch than the grid that is laid out for their force.
    large_enough(|size| {
        let (none, mesh_force) = (Imperfections::default(), force * f64::powi(2.0, size as i32));
        let loading = Loading { torque_nm, mesh_force };
        let mut set = VibratingSet::new(scene, bodies, sense, none, rotation, loading)?;
        set.rest(torque_nm)?;
        Ok(set)
    })
}

/// Undamped modes of a linearised set with their types; each has the damping ratio of the damped mode nearest
/// in frequency.
///
/// # Errors
/// If an eigenproblem fails.
pub fn linear_modes(set: &VibratingSet<'_>, linear: &LinearSet) -> Result<Vec<FeMode>, ModalError> {
    let (frequencies, shapes) = linear.undamped()?;
    let kinds = MotionKinds::of_races(set.races(), set.masses());
    let races = linear.races;
    let squares: Vec<f64> = frequencies.iter().map(|f| f * f).collect();
    let damped = linear.damped()?;
    let mut modes = Vec::with_capacity(frequencies.len());
    for group in groups(&squares) {
        let list: Vec<Vec<f64>> =
            group.clone().map(|j| (0..races).map(|i| shapes[(i, j)]).collect()).collect();
        let shares = kinds.shares(&list)?;
        for (k, j) in group.enumerate() {
            // Modes of elastic bodies in which no race moves have no shares; their type is mixed.
            let own = shares.get(k).copied().unwrap_or([0.0; 3]);
            let nearest = damped.iter().min_by(|a, b| {
                let off = |m: &&fe_contact::vibration::DampedMode| {
                    (m.frequency_hz - frequencies[j]).abs()
                };
                off(a).total_cmp(&off(b))
            });
            modes.push(FeMode {
                frequency_hz: frequencies[j],
                damping_ratio: nearest.map_or(0.0, |m| m.damping_ratio),
                mode_type: type_of(&own),
                shares: own,
                shape: list[k].clone(),
            });
        }
    }
    Ok(modes)
}

/// Ranges of neighbouring squared frequencies that agree to 1e-7 (relative): equal by symmetry.
fn groups(squares: &[f64]) -> Vec<std::ops::Range<usize>> {
    let mut groups = Vec::new();
    let mut start = 0;
    for i in 1..=squares.len() {
        if i == squares.len() || squares[i] - squares[i - 1] > 1e-7 * squares[i] {
            groups.push(start..i);
            start = i;
        }
    }
    groups
}

/// Sensitivity of one natural frequency to the mesh stiffnesses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshInfluence {
    /// ∂ln f/∂ln k, all mesh stiffnesses scaled by one factor.
    pub all_meshes: f64,
}

/// `[eq:mesh-influence]` ∂ln f/∂ln k_mesh = φᵀ Rᵀ S R φ / 2λ of every mode of a linearised set, in the order of its
/// frequencies.
///
/// Source: closed form.
/// Checked by: no check of its own.
///
/// # Errors
/// If the eigenproblem fails.
pub fn mesh_influence(linear: &LinearSet) -> Result<Vec<MeshInfluence>, ModalError> {
    let (frequencies, shapes) = linear.undamped()?;
    let of = |j: usize| {
        let stretch = &linear.rows * shapes.column(j);
        let energy = stretch.dot(&(&linear.contact * &stretch));
        let lambda = (std::f64::consts::TAU * frequencies[j]).powi(2);
        MeshInfluence { all_meshes: if lambda > 0.0 { 0.5 * energy / lambda } else { 0.0 } }
    };
    Ok((0..frequencies.len()).map(of).collect())
}
