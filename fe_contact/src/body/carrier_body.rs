//! The carrier on its rigid bore: flexibility between the pin seats.

use faer::Mat;
use nalgebra::DMatrix;

use gearset::CarrierInput;

use super::assembly::Triplets;
use crate::element::matrices;
use crate::error::FeError;
use crate::material::Elastic;
use crate::mesh::{CarrierMesh, Hold};

/// Finite-element body of the carrier whose bore stands still.
#[derive(Debug, Clone)]
pub struct CarrierBody {
    /// Its mesh.
    pub mesh: CarrierMesh,
    /// Mass, the seats filled with material, kg.
    pub mass: f64,
    /// Polar inertia about the centre, kg m².
    pub inertia: f64,
    /// Degrees of freedom, three for each seat among them.
    pub unknowns: usize,
    /// Displacement of the seats under unit forces on them, 2N×2N: radial and tangential of each
    /// planet in turn, m/N.
    pub flexibility: DMatrix<f64>,
}

/// A node's displacement as a sum over unknowns: (unknown, coefficient).
type Terms = Vec<(usize, f64)>;

impl CarrierBody {
    /// Meshes and solves the carrier for planets at ψ (rad).
    ///
    /// # Errors
    /// If the mesh is unsound.
    pub fn new(
        input: &CarrierInput,
        center_distance: f64,
        psi: &[f64],
        material: &Elastic,
        face_width: f64,
    ) -> Result<Self, FeError> {
        let mesh = CarrierMesh::new(input, center_distance, psi);
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
                    // u = U + θ × (p − c)
                    [
                        vec![(first, 1.0), (first + 2, c[1] - p[1])],
                        vec![(first + 1, 1.0), (first + 2, p[0] - c[0])],
                    ]
                }
            })
            .collect();
        let shape = CarrierMesh::shape();
        let mut triplets = Triplets::default();
        for (i, nodes) in mesh.elements.iter().enumerate() {
            let nodes = &nodes[..shape.count()];
            let points: Vec<_> = nodes.iter().map(|n| mesh.points[*n]).collect();
            let k = matrices(&shape, &points, material, face_width, false)
                .map_err(|cause| FeError::Distorted { body: "carrier", element: i, cause })?
                .stiffness;
            for (a, node_a) in nodes.iter().enumerate() {
                for (b, node_b) in nodes.iter().enumerate() {
                    for r in 0..2 {
                        for c in 0..2 {
                            for (row, p) in &terms[*node_a][r] {
                                for (column, q) in &terms[*node_b][c] {
                                    let value = p * q * k[(2 * a + r, 2 * b + c)];
                                    triplets.add(*row, *column, value);
                                }
                            }
                        }
                    }
                }
            }
        }
        let factor = triplets.factorise(next, "carrier")?;
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
        let flexibility = DMatrix::from_fn(2 * count, 2 * count, |row, column| {
            let (n, d) = (row / 2, direction(row / 2, row % 2));
            d[0] * right[(seat_unknown[n], column)] + d[1] * right[(seat_unknown[n] + 1, column)]
        });
        // The seats are filled: the whole annulus weighs.
        let [r, s] = [input.bore_radius, input.outer_radius].map(|r| r * r);
        let mass = material.density * face_width * std::f64::consts::PI * (s - r);
        Ok(Self { mesh, mass, inertia: 0.5 * mass * (r + s), unknowns: next, flexibility })
    }
}
