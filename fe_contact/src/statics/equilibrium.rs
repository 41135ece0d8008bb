//! Equilibrium of a set at one position.
//!
//! The races' coordinates q minimise the convex potential
//!
//! ```text
//! Φ(q) = ½ qᵀ K q − fᵀ q + Σ_meshes Ψ(B q),   Ψ(δ) = max over p ≥ 0 of pᵀ(δ − g) − ½ pᵀ C p
//! ```
//!
//! whose gradient is K q − f + Σ P b (forces P of the pairs, rows b) and whose Hessian is
//! K + Σ bᵀ S b with the meshes' tangents S. Newton's method with a line search ends in finitely
//! many steps, since Ψ is piecewise quadratic.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::placed::Placed;
use super::set::{SetTables, StaticSet};
use crate::complementarity::ComplementaritySolver;
use crate::contact::MeshAnswer;
use crate::error::FeError;

/// Fewest loaded cells a patch may have.
const LEAST_CELLS: usize = 6;

/// A set in equilibrium.
#[derive(Debug)]
pub(crate) struct Equilibrium<'t> {
    pub(crate) position: f64,
    /// Races' coordinates, m.
    pub(crate) q: DVector<f64>,
    /// Sun meshes, ring meshes, and the back flanks if any touch.
    pub(crate) meshes: Vec<Placed<'t>>,
    pub(crate) answers: Vec<MeshAnswer>,
    /// Largest imbalance over the load.
    pub(crate) residual: f64,
    /// Equilibrium and contact iterations.
    pub(crate) counts: (usize, usize),
}

/// Answers of all meshes with the largest residual over the load; equilibrium and contact iterations.
type Balance = ((Vec<MeshAnswer>, f64), (usize, usize));

