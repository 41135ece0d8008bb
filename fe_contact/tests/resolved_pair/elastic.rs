//! Plane strain: stiffness of biquadratic elements, and what unit forces on a flank move.

use faer::prelude::Solve;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Mat, Side};

use crate::mesh::Mesh;

/// Points and weights of Gauss's rule of three points on −1…1.
pub(crate) const GAUSS: [(f64, f64); 3] =
    [(-0.774_596_669_241_483_4, 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0)];

/// Lagrange's parabolas on −1, 0, 1 and their derivatives.
pub(crate) fn parabolas(x: f64) -> ([f64; 3], [f64; 3]) {
    ([0.5 * x * (x - 1.0), 1.0 - x * x, 0.5 * x * (x + 1.0)], [x - 0.5, -2.0 * x, x + 0.5])
}

/// E in MPa and ν.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Elastic {
    pub(crate) young: f64,
    pub(crate) poisson: f64,
}

impl Elastic {
    /// Stiffness of an element 1 mm thick, 18 × 18, N/mm.
    ///
    /// # Panics
    /// If the element is turned inside out.
    pub(crate) fn stiffness(self, corners: [[f64; 2]; 9]) -> [[f64; 18]; 18] {
        let lame = self.young * self.poisson / ((1.0 + self.poisson) * (1.0 - 2.0 * self.poisson));
        let shear = 0.5 * self.young / (1.0 + self.poisson);
        let mut k = [[0.0; 18]; 18];
        for (x, wx) in GAUSS {
            for (y, wy) in GAUSS {
                let ((nx, dx), (ny, dy)) = (parabolas(x), parabolas(y));
                let local: [[f64; 2]; 9] =
                    std::array::from_fn(|i| [dx[i % 3] * ny[i / 3], nx[i % 3] * dy[i / 3]]);
                // J_ab = ∂x_a/∂ξ_b.
                let mut j = [[0.0; 2]; 2];
                for (p, d) in corners.iter().zip(&local) {
                    for a in 0..2 {
                        for b in 0..2 {
                            j[a][b] += p[a] * d[b];
                        }
                    }
                }
                let det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
                assert!(det > 0.0, "element turned inside out at {:?}", corners[4]);
                let gradient: [[f64; 2]; 9] = local.map(|d| {
                    [
                        (d[0] * j[1][1] - d[1] * j[1][0]) / det,
                        (d[1] * j[0][0] - d[0] * j[0][1]) / det,
                    ]
                });
                let w = wx * wy * det;
                // ∫ λ div u div v + 2 µ ε(u):ε(v).
                for (m, g) in gradient.iter().enumerate() {
                    for (n, h) in gradient.iter().enumerate() {
                        let dot = g[0] * h[0] + g[1] * h[1];
                        for a in 0..2 {
                            for b in 0..2 {
                                let same = if a == b { dot } else { 0.0 };
                                k[2 * m + a][2 * n + b] +=
                                    w * (lame * g[a] * h[b] + shear * (same + g[b] * h[a]));
                            }
                        }
                    }
                }
            }
        }
        k
    }
}

/// Displacements of flank nodes under unit forces on flank nodes of the loaded tooth, both in the tooth's own frame,
/// mm for 1 N per mm of face.
pub(crate) struct Flexibility {
    /// Flanks: tooth and number of its nodes.
    pub(crate) teeth: Vec<(i32, usize)>,
    /// Of every flank: rows 2·node + direction, columns the same of the loaded tooth.
    pub(crate) of: Vec<Mat<f64>>,
}

/// Right-hand sides solved at once.
const AT_ONCE: usize = 64;

