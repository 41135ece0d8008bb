//! The lumped set in time: mesh springs replaced by tables of mesh force over deflection and phase. Integrated by
//! Newmark's average acceleration, with as many steps per mesh cycle as the law has.
//!
//! Computed with counter-clockwise torque on the sun: for clockwise torque the set is mirrored, and its
//! displacements are mirrored back.

use std::sync::Arc;

use nalgebra::DMatrix;

use dynamics::{
    AverageAcceleration, CarriedChange, Coupled, CoupledError, CoupledState, Coupling,
    CouplingForce, CyclePart, LinearPart, MapDerivative, Motion, Number, PassedSteps, Renumbering,
};
use gearset::{Axis, Body, Facing, Member, MeshLaw, Symmetry};
use scene::Scene;

use crate::coordinates::Coordinates;
use crate::error::LumpedError;
use crate::model::LumpedModel;
use crate::relative_rotation::RelativeRotation;
use crate::springs::{Rows, SpringId};

/// The forces of a mesh law as couplings: front flanks of all meshes, then backside flanks if the law has them.
#[derive(Debug, Clone)]
pub struct MeshLawCouplings(pub(crate) Arc<MeshLaw>);

impl CouplingForce for MeshLawCouplings {
    #[inline]
    fn answer(&self, coupling: usize, step_in_cycle: usize, deflection: f64) -> (f64, f64) {
        self.0.force(coupling, step_in_cycle, deflection)
    }

    fn silent_up_to(&self, coupling: usize) -> f64 {
        self.0.silent_up_to_m(coupling)
    }

    fn is_same(&self, first: (usize, usize), second: (usize, usize)) -> bool {
        self.0.is_same(first, second)
    }
}

/// A lumped set in time, its mesh forces given by a mesh law.
///
/// `[eq:lumped-in-time]` M q̈ + (α M + β_b K_s) q̇ + K_s q + Σ b P = f, P = F(phase, δ + s β δ̇), δ = bᵀ q, with K_s
/// of supports and bearings, rows b of the meshes as in the eigen model, F from the mesh law and the damping share s
/// of the mesh. f is the torque on the sun and, if the law has them, the side loads.
/// Source: derived here.
/// Checked by: `lumped/tests/time_varying.rs::static_deflection_is_the_stiffness_matrix_solved`,
/// `lumped/tests/time_varying.rs::natural_modes_are_those_of_the_eigen_model`,
/// `lumped/tests/time_varying.rs::damping_of_a_mesh_is_that_of_its_bodies_share`.
#[derive(Debug, Clone)]
pub struct TimeVarying {
    layout: Layout,
    system: Coupled<MeshLawCouplings>,
}

/// What a set consists of, in the coordinates of counter-clockwise torque on the sun.
pub(crate) struct Parts {
    pub(crate) layout: Layout,
    /// Masses, supports and bearings, without meshes.
    pub(crate) linear: LinearPart,
    pub(crate) front: Vec<Coupling>,
    pub(crate) backside: Vec<Coupling>,
    /// Forces on the coordinates by step of the cycle, N.
    pub(crate) side_loads: Vec<Vec<f64>>,
}

/// Which displacements the coordinates are and how a torque loads them. Of a pair whose gears both turn freely, these
/// and the equations are those of the coordinates with one relative rotation.
#[derive(Debug, Clone)]
pub(crate) struct Layout {
    pub(crate) coordinates: Coordinates,
    /// r in u = r θ of carrier, ring, sun and planet, m.
    radii: [f64; 4],
    /// Load on the coordinates by a unit torque on the sun, N/(N m); a planet of a pair that turns freely has the
    /// torque that balances it.
    pub(crate) by_torque: Vec<f64>,
    /// How the rotations of a pair whose gears both turn freely are one coordinate.
    relative: Option<RelativeRotation>,
    sign: f64,
    /// Angles of the planets, of a set mirrored to counter-clockwise torque on the sun, rad.
    psi_rad: Vec<f64>,
    /// Inertias of carrier, ring, sun and planets along their displacements, kg, kg, kg m²; 0 where held.
    inertias: Vec<[f64; 3]>,
}

