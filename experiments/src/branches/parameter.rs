//! What is varied along a branch.

use scene::LoadCase;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::sweep::{Marching, SweepError, SweepModel, VariedKey};

/// What is varied along a branch; everything else is held fixed, above all what the model was made under
/// ([`SweepModel::turning`](crate::sweep::SweepModel::turning)).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BranchParameter {
    /// Speed of the input member, rpm.
    Speed,
    /// Torque on the sun, N·m, about the loaded configuration of the model's own torque.
    Torque,
    /// Factor on every damping of the scene.
    Damping,
    /// A number of the scene, in the unit of its key; everything else is that of a scene with this value.
    Key(VariedKey),
}

impl BranchParameter {
    /// Its name as a clause.
    pub fn name(self) -> &'static str {
        match self {
            Self::Speed => "speed of the input member",
            Self::Torque => "torque on the sun",
            Self::Damping => "factor on the damping",
            Self::Key(key) => key.path(),
        }
    }

    /// As the argument `--over` calls it.
    pub fn argument(self) -> &'static str {
        match self {
            Self::Speed => "speed",
            Self::Torque => "torque",
            Self::Damping => "damping",
            Self::Key(key) => key.path(),
        }
    }

    /// Its unit, empty for a pure number.
    pub fn plain_unit(self) -> &'static str {
        match self {
            Self::Speed => "rpm",
            Self::Torque => "N·m",
            Self::Damping => "",
            Self::Key(key) => key.unit(),
        }
    }

    /// Its unit with a space before it, empty for a pure number.
    pub fn unit(self) -> String {
        match self.plain_unit() {
            "" => String::new(),
            unit => format!(" {unit}"),
        }
    }

    /// Share of the middle of its range that counts as a unit of arc. Resonances are some per cent of the speed wide;
    /// load and damping change motions in proportion to themselves.
    pub(super) fn share(self) -> f64 {
        match self {
            Self::Speed => 0.02,
            Self::Torque | Self::Damping | Self::Key(_) => 0.1,
        }
    }

    /// Share of the peak-to-peak vibration that counts as a unit of arc. Over a resonance the vibration changes by
    /// multiples of itself. Over load or damping it changes little but where teeth part: both folds may then lie within
    /// a seventh of the torque and a twentieth of the vibration (the catalogue's pair at 3970 rpm: 133 and 153 N·m),
    /// which no step may span.
    pub(super) fn vibration_share(self) -> f64 {
        match self {
            Self::Speed => 1.0,
            Self::Torque | Self::Damping | Self::Key(_) => 0.1,
        }
    }

    /// The set of a model at one value, at rest under its load; `size` as in [`SweepModel::turning`].
    pub(super) fn set(
        self,
        model: &dyn SweepModel,
        value: f64,
        size: usize,
    ) -> Result<Box<dyn Marching + '_>, SweepError> {
        let mut set = match self {
            Self::Key(key) => model.turning_with(key, value, size)?,
            _ => {
                let (case, damping) = self.at(&model.case(), value);
                model.turning_damped(&case, damping, size)?
            }
        };
        // The load belongs to the set, not to its coordinates.
        set.rest()?;
        Ok(set)
    }

    /// Load case and factor on the damping at one value; `fixed` says the rest.
    pub(super) fn at(self, fixed: &LoadCase, value: f64) -> (LoadCase, f64) {
        match self {
            Self::Speed => (fixed.at_speed(value), 1.0),
            Self::Torque => (fixed.with_sun_torque(value), 1.0),
            Self::Damping => (*fixed, value),
            Self::Key(_) => (*fixed, 1.0),
        }
    }
}
