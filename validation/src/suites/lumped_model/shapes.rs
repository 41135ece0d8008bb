//! Modes with vectors beside those of the lumped model, paired by the motions that they span.
//!
//! ```text
//! overlap of a vector q with a group of modes Φ, ΦᵀMΦ = 1:    ‖ΦᵀM q‖² / qᵀM q
//! of the space Q of several, QᵀMQ = 1:                        the least eigenvalue of (ΦᵀMQ)ᵀ(ΦᵀMQ), cos² of the largest angle
//! ```

use dynamics::{generalized_symmetric, orthonormal_basis};
use lumped::nalgebra::DMatrix;
use lumped::{LumpedModel, NaturalModes};

use super::{Checks, EQUAL};
use crate::check::Check;
use crate::error::ValidationError;
use crate::reference::Reference;

/// A mode with its vector.
pub(crate) struct ListedShape {
    /// Line of the table.
    pub(crate) line: u64,
    pub(crate) frequency_hz: f64,
    /// Displacements of the free coordinates of the lumped model, times any factor.
    pub(crate) shape: Vec<f64>,
}

/// Modes of the lumped model of one type and frequency.
struct Group {
    mode_type: &'static str,
    frequency_hz: f64,
    /// M^½-scaled, orthonormal.
    vectors: Vec<Vec<f64>>,
}

/// The modes of the model; types are not asked of rotations alone.
fn groups(model: &LumpedModel, is_torsional: bool) -> Result<Vec<Group>, ValidationError> {
    let mut groups: Vec<Group> = Vec::new();
    for found in NaturalModes::of(model)?.groups {
        let vectors = found.vectors.column_iter().map(|column| scaled(model, column.as_slice()));
        let mode_type = if is_torsional { "torsional" } else { found.mode_type.name() };
        let is_same = |last: &&mut Group| {
            let apart = (found.frequency_hz - last.frequency_hz).abs();
            is_torsional && apart <= EQUAL * found.frequency_hz
        };
        match groups.last_mut().filter(is_same) {
            Some(last) => last.vectors.extend(vectors),
            None => {
                let vectors = vectors.collect();
                groups.push(Group { mode_type, frequency_hz: found.frequency_hz, vectors });
            }
        }
    }
    Ok(groups)
}

