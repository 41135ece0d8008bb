//! From records to modes.

use super::chart::{ChartOrder, Pole, chart};
use super::error::IdentifyError;
use super::hankel::compressed;
use super::modes::{Mode, modes};
use super::options::Options;
use super::realisation::Realisation;
use super::records::Records;
use super::selection::{Selection, selection};

/// What was identified.
#[derive(Debug, Clone)]
pub struct Identification {
    /// Modes in the band by ascending frequency.
    pub modes: Vec<Mode>,
    /// The order they are taken from; zero if there are none.
    pub order: usize,
    /// Singular values of the block Hankel matrix, descending: as many as the highest order, fewer if the
    /// rest is rounding.
    pub singular_values: Vec<f64>,
    /// Poles of all orders.
    pub chart: Vec<ChartOrder>,
}

/// Identifies the modes in `options.band` from free decays `records[input][output]`, all of the
/// same number of samples, `interval` s apart, from the same moment after each input's pulse.
///
/// ERA with a balanced realisation (Juang & Pappa, J. Guidance 8, 1985). The order is the one with most poles
/// that are stable over `options.persistence` orders; these poles are the modes.
///
/// # Errors
/// For unusable records or options, and decompositions that fail. Finding no mode is not an error.
pub fn identify(
    records: &[Vec<Vec<f64>>],
    interval: f64,
    options: &Options,
) -> Result<Identification, IdentifyError> {
    let records = Records::new(records, interval, options)?;
    let matrices = compressed(&records, options);
    let realisation = Realisation::new(&matrices, records.outputs, options.highest_order)?;
    let chart = chart(&realisation, &records, options)?;
    let chosen = selection(&chart, realisation.complete, options);
    let (order, modes) = match chosen {
        Some(Selection { order, poles }) => {
            let ChartOrder { order, poles: all } = &chart[order];
            let poles: Vec<&Pole> = poles.iter().map(|&j| &all[j]).collect();
            (*order, modes(&poles, &records, options)?)
        }
        None => (0, Vec::new()),
    };
    Ok(Identification { modes, order, singular_values: realisation.sigma, chart })
}
