//! Follows the resonances of section 4.2 over torque on one scene: heights over those at 565 N·m, what
//! holds of the statements, and the growth of the static harmonics beside them.
//!
//! `cargo run --release -p validation --example torque -- scenes/oh58_4p.toml`

use fe_contact::statics::Bodies;
use gearset::Scene;
use validation::sweep::{Part, naturals};
use validation::torque::{Followed, follow, judge, lowest_series, static_growth};

const TORQUES: [f64; 4] = [565.0, 1130.0, 1695.0, 2260.0];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).ok_or("a scene file is needed")?;
    let scene = Scene::from_file(path.as_ref())?;
    let bodies = Bodies::new(&scene)?;
    let series = lowest_series(&naturals(&scene, &bodies, 1130.0)?).ok_or("no such modes")?;
    let followed = follow(&scene, &bodies, &TORQUES, &series, &[Part::Sun, Part::Planet(0)], 1e-6)?;
    let still = static_growth(&scene, &bodies, &TORQUES)?;
    for f in &followed {
        let shown = |list: &[f64]| {
            list.iter().map(|x| format!("{x:8.3}")).collect::<Vec<String>>().join(" ")
        };
        let speeds: Vec<String> = f.speeds_rpm.iter().map(|s| format!("{s:.0}")).collect();
        println!("{} at {} rpm, {:.3e} at 565", f.series.name(), speeds.join(", "), f.sun[0]);
        println!("    sun    {}", shown(&Followed::growth(&f.sun)));
        println!("    planet {}", shown(&Followed::growth(&f.planet)));
        let kind = usize::from(f.series.mode_type != lumped::ModeType::Rotational);
        let l = f.series.harmonic;
        let static_growth: Vec<f64> =
            still.iter().map(|h| h[kind][l] / still[0][kind][l]).collect();
        println!("    static {}", shown(&static_growth));
    }
    for (part, is_sun) in [("sun", true), ("planet", false)] {
        for s in judge(&followed, is_sun) {
            println!("{part}: {} of {}: {}", s.holding, s.asked, s.words);
        }
    }
    Ok(())
}
