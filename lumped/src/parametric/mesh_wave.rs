//! The rectangular wave of one mesh's stiffness.

use std::f64::consts::{PI, TAU};

use dynamics::c64;

/// w(t) of a mesh: its contact ratio and phase.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshWave {
    /// Contact ratio.
    pub contact_ratio: f64,
    /// Phase at time 0, cycles: 0 where a pair starts its path of contact.
    pub phase: f64,
}

impl MeshWave {
    /// Part of the cycle in which one more pair carries.
    pub fn high_part(&self) -> f64 {
        self.contact_ratio.rem_euclid(1.0)
    }

    /// w at a time, cycles: 2(1 − c′) in the first part c′ of the cycle, −2c′ in the rest.
    pub fn at(&self, time: f64) -> f64 {
        let high = self.high_part();
        if (time + self.phase).rem_euclid(1.0) < high { 2.0 * (1.0 - high) } else { -2.0 * high }
    }

    /// Times in [0, 1) at which w switches, cycles; none for a whole contact ratio.
    pub fn switches(&self) -> Vec<f64> {
        let high = self.high_part();
        if high == 0.0 {
            return Vec::new();
        }
        vec![(-self.phase).rem_euclid(1.0), (high - self.phase).rem_euclid(1.0)]
    }

    /// `[eq:mesh-wave]` ŵ_l of w = Σ ŵ_l e^{2πi l t}: (2/πl) sin(πlc′) e^{−πi l c′} e^{2πi l φ}.
    ///
    /// Source: closed form.
    /// Checked by: `lumped/src/parametric/mesh_wave.rs::harmonics_are_those_of_the_wave`.
    pub fn harmonic(&self, l: u32) -> c64 {
        let (l, high) = (f64::from(l), self.high_part());
        let size = 2.0 / (PI * l) * (PI * l * high).sin();
        c64::from_polar(size, TAU * l * self.phase - PI * l * high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ w e^{−2πi l t} dt by the midpoint rule between switches.
    #[test]
    fn harmonics_are_those_of_the_wave() {
        for (contact_ratio, phase) in [(1.62, 0.0), (1.37, 0.81), (2.5, -0.3)] {
            let wave = MeshWave { contact_ratio, phase };
            let n = 400_000;
            for l in 0..4u32 {
                let sum: c64 = (0..n)
                    .map(|i| {
                        let t = (f64::from(i) + 0.5) / f64::from(n);
                        c64::from_polar(wave.at(t), -TAU * f64::from(l) * t)
                    })
                    .sum();
                let found = sum / f64::from(n);
                let exact = if l == 0 { c64::new(0.0, 0.0) } else { wave.harmonic(l) };
                assert!((found - exact).norm() < 2e-5, "{contact_ratio} {l}: {found} {exact}");
            }
        }
    }
}
