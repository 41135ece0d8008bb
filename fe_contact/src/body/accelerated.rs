//! The elastic displacement of a gear whose race is accelerated, and the kinetic energy of elastic displacements.
//!
//! With the matrices of [`BodyMatrices`](super::BodyMatrices) and M_fr e_k the inertia of the body under a unit
//! acceleration of its race along x or y or about the centre,
//!
//! ```text
//! K w_k = M_fr e_k
//! ```
//!
//! Teeth are meshed alike, so that w is the same in the frame of every tooth, and one sector has it all.

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use super::gear_body::GearBody;
use crate::element::matrices;
use crate::error::FeError;

/// Static displacements of a gear under unit accelerations of its race, and the mass matrix of a sector.
#[derive(Debug, Clone)]
pub struct Accelerated {
    /// w in the frame of each tooth, 2 rows for each node of a sector; columns: acceleration along x and y of that
    /// frame (s²) and about the centre (m s²).
    pub displacement: DMatrix<f64>,
    /// M_rf K⁻¹ M_fr of a translation (kg s²) and of the rotation (kg m² s²); other entries are 0 by symmetry.
    pub coupled: [f64; 2],
    /// wᵀ M_ff w, the same (kg s⁴, kg m² s⁴).
    pub moved: [f64; 2],
    /// wᵀ M_ff w of one sector, in the frame of its tooth.
    of_sector: Matrix3<f64>,
    /// Consistent mass of each element of a sector, one value for each pair of its functions, kg.
    masses: Vec<(Vec<usize>, DMatrix<f64>)>,
}

impl Accelerated {
    /// Of a gear; `None` where its teeth are not meshed alike, or it was solved as a whole.
    ///
    /// # Errors
    /// If an element is distorted or a harmonic of the ring of sectors is not positive definite.
    pub fn new(gear: &GearBody) -> Result<Option<Self>, FeError> {
        let mesh = &gear.mesh;
        let Some(ring) = gear.ring() else { return Ok(None) };
        let sector = mesh.sector(0);
        let incompatible = mesh.family == scene::ElementFamily::Incompatible;
        let one = |(i, e): (usize, &crate::fe_mesh::SectorElement)| {
            let nodes = e.nodes[..e.shape.count()].to_vec();
            let points: Vec<_> = nodes.iter().map(|n| sector.points[*n]).collect();
            let own = matrices(&e.shape, &points, &gear.material, gear.face_width, incompatible)
                .map_err(|cause| FeError::Distorted { body: mesh.name, element: i, cause })?;
            // The consistent mass is the same in x and y.
            let mass = DMatrix::from_fn(nodes.len(), nodes.len(), |a, b| own.mass[(2 * a, 2 * b)]);
            Ok((nodes, mass))
        };
        let masses = sector.elements.iter().enumerate().map(one).collect::<Result<_, FeError>>()?;
        let mut own = Self {
            displacement: DMatrix::zeros(0, 0),
            coupled: [0.0; 2],
            moved: [0.0; 2],
            of_sector: Matrix3::zeros(),
            masses,
        };
        // Rigid motion of the sector: a translation does not change derivative nodes.
        let mut rigid = DMatrix::zeros(2 * sector.points.len(), 3);
        for (n, [x, y]) in sector.points.iter().enumerate() {
            let moved = if sector.is_derivative[n] { 0.0 } else { 1.0 };
            rigid[(2 * n, 0)] = moved;
            rigid[(2 * n + 1, 1)] = moved;
            rigid[(2 * n, 2)] = -y;
            rigid[(2 * n + 1, 2)] = *x;
        }
        let forces = own.times_mass(&rigid);
        own.displacement = ring.sector.everywhere(&ring.sector.under(&forces), mesh.name)?;
        let teeth = mesh.nodes.len() as f64;
        let inertia = own.times_mass(&own.displacement);
        let along = |of: &DMatrix<f64>, k: usize| of.column(k).dot(&own.displacement.column(k));
        // Σ_j cos² φ_j = Z/2 of the sectors' angles
        let whole =
            |of: &DMatrix<f64>| [0.5 * teeth * (along(of, 0) + along(of, 1)), teeth * along(of, 2)];
        (own.coupled, own.moved) = (whole(&forces), whole(&inertia));
        own.of_sector = Matrix3::from_fn(|i, j| own.displacement.column(i).dot(&inertia.column(j)));
        Ok(Some(own))
    }

