//! Results of this program that take too long to be computed by every run, as kept in `reference/` with
//! the commands that remake them.

use scene::CellLayout;
use serde::Deserialize;

use crate::reference_file::{ReferenceError, embedded, parse};
use experiments::sweep::top_of_three;

/// `full_impulse.toml`.
#[derive(Debug, Deserialize)]
#[allow(missing_docs)] // the keys say it all, units included
pub struct FullImpulse {
    pub source: String,
    pub command: String,
    pub flank_elements: u32,
    pub torque_nm: f64,
    pub position: f64,
    pub set: Vec<FullImpulseSet>,
}

/// Modes of one set, ascending.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)] // the keys say it all, units included
pub struct FullImpulseSet {
    pub scene: String,
    pub frequencies_hz: Vec<f64>,
    pub damping_ratios: Vec<f64>,
}

/// `torque_peaks.toml`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)] // the keys say it all, units included
pub struct TorquePeaks {
    pub source: String,
    pub command: String,
    pub torques_nm: Vec<f64>,
    pub peak: Vec<TorquePeak>,
}

/// One resonance: heights over those at the first torque.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)] // the keys say it all, units included
pub struct TorquePeak {
    pub system: String,
    pub mode: String,
    pub harmonic: u32,
    pub frequency_hz: f64,
    pub speeds_rpm: Vec<f64>,
    pub sun: Vec<f64>,
    pub planet: Vec<f64>,
    /// The harmonic of the sun's static deflection that drives it.
    #[serde(rename = "static")]
    pub at_rest: Vec<f64>,
}

/// `full_sweep.toml`: steady states with every degree of freedom.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)] // the keys say it all, units included
pub struct FullSweep {
    pub source: String,
    pub command: String,
    pub torque_nm: f64,
    pub flank_elements: u32,
    /// Layout of the contact cells: models are compared on the same.
    pub cell_layout: CellLayout,
    /// Tables of contact laid out for twice the usual load, this often.
    pub table_size: usize,
    pub point: Vec<FullSweepPoint>,
    /// Quasi-static bodies about the peak, by which the error of steps is known.
    pub quasi_static: Vec<FullSweepPoint>,
}

/// The peak of the sun's rotation in the second harmonic, without the error of time steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RotationalPeak {
    /// Speed of the input member, rpm.
    pub speed_rpm: f64,
    /// Height, rad.
    pub height_rad: f64,
    /// What the steps leave either uncertain by, percent.
    pub uncertain_percent: [f64; 2],
}

impl FullSweep {
    /// As kept in the repository.
    ///
    /// # Errors
    /// If the file does not hold what the code expects.
    pub fn load() -> Result<Self, ReferenceError> {
        parse("kept/full_sweep.toml", embedded!("kept/full_sweep.toml"))
    }

    /// The points at some steps a cycle.
    pub fn of_steps(&self, steps: u32) -> impl Iterator<Item = &FullSweepPoint> {
        self.point.iter().filter(move |p| p.steps_per_cycle == steps)
    }

    /// Whether a speed (rpm) is one of those about the peak.
    pub fn is_about_the_peak(&self, speed_rpm: f64) -> bool {
        self.quasi_static.iter().any(|q| q.speed_rpm == speed_rpm)
    }

    /// The peak of the three speeds about it at 140 steps, less the error of steps q∞/q₁₄₀ of quasi-static
    /// bodies, of second order at 280 and 560 steps:
    ///
    /// ```text
    /// q∞ = q₅₆₀ + (q₅₆₀ − q₂₈₀)/3
    /// ```
    ///
    /// and as uncertain as the extrapolation is long. `None` if there is none.
    pub fn rotational_peak(&self) -> Option<RotationalPeak> {
        let top = |points: &mut dyn Iterator<Item = &FullSweepPoint>| {
            top_of_three(points.map(|p| (p.speed_rpm, p.sun_rotation_rad[1])))
        };
        let full = top(&mut self.of_steps(140).filter(|p| self.is_about_the_peak(p.speed_rpm)))?;
        let quasi =
            |steps: u32| top(&mut self.quasi_static.iter().filter(|p| p.steps_per_cycle == steps));
        let (coarse, half, fine) = (quasi(140)?, quasi(280)?, quasi(560)?);
        let without = |fine: f64, half: f64| fine + (fine - half) / 3.0;
        let exact = (without(fine.0, half.0), without(fine.1, half.1));
        let off = |exact: f64, fine: f64| 100.0 * (fine / exact - 1.0).abs();
        Some(RotationalPeak {
            speed_rpm: full.0 * exact.0 / coarse.0,
            height_rad: full.1 * exact.1 / coarse.1,
            uncertain_percent: [off(exact.0, fine.0), off(exact.1, fine.1)],
        })
    }
}

/// One speed: amplitudes of harmonics 1 to 5.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)] // the keys say it all, units included
pub struct FullSweepPoint {
    pub steps_per_cycle: u32,
    pub speed_rpm: f64,
    pub cycles: usize,
    /// Change of the last two cycles in parts of the vibration.
    pub residual: f64,
    pub sun_rotation_rad: [f64; 5],
    pub sun_translation_m: [f64; 5],
    pub planet_0_rotation_rad: [f64; 5],
    pub planet_0_translation_m: [f64; 5],
    pub sun_mesh_0_force_n: [f64; 5],
    pub ring_mesh_0_force_n: [f64; 5],
}

/// `exact_peaks.toml`: resonances with exact kinematics at every step, default scene of four planets.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)] // the keys say it all, units included
pub struct ExactPeaks {
    pub source: String,
    pub command: String,
    pub peak: Vec<ExactPeak>,
}

