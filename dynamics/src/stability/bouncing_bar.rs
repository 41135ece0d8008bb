//! An elastic bar that falls on rigid ground and bounces: a contact problem with waves that has a closed-form solution.
//!
//! A bar of length L, density ρ, modulus E (per unit of cross-section), wave speed c = √(E/ρ), falls under gravity g
//! with its lower end at height v₀²/2g. τ = 2L/c is the time of a wave there and back. In landing 1 the lower end,
//! seen from the falling frame, sends d'(s) = v₀ + g s up the bar; the free end returns it; at s = τ the ground would
//! have to pull and lets go; what is left is a saw-tooth wave of velocity g (r − τ/2), which lands in phase after a
//! flight of k whole periods and which landing 2 takes out. The solution holds for v₀ > g τ and whole k = 2v₀/(gτ).
//! The total energy is constant.
//!
//! The problem with L = 10, E = 900, ρ = 1, g = 10, v₀ = 10 (k = 3) is the bouncing bar of Doyen, Ern & Piperno (2011).

use nalgebra::DMatrix;

use crate::benchmark_subjects::{IntegratorError, Obstacle, Scheme, StepState, VibratingSystem};

/// The bar.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BouncingBar {
    /// L, m.
    pub length: f64,
    /// E, N per m² of cross-section.
    pub modulus: f64,
    /// ρ, kg/m³.
    pub density: f64,
    /// g, m/s².
    pub gravity: f64,
    /// v₀, m/s.
    pub landing_speed: f64,
}

/// What a scheme made of a number of bounces.
#[derive(Debug, Clone, PartialEq)]
pub struct Bounces {
    /// At the top of each flight: energy over its first value, one per bounce.
    pub energy: Vec<f64>,
    /// Largest energy seen over the first value.
    pub largest_energy: f64,
    /// Smallest energy seen over the first value.
    pub smallest_energy: f64,
    /// Largest difference of the lower end's place from the closed form over the first two bounces, as part of the
    /// height of fall.
    pub place_error: f64,
}

impl BouncingBar {
    /// The bar of Doyen, Ern & Piperno (2011).
    pub const PUBLISHED: Self =
        Self { length: 10.0, modulus: 900.0, density: 1.0, gravity: 10.0, landing_speed: 10.0 };

    /// c = √(E/ρ), m/s.
    pub fn wave_speed(&self) -> f64 {
        (self.modulus / self.density).sqrt()
    }

    /// τ = 2L/c, s.
    pub fn wave_period(&self) -> f64 {
        2.0 * self.length / self.wave_speed()
    }

    /// 2v₀/g, s.
    pub fn flight(&self) -> f64 {
        2.0 * self.landing_speed / self.gravity
    }

    /// v₀²/2g, m.
    pub fn fall(&self) -> f64 {
        0.5 * self.landing_speed * self.landing_speed / self.gravity
    }

    /// From landing to landing: τ + 2v₀/g, s.
    pub fn bounce(&self) -> f64 {
        self.wave_period() + self.flight()
    }

    /// Height of the lower end at a time after the release from rest, m.
    ///
    /// `[eq:bouncing-bar]` Of ü = c² u'' − g for a bar that lands unstrained, u(z, t) measured from the unstrained
    /// bar on the ground:
    /// ```text
    /// landing 1, 0 ≤ s < τ: lower end 0, force (E/c) (v₀ + g s);
    /// flight 1, 0 ≤ s < kτ: lower end v₀ s − ½ g s² + g r (r − τ), r = s mod τ;
    /// landing 2, 0 ≤ s < τ: lower end 0, force (E/c) (v₀ + g (τ − s));
    /// flight 2, 0 ≤ s < kτ: lower end v₀ s − ½ g s², no strain; then the same again.
    /// ```
    /// Source: problem: Doyen, Ern & Piperno, SIAM J. Sci. Comput. 33 (2011) 223–249; solution derived here.
    /// Checked by: `dynamics/src/stability/bouncing_bar.rs::the_closed_form_keeps_momentum_and_complementarity`,
    /// `dynamics/tests/bouncing_bar.rs::the_lower_end_converges_to_the_closed_form`.
    pub fn lower_end(&self, time: f64) -> f64 {
        let (g, v, tau) = (self.gravity, self.landing_speed, self.wave_period());
        let since = time - v / g;
        if since < 0.0 {
            return self.fall() - 0.5 * g * time * time;
        }
        let (count, s) = self.place(since);
        let s = s - tau;
        if s < 0.0 {
            return 0.0;
        }
        let free = v * s - 0.5 * g * s * s;
        let r = s.rem_euclid(tau);
        if count % 2 == 0 { free + g * r * (r - tau) } else { free }
    }

    /// Number of the bounce and time since its landing.
    fn place(&self, since: f64) -> (u64, f64) {
        let count = (since / self.bounce()).floor();
        (count as u64, since - count * self.bounce())
    }

