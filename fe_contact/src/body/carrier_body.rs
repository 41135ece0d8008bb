//! The carrier on its rigid bore: flexibility between the pin seats.

use std::sync::Arc;

use faer::Mat;
use nalgebra::DMatrix;

use gearset::CarrierInput;

use super::assembly::{Factor, Triplets};
use super::matrices::BodyMatrices;
use crate::element::matrices;
use crate::error::FeError;
use crate::fe_mesh::{FeCarrierMesh, Hold};
use crate::material::Elastic;

/// Finite-element body of the carrier whose bore stands still.
#[derive(Debug, Clone)]
pub struct CarrierBody {
    /// Its mesh.
    pub mesh: FeCarrierMesh,
    /// Mass, the seats filled with material, kg.
    pub mass: f64,
    /// Polar inertia about the centre, kg m².
    pub inertia: f64,
    /// Degrees of freedom, three for each seat among them.
    pub unknowns: usize,
    /// Displacement of the seats under unit forces on them, 2N×2N: radial and tangential of each
    /// planet in turn, m/N.
    pub flexibility: DMatrix<f64>,
    /// Matrices between bore and the rest.
    pub matrices: BodyMatrices,
    /// Their stiffness, factorised.
    pub(crate) factor: Arc<Factor>,
    /// First of each seat's three degrees of freedom (x, y, θ about its centre).
    pub seat_unknown: Vec<usize>,
    /// Whether it is taken as rigid.
    pub is_rigid: bool,
    /// ψ of each seat, rad.
    psi: Vec<f64>,
}

/// A node's displacement as a sum over unknowns: (unknown, coefficient).
type Terms = Vec<(usize, f64)>;

impl CarrierBody {
    /// Displacement of a seat along a unit force on it, mean over seats and their radial and tangential
    /// directions, m/N.
    pub fn mean_seat_flexibility(&self) -> f64 {
        self.flexibility.trace() / self.flexibility.nrows() as f64
    }