    /// Lesser Rayleigh quotient of w, at least the first eigenvalue with the race held and, as a step of inverse
    /// iteration from rigid motion, close to it, (rad/s)².
    pub fn first(&self) -> f64 {
        [0, 1].map(|k| self.coupled[k] / self.moved[k]).into_iter().fold(f64::INFINITY, f64::min)
    }

    /// M u of one sector; 2 rows for each node, any number of columns.
    pub(super) fn times_mass(&self, u: &DMatrix<f64>) -> DMatrix<f64> {
        // Side by side in memory are the columns, of which there may be many.
        let u = u.transpose();
        let mut product = DMatrix::zeros(u.nrows(), u.ncols());
        for (nodes, mass) in &self.masses {
            for (q, column) in nodes.iter().zip(mass.column_iter()) {
                for (p, m) in nodes.iter().zip(column.iter()) {
                    for axis in 0..2 {
                        product.column_mut(2 * p + axis).axpy(*m, &u.column(2 * q + axis), 1.0);
                    }
                }
            }
        }
        product.transpose()
    }

    /// ℓ w for a distributed load on a tooth: displacement along `direction` in the tooth's frame, mean with the
    /// weights of the load (columns of the gear's response), under the accelerations `race` (x, y in the tooth's frame,
    /// m/s², and rad/s²), m.
    pub fn at(
        &self,
        gear: &GearBody,
        (load, direction): (&[(usize, f64)], [f64; 2]),
        race: [f64; 3],
    ) -> f64 {
        let one = |(column, weight): &(usize, f64)| -> f64 {
            let node = gear.node_of(*column);
            let moved = |axis: usize| -> f64 {
                let own = self.displacement.row(2 * node + axis);
                own.iter().zip(race).map(|(w, a)| w * a).sum()
            };
            weight * (direction[0] * moved(0) + direction[1] * moved(1))
        };
        load.iter().map(one).sum()
    }

    /// u_1ᵀ M_ff u_1 of the displacement u_1 = −K⁻¹ Σ_a ℓ_aᵀ P_a + w a of the whole gear under forces that press on its
    /// teeth and an acceleration a of its race (x, y in the frame of tooth 0, m/s², and rad/s²), kg m². The
    /// displacement by a force is counted on the teeth near it, at all of whose nodes the gear keeps it.
    pub fn energy(&self, gear: &GearBody, forces: &[ToothForce<'_>], race: [f64; 3]) -> f64 {
        let teeth = gear.mesh.nodes.len() as i64;
        let one = |tooth: i64| -> f64 {
            let (sin, cos) = gear.mesh.tooth_angle(tooth as usize).sin_cos();
            let turned = [cos * race[0] + sin * race[1], cos * race[1] - sin * race[0], race[2]];
            // The nearer way round.
            let offset =
                |at: &ToothForce<'_>| (tooth - at.tooth + teeth / 2).rem_euclid(teeth) - teeth / 2;
            let mut near =
                forces.iter().filter_map(|at| Some((at, gear.response(offset(at))?))).peekable();
            if near.peek().is_none() {
                let turned = Vector3::from(turned);
                return turned.dot(&(self.of_sector * turned));
            }
            let mut u = &self.displacement * DVector::from_column_slice(&turned);
            for (at, response) in near {
                for (column, weight) in at.load {
                    for (axis, d) in at.direction.iter().enumerate() {
                        let factor = -at.force * weight * d;
                        u.axpy(factor, &response.column(column + axis), 1.0);
                    }
                }
            }
            let u = DMatrix::from_column_slice(u.len(), 1, u.as_slice());
            u.dot(&self.times_mass(&u))
        };
        (0..teeth).map(one).sum()
    }
}

/// A force that presses on a tooth of a gear.
#[derive(Debug, Clone, Copy)]
pub struct ToothForce<'l> {
    /// Force against `direction`, N.
    pub force: f64,
    /// Tooth on which it acts.
    pub tooth: i64,
    /// Distribution over columns of the gear's response.
    pub load: &'l [(usize, f64)],
    /// Direction in the tooth's frame.
    pub direction: [f64; 2],
}
