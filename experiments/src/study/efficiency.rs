//! Which settings are efficient, and which of the ranks can be believed.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A setting as the ranking sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// Value of the quantity.
    pub value: f64,
    /// Cost in any unit, above 0.
    pub cost: f64,
    /// Number of the series it belongs to and its place in it, coarse to fine.
    pub place: Option<(usize, usize)>,
}

/// Why a small error may be luck.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Doubt {
    /// A finer setting of the same series is farther off, on the other side of the truth: the error crosses zero near
    /// this setting.
    Crossing,
    /// A finer setting of the same series is farther off on the same side.
    GrowsWithRefinement,
}

/// What became of a candidate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Judged {
    /// 100 (value − truth)/|truth|.
    pub error_percent: f64,
    /// Largest |error| of this setting and of the finer ones of its series, percent: what ranks are taken from.
    pub guarded_percent: f64,
    /// Why the small error may be luck; only where a finer setting is farther off by more than 2U.
    pub doubt: Option<Doubt>,
    /// Whether |error| is below U, so that it cannot be told from nil.
    pub is_within_uncertainty: bool,
    /// Rank by guarded error, 1 the most accurate; equals share a rank.
    pub rank: usize,
    /// Least and greatest rank as the truth moves from −U to +U.
    pub ranks: [usize; 2],
    /// Whether no setting is both cheaper and more accurate, by guarded error.
    pub is_efficient: bool,
    /// Whether that changes as the truth moves from −U to +U.
    pub is_efficiency_uncertain: bool,
}

impl Judged {
    /// Whether the rank changes as the truth moves from −U to +U.
    pub fn is_rank_uncertain(&self) -> bool {
        self.ranks[0] != self.ranks[1]
    }
}

/// Number of positions of the truth from −U to +U at which ranks are taken: where two settings change places between
/// the ends and back again, the ends alone would not show it.
const POSITIONS: usize = 21;

/// Judges candidates by a truth and its uncertainty U, both in the unit of the values; `truth` is not 0.
pub fn judge(truth: f64, uncertainty: f64, candidates: &[Candidate]) -> Vec<Judged> {
    let at = |k: usize| {
        let share = 2.0 * k as f64 / (POSITIONS - 1) as f64 - 1.0;
        Ranking::of(truth + share * uncertainty, candidates)
    };
    let (own, moved) = (Ranking::of(truth, candidates), (0..POSITIONS).map(at).collect::<Vec<_>>());
    let percent = 100.0 / truth.abs();
    let one = |i: usize| {
        let ranks = moved.iter().map(|m| m.ranks[i]).chain([own.ranks[i]]);
        let ranks = ranks.fold([usize::MAX, 0], |[a, b], r| [a.min(r), b.max(r)]);
        let error = candidates[i].value - truth;
        Judged {
            error_percent: percent * error,
            guarded_percent: percent * own.guarded[i],
            doubt: doubt(i, &own, candidates, truth, uncertainty),
            is_within_uncertainty: error.abs() <= uncertainty,
            rank: own.ranks[i],
            ranks,
            is_efficient: own.is_efficient[i],
            is_efficiency_uncertain: moved.iter().any(|m| m.is_efficient[i] != own.is_efficient[i]),
        }
    };
    (0..candidates.len()).map(one).collect()
}

fn doubt(
    i: usize,
    own: &Ranking,
    candidates: &[Candidate],
    truth: f64,
    uncertainty: f64,
) -> Option<Doubt> {
    let error = |k: usize| candidates[k].value - truth;
    if own.guarded[i] - error(i).abs() <= 2.0 * uncertainty {
        return None;
    }
    let finer = finer(i, candidates);
    let farthest = finer.max_by(|a, b| error(*a).abs().total_cmp(&error(*b).abs()))?;
    let is_other_side = error(i) * error(farthest) < 0.0;
    Some(if is_other_side { Doubt::Crossing } else { Doubt::GrowsWithRefinement })
}

/// The finer settings of the series of setting `i`.
fn finer(i: usize, candidates: &[Candidate]) -> impl Iterator<Item = usize> + '_ {
    let own = candidates[i].place;
    (0..candidates.len()).filter(move |k| match (own, candidates[*k].place) {
        (Some((series, place)), Some((other, at))) => series == other && at > place,
        _ => false,
    })
}

/// Errors and ranks by one position of the truth.
struct Ranking {
    guarded: Vec<f64>,
    ranks: Vec<usize>,
    is_efficient: Vec<bool>,
}

