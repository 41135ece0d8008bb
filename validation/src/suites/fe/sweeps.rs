//! Speed sweeps judged from their own data: what planet phasing forbids, where peaks stand, what lies
//! between harmonics, and what is left as the speed goes to zero.

use std::f64::consts::TAU;

use dynamics::{Window, spectrum};
use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, Imperfections, PitchError, StaticSet};
use gearset::{ExcitationStrengths, Facing, LoadCase, Scene, excitation_of_scene};

use super::Lab;
use crate::Profile;
use crate::catalogue::PublishedScene;
use crate::check::{Check, ReferenceKind, Subject};
use crate::error::ValidationError;
use experiments::NaturalMode;
use experiments::sweep::{
    Assigned, Content, Coordinate, Direction, FeModel, HEADROOM, Memory, Part, Plan,
    SteadySettings, SteadyState, Sweep, SweepModel, SweepPoint, assigned, contents, naturals, run,
};

/// What ids of the sweeps start with.
pub(crate) const IDS: &[&str] = &[
    "sweep.unsteady.",
    "sweep.forbidden.",
    "sweep.allowed.",
    "sweep.between.",
    "sweep.peaks.",
    "sweep.harmonics_of_",
    "sweep.static_limit.",
    "sweep.odd_grid.",
    "sweep.order.",
];

/// N·m on the sun.
pub(super) const TORQUE: f64 = 1130.0;

/// Peaks that stand out by less are left alone.
pub(super) const PROMINENT: f64 = 1.3;

/// The second manifest goes so far to either side of a peak, in parts of its speed.
const SPAN: f64 = 0.015;

/// The load case of a scene under a torque on the sun, N m.
pub(crate) fn under(scene: &Scene, sun_torque_nm: f64) -> Result<LoadCase, ValidationError> {
    Ok(LoadCase::of_scene(scene)?.with_sun_torque(sun_torque_nm))
}

/// Speeds from first to last (rpm), each by the same part above the one before.
pub(crate) fn speeds(first: f64, last: f64, ratio: f64) -> Vec<f64> {
    let count = ((last / first).ln() / ratio.ln_1p()).floor() as i32;
    (0..=count).map(|i| first * (1.0 + ratio).powi(i)).collect()
}

/// A sweep of the FE/contact model in memory.
pub(crate) fn sweep_of(
    scene: &Scene,
    bodies: &Bodies,
    imperfections: Imperfections,
    torque_nm: f64,
    speeds_rpm: &[f64],
    steady: SteadySettings,
) -> Result<Sweep, ValidationError> {
    let model = FeModel::new(scene, bodies, imperfections, under(scene, torque_nm)?);
    let plan = Plan::new(speeds_rpm, &[Direction::Up], steady)?;
    Ok(run(&model, &plan, &Memory, &|_| ())?)
}

pub(crate) fn steady_settings() -> SteadySettings {
    SteadySettings { tolerance: 1e-9, ..SteadySettings::default() }
}

/// Largest share of what is forbidden.
fn forbidden(list: &[Content]) -> f64 {
    list.iter().filter(|c| !c.is_allowed).fold(0.0f64, |a, c| a.max(c.share))
}

pub(crate) fn checks(lab: &Lab<'_>) -> Result<Vec<Check>, ValidationError> {
    let mut checks = Vec::new();
    let ratio = if lab.profile == Profile::Quick { 0.02 } else { 0.005 };
    let grid = speeds(450.0, 2500.0, ratio);
    checks.extend(set(lab, "four", &lab.four, &lab.bodies, &grid)?);
    checks.extend(set(lab, "three", &lab.three, &lab.bodies, &grid)?);
    checks.extend(slow(lab)?);
    checks.extend(odd_grid(lab)?);
    checks.extend(five(lab)?);
    Ok(checks)
}

