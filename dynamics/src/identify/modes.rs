//! Modes from poles; the modes of a repeated pole are separated.

use std::f64::consts::TAU;

use faer::linalg::solvers::Svd;
use faer::{Mat, c64};

use super::chart::Pole;
use super::error::IdentifyError;
use super::options::Options;
use super::records::Records;

/// One mode: it adds Re(shape_o · participation_i · exp(s t)) to output o of input i.
#[derive(Debug, Clone)]
pub struct Mode {
    /// Undamped natural frequency |s|/2π, Hz.
    pub frequency: f64,
    /// Damping ratio −Re s/|s|.
    pub damping: f64,
    /// s, rad/s; the mean of a repeated pole.
    pub s: c64,
    /// Number of modes that share the pole, itself included.
    pub multiplicity: usize,
    /// Largest |Δs|/|s| of the poles merged into one; zero for a simple pole.
    pub spread: f64,
    /// Amplitudes of the outputs in their units under the input that excites the mode most, at the first
    /// sample; the entry that is largest over its output's scale is real and positive. Shapes of a repeated
    /// pole are orthogonal over the scaled outputs: a basis of its space of shapes.
    pub shape: Vec<c64>,
    /// Share of each input, the largest of magnitude one.
    pub participation: Vec<c64>,
    /// Least modal amplitude coherence of its poles, 0 to 1.
    pub coherence: f64,
    /// Largest amplitude over inputs and outputs, both scaled, relative to the strongest mode.
    pub strength: f64,
}

/// Modes of the poles of one order, ascending in frequency; equal poles are merged.
pub(super) fn modes(
    poles: &[&Pole],
    records: &Records,
    options: &Options,
) -> Result<Vec<Mode>, IdentifyError> {
    let mut groups: Vec<Vec<&Pole>> = Vec::new();
    for &pole in poles {
        let equal = |other: &&Pole| {
            (other.s - pole.s).norm() <= options.tolerances.repeated * pole.s.norm()
        };
        match groups.iter_mut().find(|group| group.iter().any(equal)) {
            Some(group) => group.push(pole),
            None => groups.push(vec![pole]),
        }
    }
    let mut modes = Vec::with_capacity(poles.len());
    for group in groups {
        modes.extend(group_modes(&group, records)?);
    }
    let strongest = modes.iter().fold(0.0f64, |a, m| a.max(m.strength));
    modes.iter_mut().for_each(|m| m.strength /= strongest);
    // A pole found twice with only one shape or one input gives a second mode of negligible amplitude.
    modes.retain(|m| m.strength >= options.weakest);
    let left: Vec<c64> = modes.iter().map(|m| m.s).collect();
    for mode in &mut modes {
        mode.multiplicity = left.iter().filter(|s| **s == mode.s).count();
    }
    modes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    Ok(modes)
}

/// The modes of one pole: residues Σ φ pᵀ of the group, split by their singular values.
fn group_modes(group: &[&Pole], records: &Records) -> Result<Vec<Mode>, IdentifyError> {
    let multiplicity = group.len();
    // A perturbation that splits a repeated pole changes the mean by the square of the split only.
    let s = group.iter().map(|p| p.s).sum::<c64>() / multiplicity as f64;
    let spread = group.iter().map(|p| (p.s - s).norm() / s.norm()).fold(0.0f64, f64::max);
    let coherence = group.iter().map(|p| p.coherence).fold(f64::INFINITY, f64::min);
    let gain = records.gain(s);
    let (rows, columns) = (records.outputs, records.inputs);
    let residue = Mat::from_fn(rows, columns, |o, i| {
        // C Aᵏ B = Σ φ p λᵏ over both of each conjugate pair: 2 Re over one of them.
        group.iter().map(|p| p.shape[o] * p.participation[i]).sum::<c64>() * 2.0 / gain
    });
    // Divided by the phase that makes it as real as possible: normal modes then have real shapes.
    let square: c64 = residue.col_iter().flat_map(|c| c.iter()).map(|x| x * x).sum();
    let turn = c64::from_polar(1.0, 0.5 * square.arg());
    let turned = Mat::from_fn(rows, columns, |o, i| residue[(o, i)] / turn);
    let size = rows.min(columns);
    let svd = Svd::new_thin(turned.as_ref()).map_err(|_| IdentifyError::NoConvergence { size })?;
    let (u, v, sigma) = (svd.U(), svd.V(), svd.S().column_vector());
    Ok((0..multiplicity.min(size))
        .map(|k| {
            let shape: Vec<c64> = (0..rows).map(|o| u[(o, k)]).collect();
            let share: Vec<c64> = (0..columns).map(|i| v[(i, k)].conj() * turn).collect();
            let front = largest(&shape);
            let strength = front.norm() * largest(&share).norm() * sigma[k].re;
            let share: Vec<c64> =
                share.iter().zip(&records.input_scale).map(|(x, scale)| x * *scale).collect();
            let most = largest(&share).norm();
            let phase = front / front.norm();
            Mode {
                frequency: s.norm() / TAU,
                damping: -s.re / s.norm(),
                s,
                multiplicity,
                spread,
                shape: shape
                    .iter()
                    .zip(&records.output_scale)
                    .map(|(x, scale)| x / phase * (sigma[k].re * most * scale))
                    .collect(),
                participation: share.iter().map(|x| x * phase / most).collect(),
                coherence,
                strength,
            }
        })
        .collect())
}

/// The entry of largest magnitude, the first of equals.
fn largest(values: &[c64]) -> c64 {
    values.iter().fold(c64::new(0.0, 0.0), |a, x| {
        // Of entries equal to rounding the first is taken, so that noise does not decide.
        if x.norm() > a.norm() * (1.0 + 1e-9) { *x } else { a }
    })
}
