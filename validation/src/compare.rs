//! A list of natural frequencies compared with those of a model.

use schemars::JsonSchema;
use serde::Serialize;

use crate::likely_unit::LikelyUnit;

/// One frequency of the list.
#[derive(Debug, Clone, PartialEq)]
pub struct ListedMode {
    /// Hz.
    pub frequency_hz: f64,
    /// Mode type, if the list has one.
    pub mode_type: Option<String>,
    /// How often the frequency occurs, if the list says so.
    pub multiplicity: Option<usize>,
}

/// One distinct frequency of the model.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelMode {
    /// Hz.
    pub frequency_hz: f64,
    /// Mode type.
    pub mode_type: String,
    /// How often it occurs.
    pub multiplicity: usize,
}

/// One line of the matched table. One side is absent where nothing matched.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Match {
    /// The model's frequency, Hz.
    pub model_hz: Option<f64>,
    /// The model's mode type.
    pub model_type: Option<String>,
    /// Times the frequency occurs in the model.
    pub model_multiplicity: usize,
    /// Listed frequencies matched to it, Hz (a list may repeat a frequency or give it once).
    pub listed_hz: Vec<f64>,
    /// 100 (listed − model)/model, of the worst; absent without a match or for zero frequency.
    pub difference_percent: Option<f64>,
    /// Whether it agrees: matched, within tolerance, as often as the list says.
    pub agrees: bool,
    /// Whether it lies above the highest listed frequency, where a list that ends there says nothing.
    pub is_beyond_list: bool,
    /// Type that the list has instead of the model's, where all else agrees.
    pub listed_type: Option<String>,
    /// What is wrong, if anything.
    pub remark: Option<String>,
}

/// The whole comparison.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Comparison {
    /// Matched table, by model frequency; unmatched entries of the list at the end.
    pub matches: Vec<Match>,
    /// Tolerance, percent of the model's frequency.
    pub tolerance_percent: f64,
    /// Lines that agree.
    pub agreed: usize,
    /// Lines that do not.
    pub disagreed: usize,
    /// Modes of the model above the list's highest frequency; no disagreement unless a whole list is demanded.
    pub beyond_list: usize,
    /// Largest |difference| of all matched lines, percent.
    pub largest_difference_percent: f64,
    /// Unit that the list likely is in where few of its frequencies agree as Hz; left out without such a unit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub likely_unit: Option<LikelyUnit>,
}

/// Rigid-body frequencies come out of eigensolvers as noise; below this share of the highest model
/// frequency both sides count as zero.
const ZERO_SHARE: f64 = 1e-4;

/// Frequency up to which a mode of a model, and one listed beside it, is rigid-body motion, Hz.
pub(crate) fn rigid_body_hz(model: &[ModelMode]) -> f64 {
    ZERO_SHARE * model.iter().map(|m| m.frequency_hz).fold(0.0, f64::max)
}

/// Difference that an entry without a partner costs: frequencies further apart than two of it are not one mode.
const GAP_PERCENT: f64 = 10.0;

/// Matches a list to a model. Where every mode has a type, each type is matched within itself.
///
/// Within a type both sides are sorted, and the cheapest order-preserving alignment is taken, an unmatched entry
/// costing as much as a difference of 10 %, whatever the tolerance is. A listed frequency may stand for a model
/// frequency as often as that occurs, or once for all of them unless the list says how often it occurs. Modes of the
/// model above the highest listed frequency are no disagreement, for published tables end somewhere, unless
/// `is_whole` says that the list is to hold them all.
///
/// ```
/// use validation::{ListedMode, ModelMode, compare};
///
/// let listed = ListedMode { frequency_hz: 1000.0, mode_type: None, multiplicity: None };
/// let model = ModelMode { frequency_hz: 1004.0, mode_type: "rotational".into(), multiplicity: 1 };
/// let found = compare(&[listed], &[model], 0.5, true);
/// assert_eq!((found.agreed, found.disagreed), (1, 0));
/// ```
pub fn compare(
    listed: &[ListedMode],
    model: &[ModelMode],
    tolerance_percent: f64,
    is_whole: bool,
) -> Comparison {
    let found = held_against(listed, model, tolerance_percent, is_whole);
    Comparison { likely_unit: LikelyUnit::of(listed, model, &found, is_whole), ..found }
}

