//! A set over a mesh cycle, and the loaded configuration that is its mean.

use nalgebra::DVector;

use super::equilibrium::Equilibrium;
use super::reference::ReferenceConfiguration;
use super::set::StaticSet;
use super::state::{MeshState, SetCycle, SetState};
use crate::complementarity::{ActiveSet, ComplementaritySolver};
use crate::contact::CellSettings;
use crate::error::FeError;

/// Most times that the grids of contact cells are laid out again, each time for four times the
/// load.
const RESIZINGS: usize = 3;

/// Least number of positions over which the loaded configuration is averaged, and largest number
/// tried in the search for one with which all meshes of a kind pass through the same phases.
const MEAN_OVER: [usize; 2] = [14, 140];

/// The loaded configuration is found once no phase changes by more than this from one iteration to
/// the next, cycles. The linearisation covers the remaining change; the error is quadratic in it.
const FOUND: f64 = 1e-3;

/// Most iterations in search of the loaded configuration.
const MOST: usize = 12;

impl<'s> StaticSet<'s> {
    /// The set linearised about its mean configuration under a torque on the sun (N·m, magnitude).
    ///
    /// # Errors
    /// If contact cannot be solved, nothing holds the set, or the iteration does not converge.
    pub fn under(self, torque_nm: f64) -> Result<Self, FeError> {
        self.under_with(torque_nm, &DVector::zeros(0))
    }

    /// The same with further loads on the races' coordinates (N, one each, or an empty vector).
    ///
    /// # Errors
    /// As [`StaticSet::under`].
    pub fn under_with(mut self, torque_nm: f64, further: &DVector<f64>) -> Result<Self, FeError> {
        finite(torque_nm)?;
        let f = self.load_with(torque_nm, further);
        if f.amax() == 0.0 {
            let none = DVector::zeros(self.races.count);
            self.reference = self.reference_at(0.0, none, &[])?;
            return Ok(self);
        }
        let sized_for = self.share(torque_nm).max(1.0);
        // Springs in place of the meshes give the configuration to within the deflection of a
        // tooth.
        for _ in 0..MOST {
            let q = self.sprung(&f)?;
            let next = self.reference_at(torque_nm, q, &self.even_forces(torque_nm))?;
            let change = next.moved_from(&self.reference);
            self.reference = next;
            if change < FOUND {
                break;
            }
        }
        let mut change = f64::INFINITY;
        for _ in 0..MOST {
            let next = resized(sized_for, |size| self.mean(torque_nm, further, size))?;
            change = next.moved_from(&self.reference);
            self.reference = next;
            if change < FOUND {
                return Ok(self);
            }
        }
        Err(FeError::NoReference { torque_nm, change })
    }

    /// Force of each mesh if all planets carry the same load, N.
    pub fn share(&self, torque_nm: f64) -> f64 {
        torque_nm / self.races.base_radii[2] / self.races.planets() as f64
    }

    fn even_forces(&self, torque_nm: f64) -> Vec<f64> {
        vec![self.share(torque_nm); self.nominal.len()]
    }

    /// Mean configuration over a mesh cycle about the present reference.
    fn mean(
        &self,
        torque_nm: f64,
        further: &DVector<f64>,
        sized_for: f64,
    ) -> Result<ReferenceConfiguration, FeError> {
        let count = self.even_positions();
        let positions: Vec<f64> = (0..count).map(|i| i as f64 / count as f64).collect();
        let tables = self.tables(sized_for, &positions)?;
        let mut q = DVector::zeros(self.races.count);
        let mut forces = vec![0.0; self.nominal.len()];
        let mut start = self.reference.q.clone();
        let f = self.load_with(torque_nm, further);
        for position in positions {
            let found = self.equilibrium(&f, position, &tables, Some(&start), &ActiveSet);
            let found = found.map_err(|cause| cause.at_position(torque_nm, position))?;
            q += &found.q / count as f64;
            for (mean, answer) in forces.iter_mut().zip(&found.answers) {
                *mean += answer.pair_forces.iter().sum::<f64>() / count as f64;
            }
            start = found.q;
        }
        self.reference_at(torque_nm, q, &forces)
    }

