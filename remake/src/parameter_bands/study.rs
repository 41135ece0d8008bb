//! Effects of both ends of every interval, one parameter at a time.

use experiments::NaturalMode;
use experiments::modal::{Preload, linear_modes, lumped_frequencies, lumped_from_fe, preloaded};
use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, pair_cycle};
use gearset::MeshKind;
use scene::{PlaneState, Scene};
use validation::effects::{TabledFrequency, tabled};
use validation::parameter_bands::{BandRow, Interval, ParameterBands, ParameterEffect, band_of};
use validation::{Reference, Table, ValidationError, iso6336_mean_stiffness, scene};

use super::intervals::{
    POSITIONS, TORQUES, Wheel, intervals, with_backlash, with_fillet, with_fitting_fillets,
    with_share,
};

/// Torque of the tables, N m.
const TORQUE: f64 = 1130.0;

/// Positions over which mesh stiffness is averaged.
const STIFFNESS_POSITIONS: usize = 56;

/// A value of one variant.
struct Value {
    id: String,
    what: String,
    unit: &'static str,
    ours: f64,
    printed: f64,
    half_digit: f64,
}

/// All values of one variant, in the same order for every variant.
type Values = Vec<Value>;

fn preload(torque_nm: f64, position: f64) -> Preload {
    Preload { load: scene::LoadCase::standing(torque_nm), position, step_s: 5e-6 }
}

/// Tabled frequencies by linearised FE/contact and by the lumped model with parameters from it.
fn frequencies(
    reference: &Reference,
    change: &dyn Fn(&Scene) -> Result<Scene, ValidationError>,
    bodies: &Bodies,
    preload: Preload,
) -> Result<Values, ValidationError> {
    let mut values = Vec::new();
    for table in Table::ALL {
        let set = change(&scene(table.consistent())?)?;
        let printed = table.printed(reference);
        let standing = preloaded(&set, bodies, &preload)?;
        let modes = linear_modes(&standing, &standing.linearised()?)?;
        let typed: Vec<NaturalMode> = modes.iter().map(NaturalMode::from).collect();
        let fed = lumped_frequencies(&lumped_from_fe(&set, bodies, &preload)?)?;
        for (model, name, rows) in [
            ("FE/contact", format!("table{}.fe_contact", table.number()), tabled(printed, &typed)),
            (
                "lumped, parameters from FE",
                format!("lumped_from_fe.table{}", table.number()),
                tabled(printed, &fed),
            ),
        ] {
            let list = rows.iter().zip(&printed.mode_type).zip(&printed.fe_contact_hz);
            for (row, ((TabledFrequency { mean_hz, .. }, kind), hz)) in list.enumerate() {
                values.push(Value {
                    id: format!("{name}.{}", row + 1),
                    what: format!("Table {}, {kind} mode, {model}", table.number()),
                    unit: "Hz",
                    ours: *mean_hz,
                    printed: *hz,
                    half_digit: 0.5,
                });
            }
        }
    }
    Ok(values)
}