/// The comparison in Hz, whatever unit is likely.
pub(crate) fn held_against(
    listed: &[ListedMode],
    model: &[ModelMode],
    tolerance_percent: f64,
    is_whole: bool,
) -> Comparison {
    let end = listed.iter().fold(0.0f64, |a, l| a.max(l.frequency_hz));
    // A list with types of some modes only says too little to be matched by them.
    let typed = !listed.is_empty() && listed.iter().all(|l| l.mode_type.is_some());
    let mut kinds: Vec<Option<String>> = vec![None];
    if typed {
        let all = model.iter().map(|m| m.mode_type.clone());
        let listed_kinds = listed.iter().filter_map(|l| l.mode_type.clone());
        let mut names: Vec<String> = all.chain(listed_kinds).collect();
        names.sort();
        names.dedup();
        kinds = names.into_iter().map(Some).collect();
    }
    let mut matches = Vec::new();
    let mut strays = Vec::new();
    for kind in kinds {
        let of_kind = |name: &str| kind.as_deref().is_none_or(|k| k == name);
        let mut side: Vec<&ModelMode> = model.iter().filter(|m| of_kind(&m.mode_type)).collect();
        side.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
        let mut entries: Vec<&ListedMode> = listed
            .iter()
            .filter(|l| l.mode_type.as_deref().is_none_or(of_kind) || kind.is_none())
            .collect();
        entries.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
        let zero = rigid_body_hz(model);
        // Above the end of a list that may end somewhere nothing is looked for.
        let end_hz = if is_whole || listed.is_empty() { f64::INFINITY } else { end };
        let (taken, left) = align(&entries, &side, zero, end_hz);
        for (mode, own) in side.iter().zip(taken) {
            let mut found = judge(mode, &own, tolerance_percent, zero);
            if own.is_empty() && !is_whole && !listed.is_empty() && mode.frequency_hz > end {
                found.is_beyond_list = true;
                found.remark = Some("above the list's highest".into());
            }
            matches.push(found);
        }
        strays.extend(left.into_iter().map(|l| Match {
            model_hz: None,
            model_type: l.mode_type.clone(),
            model_multiplicity: 0,
            listed_hz: vec![l.frequency_hz],
            difference_percent: None,
            agrees: false,
            is_beyond_list: false,
            listed_type: None,
            remark: Some("the model has no such mode".into()),
        }));
    }
    let end_hz = if is_whole || listed.is_empty() { f64::INFINITY } else { end };
    if typed {
        release(&mut matches, &mut strays, tolerance_percent, end_hz);
        of_another_type(&mut matches, &mut strays, tolerance_percent);
    }
    matches.sort_by(|a, b| a.model_hz.unwrap_or(0.0).total_cmp(&b.model_hz.unwrap_or(0.0)));
    matches.extend(strays);
    let agreed = matches.iter().filter(|m| m.agrees).count();
    let beyond_list = matches.iter().filter(|m| m.is_beyond_list).count();
    let worst = matches.iter().filter_map(|m| m.difference_percent).map(f64::abs);
    Comparison {
        agreed,
        disagreed: matches.len() - agreed - beyond_list,
        beyond_list,
        largest_difference_percent: worst.fold(0.0, f64::max),
        matches,
        tolerance_percent,
        likely_unit: None,
    }
}

/// Difference in percent of the model's frequency; zero if both are rigid-body noise.
fn difference(listed: f64, model: f64, zero: f64) -> f64 {
    if listed.abs() <= zero && model.abs() <= zero {
        return 0.0;
    }
    100.0 * (listed - model) / model.max(zero)
}

/// For each model mode the listed ones matched to it, and the listed ones left over.
fn align<'l>(
    listed: &[&'l ListedMode],
    model: &[&ModelMode],
    zero: f64,
    end_hz: f64,
) -> (Vec<Vec<&'l ListedMode>>, Vec<&'l ListedMode>) {
    // Each model mode offers as many places as it occurs; only the first must be filled.
    let places: Vec<(usize, usize)> = model
        .iter()
        .enumerate()
        .flat_map(|(i, m)| (0..m.multiplicity).map(move |copy| (i, copy)))
        .collect();
    let gap = GAP_PERCENT;
    let (rows, columns) = (listed.len(), places.len());
    let cell = |i: usize, j: usize| i * (columns + 1) + j;
    let mut cost = vec![0.0f64; (rows + 1) * (columns + 1)];
    let free = |j: usize| match places[j] {
        (mode, 0) if model[mode].frequency_hz <= end_hz => gap,
        _ => 0.0,
    };
    let pair = |i: usize, j: usize| {
        difference(listed[i].frequency_hz, model[places[j].0].frequency_hz, zero).abs()
    };
    for i in 0..=rows {
        for j in 0..=columns {
            cost[cell(i, j)] = match (i, j) {
                (0, 0) => 0.0,
                (0, _) => cost[cell(0, j - 1)] + free(j - 1),
                (_, 0) => cost[cell(i - 1, 0)] + gap,
                _ => (cost[cell(i - 1, j - 1)] + pair(i - 1, j - 1))
                    .min(cost[cell(i - 1, j)] + gap)
                    .min(cost[cell(i, j - 1)] + free(j - 1)),
            };
        }
    }
    let mut taken = vec![Vec::new(); model.len()];
    let mut left = Vec::new();
    let (mut i, mut j) = (rows, columns);
    while i > 0 || j > 0 {
        let here = cost[cell(i, j)];
        let is_pair = i > 0 && j > 0 && here == cost[cell(i - 1, j - 1)] + pair(i - 1, j - 1);
        if is_pair {
            (i, j) = (i - 1, j - 1);
            taken[places[j].0].push(listed[i]);
        } else if j > 0 && here == cost[cell(i, j - 1)] + free(j - 1) {
            j -= 1;
        } else {
            i -= 1;
            left.push(listed[i]);
        }
    }
    taken.iter_mut().for_each(|t| t.reverse());
    left.reverse();
    (taken, left)
}

