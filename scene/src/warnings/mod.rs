//! Values that are allowed and unlikely: each with the slip of unit that would explain it.

mod bodies;
mod closing;
mod contradictions;
mod numerics;

use std::fmt;

use gearset::{Geometry, MeshKind};

use crate::keys::KEYS;
use crate::load::case::LoadCase;
use crate::load::estimates;
use crate::load::size::LARGE_MODULES;
use crate::scene::{Scene, SceneKind, Support, Torsional};
use crate::warnings::bodies::bodies;
pub(crate) use crate::warnings::closing::{LARGE_BACKLASH, sign_warning, signed_mm};
use crate::warnings::closing::{backlash, bottom_clearance, ring_teeth};
use crate::warnings::contradictions::contradictions;
use crate::warnings::numerics::numerics;

/// Stiffness of a central support over that of a mesh: a support meant to float is still above this, and one in
/// N/µm is below it.
const SUPPORT_TO_MESH: f64 = 1e-4;
/// Given mesh stiffness over E b/13, above which teeth are meant to be rigid: real ones have 0.5 to 2.
const STIFF_MESH: f64 = 100.0;
/// Stiffness of a planet bearing over that of a mesh. Planets never float: real ratios are 0.05 to 10, and a bearing
/// in N/mm is below 1e-3 of its likely ratio 0.25.
const PIN_TO_MESH: f64 = 1e-3;
/// Stiffness of a bearing, N/m, that gives way by a centimetre under 1 kN.
const SOFT_BEARING_N_PER_M: f64 = 1e5;
/// Mesh force, N, from which a bearing that soft is unlikely.
const HEAVY_MESH_FORCE_N: f64 = 1e3;
/// Young's modulus, Pa: plastics have 1e9 or more, diamond 1.05e12.
const YOUNG_PA: [f64; 2] = [1e9, 1.1e12];
/// Poisson's ratio of metals and plastics used for gears.
const POISSON: [f64; 2] = [0.2, 0.4];
/// Density, kg/m³: plastics have 900 or more, tungsten and gold 19300.
const DENSITY_KG_PER_M3: [f64; 2] = [500.0, 20_000.0];
/// Module, mm: below 0.2 are watches, above 100 no cutter exists. A module of 2.8 mm typed in inches is 0.11, in
/// metres 0.0028.
const MODULE_MM: [f64; 2] = [0.2, 100.0];
/// Face width over module: usual are 3 to 30.
const WIDTH_IN_MODULES: [f64; 2] = [0.5, 200.0];
/// Amount of tip relief over the module: teeth bend by some hundredths of a module at most.
const RELIEF_IN_MODULES: [f64; 2] = [1e-4, 0.05];
/// Least stiffness of a mesh over Young's modulus, m: c_γ of ISO 6336-1 is 14 to 20 N/(mm µm) of steel, here at 1 mm.
const LEAST_MESH_IN_E: f64 = 5e-5;
/// Operating pressure angle, °, below which no rack leads.
const LEAST_ANGLE_DEG: f64 = 5.0;
/// Damping ratio of the highest mode of the rigid bodies: from 1 on nothing there vibrates.
const DAMPING_RATIO: f64 = 1.0;
/// Mesh frequency, Hz: a turbine gear of 100 teeth at 30000 rpm has half of it.
const MESH_FREQUENCY_HZ: f64 = 1e5;

