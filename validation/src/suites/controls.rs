//! Negative controls: a model made wrong on purpose must break a named check.

use gearset::{PlanetOverride, Scene};
use lumped::{Body, LumpedModel, NaturalModes, SpringId};

use crate::catalogue::scene;
use crate::check::{Check, ReferenceKind, Status, Subject};
use crate::error::ValidationError;
use crate::reference::Reference;

use super::tables::{Table, rows, types};

pub(crate) fn checks(reference: &Reference) -> Result<Vec<Check>, ValidationError> {
    let set = scene(Table::Three.as_published())?;
    let softened = with_override(&set, |o| o.bearing = Some(0.8 * 87.6e6));
    let heavier = with_override(&set, |o| o.mass = Some(1.1 * 0.66));
    let model = |scene: &Scene| LumpedModel::from_scene(scene);
    let mut soft_sun = model(&set)?;
    for spring in &mut soft_sun.springs {
        if spring.id == SpringId::CentralBearing(Body::Sun) {
            spring.stiffness *= 0.8;
        }
    }
    let mut flipped = model(&set)?;
    flip_one_mesh_sign(&mut flipped);
    [
        (
            "planet_bearing_softened",
            "bearing of planet 1 softened by 20 %",
            model(&softened)?,
            "table3.lumped.types",
        ),
        ("planet_heavier", "planet 1 heavier by 10 %", model(&heavier)?, "table3.lumped.types"),
        ("sun_bearing_softened", "sun bearing softened by 20 %", soft_sun, "table3.lumped.1"),
        (
            "mesh_sign_flipped",
            "sign of planet 1's rotation in its sun mesh flipped",
            flipped,
            "table3.lumped.types",
        ),
    ]
    .into_iter()
    .map(|(name, what, model, breaks)| control(reference, name, what, &model, breaks))
    .collect()
}

fn with_override(set: &Scene, change: impl Fn(&mut PlanetOverride)) -> Scene {
    let mut changed = set.clone();
    let mut one = PlanetOverride { planet: 1, ..PlanetOverride::default() };
    change(&mut one);
    changed.overrides.push(one);
    changed
}

fn flip_one_mesh_sign(model: &mut LumpedModel) {
    let rotation = model.coordinates.of(Body::Planet(1), lumped::Axis::Rotation);
    for spring in model.springs.iter_mut().filter(|s| s.id == SpringId::SunMesh(1)) {
        for (index, coefficient) in spring.rows.iter_mut().flatten() {
            if Some(*index) == rotation {
                *coefficient = -*coefficient;
            }
        }
    }
}

/// Passes if the check named `breaks` fails on the wrong model.
fn control(
    reference: &Reference,
    name: &str,
    what: &str,
    model: &LumpedModel,
    breaks: &str,
) -> Result<Check, ValidationError> {
    let modes = NaturalModes::of(model)?;
    let mut on_wrong_model = rows(reference, Table::Three, &modes)?;
    on_wrong_model.push(types(reference, Table::Three, &modes));
    let found = on_wrong_model.iter().find(|c| c.id == breaks).map(|c| c.status);
    let id = format!("control.{name}");
    let title = format!("{what}: breaks {breaks}");
    let subject = Subject {
        id: &id,
        title: &title,
        kind: ReferenceKind::Analytic,
        source: "a check that cannot fail is a defect",
        unit: "",
    };
    let word = match found {
        Some(Status::Fail) => "fails",
        Some(_) => "passes",
        None => "no such check",
    };
    Ok(Check::equal(subject, "fails", word))
}
