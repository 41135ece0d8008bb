//! Vectors of modes: which rows have them, their coordinates, and types that they are not of.

use std::path::Path;

use lumped::ModeType;

use super::contradiction::Contradiction;
use super::tables::by_scene;
use crate::mode_type::{share, type_named, type_of};
use crate::model_kind::ModelKind;
use crate::results::manifest::Manifest;
use crate::results::model::ReferenceModel;
use crate::results::rows::ModeRow;

/// Part of its length by which a vector must differ from another.
const EQUAL: f64 = 1e-6;

/// Share of the kinetic energy up to which a vector has no part outside its type.
const PURE: f64 = 1e-9;

/// What cannot be true of the vectors in `modes.csv`. Those of scenes without a lumped model are held against nothing.
pub(in crate::results) fn vectors(
    path: &Path,
    rows: &[ModeRow],
    manifest: &Manifest,
    kind: ModelKind,
) -> Vec<Contradiction> {
    let mut found = Vec::new();
    for rows in by_scene(rows) {
        let with: Vec<&ModeRow> =
            rows.iter().filter(|row| !row.vector.is_empty()).copied().collect();
        let Some(first) = with.first() else { continue };
        let Ok(reference) = ReferenceModel::new(&first.scene.scene, &manifest.held, kind) else {
            continue;
        };
        let checked =
            whole(path, &rows, &with).and_then(|()| shapes(path, &with, manifest, &reference));
        match checked {
            Err(contradiction) => found.push(contradiction),
            Ok(shapes) => {
                let shapes: Vec<(&ModeRow, Vec<f64>)> = with.into_iter().zip(shapes).collect();
                found.extend(one_twice(path, &shapes, &reference));
                if kind != ModelKind::Torsional {
                    found.extend(
                        shapes
                            .iter()
                            .filter_map(|(row, q)| of_another_type(path, row, q, &reference)),
                    );
                }
            }
        }
    }
    found
}

/// Every row of a scene has a vector or none has, and a row is one mode.
fn whole(path: &Path, rows: &[&ModeRow], with: &[&ModeRow]) -> Result<(), Contradiction> {
    if let Some(without) = rows.iter().find(|row| row.vector.is_empty()) {
        let statement =
            format!("a row with a vector and one without, both of `{}`", without.scene.id);
        let remedy = "give the vector of every mode of a scene, or of none";
        return Err(Contradiction::new(path, [with[0].line, without.line], &[], statement, remedy));
    }
    match with.iter().find(|row| row.times() > 1) {
        Some(row) => {
            let statement = format!("one vector with multiplicity {}", row.times());
            let remedy = "write a row for each vector, each of multiplicity 1";
            Err(Contradiction::new(path, [row.line], &["multiplicity"], statement, remedy))
        }
        None => Ok(()),
    }
}

/// The vectors on the free coordinates of the lumped model.
fn shapes(
    path: &Path,
    with: &[&ModeRow],
    manifest: &Manifest,
    reference: &ReferenceModel,
) -> Result<Vec<Vec<f64>>, Contradiction> {
    let shape = |row: &&ModeRow| {
        let refuse = |statement: String, remedy: &str| {
            Contradiction::new(path, [row.line], &[], statement, remedy)
        };
        let shape = reference.shape(&manifest.convention, &row.vector).map_err(|fault| {
            refuse(
                fault.to_string(),
                "a vector has a number for every coordinate that moves, and none for others",
            )
        })?;
        match shape.iter().any(|q| *q != 0.0) && shape.iter().all(|q| q.is_finite()) {
            true => Ok(shape),
            false => {
                Err(refuse("a vector of zeros".to_owned(), "leave it out, or give its numbers"))
            }
        }
    };
    let most = reference.model.mass.len();
    if let (true, [.., last]) = (with.len() > most, with) {
        let statement =
            format!("{} vectors, and {most} coordinates of `{}` move", with.len(), last.scene.id);
        let remedy = "a model has as many modes as coordinates";
        return Err(Contradiction::new(path, [with[0].line, last.line], &[], statement, remedy));
    }
    with.iter().map(shape).collect()
}

/// Two rows with one vector.
fn one_twice(
    path: &Path,
    shapes: &[(&ModeRow, Vec<f64>)],
    reference: &ReferenceModel,
) -> Option<Contradiction> {
    let product = |a: &[f64], b: &[f64]| -> f64 {
        a.iter().zip(b).zip(&reference.model.mass).map(|((a, b), m)| a * m * b).sum()
    };
    let lengths: Vec<f64> = shapes.iter().map(|(_, q)| product(q, q)).collect();
    let pairs = (0..shapes.len()).flat_map(|j| (0..j).map(move |i| (i, j)));
    let is_one = |&(i, j): &(usize, usize)| {
        let both = product(&shapes[i].1, &shapes[j].1).powi(2);
        both >= (1.0 - EQUAL) * lengths[i] * lengths[j]
    };
    let (i, j) = pairs.filter(is_one).min_by_key(|&(i, j)| (shapes[i].0.line, shapes[j].0.line))?;
    let statement = "the vectors of two modes are one".to_owned();
    let remedy = "give each mode a vector of its own; those of one frequency span its motions";
    Some(Contradiction::new(path, [shapes[i].0.line, shapes[j].0.line], &[], statement, remedy))
}

/// A type that the vector of its row is not of.
fn of_another_type(
    path: &Path,
    row: &ModeRow,
    shape: &[f64],
    reference: &ReferenceModel,
) -> Option<Contradiction> {
    let given = row.mode_type.as_deref()?;
    let shares = reference.model.participation(shape);
    let is_other = match type_named(given) {
        ModeType::Mixed => share(&shares, ModeType::Mixed) < PURE,
        named => share(&shares, named) < 0.5,
    };
    if !is_other {
        return None;
    }
    let statement = format!(
        "`mode_type` is {given}, and the vector is {}: {:.1} % of its kinetic energy is rotational, {:.1} % \
         translational and {:.1} % of planets alone",
        type_of(&shares).name(),
        100.0 * shares.rotational,
        100.0 * shares.translational,
        100.0 * shares.planet.abs(),
    );
    let remedy = "leave the type out, which then follows from the vector";
    Some(Contradiction::new(path, [row.line], &["mode_type"], statement, remedy))
}
