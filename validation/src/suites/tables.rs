//! Tables 2 and 3: lumped frequencies as published, and with the geometry of Table 1.

use experiments::models::Changed;
use experiments::{ModalModel, ModelError, NaturalMode, distinct, frequencies_of};
use gearset::{Axis, Body};
use lumped::{LumpedModel, ModeGroup, NaturalModes, SpringId};
use scene::{LoadCase, PlanetOverride, Scene};

use crate::check::Check;
use crate::error::ValidationError;
use crate::published_table::Table;
use crate::reference::Reference;

use super::Checks;
use super::lab::of_model;
use super::mode_lists::by_type;
use crate::mode_type::type_named;

/// Natural modes of a standing set.
pub(crate) fn modes_of(
    model: &dyn ModalModel,
    scene: &Scene,
) -> Result<Vec<NaturalMode>, ValidationError> {
    model.natural_modes(scene, &LoadCase::standing(0.0)).map_err(of_model)
}

/// Frequencies and types of a set as published against the lumped column of its table.
pub(crate) fn lumped(model: &dyn ModalModel, scenes: &[Scene], reference: &Reference) -> Checks {
    let mut checks = Vec::new();
    for scene in scenes {
        let table = Table::of_planets(scene.planets.count());
        let modes = modes_of(model, scene)?;
        checks.extend(rows(reference, table, &modes)?);
        checks.push(types(reference, table, &modes)?);
    }
    Ok(checks)
}

/// Controls of [`lumped`]: wrong sets, which the same checks must notice.
pub(crate) fn lumped_controls(
    model: &dyn ModalModel,
    scenes: &[Scene],
    reference: &Reference,
) -> Checks {
    let mut checks = Vec::new();
    for set in scenes {
        let own = std::slice::from_ref(set);
        let name =
            format!("table{}.lumped.control", Table::of_planets(set.planets.count()).number());
        let mut control = |what: &str, change: &dyn Fn(&mut Scene)| {
            let judged = lumped(&Changed::new(model, change), own, reference)?;
            checks.push(reference.control(&format!("{name}.{what}"), &judged)?);
            Ok::<(), ValidationError>(())
        };
        control("sun_bearing_softened", &|s| s.supports.sun.bearing_n_per_m *= 0.8)?;
        control("planet_heavier", &planet_1_heavier)?;
        if set.planets.count() == 4 {
            control("planet_bearing_softened", &|s| {
                let bearing = Some(0.8 * s.supports.planet_bearing_n_per_m);
                s.overrides.push(PlanetOverride {
                    planet: 1,
                    bearing_n_per_m: bearing,
                    ..Default::default()
                });
            })?;
        }
    }
    Ok(checks)
}

/// The lumped model with a wrong sign in one mesh.
struct SignFlipped;

impl ModalModel for SignFlipped {
    fn natural_modes(&self, scene: &Scene, _: &LoadCase) -> Result<Vec<NaturalMode>, ModelError> {
        let mut model = LumpedModel::from_scene(scene)?;
        let rotation = model.coordinates.of(Body::Planet(1), Axis::Rotation);
        for spring in model.springs.iter_mut().filter(|s| s.id == SpringId::SunMesh(1)) {
            for (index, coefficient) in spring.rows.iter_mut().flatten() {
                if Some(*index) == rotation {
                    *coefficient = -*coefficient;
                }
            }
        }
        let modes = NaturalModes::of(&model)?;
        let of = |g: &ModeGroup| {
            let (frequency_hz, mode_type) = (g.frequency_hz, g.mode_type);
            std::iter::repeat_n(NaturalMode { frequency_hz, mode_type }, g.multiplicity)
        };
        Ok(modes.groups.iter().flat_map(of).collect())
    }
}

/// Control of [`lumped`]: the sign of planet 1's rotation in its sun mesh flipped.
pub(crate) fn sign_control(scenes: &[Scene], reference: &Reference) -> Checks {
    let judged = lumped(&SignFlipped, scenes, reference)?;
    Ok(vec![reference.control("table3.lumped.control.mesh_sign_flipped", &judged)?])
}

