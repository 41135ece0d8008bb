//! The undamped eigenproblem of springs: K = Σ k b bᵀ, M diagonal, solved without forming K.
//!
//! An eigenvalue routine on GᵀG ([`factored_modes`]) finds ω² to a part of ω_max², so frequencies below 1e-8 ω_max
//! drown in rounding; here each keeps its own relative accuracy, whatever the spread of stiffnesses and masses: a QR
//! factorisation with column pivoting of the rows sorted by size, then one-sided Jacobi rotations. How many
//! frequencies are zero follows from the rows alone, since no positive stiffness or mass changes the null space of B.

use nalgebra::{DMatrix, DVector, SVD};

use crate::error::EigenError;
use crate::symmetric::sign_of_largest;

/// Singular values of the rows of unit length below this part of the largest belong to rigid-body motion.
const RIGID: f64 = 1e-11;

/// Sweeps of rotations; six or seven are usual.
const MOST_SWEEPS: usize = 60;

/// A spring: its stiffness k ≥ 0 and its elongation bᵀq as (coordinate, coefficient).
#[derive(Debug, Clone, PartialEq)]
pub struct SpringRow<'r> {
    /// k, N/m.
    pub stiffness: f64,
    /// b.
    pub row: &'r [(usize, f64)],
}

/// All modes of springs and masses.
#[derive(Debug, Clone)]
pub struct FactoredModes {
    /// Natural frequencies ω, ascending, rad/s; those of rigid-body motion are exactly zero.
    pub omega: Vec<f64>,
    /// What rounding may have changed of each, as a part of it; zero for rigid-body motion. The rounding of the
    /// rows' coefficients, which no algorithm can undo, is included.
    pub uncertainty: Vec<f64>,
    /// M-orthonormal mode shapes, one a column (n×n).
    pub vectors: DMatrix<f64>,
}

