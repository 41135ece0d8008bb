//! The test of `auto`: scenes drawn from seeds, the error of each answer against a finer calculation, and its cost
//! beside that of the cheapest settings that would have met the tolerance. `docs/auto.md` says how it is read.

use experiments::ExperimentError;
use experiments::auto::{
    AutoError, AutoSettings, Choice, FrequencyRequest, choose_frequency, frequency_with,
};
use experiments::study::{CpuTime, Stopwatch};
use gearset::{LoadCase, Scene, estimated_inertias, estimated_mesh_stiffness};
use lumped::ModeType;

/// Tolerances that are drawn, percent.
const TOLERANCES: [f64; 6] = [0.2, 0.5, 1.0, 2.0, 5.0, 10.0];

/// Elements and cells of the truth, finer than any candidate's.
const TRUTH: AutoSettings = AutoSettings::quasi_static(20, 60);

/// Modes of the truth, beside quasi-static bodies on the same mesh, which is the coarsest candidate's. Frequencies that meshes
/// govern converge slowly with the modes: of OH-58 at 8.3 kHz 12 modes are 0.43 % above 100, 40 modes 0.26 %. More are taken where the first
/// number changes a frequency by more than `CHANGED`.
const TRUTH_MODES: [AutoSettings; 2] =
    [AutoSettings::modal(40, 6, 20), AutoSettings::modal(100, 6, 20)];
const WITHOUT_MODES: AutoSettings = AutoSettings::quasi_static(6, 20);
const CHANGED: f64 = 2e-3;

/// A scene with what is asked of it.
#[derive(Debug)]
pub struct DrawnScene {
    /// Seed.
    pub seed: u64,
    /// The scene.
    pub scene: Scene,
    /// Quantity and tolerance.
    pub request: FrequencyRequest,
}

/// The scene of a seed: equally spaced planets, 3 to 6, on the rack without profile shift, of drawn teeth, modules,
/// widths, rims, bearings, loads, damping and tip relief; its `[lumped]`, which `auto` does not read, has estimates that are off
/// by up to 5 % (masses, inertias) and 20 % (mesh stiffnesses). Sets that cannot be assembled, or that the reader of
/// scenes refuses, are drawn again.
///
/// # Errors
/// If no scene is found in 10,000 draws.
pub fn drawn_scene(seed: u64) -> Result<DrawnScene, ExperimentError> {
    let mut random = fastrand::Rng::with_seed(seed);
    for _ in 0..10_000 {
        let Some(text) = drawn_text(&mut random) else { continue };
        let Ok(plain) = Scene::from_toml(&text) else { continue };
        let Some(lumped) = drawn_lumped(&plain, &mut random) else { continue };
        let Ok(scene) = Scene::from_toml(&format!("{text}{lumped}")) else { continue };
        let request = drawn_request(scene.planets.count(), &mut random);
        return Ok(DrawnScene { seed, scene, request });
    }
    Err(ExperimentError::Incomplete("drawn scene that can be assembled"))
}

fn between(random: &mut fastrand::Rng, low: f64, high: f64) -> f64 {
    low + random.f64() * (high - low)
}

