//! JSON of `impulse`.

use experiments::modal::{Decay, FeMode, FrequencyBand, ModeBand, Preload, Spread, beside};
use scene::Fidelity;
use schemars::JsonSchema;
use serde::Serialize;

use super::found::Found;
use crate::commands::modes::KindShares;

/// `impulse --format json`.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct ImpulseOutput {
    /// On the sun; clockwise if negative.
    pub(super) sun_torque_nm: f64,
    /// Where the set stands in the mesh cycle.
    pub(super) position: f64,
    pub(super) step_us: f64,
    /// Of each free decay.
    pub(super) duration_ms: f64,
    /// Lowest and highest frequency looked for.
    pub(super) band_limits_hz: [f64; 2],
    /// quasi_static, modal or full.
    pub(super) fidelity: String,
    /// Modes of each body with its race held; null at fidelities other than modal.
    pub(super) body_modes: Option<u32>,
    /// Time steps taken in all.
    pub(super) steps: u64,
    /// Whether the linearised modes are given; they are not at fidelity full.
    pub(super) has_linearisation: bool,
    /// Linearised modes outside the band, in which none is identified; of quasi-static bodies at fidelity full.
    pub(super) outside_band: Vec<OutsideMode>,
    /// Modes in the band, identified from the decays, linearised, or both; ascending.
    pub(super) modes: Vec<ModeEntry>,
    pub(super) pulses: Vec<PulseEntry>,
    pub(super) identification: IdentificationEntry,
    /// With `--band`, else null.
    pub(super) band: Option<BandOutput>,
    #[serde(skip)]
    pub(super) title: String,
}

/// A linearised mode outside the band.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct OutsideMode {
    pub(super) frequency_hz: f64,
    /// rotational, translational, planet or mixed.
    pub(super) mode_type: String,
}

/// One mode.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct ModeEntry {
    /// rotational, translational, planet or mixed.
    pub(super) mode_type: String,
    /// From the decays; null if not found in them.
    pub(super) identified: Option<DampedMode>,
    /// From the linearised set; null if there is none, or none of this type.
    pub(super) linearised: Option<LinearisedMode>,
    /// 100 (identified − linearised)/linearised.
    pub(super) difference_percent: Option<f64>,
}

/// Frequency, damping and motion of a mode.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct DampedMode {
    pub(super) frequency_hz: f64,
    pub(super) damping_ratio: f64,
    pub(super) shares: KindShares,
}

/// A mode of the linearised set.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct LinearisedMode {
    #[serde(flatten)]
    pub(super) mode: DampedMode,
    /// ∂ln f/∂ln k, all meshes alike.
    pub(super) mesh_sensitivity: f64,
}

/// One pulse and what it did.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct PulseEntry {
    pub(super) pulse: String,
    /// Force, applied for one time step; of a torque, the torque over the base radius.
    pub(super) force_n: f64,
    /// Largest change of a mesh force over the largest mesh force.
    pub(super) force_change: f64,
    /// Deviation of the response to half the pulse from half the response, over its largest value.
    pub(super) nonlinearity: f64,
    /// Largest |(x, y)| of the sun under a pulse on the sun, else null.
    pub(super) sun_translation_um: Option<f64>,
    /// Largest r_b |θ| of the sun under a pulse on the sun, else null.
    pub(super) sun_rotation_um: Option<f64>,
}

/// Model orders of the identification.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct IdentificationEntry {
    /// Order (number of states) of the model from which the modes are taken.
    pub(super) order: usize,
    /// Number of orders in the stabilisation chart.
    pub(super) orders: usize,
}

/// Linearised frequencies over the mesh cycle.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct BandOutput {
    pub(super) torques_nm: Vec<f64>,
    /// Positions in the mesh cycle.
    pub(super) positions: Vec<f64>,
    pub(super) modes: Vec<BandMode>,
}

/// One mode over torques and positions.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct BandMode {
    pub(super) mode_type: String,
    /// Place among the modes of its type, from 1.
    pub(super) place: usize,
    /// Whether its mean is in the band of the pulse test.
    pub(super) is_in_band: bool,
    /// Over all torques and positions.
    pub(super) lowest_hz: f64,
    pub(super) mean_hz: f64,
    pub(super) highest_hz: f64,
    /// Number of (torque, position) states that have a mode of this type and place; fewer than all states if
    /// the types of modes change between them.
    pub(super) states: usize,
    /// One for each torque.
    pub(super) torques: Vec<BandTorque>,
}

/// One mode over the positions under one torque; null where a state has no such mode.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct BandTorque {
    pub(super) torque_nm: f64,
    pub(super) lowest_hz: Option<f64>,
    pub(super) mean_hz: Option<f64>,
    pub(super) highest_hz: Option<f64>,
    /// Frequency at each position.
    pub(super) frequency_hz: Vec<Option<f64>>,
}

