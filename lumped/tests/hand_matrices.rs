//! Signs and coefficients of the stiffness matrix, against a one-planet set derived by hand and against the
//! motion of material points.

use std::path::Path;

use gearset::{Axis, Body, PlanetPositions};
use lumped::{LumpedError, LumpedModel};
use scene::{AddedMass, Freedom, Scene, Torsional};

/// The Lin & Parker set.
fn lin_parker() -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/lin_parker_1999_3p.toml");
    Scene::from_file(&path).unwrap()
}

/// The Lin & Parker set with one planet at ψ and unequal pressure angles, all members free.
fn one_planet(psi: f64) -> LumpedModel {
    let mut scene = lin_parker();
    scene.planets = PlanetPositions { psi_rad: vec![psi], steps: None };
    let lumped = scene.lumped.as_mut().unwrap();
    lumped.pressure_angle_rad.sun_planet = 0.41;
    lumped.pressure_angle_rad.ring_planet = 0.33;
    lumped.mesh_n_per_m.sun_planet = 3e8;
    lumped.mesh_n_per_m.ring_planet = 5e8;
    scene.supports.carrier.bearing_n_per_m = 1.1e8;
    scene.supports.ring.bearing_n_per_m = 1.2e8;
    scene.supports.sun.bearing_n_per_m = 1.3e8;
    scene.supports.planet_bearing_n_per_m = 0.9e8;
    scene.supports.sun.torsional = Torsional::PerLength(2e7);
    LumpedModel::from_scene(&scene).unwrap()
}

#[test]
fn stiffness_matrix_of_one_planet_at_zero() {
    let k = one_planet(0.0).stiffness();
    let (ks, kr, kp, a, b): (f64, f64, f64, f64, f64) = (3e8, 5e8, 0.9e8, 0.41, 0.33);
    let (sa, ca, sb, cb) = (a.sin(), a.cos(), b.sin(), b.cos());
    // Written out by hand. Order: carrier x y u, ring x y u, sun x y u, planet ζ η u.
    // At ψ = 0: δ_s = x_s sin α + y_s cos α + u_s − ζ sin α − η cos α + u_p,
    //           δ_r = −x_r sin β + y_r cos β + u_r + ζ sin β − η cos β − u_p.
    #[rustfmt::skip]
    let by_hand: [((usize, usize), f64); 54] = [
        ((0, 0), 1.1e8 + kp), ((1, 1), 1.1e8 + kp), ((1, 2), kp), ((2, 2), kp),
        ((0, 1), 0.0), ((0, 2), 0.0),
        ((0, 9), -kp), ((1, 10), -kp), ((2, 10), -kp), ((0, 10), 0.0), ((1, 9), 0.0), ((2, 9), 0.0),
        ((2, 11), 0.0), ((0, 11), 0.0), ((1, 11), 0.0),
        ((3, 3), 1.2e8 + kr*sb*sb), ((3, 4), -kr*sb*cb), ((3, 5), -kr*sb), ((4, 4), 1.2e8 + kr*cb*cb),
        ((4, 5), kr*cb), ((5, 5), kr + 1e9),
        ((3, 9), -kr*sb*sb), ((3, 10), kr*sb*cb), ((3, 11), kr*sb),
        ((4, 9), kr*sb*cb), ((4, 10), -kr*cb*cb), ((4, 11), -kr*cb),
        ((5, 9), kr*sb), ((5, 10), -kr*cb), ((5, 11), -kr),
        ((6, 6), 1.3e8 + ks*sa*sa), ((6, 7), ks*sa*ca), ((6, 8), ks*sa), ((7, 7), 1.3e8 + ks*ca*ca),
        ((7, 8), ks*ca), ((8, 8), ks + 2e7),
        ((6, 9), -ks*sa*sa), ((6, 10), -ks*sa*ca), ((6, 11), ks*sa),
        ((7, 9), -ks*sa*ca), ((7, 10), -ks*ca*ca), ((7, 11), ks*ca),
        ((8, 9), -ks*sa), ((8, 10), -ks*ca), ((8, 11), ks),
        ((9, 9), kp + ks*sa*sa + kr*sb*sb), ((9, 10), ks*sa*ca - kr*sb*cb),
        ((9, 11), -ks*sa - kr*sb), ((10, 10), kp + ks*ca*ca + kr*cb*cb),
        ((10, 11), -ks*ca + kr*cb), ((11, 11), ks + kr),
        ((0, 3), 0.0), ((3, 6), 0.0), ((0, 6), 0.0),
    ];
    for ((i, j), expected) in by_hand {
        assert!((k[(i, j)] - expected).abs() < 1e-6, "({i}, {j}): {} {expected}", k[(i, j)]);
        assert_eq!(k[(i, j)], k[(j, i)]);
    }
}

