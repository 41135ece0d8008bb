//! One mesh alone over its mesh cycle.

use fe_contact::statics::{PairAtPhase, PairCycle};

use super::drawing::{Curve, Labels, chart};
use super::{Figure, pressure};

/// Stiffness, transmission error and load sharing over the cycle, and the pressure where one pair carries
/// most: `mesh_stiffness`, `transmission_error`, `load_sharing`, `pressure`.
///
/// `title` names the scene.
pub fn of_pair_cycle(title: &str, cycle: &PairCycle) -> Vec<Figure> {
    let about = format!("{title}, {} mesh, {:.0} N", cycle.kind.name(), cycle.force);
    let over = |f: &dyn Fn(&PairAtPhase) -> f64| -> Vec<(f64, f64)> {
        cycle.positions.iter().map(|p| (p.phase, f(p))).collect()
    };
    let stiffness = chart(
        &Labels {
            title: "Mesh stiffness over the mesh cycle",
            subtitle: about.clone(),
            x: "phase, mesh cycles",
            y: "stiffness, 1e6 N/m",
        },
        &[
            Curve::new("secant F/δ", over(&|p| cycle.secant_stiffness(p) * 1e-6)),
            Curve::new("tangent ΔF/Δδ", over(&|p| p.step_tangent * 1e-6)).dashed(),
        ],
    );
    let error = chart(
        &Labels {
            title: "Transmission error",
            subtitle: about.clone(),
            x: "phase, mesh cycles",
            y: "δ, µm",
        },
        &[Curve::new("", over(&|p| p.deflection * 1e6))],
    );
    let shares = cycle.load_of_one_pair().into_iter().map(|(place, force)| (place, force * 1e-3));
    let sharing = chart(
        &Labels {
            title: "Load of one tooth pair on its way",
            subtitle: about.clone(),
            x: "base pitches from the start of the path of contact",
            y: "force, kN",
        },
        &[Curve::new("", shares.collect())],
    );
    let mut figures = vec![
        Figure::new("mesh_stiffness", stiffness),
        Figure::new("transmission_error", error),
        Figure::new("load_sharing", sharing),
    ];
    let pressure = cycle.heaviest_pair().and_then(|(p, k)| pressure::picture(p, k, &about));
    figures.extend(pressure.map(|picture| Figure::new("pressure", picture)));
    figures
}
