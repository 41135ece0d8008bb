//! Discretisation errors: Richardson extrapolation of a refined sequence, with its uncertainty.

/// Lowest and highest observed order of convergence that is used. Outside, the sequence is not taken to converge with
/// a power of the refinement.
const USABLE: [f64; 2] = [0.5, 6.0];

/// Factor on the estimated error: with a usable order, and without one (Roache 1994; Celik et al. 2008).
const SAFETY: [f64; 2] = [1.25, 3.0];

/// Largest difference of the observed from the formal order at which the formal one is used.
const NEAR_FORMAL: f64 = 0.5;

/// Differences below this share of the value are rounding.
const ROUNDING: f64 = 1e-12;

/// The limit of a sequence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extrapolated {
    /// Limit; the finest value where no order could be observed.
    pub value: f64,
    /// Uncertainty U of the limit, in its unit.
    pub uncertainty: f64,
    /// Observed order p of convergence; `None` if the sequence does not converge with a power of the refinement, or
    /// no longer changes.
    pub order: Option<f64>,
}

impl Extrapolated {
    /// `[eq:grid-convergence-index]` Estimated error of one value of the sequence, in its unit: the grid convergence
    /// index 1.25 |v∞ − v| where an order was observed, but at least U; elsewhere U and the distance to the finest
    /// value.
    ///
    /// Source: Roache, J. Fluids Eng. 116 (1994) 405–413.
    /// Checked by: `dynamics/src/convergence.rs::the_error_of_a_coarser_value_is_its_distance_to_the_limit`,
    /// `fe.convergence.gci`.
    pub fn error_of(&self, value: f64) -> f64 {
        match self.order {
            Some(_) => self.uncertainty.max(SAFETY[0] * (self.value - value).abs()),
            None => self.uncertainty + (self.value - value).abs(),
        }
    }
}

/// Estimated error of the finest of some answers that are no single numbers, as curves or lines of a spectrum are,
/// from the `distances` of neighbours, coarse to fine, found at `refinements` as in [`extrapolate`]: one distance
/// fewer. As if the answers came to the finest one by one from the same side, so that neighbours do not agree by
/// chance.
///
/// `[eq:error-by-distances]` U = 1.25 d₂₃/(rᵖ − 1) for distances d of the answers, 3 d without a usable order.
/// Source: Roache, J. Fluids Eng. 116 (1994) 405–413.
/// Checked by: `dynamics/src/convergence.rs::distances_give_the_error_of_the_finest`.
pub fn error_by_distances(distances: &[f64], refinements: &[f64], formal: Option<f64>) -> f64 {
    let mut values = vec![0.0];
    for distance in distances.iter().rev() {
        values.push(values.last().unwrap_or(&0.0) + distance);
    }
    values.reverse();
    extrapolate(&values, refinements, formal).uncertainty
}

/// The limit of `values` (any unit), found at `refinements` n (steps, cells, elements: ascending, errors taken to fall
/// as n⁻ᵖ), at least two of either. `formal` is the order that theory gives, if any.
///
/// `[eq:richardson]` v∞ = v₃ + (v₃ − v₂)/(rᵖ − 1) and U = 1.25 |v∞ − v₃| with three values of order p.
/// Source: Richardson; Roache, J. Fluids Eng. 116 (1994) 405–413; Celik et al., J. Fluids Eng. 130 (2008) 078001.
/// Checked by: `dynamics/src/convergence.rs::a_pure_power_is_extrapolated_exactly`,
/// `experiments/src/study/controls.rs::the_known_truth_lies_within_a_known_uncertainty`.
///
/// Where the observed order is higher than the formal one by more than 0.5, the formal one is used, and where it is
/// lower, the observed one: of the two the larger U. Of four values or more, U is at least the difference to the
/// limit of the sequence without its last value. Without a usable order, v∞ is the finest value and U three times the
/// larger of the last two differences.
pub fn extrapolate(values: &[f64], refinements: &[f64], formal: Option<f64>) -> Extrapolated {
    let own = limit(values, refinements, formal);
    if values.len() < 4 || own.order.is_none() {
        return own;
    }
    let (shorter, coarser) = (&values[..values.len() - 1], &refinements[..values.len() - 1]);
    let off = (limit(shorter, coarser, formal).value - own.value).abs();
    Extrapolated { uncertainty: own.uncertainty.max(off), ..own }
}

