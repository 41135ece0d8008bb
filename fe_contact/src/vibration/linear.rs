//! A set linearised about its present state, with the set of touching cells kept.

use gearset::Body;
use nalgebra::{DMatrix, DVector};

use super::body::out_of_frame;
use super::fixed_race_mode::FixedRaceMode;
use super::flexible_bodies::FlexibleBodies;
use super::set::VibratingSet;
use crate::error::FeError;

/// Matrices of the linearised set on z = (races, then modes of carrier, ring, sun, planets).
///
/// `[eq:linearised-set]` Equations of the linearised set:
/// ```text
/// M z̈ + C ż + K z + Rᵀ P = f,   P = S_c (R z − F P̃),   β P̃' + P̃ = P
/// ```
/// Source: derived here.
/// Checked by: `fe_contact/tests/vibration.rs::linearisation_is_the_derivative_of_statics`,
/// `fe.modal.routes.frequency`.
///
/// K: stiffness without contact; R: approaches of the pairs; S_c: their stiffness S with the
/// lagging FE flexibility F taken out. In slow motion P = S R z.
#[derive(Debug, Clone)]
pub struct LinearSet {
    /// M, kg.
    pub mass: DMatrix<f64>,
    /// C without the lag, N s/m.
    pub damping: DMatrix<f64>,
    /// K without contact, N/m.
    pub supports: DMatrix<f64>,
    /// Part of K from the turning of the mesh forces with their lines of action and from the
    /// second-order terms of corner gaps, N/m; it is undamped.
    pub turning: DMatrix<f64>,
    /// R, pairs×z.
    pub rows: DMatrix<f64>,
    /// S, pairs×pairs, N/m.
    pub contact: DMatrix<f64>,
    /// Tangent stiffness of each mesh, the approaches of all its pairs growing equally: sun meshes,
    /// then ring meshes, N/m.
    pub mesh_tangents: Vec<f64>,
    /// F, m/N.
    lagging: DMatrix<f64>,
    /// β, s.
    beta: f64,
    /// Number of race coordinates in front.
    pub races: usize,
}

/// A mode of the damped linearised set.
#[derive(Debug, Clone)]
pub struct DampedMode {
    /// |s|/2π, Hz.
    pub frequency_hz: f64,
    /// −Re s/|s|.
    pub damping_ratio: f64,
    /// Complex shape on z (re, im).
    pub shape: Vec<(f64, f64)>,
}