/// Five planets: harmonics that move planets only, translations only, rotations only.
fn five(lab: &Lab<'_>) -> Result<Vec<Check>, ValidationError> {
    let mut scene = crate::catalogue::scene(PublishedScene::FivePlanets)?;
    // A multiple of the five mesh phases.
    scene.dynamics.steps_per_cycle = 140;
    let torque = five_torque(&scene)?;
    let bodies = Bodies::new(&scene)?;
    let ratio = if lab.profile == Profile::Quick { 0.08 } else { 0.02 };
    let grid = speeds(450.0, 2500.0, ratio);
    let settings = steady_settings();
    let found = sweep_of(&scene, &bodies, Imperfections::default(), torque, &grid, settings)?;
    let points = found.points();
    let strengths = excitation_of_scene(&scene, 5).ok_or(ValidationError::Incomplete("teeth"))?;
    let mut checks = judged(lab, "five", &points, &strengths)?;
    let off = found
        .states()
        .into_iter()
        .filter_map(|p| order_of_meshes(p, &scene))
        .fold(0.0f64, f64::max);
    let title = "five planets: mesh forces of the sun against the order that the planets' phases say, harmonics 1 to 5, in cycles";
    checks.push(lab.at_most("sweep.order.five", title, "", off)?);
    Ok(checks)
}

/// Torque on the sun at the operating point, N m.
fn five_torque(scene: &Scene) -> Result<f64, ValidationError> {
    Ok(LoadCase::of_scene(scene)?.sun_torque_nm)
}

/// Everything that is judged of one set.
fn set(
    lab: &Lab<'_>,
    name: &str,
    scene: &Scene,
    bodies: &Bodies,
    grid: &[f64],
) -> Result<Vec<Check>, ValidationError> {
    let case = under(scene, TORQUE)?;
    let model = FeModel::new(scene, bodies, Imperfections::default(), case);
    let found = swept(&model, grid)?;
    let points = found.points();
    let strengths = excitation_of_scene(scene, 5).ok_or(ValidationError::Incomplete("teeth"))?;
    let mut checks = judged(lab, name, &points, &strengths)?;
    let naturals = naturals(scene, bodies, case)?;
    let list = assigned(&found.states(), &strengths, &naturals, PROMINENT);
    checks.push(peaks_judged(lab, name, &list)?);
    let source = "phasor sums of the planets' mesh phases";
    // The two modes the paper follows, each where its own harmonics meet it.
    let mut modes: Vec<NaturalMode> = Vec::new();
    for n in &naturals {
        if modes.iter().all(|m| m.mode_type != n.mode_type) {
            modes.push(*n);
        }
    }
    for mode in modes {
        let kind = format!("{:?}", mode.mode_type).to_lowercase();
        let met = |l: usize| {
            list.iter().any(|p| {
                p.peak.harmonic == l
                    && p.natural.mode_type == mode.mode_type
                    && (p.natural.frequency_hz / mode.frequency_hz - 1.0).abs() < 0.02
            })
        };
        let mesh_hz = |rpm: f64| case.at_speed(rpm).mesh_frequency_hz;
        let (bottom, top) = (mesh_hz(grid[0]), mesh_hz(grid[grid.len() - 1]));
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
        let expected: Vec<f64> = (1..=5).filter(may).map(|l| l as f64).collect();
        let actual: Vec<f64> = (1..=5).filter(|l| met(*l)).map(|l| l as f64).collect();
        let own = format!("sweep.harmonics_of_{kind}.{name}");
        let title = format!(
            "{name} planets: harmonics that bring the lowest {kind} mode to resonance within the sweep"
        );
        let subject =
            Subject { id: &own, title: &title, kind: ReferenceKind::Analytic, source, unit: "" };
        checks.push(Check::equal(subject, expected, actual));
    }
    Ok(checks)
}

