//! A whole set over its mesh cycle.

use fe_contact::statics::{SetCycle, SetState};
use gearset::MeshKind;

use super::Figure;
use super::drawing::{Pen, Series, chart, colour, curve};

/// Figures of the last cycle: `transmission_error`, `load_sharing` and `mesh_stiffness`; of several cycles
/// under different torques also `rms_against_torque`.
///
/// `title` names the scene; `sun_base_radius` in m.
pub fn of_set_cycles(title: &str, cycles: &[SetCycle], sun_base_radius: f64) -> Vec<Figure> {
    let Some(cycle) = cycles.last() else { return Vec::new() };
    let about = format!("{title}, {} N·m on the sun", cycle.torque_nm);
    let figure = |name: &str, title, y, series| {
        Figure::new(name, chart([title, &about], ["mesh cycle", y], series))
    };
    let error = over(cycle, |s| s.transmission_error(sun_base_radius) * 1e6);
    let mut figures = vec![
        figure(
            "transmission_error",
            "Transmission error of the set",
            "r_b θ of the sun, µm",
            vec![Series::new("", curve(0), error)],
        ),
        figure(
            "load_sharing",
            "Load sharing between the planets",
            "mesh force, kN",
            load_sharing(cycle),
        ),
        figure(
            "mesh_stiffness",
            "Tangent mesh stiffness, planet 0",
            "∂F/∂δ, 1e6 N/m",
            mesh_stiffness(cycle),
        ),
    ];
    let (rotation, translation) = cycles[0].sun_rms();
    if cycles.len() > 1 && rotation > 0.0 && translation > 0.0 {
        let over = |of: &dyn Fn((f64, f64)) -> f64| -> Vec<(f64, f64)> {
            cycles.iter().map(|c| (c.torque_nm.abs(), of(c.sun_rms()))).collect()
        };
        let caption = format!("{title}, RMS about the mean, over that at the first torque");
        let head = ["Static deflection of the sun against torque", &caption];
        let series = vec![
            Series::new("rotation", curve(0), over(&|rms| rms.0 / rotation)),
            Series::new("translation", curve(1).dashed(), over(&|rms| rms.1 / translation)),
        ];
        let picture = chart(head, ["sun torque, N·m", "normalised RMS"], series);
        figures.push(Figure::new("rms_against_torque", picture));
    }
    figures
}

fn over(cycle: &SetCycle, of: impl Fn(&SetState) -> f64) -> Vec<(f64, f64)> {
    cycle.states.iter().map(|s| (s.position, of(s))).collect()
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

fn load_sharing(cycle: &SetCycle) -> Vec<Series> {
    let meshes = &cycle.states[0].meshes;
    let series = meshes.iter().enumerate().map(|(i, m)| {
        let pen = Pen::new(colour(i), width(i, meshes.len()));
        let pen = if m.kind == MeshKind::RingPlanet { pen.dashed() } else { pen };
        let forces = over(cycle, |s| s.meshes[i].force * 1e-3);
        Series::new(format!("{} {}", m.kind.name(), m.planet), pen, forces)
    });
    series.collect()
}

fn mesh_stiffness(cycle: &SetCycle) -> Vec<Series> {
    let meshes = cycle.states[0].meshes.iter().enumerate().filter(|(_, m)| m.planet == 0);
    let series = meshes.enumerate().map(|(k, (i, m))| {
        Series::new(m.kind.name(), curve(k), over(cycle, |s| s.meshes[i].tangent * 1e-6))
    });
    series.collect()
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
