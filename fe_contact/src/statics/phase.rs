//! Phases of a mesh cycle.

/// Phases nearer than this many parts of a cycle are the same phase, rounded differently.
pub(super) const PHASE_RESOLUTION: f64 = 1e12;

/// Phase in [0, 1), what rounds to 1 being 0.
pub(super) fn cycle(phase: f64) -> f64 {
    let reduced = phase - phase.floor();
    if reduced * PHASE_RESOLUTION >= PHASE_RESOLUTION - 0.5 { 0.0 } else { reduced }
}