/// One resonance under one torque: amplitudes of the sun at three speeds about it.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)] // the keys say it all, units included
pub struct ExactPeak {
    pub mode: String,
    pub harmonic: usize,
    pub torque_nm: f64,
    pub speeds_rpm: [f64; 3],
    /// Translation in m, or rotation in rad.
    pub sun: [f64; 3],
    pub cycles: [usize; 3],
}

/// `torque_map.toml`: section 4.2 over mesh compliance and γ.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)] // the keys say it all, units included
pub struct TorqueMap {
    pub source: String,
    pub command: String,
    pub torques_nm: Vec<f64>,
    pub cell: Vec<MapCell>,
}

/// One choice of compliance, γ, damping and relief; heights over those at the first torque.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)] // the keys say it all, units included
pub struct MapCell {
    /// `map`, or what is different on a line at the default scene's γ.
    pub line: String,
    /// From the default scene (0) to the printed stiffness (1).
    pub softening: f64,
    pub gamma_cycles: f64,
    /// Sun meshes and ring meshes.
    pub mean_stiffness_n_per_um: [f64; 2],
    pub translational: Vec<f64>,
    /// Height at the first torque, m.
    pub translational_first: f64,
    pub translational_static: Vec<f64>,
    pub rotational: Vec<f64>,
    /// rad
    pub rotational_first: f64,
    pub rotational_static: Vec<f64>,
    pub third: Vec<f64>,
    /// m
    pub third_first: f64,
    pub third_static: Vec<f64>,
    pub monotonic: bool,
    pub rotation_above_translation: bool,
    pub third_below_rotation: bool,
}

impl MapCell {
    /// Least growth of any of the three peaks from one torque to the next, a ratio: 1 or more if every peak
    /// grows with torque.
    pub fn least_growth_of_a_step(&self) -> f64 {
        let of = |list: &[f64]| list.windows(2).map(|w| w[1] / w[0]).fold(f64::INFINITY, f64::min);
        of(&self.translational).min(of(&self.rotational)).min(of(&self.third))
    }

    /// Whether the sun's rotation has outgrown its translation at rest at the same torques as in
    /// resonance.
    pub fn keeps_static_order(&self) -> bool {
        let is_above = |rotation: &[f64], translation: &[f64]| -> Vec<bool> {
            rotation.iter().zip(translation).skip(1).map(|(r, t)| r > t).collect()
        };
        is_above(&self.rotational_static, &self.translational_static)
            == is_above(&self.rotational, &self.translational)
    }
}

/// `ladder.toml`: error against cost.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)] // the keys say it all, units included
pub struct Ladder {
    pub source: String,
    pub command: String,
    pub torque_nm: f64,
    /// Of tables of contact, as the truth has them.
    pub table_size: usize,
    /// Peak of the sun's rotation in the second harmonic with `full`, without the error of steps.
    pub peak_rpm: f64,
    pub peak_rad: f64,
    /// What its own steps leave it uncertain by.
    pub peak_rpm_uncertain_percent: f64,
    pub peak_rad_uncertain_percent: f64,
    pub fidelity: Vec<LadderFidelity>,
}

/// One fidelity at some steps and cells.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)] // the keys say it all, units included
pub struct LadderFidelity {
    pub name: String,
    pub steps_per_cycle: u32,
    pub contact_cells: u32,
    pub peak_rpm: f64,
    pub peak_rad: f64,
    /// Time of one step over that of a lumped step, in turns: quartiles.
    pub step_ratio: [f64; 3],
    pub coordinates: usize,
    /// Solutions for all meshes in a step, mean since rest.
    pub solutions: f64,
}

impl LadderFidelity {
    /// Error of the peak's height, percent.
    pub fn height_percent(&self, ladder: &Ladder) -> f64 {
        100.0 * (self.peak_rad / ladder.peak_rad - 1.0)
    }

    /// Error of its place, percent.
    pub fn place_percent(&self, ladder: &Ladder) -> f64 {
        100.0 * (self.peak_rpm / ladder.peak_rpm - 1.0)
    }

    /// Cost of a mesh cycle over that of a lumped one at 140 steps.
    pub fn cycle_ratio(&self) -> f64 {
        self.step_ratio[1] * f64::from(self.steps_per_cycle) / 140.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn growth_of_every_step_says_what_the_map_says_and_the_static_order_need_not_hold() {
        let map = crate::Reference::load().unwrap().torque_map;
        for cell in &map.cell {
            assert_eq!(cell.least_growth_of_a_step() > 1.0, cell.monotonic, "{cell:?}");
        }
        let kept = map.cell.iter().filter(|cell| cell.keeps_static_order()).count();
        assert!(0 < kept && kept < map.cell.len());
        let mut cell = map.cell[0].clone();
        (cell.rotational_static, cell.translational_static) =
            (cell.rotational.clone(), cell.translational.clone());
        assert!(cell.keeps_static_order());
    }

    /// A truth that was remade asks for the ladder to be.
    #[test]
    fn the_ladder_stands_beside_the_truth_that_is_kept() {
        let truth = FullSweep::load().unwrap();
        let ladder = crate::Reference::load().unwrap().ladder;
        assert_eq!((ladder.torque_nm, ladder.table_size), (truth.torque_nm, truth.table_size));
        let peak = truth.rotational_peak().unwrap();
        // As many digits as are written.
        assert!((ladder.peak_rpm - peak.speed_rpm).abs() < 1e-3, "{}", peak.speed_rpm);
        assert!((ladder.peak_rad / peak.height_rad - 1.0).abs() < 1e-6, "{}", peak.height_rad);
    }
}