    /// Meshes and solves the carrier for planets at ψ (rad).
    ///
    /// `[eq:carrier-flexibility]` u = U + θ × (p − c) for the nodes p of a rigid seat about its centre c;
    /// A = displacements of all seats under unit forces on them, with the bore held.
    /// Source: derived here.
    /// Checked by: `fe_contact/tests/fidelity.rs::a_ring_on_springs_and_a_rigid_carrier`,
    /// `fe_contact/tests/fidelity.rs::full_bodies_turn_as_quasi_static_ones`,
    /// `validation/tests/closed_forms.rs::closed_forms_hold_on_shipped_sets`.
    ///
    /// # Errors
    /// If an element is distorted or the stiffness is not positive definite.
    pub fn new(
        input: &CarrierInput,
        center_distance: f64,
        psi: &[f64],
        material: &Elastic,
        face_width: f64,
    ) -> Result<Self, FeError> {
        let mesh = FeCarrierMesh::new(input, center_distance, psi);
        let mut next = 0;
        let mut take = |count: usize| {
            next += count;
            next - count
        };
        let seat_unknown: Vec<usize> = mesh.seats.iter().map(|_| take(3)).collect();
        let terms: Vec<[Terms; 2]> = mesh
            .holds
            .iter()
            .zip(&mesh.points)
            .map(|(hold, p)| match *hold {
                Hold::Race => [Vec::new(), Vec::new()],
                Hold::Free => {
                    let first = take(2);
                    [vec![(first, 1.0)], vec![(first + 1, 1.0)]]
                }
                Hold::Seat(n) => {
                    let (first, c) = (seat_unknown[n], mesh.seats[n]);
                    [
                        vec![(first, 1.0), (first + 2, c[1] - p[1])],
                        vec![(first + 1, 1.0), (first + 2, p[0] - c[0])],
                    ]
                }
            })
            .collect();
        let shape = FeCarrierMesh::shape();
        let (mut stiffness, mut masses) = (Triplets::default(), Triplets::default());
        let mut coupling = [(); 3].map(|()| vec![0.0; next]);
        for (i, nodes) in mesh.elements.iter().enumerate() {
            let nodes = &nodes[..shape.count()];
            let points: Vec<_> = nodes.iter().map(|n| mesh.points[*n]).collect();
            let own = matrices(&shape, &points, material, face_width, false)
                .map_err(|cause| FeError::Distorted { body: "carrier", element: i, cause })?;
            for (a, node_a) in nodes.iter().enumerate() {
                for (b, node_b) in nodes.iter().enumerate() {
                    // Rigid motion of node b with the bore: x, y, θ.
                    let [x, y] = mesh.points[*node_b];
                    let rigid = [[1.0, 0.0, -y], [0.0, 1.0, x]];
                    for r in 0..2 {
                        for (row, p) in &terms[*node_a][r] {
                            for c in 0..2 {
                                let (k, m) = (
                                    own.stiffness[(2 * a + r, 2 * b + c)],
                                    own.mass[(2 * a + r, 2 * b + c)],
                                );
                                for (column, q) in &terms[*node_b][c] {
                                    stiffness.add(*row, *column, p * q * k);
                                    masses.add(*row, *column, p * q * m);
                                }
                                for (k, moved) in rigid[c].iter().enumerate() {
                                    coupling[k][*row] += p * m * moved;
                                }
                            }
                        }
                    }
                }
            }
        }
        // The seats are filled with material.
        let r = input.pin_seat_radius_m;
        let filling = material.density * face_width * std::f64::consts::PI * r * r;
        for (first, [x, y]) in seat_unknown.iter().zip(&mesh.seats) {
            for k in 0..3 {
                let own = if k == 2 { 0.5 * filling * r * r } else { filling };
                masses.add(first + k, first + k, own);
            }
            coupling[0][*first] += filling;
            coupling[1][first + 1] += filling;
            coupling[2][*first] -= filling * y;
            coupling[2][first + 1] += filling * x;
            coupling[2][first + 2] += 0.5 * filling * r * r;
        }
        let stiffness = stiffness.matrix(next, "carrier")?;
        let factor = Arc::new(stiffness.factorise("carrier")?);
        let matrices =
            BodyMatrices { stiffness, mass: masses.matrix(next, "carrier")?, coupling, size: next };
        let count = psi.len();
        // Unit forces radially and tangentially on each seat.
        let direction = |n: usize, k: usize| {
            let (sin, cos) = psi[n].sin_cos();
            if k == 0 { [cos, sin] } else { [-sin, cos] }
        };
        let mut right = Mat::zeros(next, 2 * count);
        for n in 0..count {
            for k in 0..2 {
                let d = direction(n, k);
                right[(seat_unknown[n], 2 * n + k)] = d[0];
                right[(seat_unknown[n] + 1, 2 * n + k)] = d[1];
            }
        }
        factor.solve(&mut right);
        let mut flexibility = DMatrix::from_fn(2 * count, 2 * count, |row, column| {
            let (n, d) = (row / 2, direction(row / 2, row % 2));
            d[0] * right[(seat_unknown[n], column)] + d[1] * right[(seat_unknown[n] + 1, column)]
        });
        if input.is_rigid {
            flexibility.fill(0.0);
        }
        // Mass and inertia are those of the whole annulus, its seats filled with material.
        let [r, s] = [input.bore_radius_m, input.outer_radius_m].map(|r| r * r);
        let mass = material.density * face_width * std::f64::consts::PI * (s - r);
        Ok(Self {
            mesh,
            mass,
            inertia: 0.5 * mass * (r + s),
            unknowns: next,
            flexibility,
            matrices,
            factor,
            seat_unknown,
            is_rigid: input.is_rigid,
            psi: psi.to_vec(),
        })
    }

    /// Radial (0) or tangential (1) displacement of a seat as a sum over degrees of freedom.
    pub fn seat_terms(&self, n: usize, axis: usize) -> [(usize, f64); 2] {
        let (sin, cos) = self.psi[n].sin_cos();
        let d = if axis == 0 { [cos, sin] } else { [-sin, cos] };
        [(self.seat_unknown[n], d[0]), (self.seat_unknown[n] + 1, d[1])]
    }
}
