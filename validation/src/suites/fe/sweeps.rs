//! Speed sweeps judged from their own data: what planet phasing forbids, where peaks stand, what lies
//! between harmonics, and what is left as the speed goes to zero.

use std::f64::consts::TAU;

use dynamics::{Window, spectrum};
use experiments::sweep::{
    Assigned, Coordinate, Direction, FeModel, HEADROOM, Memory, MeshLawModel, Part, Plan,
    SteadySettings, SteadyState, Sweep, SweepModel, SweepPoint, assigned, contents, peak_speeds,
    run,
};
use experiments::{ModalModel, NaturalMode, SteadyStateModel};
use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Imperfections, PitchError, StaticSet};
use gearset::ExcitationStrengths;
use scene::{LoadCase, PlanetOverride, Scene, excitation_of_scene};

use crate::Profile;
use crate::catalogue::{PublishedScene, scene};
use crate::check::Check;
use crate::error::ValidationError;
use crate::published_table::Table;
use crate::reference::Reference;
use crate::suites::lab::of_model;
use crate::suites::{Checks, Lab};
use crate::worst::worst;

/// N·m on the sun of three and four planets.
const TORQUE: f64 = 1130.0;

/// Speeds of the sweeps, rpm.
const FROM: f64 = 450.0;
const TO: f64 = 2500.0;

/// Peaks less than this many times as high as the curve on either side are not judged.
const PROMINENT: f64 = 1.3;

/// Half-width of the refinement about a peak, as a share of its speed, and number of its speeds.
const SPAN: f64 = 0.015;
const AROUND: usize = 5;

/// Harmonics that are judged.
const HARMONICS: u32 = 5;

/// The load case of a scene under a torque on the sun, N m.
pub(crate) fn under(scene: &Scene, sun_torque_nm: f64) -> Result<LoadCase, ValidationError> {
    Ok(LoadCase::of_scene(scene)?.with_sun_torque(sun_torque_nm))
}

/// Speeds from first to last (rpm), each 1 + `ratio` times the one before.
pub(crate) fn speeds(first: f64, last: f64, ratio: f64) -> Vec<f64> {
    let count = ((last / first).ln() / ratio.ln_1p()).floor() as i32;
    (0..=count).map(|i| first * (1.0 + ratio).powi(i)).collect()
}

/// Over whole cycles: what planet phasing forbids must come out, not be put in.
pub(super) fn steady_settings() -> SteadySettings {
    SteadySettings { tolerance: 1e-9, whole_cycles: true, ..SteadySettings::default() }
}

fn strengths(scene: &Scene) -> Result<Vec<ExcitationStrengths>, ValidationError> {
    excitation_of_scene(scene, HARMONICS).ok_or(ValidationError::Incomplete("teeth"))
}

/// Name of a sweep: the number of planets in words.
fn planets(scene: &Scene) -> &'static str {
    match scene.planets.count() {
        5 => "five",
        count => Table::of_planets(count).planets(),
    }
}

/// Load case and speeds of a set's sweep; `ratios`: relative speed steps of three and four planets, of five.
fn asked_of(scene: &Scene, ratios: [f64; 2]) -> Result<(LoadCase, Vec<f64>), ValidationError> {
    let [usual, five] = ratios;
    Ok(match scene.planets.count() {
        5 => (LoadCase::of_scene(scene)?, speeds(FROM, TO, five)),
        _ => (under(scene, TORQUE)?, speeds(FROM, TO, usual)),
    })
}

/// Relative speed steps of the quick and of the full profile, each of three and four planets and of five.
const QUICK: [f64; 2] = [0.02, 0.08];
const FULL: [f64; 2] = [0.005, 0.02];

/// Five planets, with a number of steps per cycle that makes their mesh phases whole steps.
fn five_planets() -> Result<Scene, ValidationError> {
    let mut five = scene(PublishedScene::FivePlanets)?;
    five.dynamics.steps_per_cycle = 140;
    Ok(five)
}

