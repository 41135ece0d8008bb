//! Impulse test: pulses on a preloaded standing set, and identification of modes from its free decays.

use dynamics::identify::{Identification, Scaling, identify};
use dynamics::orthonormal_basis;
use fe_contact::FeError;
use fe_contact::statics::{Bodies, Races};
use fe_contact::vibration::VibratingSet;
use gearset::{Axis, Body};
use scene::Scene;

use super::error::ModalError;
use super::kinds::{MotionKinds, type_of};
use super::linear::preloaded;
use super::mode::FeMode;
use super::settings::ImpulseSettings;

/// A generalised force on the races for one time step.
#[derive(Debug, Clone, PartialEq)]
pub struct Pulse {
    /// Name: body and coordinate on which it acts.
    pub name: String,
    /// Its pattern on the races' coordinates, of unit size.
    pub pattern: Vec<f64>,
}

/// Free decay after one pulse.
#[derive(Debug, Clone)]
pub struct Decay {
    /// The pulse.
    pub pulse: Pulse,
    /// Its force, N.
    pub force_n: f64,
    /// Displacement of every race coordinate from rest, after each step, m.
    pub records: Vec<Vec<f64>>,
    /// Largest change of a mesh force over the largest mesh force.
    pub force_change: f64,
    /// Largest deviation of the response to half the pulse from half the response, over its largest
    /// value.
    pub nonlinearity: f64,
}

/// Largest motions of the sun under one pulse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contents {
    /// Largest |(x, y)|, m.
    pub translation: f64,
    /// Largest |r_b θ|, m.
    pub rotation: f64,
}

/// An impulse test and what was identified from it.
#[derive(Debug, Clone)]
pub struct ImpulseTest {
    /// Settings.
    pub settings: ImpulseSettings,
    /// One decay per pulse.
    pub decays: Vec<Decay>,
    /// Modes, ascending.
    pub modes: Vec<FeMode>,
    /// Complete result of the identification, with its stabilisation chart.
    pub identification: Identification,
    /// Total number of time steps.
    pub steps: u64,
}

/// Forces on sun and carrier (of a gear pair on sun and planet), a torque on the sun (where it is held, on ring
/// and carrier), and pulses on the planets that do not move the central members: radial, tangential and
/// rotational, in every pattern over the planets orthogonal to 1, cos ψ and sin ψ.
pub fn pulses(races: &Races) -> Vec<Pulse> {
    let single = |name: &str, body: Body, axis: Axis| {
        let i = races.of(body, axis)?;
        let mut pattern = vec![0.0; races.count];
        pattern[i] = 1.0;
        Some(Pulse { name: name.into(), pattern })
    };
    let central = [
        ("sun x force", Body::Sun, Axis::First),
        ("sun y force", Body::Sun, Axis::Second),
        ("carrier x force", Body::Carrier, Axis::First),
        ("carrier y force", Body::Carrier, Axis::Second),
        ("sun torque", Body::Sun, Axis::Rotation),
    ];
    // A sun that is held is not pushed: the member that turns in its place is.
    let instead = [
        ("ring x force", Body::Ring, Axis::First),
        ("ring y force", Body::Ring, Axis::Second),
        ("ring torque", Body::Ring, Axis::Rotation),
        ("carrier torque", Body::Carrier, Axis::Rotation),
    ];
    let rotation = |body| races.of(body, Axis::Rotation);
    let turns = rotation(Body::Sun).is_some();
    let central = central.into_iter().chain(instead.into_iter().filter(|_| !turns));
    let mut list: Vec<Pulse> =
        central.filter_map(|(name, body, axis)| single(name, body, axis)).collect();
    if races.is_pair() {
        // No pattern over one planet leaves the sun at rest.
        let planet = Body::Planet(0);
        let names = ["planet x force", "planet y force", "planet torque"];
        let is_new = rotation(planet) != rotation(Body::Sun);
        let own = names.into_iter().zip(Axis::ALL);
        let own = own.filter(|(_, axis)| *axis != Axis::Rotation || is_new);
        list.extend(own.filter_map(|(name, axis)| single(name, planet, axis)));
        return list;
    }
    let n = races.planets();
    let of = |f: &dyn Fn(f64) -> f64| races.psi.iter().map(|psi| f(*psi)).collect::<Vec<f64>>();
    let known = orthonormal_basis(&[of(&|_| 1.0), of(&f64::cos), of(&f64::sin)], &[]);
    let units: Vec<Vec<f64>> =
        (0..n).map(|i| (0..n).map(|k| f64::from(u8::from(k == i))).collect()).collect();
    for (which, weights) in orthonormal_basis(&units, &known).iter().enumerate() {
        for (axis, name) in Axis::ALL.into_iter().zip(["radially", "tangentially", "turning"]) {
            let mut pattern = vec![0.0; races.count];
            for (planet, weight) in weights.iter().enumerate() {
                if let Some(i) = races.of(Body::Planet(planet), axis) {
                    pattern[i] = *weight;
                }
            }
            list.push(Pulse { name: format!("planets {name}, pattern {which}"), pattern });
        }
    }
    list
}