fn scaled(model: &LumpedModel, shape: &[f64]) -> Vec<f64> {
    shape.iter().zip(&model.mass).map(|(q, m)| m.sqrt() * q).collect()
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// For each group the listed modes that are its, as numbers of the list, and what is left: of all pairs, those that
/// overlap most come first, and a group takes as many as it has modes.
fn paired(groups: &[Group], listed: &[Vec<f64>]) -> (Vec<Vec<usize>>, Vec<usize>) {
    let overlap =
        |g: &Group, q: &Vec<f64>| g.vectors.iter().map(|v| product(v, q).powi(2)).sum::<f64>();
    let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
    for (k, q) in listed.iter().enumerate() {
        pairs.extend(groups.iter().enumerate().map(|(g, group)| (overlap(group, q), k, g)));
    }
    pairs.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut taken = vec![Vec::new(); groups.len()];
    let mut is_left = vec![true; listed.len()];
    for (_, k, g) in pairs {
        if is_left[k] && taken[g].len() < groups[g].vectors.len() {
            is_left[k] = false;
            taken[g].push(k);
        }
    }
    taken.iter_mut().for_each(|list| list.sort_unstable());
    (taken, (0..listed.len()).filter(|k| is_left[*k]).collect())
}

/// 1 − cos² of the largest angle between the space of some vectors and that of `basis`, orthonormal; 1 if they span
/// fewer dimensions than they are.
fn lost(basis: &[&Vec<f64>], vectors: &[Vec<f64>]) -> Result<f64, ValidationError> {
    let space = orthonormal_basis(vectors, &[]);
    if space.len() < vectors.len() {
        return Ok(1.0);
    }
    let cosines = DMatrix::from_fn(basis.len(), space.len(), |i, j| product(basis[i], &space[j]));
    let squares = cosines.transpose() * cosines;
    let lambda = generalized_symmetric(&squares, &vec![1.0; space.len()])?.lambda;
    Ok((1.0 - lambda.first().copied().unwrap_or_default()).clamp(0.0, 1.0))
}

/// Frequency and shape of every mode of the scene with that id. Modes above the highest of the list are not asked for.
pub(crate) fn beside(
    id: &str,
    title: &str,
    model: &LumpedModel,
    listed: &[ListedShape],
    is_torsional: bool,
    reference: &Reference,
) -> Checks {
    let groups = groups(model, is_torsional)?;
    let vectors: Vec<Vec<f64>> = listed
        .iter()
        .map(|mode| {
            let q = scaled(model, &mode.shape);
            let length = product(&q, &q).sqrt();
            q.iter().map(|x| x / length).collect()
        })
        .collect();
    let (taken, left) = paired(&groups, &vectors);
    let end_hz = listed.iter().map(|mode| mode.frequency_hz).fold(0.0, f64::max);
    let percent = reference.registry.check("lumped_model.*")?.percent.unwrap_or_default();
    let mut checks = Vec::new();
    for (g, (group, taken)) in groups.iter().zip(&taken).enumerate() {
        let Group { mode_type, frequency_hz, .. } = *group;
        let number = groups[..=g].iter().filter(|other| other.mode_type == mode_type).count();
        let check = format!("lumped_model.{id}.{mode_type}.{number}");
        let name = format!("{title}: {mode_type} mode {number}");
        let about = reference.about(&check, &name)?;
        let distance = |k: &&usize| (listed[**k].frequency_hz - frequency_hz).abs();
        let worst = taken.iter().max_by(|a, b| distance(a).total_cmp(&distance(b)));
        let times = group.vectors.len();
        checks.push(match worst {
            None => {
                let is_beyond = frequency_hz > end_hz;
                about.number_if_run(frequency_hz, (!is_beyond).then_some(f64::NAN))
            }
            Some(_) if taken.len() < times => {
                about.equal(format!("{times} times"), format!("listed {} times", taken.len()))
            }
            Some(k) => about.number(frequency_hz, listed[*k].frequency_hz),
        });
        if taken.is_empty() {
            continue;
        }
        // Modes nearer to one another than the tolerance of frequencies: small differences turn them in one space.
        let is_near = |other: &&Group| {
            let apart = (other.frequency_hz - frequency_hz).abs();
            other.mode_type == mode_type && apart <= 0.01 * percent * frequency_hz
        };
        let basis: Vec<&Vec<f64>> =
            groups.iter().filter(is_near).flat_map(|near| &near.vectors).collect();
        let of_group: Vec<Vec<f64>> = taken.iter().map(|k| vectors[*k].clone()).collect();
        let lines: Vec<String> = taken.iter().map(|k| listed[*k].line.to_string()).collect();
        let check = format!("lumped_model.{id}.shape.{mode_type}.{number}");
        let name = format!("{title}: shape of {mode_type} mode {number}, 1 − overlap");
        let about = reference.about(&check, &name)?;
        let note = format!("vector of line {} of modes.csv", lines.join(" and "));
        checks.push(about.note(note).at_most(lost(&basis, &of_group)?));
    }
    let stray = |(number, k): (usize, &usize)| -> Result<Check, ValidationError> {
        let check = format!("lumped_model.{id}.without_partner.{}", number + 1);
        let name = format!("{title}: vector of line {} of modes.csv", listed[*k].line);
        let about = reference.about(&check, &name)?;
        Ok(about.equal("no such mode", format!("{} Hz", listed[*k].frequency_hz)))
    };
    checks.extend(left.iter().enumerate().map(stray).collect::<Result<Vec<_>, _>>()?);
    Ok(checks)
}
