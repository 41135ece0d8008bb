//! Rotations alone, as the limit of rigid bearings and against published and independent numbers.

use lumped::{LumpedModel, NaturalModes};
use scene::Scene;

use crate::common::scene;

/// Frequencies with multiplicity, Hz.
fn frequencies(model: &LumpedModel) -> Vec<f64> {
    let found = NaturalModes::of(model).unwrap();
    found.lambda.iter().map(|l| l.max(0.0).sqrt() / std::f64::consts::TAU).collect()
}

#[test]
fn rigid_bearings_leave_the_frequencies_of_rotations_alone() {
    for name in ["lin_parker_1999_3p.toml", "lin_parker_1999_4p.toml", "oh58_4p_as_published.toml"]
    {
        let mut set = scene(name);
        let limit = frequencies(&LumpedModel::from_scene(&set).unwrap().torsional());
        let largest = limit.iter().fold(0.0, |a: f64, f| a.max(*f));
        let supports = &mut set.supports;
        for support in [&mut supports.sun, &mut supports.ring, &mut supports.carrier] {
            support.bearing_n_per_m = 1e15;
        }
        supports.planet_bearing_n_per_m = 1e15;
        let mut stiff = frequencies(&LumpedModel::from_scene(&set).unwrap());
        stiff.retain(|f| *f < 1.1 * largest);
        assert_eq!(stiff.len(), limit.len(), "{name}: {stiff:?} {limit:?}");
        for (a, b) in stiff.iter().zip(&limit) {
            assert!((a - b).abs() <= 1e-4 * largest, "{name}: {stiff:?} {limit:?}");
        }
    }
}

/// Stage 2 of a public 5 MW wind turbine gearbox, ring held; expected frequencies are those of a torsional model that
/// was written independently of this program.
#[test]
fn a_wind_turbine_stage_has_the_frequencies_of_an_independent_torsional_model() {
    let set = Scene::from_toml(STAGE).unwrap();
    let found = frequencies(&LumpedModel::from_scene(&set).unwrap().torsional());
    let expected = [0.0, 745.05, 790.26, 790.26, 1653.52];
    assert_eq!(found.len(), expected.len());
    for (f, wanted) in found.iter().zip(expected) {
        assert!((f - wanted).abs() <= 0.005, "{found:?}");
    }
}

/// A stage of ratio 5 with teeth and pins of 1e12 N/m, whose carrier twists a shaft of 1e6 N·m/rad: all turn as one, so
/// that J = J_c + 5² J_s + N m_p a² + N J_p (Z_r/Z_p − 1)² and f = √(k/J)/2π = 13.528 Hz.
#[test]
fn a_rigid_stage_reflects_the_inertia_of_its_sun() {
    let set = Scene::from_toml(
        "format = 1\nkind = \"planetary\"\nplanets.count = 3\nteeth = { sun = 18, planet = 27, ring = 72 }\n\
         geometry = { rack.module_mm = 10, face_width_mm = 100 }\n[sun]\nbearing_n_per_m = 1e9\n\
         [ring]\nmotion = \"held\"\n[carrier]\nbearing_n_per_m = 1e9\ntorsional_nm_per_rad = 1e6\n\
         [planet]\nbearing_n_per_m = 1e12\n[lumped]\nmass_kg = { sun = 20, planet = 40, carrier = 200 }\n\
         inertia_kg_m2 = { sun = 5, planet = 0.4, carrier = 4 }\n\
         mesh_n_per_m = { sun_planet = 1e12, ring_planet = 1e12 }\n",
    );
    let first = frequencies(&LumpedModel::from_scene(&set.unwrap()).unwrap())[0];
    let (a, planets) = (0.225f64, 3.0);
    let inertia =
        4.0 + 25.0 * 5.0 + planets * (40.0 * a * a + 0.4 * (72.0f64 / 27.0 - 1.0).powi(2));
    let rigid = (1e6 / inertia).sqrt() / std::f64::consts::TAU;
    assert!((rigid - 13.528).abs() < 5e-4 && (first / rigid - 1.0).abs() < 1e-4, "{first} {rigid}");
}

const STAGE: &str = r#"
format = 1
kind = "planetary"
title = "Stage 2 of a 5 MW wind turbine gearbox"
planets.count = 3
teeth = { sun = 18, planet = 36, ring = 93 }

[geometry]
center_distance_mm = 584.0
face_width_mm = 550.0
rack = { module_mm = 21.0, pressure_angle_deg = 20.0 }
sun = { tip_diameter_mm = 432.838, root_diameter_mm = 341.838 }
planet = { tip_diameter_mm = 815.663, root_diameter_mm = 724.663 }
ring = { tip_diameter_mm = 1906.081, root_diameter_mm = 2000.581 }
thickness.profile_shift = { sun = 0.3805, planet = 0.4924, ring = -0.0962 }

[sun]
bearing_n_per_m = 1e9

[ring]
motion = "held"

[carrier]
bearing_n_per_m = 1e9

[planet]
bearing_n_per_m = 1e9

[lumped]
mass_kg = { sun = 379.740, planet = 880.299, carrier = 1500.0 }
inertia_kg_m2 = { sun = 8.91389, planet = 101.89854, carrier = 400.0 }
mesh_n_per_m = { sun_planet = 8.602e9, ring_planet = 11.30965e9 }
"#;
