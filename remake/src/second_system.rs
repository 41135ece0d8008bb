//! Finds the parameters of `scenes/oh58_4p_second_system.toml`: the one stiffness of all bearings and
//! the inertia fixed to each planet with which the lumped model's lowest translational and rotational
//! modes have the 622 and 782 Hz that section 4.2 of the paper prints.
//!
//! `cargo run --release -p remake -- second_system`

use experiments::modal::lumped_frequencies;
use lumped::ModeType;
use scene::Scene;
use validation::{PublishedScene, ValidationError, scene};

/// Lowest translational (mean of its pair) and rotational mode, Hz.
const PRINTED_HZ: [f64; 2] = [622.0, 782.0];

fn with(scene: &Scene, [bearing, inertia]: [f64; 2]) -> Scene {
    let mut changed = scene.clone();
    let supports = &mut changed.supports;
    supports.sun.bearing_n_per_m = bearing;
    supports.carrier.bearing_n_per_m = bearing;
    supports.planet_bearing_n_per_m = bearing;
    supports.planet_added.inertia_kg_m2 = inertia;
    changed
}

fn lowest(scene: &Scene) -> Result<[f64; 2], ValidationError> {
    let modes = lumped_frequencies(scene)?;
    let of = |kind, count: usize| {
        let list = modes.iter().filter(|m| m.mode_type == kind).take(count);
        list.map(|m| m.frequency_hz).sum::<f64>() / count as f64
    };
    Ok([of(ModeType::Translational, 2), of(ModeType::Rotational, 1)])
}

pub(crate) fn remake() -> crate::Outcome {
    let first = scene(PublishedScene::Oh58FourPlanets)?;
    let mut x = [50e6, 1e-3];
    println!("bearings 1e6 N/m   added inertia 1e-3 kg m²   translational, rotational Hz");
    for _ in 0..20 {
        let now = lowest(&with(&first, x))?;
        println!("{:.5}   {:.6}   {:.4} {:.4}", x[0] * 1e-6, x[1] * 1e3, now[0], now[1]);
        let miss = [PRINTED_HZ[0] - now[0], PRINTED_HZ[1] - now[1]];
        if miss.iter().all(|m| m.abs() < 1e-4) {
            break;
        }
        // Newton's method, derivatives by differences.
        let steps = [1e-4 * x[0], 1e-4 * x[1]];
        let a = lowest(&with(&first, [x[0] + steps[0], x[1]]))?;
        let b = lowest(&with(&first, [x[0], x[1] + steps[1]]))?;
        let j = |k: usize| [(a[k] - now[k]) / steps[0], (b[k] - now[k]) / steps[1]];
        let ([p, q], [r, s]) = (j(0), j(1));
        let determinant = p * s - q * r;
        x[0] += (s * miss[0] - q * miss[1]) / determinant;
        x[1] += (p * miss[1] - r * miss[0]) / determinant;
    }
    Ok(())
}
