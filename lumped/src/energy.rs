//! Distribution of a mode's energy over bodies and springs.

use gearset::Body;
use serde::Serialize;

use crate::model::LumpedModel;
use crate::modes::ModeGroup;
use crate::springs::SpringId;

/// Share of one body or spring in a mode's energy, averaged over a group's modes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct EnergyShare<T> {
    /// Body or spring.
    pub of: T,
    /// Share, 0 to 1.
    pub share: f64,
}

/// `[eq:kinetic-energy-shares]` Kinetic energy of every body: Σ m_i φ_i² over its coordinates (M-normalised, so they
/// sum to one).
///
/// Source: closed form.
/// Checked by: `lumped/tests/derivatives.rs::energies_add_up_to_one`.
pub fn kinetic_energy(model: &LumpedModel, group: &ModeGroup) -> Vec<EnergyShare<Body>> {
    let planets = model.psi.len();
    let mut shares: Vec<_> = Body::all(planets).map(|of| EnergyShare { of, share: 0.0 }).collect();
    for (i, (body, _)) in model.coordinates.free().iter().enumerate() {
        let squared: f64 = (0..group.multiplicity).map(|j| group.vectors[(i, j)].powi(2)).sum();
        shares[body.index()].share += model.mass[i] * squared / group.multiplicity as f64;
    }
    shares
}

/// `[eq:strain-energy-shares]` Strain energy of every spring: k (bᵀφ)²/λ. They sum to one; all zero for rigid-body
/// modes.
///
/// Source: closed form.
/// Checked by: `lumped/tests/derivatives.rs::energies_add_up_to_one`.
pub fn strain_energy(model: &LumpedModel, group: &ModeGroup) -> Vec<EnergyShare<SpringId>> {
    let share = |stretch: f64, stiffness: f64| match group.lambda > 0.0 {
        true => stiffness * stretch / (group.lambda * group.multiplicity as f64),
        false => 0.0,
    };
    model
        .springs
        .iter()
        .map(|s| EnergyShare { of: s.id, share: share(group.squared_stretch(s), s.stiffness) })
        .collect()
}
