//! The direction in which motions leave a bifurcation.

use dynamics::MapDerivative;
use nalgebra::DMatrix;

/// Eigenvector of DΦ to the multiplier nearest to `multiplier` (±1): the right singular vector to the least singular
/// value of S⁻¹ (DΦ − μ I) S, S the `scales` of the coordinates. `None` if the derivative is not finite.
pub(super) fn critical_direction(
    map: &MapDerivative,
    multiplier: f64,
    scales: &[f64],
) -> Option<Vec<f64>> {
    let n = scales.len();
    let mut matrix = DMatrix::<f64>::identity(n, n) * -multiplier;
    for (k, active) in map.active.iter().enumerate() {
        for i in 0..n {
            matrix[(i, *active)] += map.columns[(i, k)] * scales[*active] / scales[i];
        }
    }
    if !matrix.iter().all(|x| x.is_finite()) {
        return None;
    }
    let found = matrix.svd(false, true);
    let (least, _) = found.singular_values.argmin();
    let vectors = found.v_t?;
    Some(vectors.row(least).iter().zip(scales).map(|(v, s)| v * s).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// [[−1, 2], [0, 0.5]] in coordinates of sizes 1 and 100, and one without influence: (1, 0, w) to −1.
    #[test]
    fn the_eigenvector_to_minus_one_is_found_in_any_scales() {
        let columns = DMatrix::from_row_slice(3, 2, &[-1.0, 2.0, 0.0, 0.5, 3.0, 4.0]);
        let map = MapDerivative { active: vec![0, 1], columns, scales: vec![1.0; 3] };
        for scales in [[1.0, 1.0, 1.0], [1.0, 100.0, 0.01]] {
            let v = critical_direction(&map, -1.0, &scales).unwrap();
            assert!((v[1] / v[0]).abs() < 1e-12, "{v:?}");
            // DΦ v = −v in the last row: 3 v₀ = −v₂.
            assert!((v[2] / v[0] + 3.0).abs() < 1e-12, "{v:?}");
        }
    }
}