/// Checks on the steady states of any model: forbidden and allowed harmonics, peaks if the model has natural
/// modes too, the order of the meshes of equally spaced planets.
pub(crate) fn asked(
    model: &dyn SteadyStateModel,
    modal: Option<&dyn ModalModel>,
    scenes: &[Scene],
    reference: &Reference,
) -> Checks {
    let mut checks = Vec::new();
    for scene in scenes {
        let (case, grid) = asked_of(scene, QUICK)?;
        let mut asked = 0;
        let mut next = |found: &[SteadyState]| -> Option<Vec<f64>> {
            asked += 1;
            let found: Vec<&SteadyState> = found.iter().collect();
            match asked {
                1 => Some(grid.clone()),
                2 => Some(peak_speeds(&found, HARMONICS as usize, PROMINENT, SPAN, AROUND)),
                _ => None,
            }
        };
        let accuracy = (HARMONICS as usize, 1e-9);
        let states = model.explore(scene, &case, accuracy, &mut next).map_err(of_model)?;
        let states: Vec<&SteadyState> = states.iter().collect();
        let naturals = match modal {
            Some(modal) => match modal.natural_modes(scene, &case).map_err(of_model) {
                Ok(modes) => Some(modes),
                // Tables without modes of the scene leave out the peaks alone.
                Err(error) if error.is_not_recorded() => None,
                Err(error) => return Err(error),
            },
            None => None,
        };
        checks.extend(judged(reference, scene, planets(scene), &states, naturals.as_deref())?);
    }
    Ok(checks)
}

/// Judges the steady states of a set, named after its planets or, of another model, `four_lumped`.
fn judged(
    reference: &Reference,
    scene: &Scene,
    name: &str,
    states: &[&SteadyState],
    naturals: Option<&[NaturalMode]>,
) -> Checks {
    let mut checks = phasing(reference, scene, name, states)?;
    if let Some(naturals) = naturals {
        let list = assigned(states, &strengths(scene)?, naturals, PROMINENT);
        checks.push(peaks(reference, name, &list)?);
        if name == planets(scene) {
            checks.extend(harmonics_of_modes(reference, scene, name, states, naturals, &list)?);
        }
    }
    if scene.planets.count() == 5 {
        checks.push(order(reference, scene, name, states)?);
    }
    Ok(checks)
}

/// `four planets` or, of another model, `four planets, lumped`, for people.
fn words(name: &str) -> String {
    match name.split_once('_') {
        _ if name.starts_with("machine_") => name.replace('_', " ").replace("machine ", ""),
        Some((count, model)) => format!("{count} planets, {}", model.replace('_', " ")),
        None => format!("{name} planets"),
    }
}

/// What planet phasing forbids and allows in the sun's motion.
fn phasing(reference: &Reference, scene: &Scene, name: &str, states: &[&SteadyState]) -> Checks {
    let words = words(name);
    let list = contents(states, &strengths(scene)?);
    let id = format!("sweep.forbidden.{name}");
    let title = format!(
        "{words}: largest motion of the sun in a harmonic that planet phasing forbids, over the largest of its kind at any speed"
    );
    let forbidden = worst(list.iter().filter(|c| !c.is_allowed).map(|c| c.share));
    let note = format!("{} speeds", states.len());
    let mut checks = vec![reference.about(&id, &title)?.note(note).at_most(forbidden)];
    let id = format!("sweep.allowed.{name}");
    let title = format!(
        "{words}: kinds of the sun's motion and harmonics that planet phasing allows and that are there (1e-3 of the largest)"
    );
    let expected = list.iter().filter(|c| c.is_allowed).count() as f64;
    let present = list.iter().filter(|c| c.is_allowed && c.share > 1e-3).count() as f64;
    checks.push(reference.about(&id, &title)?.equal(expected, present));
    Ok(checks)
}

