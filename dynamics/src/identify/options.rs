//! What to identify and how.

use super::decimation::half_length;
use super::error::IdentifyError;

/// How the records are decimated. Block rows of the Hankel matrix are `stride` samples apart; columns may
/// start at any sample, so that no sample is lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Decimation {
    /// Every `stride`-th sample, unfiltered: modes above half the new sampling rate appear at their alias
    /// frequency, possibly in the band.
    Plain {
        /// Samples from one block row to the next.
        stride: usize,
    },
    /// Low-pass filtered first. The filter uses later samples only, so that a decay stays a sum of the same
    /// exponentials; shapes are divided by its gain at each pole.
    Filtered {
        /// Samples from one block row to the next.
        stride: usize,
    },
}

impl Decimation {
    /// Samples from one block row to the next.
    pub fn stride(self) -> usize {
        match self {
            Decimation::Plain { stride } | Decimation::Filtered { stride } => stride,
        }
    }
}

/// The matrix whose singular vectors span the states.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// The block Hankel matrix itself.
    Hankel,
    /// Its correlation with the block rows before it, whose noise is independent (ERA/DC: Juang, Cooper &
    /// Wright 1988). Needs twice as many samples per column.
    Correlation,
}

/// Scales by which the outputs are divided, so that those with small numbers count as much as others.
#[derive(Debug, Clone, PartialEq)]
pub enum Scaling {
    /// Their root mean squares over all inputs. Unsuitable for outputs that are rounding errors only.
    Rms,
    /// Given numbers in the units of the outputs, best in the ratio of their noise.
    Given(Vec<f64>),
}

/// When poles of consecutive orders count as the same.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerances {
    /// |Δf| / f.
    pub frequency: f64,
    /// |Δζ| / ζ.
    pub damping: f64,
    /// 1 − MAC of the shapes, each output divided by its scale.
    pub shape: f64,
    /// |Δs| / |s| of poles at one order which count as one repeated pole, reported at their mean.
    pub repeated: f64,
}

/// What to identify and how; [`Options::new`] gives the usual values.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Lowest and highest frequency wanted, Hz.
    pub band: (f64, f64),
    /// Decimation of the records.
    pub decimation: Decimation,
    /// Number of block rows p of the Hankel matrix.
    pub block_rows: usize,
    /// Largest number of block columns, spread evenly over the records.
    pub block_columns: usize,
    /// Highest number of states of the chart, two per mode; modes outside the band count as well.
    pub highest_order: usize,
    /// Which matrix.
    pub method: Method,
    /// Scaling of the outputs.
    pub scaling: Scaling,
    /// Tolerances of the chart.
    pub tolerances: Tolerances,
    /// Orders in a row at which a pole must be stable to be a mode.
    pub persistence: usize,
    /// Modes of higher damping ratio are discarded, and so are undamped ones.
    pub highest_damping: f64,
    /// Least coherence of a mode, 0 to 1.
    pub coherence: f64,
    /// Least amplitude of a mode relative to the strongest in the band, outputs scaled.
    pub weakest: f64,
}

impl Options {
    /// The usual options for a band (Hz) and a stride (samples). To separate close modes in noise, the block
    /// rows must span a long time: half the largest stride that the band allows is a good choice.
    pub fn new(band: (f64, f64), stride: usize) -> Self {
        Options {
            band,
            decimation: Decimation::Filtered { stride },
            block_rows: 40,
            block_columns: 1000,
            highest_order: 60,
            method: Method::Hankel,
            scaling: Scaling::Rms,
            tolerances: Tolerances { frequency: 0.01, damping: 0.05, shape: 0.02, repeated: 1e-3 },
            persistence: 4,
            highest_damping: 0.2,
            coherence: 0.98,
            weakest: 1e-6,
        }
    }

    /// Number of samples, `interval` s apart, that each record of a test with `inputs` inputs must have: for
    /// the filter, the block rows, and one column per state, the fewest that can distinguish the states.
    pub fn samples_needed(&self, interval: f64, inputs: usize) -> usize {
        let blocks = match self.method {
            Method::Hankel => self.block_rows,
            Method::Correlation => self.block_rows.saturating_mul(2),
        };
        let columns = self.highest_order.div_ceil(inputs.max(1));
        let rows = blocks.saturating_mul(self.decimation.stride());
        let filter = self.filter_half_length(interval).saturating_mul(2);
        filter.saturating_add(rows).saturating_add(columns)
    }

    /// Half length of the filter, samples.
    pub(super) fn filter_half_length(&self, interval: f64) -> usize {
        match self.decimation {
            Decimation::Filtered { stride } if stride > 1 => {
                half_length(self.band.1, stride, interval)
            }
            _ => 0,
        }
    }