/// Planet 1 heavier by 10 %.
pub(crate) fn planet_1_heavier(scene: &mut Scene) {
    let mass = scene.lumped.as_ref().and_then(|l| l.mass_kg.planet).map(|m| 1.1 * m);
    scene.overrides.push(PlanetOverride { planet: 1, mass_kg: mass, ..Default::default() });
}

/// One check a printed row: the k-th frequency of the row's type.
pub(crate) fn rows(reference: &Reference, table: Table, modes: &[NaturalMode]) -> Checks {
    let printed = table.printed(reference);
    let mut seen: Vec<&str> = Vec::new();
    let mut checks = Vec::new();
    for (row, (name, &hz)) in printed.lumped_rows().enumerate() {
        let earlier = seen.iter().filter(|s| **s == name).count();
        seen.push(name);
        let actual = frequencies_of(modes, type_named(name)).get(earlier).copied();
        let id = format!("table{}.lumped.{}", table.number(), row + 1);
        let title = format!("Table {}, lumped model: {name} mode {}", table.number(), earlier + 1);
        let about = reference.about(&id, &title)?.source(&reference.parker.source);
        checks.push(about.number(hz, actual.unwrap_or(f64::NAN)));
    }
    Ok(checks)
}

/// Types of the lowest modes, in order of frequency, as many as the table has rows.
pub(crate) fn types(
    reference: &Reference,
    table: Table,
    modes: &[NaturalMode],
) -> Result<Check, ValidationError> {
    let printed = table.printed(reference);
    let mut expected: Vec<(f64, &str)> =
        printed.lumped_rows().map(|(name, hz)| (*hz, name)).collect();
    expected.sort_by(|a, b| a.0.total_cmp(&b.0));
    let expected: Vec<&str> = expected.into_iter().map(|(_, name)| name).collect();
    let list = distinct(modes);
    let actual: Vec<&str> = list.iter().take(expected.len()).map(|d| d.mode_type.name()).collect();
    let id = format!("table{}.lumped.types", table.number());
    let title = format!("Table {}, lumped model: types by frequency", table.number());
    let about = reference.about(&id, &title)?.source(&reference.parker.source);
    Ok(about.equal(expected, actual))
}

/// The same model with the operating angles of Table 1 and spacing that can be assembled, against an
/// independent assembly.
pub(crate) fn geometry_consistent(
    model: &dyn ModalModel,
    scenes: &[Scene],
    reference: &Reference,
) -> Checks {
    let mut checks = Vec::new();
    for set in scenes {
        let table = Table::of_planets(set.planets.count());
        let recomputed = &reference.parker.recomputed;
        let expected = match table {
            Table::Two => &recomputed.three_planets,
            Table::Three => &recomputed.four_planets,
        };
        let modes = modes_of(model, set)?;
        for (mode_type, list) in by_type(expected) {
            let found = frequencies_of(&modes, mode_type);
            for (i, &hz) in list.iter().enumerate() {
                let name = mode_type.name();
                let id = format!("table{}.geometry_consistent.{name}.{}", table.number(), i + 1);
                let title =
                    format!("{} planets, Table 1 geometry: {name} {}", set.planets.count(), i + 1);
                let source =
                    "an independent assembly of the same equations (reference/parker_2000.toml)";
                let actual = found.get(i).copied().unwrap_or(f64::NAN);
                checks.push(reference.about(&id, &title)?.source(source).number(hz, actual));
            }
        }
    }
    Ok(checks)
}

/// Its control: the printed angles put back.
pub(crate) fn geometry_controls(
    model: &dyn ModalModel,
    scenes: &[Scene],
    reference: &Reference,
) -> Checks {
    let printed = |scene: &mut Scene| {
        if let Some(lumped) = &mut scene.lumped {
            let angle = 24.6f64.to_radians();
            lumped.pressure_angle_rad.sun_planet = angle;
            lumped.pressure_angle_rad.ring_planet = angle;
        }
    };
    let control = |set: &Scene| {
        let own = std::slice::from_ref(set);
        let judged = geometry_consistent(&Changed::new(model, printed), own, reference)?;
        let number = Table::of_planets(set.planets.count()).number();
        let id = format!("table{number}.geometry_consistent.control.printed_angles");
        Ok(reference.control(&id, &judged)?)
    };
    scenes.iter().map(control).collect()
}