fn limit(values: &[f64], refinements: &[f64], formal: Option<f64>) -> Extrapolated {
    let [.., v2, v3] = *values else {
        let value = values.last().copied().unwrap_or(f64::NAN);
        return Extrapolated { value, uncertainty: f64::NAN, order: None };
    };
    let without = |largest: f64| Extrapolated {
        value: v3,
        uncertainty: (SAFETY[1] * largest).max(ROUNDING * v3.abs()),
        order: None,
    };
    let ([.., v1, _, _], [.., n1, n2, n3]) = (values, refinements) else {
        return without((v3 - v2).abs());
    };
    let (first, second) = (v2 - v1, v3 - v2);
    let largest = first.abs().max(second.abs());
    if largest <= ROUNDING * v3.abs() || first * second <= 0.0 {
        return without(largest);
    }
    let Some(p) = order(first / second, n2 / n1, n3 / n2) else {
        return without(largest);
    };
    let used = match formal {
        Some(formal) if p > formal + NEAR_FORMAL => formal,
        Some(formal) if p >= formal - NEAR_FORMAL => formal.min(p),
        _ => p,
    };
    let step = second / ((n3 / n2).powf(used) - 1.0);
    let uncertainty = (SAFETY[0] * step.abs()).max(ROUNDING * v3.abs());
    Extrapolated { value: v3 + step, uncertainty, order: Some(p) }
}