fn judge(mode: &ModelMode, own: &[&ListedMode], tolerance_percent: f64, zero: f64) -> Match {
    let worst = own
        .iter()
        .map(|l| difference(l.frequency_hz, mode.frequency_hz, zero))
        .max_by(|a, b| a.abs().total_cmp(&b.abs()));
    // An entry that says nothing stands for one mode or for all that share its frequency.
    let least: usize = own.iter().map(|l| l.multiplicity.unwrap_or(1)).sum();
    let is_stated = !own.is_empty() && own.iter().all(|l| l.multiplicity.is_some());
    let remark = match worst {
        None => Some("not in the list".to_owned()),
        Some(d) if d.abs() > tolerance_percent => Some("outside tolerance".to_owned()),
        _ if least > mode.multiplicity || (is_stated && least < mode.multiplicity) => {
            Some(format!("listed {least} times, occurs {} times", mode.multiplicity))
        }
        _ => None,
    };
    Match {
        model_hz: Some(mode.frequency_hz),
        model_type: Some(mode.mode_type.clone()),
        model_multiplicity: mode.multiplicity,
        listed_hz: own.iter().map(|l| l.frequency_hz).collect(),
        difference_percent: worst,
        agrees: remark.is_none(),
        is_beyond_list: false,
        listed_type: None,
        remark,
    }
}

/// Frees listed modes that are paired beyond the tolerance within their type, where a mode of another type that the
/// list lacks is within it.
fn release(matches: &mut [Match], strays: &mut Vec<Match>, tolerance_percent: f64, end_hz: f64) {
    let lacking: Vec<f64> =
        matches.iter().filter(|m| m.listed_hz.is_empty()).filter_map(|m| m.model_hz).collect();
    let is_near = |listed: &f64| {
        let near = |hz: &f64| 100.0 * (listed - hz).abs() <= tolerance_percent * hz;
        lacking.iter().any(|hz| *hz > 0.0 && near(hz))
    };
    for found in matches.iter_mut().filter(|m| !m.listed_hz.is_empty()) {
        let differs = found.difference_percent.is_some_and(|d| d.abs() > tolerance_percent);
        if !differs || !found.listed_hz.iter().all(is_near) {
            continue;
        }
        let stray = |hz| Match {
            model_hz: None,
            model_multiplicity: 0,
            listed_hz: vec![hz],
            difference_percent: None,
            remark: Some("the model has no such mode".into()),
            ..found.clone()
        };
        strays.extend(found.listed_hz.iter().map(|hz| stray(*hz)));
        found.listed_hz.clear();
        found.difference_percent = None;
        found.is_beyond_list = found.model_hz.is_some_and(|hz| hz > end_hz);
        let remark =
            if found.is_beyond_list { "above the list's highest" } else { "not in the list" };
        found.remark = Some(remark.to_owned());
    }
}