/// Distance of the peaks from ω_n/l of the modes that the harmonic may excite.
fn peaks(reference: &Reference, name: &str, list: &[Assigned]) -> Result<Check, ValidationError> {
    let id = format!("sweep.peaks.{name}");
    let title = format!(
        "{}: peaks of the sun and planet 0, farthest from ω_n/l of a mode that the harmonic may excite",
        words(name)
    );
    let note = format!("{} peaks", list.len());
    let off = worst(list.iter().map(Assigned::off_percent));
    Ok(reference.about(&id, &title)?.note(note).at_most(off))
}

/// The harmonics in which the lowest mode of each kind is resonant within the sweep.
fn harmonics_of_modes(
    reference: &Reference,
    scene: &Scene,
    name: &str,
    states: &[&SteadyState],
    naturals: &[NaturalMode],
    list: &[Assigned],
) -> Checks {
    let strengths = strengths(scene)?;
    let ends = states.first().zip(states.last());
    let (first, last) = ends.ok_or(ValidationError::Incomplete("steady state"))?;
    let (bottom, top) = (first.case.mesh_frequency_hz, last.case.mesh_frequency_hz);
    let mut sorted = naturals.to_vec();
    sorted.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
    let mut lowest: Vec<NaturalMode> = Vec::new();
    for n in sorted.into_iter().filter(|n| n.frequency_hz > 1.0) {
        if lowest.iter().all(|m| m.mode_type != n.mode_type) {
            lowest.push(n);
        }
    }
    let mut checks = Vec::new();
    for mode in lowest {
        let kind = mode.mode_type.name();
        let met = |l: usize| {
            list.iter().any(|p| {
                p.peak.harmonic == l
                    && p.natural.mode_type == mode.mode_type
                    && (p.natural.frequency_hz / mode.frequency_hz - 1.0).abs() < 0.02
            })
        };
        let may = |l: &usize| {
            let allowed = strengths[l - 1].allowed();
            let is_excited = match mode.mode_type {
                lumped::ModeType::Rotational => allowed.rotational,
                lumped::ModeType::Translational => allowed.translational,
                lumped::ModeType::Planet => allowed.planet,
                lumped::ModeType::Mixed => true,
            };
            let mesh = mode.frequency_hz / *l as f64;
            is_excited && mesh < 0.97 * top && mesh > 1.03 * bottom
        };
        let all = 1..=strengths.len();
        let expected: Vec<f64> = all.clone().filter(may).map(|l| l as f64).collect();
        let actual: Vec<f64> = all.filter(|l| met(*l)).map(|l| l as f64).collect();
        let id = format!("sweep.harmonics_of_{kind}.{name}");
        let title = format!(
            "{name} planets: harmonics that bring the lowest {kind} mode to resonance within the sweep"
        );
        checks.push(reference.about(&id, &title)?.equal(expected, actual));
    }
    Ok(checks)
}

/// The forces of the sun meshes follow one another with the phase differences of the planets' meshes, in the sense
/// in which the sun of the scene turns relative to the carrier.
pub(super) fn order(
    reference: &Reference,
    scene: &Scene,
    name: &str,
    states: &[&SteadyState],
) -> Result<Check, ValidationError> {
    let id = format!("sweep.order.{name}");
    let title = format!(
        "{}: mesh forces of the sun against the order that the planets' phases say, harmonics 1 to 5, in cycles",
        words(name)
    );
    let off = states.iter().map(|s| order_of_meshes(s, scene).unwrap_or(f64::NAN));
    Ok(reference.about(&id, &title)?.at_most(worst(off)))
}

/// Whether our own models reach steady states, and the energy between harmonics.
pub(super) fn marches(lab: &Lab<'_>, name: &str, points: &[&SweepPoint]) -> Checks {
    let words = words(name);
    let id = format!("sweep.unsteady.{name}");
    let title = format!("{words}: speeds at which cycles do not come to repeat");
    let unsteady = points.iter().filter(|p| !p.is_steady).count() as f64;
    let mut checks = vec![lab.about(&id, &title)?.at_most(unsteady)];
    let id = format!("sweep.between.{name}");
    let title = format!("{words}: vibration energy between mesh harmonics, over all of it");
    let between = worst(points.iter().map(|p| p.between.unwrap_or(f64::NAN)));
    checks.push(lab.about(&id, &title)?.at_most(between));
    Ok(checks)
}

