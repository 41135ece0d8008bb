//! Kinematics of loaded sets: theorems that hold only where meshes are taken as displaced gears have
//! them, and the linearised set against exact kinematics.

pub(crate) mod bearings;
pub(crate) mod exact;
pub(crate) mod peaks;
pub(crate) mod potential;
pub(crate) mod turned;
pub(crate) mod work;

use dynamics::{Window, spectrum};
use fe_contact::statics::{Bodies, Imperfections, SetCycle, StaticSet};
use gearset::{Facing, Scene};

use super::Lab;
use crate::check::{Check, ReferenceKind, Subject};
use crate::error::ValidationError;

/// Even, and a multiple of 14, the denominator of the OH-58's phases.
const POSITIONS: usize = 28;

/// Harmonics of mesh frequency that are looked at.
const HARMONICS: usize = 5;

/// A set without load.
fn unloaded<'b>(scene: &Scene, bodies: &'b Bodies) -> Result<StaticSet<'b>, ValidationError> {
    Ok(StaticSet::new(scene, bodies, Facing::CounterClockwise, Imperfections::default())?)
}

/// The largest of some numbers; none, or one that is no number, give no number.
fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    let bigger = |a: f64, b: f64| if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) };
    values.into_iter().reduce(bigger).unwrap_or(f64::NAN)
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

/// What the profile left out has no number.
fn at_most(
    lab: &Lab<'_>,
    id: &str,
    title: &str,
    unit: &str,
    actual: Option<f64>,
) -> Result<Check, ValidationError> {
    match actual {
        Some(actual) => lab.at_most(id, title, unit, actual),
        None => {
            let (kind, source) = (ReferenceKind::Analytic, "by construction");
            let tolerance = lab.reference.tolerance(id, 0.0)?;
            Ok(Check::not_run(Subject { id, title, kind, source, unit }, 0.0, tolerance))
        }
    }
}

/// A control: whether `found`, which a check would judge by the tolerance of `judged_by`, is beyond it.
fn breaks(
    lab: &Lab<'_>,
    id: &str,
    title: &str,
    judged_by: &str,
    found: f64,
) -> Result<Check, ValidationError> {
    let limit = lab.reference.tolerance(judged_by, 0.0)?.absolute;
    let subject = Subject {
        id,
        title: &format!("{title} breaks {judged_by}: {found:.1e} against {limit:.0e}"),
        kind: ReferenceKind::Analytic,
        source: "a check that cannot fail is none",
        unit: "",
    };
    // What is no number breaks nothing.
    let word = if found > limit { "breaks" } else { "stands" };
    Ok(Check::equal(subject, "breaks", word))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn largest_of_nothing_or_of_what_is_no_number_is_none() {
        assert_eq!(largest([1.0, 3.0, 2.0]), 3.0);
        assert!(largest([]).is_nan());
        for list in [[f64::NAN, 1.0, 2.0], [1.0, f64::NAN, 2.0], [1.0, 2.0, f64::NAN]] {
            assert!(largest(list).is_nan());
        }
    }

    #[test]
    fn harmonics_are_those_of_a_cycle() -> Result<(), Box<dyn std::error::Error>> {
        let angle = |i: usize| std::f64::consts::TAU * i as f64 / 28.0;
        let record: Vec<f64> = (0..28).map(|i| 7.0 + 3.0 * (2.0 * angle(i)).cos()).collect();
        let found = lines(&record)?;
        for (l, [re, im]) in found.into_iter().enumerate() {
            let expected = if l == 1 { 3.0 } else { 0.0 };
            assert!((re - expected).abs() < 1e-12 && im.abs() < 1e-12, "{} {re} {im}", l + 1);
        }
        Ok(())
    }
}
