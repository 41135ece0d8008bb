//! Pressure along the flank of one tooth pair.

use fe_contact::statics::PairAtPhase;

use super::drawing::{Curve, Labels, Picture, chart};

/// Points of the ellipse.
const POINTS: u32 = 200;

/// Pressure of pair k of a position's table with its fitted ellipse; `about` names scene, mesh and load.
pub(super) fn picture(p: &PairAtPhase, k: usize, about: &str) -> Option<Picture> {
    let profile = p.pressure_profile(k)?;
    let points = profile.places.iter().zip(&profile.pressures);
    let mut curves = vec![Curve::new("cells", points.map(|(x, p)| (x * 1e3, p * 1e-6)).collect())];
    if let Some(fit) = profile.ellipse {
        let reach = profile.half_length;
        let ellipse = (0..=POINTS)
            .map(|i| -reach + 2.0 * reach * f64::from(i) / f64::from(POINTS))
            .map(|x| (x * 1e3, fit.pressure(x) * 1e-6))
            .collect();
        curves.push(Curve::new("ellipse fitted to p²", ellipse).dashed());
    }
    let labels = Labels {
        title: "Contact pressure",
        subtitle: format!("{about}; pair {} at phase {:.3}", profile.index, p.phase),
        x: "along the flank, mm",
        y: "pressure, MPa",
    };
    Some(chart(&labels, &curves))
}