/// `[eq:observed-order]` The order p at which (v₂ − v₁)/(v₃ − v₂) = s for refinement ratios r and q from the coarse
/// to the middle and from the middle to the fine grid: s = qᵖ (rᵖ − 1)/(qᵖ − 1). The right side grows with p; `None`
/// outside the usable orders.
///
/// Source: derived here.
/// Checked by: `dynamics/src/convergence.rs::a_pure_power_is_extrapolated_exactly`,
/// `dynamics/src/convergence.rs::an_order_above_the_formal_one_is_not_believed`.
fn order(s: f64, r: f64, q: f64) -> Option<f64> {
    let excess = |p: f64| q.powf(p) * (r.powf(p) - 1.0) / (q.powf(p) - 1.0) - s;
    let [mut low, mut high] = USABLE;
    // NaN is refused.
    if !(excess(low) <= 0.0 && excess(high) >= 0.0) {
        return None;
    }
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if excess(middle) < 0.0 { low = middle } else { high = middle }
    }
    Some(0.5 * (low + high))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sequence(limit: f64, error: f64, p: f64, n: &[f64]) -> Vec<f64> {
        n.iter().map(|n| limit + error * n.powf(-p)).collect()
    }

    #[test]
    fn a_pure_power_is_extrapolated_exactly() {
        for p in [1.0, 1.5, 2.0, 4.0] {
            for n in [[10.0, 20.0, 40.0], [8.0, 14.0, 20.0]] {
                let values = sequence(3.0, -0.7, p, &n);
                let found = extrapolate(&values, &n, None);
                assert!((found.value - 3.0).abs() < 1e-10, "{p} {n:?}: {found:?}");
                assert!((found.order.unwrap() - p).abs() < 1e-6, "{p}: {found:?}");
                let finest = (values[2] - 3.0).abs();
                assert!((found.uncertainty / finest - 1.25).abs() < 1e-6, "{p}: {found:?}");
            }
        }
    }

    /// With a second term in the error the limit is off, and by less than U.
    #[test]
    fn the_uncertainty_covers_a_sequence_that_is_not_yet_of_its_order() {
        for second in [-3.0, -1.0, 1.0, 3.0] {
            let n = [4.0, 8.0, 16.0];
            let values = n.map(|n: f64| 1.0 + n.powi(-2) + second * n.powi(-3));
            let found = extrapolate(&values, &n, Some(2.0));
            let off = (found.value - 1.0).abs();
            assert!(off > 0.0 && off <= found.uncertainty, "{second}: {off:e} {found:?}");
        }
    }

    /// An observed order above the formal one is a coincidence of two terms: it would make U too small.
    #[test]
    fn an_order_above_the_formal_one_is_not_believed() {
        let n = [10.0, 20.0, 40.0];
        let values = sequence(1.0, 1.0, 4.0, &n);
        let (believed, not) = (extrapolate(&values, &n, None), extrapolate(&values, &n, Some(2.0)));
        assert!(not.uncertainty > 3.0 * believed.uncertainty, "{believed:?} {not:?}");
    }

    #[test]
    fn a_sequence_that_swings_or_grows_has_no_order_and_thrice_its_change() {
        for values in [[1.0, 1.1, 1.04], [1.0, 1.1, 1.3]] {
            let found = extrapolate(&values, &[1.0, 2.0, 4.0], Some(2.0));
            assert_eq!((found.order, found.value), (None, values[2]));
            let largest = (values[1] - values[0]).abs().max((values[2] - values[1]).abs());
            assert!((found.uncertainty - 3.0 * largest).abs() < 1e-12);
        }
        let two = extrapolate(&[1.0, 1.1], &[1.0, 2.0], None);
        assert_eq!((two.order, two.value), (None, 1.1));
        assert!((two.uncertainty - 0.3).abs() < 1e-12);
        assert!(extrapolate(&[f64::NAN, 1.0, 1.1], &[1.0, 2.0, 4.0], None).order.is_none());
    }

    /// Answers at distances 4 and 1 in ratios of two are of order two: the last is off by 1/3, with the factor 5/12;
    /// two answers alone, or distances that grow, are doubted by three times the larger.
    #[test]
    fn distances_give_the_error_of_the_finest() {
        let n = [1.0, 2.0, 4.0];
        assert!((error_by_distances(&[4.0, 1.0], &n, None) - 1.25 / 3.0).abs() < 1e-9);
        assert!((error_by_distances(&[1.0], &n[1..], None) - 3.0).abs() < 1e-12);
        assert!((error_by_distances(&[1.0, 2.0], &n, None) - 6.0).abs() < 1e-12);
    }

    /// First order on a ratio of two, by hand: the middle value is off by 1.25 · |1.0 − 1.2|.
    #[test]
    fn the_error_of_a_coarser_value_is_its_distance_to_the_limit() {
        let found = extrapolate(&[1.4, 1.2, 1.1], &[1.0, 2.0, 4.0], None);
        assert!((found.order.unwrap() - 1.0).abs() < 1e-9);
        assert!((found.error_of(1.2) - 0.25).abs() < 1e-9);
        assert!((found.error_of(1.1) - found.uncertainty).abs() < 1e-12);
    }

    /// The last of four values breaks the sequence of the first three.
    #[test]
    fn four_values_tell_whether_the_limit_stays() {
        let n = [5.0, 10.0, 20.0, 40.0];
        let clean = sequence(1.0, 1.0, 2.0, &n);
        let steady = extrapolate(&clean, &n, None).uncertainty;
        let mut broken = clean.clone();
        broken[3] = broken[2] + 0.5 * (clean[3] - clean[2]);
        let found = extrapolate(&broken, &n, None);
        let short = extrapolate(&broken[..3], &n[..3], None).value;
        assert!(found.order.is_some() && found.uncertainty >= (found.value - short).abs());
        assert!((steady - 1.25 * (clean[3] - 1.0)).abs() < 1e-9);
    }
}
