//! Nominal rotation of a set, about which it vibrates.

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
    },
}

impl NominalRotation {
    /// Positions of the mesh cycle at which steps end, cycles.
    pub fn positions(&self) -> Vec<f64> {
        match *self {
            Self::Standing { position, .. } => vec![position],
            Self::Turning { steps_per_cycle: count, .. } => {
                (0..count).map(|i| i as f64 / count as f64).collect()
            }
        }
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