fn drawn_text(random: &mut fastrand::Rng) -> Option<String> {
    let planets = random.u32(3..=6);
    let (sun, planet) = (random.u32(20..=48), random.u32(20..=40));
    let ring = sun + 2 * planet;
    let module = between(random, 2.0, 5.0);
    let (z_s, z_p, z_r) = (f64::from(sun), f64::from(planet), f64::from(ring));
    let distance = 0.5 * module * (z_s + z_p);
    let room = 2.0 * distance * (std::f64::consts::PI / f64::from(planets)).sin();
    if !(sun + ring).is_multiple_of(planets) || room < module * (z_p + 3.0) {
        return None;
    }
    let angle = between(random, 20.0, 23.0);
    let width = module * between(random, 6.0, 12.0);
    let rim = |random: &mut fastrand::Rng| 2.0 * module * between(random, 2.5, 5.0);
    let bores = [module * (z_s - 2.5) - rim(random), module * (z_p - 2.5) - rim(random)];
    let outside = module * (z_r + 2.5) + rim(random);
    // Every second set has relieved tips of sun and planet.
    let relief = |random: &mut fastrand::Rng, z: f64| {
        let start = module * (z + 2.0 - between(random, 0.5, 1.2));
        let amount = between(random, 5.0, 20.0);
        format!("tip_relief = {{ start_diameter_mm = {start:.4}, amount_um = {amount:.3} }}\n")
    };
    let has_relief = random.bool();
    let reliefs = [z_s, z_p].map(|z| if has_relief { relief(random, z) } else { String::new() });
    let bearing = |random: &mut fastrand::Rng| 1e6 * between(random, 50.0, 400.0);
    let [k_sun, k_carrier, k_planet] = [(); 3].map(|()| bearing(random));
    let force = width * between(random, 100.0, 400.0);
    let base = 0.5e-3 * module * z_s * angle.to_radians().cos();
    let torque = force * base * f64::from(planets);
    let speed = between(random, 500.0, 3000.0);
    let damping = between(random, 50.0, 300.0);
    let fillet = 0.3 * module;
    Some(format!(
        r#"format = 1
kind = "planetary"
title = "Drawn set"
[planets]
count = {planets}
[teeth]
sun = {sun}
planet = {planet}
ring = {ring}
[geometry]
center_distance_mm = {distance:.6}
face_width_mm = {width:.4}
rack = {{ module_mm = {module:.6}, pressure_angle_deg = {angle:.4} }}
[geometry.sun]
tip_diameter_mm = {:.4}
root_diameter_mm = {:.4}
bore_diameter_mm = {:.4}
fillet_radius_mm = {fillet:.4}
{}[geometry.planet]
tip_diameter_mm = {:.4}
root_diameter_mm = {:.4}
bore_diameter_mm = {:.4}
fillet_radius_mm = {fillet:.4}
{}[geometry.ring]
tip_diameter_mm = {:.4}
root_diameter_mm = {:.4}
rim_diameter_mm = {outside:.4}
fillet_radius_mm = {fillet:.4}
[geometry.carrier]
bore_diameter_mm = {:.4}
outer_diameter_mm = {:.4}
pin_seat_diameter_mm = {:.4}
[geometry.thickness]
sun_planet_backlash_mm = {:.4}
ring_planet_backlash_mm = {:.4}
[material]
young_modulus_pa = 207e9
[sun]
bearing_n_per_m = {k_sun:.1}
[ring]
motion = "held"
[carrier]
motion = "rotation_held"
bearing_n_per_m = {k_carrier:.1}
[planet]
bearing_n_per_m = {k_planet:.1}
[damping]
mass_proportional_per_s = {damping:.3}
[operation]
speed_rpm = {speed:.3}
torque_nm = {torque:.3}
"#,
        module * (z_s + 2.0),
        module * (z_s - 2.5),
        bores[0],
        reliefs[0],
        module * (z_p + 2.0),
        module * (z_p - 2.5),
        bores[1],
        reliefs[1],
        module * (z_r - 1.7),
        module * (z_r + 2.5),
        // In the proportions of OH-58.
        1.54 * distance,
        2.63 * distance,
        0.225 * distance,
        0.035 * module,
        0.035 * module,
    ))
}

fn drawn_lumped(scene: &Scene, random: &mut fastrand::Rng) -> Option<String> {
    let geometry = gearset::Geometry::from_scene(scene).ok()?;
    let (m, i) = estimated_inertias(scene);
    let mut off = |value: Option<f64>, by: f64| Some(value? * between(random, 1.0 - by, 1.0 + by));
    let mesh = |mesh: Option<&gearset::Mesh>| estimated_mesh_stiffness(scene, mesh?);
    Some(format!(
        "[lumped]\nmass_kg = {{ sun = {:e}, planet = {:e}, carrier = {:e} }}\n\
         inertia_kg_m2 = {{ sun = {:e}, planet = {:e}, carrier = {:e} }}\n\
         mesh_n_per_m = {{ sun_planet = {:e}, ring_planet = {:e} }}\n",
        off(m.sun, 0.05)?,
        off(m.planet, 0.05)?,
        off(m.carrier, 0.05)?,
        off(i.sun, 0.05)?,
        off(i.planet, 0.05)?,
        off(i.carrier, 0.05)?,
        off(mesh(geometry.sun_planet.as_ref()), 0.2)?,
        off(mesh(geometry.ring_planet.as_ref()), 0.2)?,
    ))
}

fn drawn_request(planets: usize, random: &mut fastrand::Rng) -> FrequencyRequest {
    let types = [ModeType::Rotational, ModeType::Translational, ModeType::Planet];
    // Three planets have no planet modes.
    let mode_type = types[random.usize(0..if planets > 3 { 3 } else { 2 })];
    let number = random.usize(1..=if mode_type == ModeType::Translational { 6 } else { 3 });
    let tolerance_percent = TOLERANCES[random.usize(0..TOLERANCES.len())];
    FrequencyRequest { mode_type, number, tolerance_percent }
}

