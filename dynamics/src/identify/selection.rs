//! Choice of the order, and of its poles that are modes.

use faer::c64;

use super::chart::{ChartOrder, Pole};
use super::options::Options;

/// A choice from the chart.
pub(super) struct Selection {
    /// Place of the order in the chart.
    pub order: usize,
    /// Indices of its poles.
    pub poles: Vec<usize>,
}

/// The order with the most lasting poles (stable over `persistence` orders); of several such orders the one
/// whose poles change least to the adjacent orders. Of a complete realisation the highest order is taken.
/// `None` if no pole lasts.
pub(super) fn selection(
    chart: &[ChartOrder],
    complete: bool,
    options: &Options,
) -> Option<Selection> {
    let all = (0..chart.len())
        .map(|k| Selection { order: k, poles: lasting(chart, k, complete, options) });
    let mut all: Vec<Selection> = all.collect();
    if complete {
        return all.pop().filter(|last| !last.poles.is_empty());
    }
    let most = all.iter().map(|s| s.poles.len()).max().filter(|most| *most > 0)?;
    all.retain(|s| s.poles.len() == most);
    let unrest = |s: &Selection| unrest(chart, s.order, &s.poles);
    all.into_iter().min_by(|a, b| unrest(a).total_cmp(&unrest(b)))
}

/// Indices of the poles of order number k that can be modes.
fn lasting(chart: &[ChartOrder], k: usize, complete: bool, options: &Options) -> Vec<usize> {
    let (low, high) = options.band;
    let wanted = |p: &Pole| {
        (low..=high).contains(&p.frequency)
            && p.damping > 0.0
            && p.damping <= options.highest_damping
            && p.coherence >= options.coherence
            && p.amplitude.is_finite()
    };
    let poles = &chart[k].poles;
    let candidates = poles.iter().filter(|p| wanted(p));
    let strongest = candidates.fold(0.0f64, |a, p| a.max(p.amplitude));
    let strong = |p: &Pole| p.amplitude >= options.weakest * strongest;
    let mut found: Vec<usize> =
        (0..poles.len()).filter(|&j| wanted(&poles[j]) && strong(&poles[j])).collect();
    // The highest order of a complete realisation has the poles of the data and no others.
    if complete && k + 1 == chart.len() {
        return found;
    }
    found.retain(|&j| run(chart, k, j) >= options.persistence);
    found
}

/// Number of orders in a row, below and above k, at which pole j of order k is stable.
fn run(chart: &[ChartOrder], k: usize, j: usize) -> usize {
    let mut length = 0;
    let (mut at, mut pole) = (k, j);
    while let (true, Some(before)) =
        (chart[at].poles[pole].stable.all(), chart[at].poles[pole].before)
    {
        length += 1;
        (at, pole) = (at - 1, before);
    }
    (at, pole) = (k, j);
    while at + 1 < chart.len() {
        let s = chart[at].poles[pole].s;
        let next = &chart[at + 1].poles;
        let distance = |i: &usize| (next[*i].s - s).norm();
        let nearest = (0..next.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        match nearest {
            Some(i) if next[i].stable.all() => pole = i,
            _ => break,
        }
        length += 1;
        at += 1;
    }
    length
}

/// Change of the poles `lasting` of order number k to the adjacent orders: sum over these poles of |Δs|/|s|
/// to the nearest pole, averaged over both sides.
fn unrest(chart: &[ChartOrder], k: usize, lasting: &[usize]) -> f64 {
    let sides = [k.checked_sub(1), Some(k + 1)];
    let change = |s: c64| -> f64 {
        let beside = sides.iter().flatten().filter_map(|&i| chart.get(i));
        let nearest = |order: &ChartOrder| {
            order.poles.iter().fold(1.0f64, |a, p| a.min((p.s - s).norm() / s.norm()))
        };
        let changes: Vec<f64> = beside.map(nearest).collect();
        changes.iter().sum::<f64>() / changes.len().max(1) as f64
    };
    lasting.iter().map(|&j| change(chart[k].poles[j].s)).sum()
}
