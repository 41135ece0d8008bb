//! Stiffness and consistent mass of one quadrilateral.

use nalgebra::DMatrix;

use super::shape::{Shape, Values};
use crate::material::Elastic;

/// Stiffness and mass of one element, both (2·count)×(2·count), x and y of each function in turn.
#[derive(Debug, Clone)]
pub struct ElementMatrices {
    /// K, N/m (of the given thickness).
    pub stiffness: DMatrix<f64>,
    /// M, kg.
    pub mass: DMatrix<f64>,
    /// Smallest det J over the largest, of the integration points.
    pub jacobian_ratio: f64,
}

/// An element turned inside out.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "det J = {determinant:e} m² at (ξ, η) = ({xi:.3}, {eta:.3}): the element is turned inside out"
)]
pub struct DistortedElement {
    /// det J.
    pub determinant: f64,
    /// ξ.
    pub xi: f64,
    /// η.
    pub eta: f64,
}

const GAUSS_2: [(f64, f64); 2] = [(-0.577_350_269_189_625_8, 1.0), (0.577_350_269_189_625_8, 1.0)];
const GAUSS_3: [(f64, f64); 3] =
    [(-0.774_596_669_241_483_4, 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0)];
const GAUSS_4: [(f64, f64); 4] = [
    (-0.861_136_311_594_052_6, 0.347_854_845_137_453_9),
    (-0.339_981_043_584_856_3, 0.652_145_154_862_546_1),
    (0.339_981_043_584_856_3, 0.652_145_154_862_546_1),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_9),
];

fn rule(shape: &Shape) -> &'static [(f64, f64)] {
    use super::shape::Edge;
    if shape.edges.contains(&Edge::Hermite) {
        &GAUSS_4
    } else if shape.is_linear() {
        &GAUSS_2
    } else {
        &GAUSS_3
    }
}

/// J and the derivatives in x and y, at one point.
struct Mapped {
    values: Values,
    determinant: f64,
    /// J⁻¹ rows: ∂ξ/∂x, ∂η/∂x; ∂ξ/∂y, ∂η/∂y.
    inverse: [[f64; 2]; 2],
}

impl Mapped {
    fn at(shape: &Shape, points: &[[f64; 2]], xi: f64, eta: f64) -> Self {
        let values = shape.at(xi, eta);
        let mut j = [[0.0; 2]; 2];
        for (i, p) in points.iter().enumerate() {
            for k in 0..2 {
                j[0][k] += values.dxi[i] * p[k];
                j[1][k] += values.deta[i] * p[k];
            }
        }
        let determinant = j[0][0] * j[1][1] - j[0][1] * j[1][0];
        let inverse = [
            [j[1][1] / determinant, -j[0][1] / determinant],
            [-j[1][0] / determinant, j[0][0] / determinant],
        ];
        Self { values, determinant, inverse }
    }

    fn gradient(&self, dxi: f64, deta: f64) -> [f64; 2] {
        // ∂/∂x = ∂ξ/∂x ∂/∂ξ + ∂η/∂x ∂/∂η; J maps (∂x, ∂y) to (∂ξ, ∂η), so J⁻¹ maps back.
        let j = &self.inverse;
        [j[0][0] * dxi + j[0][1] * deta, j[1][0] * dxi + j[1][1] * deta]
    }
}

/// Adds w Bᵢᵀ D Bⱼ for two gradients, B = [∂x 0; 0 ∂y; ∂y ∂x].
fn couple(d: &[[f64; 3]; 3], a: [f64; 2], b: [f64; 2]) -> [[f64; 2]; 2] {
    [
        [
            a[0] * d[0][0] * b[0] + a[1] * d[2][2] * b[1],
            a[0] * d[0][1] * b[1] + a[1] * d[2][2] * b[0],
        ],
        [
            a[1] * d[1][0] * b[0] + a[0] * d[2][2] * b[1],
            a[1] * d[1][1] * b[1] + a[0] * d[2][2] * b[0],
        ],
    ]
}

