//! Matrices as their author wrote them.

use std::path::PathBuf;
use std::sync::Arc;

use lumped::nalgebra::DMatrix;

use crate::results::known_scenes::KnownScene;

/// Which matrix it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MatrixKind {
    /// M.
    Mass,
    /// K.
    Stiffness,
}

/// One matrix, in the author's coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct GivenMatrix {
    /// The file.
    pub path: PathBuf,
    /// Its numbers, square; kg of M and N/m of K where the coordinates are lengths.
    pub values: DMatrix<f64>,
    /// Part by which the number of digits may have changed an entry: half a unit of the last digit.
    pub rounding: f64,
    /// Line of each entry, column by column; 0 where the file has none.
    pub(super) lines: Vec<u64>,
    /// Line that says or shows how many rows there are.
    pub(super) size_line: u64,
}

/// The matrices of one scene.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneMatrices {
    /// The scene.
    pub scene: Arc<KnownScene>,
    /// M.
    pub mass: Option<GivenMatrix>,
    /// K.
    pub stiffness: Option<GivenMatrix>,
}

impl MatrixKind {
    /// M or K.
    pub fn letter(self) -> &'static str {
        match self {
            Self::Mass => "M",
            Self::Stiffness => "K",
        }
    }
}

impl GivenMatrix {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.values.nrows()
    }

    /// Line of the file, from 1, with entry (i, j), counted from 0; that of its size if the file leaves it out.
    pub fn line(&self, i: usize, j: usize) -> u64 {
        match self.lines.get(i + j * self.rows()) {
            Some(0) | None => self.size_line,
            Some(line) => *line,
        }
    }

    /// Line of the file, from 1, that says or shows how many rows there are.
    pub fn size_line(&self) -> u64 {
        self.size_line
    }
}

impl SceneMatrices {
    /// Both, if both are there: M, K.
    pub fn both(&self) -> Option<(&GivenMatrix, &GivenMatrix)> {
        self.mass.as_ref().zip(self.stiffness.as_ref())
    }

    /// Those that are there.
    pub fn each(&self) -> impl Iterator<Item = (MatrixKind, &GivenMatrix)> {
        let mass = self.mass.iter().map(|matrix| (MatrixKind::Mass, matrix));
        mass.chain(self.stiffness.iter().map(|matrix| (MatrixKind::Stiffness, matrix)))
    }
}

/// Entries of a matrix that is being read.
pub(super) struct Entries {
    values: DMatrix<f64>,
    lines: Vec<u64>,
    digits: usize,
}

/// Fewest digits that rounding is read from: numbers of fewer, such as 0.66 kg, are taken as exact to these.
const FEWEST_DIGITS: usize = 5;

impl Entries {
    pub(super) fn new(rows: usize) -> Self {
        Self { values: DMatrix::zeros(rows, rows), lines: vec![0; rows * rows], digits: 0 }
    }

    /// Line of an entry that is there.
    pub(super) fn line(&self, i: usize, j: usize) -> Option<u64> {
        let line = self.lines[i + j * self.values.nrows()];
        (line > 0).then_some(line)
    }

    /// Sets an entry; `text` is the number as written.
    pub(super) fn set(&mut self, (i, j): (usize, usize), value: f64, text: &str, line: u64) {
        self.values[(i, j)] = value;
        let rows = self.values.nrows();
        self.lines[i + j * rows] = line;
        self.digits = self.digits.max(significant_digits(text));
    }

    pub(super) fn finish(self, path: PathBuf, size_line: u64) -> GivenMatrix {
        let digits = self.digits.clamp(FEWEST_DIGITS, 16) as i32;
        let rounding = 0.5 * 10f64.powi(1 - digits);
        GivenMatrix { path, values: self.values, rounding, lines: self.lines, size_line }
    }
}

/// Digits of a number from the first that is not 0.
fn significant_digits(text: &str) -> usize {
    let mantissa = text.split(['e', 'E', 'd', 'D']).next().unwrap_or_default();
    let digits = mantissa.chars().filter(char::is_ascii_digit);
    digits.skip_while(|digit| *digit == '0').count()
}
