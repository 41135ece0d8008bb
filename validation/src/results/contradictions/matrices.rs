//! Matrices of mass and stiffness: sizes, symmetry, signs, and the frequencies that are listed beside them.

use std::path::Path;

use gearset::{Axis, Body};
use lumped::nalgebra::DMatrix;

use super::contradiction::Contradiction;
use crate::model_kind::ModelKind;
use crate::results::manifest::Manifest;
use crate::results::matrices::{GivenMatrix, MatrixKind, SceneMatrices};
use crate::results::model::{CoordinateFault, NoSpectrum, ReferenceModel, Spectrum};
use crate::results::rows::ModeRow;

/// Largest part by which two entries may differ that are one, beyond rounding of their digits.
const EQUAL: f64 = 1e-9;

/// Largest part by which listed frequencies may differ from those of the matrices, beyond rounding of digits.
const FREQUENCY_TOLERANCE: f64 = 2e-4;

/// What cannot be true in `matrices/`, or in `modes.csv` beside it.
pub(in crate::results) fn matrices(
    sets: &[SceneMatrices],
    modes_path: &Path,
    modes: &[ModeRow],
    manifest: &Manifest,
    kind: ModelKind,
) -> Vec<Contradiction> {
    let mut found = Vec::new();
    for set in sets {
        let before = found.len();
        let reference = match ReferenceModel::new(&set.scene.scene, &manifest.held, kind) {
            Ok(reference) => reference,
            Err(error) => {
                found.extend(set.each().map(|(_, matrix)| {
                    let statement = format!("`{}` has no lumped model: {error}", set.scene.id);
                    let remedy = "give the numbers of [lumped] in the scene, or leave the file out";
                    Contradiction::new(&matrix.path, [matrix.size_line()], &[], statement, remedy)
                }));
                continue;
            }
        };
        let mut converted = [None, None];
        for (which, matrix) in set.each() {
            let given = Given { id: &set.scene.id, which, matrix, reference: &reference, manifest };
            match given.contradiction_or_converted() {
                Ok(matrix) => converted[which as usize] = Some(matrix),
                Err(contradiction) => found.push(contradiction),
            }
        }
        if found.len() == before {
            let rows: Vec<&ModeRow> =
                modes.iter().filter(|row| row.scene.id == set.scene.id).collect();
            found.extend(spectrum(set, converted, &reference, modes_path, &rows));
        }
    }
    found
}

/// One matrix and what it is held against.
struct Given<'m> {
    id: &'m str,
    which: MatrixKind,
    matrix: &'m GivenMatrix,
    reference: &'m ReferenceModel,
    manifest: &'m Manifest,
}

impl Given<'_> {
    /// The matrix in the coordinates of the lumped model.
    fn contradiction_or_converted(&self) -> Result<DMatrix<f64>, Contradiction> {
        let Self { id, which, matrix, reference, manifest } = self;
        let convention = &manifest.convention;
        let fault = |error: CoordinateFault| {
            let remedy = "see `[convention]` and `held` of results.toml";
            Contradiction::new(&matrix.path, [matrix.size_line()], &[], error.to_string(), remedy)
        };
        let listed = reference.listed(id, convention, matrix.rows()).map_err(fault)?;
        let converted = reference.converted(id, convention, &matrix.values).map_err(fault)?;
        if let Some(found) = self.asymmetric() {
            return Err(found);
        }
        let coordinates = &reference.model.coordinates;
        let is_free = |k: &usize| coordinates.of(listed[*k].0, listed[*k].1).is_some();
        let is_massless = |k: &usize| matrix.values[(*k, *k)] <= 0.0;
        if let (MatrixKind::Mass, Some(k)) =
            (which, (0..listed.len()).filter(is_free).find(is_massless))
        {
            let (number, mass) = (k + 1, matrix.values[(k, k)]);
            let statement = format!("M({number}, {number}) is {mass}, of the {}", words(listed[k]));
            let remedy = "every body that moves has a mass and an inertia above 0";
            return Err(Contradiction::new(
                &matrix.path,
                [matrix.line(k, k)],
                &[],
                statement,
                remedy,
            ));
        }
        Ok(converted)
    }

    /// The two entries that differ most from one another.
    fn asymmetric(&self) -> Option<Contradiction> {
        let GivenMatrix { path, values, rounding, .. } = self.matrix;
        let excess = |&(i, j): &(usize, usize)| {
            let scale = (values[(i, i)] * values[(j, j)]).abs().sqrt();
            let size = values[(i, j)].abs().max(values[(j, i)].abs());
            (values[(i, j)] - values[(j, i)]).abs()
                - EQUAL * scale.max(size)
                - 2.0 * rounding * size
        };
        let pairs = (0..values.nrows()).flat_map(|j| (0..j).map(move |i| (i, j)));
        let (i, j) = pairs.max_by(|a, b| excess(a).total_cmp(&excess(b)))?;
        if excess(&(i, j)) <= 0.0 {
            return None;
        }
        let (letter, row, column) = (self.which.letter(), i + 1, j + 1);
        let statement = format!(
            "{letter}({row}, {column}) is {} and {letter}({column}, {row}) is {}",
            values[(i, j)],
            values[(j, i)]
        );
        let remedy = "matrices of masses and springs are symmetric";
        let lines = [self.matrix.line(i, j), self.matrix.line(j, i)];
        Some(Contradiction::new(path, lines, &[], statement, remedy))
    }
}

