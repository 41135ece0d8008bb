//! Grid convergence index: discretisation error of a value, estimated from its values on three grids.

/// Lowest and highest observed order that is used.
const USABLE: [f64; 2] = [1.0, 4.0];

/// Safety factor with a usable observed order, and without.
const SAFETY: [f64; 2] = [1.25, 3.0];

/// Order assumed if the observed one is not usable: for the singular field of a point load no element
/// converges faster in the mean.
const FORMAL_ORDER: f64 = 2.0;

/// Convergence of a value over three grids.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridConvergence {
    /// Observed order of convergence p; `None` if the three values are not monotonic.
    pub order: Option<f64>,
    /// Grid convergence index of the middle grid: estimated distance of its value from the limit, as a
    /// share of the value on the fine grid.
    pub index: f64,
}

/// Grid convergence index of the middle of three grids, F_s |ε| r^p/(r^p − 1) with ε the relative change from
/// the middle to the fine grid.
///
/// `values`: on the coarse, middle and fine grid, in any unit; the last is not zero. `ratios`: refinement
/// ratios r > 1 from coarse to middle and from middle to fine.
///
/// The observed order is used with F_s = 1.25 if the values are monotonic with an order between 1 and 4;
/// otherwise, as for two grids, the order 2 with F_s = 3.
///
/// Source: Roache (1994), J. Fluids Eng. 116, 405–413; the order for unequal ratios after Celik et al.
/// (2008), J. Fluids Eng. 130, 078001, step 3.
pub fn grid_convergence_index(values: [f64; 3], ratios: [f64; 2]) -> GridConvergence {
    let [coarse, middle, fine] = values;
    let (first, second) = (middle - coarse, fine - middle);
    // With unequal ratios the order solves p = ln|ε₃₂/ε₂₁ · (r₂₁^p − 1)/(r₃₂^p − 1)|/ln r₂₁.
    let mut order = None;
    if first * second > 0.0 {
        let mut p: f64 = 2.0;
        for _ in 0..100 {
            let balance = (ratios[1].powf(p) - 1.0) / (ratios[0].powf(p) - 1.0);
            p = ((first / second * balance).abs().ln() / ratios[1].ln()).clamp(0.1, 10.0);
        }
        order = Some(p);
    }
    let usable = order.filter(|p| (USABLE[0]..=USABLE[1]).contains(p));
    let (p, safety) = usable.map_or((FORMAL_ORDER, SAFETY[1]), |p| (p, SAFETY[0]));
    // From the finer pair: the middle grid is r^p times as far from the limit as the fine one.
    let grown = ratios[1].powf(p);
    GridConvergence { order, index: safety * (second / fine).abs() * grown / (grown - 1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_known_order_is_found_and_bounds_the_error() {
        // 1 + h² at h = 2, 1.4, 1.
        let values = [2.0f64, 1.4, 1.0].map(|h| 1.0 + 0.01 * h * h);
        let found = grid_convergence_index(values, [2.0 / 1.4, 1.4]);
        assert!((found.order.unwrap() - 2.0).abs() < 1e-6);
        let (error, index) = (values[1] - 1.0, found.index);
        assert!(index > error && index < 1.4 * error, "{index} {error}");
    }

    #[test]
    fn values_that_swing_are_judged_with_care() {
        let found = grid_convergence_index([1.0, 1.01, 1.005], [1.4, 1.4]);
        assert!(found.order.is_none() && found.index > 0.02);
    }

    /// First order on a ratio of two, by hand: 1.25 · |1.1 − 1.2|/1.1 · 2/(2 − 1).
    #[test]
    fn first_order_by_hand() {
        let found = grid_convergence_index([1.4, 1.2, 1.1], [2.0, 2.0]);
        assert!((found.order.unwrap() - 1.0).abs() < 1e-9);
        assert!((found.index - 1.25 * 0.1 / 1.1 * 2.0).abs() < 1e-9);
    }
}
