//! Masses and inertias of the lumped model against discs of the same circles.

use crate::load::estimates::{self, BODIES, Disc};
use crate::scene::{PerBody, Scene};
use crate::warnings::{Found, is_outside, shown};

/// Mass and inertia of a planet, and the least of any body, against its disc of the same width and density: webs
/// and hubs change them by less than this factor, a slip of unit or of size by more.
const BODY_FACTOR: f64 = 3.0;
/// Mass of a central member over its disc, a third of what g for kg makes: shafts, hubs and housings weigh less.
const CENTRAL_MASS: f64 = 1e3 / 3.0;
/// Inertia of a central member over its disc, or I/r² over its mass, a third of what kg mm² for kg m² makes:
/// generators and rotors on its shaft have up to some 10⁴ times the inertia of a gear.
const CENTRAL_INERTIA: f64 = 1e6 / 3.0;
/// (Radius of gyration / r)² of a planet whose circles are not given; a slip of unit is 1000.
const GYRATION_SQUARED: f64 = 10.0;

fn of(values: &PerBody, name: &str) -> Option<f64> {
    values.by_name().into_iter().find(|(body, _)| *body == name)?.1
}

/// Mass and inertia that are given of one body.
struct Given {
    name: &'static str,
    mass: Option<f64>,
    over_r2: Option<f64>,
    /// I, where r is known.
    inertia: Option<f64>,
}

/// One warning at most of each body.
pub(super) fn bodies(scene: &Scene, found: &mut Found) {
    let Some(lumped) = &scene.lumped else { return };
    for (name, disc) in BODIES.into_iter().zip(estimates::discs(scene)) {
        let over_r2 = of(&lumped.inertia_over_r2_kg, name);
        let inertia = over_r2.zip(of(&lumped.radius_m, name)).map(|(i, r)| i * r * r);
        let given = Given { name, mass: of(&lumped.mass_kg, name), over_r2, inertia };
        match disc {
            Some(disc) => against_disc(&given, &disc, found),
            None => against_mass(&given, found),
        }
    }
}

fn against_disc(given: &Given, disc: &Disc, found: &mut Found) {
    let name = given.name;
    let is_planet = name == "planet";
    let most = |central: f64| if is_planet { BODY_FACTOR } else { central };
    let far =
        |value: &f64, disc: f64, most: f64| is_outside([disc / BODY_FACTOR, disc * most], *value);
    let mass = given.mass.filter(|m| far(m, disc.mass, most(CENTRAL_MASS)));
    let inertia = given.inertia.filter(|i| far(i, disc.inertia(), most(CENTRAL_INERTIA)));
    let against = format!("a disc of the {name}'s circles, face width and density has");
    let (key, both) = (format!("lumped.inertia_kg_m2.{name}"), shown(disc.inertia()));
    let size = "belongs to a set of another size";
    match (mass, inertia) {
        (Some(m), Some(i)) => {
            let what = format!(
                "{against} {} kg, and {both} kg m² where `{key}` is {}",
                shown(disc.mass),
                shown(i)
            );
            let likely = "likely both are in other units, or they or the face width belong to a set of another size";
            found.add(format!("lumped.mass_kg.{name}"), m, what, likely);
        }
        (Some(m), None) => {
            let what = format!("{against} {} kg", shown(disc.mass));
            let likely = format!("likely it is in g or t, or {size}");
            found.add(format!("lumped.mass_kg.{name}"), m, what, &likely);
        }
        (None, Some(i)) => {
            let likely = format!("likely it is in kg mm² or kg cm², or {size}");
            found.add(key, i, format!("{against} {both} kg m²"), &likely);
        }
        (None, None) => {
            let (Some(m), Some(i)) = (given.mass, given.inertia) else { return };
            if is_planet && i > m * disc.outermost.powi(2) {
                let what = format!(
                    "with {} kg its radius of gyration is {} mm, outside the {name} of radius {} mm",
                    shown(m),
                    shown(1e3 * (i / m).sqrt()),
                    shown(1e3 * disc.outermost)
                );
                found.add(key, i, what, "likely inertia and mass are in different units");
            }
        }
    }
}

fn against_mass(given: &Given, found: &mut Found) {
    let (Some(m), Some(over_r2)) = (given.mass, given.over_r2) else { return };
    let most = if given.name == "planet" { GYRATION_SQUARED } else { CENTRAL_INERTIA };
    if over_r2 > most * m {
        let what = format!(
            "with {} kg its radius of gyration is {} times the radius r of u = r·θ",
            shown(m),
            shown((over_r2 / m).sqrt())
        );
        let key = format!("lumped.inertia_over_r2_kg.{}", given.name);
        found.add(
            key,
            over_r2,
            what,
            "likely I/r², `lumped.radius_mm` or `lumped.mass_kg` is in another unit",
        );
    }
}