impl Parts {
    /// # Errors
    /// If the scene lacks lumped parameters or radii, the law has another number of meshes, or damping is out of
    /// range.
    pub(crate) fn new(scene: &Scene, sense: Facing, law: &MeshLaw) -> Result<Self, LumpedError> {
        let sign = sense.sign();
        let mut seen = scene.clone();
        for psi in &mut seen.planets.psi_rad {
            *psi *= sign;
        }
        let model = LumpedModel::from_scene(&seen)?;
        let lumped = scene.lumped.as_ref().ok_or(LumpedError::NoParameters)?;
        let planets = model.psi.len();
        let wanted = if scene.supports.pair.is_some() { 1 } else { 2 * planets };
        if law.meshes() != wanted {
            return Err(LumpedError::Law { got: law.meshes(), wanted });
        }
        let d = &scene.damping;
        for (key, value) in [
            ("mass_proportional_per_s", d.mass_proportional_per_s),
            ("stiffness_proportional_s", d.stiffness_proportional_s),
            ("bearing_s", d.bearing_s),
        ] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(LumpedError::Damping { key, value });
            }
        }
        let radius = |body: Body| match lumped.radius_m.of(body) {
            Some(r) => Ok(r),
            // A body that cannot rotate needs no radius.
            None if model.coordinates.of(body, Axis::Rotation).is_none() => Ok(1.0),
            None => Err(LumpedError::NoRotation { body }),
        };
        let radii = [
            radius(Body::Carrier)?,
            radius(Body::Ring)?,
            radius(Body::Sun)?,
            radius(Body::Planet(0))?,
        ];
        let n = model.coordinates.count();
        let mut stiffness = DMatrix::zeros(n, n);
        let is_mesh = |id| matches!(id, SpringId::SunMesh(_) | SpringId::RingMesh(_));
        for spring in model.springs.iter().filter(|s| !is_mesh(s.id)) {
            for row in &spring.rows {
                for &(i, bi) in row {
                    for &(j, bj) in row {
                        stiffness[(i, j)] += spring.stiffness * bi * bj;
                    }
                }
            }
        }
        // C = α M + β_b K_s
        let damping = DMatrix::from_fn(n, n, |i, j| {
            let own = if i == j { d.mass_proportional_per_s * model.mass[i] } else { 0.0 };
            own + d.bearing_s * stiffness[(i, j)]
        });
        let [mut front, mut backside] = couplings(&model, lumped, d.stiffness_proportional_s, law);
        let mut linear = LinearPart { mass: model.mass.clone(), damping, stiffness };
        let mut side_loads = side_loads(&model, law);
        let mut by_torque = vec![0.0; n];
        let balances = scene.supports.pair.is_some_and(|pair| pair.planet.turns_freely());
        // f_u = T_s / r_s; of a planet T_p / r_p with T_p = T_s r_p / r_s.
        let of_sun = 1.0 / radii[2];
        let teeth = scene.teeth.and_then(|teeth| teeth.sun_ring());
        let (z_s, z_r) = teeth.map_or((1.0, 1.0), |(sun, ring)| (f64::from(sun), f64::from(ring)));
        // T_s : T_r : T_c = Z_s : Z_r : −(Z_s + Z_r), on the member that turns without support.
        let loaded = match scene.loaded_member() {
            Ok(Member::Ring) => (Body::Ring, z_r / z_s / radii[1]),
            Ok(Member::Carrier) => (Body::Carrier, -(z_s + z_r) / z_s / radii[0]),
            Ok(Member::Sun) | Err(_) => (Body::Sun, of_sun),
        };
        let balancing = balances.then_some((Body::Planet(0), of_sun));
        for (body, force) in std::iter::once(loaded).chain(balancing) {
            if let Some(i) = model.coordinates.of(body, Axis::Rotation) {
                by_torque[i] = force;
            }
        }
        let relative = RelativeRotation::of(scene, &model);
        if let Some(relative) = &relative {
            linear = relative.reduce(&linear);
            for coupling in front.iter_mut().chain(&mut backside) {
                *coupling = relative.coupling(coupling);
            }
            side_loads.iter_mut().for_each(|load| *load = relative.reduced(load));
            by_torque = relative.reduced(&by_torque);
        }
        let inertias = inertias(&model, radii);
        let (coordinates, psi_rad) = (model.coordinates, model.psi);
        let layout = Layout { coordinates, radii, by_torque, relative, sign, psi_rad, inertias };
        Ok(Self { layout, linear, front, backside, side_loads })
    }
}

/// Inertias of all bodies along their displacements; `radii` as in [`Layout`].
fn inertias(model: &LumpedModel, radii: [f64; 4]) -> Vec<[f64; 3]> {
    let of = |body: Body, radius: f64| {
        let [first, second, turning] =
            Axis::ALL.map(|axis| model.coordinates.of(body, axis).map_or(0.0, |i| model.mass[i]));
        [first, second, turning * radius * radius]
    };
    Body::all(model.psi.len()).map(|body| of(body, radii[body.kind()])).collect()
}