/// A sweep over given speeds, refined about its peaks.
fn swept(model: &dyn SweepModel, grid: &[f64]) -> Result<Sweep, ValidationError> {
    let plan = Plan::new(grid, &[Direction::Up], steady_settings())?;
    let mut found = run(model, &plan, &Memory, &|_| ())?.complete()?;
    let around = found.around_peaks(PROMINENT, SPAN, AROUND, steady_settings());
    found.extend(run(model, &around, &Memory, &|_| ())?.complete()?);
    Ok(found)
}

pub(crate) fn checks(lab: &Lab<'_>) -> Checks {
    let ratios = if lab.profile == Profile::Quick { QUICK } else { FULL };
    let mut checks = Vec::new();
    for scene in [&lab.four, &lab.three] {
        let (case, grid) = asked_of(scene, ratios)?;
        let model = FeModel::new(scene, &lab.bodies, Imperfections::default(), case);
        let found = swept(&model, &grid)?;
        let naturals = lab.fe.natural_modes(scene, &case).map_err(of_model)?;
        let name = planets(scene);
        checks.extend(marches(lab, name, &found.points())?);
        checks.extend(judged(lab.reference, scene, name, &found.states(), Some(&naturals))?);
    }
    checks.extend(slow(lab)?);
    checks.extend(five(lab, ratios)?);
    checks.extend(reduced(lab, ratios)?);
    checks.extend(controls(lab)?);
    checks.extend(super::machines::checks(lab)?);
    lab.gears.drop_unused();
    Ok(checks)
}

/// Five planets: each harmonic excites only planet modes, only translational or only rotational ones.
fn five(lab: &Lab<'_>, ratios: [f64; 2]) -> Checks {
    let scene = five_planets()?;
    let (case, grid) = asked_of(&scene, ratios)?;
    let bodies = lab.gears.of(&scene)?;
    let model = FeModel::new(&scene, &bodies, Imperfections::default(), case);
    let plan = Plan::new(&grid, &[Direction::Up], steady_settings())?;
    let found = run(&model, &plan, &Memory, &|_| ())?.complete()?;
    let mut checks = marches(lab, "five", &found.points())?;
    checks.extend(judged(lab.reference, &scene, "five", &found.states(), None)?);
    Ok(checks)
}

/// The models with tabulated mesh forces, judged as the fidelity from which they are made: the mesh law
/// between the races of the FE bodies and in the lumped model.
fn reduced(lab: &Lab<'_>, ratios: [f64; 2]) -> Checks {
    let scene = &lab.four;
    let (case, grid) = asked_of(scene, ratios)?;
    let law = MeshLawModel::new(scene, &lab.bodies, case)?;
    let naturals = lab.fe.natural_modes(scene, &case).map_err(of_model)?;
    let mut checks = Vec::new();
    // The lumped model has the printed masses, hence other modes than FE/contact: its peaks are not judged.
    for (name, model, naturals) in
        [("four_mesh_law", &law, Some(naturals.as_slice())), ("four_lumped", &law.lumped(), None)]
    {
        let found = swept(model, &grid)?;
        checks.extend(marches(lab, name, &found.points())?);
        checks.extend(judged(lab.reference, scene, name, &found.states(), naturals)?);
    }
    Ok(checks)
}

