//! A gear pair that hammers under a light torque: one mass on a tooth spring without mass, thrown off and pressed back.
//!
//! A mass m is pressed by a constant force f towards a flank that it touches through the spring k of the teeth; apart
//! from the flank nothing acts but f ([`HammeringPair::place`]).
//!
//! The motion repeats after T_c + T_f for ever, and the energy ½ m v² is constant. Unlike the bouncing bar this problem
//! has the inertia of gears: none at the flank, all of it behind the compliance of the teeth.

use nalgebra::DMatrix;

use crate::benchmark_subjects::{IntegratorError, Obstacle, Scheme, VibratingSystem};

/// The pair, in units in which m = 1, ω = 1 and δ = 1: what remains is v/(ωδ).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HammeringPair {
    /// v/(ωδ), the speed at which the flank is met over that of an oscillation by the static deflection: the largest
    /// force is 1 + √(1 + (v/ωδ)²) times the static one.
    pub landing_speed: f64,
}

/// What a scheme made of a number of bounces.
#[derive(Debug, Clone, PartialEq)]
pub struct Hammering {
    /// At the top of each flight by the closed form: energy over its first value, one per bounce.
    pub energy: Vec<f64>,
    /// Largest difference of the mass's place from the closed form over the first two bounces, as part of the height of
    /// a flight.
    pub place_error: f64,
}

impl HammeringPair {
    /// T_c ω.
    pub fn contact(&self) -> f64 {
        2.0 * (std::f64::consts::PI - self.landing_speed.atan())
    }

    /// T_f ω.
    pub fn flight(&self) -> f64 {
        2.0 * self.landing_speed
    }

    /// From landing to landing, times ω.
    pub fn bounce(&self) -> f64 {
        self.contact() + self.flight()
    }

    /// Height of a flight over δ.
    pub fn height(&self) -> f64 {
        0.5 * self.landing_speed * self.landing_speed
    }

    /// x/δ at a time (times ω) after the top of a flight.
    ///
    /// `[eq:hammering-pair]` With ω = √(k/m), δ = f/k and x towards the flank, 0 where it is just touched:
    /// ```text
    /// contact, 0 ≤ s < T_c: x = δ (1 − cos ωs) + (v/ω) sin ωs,   T_c = (2/ω) (π − arctan(v/(ωδ)));
    /// flight, 0 ≤ s < T_f: x = −v s + ½ (f/m) s²,   T_f = 2 v m/f.
    /// ```
    /// Source: derived here.
    /// Checked by: `dynamics/src/stability/hammering.rs::the_closed_form_obeys_newtons_law`,
    /// `dynamics/tests/bouncing_bar.rs::average_acceleration_keeps_the_energy_of_a_pair_that_hammers`.
    pub fn place(&self, time: f64) -> f64 {
        let v = self.landing_speed;
        let s = (time - 0.5 * self.flight()).rem_euclid(self.bounce());
        match s < self.contact() {
            true => 1.0 - s.cos() + v * s.sin(),
            false => {
                let s = s - self.contact();
                -v * s + 0.5 * s * s
            }
        }
    }

    /// Mass and flank, the coordinate of the flank without mass: m ẍ = f − k (x − y), 0 ≤ λ ⟂ −y ≥ 0.
    ///
    /// # Errors
    /// None for a pair; the system's own checks.
    pub fn system(&self) -> Result<VibratingSystem, IntegratorError> {
        let mass = DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, 0.0]);
        let stiffness = DMatrix::from_row_slice(2, 2, &[1.0, -1.0, -1.0, 1.0]);
        let flank = Obstacle { row: vec![0.0, -1.0], clearance: 0.0 };
        VibratingSystem::new(mass, DMatrix::zeros(2, 2), stiffness, vec![1.0, 0.0])?
            .between(&[flank])
    }

    /// Lets the pair hammer by a scheme, `steps` to a contact.
    ///
    /// # Errors
    /// If the scheme cannot be prepared for a coordinate without mass, or a step fails.
    pub fn hammer(
        &self,
        scheme: &Scheme,
        steps: f64,
        count: usize,
    ) -> Result<Hammering, IntegratorError> {
        let system = self.system()?;
        let integrator = scheme.prepare(&system, self.contact() / steps)?;
        let top = -self.height();
        let mut state = system.start(&[top, top], &[0.0, 0.0])?;
        let first = 0.5 * self.landing_speed * self.landing_speed;
        let mut place_error = 0.0f64;
        let mut energy = Vec::with_capacity(count);
        for bounce in 1..=count {
            while state.time < bounce as f64 * self.bounce() {
                integrator.step(&mut state)?;
                if state.time < 2.0 * self.bounce() {
                    let off = (state.x[0] - self.place(state.time)).abs();
                    place_error = place_error.max(off / self.height());
                }
            }
            energy.push(system.energy(&state) / first);
        }
        Ok(Hammering { energy, place_error })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Newton's law at every time: m ẍ = f − k max(x, 0), and no jump of place or speed.
    #[test]
    fn the_closed_form_obeys_newtons_law() {
        for landing_speed in [0.3, 1.0, 3.0] {
            let pair = HammeringPair { landing_speed };
            let h = 1e-4;
            let x = |t: f64| pair.place(t);
            for i in 0..4000 {
                let t = f64::from(i) * 0.00537;
                let a = (x(t + h) - 2.0 * x(t) + x(t - h)) / (h * h);
                let exact = 1.0 - x(t).max(0.0);
                // Where contact opens in the stencil the third derivative jumps by v.
                assert!((a - exact).abs() < 1e-3, "{landing_speed} {t}: {a} {exact}");
            }
        }
    }
}
