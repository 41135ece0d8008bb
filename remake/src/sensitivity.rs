//! Effect of damping, plane state and fillets on the growth of the first peaks with torque: heights at
//! 2260 N·m over those at 565 N·m, four planets.
//!
//! `cargo run --release -p remake -- sensitivity`

use experiments::models::FeContact;
use experiments::sweep::{Part, naturals};
use experiments::torque::{follow, lowest_series};
use fe_contact::statics::Bodies;
use scene::{PlaneState, Scene};
use validation::{PublishedScene, scene};

const TORQUES: [f64; 2] = [565.0, 2260.0];

fn with_fillet(mut scene: Scene, radius: f64) -> Scene {
    if let Some(g) = &mut scene.geometry {
        for gear in [g.sun.as_mut(), Some(&mut g.planet), g.ring.as_mut()].into_iter().flatten() {
            gear.fillet_radius_m = radius;
        }
    }
    scene
}

pub(crate) fn remake() -> crate::Outcome {
    let base = scene(PublishedScene::Oh58FourPlanets)?;
    let damped = |factor: f64| {
        let mut scene = base.clone();
        scene.damping.mass_proportional_per_s *= factor;
        scene.damping.stiffness_proportional_s *= factor;
        scene.damping.bearing_s *= factor;
        scene
    };
    let mut stress = base.clone();
    stress.fe_contact.plane = PlaneState::Stress;
    let variants = [
        ("default", base.clone()),
        ("damping halved", damped(0.5)),
        ("damping doubled", damped(2.0)),
        ("plane stress", stress),
        ("fillets of 0.4 mm", with_fillet(base.clone(), 0.4e-3)),
    ];
    println!("| | translational, l = 1 | rotational, l = 2 | µm at 565 N·m | µrad at 565 N·m |");
    println!("|---|---:|---:|---:|---:|");
    for (name, scene) in variants {
        let bodies = Bodies::new(&scene)?;
        let all = lowest_series(&naturals(&scene, &bodies, scene::LoadCase::standing(1130.0))?)
            .ok_or("no such modes")?;
        let found =
            follow(&FeContact::default(), &scene, &TORQUES, &[all[0], all[2]], &[Part::SUN], 1e-5)?;
        let [t, r] = [&found[0].sun, &found[1].sun];
        println!(
            "| {name} | {:.2} | {:.2} | {:.2} | {:.1} |",
            t[1] / t[0],
            r[1] / r[0],
            1e6 * t[0],
            1e6 * r[0]
        );
    }
    Ok(())
}
