//! The map of section 4.2's statements over mesh compliance and γ, four planets, as TOML for
//! `kept/torque_map.toml`. Some twenty minutes on two cores.
//!
//! `cargo run --release -p remake -- torque_map > kept/torque_map.toml`
//!
//! Compliance: `softening` s makes the factors on the FE flexibility 1 + s (f − 1), f being those of
//! `scenes/oh58_4p_published_stiffness.toml`, so that s = 0 is the default scene and s = 1 the paper's
//! printed stiffness. γ is varied through the planet's share of the tooth thickness, with fillets of 0.5 mm,
//! which fit into every root. In addition to the map, lines over s at the default share: damping halved and
//! doubled, and tips relieved by 10 µm from a quarter of the tooth's depth. One resonance per mode: lowest
//! translational in l = 1, lowest rotational in l = 2, third translational in l = 3; 84 steps per cycle,
//! successive cycles agreeing to 1e-5. The growth of the static harmonics is given beside that of the peaks.

use experiments::models::FeContact;
use experiments::sweep::{Part, naturals};
use experiments::torque::{Followed, follow, lowest_series, static_growth};
use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, Imperfections, StaticSet};
use gearset::{Facing, MeshKind, Phasing, ReliefShape, ThicknessInput, TipRelief};
use rayon::prelude::*;
use scene::{PerMesh, Scene};
use validation::judge;
use validation::{PublishedScene, scene};

const TORQUES: [f64; 4] = [565.0, 1130.0, 1695.0, 2260.0];
const SOFTENINGS: [f64; 4] = [0.0, 0.5, 1.0, 1.5];
const SHARES: [f64; 5] = [0.43, 0.46, 0.49, 0.52, 0.55];

/// Torque at which the mean mesh stiffness is given, N·m, and number of positions of the mean.
const STIFFNESS_AT: (f64, usize) = (1130.0, 28);

const FILLET_M: f64 = 0.5e-3;
const RELIEF_M: f64 = 10e-6;

type Outcome<T> = Result<T, Box<dyn std::error::Error + Send + Sync>>;

/// One choice of the scene.
#[derive(Clone, Copy)]
struct Choice {
    line: &'static str,
    softening: f64,
    /// Planet's share of the tooth thickness; `None`: that of the default scene.
    share: Option<f64>,
    damping: f64,
    relief: f64,
}

fn choices() -> Vec<Choice> {
    let mut list = Vec::new();
    let plain = Choice { line: "map", softening: 0.0, share: None, damping: 1.0, relief: 0.0 };
    for share in SHARES {
        let of = |softening| Choice { softening, share: Some(share), ..plain };
        list.extend(SOFTENINGS.map(of));
    }
    let lines = [
        Choice { line: "default", ..plain },
        Choice { line: "damping halved", damping: 0.5, ..plain },
        Choice { line: "damping doubled", damping: 2.0, ..plain },
        Choice { line: "tips relieved", relief: RELIEF_M, ..plain },
    ];
    for line in lines {
        list.extend(SOFTENINGS.map(|softening| Choice { softening, ..line }));
    }
    list
}

/// The default scene with a choice applied; `soft` are the factors that give the printed stiffness.
fn chosen(base: &Scene, soft: PerMesh, choice: Choice) -> Scene {
    let mut scene = base.clone();
    scene.dynamics.steps_per_cycle = 84;
    let factor = |f: f64| 1.0 + choice.softening * (f - 1.0);
    scene.fe_contact.flexibility_factor =
        PerMesh { sun_planet: factor(soft.sun_planet), ring_planet: factor(soft.ring_planet) };
    scene.damping.mass_proportional_per_s *= choice.damping;
    scene.damping.stiffness_proportional_s *= choice.damping;
    scene.damping.bearing_s *= choice.damping;
    if let Some(g) = &mut scene.geometry {
        for gear in [g.sun.as_mut(), Some(&mut g.planet), g.ring.as_mut()].into_iter().flatten() {
            gear.fillet_radius_m = FILLET_M;
            if choice.relief > 0.0 {
                let start_radius =
                    gear.tip_radius_m + 0.25 * (gear.root_radius_m - gear.tip_radius_m);
                let shape = ReliefShape::Linear;
                gear.tip_relief = Some(TipRelief {
                    start_radius_m: start_radius,
                    amount_m: choice.relief,
                    shape,
                });
            }
        }
        if let (ThicknessInput::Backlash { planet_share, .. }, Some(share)) =
            (&mut g.thickness, choice.share)
        {
            *planet_share = share;
        }
    }
    scene
}

