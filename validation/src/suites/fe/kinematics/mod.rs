//! Kinematics of loaded sets: theorems that hold only if meshes are evaluated at the displaced positions of
//! the gears, and the linearised set against exact kinematics.

pub(crate) mod bearings;
pub(crate) mod exact;
pub(crate) mod peaks;
pub(crate) mod potential;
pub(crate) mod turned;
pub(crate) mod work;

use dynamics::{Window, spectrum};
use fe_contact::statics::{Bodies, Imperfections, SetCycle, StaticSet};
use gearset::Facing;
use scene::Scene;

use crate::check::Check;
use crate::error::ValidationError;
use crate::suites::Lab;

/// Even, and a multiple of 14, the denominator of the OH-58's phases.
const POSITIONS: usize = 28;

/// Harmonics of the mesh frequency that are compared.
const HARMONICS: usize = 5;

/// A set without load.
fn unloaded<'b>(scene: &Scene, bodies: &'b Bodies) -> Result<StaticSet<'b>, ValidationError> {
    Ok(StaticSet::new(scene, bodies, Facing::CounterClockwise, Imperfections::default())?)
}

/// Re and Im of harmonics 1 to 5 of what is sampled evenly over one mesh cycle.
type Lines = [[f64; 2]; HARMONICS];

fn lines(record: &[f64]) -> Result<Lines, ValidationError> {
    let found = spectrum(record, 1.0 / record.len() as f64, Window::Rectangular, 1)?.lines;
    let mut lines = [[f64::NAN; 2]; HARMONICS];
    for (line, found) in lines.iter_mut().zip(found.iter().skip(1)) {
        *line = [found.re, found.im];
    }
    Ok(lines)
}

/// Harmonics of the sun over a mesh cycle in µm: rotation times the base radius, x and y.
fn sun_lines(cycle: &SetCycle, bodies: &Bodies) -> Result<[Lines; 3], ValidationError> {
    let sun = bodies.geometry.sun.as_ref().ok_or(ValidationError::Incomplete("sun"))?;
    let of = |axis: usize, scale: f64| {
        let record: Vec<f64> =
            cycle.states.iter().map(|s| 1e6 * scale * s.central[2][axis]).collect();
        lines(&record)
    };
    Ok([of(2, sun.base_radius)?, of(0, 1.0)?, of(1, 1.0)?])
}

/// A control: `found` under the judgement of the check that it must break.
fn control(lab: &Lab<'_>, id: &str, judged_by: &str, found: f64) -> Result<Check, ValidationError> {
    let spoilt = [lab.about(judged_by, "the same of what is spoilt")?.at_most(found)];
    Ok(lab.reference.control(id, &spoilt)?)
}