impl Layout {
    /// Displacements of carrier, ring, sun (x, y, m; θ, rad) and of the planets from coordinates x.
    pub(crate) fn by_body(&self, x: impl Fn(usize) -> f64) -> ([[f64; 3]; 3], Vec<[f64; 3]>) {
        let of = |body: Body| {
            let at = |i: usize| match &self.relative {
                Some(relative) => relative.full(i, &x),
                None => x(i),
            };
            let value = |axis| self.coordinates.of(body, axis).map_or(0.0, at);
            let [first, second, u] = Axis::ALL.map(value);
            // Mirrored back: y and θ change sign.
            [first, self.sign * second, self.sign * u / self.radii[body.kind()]]
        };
        let planets = (0..self.psi_rad.len()).map(Body::Planet);
        (Body::CENTRAL.map(of), planets.map(of).collect())
    }

    /// The error with body and quantity in place of a coordinate's number.
    #[cold]
    fn named(&self, cause: CoupledError) -> LumpedError {
        let CoupledError::Diverged { time_s, coordinate, value } = cause else {
            return cause.into();
        };
        // A relative rotation leaves out the planet's.
        let is_after = self.relative.as_ref().is_some_and(|own| coordinate >= own.planet);
        match self.coordinates.free().get(coordinate + usize::from(is_after)) {
            Some(&(body, axis)) => LumpedError::Diverged { time_s, body, axis, value },
            None => cause.into(),
        }
    }
}

impl TimeVarying {
    /// A set at rest without load at step 0 of a mesh cycle, for torques on the sun of the given sense, with
    /// as many steps per cycle as the law has.
    ///
    /// # Errors
    /// If the scene lacks lumped parameters or radii, the law has another number of meshes, or frequency or
    /// damping is out of range.
    pub fn new(
        scene: &Scene,
        sense: Facing,
        law: impl Into<Arc<MeshLaw>>,
        mesh_frequency_hz: f64,
    ) -> Result<Self, LumpedError> {
        let law = law.into();
        let steps = law.steps();
        let rule = time_steps(mesh_frequency_hz, steps)?;
        let Parts { layout, linear, front, backside, side_loads } = Parts::new(scene, sense, &law)?;
        let mut system =
            Coupled::new(&linear, &front, &backside, MeshLawCouplings(law), rule, steps)?;
        if let Ok(geometry) = scene.tooth_geometry() {
            system = system.bounded_by(geometry.largest_displacement());
        }
        for (step, load) in side_loads.iter().enumerate() {
            system.add_in_cycle(step, load)?;
        }
        Ok(Self { layout, system })
    }

    /// The same set under the same torque at another mesh frequency, at the origin at step 0 of a mesh cycle.
    ///
    /// # Errors
    /// If the frequency is out of range.
    pub fn at_frequency(&self, mesh_frequency_hz: f64) -> Result<Self, LumpedError> {
        let rule = time_steps(mesh_frequency_hz, self.system.law().0.steps())?;
        Ok(Self { layout: self.layout.clone(), system: self.system.at(rule)? })
    }

    /// Puts the set to rest under a torque on the sun (N m, magnitude) at its current step.
    ///
    /// # Errors
    /// If there is no equilibrium.
    pub fn rest(&mut self, torque_nm: f64) -> Result<(), LumpedError> {
        self.load(torque_nm)?;
        Ok(self.system.rest()?)
    }

    /// Loads the set by a torque on the sun (N m, magnitude) from now on, its state left as it is.
    ///
    /// # Errors
    /// None with a set that was made.
    pub fn load(&mut self, torque_nm: f64) -> Result<(), LumpedError> {
        let force: Vec<f64> = self.layout.by_torque.iter().map(|f| f * torque_nm).collect();
        Ok(self.system.set_external(&force)?)
    }

    /// One step.
    ///
    /// # Errors
    /// If the step is not solved or the motion diverges.
    pub fn step(&mut self) -> Result<(), LumpedError> {
        self.system.step().map_err(|cause| self.layout.named(cause))
    }

    /// Displacements of carrier, ring, sun (x, y, m; θ, rad; carrier frame) and of the planets
    /// (ζ, η, θ), counter-clockwise.
    pub fn displacements(&self) -> ([[f64; 3]; 3], Vec<[f64; 3]>) {
        self.layout.by_body(|i| self.system.displacement(i))
    }

