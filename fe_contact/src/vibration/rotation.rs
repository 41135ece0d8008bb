//! Nominal rotation of a set, about which it vibrates.

use gearset::PathDirection;

/// Nominal rotation of a set: none, or at a constant mesh frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NominalRotation {
    /// Standing at a position of the mesh cycle (cycles), in steps of a given length (s).
    Standing {
        /// Position, cycles.
        position: f64,
        /// Step, s.
        step: f64,
    },
    /// Turning from position 0.
    Turning {
        /// Mesh frequency, Hz.
        mesh_frequency: f64,
        /// Steps in a mesh cycle.
        steps_per_cycle: usize,
        /// Direction in which positions are passed: step k ends at k/S or at −k/S.
        direction: PathDirection,
    },
}

impl NominalRotation {
    /// Positions of the mesh cycle at which steps end, cycles.
    pub fn positions(&self) -> Vec<f64> {
        match *self {
            Self::Standing { position, .. } => vec![position],
            Self::Turning { steps_per_cycle, .. } => {
                (0..steps_per_cycle).map(|step| self.position(step)).collect()
            }
        }
    }

    /// `[eq:direction-of-positions]` Position at which a step of the cycle ends, cycles, 0 to ±1: step k ends at d
    /// k/S, d of `eq:path-direction`.
    ///
    /// Source: definition.
    /// Checked by: `experiments/tests/direction.rs::slow_sets_pass_the_same_positions_in_reverse`.
    pub(super) fn position(&self, step_in_cycle: usize) -> f64 {
        match *self {
            Self::Standing { position, .. } => position,
            Self::Turning { steps_per_cycle, direction, .. } => {
                let passed = step_in_cycle as f64 / steps_per_cycle as f64;
                // Not −0: a set at position 0 is the same in both directions.
                if step_in_cycle == 0 { 0.0 } else { direction.sign() * passed }
            }
        }
    }

    /// Direction in which positions are passed; `None` of a standing set.
    pub(super) fn turns(&self) -> Option<PathDirection> {
        match *self {
            Self::Standing { .. } => None,
            Self::Turning { direction, .. } => Some(direction),
        }
    }

    /// The same, forward of a standing set.
    pub(super) fn direction(&self) -> PathDirection {
        self.turns().unwrap_or_default()
    }

    /// Number of positions at which steps end.
    pub(super) fn count(&self) -> usize {
        match *self {
            Self::Standing { .. } => 1,
            Self::Turning { steps_per_cycle, .. } => steps_per_cycle,
        }
    }

    /// Position at the start, cycles.
    pub(super) fn start(&self) -> f64 {
        match *self {
            Self::Standing { position, .. } => position,
            Self::Turning { .. } => 0.0,
        }
    }
}