/// A sweep over some speeds, and closer about its peaks.
pub(super) fn swept(model: &dyn SweepModel, grid: &[f64]) -> Result<Sweep, ValidationError> {
    let plan = Plan::new(grid, &[Direction::Up], steady_settings())?;
    let mut found = run(model, &plan, &Memory, &|_| ())?;
    let around = found.around_peaks(PROMINENT, SPAN, 5, steady_settings());
    found.chains.extend(run(model, &around, &Memory, &|_| ())?.chains);
    Ok(found)
}

/// `four` or, of another model, `four_lumped`, for people.
fn words(name: &str) -> String {
    match name.split_once('_') {
        Some((count, model)) => format!("{count} planets, {model}"),
        None => format!("{name} planets"),
    }
}

/// How far the peaks stand from where modes should have them.
pub(super) fn peaks_judged(
    lab: &Lab<'_>,
    name: &str,
    list: &[Assigned],
) -> Result<Check, ValidationError> {
    let words = words(name);
    let worst = list.iter().fold(0.0f64, |a, p| a.max(p.off_percent().abs()));
    let title = format!(
        "{words}: {} peaks of the sun and planet 0, farthest from ω_n/l of a mode that the harmonic may excite",
        list.len()
    );
    let id = format!("sweep.peaks.{name}");
    lab.number(&id, &title, ReferenceKind::Analytic, "resonance", "%", 0.0, worst)
}

/// What holds for any set of equal planets.
pub(super) fn judged(
    lab: &Lab<'_>,
    name: &str,
    points: &[&SweepPoint],
    strengths: &[ExcitationStrengths],
) -> Result<Vec<Check>, ValidationError> {
    let (mut checks, words) = (Vec::new(), words(name));
    let id = |what: &str| format!("sweep.{what}.{name}");
    let unsteady = points.iter().filter(|p| !p.is_steady).count() as f64;
    let title = format!("{words}: speeds at which cycles do not come to repeat");
    checks.push(lab.at_most(&id("unsteady"), &title, "", unsteady)?);
    let states: Vec<&SteadyState> = points.iter().map(|p| &p.state).collect();
    let list = contents(&states, strengths);
    let forbidden = forbidden(&list);
    let title = format!(
        "{words}: largest motion of the sun in a harmonic that planet phasing forbids, over the largest of its kind, {} speeds",
        points.len()
    );
    checks.push(lab.at_most(&id("forbidden"), &title, "", forbidden)?);
    let title = format!(
        "{words}: kinds of the sun's motion and harmonics that planet phasing allows and that are there (1e-3 of the largest)"
    );
    let expected = list.iter().filter(|c| c.is_allowed).count() as f64;
    let present = list.iter().filter(|c| c.is_allowed && c.share > 1e-3).count() as f64;
    let source = "phasor sums of the planets' mesh phases";
    let kind = ReferenceKind::Analytic;
    let own = id("allowed");
    let subject = Subject { id: &own, title: &title, kind, source, unit: "" };
    checks.push(Check::equal(subject, expected, present));
    let between = points.iter().filter_map(|p| p.between).fold(0.0f64, f64::max);
    let title = format!("{words}: vibration energy between mesh harmonics, over all of it");
    checks.push(lab.at_most(&id("between"), &title, "", between)?);
    Ok(checks)
}

/// Harmonics 0…5 of the sun's motion (radial, tangential, rotation) at rest, on the sweep's grids.
fn static_harmonics(lab: &Lab<'_>) -> Result<[Vec<[f64; 2]>; 3], ValidationError> {
    let sun = lab.bodies.geometry.sun.as_ref().ok_or(ValidationError::Incomplete("sun"))?;
    let share = TORQUE / sun.base_radius / lab.four.planets.count() as f64;
    let (sense, none) = (Facing::CounterClockwise, Imperfections::default());
    let set = StaticSet::new(&lab.four, &lab.bodies, sense, none)?;
    let cycle = set.cycle_on_grids_for(HEADROOM * share, TORQUE, 140, &ActiveSet)?;
    let one = |axis: usize| -> Result<Vec<[f64; 2]>, ValidationError> {
        let record: Vec<f64> = cycle.states.iter().map(|s| s.central[2][axis]).collect();
        let lines = spectrum(&record, 1.0, Window::Rectangular, 1)?.lines;
        Ok(lines[..6].iter().map(|x| [x.re, x.im]).collect())
    };
    Ok([one(0)?, one(1)?, one(2)?])
}

