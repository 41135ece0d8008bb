//! One mesh alone over its mesh cycle.

use fe_contact::statics::{PairAtPhase, PairCycle};

use super::Figure;
use super::drawing::{Picture, Series, chart, curve};

/// Points of the ellipse that is fitted to the pressure.
const POINTS: u32 = 200;

/// Stiffness, transmission error and load sharing over the cycle, and the pressure where one pair carries
/// most: `mesh_stiffness`, `transmission_error`, `load_sharing`, `pressure`.
///
/// `title` names the scene.
pub fn of_pair_cycle(title: &str, cycle: &PairCycle) -> Vec<Figure> {
    let about = format!("{title}, {} mesh, {:.0} N", cycle.kind.name(), cycle.force);
    let over = |f: &dyn Fn(&PairAtPhase) -> f64| -> Vec<(f64, f64)> {
        cycle.positions.iter().map(|p| (p.phase, f(p))).collect()
    };
    let secant = over(&|p| cycle.secant_stiffness(p) * 1e-6);
    let tangent = over(&|p| p.step_tangent * 1e-6);
    let error = over(&|p| p.deflection * 1e6);
    let shares = cycle.load_of_one_pair().into_iter().map(|(place, force)| (place, force * 1e-3));
    let picture = |title, axes, series| chart([title, &about], axes, series);
    let stiffness = picture(
        "Mesh stiffness over the mesh cycle",
        ["phase, mesh cycles", "stiffness, 1e6 N/m"],
        vec![
            Series::new("secant F/δ", curve(0), secant),
            Series::new("tangent ΔF/Δδ", curve(1).dashed(), tangent),
        ],
    );
    let error = picture(
        "Transmission error",
        ["phase, mesh cycles", "δ, µm"],
        vec![Series::new("", curve(0), error)],
    );
    let sharing = picture(
        "Load of one tooth pair on its way",
        ["base pitches from the start of the path of contact", "force, kN"],
        vec![Series::new("", curve(0), shares)],
    );
    let mut figures = vec![
        Figure::new("mesh_stiffness", stiffness),
        Figure::new("transmission_error", error),
        Figure::new("load_sharing", sharing),
    ];
    let pressure = cycle.heaviest_pair().and_then(|(p, k)| pressure(p, k, &about));
    figures.extend(pressure.map(|picture| Figure::new("pressure", picture)));
    figures
}

/// Pressure of pair k of a position's table with its fitted ellipse; `about` names scene, mesh and load.
fn pressure(p: &PairAtPhase, k: usize, about: &str) -> Option<Picture> {
    let profile = p.pressure_profile(k)?;
    let cells = profile.places.iter().zip(&profile.pressures).map(|(x, p)| (x * 1e3, p * 1e-6));
    let mut series = vec![Series::new("cells", curve(0), cells)];
    if let Some(fit) = profile.ellipse {
        let share = (0..=POINTS).map(|i| 2.0 * f64::from(i) / f64::from(POINTS) - 1.0);
        let places = share.map(|share| share * profile.half_length);
        let ellipse = places.map(|x| (x * 1e3, fit.pressure(x) * 1e-6));
        series.push(Series::new("ellipse fitted to p²", curve(1).dashed(), ellipse));
    }
    let caption = format!("{about}; pair {} at phase {:.3}", profile.index, p.phase);
    let axes = ["along the flank, mm", "pressure, MPa"];
    Some(chart(["Contact pressure", &caption], axes, series))
}
