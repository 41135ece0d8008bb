//! Where branches cross a speed.

use experiments::branches::{Branch, BranchPoint};

use crate::amplitudes::rotation;

/// Speed of a point, rpm.
pub(crate) fn speed(p: &BranchPoint) -> f64 {
    p.state.case.speed_rpm
}

/// The motions of a branch at one speed, with their stability, between neighbouring points.
pub(crate) fn at(branch: &Branch, rpm: f64) -> Vec<([f64; 5], bool)> {
    let crossing = |pair: &[BranchPoint]| {
        let [a, b] = [speed(&pair[0]), speed(&pair[1])];
        let share = (rpm - a) / (b - a);
        (0.0..1.0).contains(&share).then(|| {
            let [from, to] = [rotation(&pair[0].state), rotation(&pair[1].state)];
            let mut between = from;
            between.iter_mut().zip(to).for_each(|(f, t)| *f += share * (t - *f));
            (between, pair[0].is_stable && pair[1].is_stable)
        })
    };
    branch.points.windows(2).filter_map(crossing).collect()
}
