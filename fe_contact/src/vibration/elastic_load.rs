//! Loads on the modes of a moving set of quasi-static bodies by what these bodies lack, at one step, to first order: the
//! inertia of their elastic displacements and the static flexibility between different meshes of a body.
//!
//! With the equations of [`ElasticInertia`] (q: motion of a body's race, u_s: its elastic displacement under the
//! forces P_a of its tooth pairs, w: under unit accelerations of its race) and φ, P_i the shape and the pair forces of mode i of
//! unit modal mass, the modal coordinate y_i obeys to first order
//!
//! ```text
//! ÿ_i + 2 ζ_i ω_i ẏ_i + ω_i² y_i = … − d²/dt² (φᵀM_rf u_s − φᵀM_rf w q̈) + Σ_a P_ia ℓ_a w q̈ + Σ_ab P_ia X_ab P_b
//! φᵀM_rf u_s = −Σ_a P_a ℓ_a w(φ)
//! ```
//!
//! For motion in mode i itself, q = φ y and P = P_i y, this is the change of its eigenvalue by [`ElasticInertia::of_mode`] less
//! the kinetic energy R of the elastic displacements, which moved no response of the development sets by a tenth of
//! the change.

use nalgebra::DVector;

use super::body::into_frame;
use super::elastic_inertia::{AcceleratedCarrier, ElasticInertia, product};
use super::frame::Frame;
use super::linear::LinearSet;
use super::set::VibratingSet;
use crate::body::{Accelerated, CarrierBody};
use crate::error::FeError;
use crate::statics::{CARRIER, PLANETS};

/// A mode of a set of quasi-static bodies.
#[derive(Debug, Clone)]
pub struct RaceMode {
    /// Shape on the races' coordinates, of unit modal mass.
    shape: DVector<f64>,
    /// Force of each front mesh, N for a unit modal coordinate.
    mesh_forces: Vec<f64>,
    /// ω², (rad/s)².
    pub lambda: f64,
    /// 2 ζ ω, 1/s.
    pub damping: f64,
}

impl RaceMode {
    /// A mode that moves and presses on nothing, for tests.
    pub fn of(lambda: f64, damping: f64) -> Self {
        Self { shape: DVector::zeros(0), mesh_forces: Vec::new(), lambda, damping }
    }
}

/// Loads on a mode at one step, one for each effect. The first two act by minus their second derivative in time.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ElasticLoad {
    /// φᵀM_rf u_s of the displacement by pair and bearing forces.
    pub pressed: f64,
    /// −φᵀM_rf w q̈ of the displacement by the acceleration of the races.
    pub accelerated: f64,
    /// Σ P_i ℓ w q̈: pairs and bearings give way under the acceleration of the races.
    pub opened: f64,
    /// Σ P_i X P: static flexibility between different meshes of a body.
    pub coupled: f64,
}

impl ElasticInertia {
    /// The modes of the set `set`, linearised as `linear`, from their eigenvalues and shapes of unit modal mass.
    ///
    /// # Errors
    /// If the set has no pairs at its present position.
    pub fn race_modes<'m>(
        set: &VibratingSet<'_>,
        linear: &LinearSet,
        modes: impl Iterator<Item = (f64, &'m [f64])>,
    ) -> Result<Vec<RaceMode>, FeError> {
        let frame = set.frames.current(set.clock.step_in_cycle).ok_or_else(lost)?;
        let beta = set.race_dynamics.damping.beta;
        let one = |(lambda, shape): (f64, &[f64])| {
            let z = DVector::from_column_slice(shape);
            let approaches = &linear.rows * &z;
            // P = S R z
            let forces = &linear.contact * &approaches;
            let mesh_forces = frame.meshes[..set.statics.meshes()]
                .iter()
                .map(|mesh| forces.rows(mesh.first, mesh.count).sum())
                .collect();
            let damping = z.dot(&(&linear.damping * &z)) + beta * approaches.dot(&forces);
            RaceMode { shape: z, mesh_forces, lambda, damping }
        };
        Ok(modes.map(one).collect())
    }