/// What `auto` did on a drawn scene, and the truth.
#[derive(Debug)]
pub struct AutoRow {
    /// Scene and request.
    pub drawn: DrawnScene,
    /// Choice or refusal.
    pub found: Result<Choice, AutoError>,
    /// The frequency by the truth, Hz; NaN where FE/contact refuses the set.
    pub truth_hz: f64,
    /// The cheapest candidate that is within the tolerance of the truth.
    pub cheapest: Option<AutoSettings>,
    /// CPU time of `auto` over that of the cheapest candidate, both from the scene to the number.
    pub cost_ratio: Option<f64>,
    /// The same over that of the cheapest FE/contact candidate that is within the tolerance.
    pub fe_cost_ratio: Option<f64>,
}

impl AutoRow {
    /// True error of the choice, percent of the truth.
    pub fn error_percent(&self) -> Option<f64> {
        let choice = self.found.as_ref().ok()?;
        Some(100.0 * (choice.value / self.truth_hz - 1.0).abs())
    }

    /// What is wrong with it, if anything.
    pub fn miss(&self) -> Option<&'static str> {
        let tolerance = self.drawn.request.tolerance_percent;
        // NaN is within nothing.
        let is_within = self.error_percent().map(|error| error <= tolerance);
        match (is_within, self.cost_ratio, self.cheapest) {
            (Some(false), ..) => Some("error"),
            (Some(true), Some(ratio), _) if ratio > 2.0 => Some("cost"),
            (None, _, Some(_)) => Some("refused"),
            _ => None,
        }
    }
}

/// Longest CPU time that is measured again, s, and how often: of less than that interrupts and cold caches are a good part.
const SHORT_S: f64 = 0.02;
const AGAIN: usize = 8;

/// CPU time of some work, s: the median of several runs where it is short.
pub(crate) fn timed(clock: &mut CpuTime, work: &mut dyn FnMut()) -> f64 {
    let mut once = || {
        let start = clock.seconds();
        work();
        clock.seconds() - start
    };
    let mut all = vec![once()];
    if all[0] < SHORT_S {
        all.extend((0..AGAIN).map(|_| once()));
        all.sort_by(f64::total_cmp);
    }
    all[all.len() / 2]
}

/// Runs `auto` on the scene of a seed, then the truth, then the candidates from cheap to dear up to the first that is
/// within the tolerance. Times are those of the calling thread: call it on a pool of one.
///
/// # Errors
/// If the scene cannot be drawn, or has no load.
pub fn auto_row(seed: u64) -> Result<AutoRow, ExperimentError> {
    let drawn = drawn_scene(seed)?;
    let case = LoadCase::of_scene(&drawn.scene)?;
    let (scene, request) = (&drawn.scene, &drawn.request);
    let mut clock = CpuTime::default();
    let mut found = None;
    let auto_s = timed(&mut clock, &mut || found = Some(choose_frequency(scene, &case, request)));
    let found = found.ok_or(ExperimentError::Incomplete("answer"))?;
    let of = |settings| frequency_with(scene, &case, settings, request);
    let truth = || -> Result<f64, ExperimentError> {
        let [some, many] = TRUTH_MODES;
        let (rigid, mut modal) = (of(WITHOUT_MODES)?, of(some)?);
        if (modal / rigid - 1.0).abs() > CHANGED {
            modal = of(many)?;
        }
        Ok(of(TRUTH)? * modal / rigid)
    };
    let truth_hz = truth().unwrap_or(f64::NAN);
    let (mut cheapest, mut cost_ratio, mut fe_cost_ratio) = (None, None, None);
    for settings in FrequencyRequest::candidates() {
        let mut value = Ok(f64::NAN);
        let own_s = timed(&mut clock, &mut || value = of(settings));
        let off = value.map_or(f64::NAN, |v| 100.0 * (v / truth_hz - 1.0).abs());
        if off <= request.tolerance_percent {
            let ratio = Some(auto_s / own_s);
            if cheapest.is_none() {
                (cheapest, cost_ratio) = (Some(settings), ratio);
            }
            if settings != AutoSettings::LUMPED {
                fe_cost_ratio = ratio;
                break;
            }
        }
    }
    Ok(AutoRow { drawn, found, truth_hz, cheapest, cost_ratio, fe_cost_ratio })
}
