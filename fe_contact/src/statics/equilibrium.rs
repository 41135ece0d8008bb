//! Equilibrium of a set at one position.
//!
//! The races' coordinates q minimise a convex potential ([`StaticSet::balance`]). K holds the bearings and, about a
//! loaded reference, the turning of the mesh forces with their lines of action. Newton's method with a line search
//! ends in finitely many steps, since Ψ is piecewise quadratic.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::placed::PlacedMesh;
use super::set::StaticSet;
use super::slopes::Slopes;
use super::tables::SetTables;
use crate::complementarity::ComplementaritySolver;
use crate::contact::MeshAnswer;
use crate::error::FeError;

/// Fewest loaded cells a patch may have.
const LEAST_CELLS: usize = 6;

/// Most repetitions of an equilibrium for the second-order terms of corner gaps, and the change of
/// displacements (m) at which they end.
const MOST_BENDINGS: usize = 8;
const BENT: f64 = 1e-12;

/// A set in equilibrium.
#[derive(Debug, Clone)]
pub(crate) struct Equilibrium<'t> {
    pub(crate) position: f64,
    /// Races' coordinates, m.
    pub(crate) q: DVector<f64>,
    /// Sun meshes, ring meshes, and the backside flanks if any touch.
    pub(crate) meshes: Vec<PlacedMesh<'t>>,
    pub(crate) answers: Vec<MeshAnswer>,
    /// Slopes of the deformed flanks that are included in the front meshes' rows, and (`level`) the
    /// load on the races that they leave, N.
    pub(crate) slopes: Vec<Slopes>,
    pub(crate) level: DVector<f64>,
    /// `level` plus the load on the races from the second-order terms of corner gaps, P G'' Δe ∂e,
    /// N.
    pub(crate) load: DVector<f64>,
    /// Largest imbalance of any race relative to the load.
    pub(crate) residual: f64,
    /// Equilibrium and contact iterations.
    pub(crate) counts: (usize, usize),
}

/// K (N/m) and f (N) of the potential without the meshes.
pub(super) struct System {
    pub(super) stiffness: DMatrix<f64>,
    pub(super) load: DVector<f64>,
}

/// Answers of all meshes with the largest residual over the load; equilibrium and contact iterations.
type Balance = ((Vec<MeshAnswer>, f64), (usize, usize));

