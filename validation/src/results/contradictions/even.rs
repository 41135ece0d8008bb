//! Positions of a mesh cycle that are not even.

use std::path::Path;

use super::contradiction::Contradiction;

/// Largest step over the smallest of positions that are printed with few digits.
const EVEN: f64 = 1.5;

/// Steps that differ; the mean over uneven positions is not that over the cycle. `points`: positions, ascending, with
/// their lines.
pub(super) fn uneven(path: &Path, points: &[(f64, u64)]) -> Option<Contradiction> {
    let next = points.iter().cycle().skip(1);
    let step = |(a, b): (&(f64, u64), &(f64, u64))| {
        // The last step leads into the next cycle.
        let step = b.0 - a.0 + if b.0 < a.0 { 1.0 } else { 0.0 };
        (step, [a.1, b.1], [a.0, b.0])
    };
    let mut steps: Vec<_> = points.iter().zip(next).map(step).collect();
    steps.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (least, largest) = (steps.first()?, steps.last()?);
    if points.len() < 2 || largest.0 <= EVEN * least.0 {
        return None;
    }
    let (what, lines, [a, b]) = match least.0 {
        // Position 1 is position 0 of the next cycle.
        step if step <= 0.0 => ("are one position of the cycle", least.1, least.2),
        _ => ("leave a gap", largest.1, largest.2),
    };
    let statement = format!("positions are not even: {a} and {b} {what}");
    let remedy = "give positions k/n, k from 0 to n − 1: without 1 where 0 is there";
    Some(Contradiction::new(path, lines, &["position"], statement, remedy))
}
