//! Masses and inertias against the paper's lumped ones, and the tooth thickness at which they agree best.

use fe_contact::Elastic;
use fe_contact::body::CarrierBody;
use fe_contact::fe_mesh::{Elements, FeGearMesh};
use gearset::{Gear, ThicknessInput};
use scene::Scene;

use crate::catalogue::{PublishedScene, scene};
use crate::error::ValidationError;
use crate::suites::{Checks, Lab};

/// Elements along the flank for masses alone.
const FLANK_ELEMENTS: usize = 6;

/// Mass (kg) and polar inertia (kg m²) of sun and planet, beside the scene's lumped values.
fn gears(scene: &Scene) -> Result<[(f64, f64); 4], ValidationError> {
    let missing = || ValidationError::Incomplete("sun, or lumped mass or inertia of it");
    let geometry = scene.tooth_geometry().ok().ok_or_else(missing)?;
    let material = Elastic::new(&scene.material, scene.fe_contact.plane);
    let lumped = scene.lumped.as_ref().ok_or_else(missing)?;
    let of = |name, gear: &Gear| -> Result<(f64, f64), ValidationError> {
        let mesh = FeGearMesh::new(name, gear, Elements::of(&scene.fe_contact, FLANK_ELEMENTS))?;
        Ok(mesh.mass_properties(&material, geometry.face_width)?)
    };
    let sun_gear = geometry.sun.as_ref().ok_or_else(missing)?;
    let (sun, planet) = (of("sun", sun_gear)?, of("planet", &geometry.planet)?);
    let inertia = |over_r2: Option<f64>, gear: &Gear| Some(over_r2? * gear.base_radius.powi(2));
    let known = |x: Option<f64>| x.ok_or_else(missing);
    Ok([
        (known(lumped.mass_kg.sun)?, sun.0),
        (known(inertia(lumped.inertia_over_r2_kg.sun, sun_gear))?, sun.1),
        (known(lumped.mass_kg.planet)?, planet.0),
        (known(inertia(lumped.inertia_over_r2_kg.planet, &geometry.planet))?, planet.1),
    ])
}

/// Root mean square of the four relative differences.
fn misfit(scene: &Scene, share: f64) -> Result<f64, ValidationError> {
    let mut scene = scene.clone();
    if let Some(ThicknessInput::Backlash { planet_share, .. }) =
        scene.geometry.as_mut().map(|g| &mut g.thickness)
    {
        *planet_share = share;
    }
    let list = gears(&scene)?;
    Ok((list.iter().map(|(paper, ours)| (ours / paper - 1.0).powi(2)).sum::<f64>() / 4.0).sqrt())
}

/// The planet's share of tooth thickness with the smallest misfit, by golden section.
fn best_share(scene: &Scene) -> Result<f64, ValidationError> {
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let (mut low, mut high) = (0.3, 0.6);
    let at = |a: f64, b: f64| (b - golden * (b - a), a + golden * (b - a));
    let (mut p, mut q) = at(low, high);
    let (mut f, mut g) = (misfit(scene, p)?, misfit(scene, q)?);
    while high - low > 1e-4 {
        if f < g {
            (high, q, g) = (q, p, f);
            p = at(low, high).0;
            f = misfit(scene, p)?;
        } else {
            (low, p, f) = (p, q, g);
            q = at(low, high).1;
            g = misfit(scene, q)?;
        }
    }
    Ok(0.5 * (low + high))
}

pub(crate) fn checks(lab: &Lab<'_>) -> Checks {
    let mut checks = masses(lab, &lab.four)?;
    let mut light = lab.four.clone();
    light.material.density_kg_per_m3 = 7000.0;
    let spoilt = masses(lab, &light)?;
    checks.push(lab.reference.control("fe.bodies.control.density", &spoilt)?);
    let best = best_share(&lab.four)?;
    let second = scene(PublishedScene::Oh58BestThickness)?;
    let kept = match second.geometry.as_ref().map(|g| g.thickness) {
        Some(ThicknessInput::Backlash { planet_share, .. }) => planet_share,
        _ => return Err(ValidationError::Incomplete("planet_share")),
    };
    let title = "planet's share of tooth thickness for which masses and inertias agree best, as in scenes/oh58_4p_best_thickness.toml";
    let about = lab.about("fe.bodies.best_share", title)?;
    checks.push(about.source("scenes/oh58_4p_best_thickness.toml").number(kept, best));
    let title = "root mean square of the four differences at that share";
    let about = lab.about("fe.bodies.best_misfit", title)?.source(&lab.reference.parker.source);
    checks.push(about.at_most(100.0 * misfit(&lab.four, best)?));
    Ok(checks)
}

/// Masses and inertias of a scene's bodies against its printed lumped ones.
fn masses(lab: &Lab<'_>, scene: &Scene) -> Checks {
    let mut checks = Vec::new();
    let source = &lab.reference.parker.source;
    let names = [("sun", "mass"), ("sun", "inertia"), ("planet", "mass"), ("planet", "inertia")];
    for ((body, what), (paper, ours)) in names.into_iter().zip(gears(scene)?) {
        let id = format!("fe.bodies.{what}.{body}");
        let title = format!("{what} of the {body}'s mesh against the printed lumped one");
        checks.push(lab.about(&id, &title)?.source(source).number(paper, ours));
    }
    let geometry = scene.geometry.as_ref().and_then(|g| g.carrier);
    let carrier = geometry.ok_or(ValidationError::Incomplete("carrier"))?;
    let (a, width) = (lab.bodies.geometry.center_distance, lab.bodies.geometry.face_width);
    let material = Elastic::new(&scene.material, scene.fe_contact.plane);
    let body = CarrierBody::new(&carrier, a, &scene.planets.psi_rad, &material, width)?;
    let lumped = scene.lumped.as_ref().ok_or(ValidationError::Incomplete("lumped"))?;
    let printed = lumped.mass_kg.carrier.zip(lumped.inertia_over_r2_kg.carrier.map(|i| i * a * a));
    let (mass, inertia) = printed.ok_or(ValidationError::Incomplete("carrier's mass"))?;
    let title = "mass of the carrier's annulus against the printed lumped one";
    let about = lab.about("fe.bodies.mass.carrier", title)?.source(source);
    checks.push(about.number(mass, body.mass));
    let title = "polar inertia of the carrier's annulus against the printed lumped one";
    let about = lab.about("fe.bodies.inertia.carrier", title)?.source(source);
    checks.push(about.number(inertia, body.inertia));
    Ok(checks)
}