/// Harmonics 0…5 of the sun's motion (radial, tangential, rotation) at rest, on the sweep's grids.
fn static_harmonics(lab: &Lab<'_>, steps: usize) -> Result<[Vec<[f64; 2]>; 3], ValidationError> {
    let sun = lab.bodies.geometry.sun.as_ref().ok_or(ValidationError::Incomplete("sun"))?;
    let share = TORQUE / sun.base_radius / lab.four.planets.count() as f64;
    let (sense, none) = (LoadCase::standing(TORQUE).sense(), Imperfections::default());
    let set = StaticSet::new(&lab.four, &lab.bodies, sense, none)?;
    let cycle = set.cycle_on_grids_for(HEADROOM * share, TORQUE, steps, &ActiveSet)?;
    let one = |axis: usize| -> Result<Vec<[f64; 2]>, ValidationError> {
        let record: Vec<f64> = cycle.states.iter().map(|s| s.central[2][axis]).collect();
        let lines = spectrum(&record, 1.0, Window::Rectangular, 1)?.lines;
        Ok(lines[..6].iter().map(|x| [x.re, x.im]).collect())
    };
    Ok([one(0)?, one(1)?, one(2)?])
}

/// As the speed goes to zero the response approaches the static deflection.
fn slow(lab: &Lab<'_>) -> Checks {
    let title = "four planets at 20 rpm: harmonics 1 to 5 of the sun's motion against those at rest, largest difference";
    let usual = lab.four.dynamics.steps_per_cycle;
    let (finer, rpm) = (2 * usual, 20.0);
    let note = format!("{:.2} % with {finer} steps", off_static(lab, finer, rpm)?);
    let about = lab.about("sweep.static_limit.four", title)?.note(note);
    let mut checks = vec![about.at_most(off_static(lab, usual, rpm)?)];
    if lab.profile == Profile::Full {
        let title = "four planets, 1120 steps: that difference at 2.5 rpm over the one at 5 rpm";
        let (fast, slow) = (off_static(lab, 8 * usual, 5.0)?, off_static(lab, 8 * usual, 2.5)?);
        let note = format!("{fast:.3} % and {slow:.3} %");
        let about = lab.about("sweep.slow_turning.four", title)?.note(note);
        checks.push(about.number(0.5, slow / fast));
    }
    Ok(checks)
}

/// Largest difference of harmonics 1 to 5 of the sun's motion at a speed from those at rest, in percent of the latter.
fn off_static(lab: &Lab<'_>, steps: u32, rpm: f64) -> Result<f64, ValidationError> {
    let settings = SteadySettings { between_cycles: 0, ..steady_settings() };
    let case = under(&lab.four, TORQUE)?.at_speed(rpm);
    let mut scene = lab.four.clone();
    scene.dynamics.steps_per_cycle = steps;
    let found = at_speed(lab, &scene, Imperfections::default(), case, settings)?;
    let still = static_harmonics(lab, steps as usize)?;
    let mut off_percent = Vec::new();
    for point in found.states() {
        for (axis, coordinate) in Coordinate::DISPLACEMENTS.into_iter().enumerate() {
            let largest = (1..=5).map(|l| still[axis][l][0].hypot(still[axis][l][1]));
            let largest = largest.fold(0.0f64, f64::max);
            for (l, [re, im]) in still[axis].iter().enumerate().skip(1) {
                let size = re.hypot(*im);
                // Forbidden harmonics vanish in both and have no relative difference.
                if size > 1e-6 * largest {
                    let line = point.line(Part::SUN, coordinate, l);
                    let (a, p) = line.map_or((f64::NAN, 0.0), |l| (l.amplitude, l.phase_rad));
                    let off = (a * p.cos() - re).hypot(a * p.sin() - im);
                    off_percent.push(100.0 * off / size);
                }
            }
        }
    }
    Ok(worst(off_percent))
}

/// The steady state of a set at one speed.
fn at_speed(
    lab: &Lab<'_>,
    scene: &Scene,
    imperfections: Imperfections,
    case: LoadCase,
    settings: SteadySettings,
) -> Result<Sweep, ValidationError> {
    let bodies = lab.gears.of(scene)?;
    let model = FeModel::new(scene, &bodies, imperfections, case);
    let plan = Plan::new(&[case.speed_rpm], &[Direction::Up], settings)?;
    Ok(run(&model, &plan, &Memory, &|_| ())?.complete()?)
}