/// Masses, inertias and mesh stiffnesses.
fn bodies_and_meshes(set: &Scene, bodies: &Bodies) -> Result<Values, ValidationError> {
    let missing = || ValidationError::Incomplete("sun, carrier, or lumped values of them");
    let lumped = scene(Table::Three.consistent())?.lumped.ok_or_else(missing)?;
    let sun = bodies.sun.as_ref().ok_or_else(missing)?;
    let standing = preloaded(set, bodies, &preload(TORQUE, 0.0))?;
    let carrier = standing.races().carrier.as_ref().ok_or_else(missing)?;
    let [r_carrier, _, r_sun, r_planet] = standing.races().radii;
    // Masses are printed to 0.01 kg, inertias to 1e-6, 1e-5 and 1e-4 kg m².
    let parts = [
        (
            "sun",
            [sun.mass, sun.inertia],
            [lumped.mass_kg.sun, lumped.inertia_over_r2_kg.sun],
            r_sun,
            0.5e-6,
        ),
        (
            "planet",
            [bodies.planet.mass, bodies.planet.inertia],
            [lumped.mass_kg.planet, lumped.inertia_over_r2_kg.planet],
            r_planet,
            0.5e-5,
        ),
        (
            "carrier",
            [carrier.mass, carrier.inertia],
            [lumped.mass_kg.carrier, lumped.inertia_over_r2_kg.carrier],
            r_carrier,
            0.5e-4,
        ),
    ];
    let mut values = Vec::new();
    for (name, [mass, inertia], [printed_mass, over_r2], radius, half_digit) in parts {
        values.push(Value {
            id: format!("fe.bodies.mass.{name}"),
            what: format!("mass of the {name}"),
            unit: "kg",
            ours: mass,
            printed: printed_mass.ok_or_else(missing)?,
            half_digit: 0.005,
        });
        values.push(Value {
            id: format!("fe.bodies.inertia.{name}"),
            what: format!("polar inertia of the {name}"),
            unit: "kg m²",
            ours: inertia,
            printed: over_r2.ok_or_else(missing)? * radius * radius,
            half_digit,
        });
    }
    let force = TORQUE / 3.0 / r_sun;
    let mut secants = Vec::new();
    for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
        let cycle = pair_cycle(bodies, kind, force, STIFFNESS_POSITIONS, &ActiveSet)?;
        secants.push((kind, cycle.mean_secant_stiffness()));
    }
    let width = bodies.geometry.face_width;
    for (kind, secant) in &secants {
        let formula = iso6336_mean_stiffness(set, *kind).ok_or_else(missing)?;
        // The formula uses the same gears, so that the ratio of the two is judged.
        values.push(Value {
            id: format!("fe.iso_6336.{}", kind.name()),
            what: format!(
                "mean secant stiffness of the {} mesh over c_γ of ISO 6336-1",
                kind.name()
            ),
            unit: "",
            ours: secant / width * 1e-9 / formula,
            printed: 1.0,
            half_digit: 0.0,
        });
    }
    let series = 1.0 / secants.iter().map(|(_, k)| 1.0 / k).sum::<f64>();
    let printed = lumped.mesh_n_per_m.sun_planet;
    for (name, value) in
        [("series", series), ("sun_planet", secants[0].1), ("ring_planet", secants[1].1)]
    {
        values.push(Value {
            id: format!("fe.stiffness.{name}"),
            what: match name {
                "series" => "mean secant stiffnesses of the two meshes in series".into(),
                _ => format!("mean secant stiffness of the {name} mesh alone"),
            },
            unit: "1e6 N/m",
            ours: value * 1e-6,
            printed: printed * 1e-6,
            half_digit: 5.0,
        });
    }
    Ok(values)
}

/// All values of the scenes that `change` makes.
fn values(
    reference: &Reference,
    change: &dyn Fn(&Scene) -> Result<Scene, ValidationError>,
) -> Result<Values, ValidationError> {
    let set = change(&scene(Table::Three.consistent())?)?;
    let bodies = Bodies::new(&set)?;
    let mut list = frequencies(reference, change, &bodies, preload(TORQUE, 0.0))?;
    list.extend(bodies_and_meshes(&set, &bodies)?);
    Ok(list)
}

fn percent(base: &Values, list: &Values) -> Vec<f64> {
    base.iter().zip(list).map(|(a, b)| 100.0 * (b.ours / a.ours - 1.0)).collect()
}

/// A scene with one parameter at a value.
fn changed(scene: &Scene, interval: &Interval, value: f64) -> Result<Scene, ValidationError> {
    let mut changed = scene.clone();
    match interval.name.as_str() {
        "planet_share" => changed = with_share(scene, value),
        "backlash" => changed = with_backlash(scene, 1e-3 * value),
        "pin_seat" => {
            let carrier = changed.geometry.as_mut().and_then(|g| g.carrier.as_mut());
            carrier.ok_or(ValidationError::Incomplete("carrier"))?.pin_seat_radius_m = 1e-3 * value;
        }
        "plane_stress" if value > 0.5 => changed.fe_contact.plane = PlaneState::Stress,
        "plane_stress" => {}
        name => {
            let wheel = Wheel::ALL.into_iter().find(|w| name == format!("{}_fillet", w.name()));
            let wheel = wheel.ok_or(ValidationError::Incomplete("parameter of that name"))?;
            changed = with_fillet(scene, wheel, 1e-3 * value);
        }
    }
    with_fitting_fillets(&changed)
}