/// Applies every pulse in turn to a preloaded set and identifies its modes.
///
/// # Errors
/// If the settings are refused, the set cannot be set up or does not stay at rest, a step fails, or nothing
/// can be identified.
pub fn impulse_test(
    scene: &Scene,
    bodies: &Bodies,
    settings: &ImpulseSettings,
) -> Result<ImpulseTest, ModalError> {
    settings.check()?;
    let mut set = preloaded(scene, bodies, &settings.preload)?;
    let steps = settings.steps();
    stand_still(&mut set, settings)?;
    let few = settings.trial_steps;
    let mut decays = Vec::new();
    let mut taken = 0;
    for pulse in pulses(set.races()).into_iter().filter(|p| settings.takes(&p.name)) {
        // A short trial determines the force for the wanted change of mesh force.
        let trial = 1e-3 * largest(&mesh_forces(&set)).max(1.0);
        let (_, change) = decay(&mut set, settings, &pulse, trial, steps.min(few))?;
        let force_n = trial * settings.size / change.max(f64::MIN_POSITIVE);
        let (records, force_change) = decay(&mut set, settings, &pulse, force_n, steps)?;
        if force_change > PROPORTION * settings.size {
            return Err(ModalError::Unsteady { torque_nm: settings.preload.load.sun_torque_nm });
        }
        let (half, _) = decay(&mut set, settings, &pulse, 0.5 * force_n, steps.min(few))?;
        taken += (2 * steps.min(few) + steps) as u64;
        let peak = records.iter().map(|r| largest(r)).fold(0.0, f64::max);
        let off = records
            .iter()
            .zip(&half)
            .flat_map(|(whole, half)| whole.iter().zip(half).map(|(w, h)| (0.5 * w - h).abs()))
            .fold(0.0, f64::max);
        decays.push(Decay { pulse, force_n, records, force_change, nonlinearity: off / peak });
    }
    let records: Vec<Vec<Vec<f64>>> = decays.iter().map(|d| d.records.clone()).collect();
    let mut options = settings.identification();
    // All outputs are in metres: a common scale does not magnify coordinates at rest.
    let scale = 1.0 / records.iter().flatten().map(|r| largest(r)).fold(0.0, f64::max);
    options.scaling = Scaling::Given(vec![scale; set.races().count]);
    let identification = identify(&records, settings.preload.step_s, &options)?;
    let modes = typed(&set, &identification)?;
    Ok(ImpulseTest { settings: *settings, decays, modes, identification, steps: taken })
}

/// Steps without a pulse, and the largest change of a mesh force over them relative to that by the pulses.
const STILL: (usize, f64) = (20, 0.01);

/// The set is unsteady if a pulse changes a mesh force by more than this multiple of the intended change.
const PROPORTION: f64 = 10.0;

/// Checks that the set stays at rest without a pulse.
fn stand_still(set: &mut VibratingSet<'_>, settings: &ImpulseSettings) -> Result<(), ModalError> {
    let unsteady = || ModalError::Unsteady { torque_nm: settings.preload.load.sun_torque_nm };
    let nothing = Pulse { name: String::new(), pattern: vec![0.0; set.races().count] };
    match decay(set, settings, &nothing, 0.0, STILL.0) {
        Ok((_, change)) if change <= STILL.1 * settings.size => Ok(()),
        Ok(_) | Err(ModalError::Fe(FeError::Diverged { .. })) => Err(unsteady()),
        Err(other) => Err(other),
    }
}

