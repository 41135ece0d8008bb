//! The LAPACK drivers on problems with known solutions.

use std::f64::consts::PI;

use lapack_route::{Driver, LapackError, dsygv_pairs, lapack_generalized};
use nalgebra::DMatrix;

/// Chain of n equal masses and n + 1 equal springs between two walls, and its eigenvalues
/// λ_j = 4 (k/m) sin²(jπ/2(n+1)).
fn chain(n: usize, k: f64, m: f64) -> (DMatrix<f64>, DMatrix<f64>, Vec<f64>) {
    let stiffness = DMatrix::from_fn(n, n, |i, j| match i.abs_diff(j) {
        0 => 2.0 * k,
        1 => -k,
        _ => 0.0,
    });
    let mass = DMatrix::from_diagonal_element(n, n, m);
    let exact = |j: usize| {
        let sin = (j as f64 * PI / (2.0 * (n as f64 + 1.0))).sin();
        4.0 * k / m * sin * sin
    };
    (stiffness, mass, (1..=n).map(exact).collect())
}

fn worst(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}

#[test]
fn chain_of_masses() {
    for n in [1, 2, 7, 30] {
        let (k, m, exact) = chain(n, 3.5e8, 0.66);
        for driver in Driver::ALL {
            let found = lapack_generalized(&k, &m, driver).unwrap();
            assert!(worst(&found, &exact) <= 1e-14 * n as f64 * exact[n - 1], "{driver:?} {n}");
        }
    }
}

#[test]
fn a_coupled_mass_matrix_counts_too() {
    // M = [[2, 1], [1, 2]], K = diag(3, 3): λ = 3/eig(M) = 1 and 3.
    let m = DMatrix::from_row_slice(2, 2, &[2.0, 1.0, 1.0, 2.0]);
    let k = DMatrix::from_diagonal_element(2, 2, 3.0);
    for driver in Driver::ALL {
        assert!(worst(&lapack_generalized(&k, &m, driver).unwrap(), &[1.0, 3.0]) <= 1e-14);
    }
}

#[test]
fn only_the_lower_triangles_are_read() {
    let (mut k, m, exact) = chain(5, 1.0, 1.0);
    k[(0, 3)] = 1e3;
    for driver in Driver::ALL {
        assert!(worst(&lapack_generalized(&k, &m, driver).unwrap(), &exact) <= 1e-13);
    }
}

#[test]
fn vectors_solve_the_problem_and_are_mass_normalised() {
    let (k, m, _) = chain(12, 3.5e8, 0.66);
    let pairs = dsygv_pairs(&k, &m).unwrap();
    let phi = &pairs.vectors;
    let lambda = DMatrix::from_diagonal(&pairs.values.clone().into());
    // ‖KΦ − MΦΛ‖ / ‖K‖ and ‖ΦᵀMΦ − 1‖
    assert!((&k * phi - &m * phi * lambda).norm() <= 1e-13 * k.norm());
    assert!((phi.transpose() * &m * phi - DMatrix::identity(12, 12)).norm() <= 1e-13);
}

#[test]
fn unfit_matrices_are_refused() {
    let (k, m, _) = chain(3, 1.0, 1.0);
    let nan = DMatrix::from_element(3, 3, f64::NAN);
    for driver in Driver::ALL {
        let solve = |k: &DMatrix<f64>, m: &DMatrix<f64>| lapack_generalized(k, m, driver);
        let small = DMatrix::zeros(2, 2);
        assert_eq!(solve(&k, &small), Err(LapackError::Shape { k: (3, 3), m: (2, 2) }));
        let oblong = DMatrix::zeros(2, 3);
        assert_eq!(solve(&oblong, &oblong), Err(LapackError::Shape { k: (2, 3), m: (2, 3) }));
        assert_eq!(solve(&nan, &m), Err(LapackError::NotFinite));
        assert_eq!(solve(&k, &-m.clone()), Err(LapackError::MassNotPositive));
        assert_eq!(solve(&k, &DMatrix::zeros(3, 3)), Err(LapackError::MassNotPositive));
        assert_eq!(solve(&DMatrix::zeros(0, 0), &DMatrix::zeros(0, 0)), Ok(vec![]));
    }
}