/// As the speed goes to zero what is left is the static deflection.
fn slow(lab: &Lab<'_>) -> Result<Vec<Check>, ValidationError> {
    let settings = SteadySettings { between_cycles: 0, ..steady_settings() };
    let none = Imperfections::default();
    let found = sweep_of(&lab.four, &lab.bodies, none, TORQUE, &[20.0], settings)?;
    let still = static_harmonics(lab)?;
    let mut worst = 0.0f64;
    for point in found.states() {
        for (axis, coordinate) in Coordinate::DISPLACEMENTS.into_iter().enumerate() {
            let largest = (1..=5).map(|l| still[axis][l][0].hypot(still[axis][l][1]));
            let largest = largest.fold(0.0f64, f64::max);
            for (l, [re, im]) in still[axis].iter().enumerate().skip(1) {
                let size = re.hypot(*im);
                let Some(line) = point.line(Part::Sun, coordinate, l) else { continue };
                // What is forbidden is nothing on either side.
                if size > 1e-6 * largest {
                    let (a, p) = (line.amplitude, line.phase_rad);
                    let off = (a * p.cos() - re).hypot(a * p.sin() - im);
                    worst = worst.max(100.0 * off / size);
                }
            }
        }
    }
    let title = "four planets at 20 rpm: harmonics 1 to 5 of the sun's motion against those at rest, largest difference";
    let kind = ReferenceKind::Analytic;
    let id = "sweep.static_limit.four";
    Ok(vec![lab.number(id, title, kind, "inertia and damping vanish", "%", 0.0, worst)?])
}

/// With an odd number of steps half a cycle is no whole number of them, and what the rules forbid is
/// there: an artefact, shown once.
fn odd_grid(lab: &Lab<'_>) -> Result<Vec<Check>, ValidationError> {
    let mut scene = lab.four.clone();
    scene.dynamics.steps_per_cycle = 141;
    let found = forbidden_share(&scene, &lab.bodies, Imperfections::default(), 1600.0)?;
    let limit = lab.reference.tolerance("sweep.forbidden.four", 0.0)?.absolute;
    let is_there = found > limit;
    let title = format!(
        "141 steps in a cycle leave the sun {found:.1e} in forbidden harmonics at 1600 rpm: more than sweep.forbidden.four allows"
    );
    Ok(vec![breaks("sweep.odd_grid.four", &title, is_there)])
}

/// What forbidden harmonics hold at one speed.
fn forbidden_share(
    scene: &Scene,
    bodies: &Bodies,
    imperfections: Imperfections,
    speed_rpm: f64,
) -> Result<f64, ValidationError> {
    let settings = SteadySettings { between_cycles: 0, ..steady_settings() };
    let found = sweep_of(scene, bodies, imperfections, TORQUE, &[speed_rpm], settings)?;
    let strengths = excitation_of_scene(scene, 5).ok_or(ValidationError::Incomplete("teeth"))?;
    Ok(forbidden(&contents(&found.states(), &strengths)))
}

fn breaks(id: &str, title: &str, is_broken: bool) -> Check {
    let source = "a check that cannot fail is none";
    let subject = Subject { id, title, kind: ReferenceKind::Analytic, source, unit: "" };
    Check::equal(subject, "breaks", if is_broken { "breaks" } else { "stands" })
}