fn largest(list: &[f64]) -> f64 {
    list.iter().fold(0.0f64, |a, x| a.max(x.abs()))
}

fn mesh_forces(set: &VibratingSet<'_>) -> Vec<f64> {
    let mut out = Vec::new();
    set.mesh_forces(&mut out);
    out
}

/// Records of all races after one pulse, by coordinate, and the largest change of a mesh force.
fn decay(
    set: &mut VibratingSet<'_>,
    settings: &ImpulseSettings,
    pulse: &Pulse,
    force: f64,
    steps: usize,
) -> Result<(Vec<Vec<f64>>, f64), ModalError> {
    set.rest(settings.preload.load.sun_load_nm())?;
    let rest = set.motion().x.clone();
    let forces = mesh_forces(set);
    let size = largest(&forces);
    let steady: Vec<f64> = set.external.iter().copied().collect();
    let mut records = vec![Vec::with_capacity(steps); rest.len()];
    let (mut change, mut now) = (0.0f64, Vec::new());
    for step in 0..steps {
        let push = if step == 0 { force } else { 0.0 };
        for (i, (steady, pattern)) in steady.iter().zip(&pulse.pattern).enumerate() {
            set.external[i] = steady + push * pattern;
        }
        set.step()?;
        for ((record, x), rest) in records.iter_mut().zip(&set.motion().x).zip(&rest) {
            record.push(x - rest);
        }
        set.mesh_forces(&mut now);
        for (a, b) in now.iter().zip(&forces) {
            change = change.max((a - b).abs() / size);
        }
    }
    Ok((records, change))
}

/// Identified modes with their types.
fn typed(
    set: &VibratingSet<'_>,
    identification: &Identification,
) -> Result<Vec<FeMode>, ModalError> {
    let kinds = MotionKinds::of_races(set.races(), set.masses());
    let mut modes = Vec::new();
    let list = &identification.modes;
    let mut first = 0;
    while first < list.len() {
        let count = list[first].multiplicity.max(1).min(list.len() - first);
        // The phase of a complex mode shape is arbitrary; kinds are found from the shape made real.
        let real: Vec<Vec<f64>> =
            list[first..first + count].iter().map(|m| in_phase(&m.shape)).collect();
        let shares = kinds.shares(&real)?;
        for (k, mode) in list[first..first + count].iter().enumerate() {
            let own = shares.get(k).copied().unwrap_or([0.0; 3]);
            modes.push(FeMode {
                frequency_hz: mode.frequency,
                damping_ratio: mode.damping,
                mode_type: type_of(&own),
                shares: own,
                shape: real[k].clone(),
            });
        }
        first += count;
    }
    modes.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
    Ok(modes)
}

/// Real part of a complex shape after the rotation that makes it as real as possible, by minus half the phase
/// of Σ z².
fn in_phase(shape: &[dynamics::c64]) -> Vec<f64> {
    let square = shape
        .iter()
        .fold((0.0, 0.0), |(a, b), z| (a + z.re * z.re - z.im * z.im, b + 2.0 * z.re * z.im));
    let turn = -0.5 * square.1.atan2(square.0);
    let (sin, cos) = turn.sin_cos();
    shape.iter().map(|z| cos * z.re - sin * z.im).collect()
}

impl ImpulseTest {
    /// Largest motions of the sun under the pulse of this name.
    pub fn sun_contents(&self, races: &Races, pulse: &str) -> Option<Contents> {
        let decay = self.decays.iter().find(|d| d.pulse.name == pulse)?;
        let [x, y, u] = races.places(Body::Sun).map(|place| place.map(|i| &decay.records[i]));
        let (x, y, u) = (x?, y?, u?);
        let translation = x.iter().zip(y).map(|(x, y)| x.hypot(*y)).fold(0.0, f64::max);
        Some(Contents { translation, rotation: largest(u) })
    }
}