    /// The number of positions that the scene names, or the least (at least 14) with which all meshes of a kind pass
    /// through the same phases: the phase differences of the unloaded set are then whole numbers of steps.
    fn even_positions(&self) -> usize {
        if let Some(positions) = self.bodies.settings.input.mean_positions {
            return positions as usize;
        }
        let [least, most] = MEAN_OVER;
        let planets = self.races.planets();
        let is_whole = |count: &usize| {
            self.nominal[..planets].iter().all(|of| {
                let x = of.offset * *count as f64;
                (x - x.round()).abs() < 1e-9
            })
        };
        (least..=most).find(is_whole).unwrap_or(most)
    }

    /// A torque on the sun (N·m, magnitude) and further loads on the races' coordinates, N.
    pub(super) fn load_with(&self, torque_nm: f64, further: &DVector<f64>) -> DVector<f64> {
        let mut f = self.load(torque_nm);
        if !further.is_empty() {
            f += further;
        }
        f
    }

    /// Equilibrium at `positions` evenly spaced positions of one mesh cycle; `torque_nm` is the
    /// magnitude of the sun's torque, whose sense is that of the set. The set is linearised about
    /// its mean configuration under that torque.
    ///
    /// # Errors
    /// If contact cannot be solved, the cells do not suffice, nothing holds the set, or displacements are
    /// too large for linear kinematics.
    pub fn cycle(
        &self,
        torque_nm: f64,
        positions: usize,
        solver: &(dyn ComplementaritySolver + Sync),
    ) -> Result<SetCycle, FeError> {
        let found = self.clone().under(torque_nm)?.cycle_here(torque_nm, positions, solver)?;
        // A single position has no peak-to-peak motion to compare with.
        if positions > 1 {
            found.kinematic_rest(self.races.radii[2]).check()?;
        }
        Ok(found)
    }

    /// The same, linearised about the present reference, without the check of linear kinematics.
    ///
    /// # Errors
    /// As [`StaticSet::cycle`].
    pub fn cycle_here(
        &self,
        torque_nm: f64,
        positions: usize,
        solver: &(dyn ComplementaritySolver + Sync),
    ) -> Result<SetCycle, FeError> {
        self.cycle_with(torque_nm, &DVector::zeros(0), positions, solver)
    }

    /// Equilibrium over a mesh cycle about the mean configuration under the torque, on grids laid
    /// out for meshes that carry `mesh_force` (N), as in sweeps: grids for larger forces have wider
    /// cells.
    ///
    /// # Errors
    /// As [`StaticSet::cycle`].
    pub fn cycle_on_grids_for(
        &self,
        mesh_force: f64,
        torque_nm: f64,
        positions: usize,
        solver: &(dyn ComplementaritySolver + Sync),
    ) -> Result<SetCycle, FeError> {
        let set = self.clone().under(torque_nm)?;
        let cells = set.bodies.cells_in_time(mesh_force);
        set.cycle_on(torque_nm, &DVector::zeros(0), positions, cells, solver)
    }

    /// [`StaticSet::cycle_here`] with further loads on the races' coordinates (N, one each, or an
    /// empty vector).
    ///
    /// # Errors
    /// As [`StaticSet::cycle`].
    pub fn cycle_with(
        &self,
        torque_nm: f64,
        further: &DVector<f64>,
        positions: usize,
        solver: &(dyn ComplementaritySolver + Sync),
    ) -> Result<SetCycle, FeError> {
        // Grids are sized for an even share of the load. Where a mesh carries far more (a displaced
        // planet), all grids are laid out again for a larger force.
        resized(self.share(torque_nm).max(1.0), |sized_for| {
            self.cycle_on(torque_nm, further, positions, self.bodies.cells(sized_for), solver)
        })
    }

