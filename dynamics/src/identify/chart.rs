//! Stabilisation chart: the poles of every order, and which of their properties are stable from order to
//! order.

use std::f64::consts::TAU;

use faer::c64;

use super::error::IdentifyError;
use super::options::{Options, Tolerances};
use super::realisation::Realisation;
use super::records::Records;
use super::shape::share_in_span;

/// Which properties of a pole agree with a pole of the order before.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Stability {
    /// The frequency agrees.
    pub frequency: bool,
    /// The damping ratio agrees as well.
    pub damping: bool,
    /// The shape agrees, or lies in the span of the shapes of a repeated pole.
    pub shape: bool,
}

impl Stability {
    /// Whether frequency, damping and shape are all stable.
    pub fn all(self) -> bool {
        self.frequency && self.damping && self.shape
    }
}

/// A pole of the chart.
#[derive(Debug, Clone)]
pub struct Pole {
    /// s, rad/s.
    pub s: c64,
    /// |s|/2π, Hz.
    pub frequency: f64,
    /// −Re s/|s|.
    pub damping: f64,
    /// Modal amplitude coherence, 0 to 1.
    pub coherence: f64,
    /// Largest amplitude over inputs and outputs at the first sample, both scaled.
    pub amplitude: f64,
    /// Which of its properties are stable.
    pub stable: Stability,
    /// Shape over the scaled outputs.
    pub shape: Vec<c64>,
    /// Participation of the scaled inputs.
    pub(super) participation: Vec<c64>,
    /// Index of the matching pole at the order before.
    pub(super) before: Option<usize>,
}

/// The poles of one order.
#[derive(Debug, Clone)]
pub struct ChartOrder {
    /// Number of states.
    pub order: usize,
    /// Oscillating poles below half the decimated rate, by ascending frequency.
    pub poles: Vec<Pole>,
}

/// Poles at all even orders, compared from order to order.
pub(super) fn chart(
    realisation: &Realisation,
    records: &Records,
    options: &Options,
) -> Result<Vec<ChartOrder>, IdentifyError> {
    let step = options.decimation.stride() as f64 * records.interval;
    let mut chart: Vec<ChartOrder> = Vec::new();
    let highest = realisation.highest();
    // The highest order may be odd: at least one of its states does not oscillate.
    let odd = Some(highest).filter(|n| n % 2 == 1);
    for order in (2..=highest).step_by(2).chain(odd) {
        let mut poles = Vec::new();
        for raw in realisation.poles(order)? {
            // s = ln(λ)/Δt
            let s = raw.multiplier.ln() / step;
            let gain = records.gain(s).norm();
            let largest = |v: &[c64]| v.iter().fold(0.0f64, |a, x| a.max(x.norm()));
            let amplitude = 2.0 * largest(&raw.shape) * largest(&raw.participation) / gain;
            let mut pole = Pole {
                s,
                frequency: s.norm() / TAU,
                damping: -s.re / s.norm(),
                coherence: raw.coherence,
                amplitude,
                stable: Stability::default(),
                shape: raw.shape,
                participation: raw.participation,
                before: None,
            };
            if let Some(last) = chart.last() {
                compare(&mut pole, &last.poles, &options.tolerances);
            }
            poles.push(pole);
        }
        poles.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
        chart.push(ChartOrder { order, poles });
    }
    Ok(chart)
}

/// Matches a pole with the nearest one of the order before and compares the two.
fn compare(pole: &mut Pole, before: &[Pole], tolerances: &Tolerances) {
    let distance = |other: &Pole| (other.s - pole.s).norm();
    let nearest =
        (0..before.len()).min_by(|&i, &j| distance(&before[i]).total_cmp(&distance(&before[j])));
    let Some(index) = nearest else { return };
    let other = &before[index];
    let near = |a: f64, b: f64, tolerance: f64| (a - b).abs() <= tolerance * b.abs();
    if !near(pole.frequency, other.frequency, tolerances.frequency) {
        return;
    }
    let family: Vec<&[c64]> = before
        .iter()
        .filter(|p| (p.s - other.s).norm() <= tolerances.repeated * other.s.norm())
        .map(|p| p.shape.as_slice())
        .collect();
    let share = share_in_span(&pole.shape, &family);
    pole.before = Some(index);
    pole.stable = Stability {
        frequency: true,
        damping: near(pole.damping, other.damping, tolerances.damping),
        shape: 1.0 - share <= tolerances.shape,
    };
}
