//! What is stated of the error of a natural frequency in closed form, part by part, as shares of the frequency.
//!
//! With the sensitivities s = ∂ln f/∂ln k of the lumped model, and of a mode of unit modal mass
//!
//! ```text
//! meshes      0.03 Σ s_sun + 0.04 Σ s_ring
//! pairs       Σ s |ln k'/k|,   k': with the pair that may or may not touch
//! seats       0.04 · ½ FᵀA F/λ
//! lines       0.1 (F/r) Σ_b n_b τ_b/M_b /(2 λ) + d/p
//! inertia     ½ |change|                                      λ < λ_1 of every gear, else infinite
//! carrier     ½ FᵀA F/(λ_1 − λ)                               λ < λ_1 of the carrier, else infinite
//! ```
//!
//! Lines: forces that turn with their lines of action, corners and flanks that lean. F: mean force of a mesh, r: base
//! radius of the sun, n_b: meshes of one body of kind b, τ_b: share of the kinetic energy of all of this kind, M_b:
//! the least of its mass and I/r²; d: mean deflection of a mesh, p: base pitch.
//!
//! Carrier: under the forces F of the pins its annulus moves by u = AF against its bore. Quasi-static seats have this
//! displacement, and [`AnalyticSet::inertia_change`] what it adds to the modal mass with the rigid motion. Its own is
//! missing:
//!
//! ```text
//! R = uᵀM u ≤ uᵀK u/λ_1 = FᵀA F/λ_1,    δf/f ≤ ½ R/(1 − λ/λ_1)
//! ```
//!
//! with λ_1 of the first mode of the annulus with its bore held (`torsion.rs`), because λ_1 is the least Rayleigh
//! quotient of any displacement that leaves the bore at rest. The denominator is what a displacement in the shape of
//! that mode grows by at the frequency of the set. Rigid seats raise λ_1, which the bound does without.
//!
//! The same of the gears under mesh forces is in the half of the change.

use super::AnalyticSet;
use crate::energy::kinetic_energy;
use crate::modes::ModeGroup;
use crate::sensitivity::{Parameter, sensitivities};
use crate::springs::SpringId;
use gearset::{Axis, Body};

/// What the stiffness of sun meshes and of ring meshes is within, where no pair hands over (`docs/closed_forms.md`).
pub(super) const MESHES: [f64; 2] = [0.03, 0.04];

/// What the flexibility of pin seats is within (`docs/closed_forms.md`).
pub(super) const SEATS: f64 = 0.04;

/// Part of what turning forces do at most that the closed form may leave: planets share the torque evenly in it.
const TURNING: f64 = 0.1;

/// Part of the change by the inertia of elastic displacements that its closed form may leave.
const CHANGE: f64 = 0.5;

/// One part of the stated error of a natural frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StatedError {
    /// The approximation that it is of.
    pub source: &'static str,
    /// Share of the frequency, positive; infinite where there is no bound.
    pub share: f64,
}

impl AnalyticSet {
    /// Stated errors of the frequency of a group of modes of this set beside FE/contact with the inertia of every
    /// body, the frequency being f (1 + [`inertia_change`](Self::inertia_change)). They are to be added as if all had
    /// one sign. Empty for a rigid-body mode.
    pub fn frequency_errors(&self, group: &ModeGroup) -> Vec<StatedError> {
        if group.lambda <= 0.0 {
            return Vec::new();
        }
        let planets = self.model.psi.len();
        let (mut meshes, mut pairs) = (0.0, 0.0);
        for sensitivity in sensitivities(&self.model, group) {
            let (doubt, mesh) = match sensitivity.parameter {
                Parameter::Stiffness(SpringId::SunMesh(n)) => (MESHES[0], n),
                Parameter::Stiffness(SpringId::RingMesh(n)) => (MESHES[1], planets + n),
                _ => continue,
            };
            meshes += doubt * sensitivity.logarithmic;
            pairs += sensitivity.logarithmic * self.hand_overs[mesh].abs();
        }
        let seats = self.seat_strain(group);
        let bodies = [self.bodies.first_gear(), self.bodies.first_carrier()];
        let is_below = bodies.map(|first| group.lambda < first);
        let bounded = |is_bounded: bool, share: f64| if is_bounded { share } else { f64::INFINITY };
        let of_carrier = 0.5 * seats / (bodies[1] - group.lambda);
        let parts = [
            ("mesh stiffness", meshes),
            ("tooth pairs that may or may not touch", pairs),
            ("pin seats", SEATS * 0.5 * seats / group.lambda),
            ("lines of action, corners and flanks under load", self.of_lines(group)),
            (
                "inertia of elastic displacements",
                bounded(is_below[0], CHANGE * self.inertia_change(group).abs()),
            ),
            ("inertia of the carrier between bore and pin seats", bounded(is_below[1], of_carrier)),
        ];
        parts.map(|(source, share)| StatedError { source, share }).to_vec()
    }

    /// λ = ω² of the first mode of any elastic body with its race held, (rad/s)².
    pub fn first_of_bodies(&self) -> f64 {
        self.bodies.first_gear().min(self.bodies.first_carrier())
    }

    /// FᵀA F of a mode of unit modal mass, twice the strain energy of the pin seats, mean over the group, (rad/s)².
    fn seat_strain(&self, group: &ModeGroup) -> f64 {
        let shapes = &group.vectors;
        let energies = shapes.transpose() * &self.seat_stiffness * shapes;
        energies.trace() / group.multiplicity as f64
    }

    /// Lines, corners and flanks.
    fn of_lines(&self, group: &ModeGroup) -> f64 {
        let coordinates = &self.model.coordinates;
        let least = |body: Body| {
            let own = Axis::ALL.into_iter().filter_map(|axis| coordinates.of(body, axis));
            own.map(|i| self.model.mass[i]).fold(f64::INFINITY, f64::min)
        };
        let moved: f64 = kinetic_energy(&self.model, group)
            .iter()
            .map(|energy| {
                let meshes = match energy.of {
                    Body::Carrier => 0.0,
                    Body::Ring | Body::Sun => self.model.psi.len() as f64,
                    Body::Planet(_) => 2.0,
                };
                meshes * energy.share / least(energy.of)
            })
            .sum();
        TURNING * 0.5 * self.turning * moved / group.lambda + self.slope
    }
}