/// An allowed value that is unlikely.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Warning {
    /// Full dotted path of the key.
    pub key: String,
    /// Its value, in the unit of the key.
    pub value: String,
    /// What is unlikely about it.
    pub what: String,
    /// The slip that would explain it.
    pub likely: String,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` is {}: {}; {}", self.key, self.value, self.what, self.likely)
    }
}

/// The unlikely values of a valid scene.
pub fn warnings(scene: &Scene) -> Vec<Warning> {
    let mut found = Found(Vec::new());
    let geometry = scene.tooth_geometry().ok();
    material(scene, &mut found);
    if let Some(geometry) = &geometry {
        lengths(geometry, &mut found);
        backlash(scene, geometry, &mut found);
        tip_reliefs(geometry, &mut found);
        bottom_clearance(geometry, &mut found);
        load(scene, geometry, &mut found);
        contradictions(scene, geometry, &mut found);
    }
    ring_teeth(scene, &mut found);
    parameters_alone(scene, &mut found);
    bodies(scene, &mut found);
    supports(scene, geometry.as_ref(), &mut found);
    damping(scene, &mut found);
    speed(scene, &mut found);
    found.0.extend(numerics(scene, geometry.as_ref()));
    found.0
}

struct Found(Vec<Warning>);

impl Found {
    fn add(&mut self, key: impl Into<String>, value: f64, what: String, likely: &str) {
        let value = shown(value);
        self.0.push(Warning { key: key.into(), value, what, likely: likely.into() });
    }
}

/// A number as people write it.
pub(crate) fn shown(x: f64) -> String {
    if x != 0.0 && !(1e-3..1e5).contains(&x.abs()) {
        return format!("{x:.4e}");
    }
    let text = format!("{x:.5}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn is_outside([low, high]: [f64; 2], x: f64) -> bool {
    x < low || x > high
}

fn material(scene: &Scene, found: &mut Found) {
    let m = &scene.material;
    let e = m.young_modulus_pa;
    if is_outside(YOUNG_PA, e) {
        let likely = match e {
            e if e < 1.5e3 => "likely it is in GPa: write it in Pa, e.g. 207e9",
            e if e < 1.5e6 => "likely it is in MPa (N/mm²): write it in Pa, e.g. 207e9",
            _ => "likely a slip in the exponent: steel has 207e9 Pa",
        };
        let what = format!("solids have {:e} to {:e} Pa", YOUNG_PA[0], YOUNG_PA[1]);
        found.add("material.young_modulus_pa", e, what, likely);
    }
    if is_outside(POISSON, m.poisson_ratio) {
        let what = format!("metals and plastics have {} to {}", POISSON[0], POISSON[1]);
        found.add("material.poisson_ratio", m.poisson_ratio, what, "likely a slip: steel has 0.3");
    }
    let rho = m.density_kg_per_m3;
    if is_outside(DENSITY_KG_PER_M3, rho) {
        let likely = match rho {
            r if r < 1e-3 => "likely it is in t/mm³ or kg/mm³: write it in kg/m³, e.g. 7850",
            r if r < 25.0 => "likely it is in g/cm³ or kg/dm³: write it in kg/m³, e.g. 7850",
            _ => "likely a slip of unit: steel has 7850 kg/m³",
        };
        let [low, high] = DENSITY_KG_PER_M3;
        found.add(
            "material.density_kg_per_m3",
            rho,
            format!("solids have {low} to {high} kg/m³"),
            likely,
        );
    }
}

fn lengths(geometry: &Geometry, found: &mut Found) {
    let Some(module) = estimates::module(geometry) else { return };
    if is_outside(MODULE_MM, 1e3 * module) {
        let likely = match 1e3 * module {
            m if m < 0.02 => "likely lengths are in m: write them in mm",
            m if m < 1.0 => "likely lengths are in inches: write them in mm",
            _ => "likely lengths are in µm: write them in mm",
        };
        let what = format!(
            "with the numbers of teeth it makes a module of {} mm, where gears have {} to {} mm",
            shown(1e3 * module),
            MODULE_MM[0],
            MODULE_MM[1]
        );
        found.add("geometry.center_distance_mm", 1e3 * geometry.center_distance, what, likely);
    }
    let widths = geometry.face_width / module;
    if is_outside(WIDTH_IN_MODULES, widths) {
        let what = format!(
            "that is {} modules of {} mm, where gears are {} to {} wide",
            shown(widths),
            shown(1e3 * module),
            WIDTH_IN_MODULES[0],
            WIDTH_IN_MODULES[1]
        );
        let likely = match widths {
            w if w < 1.0 => "likely it is in m or inches: write it in mm",
            _ => "likely it is in µm, or a slip in the exponent: write it in mm",
        };
        found.add("geometry.face_width_mm", 1e3 * geometry.face_width, what, likely);
    }
}

fn tip_reliefs(geometry: &Geometry, found: &mut Found) {
    let Some(module) = estimates::module(geometry) else { return };
    let gears = [
        ("sun", geometry.sun.as_ref()),
        ("planet", Some(&geometry.planet)),
        ("ring", geometry.ring.as_ref()),
    ];
    for (name, gear) in gears {
        let Some(relief) = gear.and_then(|gear| gear.tip_relief) else { continue };
        let modules = relief.amount_m / module;
        if relief.amount_m > 0.0 && is_outside(RELIEF_IN_MODULES, modules) {
            let what = format!(
                "that is {} of the module of {} mm, where gears have {} to {}",
                shown(modules),
                shown(1e3 * module),
                shown(RELIEF_IN_MODULES[0]),
                RELIEF_IN_MODULES[1]
            );
            let key = format!("geometry.{name}.tip_relief.amount_um");
            found.add(key, 1e6 * relief.amount_m, what, "likely it is not in µm");
        }
    }
}

fn load(scene: &Scene, geometry: &Geometry, found: &mut Found) {
    let deflection = estimates::deflection(scene, geometry);
    if let (Some(length), Some(module), Some(o)) =
        (deflection, estimates::module(geometry), scene.operation)
        && length > LARGE_MODULES * module
    {
        let what = format!(
            "by estimate the teeth give way by {} mm, {} of the module",
            shown(1e3 * length),
            shown(length / module)
        );
        let likely = match scene.kind {
            SceneKind::Planetary => {
                "likely the torque is in N·mm, or `planet.bearing_n_per_m` is not in N/m; if neither, lines of action turn so far \
                 under load that natural frequencies of the lumped model, which has those of the unloaded set, are up to 1 % off"
            }
            SceneKind::GearPair => "likely the torque is in N·mm",
        };
        found.add("operation.torque_nm", o.torque_nm, what, likely);
    }
}

/// Mesh stiffnesses and pressure angles of a scene without teeth to hold them against.
fn parameters_alone(scene: &Scene, found: &mut Found) {
    let Some(lumped) = scene.lumped.as_ref().filter(|_| scene.geometry.is_none()) else { return };
    let kinds = [MeshKind::SunPlanet, MeshKind::RingPlanet];
    let is_there = |kind: &MeshKind| scene.pair.is_none_or(|pair| pair == *kind);
    for kind in kinds.into_iter().filter(is_there) {
        let k = lumped.mesh_n_per_m.of(kind);
        let least = LEAST_MESH_IN_E * scene.material.young_modulus_pa;
        if k < least {
            let what =
                format!("teeth of this material have {} N/m at a face width of 1 mm", shown(least));
            let likely = "likely it is in N/mm (1 N/mm = 1000 N/m) or N/µm (1e6 N/m)";
            found.add(format!("lumped.mesh_n_per_m.{}", kind.name()), k, what, likely);
        }
        let angle = lumped.pressure_angle_rad.of(kind).to_degrees();
        if angle < LEAST_ANGLE_DEG {
            let what = "gears have 14 to 30°".into();
            let likely = "likely it is in radians: write it in degrees";
            found.add(format!("lumped.pressure_angle_deg.{}", kind.name()), angle, what, likely);
        }
    }
}

/// Stiffnesses of bearings and torsional supports against that of a mesh.
fn supports(scene: &Scene, geometry: Option<&Geometry>, found: &mut Found) {
    let Some(mesh) = estimates::mesh_stiffness(scene) else { return };
    // Teeth that are given as all but rigid say nothing of bearings.
    let mesh = estimates::pair_stiffness(scene).map_or(mesh, |pair| mesh.min(STIFF_MESH * pair));
    let force = geometry.and_then(|g| estimates::mesh_force(scene, g)).unwrap_or(0.0);
    let soft = |k: f64, least: f64| {
        k > 0.0 && (k < least * mesh || (k < SOFT_BEARING_N_PER_M && force > HEAVY_MESH_FORCE_N))
    };
    let what = |k: f64| {
        format!("it is {} of the stiffness of a mesh, {} N/m", shown(k / mesh), shown(mesh))
    };
    let likely = "likely it is in N/mm (1 N/mm = 1000 N/m) or N/µm (1e6 N/m)";
    let s = &scene.supports;
    let base = |gear: Option<&gearset::Gear>| gear.map(|g| g.base_radius);
    let lumped = scene.lumped.as_ref().map(|l| l.radius_m).unwrap_or_default();
    let mut members: Vec<(&str, Support, Option<f64>)> = vec![
        ("sun", s.sun, lumped.sun.or(geometry.and_then(|g| base(g.sun.as_ref())))),
        ("ring", s.ring, lumped.ring.or(geometry.and_then(|g| base(g.ring.as_ref())))),
        ("carrier", s.carrier, lumped.carrier.or(geometry.map(|g| g.center_distance))),
    ];
    let base_radius = lumped.planet.or(geometry.map(|g| g.planet.base_radius));
    members.extend(s.pair.map(|pair| ("planet", pair.planet, base_radius)));
    for (name, support, radius) in members {
        if support.motion.translates() && soft(support.bearing_n_per_m, SUPPORT_TO_MESH) {
            found.add(
                format!("{name}.bearing_n_per_m"),
                support.bearing_n_per_m,
                what(support.bearing_n_per_m),
                likely,
            );
        }
        if !support.motion.rotates() {
            continue;
        }
        let (key, given, unit) = match support.torsional {
            Torsional::PerLength(k) => ("torsional_n_per_m", k, likely),
            Torsional::PerAngle(k) => {
                ("torsional_nm_per_rad", k, "likely it is in N·mm/rad or kN·m/rad")
            }
        };
        let per_length = match support.torsional {
            Torsional::PerLength(k) => Some(k),
            Torsional::PerAngle(_) => radius.map(|r| estimates::per_length(&support, r)),
        };
        if let Some(k) = per_length
            && soft(k, SUPPORT_TO_MESH)
        {
            found.add(format!("{name}.{key}"), given, format!("per u = r·θ {}", what(k)), unit);
        }
    }
    if soft(s.planet_bearing_n_per_m, PIN_TO_MESH) {
        found.add(
            "planet.bearing_n_per_m",
            s.planet_bearing_n_per_m,
            what(s.planet_bearing_n_per_m),
            likely,
        );
    }
}

/// Damping ratios α/2ω and βω/2 at the highest frequency of the rigid bodies.
fn damping(scene: &Scene, found: &mut Found) {
    let Some(omega) = estimates::highest_frequency(scene) else { return };
    let d = &scene.damping;
    let (alpha, beta) = (d.mass_proportional_per_s, d.stiffness_proportional_s);
    let values = [
        ("damping.mass_proportional_per_s", alpha, 0.5 * alpha / omega),
        ("damping.stiffness_proportional_s", beta, 0.5 * beta * omega),
        ("damping.bearing_s", d.bearing_s, 0.5 * d.bearing_s * omega),
    ];
    for (key, value, ratio) in values {
        // `bearing_s` left out is β.
        let is_repeated = key == "damping.bearing_s" && value == beta;
        // The default reaches this in sets whose bearings are given as all but rigid.
        let is_default = KEYS.iter().any(|k| k.path == key && k.default_si() == Some(value));
        if ratio > DAMPING_RATIO && !is_repeated && !is_default {
            let hertz = shown(omega / std::f64::consts::TAU);
            let what = format!(
                "near the highest mode, about {hertz} Hz, it makes a damping ratio of {}",
                shown(ratio)
            );
            let likely = "likely it is in ms or µs, or is itself a damping ratio or percentage";
            found.add(key, value, what, likely);
        }
    }
}

fn speed(scene: &Scene, found: &mut Found) {
    let Ok(case) = LoadCase::of_scene(scene) else { return };
    let hertz = case.mesh_frequency_hz;
    if let Some(operation) = scene.operation
        && hertz > MESH_FREQUENCY_HZ
    {
        let what = format!(
            "it makes a mesh frequency of {} Hz, above {MESH_FREQUENCY_HZ:e} Hz",
            shown(hertz)
        );
        found.add(
            "operation.speed_rpm",
            operation.speed_rpm,
            what,
            "likely it is in turns an hour or degrees a second",
        );
    }
}

#[cfg(test)]
mod tests;