impl VibratingSet<'_> {
    /// Linearises about the present state of a set of which at least one mesh touches.
    ///
    /// # Errors
    /// If no mesh touches, and as [`tangent`](Self::tangent).
    pub fn linearised(&self) -> Result<LinearSet, FeError> {
        let own = self.tangent()?;
        match own.mesh_tangents.iter().all(|t| *t == 0.0) {
            true => Err(unloaded()),
            false => Ok(own),
        }
    }

    /// Linearises about the present state, also of a moving set whose teeth have all parted.
    ///
    /// # Errors
    /// If the set has not been stepped or put to rest yet, or a body has every degree of freedom (`full`): its
    /// linearisation is the limit of `modal`.
    pub fn tangent(&self) -> Result<LinearSet, FeError> {
        let frame = self.frames.current(self.clock.step_in_cycle).ok_or_else(unloaded)?;
        let n = self.races().count;
        let turned = self.clock.turned();
        let no_modes = || {
            FeError::NoEquilibrium(
                "`dynamics.fidelity` = \"full\" has no small linearisation: take \"modal\"".into(),
            )
        };
        let mut lists: Vec<(Body, f64, &[FixedRaceMode])> = Vec::new();
        lists.push((Body::Carrier, 0.0, self.bodies.carrier.modes().ok_or_else(no_modes)?));
        for (body, gear) in Body::all(self.races().planets()).skip(1).zip(&self.bodies.gears) {
            let modes = gear.vibrating.modes().ok_or_else(no_modes)?;
            lists.push((body, gear.angle(turned), modes));
        }
        let elastic: usize = lists.iter().map(|(_, _, modes)| modes.len()).sum();
        let size = n + elastic;
        let (mut mass, mut supports) = (DMatrix::zeros(size, size), DMatrix::zeros(size, size));
        let mut damping = DMatrix::zeros(size, size);
        for i in 0..n {
            mass[(i, i)] = self.race_dynamics.mass[i];
            supports[(i, i)] = self.race_dynamics.supports[i];
        }
        let mut first = n;
        for (body, angle, modes) in &lists {
            for (j, mode) in modes.iter().enumerate() {
                let at = first + j;
                mass[(at, at)] = 1.0;
                let along = out_of_frame(mode.participation, *angle);
                for (place, g) in self.races().places(*body).into_iter().zip(along) {
                    if let Some(i) = place {
                        mass[(i, at)] = g;
                        mass[(at, i)] = g;
                    }
                }
            }
            first += modes.len();
        }
        // Planet bearings on seats that may be flexible, and the central members' supports.
        let bearings = self.race_dynamics.bearings.linearised(lists[0].2, n, size)?;
        supports += bearings;
        damping += self.race_dynamics.bearing_ratio * &supports;
        // Stiffness from mesh forces that turn with their lines of action; it is undamped.
        let mut turning = DMatrix::zeros(size, size);
        turning.view_mut((0, 0), (n, n)).copy_from(&self.statics.reference().stiffness);
        // Generalised force of a corner: P (b − G'' Δe ∂e). Its derivative has the term −P G'' ∂e
        // ∂eᵀ beside that of P.
        let mut rigid = frame.pattern.rigid.clone();
        for bend in &frame.bends {
            let row = bend.row.full(n);
            let moved =
                row.dot(&DVector::from_column_slice(&self.race_dynamics.motion.x)) - bend.offset;
            let force = self.pairs.forces[bend.pair].max(0.0);
            let mut of_races = turning.view_mut((0, 0), (n, n));
            of_races.ger(-force * bend.curvature, &row, &row, 1.0);
            let mut leant = rigid.row_mut(bend.pair);
            leant -= bend.curvature * moved * row.transpose();
        }
        supports += &turning;
        let mut first = n;
        for (_, _, modes) in &lists {
            for (j, mode) in modes.iter().enumerate() {
                supports[(first + j, first + j)] += mode.lambda;
                damping[(first + j, first + j)] += self.race_dynamics.damping.beta * mode.lambda;
            }
            first += modes.len();
        }
        damping += self.race_dynamics.damping.alpha * &mass;
        // Pairs that touch.
        let count = frame.offsets.len();
        let mut s = DMatrix::zeros(count, count);
        let mut mesh_tangents = Vec::with_capacity(frame.meshes.len());
        for mesh in &frame.meshes {
            let lost = || FeError::NoEquilibrium("no contact was found at this position".into());
            let map = mesh.map(&self.contact.maps).ok_or_else(lost)?;
            mesh_tangents.push(map.stiffness().iter().sum());
            for i in 0..mesh.count {
                for j in 0..mesh.count {
                    s[(mesh.first + i, mesh.first + j)] = map.stiffness()[i * mesh.count + j];
                }
            }
        }
        let mut rows = DMatrix::zeros(count, size);
        rows.view_mut((0, 0), (count, n)).copy_from(&rigid);
        let mut first = n + lists[0].2.len();
        for ((gear, own), (_, _, modes)) in
            self.bodies.gears.iter().zip(&frame.pattern.own).zip(&lists[1..])
        {
            if modes.is_empty() {
                continue;
            }
            for (port, (pair, _)) in
                FlexibleBodies::ports_of(frame, gear, own, self.clock.cycles).iter().zip(own)
            {
                for (j, mode) in modes.iter().enumerate() {
                    rows[(*pair, first + j)] += port.read(&mode.shape);
                }
            }
            first += modes.len();
        }
        // Within a mesh the flexibility of the modes is part of the cells' compliance and must not
        // act twice. Between meshes the static flexibility that the modes leave out appears nowhere
        // else.
        let (carried, mut doubled) =
            (self.bodies.carried(frame, self.clock.cycles), -frame.lagging());
        for mesh in &frame.meshes {
            let own = (mesh.first, mesh.first);
            let size = (mesh.count, mesh.count);
            doubled.view_mut(own, size).copy_from(&carried.view(own, size));
        }
        let contact = stiffened(&s, &doubled)?;
        Ok(LinearSet {
            mass,
            damping,
            supports,
            turning,
            rows,
            contact,
            mesh_tangents,
            lagging: frame.lagging().clone(),
            beta: self.race_dynamics.damping.beta,
            races: n,
        })
    }
}

fn unloaded() -> FeError {
    FeError::NoEquilibrium("no mesh touches: there is nothing to linearise about".into())
}

/// (I − S X)⁻¹ S: the stiffness with the compliance X taken out.
fn stiffened(s: &DMatrix<f64>, x: &DMatrix<f64>) -> Result<DMatrix<f64>, FeError> {
    let n = s.nrows();
    (DMatrix::identity(n, n) - s * x)
        .lu()
        .solve(s)
        .ok_or_else(|| FeError::NoEquilibrium("the linearised contact is singular".into()))
}

impl LinearSet {
    /// K + Rᵀ S R, N/m.
    pub fn stiffness(&self) -> DMatrix<f64> {
        let sum = &self.supports + self.rows.transpose() * &self.contact * &self.rows;
        0.5 * (&sum + sum.transpose())
    }

