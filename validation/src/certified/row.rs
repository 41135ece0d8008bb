//! One value with its conditions and its uncertainty.

use std::fmt::Write;

use serde::{Deserialize, Serialize};

use super::class::Class;
use super::quantity::Quantity;

/// A row of a table of the data set, or of somebody's baseline: columns that do not apply are empty.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// [`Row::name`]; it does not change with the version.
    pub id: String,
    /// Name of the quantity, one of [`super::QUANTITIES`].
    pub quantity: String,
    /// Id of the scene.
    pub scene: String,
    /// Kind of model: `geometry` (true of every model), `lumped`, `torsional`, `fe_contact`, `measured`.
    pub kind: String,
    /// Body, mesh, kind of modes, or the two coordinates of an entry of a matrix.
    pub subject: String,
    /// Coordinate of the subject: `x`, `y`, `rotation`, `radial`, …
    pub coordinate: String,
    /// Number among its like, from 1: of a mode within its type.
    pub number: Option<u32>,
    /// Harmonic of the mesh frequency.
    pub harmonic: Option<u32>,
    /// Torque on the sun, N m.
    pub sun_torque_nm: Option<f64>,
    /// Speed of the driven member, rpm.
    pub speed_rpm: Option<f64>,
    /// Position in the mesh cycle, 0 to 1.
    pub position: Option<f64>,
    /// Approach of the gears of one mesh along the line of action, µm.
    pub approach_um: Option<f64>,
    /// The value.
    pub value: f64,
    /// Its unit; empty of numbers.
    pub unit: String,
    /// Expanded uncertainty: the value is within ± this, in its unit.
    pub uncertainty: f64,
    /// How far it is certain.
    pub class: Class,
    /// Routes to the value, joined by `; `: at least two of classes A and B.
    pub routes: String,
    /// Where the numbers of the scene come from.
    pub source: String,
    /// Version of the data set, or of the program of a baseline.
    pub version: String,
}

impl Row {
    /// A row of one route without conditions, its unit that of the quantity; its id is empty.
    pub fn new(scene: &str, kind: &str, quantity: &str, subject: &str, value: f64) -> Self {
        let unit = Quantity::named(quantity).map_or("", |quantity| quantity.unit);
        Self {
            id: String::new(),
            quantity: quantity.to_owned(),
            scene: scene.to_owned(),
            kind: kind.to_owned(),
            subject: subject.to_owned(),
            coordinate: String::new(),
            number: None,
            harmonic: None,
            sun_torque_nm: None,
            speed_rpm: None,
            position: None,
            approach_um: None,
            value,
            unit: unit.to_owned(),
            uncertainty: 0.0,
            class: Class::C,
            routes: String::new(),
            source: String::new(),
            version: String::new(),
        }
    }

    /// Kind, scene, quantity and what applies of the other conditions, joined by dots:
    /// `lumped.oh58_4p.frequency.rotational.2`. Speeds, torques and positions count to six digits.
    pub fn name(&self) -> String {
        let mut name = format!("{}.{}.{}", self.kind, self.scene, self.quantity);
        for word in [&self.subject, &self.coordinate] {
            if !word.is_empty() {
                name.push('.');
                name.push_str(&word.replace(' ', "-"));
            }
        }
        // Writing to a string cannot fail.
        for (letter, number) in [("", self.number), ("l", self.harmonic)] {
            if let Some(number) = number {
                let _ = write!(name, ".{letter}{number}");
            }
        }
        for (number, unit) in [
            (self.sun_torque_nm, "nm"),
            (self.speed_rpm, "rpm"),
            (self.position, "cycles"),
            (self.approach_um, "um"),
        ] {
            if let Some(number) = number {
                let _ = write!(name, ".{}{unit}", six_digits(number));
            }
        }
        name
    }
}

/// A number with at most six significant digits, as short as it can be: positions of a program that prints fewer digits
/// are the same positions.
fn six_digits(number: f64) -> String {
    let rounded: f64 = format!("{number:.5e}").parse().unwrap_or(number);
    format!("{rounded}")
}
