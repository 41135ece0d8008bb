//! The map of section 4.2's statements over mesh compliance and γ, four planets, as TOML for
//! `reference/torque_map.toml`. About a quarter of an hour on two cores.
//!
//! `cargo run --release -p validation --example torque_map > reference/torque_map.toml`
//!
//! Compliance: one factor on the FE flexibility of both meshes. γ: through the planet's share of the
//! tooth thickness, fillets of 0.5 mm so that every root has room. One resonance a mode: lowest
//! translational in l = 1, lowest rotational in l = 2, third translational in l = 3; 84 steps a cycle,
//! cycles repeating to 1e-5.

use fe_contact::statics::Bodies;
use gearset::{PerMesh, Phasing, Scene, ThicknessInput};
use validation::sweep::{Part, naturals};
use validation::torque::{follow, judge, lowest_series};

const TORQUES: [f64; 4] = [565.0, 1130.0, 1695.0, 2260.0];
const FACTORS: [f64; 8] = [1.0, 1.25, 1.5, 1.75, 2.0, 2.25, 2.5, 2.75];
const SHARES: [f64; 8] = [0.41, 0.43, 0.45, 0.47, 0.49, 0.51, 0.53, 0.55];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let base = Scene::from_file("scenes/oh58_4p.toml".as_ref())?;
    println!("# Statements on growth with torque over mesh compliance and γ, four planets.");
    println!("# Remade by: cargo run --release -p validation --example torque_map");
    println!("source = \"own computation, quasi-static rung\"");
    println!("command = \"cargo run --release -p validation --example torque_map\"");
    println!("torques_nm = {TORQUES:?}");
    for share in SHARES {
        for factor in FACTORS {
            let mut scene = base.clone();
            scene.dynamics.steps_per_cycle = 84;
            scene.fe_contact.flexibility_factor =
                PerMesh { sun_planet: factor, ring_planet: factor };
            if let Some(g) = &mut scene.geometry {
                for gear in
                    [g.sun.as_mut(), Some(&mut g.planet), g.ring.as_mut()].into_iter().flatten()
                {
                    gear.fillet_radius = 0.5e-3;
                }
                if let ThicknessInput::Backlash { planet_share, .. } = &mut g.thickness {
                    *planet_share = share;
                }
            }
            let bodies = Bodies::new(&scene)?;
            let phasing = Phasing::new(&bodies.geometry, &scene.planets).ok_or("no phases")?;
            let gamma = phasing.gamma();
            let all = lowest_series(&naturals(&scene, &bodies, 1130.0)?).ok_or("no such modes")?;
            let series: Vec<_> = [0, 2, 4].iter().map(|i| all[*i]).collect();
            let followed = follow(&scene, &bodies, &TORQUES, &series, &[Part::Sun], 1e-5)?;
            let list = |which: usize| -> Vec<String> {
                let first = followed[which].sun[0];
                followed[which].sun.iter().map(|x| format!("{:.4}", x / first)).collect()
            };
            println!("\n[[cell]]");
            println!("planet_share = {share}\ngamma_cycles = {gamma:.5}\nfactor = {factor}");
            for (k, name) in ["translational", "rotational", "third"].iter().enumerate() {
                println!("{name} = [{}]", list(k).join(", "));
            }
            for statement in judge(&followed, true) {
                println!("{} = {}", statement.name, statement.holds());
            }
            eprintln!("share {share}, factor {factor}");
        }
    }
    Ok(())
}