/// Stiffness and mass of an element with generalised nodes `points` (positions, and arc-length
/// derivatives of position for Hermite functions).
///
/// `incompatible` adds the bending modes 1 − ξ², 1 − η², with their gradients taken at the centre so that the patch
/// test holds, and condenses them.
///
/// `[eq:element-matrices]` K = ∫ Bᵀ D B dA, M = ρ ∫ Nᵀ N dA, B = [∂x 0; 0 ∂y; ∂y ∂x]; incompatible modes with their
/// stiffness H and coupling G leave K − Gᵀ H⁻¹ G.
/// Source: Taylor, Beresford & Wilson, Int. J. Numer. Methods Eng. 10 (1976) 1211–1219.
/// Checked by: `fe_contact/tests/elements.rs::three_rigid_motions_and_no_other_free_one`,
/// `fe_contact/tests/elements.rs::the_plain_quadrilateral_locks_in_bending_and_the_others_do_not`.
///
/// # Errors
/// If det J is not positive at an integration point.
pub fn matrices(
    shape: &Shape,
    points: &[[f64; 2]],
    material: &Elastic,
    thickness: f64,
    incompatible: bool,
) -> Result<ElementMatrices, DistortedElement> {
    let n = shape.count();
    let d = material.stiffness();
    let mut stiffness = DMatrix::<f64>::zeros(2 * n, 2 * n);
    let mut mass = DMatrix::<f64>::zeros(2 * n, 2 * n);
    let mut coupling = DMatrix::<f64>::zeros(4, 2 * n);
    let mut inner = DMatrix::<f64>::zeros(4, 4);
    let (mut least, mut most) = (f64::INFINITY, 0.0f64);
    let centre = Mapped::at(shape, points, 0.0, 0.0);
    let gauss = rule(shape);
    for &(xi, w_xi) in gauss {
        for &(eta, w_eta) in gauss {
            let at = Mapped::at(shape, points, xi, eta);
            let determinant = at.determinant;
            if determinant.is_nan() || determinant <= 0.0 {
                return Err(DistortedElement { determinant, xi, eta });
            }
            least = least.min(determinant);
            most = most.max(determinant);
            let weight = w_xi * w_eta * determinant * thickness;
            let mut gradients = [[0.0; 2]; super::MOST];
            for (i, g) in gradients.iter_mut().enumerate().take(n) {
                *g = at.gradient(at.values.dxi[i], at.values.deta[i]);
            }
            for i in 0..n {
                for j in 0..n {
                    let block = couple(&d, gradients[i], gradients[j]);
                    let inertia = weight * material.density * at.values.n[i] * at.values.n[j];
                    for r in 0..2 {
                        for c in 0..2 {
                            stiffness[(2 * i + r, 2 * j + c)] += weight * block[r][c];
                        }
                        mass[(2 * i + r, 2 * j + r)] += inertia;
                    }
                }
            }
            if incompatible {
                // ∇(1 − ξ²) = −2ξ ∇ξ, by the centre's Jacobian, scaled by det J₀/det J.
                let scale = centre.determinant / determinant;
                let modes = [(-2.0 * xi, 0.0), (0.0, -2.0 * eta)]
                    .map(|(a, b)| centre.gradient(a, b).map(|g| g * scale));
                for (m, &gm) in modes.iter().enumerate() {
                    for (j, &gj) in gradients.iter().enumerate().take(n) {
                        let block = couple(&d, gm, gj);
                        for r in 0..2 {
                            for c in 0..2 {
                                coupling[(2 * m + r, 2 * j + c)] += weight * block[r][c];
                            }
                        }
                    }
                    for (k, &gk) in modes.iter().enumerate() {
                        let block = couple(&d, gm, gk);
                        for r in 0..2 {
                            for c in 0..2 {
                                inner[(2 * m + r, 2 * k + c)] += weight * block[r][c];
                            }
                        }
                    }
                }
            }
        }
    }
    if incompatible {
        let solved = inner.cholesky().map(|c| c.solve(&coupling)).ok_or(DistortedElement {
            determinant: least,
            xi: 0.0,
            eta: 0.0,
        })?;
        stiffness -= coupling.transpose() * solved;
    }
    Ok(ElementMatrices { stiffness, mass, jacobian_ratio: least / most })
}
