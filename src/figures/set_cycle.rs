//! A whole set over its mesh cycle.

use fe_contact::statics::{SetCycle, SetState};
use gearset::MeshKind;

use super::Figure;
use super::drawing::{Curve, Labels, Picture, chart};

/// Figures of the last cycle: `transmission_error`, `load_sharing` and `mesh_stiffness`; of several cycles
/// under different torques also `rms_against_torque`.
///
/// `title` names the scene; `sun_base_radius` in m.
pub fn of_set_cycles(title: &str, cycles: &[SetCycle], sun_base_radius: f64) -> Vec<Figure> {
    let Some(cycle) = cycles.last() else { return Vec::new() };
    let about = format!("{title}, {} N·m on the sun", cycle.torque_nm);
    let mut figures = vec![
        Figure::new("transmission_error", transmission_error(cycle, sun_base_radius, &about)),
        Figure::new("load_sharing", load_sharing(cycle, &about)),
        Figure::new("mesh_stiffness", mesh_stiffness(cycle, &about)),
    ];
    let (rotation, translation) = cycles[0].sun_rms();
    if cycles.len() > 1 && rotation > 0.0 && translation > 0.0 {
        figures.push(Figure::new("rms_against_torque", rms_against_torque(title, cycles)));
    }
    figures
}

fn over(cycle: &SetCycle, of: impl Fn(&SetState) -> f64) -> Vec<(f64, f64)> {
    cycle.states.iter().map(|s| (s.position, of(s))).collect()
}

fn transmission_error(cycle: &SetCycle, radius: f64, about: &str) -> Picture {
    let labels = Labels {
        title: "Transmission error of the set",
        subtitle: about.into(),
        x: "mesh cycle",
        y: "r_b θ of the sun, µm",
    };
    chart(&labels, &[Curve::new("", over(cycle, |s| s.transmission_error(radius) * 1e6))])
}

/// Width of curve i of so many, px. Planets in phase carry the same force: a curve that lies below others is wider and
/// shows at their sides, and curves on top stay thin enough for their dashes to be seen.
fn width(i: usize, count: usize) -> f64 {
    const THINNEST: f64 = 1.2;
    const STEP: f64 = 0.6;
    const WIDEST: f64 = 7.0;
    let below = count.saturating_sub(1);
    let step = STEP.min((WIDEST - THINNEST) / below.max(1) as f64);
    THINNEST + step * below.saturating_sub(i) as f64
}

fn load_sharing(cycle: &SetCycle, about: &str) -> Picture {
    let meshes = cycle.states[0].meshes.iter().enumerate();
    let count = cycle.states[0].meshes.len();
    let curves: Vec<Curve> = meshes
        .map(|(i, m)| {
            let forces = over(cycle, |s| s.meshes[i].force * 1e-3);
            let curve = Curve::new(format!("{} {}", m.kind.name(), m.planet), forces);
            let curve = curve.wide(width(i, count));
            if m.kind == MeshKind::RingPlanet { curve.dashed() } else { curve }
        })
        .collect();
    let labels = Labels {
        title: "Load sharing between the planets",
        subtitle: about.into(),
        x: "mesh cycle",
        y: "mesh force, kN",
    };
    chart(&labels, &curves)
}

fn mesh_stiffness(cycle: &SetCycle, about: &str) -> Picture {
    let meshes = cycle.states[0].meshes.iter().enumerate().filter(|(_, m)| m.planet == 0);
    let curves: Vec<Curve> = meshes
        .map(|(i, m)| Curve::new(m.kind.name(), over(cycle, |s| s.meshes[i].tangent * 1e-6)))
        .collect();
    let labels = Labels {
        title: "Tangent mesh stiffness, planet 0",
        subtitle: about.into(),
        x: "mesh cycle",
        y: "∂F/∂δ, 1e6 N/m",
    };
    chart(&labels, &curves)
}

fn rms_against_torque(title: &str, cycles: &[SetCycle]) -> Picture {
    let (r0, t0) = cycles[0].sun_rms();
    let over = |of: &dyn Fn(&SetCycle) -> f64| -> Vec<(f64, f64)> {
        cycles.iter().map(|c| (c.torque_nm.abs(), of(c))).collect()
    };
    let labels = Labels {
        title: "Static deflection of the sun against torque",
        subtitle: format!("{title}, RMS about the mean, over that at the first torque"),
        x: "sun torque, N·m",
        y: "normalised RMS",
    };
    let curves = [
        Curve::new("rotation", over(&|c| c.sun_rms().0 / r0)),
        Curve::new("translation", over(&|c| c.sun_rms().1 / t0)).dashed(),
    ];
    chart(&labels, &curves)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_curve_is_wider_than_the_next_and_none_is_a_band() {
        for count in [1, 2, 6, 8, 24] {
            let widths: Vec<f64> = (0..count).map(|i| width(i, count)).collect();
            assert!(widths.windows(2).all(|pair| pair[0] > pair[1] + 0.2), "{widths:?}");
            assert!(widths[0] <= 7.0 && widths[count - 1] == 1.2, "{widths:?}");
        }
    }
}
