//! Remakes `kept/full_impulse.toml`: impulse tests on bodies with every finite-element degree of
//! freedom. Prints the file; about ten minutes on two cores.

use std::path::Path;

use experiments::modal::{ImpulseSettings, impulse_test};
use fe_contact::statics::Bodies;
use scene::{Fidelity, Scene};

const FLANK_ELEMENTS: u32 = 8;
const TORQUE: f64 = 1130.0;

fn main() {
    // `cargo bench … -- --test` only tests that benches start.
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    println!("kind = \"own truth\"");
    println!(
        "source = \"this program, fidelity full, fe_contact.flank_elements = {FLANK_ELEMENTS}, pulses of 5 µs, \
         decays of 10 ms, 1130 N·m, position 0\""
    );
    println!("command = \"cargo bench --bench full_impulse\"");
    println!("flank_elements = {FLANK_ELEMENTS}\ntorque_nm = {TORQUE:.1}\nposition = 0.0");
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    for name in ["oh58_3p", "oh58_4p"] {
        let mut scene = Scene::from_file(&root.join(format!("{name}.toml"))).unwrap();
        scene.fe_contact.flank_elements = FLANK_ELEMENTS;
        scene.dynamics.fidelity = Fidelity::Full;
        let bodies = Bodies::new(&scene).unwrap();
        let test = impulse_test(
            &scene,
            &bodies,
            &ImpulseSettings::short(scene::LoadCase::standing(TORQUE), 0.0),
        )
        .unwrap();
        let list = |of: &dyn Fn(usize) -> String| {
            (0..test.modes.len()).map(of).collect::<Vec<_>>().join(", ")
        };
        println!("\n[[set]]\nscene = \"{name}\"");
        println!("frequencies_hz = [{}]", list(&|i| format!("{:.3}", test.modes[i].frequency_hz)));
        println!("damping_ratios = [{}]", list(&|i| format!("{:.5}", test.modes[i].damping_ratio)));
    }
}