impl Ranking {
    fn of(truth: f64, candidates: &[Candidate]) -> Self {
        let error = |k: usize| (candidates[k].value - truth).abs();
        let all = 0..candidates.len();
        let guarded: Vec<f64> =
            all.clone().map(|i| finer(i, candidates).map(error).fold(error(i), f64::max)).collect();
        let ranks = all.clone().map(|i| 1 + guarded.iter().filter(|g| **g < guarded[i]).count());
        let beats = |k: usize, i: usize| {
            let (a, b) = (candidates[k].cost, candidates[i].cost);
            a <= b && guarded[k] <= guarded[i] && (a < b || guarded[k] < guarded[i])
        };
        let is_efficient = all.clone().map(|i| !all.clone().any(|k| beats(k, i)));
        Self { ranks: ranks.collect(), is_efficient: is_efficient.collect(), guarded }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(list: &[(f64, f64)]) -> Vec<Candidate> {
        let one = |(k, (value, cost)): (usize, &(f64, f64))| Candidate {
            value: *value,
            cost: *cost,
            place: Some((0, k)),
        };
        list.iter().enumerate().map(one).collect()
    }

    /// Errors 8, 0.1, −2, −1, −0.5: the second is nearest to the truth by luck.
    #[test]
    fn a_lucky_crossing_is_flagged_and_ranked_by_what_follows() {
        let list = of(&[(108.0, 1.0), (100.1, 2.0), (98.0, 4.0), (99.0, 8.0), (99.5, 16.0)]);
        let found = judge(100.0, 0.01, &list);
        let doubts: Vec<_> = found.iter().map(|j| j.doubt).collect();
        assert_eq!(doubts, [None, Some(Doubt::Crossing), None, None, None]);
        assert!((found[1].error_percent - 0.1).abs() < 1e-9);
        assert!((found[1].guarded_percent - 2.0).abs() < 1e-9);
        let ranks: Vec<_> = found.iter().map(|j| j.rank).collect();
        assert_eq!(ranks, [5, 3, 3, 2, 1]);
        // The third costs more than the second and is no more accurate.
        let front: Vec<_> = found.iter().map(|j| j.is_efficient).collect();
        assert_eq!(front, [true, true, false, true, true]);
        // Without series there is nothing by which luck could be seen.
        let alone: Vec<Candidate> = list.iter().map(|c| Candidate { place: None, ..*c }).collect();
        assert_eq!(judge(100.0, 0.01, &alone)[1].doubt, None);
        assert_eq!(judge(100.0, 0.01, &alone)[1].rank, 1);
    }

    #[test]
    fn an_error_that_grows_with_refinement_is_flagged() {
        let found = judge(100.0, 0.01, &of(&[(101.0, 1.0), (102.0, 2.0), (103.0, 4.0)]));
        let doubts: Vec<_> = found.iter().map(|j| j.doubt).collect();
        let grows = Some(Doubt::GrowsWithRefinement);
        assert_eq!(doubts, [grows, grows, None]);
        // Inside U nothing can be said.
        let found = judge(100.0, 2.0, &of(&[(101.0, 1.0), (102.0, 2.0), (103.0, 4.0)]));
        assert!(found.iter().all(|j| j.doubt.is_none()));
    }

    /// Errors of +1 and −1.2 change places if the truth moves by 0.2, and do not if it moves by 0.05.
    #[test]
    fn ranks_that_a_moved_truth_would_change_are_uncertain() {
        let list = [(101.0, 2.0), (98.8, 1.0)];
        let list: Vec<_> = list.map(|(value, cost)| Candidate { value, cost, place: None }).into();
        let (sure, not) = (judge(100.0, 0.05, &list), judge(100.0, 0.2, &list));
        assert!(sure.iter().all(|j| !j.is_rank_uncertain() && !j.is_efficiency_uncertain));
        assert!(not.iter().all(Judged::is_rank_uncertain));
        // The dearer one would leave the front; the cheaper one is on it in any case.
        assert_eq!(
            not.iter().map(|j| j.is_efficiency_uncertain).collect::<Vec<_>>(),
            [true, false]
        );
        // A truth that is wrong by more than U gives other ranks without a flag: that U must cover its own error is
        // what routes and extrapolation are tested for.
        let wrong = judge(99.8, 0.05, &list);
        assert_eq!([sure[0].rank, wrong[0].rank], [1, 2]);
    }
}