/// `planet 1, tangential displacement`.
fn words((body, axis): (Body, Axis)) -> String {
    format!("{}, {}", body.name().replace('_', " "), axis.displacement(body))
}

/// What the eigenvalues contradict. A matrix that is not there is taken from the lumped model.
fn spectrum(
    set: &SceneMatrices,
    [mass, stiffness]: [Option<DMatrix<f64>>; 2],
    reference: &ReferenceModel,
    modes_path: &Path,
    rows: &[&ModeRow],
) -> Vec<Contradiction> {
    let rounding = [&set.mass, &set.stiffness].map(|m| m.as_ref().map_or(0.0, |m| m.rounding));
    let mass = mass.unwrap_or_else(|| reference.model.mass_matrix());
    let stiffness = stiffness.unwrap_or_else(|| reference.model.stiffness());
    let spectrum = match (Spectrum::new(&mass, &stiffness, rounding), &set.mass, &set.stiffness) {
        (Ok(spectrum), ..) => spectrum,
        (Err(NoSpectrum::Eigen(error)), _, Some(k)) => {
            let statement = format!("the natural frequencies cannot be computed: {error}");
            let remedy = "give masses and stiffnesses in SI units";
            return vec![Contradiction::new(&k.path, [k.size_line()], &[], statement, remedy)];
        }
        (Err(_), Some(m), _) => {
            let statement = "M is not positive definite: a motion has no kinetic energy".to_owned();
            let remedy = "every body that moves has a mass and an inertia above 0";
            return vec![Contradiction::new(&m.path, [m.size_line()], &[], statement, remedy)];
        }
        (Err(_), ..) => return Vec::new(),
    };
    let lowest = spectrum.lambda.first().copied().unwrap_or_default();
    if let (Some(k), true) = (&set.stiffness, lowest < -spectrum.nil()) {
        let statement = format!(
            "K has a negative eigenvalue: ω² is {lowest:.4e} (rad/s)², and the largest {:.4e} (rad/s)²",
            spectrum.largest()
        );
        let remedy = "K = Σ k b bᵀ of springs has none: look for a wrong sign in one triangle or on the diagonal";
        return vec![Contradiction::new(&k.path, [k.size_line()], &[], statement, remedy)];
    }
    let names = set.both().map(|(m, k)| [m, k].map(|matrix| name(&matrix.path)));
    let Some([m, k]) = names else { return Vec::new() };
    // Digits behind the point of the frequency that has most.
    let decimals = |row: &&ModeRow| {
        let text = row.frequency_hz.to_string();
        text.split_once('.').map_or(0, |(_, decimals)| decimals.len())
    };
    let half_unit = 0.5 * 10f64.powi(-(rows.iter().map(decimals).max().unwrap_or(0) as i32));
    let other = rows.iter().find_map(|row| {
        // Rigid-body motion comes out of eigensolvers as noise.
        let is_rigid = (std::f64::consts::TAU * row.frequency_hz).powi(2) <= spectrum.nil();
        let (hz, is_one) = spectrum.nearest(row.frequency_hz, FREQUENCY_TOLERANCE, half_unit);
        let may_be_nil = is_rigid && lowest.abs() <= spectrum.nil();
        (!is_one && !may_be_nil).then_some((row, hz))
    });
    let contradiction = |(row, hz): (&&ModeRow, f64)| {
        let statement =
            format!("{} Hz, and {m} with {k} has {hz:.2} Hz as the nearest", row.frequency_hz);
        let remedy = "write table and matrices from one model";
        Contradiction::new(modes_path, [row.line], &["frequency_hz"], statement, remedy)
    };
    other.map(contradiction).into_iter().collect()
}

fn name(path: &Path) -> String {
    path.file_name().map_or(String::new(), |name| name.to_string_lossy().into_owned())
}
