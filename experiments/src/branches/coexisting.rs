//! Ranges in which more than one stable motion was found.

use super::branch::{Branch, Branches};
use super::point::{BranchPoint, BranchPointKind};
use crate::sweep::Line;

/// Located points nearer than this, relative to the parameter, are one.
const SAME: f64 = 1e-6;

/// Motions whose harmonics differ by less than this share of the largest one of their kind are one.
const ALIKE: f64 = 1e-3;

/// Stable motions that follow one another along a branch.
struct Stretch<'b> {
    /// Ranges of the parameter from point to point.
    ranges: Vec<[f64; 2]>,
    /// Its points at the least and at the greatest value.
    ends: [&'b BranchPoint; 2],
}

impl<'b> Stretch<'b> {
    /// Of all branches, in order.
    fn all(branches: &'b [Branch]) -> Vec<Self> {
        let mut all = Vec::new();
        for branch in branches {
            let mut open: Option<Self> = None;
            for pair in branch.points.windows(2) {
                // At a located point itself stability is about to change.
                let is_stable = |p: &BranchPoint| p.is_stable || p.kind != BranchPointKind::Regular;
                let [a, b] = [&pair[0], &pair[1]];
                if !(is_stable(a) && is_stable(b) && (a.is_stable || b.is_stable)) {
                    all.extend(open.take());
                    continue;
                }
                let [low, high] = if a.parameter <= b.parameter { [a, b] } else { [b, a] };
                let own =
                    open.get_or_insert_with(|| Self { ranges: Vec::new(), ends: [low, high] });
                own.ranges.push([low.parameter, high.parameter]);
                if low.parameter < own.ends[0].parameter {
                    own.ends[0] = low;
                }
                if high.parameter > own.ends[1].parameter {
                    own.ends[1] = high;
                }
            }
            all.extend(open);
        }
        all
    }

    /// Whether two stretches are the same motions, passed twice: both ends are at the same values with the same
    /// harmonics. (A motion that repeats after two mesh cycles and the same one cycle later have the same harmonics.)
    fn is(&self, other: &Self) -> bool {
        self.ends.iter().zip(&other.ends).all(|(a, b)| {
            (a.parameter - b.parameter).abs() <= SAME * a.parameter.abs() && are_alike(a, b)
        })
    }
}

/// Whether two motions have the same harmonics.
fn are_alike(a: &BranchPoint, b: &BranchPoint) -> bool {
    a.state.lines.iter().zip(&b.state.lines).all(|(line, other)| {
        let own = a.state.lines.iter().filter(|l| l.coordinate == line.coordinate);
        let largest = own.map(|l| l.amplitude).fold(0.0, f64::max);
        let parts = |l: &Line| [l.amplitude * l.phase_rad.cos(), l.amplitude * l.phase_rad.sin()];
        let ([x, y], [u, v]) = (parts(line), parts(other));
        (x - u).hypot(y - v) <= ALIKE * largest
    })
}

impl Branches {
    /// Ranges of the parameter, ascending, in which more than one stable motion was found.
    pub fn coexisting(&self) -> Vec<[f64; 2]> {
        let mut stretches: Vec<Stretch<'_>> = Vec::new();
        for own in Stretch::all(&self.branches) {
            if !stretches.iter().any(|known| own.is(known)) {
                stretches.push(own);
            }
        }
        // Where stretches of stable motions begin (+1) and end (−1).
        let ranges = stretches.iter().flat_map(|own| &own.ranges);
        let mut ends: Vec<(f64, i32)> =
            ranges.flat_map(|[low, high]| [(*low, 1), (*high, -1)]).collect();
        // At one value stretches end before others begin, so that neighbours along a branch count once.
        ends.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let (mut count, mut from, mut ranges) = (0, f64::NAN, Vec::<[f64; 2]>::new());
        for (value, step) in ends {
            let was = count;
            count += step;
            if was < 2 && count == 2 {
                from = value;
            }
            if was == 2 && count < 2 && value > from {
                match ranges.last_mut() {
                    Some(last) if last[1] == from => last[1] = value,
                    _ => ranges.push([from, value]),
                }
            }
        }
        ranges
    }
}

#[cfg(test)]
mod tests {
    use scene::LoadCase;

    use super::super::branch::{Branch, BranchEnd, BranchOrigin};
    use super::super::parameter::BranchParameter;
    use super::*;
    use crate::sweep::SteadyState;

    fn branch(points: &[(f64, BranchPointKind, bool)]) -> Branch {
        let point = |&(parameter, kind, is_stable): &(f64, BranchPointKind, bool)| BranchPoint {
            state: SteadyState {
                case: LoadCase::turning(50.0, parameter, parameter),
                lines: Vec::new(),
            },
            parameter,
            damping_factor: 1.0,
            kind,
            is_stable,
            multipliers: Vec::new(),
            critical: None,
            between: None,
            residual: 0.0,
            arc: parameter,
            iterations: 3,
            lowest_force_n: 0.0,
            contact_loss: 0.0,
            backside_contact: None,
            grazing_margin: None,
        };
        Branch {
            fidelity: "mesh-law".into(),
            over: BranchParameter::Speed,
            origin: BranchOrigin::Start(1.0),
            repeats_after: 1,
            points: points.iter().map(point).collect(),
            ends: [BranchEnd::Bound, BranchEnd::Bound],
        }
    }

    #[test]
    fn stable_motions_coexist_between_folds_and_where_branches_overlap() {
        use BranchPointKind::{Fold, Regular};
        let hysteresis = branch(&[
            (1.0, Regular, true),
            (2.5, Regular, true),
            (3.0, Fold, false),
            (2.5, Regular, false),
            (2.0, Fold, false),
            (2.2, Regular, true),
            (4.0, Regular, true),
        ]);
        let mut found = Branches { branches: vec![hysteresis], not_followed: Vec::new() };
        assert_eq!(found.coexisting(), [[2.0, 3.0]]);
        found.branches.push(branch(&[
            (3.5, Regular, true),
            (3.8, Regular, true),
            (3.9, Regular, false),
        ]));
        assert_eq!(found.coexisting(), [[2.0, 3.0], [3.5, 3.8]]);
        let alone = branch(&[(1.0, Regular, true), (2.0, Regular, true), (3.0, Regular, true)]);
        let found = Branches { branches: vec![alone], not_followed: Vec::new() };
        assert!(found.coexisting().is_empty());
    }

    /// A branch that passes a stretch of stable motions twice, from one located point to another, has one motion there;
    /// two stretches that share one end only are two.
    #[test]
    fn motions_passed_twice_count_once() {
        use BranchPointKind::{Fold, NeimarkSacker, PeriodDoubling, Regular};
        let twice = branch(&[
            (1.0, Regular, false),
            (2.0, PeriodDoubling, true),
            (2.4, Regular, true),
            (3.0, NeimarkSacker, false),
            (3.5, Regular, false),
            (4.0, Fold, false),
            (3.5, Regular, false),
            (3.0, NeimarkSacker, true),
            (2.7, Regular, true),
            (2.0, PeriodDoubling, false),
            (1.0, Regular, false),
        ]);
        let mut found = Branches { branches: vec![twice], not_followed: Vec::new() };
        assert!(found.coexisting().is_empty(), "{:?}", found.coexisting());
        found.branches.push(branch(&[
            (2.0, PeriodDoubling, true),
            (2.5, Regular, true),
            (2.8, Fold, false),
            (2.7, Regular, false),
        ]));
        assert_eq!(found.coexisting(), [[2.0, 2.8]]);
    }
}
