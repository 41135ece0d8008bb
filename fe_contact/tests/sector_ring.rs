//! Responses of gears from one sector against those from the whole gear.

use fe_contact::body::{Accelerated, BodyMatrices, GearBody};
use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, Imperfections, StaticSet};
use gearset::Facing;
use scene::{ElementFamily, Scene};

fn scene(name: &str, family: ElementFamily) -> Scene {
    let path = format!("{}/../scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let mut scene = Scene::from_file(path.as_ref()).unwrap();
    scene.fe_contact.element = family;
    scene
}

/// Largest difference of two bodies' responses: of each of the teeth near the loaded one over its own
/// largest entry, and between the flanks of all teeth over the largest of the loaded one's. (A ring that is held at its
/// rim responds by less than the rounding error of that a few dozen teeth away.)
fn difference(one: &GearBody, other: &GearBody) -> [f64; 2] {
    let (mut near, mut around) = (0.0f64, 0.0f64);
    for offset in -4..=4 {
        let (a, b) = (one.response(offset).unwrap(), other.response(offset).unwrap());
        assert_eq!(a.shape(), b.shape());
        assert!(b.amax() > 0.0);
        near = near.max((a - b).amax() / b.amax());
    }
    let (teeth, mut largest) = (one.mesh.nodes.len() as i64, 0.0f64);
    for offset in 0..teeth {
        for on in 0..one.load_count() {
            for of in (0..one.load_count()).step_by(3) {
                for (force, measured) in [([1.0, 0.0], [0.6, 0.8]), ([0.0, 1.0], [-0.8, 0.6])] {
                    let (load, point) = ([(2 * on, 1.0)], [(2 * of, 1.0)]);
                    let of_body = |body: &GearBody| {
                        body.surface_flexibility((&load, force), offset, (&point, measured))
                    };
                    let (a, b) = (of_body(one), of_body(other));
                    largest = largest.max(b.abs());
                    around = around.max((a - b).abs());
                }
            }
        }
    }
    assert!(largest > 0.0);
    [near, around / largest]
}

/// Sun, planet and ring, all families of elements, even and odd numbers of teeth: the ring of condensed sectors
/// responds as the assembled whole gear does.
#[test]
fn a_ring_of_sectors_responds_as_the_whole_gear() {
    for (name, family) in [
        ("oh58_4p", ElementFamily::Quadratic),
        ("oh58_4p", ElementFamily::Linear),
        ("oh58_4p", ElementFamily::Incompatible),
        ("five_planets", ElementFamily::Quadratic),
    ] {
        let scene = scene(name, family);
        let bodies = Bodies::new(&scene).unwrap();
        for body in [bodies.sun.as_ref().unwrap(), &bodies.planet, bodies.ring.as_ref().unwrap()] {
            let whole =
                GearBody::of_whole_gear(body.mesh.clone(), body.material, body.face_width).unwrap();
            assert_eq!((body.mass, body.inertia), (whole.mass, whole.inertia));
            assert_eq!(body.unknowns, whole.unknowns);
            let off = difference(body, &whole);
            println!("{name} {family:?} {}: {off:?}", body.mesh.name);
            assert!(off.iter().all(|x| *x < 1e-9), "{name} {family:?} {}: {off:?}", body.mesh.name);
        }
    }
}

/// Transmission error, mesh forces and mesh stiffness of four planets over a mesh cycle are those with bodies from
/// whole gears.
#[test]
fn statics_on_a_ring_of_sectors_are_those_on_whole_gears() {
    let scene = scene("oh58_4p", ElementFamily::Quadratic);
    let bodies = Bodies::new(&scene).unwrap();
    let mut whole = bodies.clone();
    let remade = |body: &GearBody| {
        GearBody::of_whole_gear(body.mesh.clone(), body.material, body.face_width).unwrap()
    };
    whole.sun = bodies.sun.as_ref().map(remade);
    whole.planet = remade(&bodies.planet);
    whole.ring = bodies.ring.as_ref().map(remade);
    let (sense, torque) = (Facing::CounterClockwise, 1413.0);
    let cycle = |bodies: &Bodies| {
        let set = StaticSet::new(&scene, bodies, sense, Imperfections::default()).unwrap();
        set.cycle(torque, 14, &ActiveSet).unwrap()
    };
    let (ring, whole) = (cycle(&bodies), cycle(&whole));
    let (mut worst, mut compared) = (0.0f64, 0);
    for (a, b) in ring.states.iter().zip(&whole.states) {
        let mut near = |a: f64, b: f64| {
            worst = worst.max((a - b).abs() / b.abs());
            compared += 1;
        };
        // Rotation of the sun, rad.
        near(a.central[2][2], b.central[2][2]);
        for (a, b) in a.meshes.iter().zip(&b.meshes) {
            near(a.force, b.force);
            near(a.tangent, b.tangent);
        }
    }
    println!("{worst:.1e}");
    assert_eq!(compared, 14 * 17);
    assert!(worst < 1e-9, "{worst:e}");
}

/// The displacement of a gear under accelerations of its race from one sector: M_rf K⁻¹ M_fr and wᵀ M_ff w are those of
/// the assembled whole gear, and their ratio is close above the first eigenvalue with the race held.
#[test]
#[ignore = "long: .ci/full runs it"]
fn an_accelerated_race_displaces_a_ring_of_sectors_as_the_whole_gear() {
    for name in ["oh58_4p", "five_planets"] {
        let scene = scene(name, ElementFamily::Quadratic);
        let bodies = Bodies::new(&scene).unwrap();
        for body in [bodies.sun.as_ref().unwrap(), &bodies.planet, bodies.ring.as_ref().unwrap()] {
            let own = Accelerated::new(body).unwrap().unwrap();
            let whole = BodyMatrices::of_gear(&body.mesh, &body.material, body.face_width).unwrap();
            let factor = whole.stiffness.factorise(body.mesh.name).unwrap();
            let mut quotients = Vec::new();
            for (k, which) in [(0, 0), (1, 0), (2, 1)] {
                let mut w = whole.coupling[k].clone();
                factor.solve_one(&mut w);
                let mut inertia = vec![0.0; whole.size];
                whole.mass.multiply_add(1.0, &w, &mut inertia);
                let dot = |a: &[f64]| a.iter().zip(&w).map(|(a, b)| a * b).sum::<f64>();
                let (coupled, moved) = (dot(&whole.coupling[k]), dot(&inertia));
                let off = [own.coupled[which] / coupled - 1.0, own.moved[which] / moved - 1.0];
                assert!(off.iter().all(|x| x.abs() < 1e-9), "{} {k}: {off:?}", body.mesh.name);
                quotients.push(coupled / moved);
            }
            let modes = fe_contact::vibration::fixed_race_modes(&whole, 4, 1.0, body.mesh.name);
            let first = modes.unwrap()[0].lambda;
            let ratio = own.first() / first;
            println!("{name} {}: {quotients:?} {first} {ratio}", body.mesh.name);
            assert!(ratio > 1.0 - 1e-6 && ratio < 1.05, "{} {ratio}", body.mesh.name);
        }
    }
}
