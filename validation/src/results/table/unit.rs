//! Units that the title of a column may end in.

use std::f64::consts::{PI, TAU};

/// What a column of numbers measures; its numbers are converted to the unit named here.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Hz.
    Frequency,
    /// rpm.
    Speed,
    /// N m.
    Torque,
    /// rad.
    Angle,
    /// m.
    Length,
    /// N.
    Force,
    /// N/m.
    Stiffness,
    /// Part of a mesh cycle, 0 to 1.
    CyclePart,
    /// A displacement (m), a rotation (rad) or a force (N), as another column of the row says.
    ByRow,
}

/// What a unit is one of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dimension {
    /// Displacements.
    Length,
    /// Rotations and phases.
    Angle,
    /// Mesh forces.
    Force,
}

/// A unit as the end of a title: name, and by what its numbers are multiplied.
pub(super) type Unit = (&'static str, f64);

const FREQUENCY: &[Unit] = &[
    ("hz", 1.0),
    ("khz", 1e3),
    ("rad_per_s", 1.0 / TAU),
    ("rad_s", 1.0 / TAU),
    ("rpm", 1.0 / 60.0),
];
const SPEED: &[Unit] =
    &[("rpm", 1.0), ("rad_per_s", 60.0 / TAU), ("rad_s", 60.0 / TAU), ("hz", 60.0), ("1_min", 1.0)];
const TORQUE: &[Unit] =
    &[("nm", 1.0), ("n_m", 1.0), ("nmm", 1e-3), ("n_mm", 1e-3), ("knm", 1e3), ("kn_m", 1e3)];
const ANGLE: &[Unit] = &[("rad", 1.0), ("mrad", 1e-3), ("urad", 1e-6), ("deg", PI / 180.0)];
const LENGTH: &[Unit] = &[("m", 1.0), ("mm", 1e-3), ("um", 1e-6), ("nm", 1e-9)];
const FORCE: &[Unit] = &[("n", 1.0), ("kn", 1e3)];
const STIFFNESS: &[Unit] = &[
    ("n_per_m", 1.0),
    ("n_m", 1.0),
    ("n_per_mm", 1e3),
    ("n_mm", 1e3),
    ("n_per_um", 1e6),
    ("n_um", 1e6),
    ("kn_per_mm", 1e6),
    ("kn_mm", 1e6),
];
const CYCLE_PART: &[Unit] = &[("", 1.0), ("percent", 1e-2), ("deg", 1.0 / 360.0)];

impl Quantity {
    /// Units of the quantity, the one that numbers are converted to first.
    pub(super) fn units(self) -> Vec<Unit> {
        match self {
            Self::Frequency => FREQUENCY.to_vec(),
            Self::Speed => SPEED.to_vec(),
            Self::Torque => TORQUE.to_vec(),
            Self::Angle => ANGLE.to_vec(),
            Self::Length => LENGTH.to_vec(),
            Self::Force => FORCE.to_vec(),
            Self::Stiffness => STIFFNESS.to_vec(),
            Self::CyclePart => CYCLE_PART.to_vec(),
            Self::ByRow => [&[("", 1.0)], LENGTH, ANGLE, FORCE].concat(),
        }
    }

    /// The name of a column without the unit of the quantity.
    pub(super) fn stem(self, name: &'static str) -> &'static str {
        let unit = self.units().first().map_or("", |unit| unit.0);
        name.strip_suffix(unit).map_or(name, |stem| stem.trim_end_matches('_'))
    }
}

impl Dimension {
    /// What a unit of a [`Quantity::ByRow`] column measures; `None` of no unit, which fits every row.
    pub(super) fn of_unit(unit: &str) -> Option<Self> {
        let is_in = |list: &[Unit]| list.iter().any(|(name, _)| *name == unit);
        let lists = [(LENGTH, Self::Length), (ANGLE, Self::Angle), (FORCE, Self::Force)];
        lists.into_iter().find(|(list, _)| is_in(list)).map(|(_, dimension)| dimension)
    }
}