    /// Loads on each mode at the present step of a turning set.
    ///
    /// # Errors
    /// If the set has not been stepped or put to rest yet.
    pub fn loads(
        &self,
        set: &VibratingSet<'_>,
        modes: &[RaceMode],
    ) -> Result<Vec<ElasticLoad>, FeError> {
        let frame = set.frames.current(set.clock.step_in_cycle).ok_or_else(lost)?;
        let mut loads = vec![ElasticLoad::default(); modes.len()];
        let moved = DVector::from_column_slice(&set.motion().a);
        for k in 0..set.bodies.gears.len() {
            self.add_gear_loads(set, frame, k, (modes, &moved), &mut loads);
        }
        if let (Some(own), Some(body)) = (&self.carrier, &set.races().carrier) {
            add_carrier_loads(set, (own, body), (modes, &moved), &mut loads);
        }
        Ok(loads)
    }

    /// Least Rayleigh quotient of the displacements w, close to the first eigenvalue of a body with its race held, (rad/s)².
    pub fn first(&self) -> f64 {
        let carrier = self.carrier.as_ref().map_or(f64::INFINITY, |own| own.first);
        self.gears.iter().map(Accelerated::first).fold(carrier, f64::min)
    }

    fn add_gear_loads(
        &self,
        set: &VibratingSet<'_>,
        frame: &Frame,
        k: usize,
        (modes, moved): (&[RaceMode], &DVector<f64>),
        loads: &mut [ElasticLoad],
    ) {
        let (gear, own) = (set.bodies.gears[k].body, &self.gears[k.min(2)]);
        let forces = &set.pairs.forces;
        let of_meshes: Vec<f64> = set.pairs.of_meshes(frame).collect();
        // A mode's mesh force on the pairs as the motion shares it among them.
        let of_mode = |mode: &RaceMode, pair: usize| {
            let mesh = frame.pattern.mesh_of(pair);
            let own = mode.mesh_forces.get(mesh).copied().unwrap_or(0.0);
            if of_meshes[mesh] == 0.0 { 0.0 } else { own * forces[pair] / of_meshes[mesh] }
        };
        // x, y and θ of the race.
        let race = |z: &DVector<f64>| {
            let mut q = set.races().displaced(z, k + 1);
            q[2] /= set.races().radii[(k + 1).min(PLANETS)];
            q
        };
        let a = race(moved);
        let shapes: Vec<[f64; 3]> = modes.iter().map(|mode| race(&mode.shape)).collect();
        let [c, r] = own.coupled;
        for (q, load) in shapes.iter().zip(loads.iter_mut()) {
            load.accelerated -= c * (q[0] * a[0] + q[1] * a[1]) + r * q[2] * a[2];
        }
        let ports = &frame.pattern.own[k];
        for (pair, e) in ports.iter().filter(|(pair, _)| forces[*pair] != 0.0) {
            let Some(ends) = frame.pattern.ends[*pair].as_ref() else { continue };
            let (point, axis) = (&ends[*e].end, ends[*e].axis);
            let at = |q: [f64; 3]| {
                own.at(gear, (point.load.as_slice(), point.direction), into_frame(q, axis))
            };
            // ℓ w, linear in the acceleration of the race.
            let unit = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(at);
            let along = |q: [f64; 3]| unit[0] * q[0] + unit[1] * q[1] + unit[2] * q[2];
            let opened = along(a);
            for ((mode, q), load) in modes.iter().zip(&shapes).zip(loads.iter_mut()) {
                load.pressed -= forces[*pair] * along(*q);
                load.opened += of_mode(mode, *pair) * opened;
            }
        }
        let across = &frame.pattern.across(&set.bodies.gears)[k];
        // X P
        let bent: Vec<f64> = (0..ports.len())
            .map(|i| ports.iter().enumerate().map(|(j, (b, _))| across[(i, j)] * forces[*b]).sum())
            .collect();
        for (mode, load) in modes.iter().zip(loads.iter_mut()) {
            let own = ports.iter().zip(&bent).map(|((pair, _), bent)| of_mode(mode, *pair) * bent);
            load.coupled += own.sum::<f64>();
        }
    }
}