/// Negative controls: what must break when the set is spoilt.
pub(crate) fn controls(lab: &Lab<'_>) -> Result<Vec<Check>, ValidationError> {
    let mut checks = Vec::new();
    let limit = lab.reference.tolerance("sweep.forbidden.four", 0.0)?.absolute;
    let displaced =
        Imperfections { displaced_planets: vec![(1, 0.0, 50e-6)], ..Imperfections::default() };
    let found = forbidden_share(&lab.four, &lab.bodies, displaced, 1600.0)?;
    let title = "one planet displaced by 50 µm along its path breaks sweep.forbidden.four";
    checks.push(breaks("sweep.control.displaced_planet", title, found > limit));

    let mut softer = lab.four.clone();
    let bearing = 0.8 * softer.supports.planet_bearing;
    softer.overrides.push(gearset::PlanetOverride {
        planet: 1,
        mass: None,
        inertia_over_r2: None,
        bearing: Some(bearing),
        sun_mesh: None,
        ring_mesh: None,
    });
    let found = forbidden_share(&softer, &lab.bodies, Imperfections::default(), 1600.0)?;
    let title = "one planet bearing 20 % softer breaks sweep.forbidden.four";
    checks.push(breaks("sweep.control.softer_bearing", title, found > limit));

    // The planets counted the other way round: their phases run backwards.
    let five = crate::catalogue::scene(PublishedScene::FivePlanets)?;
    let mut reversed = five.clone();
    reversed.planets.psi_rad.iter_mut().for_each(|psi| *psi = -*psi);
    if let Some(steps) = &mut reversed.planets.steps {
        steps.iter_mut().for_each(|s| *s = -*s);
    }
    let bodies = Bodies::new(&five)?;
    let settings = SteadySettings { between_cycles: 0, ..steady_settings() };
    let (torque, none) = (five_torque(&five)?, Imperfections::default());
    let found = sweep_of(&reversed, &bodies, none, torque, &[1000.0], settings)?;
    let limit = lab.reference.tolerance("sweep.order.five", 0.0)?.absolute;
    let is_off =
        found.states().into_iter().filter_map(|p| order_of_meshes(p, &five)).any(|o| o > limit);
    let title = "five planets with their phases reversed break sweep.order.five";
    checks.push(breaks("sweep.control.phases_reversed", title, is_off));

    let limit = lab.reference.tolerance("sweep.between.four", 0.0)?.absolute;
    let pitch = Imperfections {
        pitch_errors: vec![PitchError { tooth: 5, amount: 10e-6 }],
        ..Imperfections::default()
    };
    // The sun's teeth come round after as many mesh cycles.
    let teeth = lab.bodies.geometry.sun.as_ref().map_or(1, |sun| sun.teeth) as usize;
    let settings =
        SteadySettings { most_cycles: 4 * teeth, between_cycles: teeth, ..steady_settings() };
    let found = sweep_of(&lab.four, &lab.bodies, pitch, TORQUE, &[1600.0], settings)?;
    let between = found.points().iter().filter_map(|p| p.between).fold(0.0f64, f64::max);
    let title = "one sun tooth 10 µm out of pitch makes sidebands: breaks sweep.between.four";
    checks.push(breaks("sweep.control.pitch_error", title, between > limit));
    Ok(checks)
}

/// How far the sun meshes' forces are from following one another as the planets' mesh phases say, in
/// cycles of the harmonic: F_n(t) = F_0(t + φ_n/f_m) in sets of equally spaced planets.
pub(crate) fn order_of_meshes(point: &SteadyState, scene: &Scene) -> Option<f64> {
    let teeth = f64::from(scene.teeth?.sun?);
    let mut worst = 0.0f64;
    for l in 1..=5 {
        let first = point.line(Part::SunMesh(0), Coordinate::Force, l)?;
        for (n, psi) in scene.planets.psi_rad.iter().enumerate().skip(1) {
            let own = point.line(Part::SunMesh(n), Coordinate::Force, l)?;
            // φ_n = −Z_s ψ_n/2π
            let expected = -(l as f64) * teeth * psi / TAU;
            let off = (own.phase_rad - first.phase_rad) / TAU - expected;
            worst = worst.max((off - off.round()).abs());
        }
    }
    Some(worst)
}
