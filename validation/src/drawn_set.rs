//! Planetary sets drawn from seeds, of drawn teeth, modules, widths, rims, bearings, loads and damping.

use scene::{Scene, estimated_inertias, estimated_mesh_stiffness};

/// The set of a seed: equally spaced planets, 3 to 6, on the rack without profile shift, of drawn teeth, modules,
/// widths, rims, bearings, loads, damping and tip relief; its `[lumped]` has estimates that are off
/// by up to 5 % (masses, inertias) and 20 % (mesh stiffnesses). Sets that cannot be assembled, or that the reader of
/// scenes refuses, are drawn again; `None` if no scene is found in 10,000 draws.
pub fn drawn_set(seed: u64) -> Option<Scene> {
    let mut random = fastrand::Rng::with_seed(seed);
    for _ in 0..10_000 {
        let Some(text) = drawn_text(&mut random) else { continue };
        let Ok(plain) = Scene::from_toml(&text) else { continue };
        let Some(lumped) = drawn_lumped(&plain, &mut random) else { continue };
        let Ok(scene) = Scene::from_toml(&format!("{text}{lumped}")) else { continue };
        return Some(scene);
    }
    None
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
    let geometry = scene.tooth_geometry().ok()?;
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