    /// `[eq:slow-damping]` Damping of slow motion, N s/m: C + β Rᵀ S F S R, since to first order in β the lag of the
    /// FE flexibility makes of P = S R z the force S R z + β S F S R ż.
    ///
    /// Source: derived here.
    /// Checked by: `fe_contact/tests/vibration.rs::slow_damping_is_that_of_the_lagging_set`.
    pub fn slow_damping(&self) -> DMatrix<f64> {
        let forces = &self.contact * &self.rows;
        &self.damping + self.beta * (forces.transpose() * &self.lagging * &forces)
    }

    /// Undamped frequencies (Hz, ascending) and M-orthonormal shapes, one a column.
    ///
    /// # Errors
    /// If the eigenproblem fails.
    pub fn undamped(&self) -> Result<(Vec<f64>, DMatrix<f64>), FeError> {
        let k = self.stiffness();
        let size = k.nrows();
        let factor = self.mass.clone().cholesky().ok_or_else(|| {
            FeError::NoEquilibrium("the mass matrix is not positive definite".into())
        })?;
        let l = factor.l();
        // K̃ = L⁻¹ K L⁻ᵀ
        let failed = || FeError::NoEquilibrium("the mass matrix is singular".into());
        let half = l.solve_lower_triangular(&k).ok_or_else(failed)?;
        let scaled = l.solve_lower_triangular(&half.transpose()).ok_or_else(failed)?;
        let modes = dynamics::generalized_symmetric(&scaled, &vec![1.0; size])
            .map_err(|cause| FeError::Modes { body: "linearised set", cause })?;
        let shapes = l.tr_solve_lower_triangular(&modes.vectors).ok_or_else(failed)?;
        let frequency = |x: &f64| x.max(0.0).sqrt() / std::f64::consts::TAU;
        Ok((modes.lambda.iter().map(frequency).collect(), shapes))
    }

    /// Oscillating modes with damping and lag, by ascending frequency.
    ///
    /// # Errors
    /// If the eigenproblem fails.
    pub fn damped(&self) -> Result<Vec<DampedMode>, FeError> {
        let size = self.mass.nrows();
        let touching: Vec<usize> =
            (0..self.rows.nrows()).filter(|i| self.contact.row(*i).amax() > 0.0).collect();
        let has_lag = self.beta > 0.0 && self.lagging.amax() > 0.0;
        let p = if has_lag { touching.len() } else { 0 };
        let singular = || FeError::NoEquilibrium("the mass matrix is singular".into());
        let factor = self.mass.clone().cholesky().ok_or_else(singular)?;
        // Time in units of 1/ω₀, velocities in ω₀, forces in units of the stiffest pair's.
        let omega0 = 1e4;
        let unit = self.contact.amax();
        let contact =
            if has_lag { stiffened(&self.contact, &self.lagging)? } else { self.contact.clone() };
        let k = &self.supports + self.rows.transpose() * &contact * &self.rows;
        let (mk, mc) = (factor.solve(&k), factor.solve(&self.damping));
        // P = S_c (R z − F P̃)
        let lagged = factor.solve(&(self.rows.transpose() * &contact * &self.lagging));
        let followed = &contact * &self.rows;
        let kept = &contact * &self.lagging;
        let total = 2 * size + p;
        let mut a = DMatrix::zeros(total, total);
        for i in 0..size {
            a[(i, size + i)] = 1.0;
            for j in 0..size {
                a[(size + i, j)] = -mk[(i, j)] / (omega0 * omega0);
                a[(size + i, size + j)] = -mc[(i, j)] / omega0;
            }
            for (j, pair) in touching.iter().enumerate().take(p) {
                a[(size + i, 2 * size + j)] = lagged[(i, *pair)] * unit / (omega0 * omega0);
            }
        }
        let rate = 1.0 / (self.beta.max(f64::MIN_POSITIVE) * omega0);
        for (i, pair) in touching.iter().enumerate().take(p) {
            for j in 0..size {
                a[(2 * size + i, j)] = rate * followed[(*pair, j)] / unit;
            }
            for (j, other) in touching.iter().enumerate() {
                let own = if i == j { 1.0 } else { 0.0 };
                a[(2 * size + i, 2 * size + j)] = -rate * (own + kept[(*pair, *other)]);
            }
        }
        let modes = dynamics::state_modes(&a)
            .map_err(|cause| FeError::Modes { body: "linearised set", cause })?;
        Ok(modes
            .into_iter()
            .filter(|m| m.exponent.1 > 1e-9 * m.natural_frequency())
            .map(|m| DampedMode {
                frequency_hz: omega0 * m.natural_frequency() / std::f64::consts::TAU,
                damping_ratio: m.damping_ratio(),
                shape: m.vector[..size].to_vec(),
            })
            .collect())
    }
}
