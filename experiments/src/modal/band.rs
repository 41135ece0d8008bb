//! Change of natural frequencies with the position in the mesh cycle and with the preload.

use fe_contact::statics::Bodies;
use lumped::ModeType;
use scene::Scene;

use super::error::ModalError;
use super::linear::{Preload, linear_modes, preloaded};
use super::mode::of_type;

/// Natural frequencies of the linearised set at evenly spaced positions of the mesh cycle, under several
/// torques.
#[derive(Debug, Clone)]
pub struct FrequencyBand {
    /// Torques on the sun, N m.
    pub torques_nm: Vec<f64>,
    /// Positions, cycles.
    pub positions: Vec<f64>,
    /// Modes, identified by type and place among the modes of the type, by ascending mean frequency.
    pub modes: Vec<ModeBand>,
}

/// One mode over all torques and positions.
#[derive(Debug, Clone)]
pub struct ModeBand {
    /// Type.
    pub mode_type: ModeType,
    /// Place among the modes of its type, from 1.
    pub place: usize,
    /// Frequency by torque and position, Hz; `None` where fewer modes were of this type.
    pub frequencies_hz: Vec<Vec<Option<f64>>>,
}

/// Lowest, mean and highest of some frequencies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// Lowest, Hz.
    pub lowest: f64,
    /// Mean, Hz.
    pub mean: f64,
    /// Highest, Hz.
    pub highest: f64,
    /// Number of frequencies.
    pub count: usize,
}

impl ModeBand {
    /// Spread over all torques and positions.
    pub fn spread(&self) -> Spread {
        Spread::of(self.frequencies_hz.iter().flatten().flatten().copied())
    }

    /// Spread over all positions under torque number `torque`.
    pub fn spread_under(&self, torque: usize) -> Spread {
        Spread::of(self.frequencies_hz[torque].iter().flatten().copied())
    }
}

impl Spread {
    fn of(list: impl Iterator<Item = f64>) -> Self {
        let none = Self { lowest: f64::INFINITY, mean: 0.0, highest: 0.0, count: 0 };
        let sum = list.fold(none, |s, f| Self {
            lowest: s.lowest.min(f),
            mean: s.mean + f,
            highest: s.highest.max(f),
            count: s.count + 1,
        });
        Self { mean: sum.mean / sum.count.max(1) as f64, ..sum }
    }
}

/// Natural frequencies up to `highest_hz` of the set linearised at `count` evenly spaced positions of the
/// mesh cycle, under the torque of a preload times each of `factors`.
///
/// # Errors
/// If the set has no equilibrium, or cannot be linearised, in one of these states.
pub fn frequency_band(
    scene: &Scene,
    bodies: &Bodies,
    preload: &Preload,
    factors: &[f64],
    count: usize,
    highest_hz: f64,
) -> Result<FrequencyBand, ModalError> {
    let torques_nm: Vec<f64> = factors.iter().map(|f| f * preload.load.sun_torque_nm).collect();
    let positions: Vec<f64> = (0..count).map(|i| i as f64 / count as f64).collect();
    let mut modes: Vec<ModeBand> = Vec::new();
    for (t, torque_nm) in torques_nm.iter().enumerate() {
        for (p, position) in positions.iter().enumerate() {
            let state = Preload {
                load: preload.load.with_sun_torque(*torque_nm),
                position: *position,
                ..*preload
            };
            let set = preloaded(scene, bodies, &state)?;
            let mut found = linear_modes(&set, &set.linearised()?)?;
            found.retain(|m| m.frequency_hz <= highest_hz);
            for mode_type in TYPES {
                for (i, mode) in of_type(&found, mode_type).iter().enumerate() {
                    let is_own = |m: &ModeBand| m.mode_type == mode_type && m.place == i + 1;
                    let known = modes.iter().position(is_own);
                    let at = known.unwrap_or_else(|| {
                        let frequencies_hz = vec![vec![None; count]; factors.len()];
                        modes.push(ModeBand { mode_type, place: i + 1, frequencies_hz });
                        modes.len() - 1
                    });
                    modes[at].frequencies_hz[t][p] = Some(mode.frequency_hz);
                }
            }
        }
    }
    modes.sort_by(|a, b| a.spread().mean.total_cmp(&b.spread().mean));
    Ok(FrequencyBand { torques_nm, positions, modes })
}

const TYPES: [ModeType; 4] =
    [ModeType::Rotational, ModeType::Translational, ModeType::Planet, ModeType::Mixed];