/// Solves K φ = ω² M φ for K = Σ k b bᵀ and M = diag(`mass`).
///
/// `[eq:factored-eigenproblem]` The natural frequencies ω are the singular values of G = diag(√k) B diag(1/√m).
/// Source: Demmel et al., Linear Algebra Appl. 299 (1999) 21–80; Drmač & Veselić, SIAM J. Matrix Anal. Appl. 29
/// (2008) 1322–1342.
/// Checked by: `dynamics/src/factored.rs::agrees_with_the_eigenvalue_routine_where_nothing_is_spread`,
/// `dynamics/src/factored.rs::small_frequencies_keep_their_digits_beside_large_ones`,
/// `lumped/tests/spread.rs::every_frequency_is_as_sure_as_it_says`.
///
/// # Errors
/// For masses that are not positive, entries that are not finite, or rotations that do not converge.
pub fn factored_modes(
    springs: &[SpringRow<'_>],
    mass: &[f64],
) -> Result<FactoredModes, EigenError> {
    let n = mass.len();
    if let Some(index) = mass.iter().position(|m| !(*m > 0.0 && m.is_finite())) {
        return Err(EigenError::Mass { index, value: mass[index] });
    }
    let acting: Vec<&SpringRow<'_>> = springs.iter().filter(|s| s.stiffness != 0.0).collect();
    for (row, spring) in acting.iter().enumerate() {
        for (column, b) in spring.row {
            let entry = spring.stiffness.sqrt() * b / mass[*column].sqrt();
            if !entry.is_finite() {
                return Err(EigenError::NotFinite { row, column: *column });
            }
        }
    }
    let rigid = rigid_motions(&acting, n)?;
    let elastic = n - rigid.len();
    // G, rows by falling size.
    let mut rows: Vec<Vec<f64>> = acting
        .iter()
        .map(|spring| {
            let mut row = vec![0.0; n];
            for (j, b) in spring.row {
                row[*j] += spring.stiffness.sqrt() * b / mass[*j].sqrt();
            }
            row
        })
        .collect();
    let size = |row: &Vec<f64>| row.iter().fold(0.0f64, |a, x| a.max(x.abs()));
    rows.sort_by(|a, b| size(b).total_cmp(&size(a)));
    rows.resize(rows.len().max(n), vec![0.0; n]);
    let g = DMatrix::from_fn(rows.len(), n, |i, j| rows[i][j]);
    // G P = Q R; the left singular vectors of Rᵀ are the right ones of G P.
    let qr = g.clone().col_piv_qr();
    let mut columns = qr.r().rows(0, n).transpose();
    rotate(&mut columns)?;
    qr.p().inv_permute_rows(&mut columns);
    let mut order: Vec<(f64, usize)> = (0..n).map(|j| (columns.column(j).norm(), j)).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut modes = FactoredModes {
        omega: vec![0.0; n],
        uncertainty: vec![0.0; n],
        vectors: DMatrix::zeros(n, n),
    };
    let root: Vec<f64> = mass.iter().map(|m| m.sqrt()).collect();
    for (place, motion) in orthonormal(&rigid, &root).into_iter().enumerate() {
        modes.vectors.set_column(place, &motion);
    }
    for (place, (omega, j)) in order.into_iter().enumerate().skip(n - elastic) {
        if omega <= 0.0 {
            // The rows say that this motion is elastic, and nothing is left of its stiffness.
            return Err(EigenError::Residual { residual: 1.0, limit: 0.0, size: n });
        }
        let v = columns.column(j) / omega;
        // Rayleigh's quotient ‖G v‖ takes the error of v in second order only; what it differs by from the length of
        // the rotated column shows the size of what the factorisation did; twice that is what is said of it.
        let quotient = (&g * &v).norm();
        modes.omega[place] = quotient.min(omega);
        modes.uncertainty[place] =
            uncertainty(&g, &v, omega) + 2.0 * (quotient - omega).abs() / quotient.min(omega);
        modes.vectors.set_column(place, &v);
    }
    for j in 0..n {
        let mut column = modes.vectors.column_mut(j);
        let sign = sign_of_largest(column.iter().copied());
        // φ = M^-½ v
        column.iter_mut().zip(&root).for_each(|(x, root)| *x *= sign / root);
    }
    Ok(modes)
}

/// What rounding may change of ω = ‖G v‖, as a part of it.
///
/// Entries of G are good to some ε, so that u = G v/ω changes ω by uᵀ δG v ≤ ε |u|ᵀ|G||v| to first order; to second
/// order a stiff spring that ought not to stretch at all takes up energy, ½ (ε |G||v|)²/ω².
fn uncertainty(g: &DMatrix<f64>, v: &DVector<f64>, omega: f64) -> f64 {
    // Sums of n terms after about as many rotations.
    let part = 4.0 * g.ncols() as f64 * f64::EPSILON;
    let (mut first, mut second) = (0.0, 0.0);
    for row in g.row_iter() {
        let stretched: f64 = row.iter().zip(v.iter()).map(|(g, v)| g * v).sum();
        let terms: f64 = row.iter().zip(v.iter()).map(|(g, v)| (g * v).abs()).sum();
        first += (stretched.abs() / omega) * terms / omega;
        second += (terms / omega).powi(2);
    }
    part * first + part * part * second
}

/// Orthonormal basis of the displacements that stretch no spring.
fn rigid_motions(springs: &[&SpringRow<'_>], n: usize) -> Result<Vec<DVector<f64>>, EigenError> {
    let mut unit = DMatrix::zeros(springs.len().max(n), n);
    for (i, spring) in springs.iter().enumerate() {
        let length = spring.row.iter().map(|(_, b)| b * b).sum::<f64>().sqrt();
        for (j, b) in spring.row.iter().filter(|_| length > 0.0) {
            unit[(i, *j)] += b / length;
        }
    }
    let solved = SVD::try_new(unit, false, true, f64::EPSILON, 100 * n.max(10))
        .ok_or(EigenError::NoConvergence { size: n })?;
    let Some(right) = solved.v_t else { return Err(EigenError::NoConvergence { size: n }) };
    let largest = solved.singular_values.max();
    let is_rigid = |j: &usize| solved.singular_values[*j] <= RIGID * largest;
    Ok((0..n).filter(is_rigid).map(|j| right.row(j).transpose()).collect())
}

/// M^½ times some independent motions, orthonormal.
fn orthonormal(motions: &[DVector<f64>], root: &[f64]) -> Vec<DVector<f64>> {
    let mut basis: Vec<DVector<f64>> = Vec::with_capacity(motions.len());
    for motion in motions {
        let mut v = DVector::from_fn(root.len(), |i, _| motion[i] * root[i]);
        // Twice is enough (Kahan): the second pass removes what rounding left of the first.
        for _ in 0..2 {
            for b in &basis {
                let along = b.dot(&v);
                v.axpy(-along, b, 1.0);
            }
        }
        basis.push(v.normalize());
    }
    basis
}

/// One-sided Jacobi: turns pairs of columns until all are orthogonal to rounding, each pair judged by its own
/// lengths, so that short columns keep their relative accuracy.
fn rotate(columns: &mut DMatrix<f64>) -> Result<(), EigenError> {
    let n = columns.ncols();
    let orthogonal = f64::EPSILON * (n as f64).sqrt();
    for _ in 0..MOST_SWEEPS {
        let mut turned = false;
        for i in 0..n {
            for j in i + 1..n {
                let (a, b) = (columns.column(i).norm(), columns.column(j).norm());
                if a == 0.0 || b == 0.0 {
                    continue;
                }
                // cos of the angle between the columns; scaled first, so that no product underflows.
                let cosine: f64 = columns
                    .column(i)
                    .iter()
                    .zip(columns.column(j).iter())
                    .map(|(x, y)| x / a * (y / b))
                    .sum();
                if cosine.abs() <= orthogonal {
                    continue;
                }
                turned = true;
                // ζ = (b² − a²)/(2 a·b), t = sign ζ/(|ζ| + √(1 + ζ²))
                let zeta = (b / a - a / b) / (2.0 * cosine);
                let t = zeta.signum() / (zeta.abs() + 1.0f64.hypot(zeta));
                let c = 1.0 / 1.0f64.hypot(t);
                let s = c * t;
                for k in 0..n {
                    let (x, y) = (columns[(k, i)], columns[(k, j)]);
                    columns[(k, i)] = c * x - s * y;
                    columns[(k, j)] = s * x + c * y;
                }
            }
        }
        if !turned {
            return Ok(());
        }
    }
    Err(EigenError::NoConvergence { size: n })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::symmetric::generalized_symmetric;

    fn springs<'r>(list: &'r [(f64, Vec<(usize, f64)>)]) -> Vec<SpringRow<'r>> {
        list.iter().map(|(stiffness, row)| SpringRow { stiffness: *stiffness, row }).collect()
    }

    /// Chain of masses on springs, one end fixed or free.
    fn chain(n: usize, k: impl Fn(usize) -> f64, fixed: bool) -> Vec<(f64, Vec<(usize, f64)>)> {
        let mut list: Vec<(f64, Vec<(usize, f64)>)> =
            (1..n).map(|i| (k(i), vec![(i - 1, -1.0), (i, 1.0)])).collect();
        if fixed {
            list.push((k(0), vec![(0, 1.0)]));
        }
        list
    }

    #[test]
    fn agrees_with_the_eigenvalue_routine_where_nothing_is_spread() {
        let list = chain(20, |i| 1e8 * (1.0 + 0.1 * i as f64), true);
        let mass: Vec<f64> = (0..20).map(|i| 0.5 + 0.05 * i as f64).collect();
        let found = factored_modes(&springs(&list), &mass).unwrap();
        let mut k = DMatrix::zeros(20, 20);
        for (stiffness, row) in &list {
            for (i, a) in row {
                for (j, b) in row {
                    k[(*i, *j)] += stiffness * a * b;
                }
            }
        }
        let known = generalized_symmetric(&k, &mass).unwrap();
        for j in 0..20 {
            assert!((found.omega[j].powi(2) / known.lambda[j] - 1.0).abs() < 1e-11, "{j}");
            assert!(found.uncertainty[j] < 1e-12);
            let shape = found.vectors.column(j) - known.vectors.column(j);
            assert!(shape.amax() < 1e-10 * known.vectors.column(j).amax(), "{j}");
        }
    }

    /// Two masses: ω₁² ω₂² = det K/(m₁ m₂) and ω₁² + ω₂² = tr M⁻¹K hold to rounding over 24 decades.
    #[test]
    fn small_frequencies_keep_their_digits_beside_large_ones() {
        for (soft, stiff, light) in [(1.0, 1e24, 1.0), (1e3, 1e17, 1e-8), (1e-6, 1e18, 1e-12)] {
            let list = [(soft, vec![(0, 1.0)]), (stiff, vec![(0, -1.0), (1, 1.0)])];
            let mass = [3.0, light];
            let found = factored_modes(&springs(&list), &mass).unwrap();
            // The sum of the squares is that of the stiff spring to rounding; the product is exact.
            let high = stiff * (1.0 / mass[0] + 1.0 / mass[1]) + soft / mass[0];
            let low = soft * stiff / (mass[0] * mass[1]) / high;
            let want = [low.sqrt(), high.sqrt()];
            for (found, want) in found.omega.iter().zip(want) {
                assert!(
                    (found / want - 1.0).abs() < 1e-13,
                    "{soft} {stiff} {light}: {found} {want}"
                );
            }
            // The bound allows for springs that only seem to be redundant: (ε ω_max/ω_min)² at most.
            assert!(found.uncertainty.iter().all(|u| *u < 1e-4));
        }
    }

    #[test]
    fn rigid_motion_is_exactly_zero_and_soft_motion_is_not() {
        let free = chain(6, |i| f64::powi(1e3, i as i32), false);
        let found = factored_modes(&springs(&free), &[1e-6, 1.0, 1e3, 1.0, 2.0, 5.0]).unwrap();
        assert_eq!(found.omega[0], 0.0);
        assert!(found.omega[1] > 0.0);
        let shape = found.vectors.column(0);
        assert!(shape.iter().all(|x| (x / shape[0] - 1.0).abs() < 1e-12));
        let mut held = free.clone();
        held.push((1e-9, vec![(0, 1.0)]));
        let found = factored_modes(&springs(&held), &[1e-6, 1.0, 1e3, 1.0, 2.0, 5.0]).unwrap();
        // A rigid body of the total mass on the soft spring: ω² = k/Σm.
        let want = (1e-9f64 / 1009.000001).sqrt();
        assert!((found.omega[0] / want - 1.0).abs() < 1e-12, "{} {want}", found.omega[0]);
        assert!(found.uncertainty[0] < 1e-3);
    }

    #[test]
    fn bad_input_is_refused() {
        let list = chain(2, |_| 1.0, true);
        let refused = factored_modes(&springs(&list), &[1.0, 0.0]);
        assert!(matches!(refused, Err(EigenError::Mass { index: 1, .. })));
        let list = [(f64::NAN, vec![(0, 1.0)])];
        let refused = factored_modes(&springs(&list), &[1.0]);
        assert!(matches!(refused, Err(EigenError::NotFinite { .. })));
    }
}
