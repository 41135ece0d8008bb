//! Where a mode has its energy: shares by which the errors of its frequency are estimated.

use fe_contact::statics::{CARRIER, PLANETS};
use fe_contact::vibration::{LinearSet, VibratingSet};
use lumped::{Body, LumpedModel, ModeGroup, ModeType, Parameter, sensitivities};

use crate::error::ExperimentError;
use crate::modal::{linear_modes, mesh_influence};

/// Bodies in the order carrier, ring, sun, all planets.
pub(super) const KINDS: usize = 4;

/// Energy of one mode.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ModeEnergy {
    pub(super) frequency_hz: f64,
    pub(super) mode_type: ModeType,
    /// Shares of the kinetic energy in rotational, translational and planet motion.
    pub(super) of_types: [f64; 3],
    /// Shares of kinetic energy: carrier, ring, sun, all planets.
    pub(super) kinetic: [f64; KINDS],
    /// Share of strain energy in all meshes, 2 ∂ln f/∂ln k.
    pub(super) meshes: f64,
    /// Share of strain energy in the planet bearings; with FE/contact, in all that are not meshes.
    pub(super) bearings: f64,
    /// Shape of unit modal mass on the races' coordinates of an FE/contact set; empty for the lumped model.
    pub(super) shape: Vec<f64>,
}

/// Modes of a linearised FE/contact set, ascending.
pub(super) fn of_linear(
    set: &VibratingSet<'_>,
    linear: &LinearSet,
) -> Result<Vec<ModeEnergy>, ExperimentError> {
    let modes = linear_modes(set, linear)?;
    let influence = mesh_influence(linear)?;
    let (races, mass) = (set.races(), set.masses());
    let bodies = PLANETS + races.psi.len();
    let energy = modes.into_iter().zip(&influence).map(|(mode, own)| {
        let mut kinetic = [0.0; KINDS];
        for body in CARRIER..bodies {
            for i in (0..3).filter_map(|axis| races.of(body, axis)) {
                // M-normalised: T_i = m_i φ_i²
                kinetic[body.min(PLANETS)] += mass[i] * mode.shape[i].powi(2);
            }
        }
        let meshes = 2.0 * own.all_meshes;
        let bearings = (1.0 - meshes).max(0.0);
        let (frequency_hz, mode_type) = (mode.frequency_hz, mode.mode_type);
        let of_types = mode.shares;
        ModeEnergy {
            frequency_hz,
            mode_type,
            of_types,
            kinetic,
            meshes,
            bearings,
            shape: mode.shape,
        }
    });
    Ok(energy.collect())
}

/// One distinct frequency of the lumped model.
pub(super) fn of_group(model: &LumpedModel, group: &ModeGroup) -> ModeEnergy {
    let mut kinetic = [0.0; KINDS];
    for share in lumped::kinetic_energy(model, group) {
        let kind = match share.of {
            Body::Carrier => 0,
            Body::Ring => 1,
            Body::Sun => 2,
            Body::Planet(_) => 3,
        };
        kinetic[kind] += share.share;
    }
    let all = sensitivities(model, group);
    let share = |name: &str| {
        let own = |s: &&lumped::Sensitivity| matches!(&s.parameter, Parameter::StiffnessFamily(n) if n == name);
        all.iter().find(own).map_or(0.0, |s| 2.0 * s.logarithmic)
    };
    ModeEnergy {
        frequency_hz: group.frequency_hz,
        mode_type: crate::modal::majority(&group.participation),
        of_types: [
            group.participation.rotational,
            group.participation.translational,
            group.participation.planet,
        ],
        kinetic,
        meshes: share("sun_mesh") + share("ring_mesh"),
        bearings: share("planet_bearing"),
        shape: Vec::new(),
    }
}

/// A mode with a share of the asked type between these may be counted among them or not: shares change with the model by as
/// much as a coupling of its type does.
const MIXED: [f64; 2] = [0.35, 0.65];

/// Modes up to this ratio above the asked one may change places with it.
const CLOSE: f64 = 1.05;

/// Frequency of a mode up to the one asked for, or close above it, that is of the asked type about as much as of others, Hz;
/// modes as frequencies (Hz) with their shares in rotational, translational and planet motion.
pub(super) fn mixed(
    modes: impl IntoIterator<Item = (f64, [f64; 3])>,
    own_hz: f64,
    mode_type: ModeType,
) -> Option<f64> {
    let place = match mode_type {
        ModeType::Rotational => 0,
        ModeType::Translational => 1,
        _ => 2,
    };
    let [low, high] = MIXED;
    let is_mixed = |(hz, shares): &(f64, [f64; 3])| {
        *hz <= CLOSE * own_hz && (low..=high).contains(&shares[place])
    };
    modes.into_iter().find(is_mixed).map(|(hz, _)| hz)
}