/// Those of the carrier, on whose seats the planet bearings press with F = (I/k + A)⁻¹ B q.
fn add_carrier_loads(
    set: &VibratingSet<'_>,
    (own, body): (&AcceleratedCarrier, &CarrierBody),
    (modes, moved): (&[RaceMode], &DVector<f64>),
    loads: &mut [ElasticLoad],
) {
    let race = |z: &DVector<f64>| {
        let mut q = set.races().displaced(z, CARRIER);
        q[2] /= set.races().radii[CARRIER];
        q
    };
    let bearings = &set.race_dynamics.bearings;
    let seats = |z: &DVector<f64>| &set.race_dynamics.seat_stiffness * (&bearings.rigid * z);
    let w_moved = own.displaced(race(moved));
    let opened: Vec<f64> = bearings.ports.iter().map(|port| port.read(&w_moved)).collect();
    let forces = seats(&DVector::from_column_slice(&set.motion().x));
    for (mode, load) in modes.iter().zip(loads.iter_mut()) {
        let q = race(&mode.shape);
        let w = own.displaced(q);
        let pressed = bearings.ports.iter().zip(forces.iter()).map(|(port, f)| f * port.read(&w));
        load.pressed += pressed.sum::<f64>();
        let given = seats(&mode.shape);
        load.opened -= given.iter().zip(&opened).map(|(f, opened)| f * opened).sum::<f64>();
        let inertia = body.matrices.coupling.iter().zip(q);
        load.accelerated -= inertia.map(|(m, q)| q * product(m, &w_moved)).sum::<f64>();
    }
}

fn lost() -> FeError {
    FeError::NoEquilibrium("no mesh touches: a mode has no mesh forces".into())
}

#[cfg(test)]
mod tests {
    use gearset::{Facing, Scene};

    use super::super::prepared::Loading;
    use super::super::rotation::NominalRotation;
    use super::*;
    use crate::statics::{Bodies, Imperfections};

    /// A set that moves in one of its modes, q = φ, q̈ = −λφ and P = P_i, loads this mode by −δλ of the same effects, because
    /// ÿ + (λ + δλ) y = 0; a load that lost a sign, a frame or a body would not.
    #[test]
    fn motion_in_a_mode_loads_it_by_the_change_of_its_eigenvalue() {
        let path = format!("{}/../scenes/oh58_4p.toml", env!("CARGO_MANIFEST_DIR"));
        let mut scene = Scene::from_file(path.as_ref()).unwrap();
        scene.fe_contact.flank_elements = 8;
        let bodies = Bodies::new(&scene).unwrap();
        let (sense, none) = (Facing::CounterClockwise, Imperfections::default());
        let rotation = NominalRotation::Standing { position: 0.0, step: 5e-6 };
        let loading = Loading { torque_nm: 1130.0, mesh_force: 8000.0 };
        let mut set = VibratingSet::new(&scene, &bodies, sense, none, rotation, loading).unwrap();
        set.rest(1130.0).unwrap();
        let linear = set.linearised().unwrap();
        let inertia = ElasticInertia::new(&set).unwrap().unwrap();
        let (frequencies, shapes) = linear.undamped().unwrap();
        let lambda = |i: usize| (std::f64::consts::TAU * frequencies[i]).powi(2);
        let columns: Vec<Vec<f64>> =
            shapes.column_iter().map(|c| c.iter().copied().collect()).collect();
        let list = columns.iter().enumerate().map(|(i, c)| (lambda(i), c.as_slice()));
        let modes = ElasticInertia::race_modes(&set, &linear, list).unwrap();
        let mut compared = 0;
        for (i, shape) in columns.iter().enumerate().filter(|(i, _)| frequencies[*i] > 100.0) {
            let z = DVector::from_column_slice(shape);
            set.pairs.forces = &linear.contact * (&linear.rows * &z);
            set.race_dynamics.motion.x.copy_from_slice(shape);
            let a = shape.iter().map(|x| -lambda(i) * x).collect::<Vec<_>>();
            set.race_dynamics.motion.a.copy_from_slice(&a);
            let load = inertia.loads(&set, &modes).unwrap()[i];
            let sum = lambda(i) * (load.pressed + load.accelerated) + load.opened + load.coupled;
            let shift = inertia.of_mode(&set, &linear, shape, lambda(i)).unwrap();
            let expected = -lambda(i) * (shift.inertia + shift.coupling);
            let size = lambda(i) * (shift.inertia.abs() + shift.coupling.abs());
            assert!((sum - expected).abs() < 1e-9 * size, "{i}: {sum:e} {expected:e}");
            compared += 1;
        }
        assert!(compared > 14, "{compared}");
    }
}