/// Negative controls: the same judgement of spoilt sets.
fn controls(lab: &Lab<'_>) -> Checks {
    let alone = SteadySettings { between_cycles: 0, ..steady_settings() };
    let at_1600 = under(&lab.four, TORQUE)?.at_speed(1600.0);
    let mut checks = Vec::new();
    let mut forbids = |what: &str, scene: &Scene, imperfections: Imperfections| {
        let found = at_speed(lab, scene, imperfections, at_1600, alone.clone())?;
        let spoilt = phasing(lab.reference, scene, "four", &found.states())?;
        checks.push(lab.reference.control(&format!("sweep.control.{what}"), &spoilt)?);
        Ok::<(), ValidationError>(())
    };
    let none = Imperfections::default;
    let displaced = Imperfections { displaced_planets: vec![(1, 0.0, 50e-6)], ..none() };
    forbids("displaced_planet", &lab.four, displaced)?;
    let mut softer = lab.four.clone();
    let bearing = Some(0.8 * softer.supports.planet_bearing_n_per_m);
    softer.overrides.push(PlanetOverride {
        planet: 1,
        bearing_n_per_m: bearing,
        ..PlanetOverride::default()
    });
    forbids("softer_bearing", &softer, none())?;
    // Half a cycle is then not a whole number of steps, and forbidden harmonics appear as an artefact.
    let mut odd = lab.four.clone();
    odd.dynamics.steps_per_cycle = 141;
    forbids("odd_grid", &odd, none())?;

    let five = five_planets()?;
    let mut reversed = five.clone();
    reversed.planets.psi_rad.iter_mut().for_each(|psi| *psi = -*psi);
    if let Some(steps) = &mut reversed.planets.steps {
        steps.iter_mut().for_each(|s| *s = -*s);
    }
    let case = LoadCase::of_scene(&five)?.at_speed(1000.0);
    let found = at_speed(lab, &reversed, none(), case, alone)?;
    let spoilt = [order(lab.reference, &five, "five", &found.states())?];
    checks.push(lab.reference.control("sweep.control.phases_reversed", &spoilt)?);

    let pitch =
        Imperfections { pitch_errors: vec![PitchError { tooth: 5, amount: 10e-6 }], ..none() };
    // The same sun teeth are in mesh again after as many mesh cycles as the sun has teeth.
    let teeth = lab.bodies.geometry.sun.as_ref().map_or(1, |sun| sun.teeth) as usize;
    let settings =
        SteadySettings { most_cycles: 4 * teeth, between_cycles: teeth, ..steady_settings() };
    let found = at_speed(lab, &lab.four, pitch, at_1600, settings)?;
    let spoilt = marches(lab, "four", &found.points())?;
    checks.push(lab.reference.control("sweep.control.pitch_error", &spoilt)?);
    Ok(checks)
}

/// Largest deviation of the sun meshes' forces from F_n(t) = F_0(t + φ_n/f_m), which holds for equally spaced
/// planets with the mesh phases φ_n of a sun that turns with σ relative to the carrier, in cycles of the harmonic.
fn order_of_meshes(point: &SteadyState, scene: &Scene) -> Option<f64> {
    let teeth = f64::from(scene.teeth?.sun?) * LoadCase::of_scene(scene).ok()?.sun_turns.sign();
    let mut largest = 0.0f64;
    for l in 1..=5 {
        let first = point.line(Part::SunMesh(0), Coordinate::Force, l)?;
        for (n, psi) in scene.planets.psi_rad.iter().enumerate().skip(1) {
            let own = point.line(Part::SunMesh(n), Coordinate::Force, l)?;
            // φ_n = −σ Z_s ψ_n/2π
            let expected = -(l as f64) * teeth * psi / TAU;
            let off = (own.phase_rad - first.phase_rad) / TAU - expected;
            largest = largest.max((off - off.round()).abs());
        }
    }
    Some(largest)
}