/// Effects of one parameter's two ends on all values, percent.
fn ends(
    reference: &Reference,
    interval: &Interval,
    base: &Values,
    bodies: &Bodies,
) -> Result<[Vec<f64>; 2], ValidationError> {
    let nothing: Vec<f64> = vec![0.0; base.len()];
    let same = |scene: &Scene| Ok(scene.clone());
    // Position and preload affect only frequencies, which come first among the values.
    let state = |torque, position| -> Result<Vec<f64>, ValidationError> {
        let list = frequencies(reference, &same, bodies, preload(torque, position))?;
        let mut effects = percent(base, &list);
        effects.resize(base.len(), 0.0);
        Ok(effects)
    };
    match interval.name.as_str() {
        "position" => {
            let (mut least, mut most) = (nothing.clone(), nothing);
            for k in 1..POSITIONS {
                let at = state(TORQUE, k as f64 / POSITIONS as f64)?;
                for (i, effect) in at.into_iter().enumerate() {
                    (least[i], most[i]) = (least[i].min(effect), most[i].max(effect));
                }
            }
            Ok([least, most])
        }
        "preload" => Ok([state(TORQUES[0], 0.0)?, state(TORQUES[1], 0.0)?]),
        _ => {
            let end = |value: f64| -> Result<Vec<f64>, ValidationError> {
                if value == interval.base {
                    return Ok(nothing.clone());
                }
                let change = |scene: &Scene| changed(scene, interval, value);
                Ok(percent(base, &values(reference, &change)?))
            };
            Ok([end(interval.lower)?, end(interval.upper)?])
        }
    }
}

/// An effect rounded to the 1e-4 % that are kept.
fn rounded(percent: f64) -> f64 {
    let kept = (percent * 1e4).round() * 1e-4;
    // Avoids -0, and binary remainders in the printed multiples of 1e-4.
    if kept == 0.0 { 0.0 } else { (kept * 1e4).round() / 1e4 }
}

fn shown(interval: &Interval) -> Interval {
    let Interval { lower, base, upper, .. } = *interval;
    let [lower, base, upper] = [lower, base, upper].map(digits);
    Interval { lower, base, upper, ..interval.clone() }
}

/// Seven digits, as values and the ends of intervals are kept.
fn digits(x: f64) -> f64 {
    format!("{x:.6e}").parse().unwrap_or(x)
}

/// Computes all bands; `heard` is called with the name of every parameter before it is varied.
///
/// # Errors
/// If a scene cannot be used, or an equilibrium or an eigenproblem cannot be solved.
pub(super) fn study(
    reference: &Reference,
    command: &str,
    heard: &dyn Fn(&str),
) -> Result<ParameterBands, ValidationError> {
    let set = scene(Table::Three.consistent())?;
    let intervals = intervals(&set)?;
    let same = |scene: &Scene| Ok(scene.clone());
    heard("the scene as it is");
    let base = values(reference, &same)?;
    let bodies = Bodies::new(&set)?;
    let mut effects: Vec<Vec<ParameterEffect>> = base.iter().map(|_| Vec::new()).collect();
    for interval in &intervals {
        heard(&interval.name);
        let [lower, upper] = ends(reference, interval, &base, &bodies)?;
        for (row, (low, high)) in effects.iter_mut().zip(lower.into_iter().zip(upper)) {
            row.push(ParameterEffect {
                parameter: interval.name.clone(),
                at_lower_percent: rounded(low),
                at_upper_percent: rounded(high),
            });
        }
    }
    let row = base.into_iter().zip(effects).map(|(value, effect)| {
        let bodily =
            |e: &&ParameterEffect| intervals.iter().any(|i| i.name == e.parameter && i.is_body);
        BandRow {
            band_percent: band_of(effect.iter().filter(bodily)).map(rounded),
            band_with_state_percent: band_of(effect.iter()).map(rounded),
            id: value.id,
            what: value.what,
            unit: value.unit.into(),
            ours: digits(value.ours),
            printed: digits(value.printed),
            half_digit: value.half_digit,
            effect,
        }
    });
    Ok(ParameterBands {
        source: "own computation: both ends of every interval one at a time, three and four planets at 1130 N·m and position 0; effects and bands in percent of our value; a band is the sum of the effects by sign".into(),
        command: command.into(),
        row: row.collect(),
        interval: intervals.iter().map(shown).collect(),
    })
}
