//! Branches of piecewise smooth equations past a kink at which they turn back.
//!
//! Where two smooth pieces of F meet, the tangents on both sides differ by a finite angle. Up to a right angle the
//! hyperplane across the old tangent still meets the branch; beyond it, at a fold of the kink, it does not, however
//! short the step, or a solution on the piece beyond is found from which the branch leads back. What tells forwards
//! from backwards is the sign of det [∂F/∂u; tᵀ], which stays the same along the branch. The next step goes in this
//! sense along the tangent at the last point or of the linearisation at a point just beyond it.

use super::family::Family;
use super::space::{Corrected, Space, Stop, dot, norm};

/// Factor from one step tried to the next longer one.
const LONGER: f64 = 4.0;

/// Points whose linearisation is tried, in steps along the old tangent: the last one itself, then beyond the kink.
const PROBES: [f64; 4] = [0.0, 1.0, 0.25, 4.0];

/// A point beyond the kink after `from`, at most `longest` away; `None` if there is none that the linearisations there
/// and beyond lead to. `sense`: sign of det [∂F/∂u; tᵀ] along the branch before the kink.
pub(super) fn past_kink<F: Family>(
    space: &mut Space<'_, F>,
    from: &Corrected,
    sense: f64,
    [shortest, longest]: [f64; 2],
    stop: Stop,
) -> Option<Corrected> {
    let (u, t) = (&from.u, &from.tangent);
    let along =
        |h: f64, t: &[f64]| -> Vec<f64> { u.iter().zip(t).map(|(u, t)| u + h * t).collect() };
    let mut h = shortest;
    while h <= longest {
        for probe in PROBES {
            let beyond = along(probe * h, t);
            // A probe at which F is not defined, or has no tangent, tells nothing.
            let Ok(mut other) = space.any_tangent(&beyond, t) else { continue };
            let Ok(own) = space.orientation(&beyond, &other) else { continue };
            if own * sense < 0.0 {
                other.iter_mut().for_each(|t| *t = -*t);
            }
            let Ok(next) = space.correct(&along(h, &other), &other, stop) else { continue };
            let moved: Vec<f64> = next.u.iter().zip(u).map(|(a, b)| a - b).collect();
            let is_near = (0.1 * h..3.0 * h).contains(&norm(&moved)) && dot(&moved, &other) > 0.0;
            // The way back along the branch has the other sense.
            if is_near && next.orientation * sense > 0.0 {
                return Some(next);
            }
        }
        h *= LONGER;
    }
    None
}
