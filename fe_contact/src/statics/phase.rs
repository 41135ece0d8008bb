//! Phases of a mesh cycle.

/// Phases are compared in steps of a cycle divided by this number; smaller differences are rounding
/// errors.
pub(super) const PHASE_RESOLUTION: f64 = 1e12;

/// Phase reduced to [0, 1), where a phase that rounds to 1 becomes 0.
pub(super) fn cycle(phase: f64) -> f64 {
    let reduced = phase - phase.floor();
    if reduced * PHASE_RESOLUTION >= PHASE_RESOLUTION - 0.5 { 0.0 } else { reduced }
}