impl Flexibility {
    /// Solves for every node of the loaded flank with arc fractions in `range`; the bore is held.
    pub(crate) fn new(mesh: &Mesh, elastic: Elastic, pitch: f64, range: [f64; 2]) -> Self {
        let n = mesh.nodes.len();
        let mut unknown = vec![0; n];
        for &held in &mesh.bore {
            unknown[held] = usize::MAX;
        }
        let mut count = 0;
        for u in unknown.iter_mut().filter(|u| **u != usize::MAX) {
            *u = count;
            count += 1;
        }
        let mut entries = Vec::new();
        for element in &mesh.elements {
            let k = elastic.stiffness(element.map(|i| mesh.nodes[i]));
            for (row, line) in k.iter().enumerate() {
                for (column, value) in line.iter().enumerate() {
                    let at = |i: usize| (unknown[element[i / 2]], i % 2);
                    let ((r, a), (c, b)) = (at(row), at(column));
                    if r == usize::MAX || c == usize::MAX || 2 * r + a < 2 * c + b {
                        continue;
                    }
                    entries.push(Triplet::new(2 * r + a, 2 * c + b, *value));
                }
            }
        }
        let lower =
            SparseColMat::<usize, f64>::try_new_from_triplets(2 * count, 2 * count, &entries)
                .expect("entries within the matrix");
        drop(entries);
        let symbolic = SymbolicLlt::try_new(lower.symbolic(), Side::Lower).expect("memory");
        let factor =
            Llt::try_new_with_symbolic(symbolic, lower.as_ref(), Side::Lower).expect("held body");
        let (_, loaded) = mesh.flanks.iter().find(|f| f.0 == 0).expect("a loaded tooth");
        let last = loaded.len() - 1;
        let within = |i: &usize| (range[0]..=range[1]).contains(&(*i as f64 / last as f64));
        let columns: Vec<usize> =
            (0..=last).filter(within).flat_map(|i| [2 * i, 2 * i + 1]).collect();
        let teeth: Vec<(i32, usize)> = mesh.flanks.iter().map(|f| (f.0, f.1.len())).collect();
        let empty =
            |&(_, nodes): &(i32, usize)| Mat::from_fn(2 * nodes, 2 * last + 2, |_, _| f64::NAN);
        let mut of: Vec<Mat<f64>> = teeth.iter().map(empty).collect();
        for some in columns.chunks(AT_ONCE) {
            let mut right = Mat::<f64>::zeros(2 * count, some.len());
            for (k, &column) in some.iter().enumerate() {
                right[(2 * unknown[loaded[column / 2]] + column % 2, k)] = 1.0;
            }
            factor.solve_in_place(right.as_mut());
            for ((tooth, nodes), of) in mesh.flanks.iter().zip(&mut of) {
                let [c, s] = crate::gear::unit(f64::from(*tooth) * pitch);
                for (i, &node) in nodes.iter().enumerate() {
                    for (k, &column) in some.iter().enumerate() {
                        let at = 2 * unknown[node];
                        let (x, y) = (right[(at, k)], right[(at + 1, k)]);
                        of[(2 * i, column)] = c * x + s * y;
                        of[(2 * i + 1, column)] = c * y - s * x;
                    }
                }
            }
        }
        Self { teeth, of }
    }

    /// Displacement of flank places of tooth `tooth` against forces on the loaded one: aᵀ F b for nodal weights.
    pub(crate) fn work(&self, tooth: i32, a: &[(usize, [f64; 2])], b: &[(usize, [f64; 2])]) -> f64 {
        let which = self.teeth.iter().position(|t| t.0 == tooth).expect("a neighbouring tooth");
        let matrix = &self.of[which];
        let mut sum = 0.0;
        for &(i, p) in a {
            for &(j, q) in b {
                for (k, p) in p.iter().enumerate() {
                    for (l, q) in q.iter().enumerate() {
                        sum += p * q * matrix[(2 * i + k, 2 * j + l)];
                    }
                }
            }
        }
        sum
    }

    /// Number of elements along a tooth's flank.
    pub(crate) fn elements(&self, tooth: i32) -> usize {
        self.teeth.iter().find(|t| t.0 == tooth).map_or(0, |t| (t.1 - 1) / 2)
    }
}