    /// Refuses options out of range, for records with samples `interval` s apart.
    pub(super) fn check(&self, interval: f64) -> Result<(), IdentifyError> {
        if !(interval > 0.0 && interval.is_finite()) {
            return Err(IdentifyError::Interval { value: interval });
        }
        let (low, high) = self.band;
        if !(low >= 0.0 && high > low && high.is_finite()) {
            return Err(IdentifyError::Band { low, high });
        }
        let t = &self.tolerances;
        let (positive, counted) = ("positive and finite", "at least one");
        let numbers = [
            ("tolerances.frequency", t.frequency),
            ("tolerances.damping", t.damping),
            ("tolerances.shape", t.shape),
            ("tolerances.repeated", t.repeated),
            ("highest_damping", self.highest_damping),
        ];
        for (option, value) in numbers {
            if !(value > 0.0 && value.is_finite()) {
                return Err(IdentifyError::Option { option, value, expected: positive });
            }
        }
        for (option, value) in [("coherence", self.coherence), ("weakest", self.weakest)] {
            if !(0.0..=1.0).contains(&value) {
                return Err(IdentifyError::Option { option, value, expected: "from zero to one" });
            }
        }
        let counts = [
            ("decimation.stride", self.decimation.stride()),
            ("block_rows", self.block_rows),
            ("block_columns", self.block_columns),
            ("persistence", self.persistence),
        ];
        for (option, count) in counts {
            if count == 0 {
                return Err(IdentifyError::Option { option, value: 0.0, expected: counted });
            }
        }
        let order = self.highest_order;
        if order < 2 {
            let expected = "at least two, one mode";
            return Err(IdentifyError::Option {
                option: "highest_order",
                value: order as f64,
                expected,
            });
        }
        let stride = self.decimation.stride();
        let limit = 0.5 / (stride as f64 * interval);
        // A filter needs a transition band between the band and the lowest frequency that folds into it.
        let room = if matches!(self.decimation, Decimation::Filtered { .. }) { 0.9 } else { 1.0 };
        if high > room * limit {
            return Err(IdentifyError::Stride { high, limit: room * limit, stride });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unusable_options_are_refused() {
        let usual = Options::new((10.0, 1000.0), 10);
        let refused = |options: Options| options.check(1e-5).unwrap_err();
        for (low, high) in [(-1.0, 10.0), (10.0, 10.0), (10.0, f64::INFINITY)] {
            let options = Options { band: (low, high), ..usual.clone() };
            assert_eq!(refused(options), IdentifyError::Band { low, high });
        }
        // Half the rate of one sample in 60 is 833 Hz.
        for decimation in [Decimation::Plain { stride: 60 }, Decimation::Filtered { stride: 60 }] {
            let found = refused(Options { decimation, ..usual.clone() });
            assert!(matches!(found, IdentifyError::Stride { stride: 60, .. }), "{found}");
        }
        // 1000 Hz is below 1020 Hz, but leaves no transition band for a filter.
        let decimation = Decimation::Filtered { stride: 49 };
        let found = refused(Options { decimation, ..usual.clone() });
        assert!(matches!(found, IdentifyError::Stride { stride: 49, .. }));
        let named = |options: Options, name: &str| {
            let found = refused(options);
            let IdentifyError::Option { option, .. } = found else { panic!("{name}: {found}") };
            assert_eq!(option, name);
        };
        named(Options::new((10.0, 1000.0), 0), "decimation.stride");
        named(Options { block_rows: 0, ..usual.clone() }, "block_rows");
        named(Options { block_columns: 0, ..usual.clone() }, "block_columns");
        named(Options { persistence: 0, ..usual.clone() }, "persistence");
        named(Options { highest_order: 1, ..usual.clone() }, "highest_order");
        named(Options { highest_damping: f64::NAN, ..usual.clone() }, "highest_damping");
        named(Options { coherence: 1.1, ..usual.clone() }, "coherence");
        named(Options { weakest: -0.1, ..usual.clone() }, "weakest");
        let tolerances = Tolerances { shape: 0.0, ..usual.tolerances };
        named(Options { tolerances, ..usual.clone() }, "tolerances.shape");
    }

    #[test]
    fn an_interval_must_be_positive() {
        let options = Options::new((10.0, 1000.0), 10);
        for value in [0.0, -1e-5, f64::INFINITY] {
            assert_eq!(options.check(value), Err(IdentifyError::Interval { value }));
        }
        assert_eq!(options.check(1e-5), Ok(()));
    }
}