    /// Linear elements with diagonal mass, upwards from the lower end, which must stay above the ground. With
    /// `massless_end` the mass of the lower end is given to its neighbour, so that the contact force finds no inertia
    /// of its own (mass redistribution: Khenous, Laborde & Renard, Eur. J. Mech. A 27, 2008).
    ///
    /// # Errors
    /// If the matrices cannot be made.
    pub fn system(
        &self,
        elements: usize,
        massless_end: bool,
    ) -> Result<VibratingSystem, IntegratorError> {
        let nodes = elements + 1;
        let size = self.length / elements as f64;
        let spring = self.modulus / size;
        let mut mass: Vec<f64> = vec![self.density * size; nodes];
        mass[0] *= 0.5;
        mass[elements] *= 0.5;
        if massless_end {
            mass[1] += std::mem::take(&mut mass[0]);
        }
        let stiffness = DMatrix::from_fn(nodes, nodes, |i, j| match i.abs_diff(j) {
            0 if i == 0 || i == elements => spring,
            0 => 2.0 * spring,
            1 => -spring,
            _ => 0.0,
        });
        let load = mass.iter().map(|m| -self.gravity * m).collect();
        let mass = DMatrix::from_fn(nodes, nodes, |i, j| if i == j { mass[i] } else { 0.0 });
        let row = (0..nodes).map(|i| if i == 0 { 1.0 } else { 0.0 }).collect();
        VibratingSystem::new(mass, DMatrix::zeros(nodes, nodes), stiffness, load)?
            .between(&[Obstacle { row, clearance: 0.0 }])
    }

    /// Lets the bar bounce by a scheme, with steps of `courant` times the passage of an element.
    ///
    /// # Errors
    /// If the scheme cannot be prepared or a step fails.
    pub fn bounces(
        &self,
        scheme: &Scheme,
        massless_end: bool,
        elements: usize,
        courant: f64,
        count: usize,
    ) -> Result<Bounces, IntegratorError> {
        let system = self.system(elements, massless_end)?;
        let h = courant * self.length / elements as f64 / self.wave_speed();
        let integrator = scheme.prepare(&system, h)?;
        let nodes = system.count();
        let mut state = system.start(&vec![self.fall(); nodes], &vec![0.0; nodes])?;
        let first = system.energy(&state);
        // The top of flight n is at n bounces after the release.
        let ends = (1..=count).map(|n| n as f64 * self.bounce());
        let mut found = Bounces {
            energy: Vec::with_capacity(count),
            largest_energy: 1.0,
            smallest_energy: 1.0,
            place_error: 0.0,
        };
        let mut see = |state: &StepState| {
            let part = system.energy(state) / first;
            found.largest_energy = found.largest_energy.max(part);
            found.smallest_energy = found.smallest_energy.min(part);
            if state.time < 2.0 * self.bounce() {
                let off = (state.x[0] - self.lower_end(state.time)).abs();
                found.place_error = found.place_error.max(off / self.fall());
            }
        };
        let mut tops = Vec::with_capacity(count);
        for end in ends {
            while state.time < end {
                integrator.step(&mut state)?;
                see(&state);
            }
            tops.push(system.energy(&state) / first);
        }
        found.energy = tops;
        Ok(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Force on the ground at that time, N per m² of cross-section.
    fn force(bar: &BouncingBar, time: f64) -> f64 {
        let (g, v, tau) = (bar.gravity, bar.landing_speed, bar.wave_period());
        let since = time - v / g;
        if since < 0.0 {
            return 0.0;
        }
        let (count, s) = bar.place(since);
        if s >= tau {
            return 0.0;
        }
        let since = if count % 2 == 0 { s } else { tau - s };
        bar.modulus / bar.wave_speed() * (v + g * since)
    }

    /// Newton's law for the whole bar: its momentum changes by weight and contact force, and the force and the place
    /// of the lower end exclude each other.
    #[test]
    fn the_closed_form_keeps_momentum_and_complementarity() {
        let bar = BouncingBar::PUBLISHED;
        let tau = bar.wave_period();
        let mass = bar.density * bar.length;
        let steps = 200_000;
        let h = 2.0 * bar.bounce() / f64::from(steps);
        let start = bar.landing_speed / bar.gravity;
        let mut impulse = [0.0; 2];
        for i in 0..steps {
            let t = start + (f64::from(i) + 0.5) * h;
            let (x, force) = (bar.lower_end(t), force(&bar, t));
            assert!(x >= 0.0 && force >= 0.0 && (x == 0.0 || force == 0.0), "{t}: {x} {force}");
            impulse[usize::from(t - start > bar.bounce())] += force * h;
        }
        // Each landing turns −v₀ into +v₀ against the weight.
        let exact = mass * (2.0 * bar.landing_speed + bar.gravity * tau);
        for found in impulse {
            assert!((found / exact - 1.0).abs() < 1e-4, "{found} {exact}");
        }
        // The lower end moves without jumps.
        for i in 0..1000 {
            let t = f64::from(i) * 0.011;
            assert!((bar.lower_end(t + 1e-9) - bar.lower_end(t)).abs() < 1e-7, "{t}");
        }
    }
}
