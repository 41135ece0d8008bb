//! Fig. 12: static deflection of the sun against torque, four planets.

use fe_contact::statics::{Bodies, Imperfections};
use gearset::{PlaneState, Scene, ThicknessInput};

use super::Lab;
use crate::Profile;
use crate::check::{Check, ReferenceKind, Subject, Tolerance};
use crate::error::ValidationError;

/// N·m: 1000 to 12000 lb-in.
const FIRST: f64 = 113.0;
const LAST: f64 = 1356.0;

/// RMS of sun rotation and translation over those at 113 N·m, for each torque.
pub fn normalised_rms(
    lab: &Lab<'_>,
    scene: &Scene,
    bodies: &Bodies,
    torques: &[f64],
    positions: usize,
) -> Result<Vec<(f64, f64)>, ValidationError> {
    let mut list = Vec::new();
    for torque in torques {
        list.push(lab.set(scene, bodies, *torque, positions, Imperfections::default())?.sun_rms());
    }
    let (r, t) = list[0];
    Ok(list.iter().map(|(a, b)| (a / r, b / t)).collect())
}

fn with_fillet(mut scene: Scene, radius: f64) -> Scene {
    if let Some(g) = &mut scene.geometry {
        for gear in [g.sun.as_mut(), Some(&mut g.planet), g.ring.as_mut()].into_iter().flatten() {
            gear.fillet_radius = radius;
        }
    }
    scene
}

/// Over tooth thickness (and with it γ), backlash, fillet and plane state.
fn variants(base: &Scene) -> Vec<(String, Scene)> {
    let mut list = Vec::new();
    let thickness = |share: Option<f64>, backlash: Option<f64>| {
        let mut scene = base.clone();
        if let Some(ThicknessInput::Backlash { sun_planet, ring_planet, planet_share }) =
            scene.geometry.as_mut().map(|g| &mut g.thickness)
        {
            *planet_share = share.unwrap_or(*planet_share);
            *sun_planet = backlash.unwrap_or(*sun_planet);
            *ring_planet = backlash.unwrap_or(*ring_planet);
        }
        scene
    };
    for share in [0.40, 0.45, 0.55] {
        // The fillet that fits into every one of these roots.
        let scene = with_fillet(thickness(Some(share), None), 0.5e-3);
        list.push((format!("planet_share_{share:.2}"), scene));
    }
    for backlash in [0.02, 0.2, 0.4] {
        list.push((format!("backlash_{backlash}_mm"), thickness(None, Some(backlash * 1e-3))));
    }
    for fillet in [0.4, 0.6] {
        list.push((format!("fillet_{fillet}_mm"), with_fillet(base.clone(), fillet * 1e-3)));
    }
    let mut scene = base.clone();
    scene.fe_contact.plane = PlaneState::Stress;
    list.push(("plane_stress".into(), scene));
    list
}

pub(crate) fn checks(lab: &Lab<'_>) -> Result<Vec<Check>, ValidationError> {
    let mut checks = Vec::new();
    let source = format!("{}, Fig. 12 and section 4.2", lab.reference.parker.source);
    let torques: Vec<f64> = (1..=12).map(|i| FIRST * f64::from(i)).collect();
    let found = normalised_rms(lab, &lab.four, &lab.bodies, &torques, 140)?;
    fn about<'a>(id: &'a str, title: &'a str, source: &'a str) -> Subject<'a> {
        Subject { id, title, kind: ReferenceKind::Published, source, unit: "" }
    }
    let ahead = found[1..].iter().filter(|(r, t)| r > t).count() as f64;
    let title = "torques, of eleven above 113 N·m, at which the sun's rotation has grown more than its translation";
    checks.push(Check::equal(about("fe.fig12.rotation_ahead", title, &source), 11.0, ahead));
    let grows = |of: fn(&(f64, f64)) -> f64| {
        found.windows(2).filter(|w| of(&w[1]) > of(&w[0])).count() as f64
    };
    let title = "steps of torque, of eleven, over which rotation and translation grow";
    let both = vec![grows(|p| p.0), grows(|p| p.1)];
    checks.push(Check::equal(about("fe.fig12.monotonic", title, &source), vec![11.0, 11.0], both));
    // Grows more rapidly at every torque, not only on the whole.
    let faster = found.windows(2).filter(|w| w[1].0 - w[0].0 > w[1].1 - w[0].1).count() as f64;
    let title = "steps of torque, of eleven, over which rotation grows more than translation";
    checks.push(Check::equal(about("fe.fig12.rotation_faster", title, &source), 11.0, faster));
    for (name, scene) in variants(&lab.four) {
        let id = format!("fe.fig12.variant.{name}");
        let title =
            format!("{name}: torques, of three, at which rotation has grown more than translation");
        let subject = about(&id, &title, &source);
        if lab.profile == Profile::Quick {
            checks.push(Check::not_run(subject, 3.0, Tolerance::exact()));
            continue;
        }
        let bodies = Bodies::new(&scene)?;
        let torques = [FIRST, 452.0, 904.0, LAST];
        let found = normalised_rms(lab, &scene, &bodies, &torques, 42)?;
        let ahead = found[1..].iter().filter(|(r, t)| r > t).count() as f64;
        checks.push(Check::equal(subject, 3.0, ahead));
    }
    Ok(checks)
}
