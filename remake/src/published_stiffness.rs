//! Finds the factors of `scenes/oh58_*_published_stiffness.toml`: by how much the FE part of each
//! mesh's flexibility must grow for the mean secant stiffness at 1130 N·m to be the printed 350e6 N/m.
//!
//! `cargo run --release -p remake -- published_stiffness`

use fe_contact::FeError;
use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, Imperfections, StaticSet};
use gearset::{Facing, MeshKind};
use scene::Scene;
use validation::{PublishedScene, scene};

/// Section 3 of the paper: both meshes, N/m.
const PRINTED: f64 = 350e6;

/// Torque on the sun, N·m, and even positions of the mesh cycle over which the mean is taken.
const TORQUE_NM: f64 = 1130.0;
const POSITIONS: usize = 28;

/// 1/k of sun and ring meshes, k the mean over positions and planets of F/δ, m/N.
fn mean_compliance(scene: &Scene, bodies: &Bodies) -> Result<[f64; 2], FeError> {
    let perfect = Imperfections::default();
    let set = StaticSet::new(scene, bodies, Facing::CounterClockwise, perfect)?;
    let cycle = set.cycle(TORQUE_NM, POSITIONS, &ActiveSet)?;
    Ok([MeshKind::SunPlanet, MeshKind::RingPlanet].map(|k| 1.0 / cycle.mean_secant_stiffness(k)))
}

pub(crate) fn remake() -> crate::Outcome {
    for which in [PublishedScene::Oh58ThreePlanets, PublishedScene::Oh58FourPlanets] {
        let scene = scene(which)?;
        let mut bodies = Bodies::new(&scene)?;
        println!("{}", scene.title);
        println!("  factors (sun, ring)    mean secants (sun, ring), 1e6 N/m");
        // Compliance is nearly linear in the factor: secant steps, each mesh by itself.
        let mut before: Option<([f64; 2], [f64; 2])> = None;
        let mut factors = [1.0, 1.0];
        for _ in 0..8 {
            let input = &mut bodies.settings.input.flexibility_factor;
            (input.sun_planet, input.ring_planet) = (factors[0], factors[1]);
            let now = mean_compliance(&scene, &bodies)?;
            let [sun, ring] = now.map(|c| 1e-6 / c);
            println!("  {:.5} {:.5}    {sun:.4} {ring:.4}", factors[0], factors[1]);
            if now.iter().all(|c| (c * PRINTED - 1.0).abs() < 1e-6) {
                break;
            }
            let next = std::array::from_fn(|i| match before {
                None => factors[i] / (now[i] * PRINTED),
                Some((f, c)) => {
                    let slope = (now[i] - c[i]) / (factors[i] - f[i]);
                    factors[i] + (1.0 / PRINTED - now[i]) / slope
                }
            });
            before = Some((factors, now));
            factors = next;
        }
    }
    Ok(())
}