impl ImpulseOutput {
    pub(super) fn new(found: &Found) -> Self {
        let test = &found.test;
        let settings = &test.settings;
        let Preload { load, position, step_s } = settings.preload;
        let (fidelity, body_modes) = match found.scene.dynamics.fidelity {
            Fidelity::MeshLaw => ("mesh_law", None),
            Fidelity::QuasiStatic => ("quasi_static", None),
            Fidelity::Modal(n) => ("modal", Some(n)),
            Fidelity::Full => ("full", None),
        };
        Self {
            sun_torque_nm: load.sun_torque_nm,
            position,
            step_us: 1e6 * step_s,
            duration_ms: 1e3 * settings.duration_s,
            band_limits_hz: [settings.band_hz.0, settings.band_hz.1],
            fidelity: fidelity.into(),
            body_modes,
            steps: test.steps,
            has_linearisation: found.linear.is_some(),
            outside_band: found
                .outside
                .iter()
                .map(|m| OutsideMode {
                    frequency_hz: m.frequency_hz,
                    mode_type: m.mode_type.name().into(),
                })
                .collect(),
            modes: modes(&test.modes, found.linear.as_deref().unwrap_or(&[])),
            pulses: test.decays.iter().map(|d| pulse(found, d)).collect(),
            identification: IdentificationEntry {
                order: test.identification.order,
                orders: test.identification.chart.len(),
            },
            band: found.band.as_ref().map(|b| band(b, settings.band_hz)),
            title: found.scene.title.clone(),
        }
    }
}

/// Identified and linearised modes, matched.
fn modes(identified: &[FeMode], linear: &[(FeMode, f64)]) -> Vec<ModeEntry> {
    let linearised: Vec<&FeMode> = linear.iter().map(|(mode, _)| mode).collect();
    let entry = |(i, j): (Option<usize>, Option<usize>)| {
        let (ours, theirs) = (i.map(|i| &identified[i]), j.map(|j| &linear[j]));
        let mode_type = ours.or(theirs.map(|l| &l.0))?.mode_type;
        Some(ModeEntry {
            mode_type: mode_type.name().into(),
            identified: ours.map(damped),
            linearised: theirs.map(|(m, influence)| LinearisedMode {
                mode: damped(m),
                mesh_sensitivity: *influence,
            }),
            difference_percent: ours
                .zip(theirs)
                .map(|(a, (b, _))| 100.0 * (a.frequency_hz / b.frequency_hz - 1.0)),
        })
    };
    beside(identified, &linearised).into_iter().filter_map(entry).collect()
}

fn damped(mode: &FeMode) -> DampedMode {
    let FeMode { frequency_hz, damping_ratio, shares, .. } = *mode;
    let [rotational, translational, planet] = shares;
    let shares = KindShares { rotational, translational, planet };
    DampedMode { frequency_hz, damping_ratio, shares }
}

fn pulse(found: &Found, decay: &Decay) -> PulseEntry {
    let name = &decay.pulse.name;
    let sun =
        if name.starts_with("sun ") { found.test.sun_contents(&found.races, name) } else { None };
    PulseEntry {
        pulse: name.clone(),
        force_n: decay.force_n,
        force_change: decay.force_change,
        nonlinearity: decay.nonlinearity,
        sun_translation_um: sun.map(|c| 1e6 * c.translation),
        sun_rotation_um: sun.map(|c| 1e6 * c.rotation),
    }
}

fn band(band: &FrequencyBand, limits: (f64, f64)) -> BandOutput {
    let mode = |m: &ModeBand| {
        let Spread { lowest, mean, highest, count } = m.spread();
        let under = |(t, torque_nm): (usize, &f64)| {
            let own = m.spread_under(t);
            let given = |x: f64| (own.count > 0).then_some(x);
            BandTorque {
                torque_nm: *torque_nm,
                lowest_hz: given(own.lowest),
                mean_hz: given(own.mean),
                highest_hz: given(own.highest),
                frequency_hz: m.frequencies_hz[t].clone(),
            }
        };
        BandMode {
            mode_type: m.mode_type.name().into(),
            place: m.place,
            is_in_band: (limits.0..=limits.1).contains(&mean),
            lowest_hz: lowest,
            mean_hz: mean,
            highest_hz: highest,
            states: count,
            torques: band.torques_nm.iter().enumerate().map(under).collect(),
        }
    };
    BandOutput {
        torques_nm: band.torques_nm.clone(),
        positions: band.positions.clone(),
        modes: band.modes.iter().map(mode).collect(),
    }
}