/// One cell as TOML.
fn cell(base: &Scene, soft: PerMesh, choice: Choice) -> Outcome<String> {
    let scene = chosen(base, soft, choice);
    let bodies = Bodies::new(&scene)?;
    let gamma = Phasing::new(&bodies.geometry, &scene.planets).ok_or("no phases")?.gamma();
    let set = StaticSet::new(&scene, &bodies, Facing::CounterClockwise, Imperfections::default())?;
    let cycle = set.cycle(STIFFNESS_AT.0, STIFFNESS_AT.1, &ActiveSet)?;
    let [sun, ring] =
        [MeshKind::SunPlanet, MeshKind::RingPlanet].map(|k| 1e-6 * cycle.mean_secant_stiffness(k));
    let all = lowest_series(&naturals(&scene, &bodies, scene::LoadCase::standing(STIFFNESS_AT.0))?)
        .ok_or("no such modes")?;
    let series: Vec<_> = [0, 2, 4].iter().map(|i| all[*i]).collect();
    let followed = follow(&FeContact::default(), &scene, &TORQUES, &series, &[Part::SUN], 1e-5)?;
    let still = static_growth(&scene, &bodies, &TORQUES)?;
    let numbers = |list: &[f64]| {
        list.iter().map(|x| format!("{:.4}", x / list[0])).collect::<Vec<_>>().join(", ")
    };
    let mut text = format!(
        "\n[[cell]]\nline = \"{}\"\nsoftening = {}\ngamma_cycles = {gamma:.5}\n",
        choice.line, choice.softening
    );
    text += &format!("mean_stiffness_n_per_um = [{sun:.2}, {ring:.2}]\n");
    // Rotation of the sun stands first in the static records.
    let of = |kind: usize, l: usize| still.iter().map(|s| s[kind][l]).collect::<Vec<f64>>();
    let parts = [("translational", 1, 1), ("rotational", 0, 2), ("third", 1, 3)];
    for ((name, kind, l), Followed { sun, .. }) in parts.into_iter().zip(&followed) {
        text += &format!("{name} = [{}]\n", numbers(sun));
        text += &format!("{name}_first = {:.4e}\n", sun[0]);
        text += &format!("{name}_static = [{}]\n", numbers(&of(kind, l)));
    }
    for statement in judge(&followed, true) {
        text += &format!("{} = {}\n", statement.name, statement.holds());
    }
    Ok(text)
}

pub(crate) fn remake() -> crate::Outcome {
    let base = scene(PublishedScene::Oh58FourPlanets)?;
    let soft =
        scene(PublishedScene::Oh58FourPlanetsPublishedStiffness)?.fe_contact.flexibility_factor;
    println!("# Statements on growth with torque over mesh compliance and γ, four planets.");
    println!("# Remade by: cargo run --release -p remake -- torque_map");
    println!("source = \"own computation, quasi-static fidelity, 84 steps a cycle\"");
    println!("command = \"cargo run --release -p remake -- torque_map\"");
    println!("torques_nm = {TORQUES:?}");
    // Two at a time, so that results are printed in order as they are found.
    for two in choices().chunks(2) {
        let texts: Vec<Outcome<String>> =
            two.par_iter().map(|choice| cell(&base, soft, *choice)).collect();
        for (text, choice) in texts.into_iter().zip(two) {
            print!("{}", text?);
            eprintln!("{}, softening {}, share {:?}", choice.line, choice.softening, choice.share);
        }
    }
    Ok(())
}