    fn cycle_on(
        &self,
        torque_nm: f64,
        further: &DVector<f64>,
        positions: usize,
        cells: CellSettings,
        solver: &(dyn ComplementaritySolver + Sync),
    ) -> Result<SetCycle, FeError> {
        if positions == 0 {
            return Err(FeError::Unfit {
                key: "positions".into(),
                value: "0".into(),
                allowed: "1 or more".into(),
                why: "a mesh cycle is computed at positions".into(),
            });
        }
        let list: Vec<f64> = (0..positions).map(|i| i as f64 / positions as f64).collect();
        self.states_on(torque_nm, further, &list, cells, solver)
    }

    /// Equilibrium at given positions (cycles), linearised about the present reference.
    ///
    /// # Errors
    /// As [`StaticSet::cycle`], except the check of linear kinematics.
    pub fn at_positions(
        &self,
        torque_nm: f64,
        positions: &[f64],
        solver: &(dyn ComplementaritySolver + Sync),
    ) -> Result<SetCycle, FeError> {
        let none = DVector::zeros(0);
        resized(self.share(torque_nm).max(1.0), |sized_for| {
            self.states_on(torque_nm, &none, positions, self.bodies.cells(sized_for), solver)
        })
    }

    fn states_on(
        &self,
        torque_nm: f64,
        further: &DVector<f64>,
        list: &[f64],
        cells: CellSettings,
        solver: &(dyn ComplementaritySolver + Sync),
    ) -> Result<SetCycle, FeError> {
        finite(torque_nm)?;
        let tables = self.tables_of(cells, list, None)?;
        let f = self.load_with(torque_nm, further);
        if f.amax() > 0.0 {
            self.lay_out_beside(&tables)?;
        }
        let mut states = Vec::with_capacity(list.len());
        let mut start = (self.reference.torque_nm > 0.0).then(|| self.reference.q.clone());
        for &position in list {
            let at = |cause: FeError| cause.at_position(torque_nm, position);
            let found = self.equilibrium(&f, position, &tables, start.as_ref(), solver);
            let mut found = found.map_err(at)?;
            self.lean_all(&f, &tables, &mut found, solver).map_err(at)?;
            states.push(self.state(&found));
            start = Some(found.q);
        }
        Ok(SetCycle { torque_nm: self.sign * torque_nm, lead: self.reference.lead(), states })
    }

    /// An equilibrium in the frame of the scene, with its kinematic rest.
    fn state(&self, found: &Equilibrium<'_>) -> SetState {
        self.state_of(found, self.kinematic_rest(found))
    }

    /// The same with a given kinematic rest, m.
    pub(super) fn state_of(&self, found: &Equilibrium<'_>, kinematic_rest: f64) -> SetState {
        let Equilibrium { position, q, meshes, answers, residual, counts, .. } = found;
        let (central, planets) = self.displacements(q);
        let (loaded, share) = self.races.loaded();
        let mut states: Vec<MeshState> =
            meshes.iter().zip(answers).map(|(mesh, answer)| mesh.state(q, answer)).collect();
        SetState {
            position: *position,
            central,
            loaded_rotation: share * central[loaded.index()][2],
            planets,
            backside: states.split_off(self.nominal.len()),
            meshes: states,
            reactions: self.reactions(found),
            kinematic_rest,
            residual: *residual,
            iterations: counts.0,
            contact_iterations: counts.1,
        }
    }
}

/// Runs `attempt` with a mesh force (N) for which tables are sized, and again for four times the
/// force where loads exceed the tables' grids.
fn resized<T>(
    mut sized_for: f64,
    attempt: impl Fn(f64) -> Result<T, FeError>,
) -> Result<T, FeError> {
    for _ in 0..RESIZINGS {
        match attempt(sized_for) {
            Err(FeError::GridOverflow { .. }) => sized_for *= 4.0,
            result => return result,
        }
    }
    attempt(sized_for)
}

/// Refuses a torque that is not a number, under which all forces would be zero.
fn finite(torque_nm: f64) -> Result<(), FeError> {
    match torque_nm.is_finite() {
        true => Ok(()),
        false => Err(FeError::Unfit {
            key: "operation.torque_nm".into(),
            value: torque_nm.to_string(),
            allowed: "a finite number".into(),
            why: "it loads the teeth".into(),
        }),
    }
}