impl StaticSet<'_> {
    /// Equilibrium at one position under loads f (n, N) on the races, without the slopes of the
    /// flanks.
    ///
    /// # Errors
    /// As [`StaticSet::cycle`].
    pub(crate) fn equilibrium<'t>(
        &self,
        f: &DVector<f64>,
        position: f64,
        tables: &'t SetTables,
        start: Option<&DVector<f64>>,
        solver: &dyn ComplementaritySolver,
    ) -> Result<Equilibrium<'t>, FeError> {
        let mut meshes = self.place(position, tables);
        let none = DVector::zeros(self.races.count);
        let slopes = Vec::new();
        if f.amax() == 0.0 {
            let answers = meshes.iter().map(PlacedMesh::untouched).collect::<Vec<_>>();
            let (q, level, load) = (none.clone(), none.clone(), none);
            let (residual, counts) = (0.0, (0, 0));
            return Ok(Equilibrium {
                position,
                q,
                meshes,
                answers,
                slopes,
                level,
                load,
                residual,
                counts,
            });
        }
        let mut q = match start {
            Some(q) => q.clone(),
            None => self.sprung(f)?,
        };
        let system = self.system(f, &none);
        let (mut found, mut counts) = self.balance(&system, &mut q, (&meshes, &[]), solver)?;
        if self.backside_touches(&q) {
            meshes.extend(self.place_backside(position, &tables.settings)?);
            let (again, more) = self.balance(&system, &mut q, (&meshes, &found.0), solver)?;
            (found, counts) = (again, (counts.0 + more.0, counts.1 + more.1));
        }
        let (answers, residual) = found;
        for (mesh, answer) in meshes.iter().zip(&answers) {
            // A mesh with little force touches with few cells, which does not affect the result.
            mesh.table.check_patches(answer, LEAST_CELLS, 0.2 * tables.settings.force)?;
            mesh.check_window(&q)?;
        }
        let (level, load) = (none.clone(), none);
        Ok(Equilibrium { position, q, meshes, answers, slopes, level, load, residual, counts })
    }

    /// Computes the slopes of the flanks as deformed in an equilibrium, includes them in its rows,
    /// and solves for equilibrium again.
    ///
    /// # Errors
    /// If contact cannot be solved.
    pub(crate) fn lean_all(
        &self,
        f: &DVector<f64>,
        tables: &SetTables,
        found: &mut Equilibrium<'_>,
        solver: &dyn ComplementaritySolver,
    ) -> Result<(), FeError> {
        if f.amax() == 0.0 {
            return Ok(());
        }
        let forces = |k: usize| &found.answers[k].pair_forces;
        let fronts = 0..self.nominal.len();
        found.slopes = fronts
            .map(|mesh| self.slopes(tables, mesh, found.position, forces(mesh)))
            .collect::<Result<_, _>>()?;
        let Equilibrium { meshes, slopes, level, .. } = found;
        for (mesh, (placed, own)) in meshes.iter_mut().zip(slopes).enumerate() {
            self.lean(mesh, placed, own, level);
        }
        self.settle_bent(f, found, solver)
    }

    /// Solves for equilibrium again with the second-order terms of corner gaps, until these agree
    /// with its own displacements.
    ///
    /// # Errors
    /// If contact cannot be solved.
    pub(crate) fn settle_bent(
        &self,
        f: &DVector<f64>,
        found: &mut Equilibrium<'_>,
        solver: &dyn ComplementaritySolver,
    ) -> Result<(), FeError> {
        let perfect: Vec<Vec<f64>> = found.meshes.iter().map(|m| m.offsets.clone()).collect();
        let before = found.counts;
        let mut counts = before;
        for _ in 0..MOST_BENDINGS {
            let q = found.q.clone();
            found.load.copy_from(&found.level);
            for ((mesh, perfect), answer) in
                found.meshes.iter_mut().zip(&perfect).zip(&found.answers)
            {
                mesh.bend(perfect, &q, &answer.pair_forces, &mut found.load);
            }
            self.settle(f, found, solver)?;
            counts = (counts.0 + found.counts.0, counts.1 + found.counts.1);
            found.counts = counts;
            if (&found.q - q).amax() < BENT {
                break;
            }
        }
        Ok(())
    }

    /// Solves for equilibrium again after rows, gap offsets or loads were changed.
    pub(crate) fn settle(
        &self,
        f: &DVector<f64>,
        found: &mut Equilibrium<'_>,
        solver: &dyn ComplementaritySolver,
    ) -> Result<(), FeError> {
        let system = self.system(f, &found.load);
        let known = (&*found.meshes, &*found.answers);
        let ((answers, residual), counts) = self.balance(&system, &mut found.q, known, solver)?;
        (found.answers, found.residual, found.counts) = (answers, residual, counts);
        Ok(())
    }

    /// K with bearings and the turning of the mesh forces with their lines of action about the
    /// reference, and f with the loads `f` and `left` (N).
    fn system(&self, f: &DVector<f64>, left: &DVector<f64>) -> System {
        let turning = &self.reference.stiffness;
        System {
            stiffness: &self.races.stiffness + turning,
            load: f + left + turning * &self.reference.q,
        }
    }

    /// Newton's method from q; answers of all meshes with the residual, and the iterations it took.
    /// Cells that touch in the `known` answers of the first of the meshes are the first guess.
    ///
    /// `[eq:static-equilibrium]` Least of the potential with the gradient K q − f + Σ P b (forces P of the pairs,
    /// rows b) and the Hessian K + Σ bᵀ S b with the meshes' tangents S:
    /// ```text
    /// Φ(q) = ½ qᵀ K q − fᵀ q + Σ_meshes Ψ(B q),   Ψ(δ) = max over p ≥ 0 of pᵀ(δ − g) − ½ pᵀ C p.
    /// ```
    /// Source: derived here.
    /// Checked by: `fe.sets.balance`, `fe.sets.sharing`, `fe.sets.mirror`, `fe.kinematics.bearings`.
    pub(super) fn balance(
        &self,
        system: &System,
        q: &mut DVector<f64>,
        (meshes, known): (&[PlacedMesh<'_>], &[MeshAnswer]),
        solver: &dyn ComplementaritySolver,
    ) -> Result<Balance, FeError> {
        const MOST: usize = 60;
        let System { stiffness, load: f } = system;
        let load = f.amax();
        let first = |(i, mesh): (usize, &PlacedMesh<'_>)| {
            let known = known.get(i).filter(|answer| answer.active.iter().any(|a| *a));
            Some(known.map_or_else(|| mesh.guess(), |answer| answer.active.clone()))
        };
        let mut warm: Vec<Option<Vec<bool>>> = meshes.iter().enumerate().map(first).collect();
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
            0.5 * (stiffness * q).dot(q) - f.dot(q) + energy
        };
        let mut answers = evaluate(q, &mut warm)?;
        let mut residual = f64::INFINITY;
        for iteration in 1..=MOST {
            let mut r = f - stiffness * &*q;
            let mut hessian = stiffness.clone();
            for (mesh, answer) in meshes.iter().zip(&answers) {
                mesh.add_to(&mut r, &mut hessian, answer);
            }
            let before = residual;
            residual = r.amax() / load;
            // Within one quadratic piece a step reduces the residual to rounding, which further
            // loads that hold the races in displaced positions may keep above 1e-14.
            if residual < 1e-14 || (residual < 1e-11 && residual > 0.1 * before) {
                return Ok(((answers, residual), (iteration, contact_iterations)));
            }
            // Without contact of a mesh the matrix may be singular: springs as in the first guess
            // are added for this step.
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

    /// E b/13: about the stiffness of one pair of steel teeth, N/m.
    fn nominal_stiffness(&self) -> f64 {
        self.bodies.material.young * self.bodies.geometry.face_width / 13.0
    }

    /// Equilibrium with a linear spring along the line of action in place of each mesh, about the
    /// reference.
    pub(super) fn sprung(&self, f: &DVector<f64>) -> Result<DVector<f64>, FeError> {
        let (mut matrix, mut f) = (self.races.stiffness.clone(), f.clone());
        let k = self.nominal_stiffness();
        for pose in &self.reference.meshes {
            let row = &pose.gradients[0];
            matrix.ger(k, row, row, 1.0);
            f.axpy(k * (row.dot(&self.reference.q) - pose.at[0]), row, 1.0);
        }
        Ok(definite(matrix).ok_or_else(turns_freely)?.solve(&f))
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