/// Mesh deflections are the approaches, along the line of action, of the two material points in contact;
/// computed from rigid-body motion without the formulas for δ.
#[test]
fn mesh_deflections_are_what_the_material_points_do() {
    let (psi, a, b) = (0.7f64, 0.41f64, 0.33f64);
    let model = one_planet(psi);
    let q: Vec<f64> = (0..12).map(|i| 1e-6 * ((i * i + 3 * i + 1) % 7) as f64 - 2e-6).collect();
    let of = |body, axis| q[model.coordinates.of(body, axis).unwrap()];
    let turn =
        |v: [f64; 2], t: f64| [v[0] * t.cos() - v[1] * t.sin(), v[0] * t.sin() + v[1] * t.cos()];
    // With u = r_b θ the radii may be chosen freely.
    let (r_s, r_r, r_p) = (0.0352, 0.129, 0.0456);
    let central = |body: Body, r_b: f64, point: [f64; 2]| {
        let theta = of(body, Axis::Rotation) / r_b;
        [of(body, Axis::First) - theta * point[1], of(body, Axis::Second) + theta * point[0]]
    };
    let planet = |point: [f64; 2]| {
        let t = turn([of(Body::Planet(0), Axis::First), of(Body::Planet(0), Axis::Second)], psi);
        let theta = of(Body::Planet(0), Axis::Rotation) / r_p;
        [t[0] - theta * point[1], t[1] + theta * point[0]]
    };
    let dot = |u: [f64; 2], v: [f64; 2]| u[0] * v[0] + u[1] * v[1];
    // Sun mesh in the planet's own frame: the line of action runs along (sin α, cos α), touching
    // the sun's base circle at r_s (cos α, −sin α) and the planet's at r_p (−cos α, sin α).
    let push = turn([a.sin(), a.cos()], psi);
    let on_sun = turn([r_s * a.cos(), -r_s * a.sin()], psi);
    let on_planet = turn([-r_p * a.cos(), r_p * a.sin()], psi);
    let approach = dot(central(Body::Sun, r_s, on_sun), push) - dot(planet(on_planet), push);
    let spring = |n: usize| {
        let mesh: Vec<_> = model.springs.iter().filter(|s| s.rows.len() == 1).collect();
        mesh[mesh.len() - 2 + n].deflection(0, |i| q[i])
    };
    assert!((spring(0) - approach).abs() < 1e-18, "{} {approach}", spring(0));
    // Ring mesh: the planet pushes the ring along (sin α_r, −cos α_r); base circles are touched at
    // r (cos α_r, sin α_r) from either centre. Positive u of the ring loads the spring.
    let push = turn([b.sin(), -b.cos()], psi);
    let on_ring = turn([r_r * b.cos(), r_r * b.sin()], psi);
    let on_planet = turn([r_p * b.cos(), r_p * b.sin()], psi);
    let approach = dot(planet(on_planet), push) - dot(central(Body::Ring, r_r, on_ring), push);
    assert!((spring(1) - approach).abs() < 1e-18, "{} {approach}", spring(1));
}

#[test]
fn what_is_fixed_to_the_planets_adds_to_their_mass_and_to_nothing_else() {
    let mut scene = lin_parker();
    let bare = LumpedModel::from_scene(&scene).unwrap();
    scene.supports.planet_added = AddedMass { mass_kg: 0.2, inertia_kg_m2: 3e-3 };
    scene.lumped.as_mut().unwrap().radius_m.planet = None;
    let refused = LumpedModel::from_scene(&scene).unwrap_err();
    assert_eq!(refused, LumpedError::NoRadius { body: Body::Planet(0) });
    scene.lumped.as_mut().unwrap().radius_m.planet = Some(0.05);
    let model = LumpedModel::from_scene(&scene).unwrap();
    for (i, (body, axis)) in model.coordinates.free().iter().enumerate() {
        let more = match (body, axis) {
            (Body::Planet(_), Axis::Rotation) => 3e-3 / (0.05 * 0.05),
            (Body::Planet(_), _) => 0.2,
            _ => 0.0,
        };
        assert_eq!(model.mass[i], bare.mass[i] + more);
    }
    assert_eq!(model.stiffness(), bare.stiffness());
}

/// A scene built in code says which body has no mass, and not the number of a coordinate.
#[test]
fn masses_that_are_none_are_refused_by_body() {
    let mut scene = lin_parker();
    scene.lumped.as_mut().unwrap().mass_kg.planet = Some(-1.0);
    let refused = LumpedModel::from_scene(&scene).unwrap_err().to_string();
    let expected = "`lumped.mass_kg` of the planet 0 is -1: it must be positive and finite";
    assert_eq!(refused, expected);
    scene.lumped.as_mut().unwrap().inertia_over_r2_kg.sun = Some(f64::NAN);
    let refused = LumpedModel::from_scene(&scene).unwrap_err();
    assert!(matches!(refused, LumpedError::Inertia { body: Body::Sun, .. }), "{refused}");
}

#[test]
fn held_members_leave_and_take_nothing_else_with_them() {
    let mut scene = lin_parker();
    let whole = LumpedModel::from_scene(&scene).unwrap().stiffness();
    scene.supports.ring.motion = Freedom::Held;
    scene.supports.carrier.motion = Freedom::RotationHeld;
    let model = LumpedModel::from_scene(&scene).unwrap();
    let part = model.stiffness();
    let kept: Vec<usize> = (0..18).filter(|i| ![2, 3, 4, 5].contains(i)).collect();
    assert_eq!(part.nrows(), kept.len());
    for (i, &p) in kept.iter().enumerate() {
        for (j, &q) in kept.iter().enumerate() {
            assert_eq!(part[(i, j)], whole[(p, q)]);
        }
    }
}