/// Listed modes without a partner of their type that are, within tolerance, a mode of the model of another type that
/// the list lacks: one mode with a wrong type instead of two faults.
fn of_another_type(matches: &mut [Match], strays: &mut Vec<Match>, tolerance_percent: f64) {
    for lacking in matches.iter_mut().filter(|m| m.listed_hz.is_empty()) {
        let (Some(hz), Some(model_type)) = (lacking.model_hz, &lacking.model_type) else {
            continue;
        };
        let percent = |stray: &Match| 100.0 * (stray.listed_hz[0] - hz) / hz;
        let is_near = |stray: &Match| {
            stray.model_type.is_some() && hz > 0.0 && percent(stray).abs() <= tolerance_percent
        };
        let Some(first) = strays.iter().find(|stray| is_near(stray)).cloned() else { continue };
        let is_same = |stray: &Match| is_near(stray) && stray.model_type == first.model_type;
        lacking.listed_hz = strays.iter().filter(|s| is_same(s)).map(|s| s.listed_hz[0]).collect();
        lacking.difference_percent = Some(percent(&first));
        lacking.is_beyond_list = false;
        let listed = first.model_type.clone().unwrap_or_default();
        lacking.remark = Some(format!("listed as {listed}, is {model_type}"));
        lacking.listed_type = Some(listed);
        strays.retain(|stray| !is_same(stray));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn model() -> Vec<ModelMode> {
        [(1710.4, "planet", 1), (1715.8, "translational", 2), (1788.5, "rotational", 1)]
            .map(|(frequency_hz, name, multiplicity)| ModelMode {
                frequency_hz,
                mode_type: name.into(),
                multiplicity,
            })
            .to_vec()
    }

    fn listed(frequency_hz: f64, kind: Option<&str>) -> ListedMode {
        ListedMode { frequency_hz, mode_type: kind.map(str::to_owned), multiplicity: None }
    }

    #[test]
    fn types_are_matched_within_themselves_even_where_order_crosses() {
        let list = [
            listed(1716.0, Some("planet")),
            listed(1714.0, Some("translational")),
            listed(1790.0, Some("rotational")),
        ];
        let result = compare(&list, &model(), 1.0, true);
        assert_eq!(result.disagreed, 0, "{result:?}");
        assert_eq!(result.matches[0].listed_hz, [1716.0]);
        assert!((result.largest_difference_percent - 100.0 * 5.6 / 1710.4).abs() < 1e-9);
    }

    #[test]
    fn a_pair_may_be_listed_once_or_twice_but_not_three_times() {
        let once = [listed(1710.4, None), listed(1715.8, None), listed(1788.5, None)];
        assert_eq!(compare(&once, &model(), 0.1, true).disagreed, 0);
        let twice: Vec<_> = once.iter().cloned().chain([listed(1715.9, None)]).collect();
        assert_eq!(compare(&twice, &model(), 0.1, true).disagreed, 0);
        let thrice: Vec<_> = twice.iter().cloned().chain([listed(1716.0, None)]).collect();
        assert_eq!(compare(&thrice, &model(), 0.1, true).disagreed, 1);
    }

    #[test]
    fn missing_strange_and_distant_entries_disagree() {
        let list = [listed(1710.4, None), listed(1760.0, None), listed(3000.0, None)];
        let result = compare(&list, &model(), 1.0, true);
        let remarks: Vec<_> = result.matches.iter().filter_map(|m| m.remark.clone()).collect();
        assert!(remarks.iter().any(|r| r.contains("no such mode")), "{remarks:?}");
        assert!(result.disagreed >= 2);
        assert_eq!(compare(&[], &model(), 1.0, true).disagreed, 3);
    }

    #[test]
    fn a_multiplicity_that_is_stated_must_be_that_of_the_model() {
        let list = |multiplicity| {
            let mut list = [listed(1710.4, None), listed(1715.8, None), listed(1788.5, None)];
            list[1].multiplicity = multiplicity;
            compare(&list, &model(), 0.1, true)
        };
        assert_eq!(list(None).disagreed, 0);
        assert_eq!(list(Some(2)).disagreed, 0);
        let once = list(Some(1));
        assert_eq!(once.disagreed, 1);
        assert_eq!(once.matches[1].remark.as_deref(), Some("listed 1 times, occurs 2 times"));
        assert_eq!(list(Some(3)).disagreed, 1);
    }

    #[test]
    fn modes_above_a_lists_end_disagree_only_where_the_whole_list_is_demanded() {
        let list = [listed(1710.4, None), listed(1715.8, None)];
        let found = compare(&list, &model(), 0.1, false);
        assert_eq!((found.agreed, found.disagreed, found.beyond_list), (2, 0, 1));
        assert!(found.matches[2].is_beyond_list && !found.matches[2].agrees);
        assert_eq!(compare(&list, &model(), 0.1, true).disagreed, 1);
        // A gap below the end is one whatever is demanded, and an empty list agrees with nothing.
        let list = [listed(1710.4, None), listed(1788.5, None)];
        assert_eq!(compare(&list, &model(), 0.1, false).disagreed, 1);
        assert_eq!(compare(&[], &model(), 0.1, false).disagreed, 3);
    }

    #[test]
    fn a_wrong_type_disagrees() {
        let list = [
            listed(1710.4, Some("rotational")),
            listed(1715.8, Some("translational")),
            listed(1788.5, Some("rotational")),
        ];
        let found = compare(&list, &model(), 1.0, true);
        assert_eq!((found.agreed, found.disagreed), (2, 1), "{found:?}");
        assert_eq!(found.matches[0].listed_hz, [1710.4]);
        assert_eq!(found.matches[0].remark.as_deref(), Some("listed as rotational, is planet"));
    }
}
