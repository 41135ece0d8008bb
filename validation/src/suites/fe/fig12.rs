//! Fig. 12: static deflection of the sun against torque, four planets.

use experiments::{StaticModel, SunRms};
use gearset::ThicknessInput;
use scene::{LoadCase, PlaneState, Scene};

use crate::error::ValidationError;
use crate::reference::Reference;
use crate::suites::lab::of_model;
use crate::suites::{AskedCycle, Checks, Lab};

/// First torque, N·m (1000 lb-in), and number of its multiples.
const FIRST: f64 = 113.0;
const TORQUES: u32 = 12;

/// Positions of the mesh cycle: of the default set, and of its variants.
const POSITIONS: usize = 140;
const POSITIONS_OF_VARIANTS: usize = 42;

/// Root mean squares of the sun's rotation and translation over those at the first torque.
fn normalised_rms(
    model: &dyn StaticModel,
    scene: &Scene,
    torques: &[f64],
    positions: usize,
) -> Result<Vec<(f64, f64)>, ValidationError> {
    let mut list: Vec<SunRms> = Vec::new();
    for torque in torques {
        let case = LoadCase::standing(*torque);
        list.push(model.mesh_cycle(scene, &case, positions).map_err(of_model)?.sun_rms());
    }
    let first = list.first().copied().ok_or(ValidationError::Incomplete("torque"))?;
    let over = |rms: &SunRms| {
        (rms.rotation_rad / first.rotation_rad, rms.translation_m / first.translation_m)
    };
    Ok(list.iter().map(over).collect())
}

fn torques() -> Vec<f64> {
    (1..=TORQUES).map(|i| FIRST * f64::from(i)).collect()
}

/// Mesh cycles that are asked of a scene.
pub(crate) fn cycles(scene: &Scene) -> Vec<AskedCycle> {
    let cycle =
        |sun_torque_nm| AskedCycle { set: scene.clone(), sun_torque_nm, positions: POSITIONS };
    torques().into_iter().map(cycle).collect()
}

/// The paper's statements on the figure, judged on the mesh cycles of any model.
pub(crate) fn asked(model: &dyn StaticModel, scenes: &[Scene], reference: &Reference) -> Checks {
    let mut checks = Vec::new();
    for scene in scenes {
        let found = normalised_rms(model, scene, &torques(), POSITIONS)?;
        checks.extend(judged(reference, &found)?);
    }
    Ok(checks)
}

/// Statements about growth with torque: rotation and translation, over those at the first torque.
fn judged(reference: &Reference, found: &[(f64, f64)]) -> Checks {
    let source = format!("{}, Fig. 12 and section 4.2", reference.parker.source);
    let others = f64::from(TORQUES - 1);
    let mut checks = Vec::new();
    let title = "torques, of eleven above 113 N·m, at which the sun's rotation has grown more than its translation";
    let about = reference.about("fe.fig12.rotation_ahead", title)?.source(&source);
    checks.push(about.equal(others, ahead(found)));
    let grows = |of: fn(&(f64, f64)) -> f64| {
        found.windows(2).filter(|w| of(&w[1]) > of(&w[0])).count() as f64
    };
    let title = "steps of torque, of eleven, over which rotation and translation grow";
    let both = vec![grows(|p| p.0), grows(|p| p.1)];
    let about = reference.about("fe.fig12.monotonic", title)?.source(&source);
    checks.push(about.equal(vec![others, others], both));
    // "More rapidly" is judged for every step of torque, not only over the whole range.
    let faster = found.windows(2).filter(|w| w[1].0 - w[0].0 > w[1].1 - w[0].1).count() as f64;
    let title = "steps of torque, of eleven, over which rotation grows more than translation";
    let about = reference.about("fe.fig12.rotation_faster", title)?.source(&source);
    checks.push(about.equal(others, faster));
    Ok(checks)
}

/// Torques above the first at which rotation has grown more than translation.
fn ahead(found: &[(f64, f64)]) -> f64 {
    found.iter().skip(1).filter(|(r, t)| r > t).count() as f64
}

pub(crate) fn checks(lab: &Lab<'_>) -> Checks {
    let found = normalised_rms(&lab.fe, &lab.four, &torques(), POSITIONS)?;
    let mut checks = judged(lab.reference, &found)?;
    let falling: Vec<(f64, f64)> = found.iter().rev().copied().collect();
    let spoilt = judged(lab.reference, &falling)?;
    checks.push(lab.reference.control("fe.fig12.control.reversed", &spoilt)?);
    let source = format!("{}, Fig. 12 and section 4.2", lab.reference.parker.source);
    for (name, scene) in variants(&lab.four) {
        let id = format!("fe.fig12.variant.{name}");
        let title = format!(
            "{name}: torques, of eleven above 113 N·m, at which the sun's rotation has grown more than its translation"
        );
        let found = if lab.runs(&id)? {
            Some(ahead(&normalised_rms(&lab.fe, &scene, &torques(), POSITIONS_OF_VARIANTS)?))
        } else {
            None
        };
        lab.gears.drop_unused();
        let about = lab.about(&id, &title)?.source(&source);
        checks.push(about.equal_if_run(f64::from(TORQUES - 1), found));
    }
    Ok(checks)
}

fn with_fillet(mut scene: Scene, radius: f64) -> Scene {
    if let Some(g) = &mut scene.geometry {
        for gear in [g.sun.as_mut(), Some(&mut g.planet), g.ring.as_mut()].into_iter().flatten() {
            gear.fillet_radius_m = radius;
        }
    }
    scene
}

/// Over tooth thickness (and with it γ), backlash, fillet and plane state.
fn variants(base: &Scene) -> Vec<(String, Scene)> {
    let mut list = Vec::new();
    let thickness = |share: Option<f64>, backlash: Option<f64>| {
        let mut scene = base.clone();
        if let Some(ThicknessInput::Backlash {
            sun_planet_m: sun_planet,
            ring_planet_m: ring_planet,
            planet_share,
        }) = scene.geometry.as_mut().map(|g| &mut g.thickness)
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