    /// The same in coordinates `y` as those of [`TimeVarying::coordinates_of_motion`].
    pub fn displacements_of(&self, y: &[f64]) -> ([[f64; 3]; 3], Vec<[f64; 3]>) {
        let x = self.system.displacements_of(y);
        self.layout.by_body(|i| x[i])
    }

    /// Inertias of carrier, ring, sun and planets along these displacements, kg, kg, kg m²; 0 where held.
    pub fn inertias(&self) -> &[[f64; 3]] {
        &self.layout.inertias
    }

    /// Angles of the planets, of the set mirrored to counter-clockwise torque on the sun, rad.
    pub fn planet_angles_rad(&self) -> &[f64] {
        &self.layout.psi_rad
    }

    /// Force of each mesh: sun meshes, ring meshes, then their backside flanks if the law has them, N.
    pub fn mesh_forces(&self, out: &mut Vec<f64>) {
        out.clear();
        out.extend_from_slice(self.forces());
    }

    /// The same as they are kept, N.
    pub fn forces(&self) -> &[f64] {
        self.system.forces()
    }

    /// Whether the law's tables contain all deflections of the present step; beyond their last node forces
    /// are extrapolated linearly.
    pub fn is_within_tables(&self) -> bool {
        let (tables, step) = (self.system.law(), self.step_in_cycle());
        let deflections = self.system.deflections();
        let mut each = deflections.iter().enumerate();
        each.all(|(k, d)| tables.0.curve(k, step).is_none_or(|curve| curve.reaches(*d)))
    }

    /// Step in the mesh cycle.
    pub fn step_in_cycle(&self) -> usize {
        self.system.state().step_in_cycle
    }

    /// Time since the start, s.
    pub fn time(&self) -> f64 {
        self.system.time()
    }

    /// The state from which the motion can be continued exactly.
    pub fn state(&self) -> &CoupledState {
        self.system.state()
    }

    /// Continues from an earlier state of this set; the motion repeats bit by bit.
    ///
    /// # Errors
    /// If the state is of another set.
    pub fn set_state(&mut self, state: &CoupledState) -> Result<(), LumpedError> {
        Ok(self.system.set_state(state)?)
    }

    /// Displacements, velocities and accelerations of the free coordinates (u = r θ; of the set mirrored to
    /// counter-clockwise torque), m and s. Of a pair whose gears both turn freely the sum of their u stands in the
    /// sun's place, and the planet's falls away.
    pub fn motion(&self) -> Motion {
        self.system.motion()
    }

    /// Sets displacements (m) and velocities (m/s) of the same coordinates at a step of the cycle.
    ///
    /// # Errors
    /// If there is not one number for each coordinate.
    pub fn set_motion(
        &mut self,
        step_in_cycle: usize,
        x: &[f64],
        v: &[f64],
    ) -> Result<(), LumpedError> {
        Ok(self.system.set_motion(step_in_cycle, x, v)?)
    }

    /// Displacements and velocities of the modes of the bodies on their supports: they determine the motion that
    /// follows.
    pub fn coordinates_of_motion(&self) -> Vec<f64> {
        self.system.coordinates()
    }

    /// Continues from other such coordinates at the present step of the cycle.
    ///
    /// # Errors
    /// If they are too few or too many, or not finite.
    pub fn set_coordinates(&mut self, y: &[f64]) -> Result<(), LumpedError> {
        Ok(self.system.set_coordinates(y)?)
    }

    /// The symmetry after a part of the mesh cycle that the set has, with the most parts.
    pub fn symmetry(&self) -> Option<(Symmetry, CyclePart)> {
        let Layout { coordinates, psi_rad, sign, .. } = &self.layout;
        let couplings = self.system.forces().len();
        let place = |body, axis| coordinates.of(body, axis);
        // The planets' angles are those of the set mirrored to counter-clockwise torque.
        let steps = self.system.law().0.steps();
        let all = Symmetry::renumberings(psi_rad, steps, couplings, place);
        all.into_iter().find_map(|(own, coordinates, couplings)| {
            let renumbering = Renumbering { parts: own.parts, coordinates, couplings };
            Some((own.seen_with(*sign), self.system.part_of_cycle(&renumbering)?))
        })
    }

    /// Ends such a part that began at step 0: the set stands at step 0 again, its planets renumbered.
    pub fn take_part_back(&mut self, part: &CyclePart) {
        self.system.take_part_back(part);
    }

