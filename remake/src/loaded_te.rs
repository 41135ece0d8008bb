//! Origin of the growth with torque: harmonics of the loaded transmission error of one sun mesh and one ring
//! mesh alone, their sum at the mesh phases of the set, and those of the whole set at rest, four planets.
//!
//! `cargo run --release -p remake -- loaded_te`
//!
//! With every planet under the same force and nothing but rotation, the sun's base circle follows
//!
//! ```text
//! u_l = T_s,l (1/N) Σ_n e^{i2πl φ_sn} + T_r,l (1/N) Σ_n e^{i2πl φ_rn}
//! ```
//!
//! with T_s and T_r the harmonics of one mesh alone over its phase, and φ the mesh phases at position 0.

use std::f64::consts::TAU;

use dynamics::{Window, spectrum};
use experiments::torque::static_growth;
use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, pair_cycle};
use gearset::{MeshKind, MeshStart, Phasing};
use validation::{PublishedScene, scene};

const TORQUES: [f64; 4] = [565.0, 1130.0, 1695.0, 2260.0];
const POSITIONS: usize = 140;

/// A complex number.
type Z = [f64; 2];

fn times(a: Z, b: Z) -> Z {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

pub(crate) fn remake() -> crate::Outcome {
    let both = [
        ("default", PublishedScene::Oh58FourPlanets),
        ("published stiffness", PublishedScene::Oh58FourPlanetsPublishedStiffness),
    ];
    println!(
        "| scene | N·m | contact ratios (sun, ring) | sun mesh l = 1, 2, µm | ring mesh l = 1, 2, µm | l = 2 at the set's phases, µm | set at rest, µm |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|");
    for (name, which) in both {
        let scene = scene(which)?;
        let bodies = Bodies::new(&scene)?;
        let radius = bodies.geometry.sun.as_ref().ok_or("no sun")?.base_radius;
        let phasing = Phasing::new(&bodies.geometry, &scene.planets).ok_or("no phases")?;
        let starts = MeshStart::of_set(&phasing);
        let planets = starts.len() / 2;
        let still = static_growth(&scene, &bodies, &TORQUES)?;
        for (k, torque) in TORQUES.into_iter().enumerate() {
            let force = torque / planets as f64 / radius;
            // Harmonics 1 and 2 of one mesh, and its effective contact ratio.
            let of = |kind| -> Result<([Z; 2], f64), Box<dyn std::error::Error + Send + Sync>> {
                let cycle = pair_cycle(&bodies, kind, force, POSITIONS, &ActiveSet)?;
                let record: Vec<f64> = cycle.positions.iter().map(|p| p.deflection).collect();
                let lines = spectrum(&record, 1.0, Window::Rectangular, 1)?.lines;
                let both = [1, 2].map(|l| [lines[l].re, lines[l].im]);
                Ok((both, cycle.effective_contact_ratio()))
            };
            let (sun, ring) = (of(MeshKind::SunPlanet)?, of(MeshKind::RingPlanet)?);
            let mut sum = [0.0; 2];
            for (m, start) in starts.iter().enumerate() {
                let (sin, cos) = (2.0 * TAU * start.front).sin_cos();
                let own = times(if m < planets { sun.0[1] } else { ring.0[1] }, [cos, sin]);
                sum = [0, 1].map(|i| sum[i] + own[i] / planets as f64);
            }
            let size = |z: Z| 1e6 * z[0].hypot(z[1]);
            println!(
                "| {name} | {torque:.0} | {:.2}, {:.2} | {:.2}, {:.2} | {:.2}, {:.2} | {:.2} | {:.2} |",
                sun.1,
                ring.1,
                size(sun.0[0]),
                size(sun.0[1]),
                size(ring.0[0]),
                size(ring.0[1]),
                size(sum),
                1e6 * radius * still[k][0][2]
            );
        }
    }
    Ok(())
}
