//! 0 ≤ λ ⟂ W λ + q ≥ 0 for a symmetric positive definite W, by principal pivoting with the least index.
//!
//! For such W no set of active obstacles comes twice, so that the pivoting ends.

use nalgebra::{DMatrix, DVector};

use super::error::IntegratorError;

/// Most pivots of a problem; 2^m is the theoretical bound.
const MOST_PIVOTS: usize = 10_000;

/// `[eq:least-index-pivoting]` 0 ≤ λ ⟂ W λ + q ≥ 0 for λ (m), W (m×m) and q (m) by least-index principal pivoting.
///
/// Source: Murty, Opsearch 11 (1974) 123–130.
/// Checked by: `dynamics/src/benchmark_subjects/complementarity.rs::the_solution_is_the_only_one_of_all_sets`.
///
/// # Errors
/// If W is not positive definite on a set of active obstacles, or the pivoting does not end.
pub(super) fn solve(w: &DMatrix<f64>, q: &DVector<f64>) -> Result<DVector<f64>, IntegratorError> {
    let m = q.len();
    let failed = |why| IntegratorError::Contact { obstacles: m, why };
    // Nearly always no obstacle is touched.
    if q.iter().all(|gap| *gap >= 0.0) {
        return Ok(DVector::zeros(m));
    }
    let size = w.diagonal().max();
    let mut active = vec![false; m];
    for _ in 0..MOST_PIVOTS {
        let own: Vec<usize> = (0..m).filter(|&i| active[i]).collect();
        let mut force = DVector::zeros(m);
        if !own.is_empty() {
            let block = w.select_rows(&own).select_columns(&own);
            let factor =
                block.cholesky().ok_or(failed("two obstacles act on one and the same motion"))?;
            // W_aa λ_a = −q_a
            let solved = factor.solve(&(-q.select_rows(&own)));
            own.iter().zip(solved.iter()).for_each(|(&i, f)| force[i] = *f);
        }
        let gap = w * &force + q;
        // Gaps of inactive obstacles are judged beside the rounding of W λ.
        let rounding = 1e-13 * size * force.amax();
        let is_wrong = |i: usize| if active[i] { force[i] < 0.0 } else { gap[i] < -rounding };
        match (0..m).find(|&i| is_wrong(i)) {
            None => return Ok(force),
            Some(i) => active[i] = !active[i],
        }
    }
    Err(failed("too many pivots"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All 2^m sets are tried: exactly one satisfies the conditions, and it is the one found.
    #[test]
    fn the_solution_is_the_only_one_of_all_sets() {
        let mut seed = fastrand_like(7);
        for m in 1..=6 {
            for _ in 0..40 {
                let a = DMatrix::from_fn(m, m, |_, _| seed());
                let w = &a * a.transpose() + DMatrix::identity(m, m) * 0.1;
                let q = DVector::from_fn(m, |_, _| seed());
                let found = solve(&w, &q).unwrap();
                let gap = &w * &found + &q;
                assert!(found.iter().all(|f| *f >= 0.0) && gap.iter().all(|g| *g >= -1e-12));
                assert!(found.dot(&gap).abs() < 1e-12);
                let sets = (0..1u32 << m).filter(|set| {
                    let own: Vec<usize> = (0..m).filter(|i| set & (1 << i) != 0).collect();
                    let mut force = DVector::zeros(m);
                    if !own.is_empty() {
                        let block = w.select_rows(&own).select_columns(&own);
                        let solved = block.lu().solve(&(-q.select_rows(&own))).unwrap();
                        own.iter().zip(solved.iter()).for_each(|(&i, f)| force[i] = *f);
                    }
                    let gap = &w * &force + &q;
                    let is_one =
                        force.iter().all(|f| *f >= 0.0) && gap.iter().all(|g| *g >= -1e-12);
                    assert!(!is_one || (&force - &found).amax() < 1e-10);
                    is_one
                });
                assert_eq!(sets.count(), 1);
            }
        }
    }

    #[test]
    fn obstacles_on_one_motion_are_refused() {
        let w = DMatrix::from_element(2, 2, 1.0);
        let q = DVector::from_vec(vec![-1.0, -2.0]);
        // The lowest index first, then both at once, which has no factor.
        assert!(matches!(solve(&w, &q), Err(IntegratorError::Contact { obstacles: 2, .. })));
        // One of them is enough for the other.
        let q = DVector::from_vec(vec![-2.0, -1.0]);
        assert!((solve(&w, &q).unwrap()[0] - 2.0).abs() < 1e-14);
    }

    /// Numbers in ±1 from a linear congruence.
    fn fastrand_like(mut state: u64) -> impl FnMut() -> f64 {
        move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }
    }
}