    /// Adds the present state to those passed.
    pub fn keep_step(&self, passed: &mut PassedSteps) {
        self.system.keep_step(passed);
    }

    /// The derivative of the last of the states passed with respect to the first, between which every step was
    /// kept, computed in the precision of T; frequencies of the motion are of the order of `rate` (rad/s). `None`
    /// without a state.
    pub fn derivative_of<T: Number>(
        &self,
        passed: &PassedSteps,
        rate: f64,
    ) -> Option<MapDerivative> {
        self.system.derivative_of::<T>(passed, rate)
    }

    /// The same in double precision, with a change of the coordinates at the start carried along. `None` also for a
    /// change of another size.
    pub fn derivative_with(
        &self,
        passed: &PassedSteps,
        rate: f64,
        change: CarriedChange<'_>,
    ) -> Option<MapDerivative> {
        self.system.derivative_with(passed, rate, change)
    }

    /// Free coordinates.
    pub fn coordinates(&self) -> &Coordinates {
        &self.layout.coordinates
    }

    /// Mean number of iterations per step so far, and number of steps with backside flanks in the solution.
    pub fn counts(&self) -> (f64, u64) {
        let steps = self.system.state().steps.max(1) as f64;
        (self.system.iterations as f64 / steps, self.system.with_rare)
    }
}

/// Time steps of which some `steps` make a mesh cycle.
fn time_steps(mesh_frequency_hz: f64, steps: usize) -> Result<AverageAcceleration, LumpedError> {
    if !(mesh_frequency_hz > 0.0 && mesh_frequency_hz.is_finite()) {
        return Err(LumpedError::Frequency(mesh_frequency_hz));
    }
    AverageAcceleration::new(1.0 / (mesh_frequency_hz * steps as f64))
        .map_err(|_| LumpedError::Frequency(mesh_frequency_hz))
}

/// The law's side loads on the free coordinates, by step, N.
fn side_loads(model: &LumpedModel, law: &MeshLaw) -> Vec<Vec<f64>> {
    let planets = model.psi.len();
    let directions: Vec<(f64, f64)> = model.psi.iter().map(|psi| psi.sin_cos()).collect();
    let of_step = |step: usize| {
        let mut load = vec![0.0; model.coordinates.count()];
        for mesh in 0..law.meshes() {
            let n = mesh % planets;
            let central = if mesh < planets { Body::Sun } else { Body::Ring };
            let (sin, cos) = directions[n];
            let [radial, tangential, u, zeta, eta, spin] = law.side_load(mesh, step);
            let [x, y] = [cos * radial - sin * tangential, sin * radial + cos * tangential];
            for (body, own) in [(central, [x, y, u]), (Body::Planet(n), [zeta, eta, spin])] {
                for (axis, f) in Axis::ALL.into_iter().zip(own) {
                    if let Some(i) = model.coordinates.of(body, axis) {
                        load[i] += f;
                    }
                }
            }
        }
        load
    };
    (0..law.steps()).map(of_step).collect()
}

/// Front and backside flanks of all meshes as couplings; the lag of each is its damping share times β, s.
fn couplings(
    model: &LumpedModel,
    lumped: &scene::LumpedInput,
    beta: f64,
    law: &MeshLaw,
) -> [Vec<Coupling>; 2] {
    let rows = Rows { coordinates: &model.coordinates };
    let angle = &lumped.pressure_angle_rad;
    let planets = model.psi.len();
    let coupling = |mesh: usize, entries: Vec<(usize, f64)>| {
        let mut row = vec![0.0; model.coordinates.count()];
        entries.into_iter().for_each(|(i, b)| row[i] += b);
        Coupling { row, offset: 0.0, lag: beta * law.damping_share(mesh) }
    };
    let mut front = Vec::with_capacity(2 * planets);
    let mut backside = Vec::with_capacity(2 * planets);
    for (n, &psi) in model.psi.iter().enumerate() {
        front.push(coupling(n, rows.sun_mesh(n, psi, angle.sun_planet)));
        backside.push(coupling(n, rows.sun_backside(n, psi, angle.sun_planet)));
    }
    let with_ring = if law.meshes() == 2 * planets { &model.psi[..] } else { &[] };
    for (n, &psi) in with_ring.iter().enumerate() {
        front.push(coupling(planets + n, rows.ring_mesh(n, psi, angle.ring_planet)));
        backside.push(coupling(planets + n, rows.ring_backside(n, psi, angle.ring_planet)));
    }
    if !law.has_backside() {
        backside.clear();
    }
    [front, backside]
}
