//! Follows the resonances of section 4.2 over torque on its three scenes, as TOML for
//! `kept/torque_peaks.toml`: heights over those at 565 N·m of the sun and of planet 0, and the growth
//! of the same harmonics of the sun at rest. About five minutes on two cores.
//!
//! `cargo run --release -p remake -- torque > kept/torque_peaks.toml`

use experiments::models::FeContact;
use experiments::sweep::{Part, naturals};
use experiments::torque::{Followed, follow, lowest_series, static_growth};
use fe_contact::statics::Bodies;
use gearset::Body;
use validation::{PublishedScene, scene};

const TORQUES: [f64; 4] = [565.0, 1130.0, 1695.0, 2260.0];

pub(crate) fn remake() -> crate::Outcome {
    let command = "cargo run --release -p remake -- torque";
    println!("# Resonant peaks over torque, four planets: heights over those at the first torque.");
    println!("source = \"own computation: quasi-static fidelity, 140 steps a cycle\"");
    println!("command = \"{command}\"");
    println!("torques_nm = {TORQUES:?}");
    let systems = [
        ("default scene", PublishedScene::Oh58FourPlanets),
        ("meshes as soft as published", PublishedScene::Oh58FourPlanetsPublishedStiffness),
        ("second system", PublishedScene::Oh58SecondSystem),
    ];
    let list = |values: &[f64]| {
        let shown: Vec<String> = values.iter().map(|x| format!("{x:.4}")).collect();
        format!("[{}]", shown.join(", "))
    };
    for (system, which) in systems {
        let scene = scene(which)?;
        let bodies = Bodies::new(&scene)?;
        let series = lowest_series(&naturals(&scene, &bodies, scene::LoadCase::standing(1130.0))?)
            .ok_or("no such modes")?;
        let both = [Part::SUN, Part::Body(Body::Planet(0))];
        let followed = follow(&FeContact::default(), &scene, &TORQUES, &series, &both, 1e-6)?;
        let still = static_growth(&scene, &bodies, &TORQUES)?;
        for f in &followed {
            let kind = usize::from(f.series.mode_type != lumped::ModeType::Rotational);
            let l = f.series.harmonic;
            let at_rest: Vec<f64> = still.iter().map(|h| h[kind][l] / still[0][kind][l]).collect();
            println!("\n[[peak]]");
            println!("system = \"{system}\"");
            println!("mode = \"{}\"", f.series.mode());
            println!("harmonic = {l}");
            println!("frequency_hz = {:.1}", f.series.frequency_hz);
            println!("speeds_rpm = {}", list(&f.speeds_rpm));
            println!("sun = {}", list(&Followed::growth(&f.sun)));
            println!("planet = {}", list(&Followed::growth(&f.planet)));
            println!("static = {}", list(&at_rest));
        }
    }
    Ok(())
}