impl StaticSet<'_> {
    /// Equilibrium at one position.
    ///
    /// # Errors
    /// As [`StaticSet::cycle`].
    pub(crate) fn equilibrium<'t>(
        &self,
        torque_nm: f64,
        position: f64,
        tables: &'t SetTables,
        start: Option<&DVector<f64>>,
        solver: &dyn ComplementaritySolver,
    ) -> Result<Equilibrium<'t>, FeError> {
        let f = self.load(torque_nm);
        let load = f.amax();
        let mut meshes = self.place(position, tables);
        if load == 0.0 {
            let answers = meshes.iter().map(Placed::untouched).collect::<Vec<_>>();
            let q = DVector::zeros(self.races.count);
            return Ok(Equilibrium { position, q, meshes, answers, residual: 0.0, counts: (0, 0) });
        }
        let mut q = match start {
            Some(q) => q.clone(),
            None => self.first_guess(&f, &meshes)?,
        };
        let (mut found, mut counts) = self.balance(&f, load, &mut q, &meshes, solver)?;
        if self.backs_touch(&q) {
            meshes.extend(self.place_backs(position, &tables.settings)?);
            let (again, more) = self.balance(&f, load, &mut q, &meshes, solver)?;
            (found, counts) = (again, (counts.0 + more.0, counts.1 + more.1));
        }
        let (answers, residual) = found;
        for (mesh, answer) in meshes.iter().zip(&answers) {
            // A mesh that carries next to nothing rests on few cells, and that decides nothing.
            mesh.table.check_patches(answer, LEAST_CELLS, 0.2 * tables.settings.force)?;
            mesh.check_window(&q)?;
        }
        Ok(Equilibrium { position, q, meshes, answers, residual, counts })
    }

    /// Finds equilibrium anew after gap offsets were changed.
    pub(crate) fn settle(
        &self,
        torque_nm: f64,
        found: &mut Equilibrium<'_>,
        solver: &dyn ComplementaritySolver,
    ) -> Result<(), FeError> {
        let f = self.load(torque_nm);
        let ((answers, residual), counts) =
            self.balance(&f, f.amax(), &mut found.q, &found.meshes, solver)?;
        (found.answers, found.residual, found.counts) = (answers, residual, counts);
        Ok(())
    }

    /// Newton's method from q; answers of all meshes with the residual, and the iterations it took.
    fn balance(
        &self,
        f: &DVector<f64>,
        load: f64,
        q: &mut DVector<f64>,
        meshes: &[Placed<'_>],
        solver: &dyn ComplementaritySolver,
    ) -> Result<Balance, FeError> {
        const MOST: usize = 60;
        let mut warm: Vec<Option<Vec<bool>>> = meshes.iter().map(|m| Some(m.guess())).collect();
        let mut contact_iterations = 0;
        let mut evaluate = |q: &DVector<f64>, warm: &mut Vec<Option<Vec<bool>>>| {
            let mut answers = Vec::with_capacity(meshes.len());
            for (mesh, warm) in meshes.iter().zip(warm.iter_mut()) {
                let answer = mesh.answer(q, solver, warm.as_deref())?;
                contact_iterations += answer.iterations;
                if answer.active.iter().any(|a| *a) {
                    *warm = Some(answer.active.clone());
                }
                answers.push(answer);
            }
            Ok::<_, FeError>(answers)
        };
        let potential = |q: &DVector<f64>, answers: &[MeshAnswer]| {
            let energy: f64 = answers.iter().map(|a| a.energy).sum();
            0.5 * (&self.races.stiffness * q).dot(q) - f.dot(q) + energy
        };
        let mut answers = evaluate(q, &mut warm)?;
        let mut residual = f64::INFINITY;
        for iteration in 1..=MOST {
            let mut r = f - &self.races.stiffness * &*q;
            let mut hessian = self.races.stiffness.clone();
            for (mesh, answer) in meshes.iter().zip(&answers) {
                mesh.add_to(&mut r, &mut hessian, answer);
            }
            residual = r.amax() / load;
            if residual < 1e-11 {
                return Ok(((answers, residual), (iteration, contact_iterations)));
            }
            // A mesh out of contact leaves the matrix singular: lend it the first guess's springs.
            let step = match definite(hessian.clone()) {
                Some(factor) => factor.solve(&r),
                None => {
                    for mesh in meshes {
                        mesh.add_nominal(&mut hessian, self.nominal_stiffness());
                    }
                    definite(hessian).ok_or_else(turns_freely)?.solve(&r)
                }
            };
            let (before, slope) = (potential(q, &answers), r.dot(&step));
            let mut scale = 1.0;
            loop {
                let trial = &*q + scale * &step;
                let found = evaluate(&trial, &mut warm)?;
                let rounding = 1e-12 * (before.abs() + slope.abs());
                if potential(&trial, &found) <= before - 1e-4 * scale * slope + rounding
                    || scale < 1e-6
                {
                    (*q, answers) = (trial, found);
                    break;
                }
                scale *= 0.5;
            }
        }
        Err(FeError::NotConverged { iterations: MOST, residual })
    }

    /// E b/13: about the stiffness of one pair of steel teeth per unit length.
    fn nominal_stiffness(&self) -> f64 {
        self.bodies.material.young * self.bodies.geometry.face_width / 13.0
    }

    /// Equilibrium with a spring in each mesh's nearest pair.
    fn first_guess(
        &self,
        f: &DVector<f64>,
        meshes: &[Placed<'_>],
    ) -> Result<DVector<f64>, FeError> {
        let mut matrix = self.races.stiffness.clone();
        for mesh in meshes {
            mesh.add_nominal(&mut matrix, self.nominal_stiffness());
        }
        Ok(definite(matrix).ok_or_else(turns_freely)?.solve(f))
    }
}

/// Cholesky factor of a matrix that is positive definite by more than rounding.
fn definite(matrix: DMatrix<f64>) -> Option<Cholesky<f64, nalgebra::Dyn>> {
    let diagonal = matrix.diagonal();
    let factor = Cholesky::new(matrix)?;
    let l = factor.l_dirty();
    let is_sound = (0..diagonal.len()).all(|i| l[(i, i)].powi(2) > 1e-11 * diagonal[i]);
    is_sound.then_some(factor)
}

fn turns_freely() -> FeError {
    FeError::NoEquilibrium(
        "the set can turn freely under the torque: hold the rotation of two central members, or \
         give them a torsional support"
            .into(),
    )
}
