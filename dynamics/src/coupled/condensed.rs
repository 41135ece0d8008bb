//! A group of couplings with the rest of the system condensed out.

use super::coupling::Coupling;
use super::linear::{LANES, Modes};
use crate::newmark::AverageAcceleration;

/// Numbers of couplings (widths) for which the solver is compiled.
pub(super) const WIDTHS: [usize; 9] = [4, 6, 8, 10, 12, 16, 24, 32, 48];

/// Evaluates an expression in which the constant `$w` is the given width of a group: the solver of that width.
macro_rules! at_width {
    ($width:expr, $w:ident => $body:expr) => {
        at_width!(@ $width, $w, $body, 4 6 8 10 12 16 24 32; 48)
    };
    (@ $width:expr, $w:ident, $body:expr, $($size:literal)*; $most:literal) => {
        match $width {
            $($size => {
                const $w: usize = $size;
                $body
            })*
            _ => {
                const $w: usize = $most;
                $body
            }
        }
    };
}
pub(super) use at_width;

/// Couplings in modal coordinates, padded with couplings without force to a width of the solver.
#[derive(Debug, Clone)]
pub(super) struct Condensed {
    /// Number of couplings.
    pub(super) count: usize,
    /// The same with padding.
    pub(super) width: usize,
    /// R Φ: by mode, then coupling.
    pub(super) rows: Vec<f64>,
    /// g R Φ, g = 1 + 2τ/h: by mode, then coupling.
    pub(super) gain_rows: Vec<f64>,
    /// −τ R Φ, s: by mode, then coupling.
    pub(super) lag_rows: Vec<f64>,
    /// A⁻¹ Φᵀ Rᵀ: by coupling, then padded mode.
    pub(super) answers: Vec<f64>,
    /// Y, by column.
    pub(super) receptance: Vec<f64>,
    /// Y, by row: it is not symmetric where damping is not.
    pub(super) receptance_by_row: Vec<f64>,
    /// o, m.
    pub(super) offsets: Vec<f64>,
    /// τ, s.
    pub(super) lags: Vec<f64>,
    /// Whether any lag is not zero.
    pub(super) has_lag: bool,
}

/// Least width for `count` couplings.
pub(super) fn width(count: usize) -> Option<usize> {
    WIDTHS.into_iter().find(|w| *w >= count)
}

impl Condensed {
    /// `None` if there are too many couplings.
    pub(super) fn new(
        modes: &Modes,
        rule: &AverageAcceleration,
        couplings: &[&Coupling],
    ) -> Option<Self> {
        let (count, n) = (couplings.len(), modes.count);
        let width = width(count)?;
        let mut rows = vec![0.0; n * width];
        for (k, coupling) in couplings.iter().enumerate() {
            for j in 0..n {
                let of = |i: usize| coupling.row[i] * modes.shapes[(i, j)];
                rows[j * width + k] = (0..n).map(of).sum();
            }
        }
        let fill = |of: fn(&Coupling) -> f64| -> Vec<f64> {
            let given = couplings.iter().map(|c| of(c));
            given.chain(std::iter::repeat_n(0.0, width - count)).collect()
        };
        let (lags, offsets) = (fill(|c| c.lag), fill(|c| c.offset));
        let has_lag = lags.iter().any(|lag| *lag != 0.0);
        let lag_rows = rows.iter().enumerate().map(|(i, r)| -lags[i % width] * r).collect();
        let own = Self {
            count,
            width,
            rows,
            gain_rows: Vec::new(),
            lag_rows,
            answers: Vec::new(),
            receptance: Vec::new(),
            receptance_by_row: Vec::new(),
            offsets,
            lags,
            has_lag,
        };
        Some(own.at(modes, rule))
    }

    /// The same couplings with modes at other time steps.
    pub(super) fn at(self, modes: &Modes, rule: &AverageAcceleration) -> Self {
        let Self { count, width, rows, lags, .. } = &self;
        let (count, width, n) = (*count, *width, modes.count);
        let padded = n.next_multiple_of(LANES);
        let mut answers = vec![0.0; width * padded];
        let mut receptance = vec![0.0; width * width];
        let mut receptance_by_row = receptance.clone();
        for k in 0..count {
            let row: Vec<f64> = (0..n).map(|j| rows[j * width + k]).collect();
            let own = &mut answers[k * padded..(k + 1) * padded];
            match &modes.own_damping {
                Some(_) => (0..n).for_each(|j| own[j] = modes.own_inverse[j] * row[j]),
                None => modes.solve_full(&row, own),
            }
            for l in 0..count {
                let of = (0..n).map(|j| rows[j * width + l] * own[j]).sum();
                receptance[k * width + l] = of;
                receptance_by_row[l * width + k] = of;
            }
        }
        let gain = |(i, r): (usize, &f64)| (1.0 + lags[i % width] * rule.damping()) * r;
        let gain_rows = rows.iter().enumerate().map(gain).collect();
        Self { gain_rows, answers, receptance, receptance_by_row, ..self }
    }

    /// Deflections at modal displacements, m.
    pub(super) fn deflections(&self, modal: &[f64], out: &mut [f64]) {
        for (k, out) in out.iter_mut().enumerate().take(self.count) {
            let along = self.rows.iter().skip(k).step_by(self.width).zip(modal);
            *out = along.map(|(r, q)| r * q).sum::<f64>() - self.offsets[k];
        }
    }
}
