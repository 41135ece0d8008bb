//! Kinds of modes as invariant subspaces: equal eigenvalues are grouped first, then the group's
//! subspace is split along the kinds, so that modes which merely coincide are told apart.

use std::ops::Range;

use crate::error::EigenError;
use crate::symmetric::symmetric_eigen;

/// A direction belongs to a kind if its share in the kind is at least 1 − `IMPURE`.
pub const IMPURE: f64 = 1e-6;

/// Groups of equal eigenvalues in an ascending list: neighbours that differ by no more than
/// 1e-9 λ + 1e-11 λ_max, the rounding error of eigenvalue routines at an exact multiplicity.
pub fn group_equal(lambda: &[f64]) -> Vec<Range<usize>> {
    let largest = lambda.iter().fold(0.0f64, |a, l| a.max(l.abs()));
    let mut groups = Vec::new();
    let mut start = 0;
    for i in 1..=lambda.len() {
        let splits = i == lambda.len()
            || lambda[i] - lambda[i - 1] > 1e-9 * lambda[i].abs() + 1e-11 * largest;
        if splits {
            groups.push(start..i);
            start = i;
        }
    }
    groups
}

/// Orthonormal basis of the span of `candidates` with the directions of the orthonormal `before`
/// taken out; dependent candidates are dropped.
pub fn orthonormal_basis(candidates: &[Vec<f64>], before: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut basis: Vec<Vec<f64>> = Vec::with_capacity(candidates.len());
    for candidate in candidates {
        let mut v = candidate.clone();
        let length = norm(&v);
        // Twice is enough (Kahan): the second pass removes what rounding left of the first.
        for _ in 0..2 {
            for b in before.iter().chain(&basis) {
                let along: f64 = b.iter().zip(&v).map(|(x, y)| x * y).sum();
                v.iter_mut().zip(b).for_each(|(x, y)| *x -= along * y);
            }
        }
        let left = norm(&v);
        if left > 1e-8 * length {
            v.iter_mut().for_each(|x| *x /= left);
            basis.push(v);
        }
    }
    basis
}

fn norm(v: &[f64]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// One direction of a group's subspace after splitting.
#[derive(Debug, Clone, PartialEq)]
pub struct SubspaceDirection {
    /// Coefficients on the group's basis (length m, unit length).
    pub coefficients: Vec<f64>,
    /// Index of the kind it belongs to; the kind after the last basis is "the rest". `None`: mixed.
    pub kind: Option<usize>,
    /// Squared length of its projection on each kind, the rest last; they sum to one.
    pub shares: Vec<f64>,
}

/// Splits a group's subspace along mutually orthogonal kinds and the rest of the space.
///
/// With Q the orthonormal basis of the group (n×m) and B_k that of kind k (n×d_k), `projections`
/// are the rows of B_kᵀ Q (d_k rows of length m). Pure directions come first, kind by kind; what is
/// left is mixed.
///
/// `[eq:kinds-as-subspaces]` A kind's pure directions are the eigenvectors of G_k = Qᵀ Π_k Q = (B_kᵀ Q)ᵀ (B_kᵀ Q)
/// with eigenvalue one.
/// Source: derived here.
/// Checked by: `dynamics/src/subspace.rs::coinciding_modes_of_two_kinds_are_told_apart`,
/// `dynamics/src/subspace.rs::a_direction_between_kinds_is_mixed`.
///
/// # Errors
/// If a small eigenproblem does not converge.
pub fn split(
    m: usize,
    projections: &[Vec<Vec<f64>>],
) -> Result<Vec<SubspaceDirection>, EigenError> {
    let along = |row: &Vec<f64>, c: &[f64]| row.iter().zip(c).map(|(p, x)| p * x).sum::<f64>();
    let shares_of = |c: &[f64]| {
        let share =
            |rows: &Vec<Vec<f64>>| rows.iter().map(|r| along(r, c).powi(2)).sum::<f64>().min(1.0);
        let mut shares: Vec<f64> = projections.iter().map(share).collect();
        shares.push((1.0 - shares.iter().sum::<f64>()).max(0.0));
        shares
    };
    if m == 1 {
        let shares = shares_of(&[1.0]);
        let kind = shares.iter().position(|s| *s >= 1.0 - IMPURE);
        return Ok(vec![SubspaceDirection { coefficients: vec![1.0], kind, shares }]);
    }
    // A kind's pure directions are the eigenvectors of G_k = Qᵀ Π_k Q with eigenvalue one.
    let gram = |k: usize, i: usize, j: usize| -> f64 {
        let of = |rows: &Vec<Vec<f64>>| rows.iter().map(|r| r[i] * r[j]).sum::<f64>();
        match projections.get(k) {
            Some(rows) => of(rows),
            None => f64::from(u8::from(i == j)) - projections.iter().map(of).sum::<f64>(),
        }
    };
    let mut directions: Vec<SubspaceDirection> = Vec::with_capacity(m);
    for kind in 0..=projections.len() {
        let trace: f64 = (0..m).map(|i| gram(kind, i, i)).sum();
        if trace < 1.0 - IMPURE {
            continue; // no eigenvalue can be one
        }
        let (values, vectors) = symmetric_eigen(m, |i, j| gram(kind, i, j))?;
        for j in (0..m).filter(|&j| values[j] >= 1.0 - IMPURE) {
            let coefficients: Vec<f64> = (0..m).map(|i| vectors[(i, j)]).collect();
            let shares = shares_of(&coefficients);
            directions.push(SubspaceDirection { coefficients, kind: Some(kind), shares });
        }
    }
    if directions.len() < m {
        let pure: Vec<Vec<f64>> = directions.iter().map(|d| d.coefficients.clone()).collect();
        let unit = |i: usize| (0..m).map(|j| f64::from(u8::from(i == j))).collect();
        let units: Vec<Vec<f64>> = (0..m).map(unit).collect();
        let found = orthonormal_basis(&pure, &[]);
        for coefficients in orthonormal_basis(&units, &found) {
            let shares = shares_of(&coefficients);
            directions.push(SubspaceDirection { kind: None, coefficients, shares });
        }
    }
    Ok(directions)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(n: usize, i: usize) -> Vec<f64> {
        (0..n).map(|k| f64::from(u8::from(k == i))).collect()
    }

    /// B_kᵀ Q for bases given by their vectors.
    fn projections(kinds: &[Vec<Vec<f64>>], q: &[Vec<f64>]) -> Vec<Vec<Vec<f64>>> {
        let dot = |a: &Vec<f64>, b: &Vec<f64>| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let rows = |kind: &Vec<Vec<f64>>| {
            kind.iter().map(|b| q.iter().map(|v| dot(b, v)).collect()).collect()
        };
        kinds.iter().map(rows).collect()
    }

    #[test]
    fn equal_values_are_grouped_and_near_ones_are_not() {
        let lambda = [0.0, 1.0, 1.0 + 1e-12, 1.001, 5.0];
        assert_eq!(group_equal(&lambda), [0..1, 1..3, 3..4, 4..5]);
        assert!(group_equal(&[]).is_empty());
    }

    #[test]
    fn coinciding_modes_of_two_kinds_are_told_apart() {
        // Kinds: e0 | e1, e2 | rest. The group is span{e0, e1, e3}, its basis thoroughly mixed.
        let kinds = [vec![unit(5, 0)], vec![unit(5, 1), unit(5, 2)]];
        let mix = |a: f64, b: f64, c: f64| vec![a, b, 0.0, c, 0.0];
        let mixed = [mix(1.0, 2.0, 2.0), mix(2.0, 1.0, -2.0), mix(2.0, -2.0, 1.0)];
        let q = orthonormal_basis(&mixed, &[]);
        let directions = split(q.len(), &projections(&kinds, &q)).unwrap();
        let found: Vec<_> = directions.iter().map(|d| d.kind).collect();
        assert_eq!(found, [Some(0), Some(1), Some(2)]);
        for d in &directions {
            assert!((d.shares.iter().sum::<f64>() - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn a_direction_between_kinds_is_mixed() {
        let kinds = [vec![unit(3, 0)], vec![unit(3, 1)]];
        let vectors = [vec![3.0, 4.0, 0.0], vec![0.0, 0.0, 1.0]];
        let q = orthonormal_basis(&vectors, &[]);
        let directions = split(q.len(), &projections(&kinds, &q)).unwrap();
        let found: Vec<_> = directions.iter().map(|d| d.kind).collect();
        assert_eq!(found, [Some(2), None]);
        assert!((directions[1].shares[0] - 0.36).abs() < 1e-14);
    }

    #[test]
    fn dependent_candidates_are_dropped() {
        let basis = orthonormal_basis(&[unit(3, 0), unit(3, 0), vec![0.0; 3]], &[]);
        assert_eq!(basis.len(), 1);
    }
}
