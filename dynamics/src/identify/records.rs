//! Checked, filtered and scaled records.

use faer::c64;

use super::decimation::{filter, gain, low_pass};
use super::error::IdentifyError;
use super::options::{Options, Scaling};

/// Records ready for the block Hankel matrix.
pub(super) struct Records {
    /// Samples by input and output, each divided by both scales.
    pub values: Vec<Vec<Vec<f64>>>,
    /// Number of inputs.
    pub inputs: usize,
    /// Number of outputs.
    pub outputs: usize,
    /// Samples of every record.
    pub samples: usize,
    /// Sample interval, s.
    pub interval: f64,
    /// Scales of the outputs, in their units.
    pub output_scale: Vec<f64>,
    /// Scales of the inputs, without unit.
    pub input_scale: Vec<f64>,
    weights: Vec<f64>,
}

impl Records {
    /// Checks and prepares `raw[input][output]`.
    pub(super) fn new(
        raw: &[Vec<Vec<f64>>],
        interval: f64,
        options: &Options,
    ) -> Result<Self, IdentifyError> {
        options.check(interval)?;
        let samples = check_shape(raw)?;
        let (inputs, outputs) = (raw.len(), raw[0].len());
        let stride = options.decimation.stride();
        let half = options.filter_half_length(interval);
        let needed = options.samples_needed(interval, inputs);
        if samples < needed {
            return Err(IdentifyError::TooShort { samples, needed });
        }
        let weights = if half > 0 { low_pass(half, stride) } else { vec![1.0] };
        let mut values: Vec<Vec<Vec<f64>>> =
            raw.iter().map(|row| row.iter().map(|x| filter(x, &weights)).collect()).collect();
        let samples = samples + 1 - weights.len();
        let output_scale = output_scales(&values, &options.scaling)?;
        for row in &mut values {
            for (record, scale) in row.iter_mut().zip(&output_scale) {
                record.iter_mut().for_each(|x| *x /= scale);
            }
        }
        let input_scale = input_scales(&values)?;
        for (row, scale) in values.iter_mut().zip(&input_scale) {
            row.iter_mut().flatten().for_each(|x| *x /= scale);
        }
        Ok(Records {
            values,
            inputs,
            outputs,
            samples,
            interval,
            output_scale,
            input_scale,
            weights,
        })
    }

    /// Factor by which the filter has multiplied the amplitude of a pole.
    pub(super) fn gain(&self, s: c64) -> c64 {
        gain(&self.weights, s, self.interval)
    }
}

/// Number of samples, the same for all.
fn check_shape(raw: &[Vec<Vec<f64>>]) -> Result<usize, IdentifyError> {
    let first = raw.first().and_then(|row| row.first()).ok_or(IdentifyError::NoRecords)?;
    let expected = raw[0].len();
    for (input, row) in raw.iter().enumerate() {
        if row.len() != expected {
            return Err(IdentifyError::Outputs { input, found: row.len(), expected });
        }
        for (output, record) in row.iter().enumerate() {
            let (found, expected) = (record.len(), first.len());
            if found != expected {
                return Err(IdentifyError::Length { input, output, found, expected });
            }
            if let Some(sample) = record.iter().position(|x| !x.is_finite()) {
                return Err(IdentifyError::NotFinite { input, output, sample });
            }
        }
    }
    Ok(first.len())
}

/// Root mean square without overflow; zero for records of zeros.
fn rms<'a>(records: impl Iterator<Item = &'a Vec<f64>> + Clone) -> f64 {
    let peak = records.clone().flatten().fold(0.0f64, |a, x| a.max(x.abs()));
    if peak == 0.0 {
        return 0.0;
    }
    let (mut sum, mut count) = (0.0, 0.0);
    for x in records.flatten() {
        sum += (x / peak).powi(2);
        count += 1.0;
    }
    peak * f64::sqrt(sum / count)
}

fn output_scales(values: &[Vec<Vec<f64>>], scaling: &Scaling) -> Result<Vec<f64>, IdentifyError> {
    let outputs = values[0].len();
    match scaling {
        Scaling::Given(scales) => {
            let sound = scales.len() == outputs && scales.iter().all(|s| *s > 0.0 && s.is_finite());
            if sound { Ok(scales.clone()) } else { Err(IdentifyError::Scales { outputs }) }
        }
        Scaling::Rms => {
            let scale = |o: usize| rms(values.iter().map(|row| &row[o]));
            // An output of zeros needs no scale.
            Ok((0..outputs).map(scale).map(|s| if s > 0.0 { s } else { 1.0 }).collect())
        }
    }
}

/// Root mean squares of the responses to each input over the scaled outputs; a response below 1e-9 of the
/// largest is rounding and is not scaled up.
fn input_scales(values: &[Vec<Vec<f64>>]) -> Result<Vec<f64>, IdentifyError> {
    let scales: Vec<f64> = values.iter().map(|row| rms(row.iter())).collect();
    let largest = scales.iter().fold(0.0f64, |a, s| a.max(*s));
    if !(largest > 0.0 && largest.is_finite()) {
        return Err(IdentifyError::Silent);
    }
    Ok(scales.iter().map(|s| if *s > 1e-9 * largest { *s } else { largest }).collect())
}

#[cfg(test)]
mod tests {
    use super::super::options::Decimation;
    use super::*;

    /// Two inputs, three outputs, 2000 samples of a decay.
    fn sound() -> Vec<Vec<Vec<f64>>> {
        let decay: Vec<f64> =
            (0..2000).map(|k| (-0.002 * k as f64).exp() * (0.1 * k as f64).cos()).collect();
        vec![vec![decay; 3]; 2]
    }

    fn refusal(raw: &[Vec<Vec<f64>>], interval: f64, options: &Options) -> IdentifyError {
        match Records::new(raw, interval, options) {
            Ok(_) => panic!("not refused"),
            Err(error) => error,
        }
    }

    #[test]
    fn unusable_records_are_refused() {
        let options = Options::new((10.0, 1000.0), 10);
        assert!(Records::new(&sound(), 1e-5, &options).is_ok());
        let refused = |raw: &[Vec<Vec<f64>>]| refusal(raw, 1e-5, &options);
        assert_eq!(refused(&[]), IdentifyError::NoRecords);
        assert_eq!(refused(&[vec![]]), IdentifyError::NoRecords);
        let mut raw = sound();
        raw[1].pop();
        let (input, found, expected) = (1, 2, 3);
        assert_eq!(refused(&raw), IdentifyError::Outputs { input, found, expected });
        let mut raw = sound();
        raw[1][2].pop();
        let (output, found, expected) = (2, 1999, 2000);
        assert_eq!(refused(&raw), IdentifyError::Length { input, output, found, expected });
        let mut raw = sound();
        raw[0][1][7] = f64::INFINITY;
        let expected = IdentifyError::NotFinite { input: 0, output: 1, sample: 7 };
        assert_eq!(refused(&raw), expected);
        let short: Vec<Vec<Vec<f64>>> =
            sound().iter().map(|row| row.iter().map(|x| x[..500].to_vec()).collect()).collect();
        assert!(matches!(refused(&short), IdentifyError::TooShort { samples: 500, .. }));
        assert_eq!(refused(&vec![vec![vec![0.0; 2000]; 2]; 2]), IdentifyError::Silent);
    }

    #[test]
    fn unusable_scales_are_refused() {
        let usual = Options::new((10.0, 1000.0), 10);
        for scales in [vec![1.0; 2], vec![1.0, 0.0, 1.0], vec![1.0, f64::NAN, 1.0]] {
            let options = Options { scaling: Scaling::Given(scales), ..usual.clone() };
            assert_eq!(refusal(&sound(), 1e-5, &options), IdentifyError::Scales { outputs: 3 });
        }
    }

    /// Sizes beyond any record end in an error, not in an overflow or a lack of memory.
    #[test]
    fn absurd_sizes_are_too_much_for_any_record() {
        let usual = Options { band: (0.0, 1e-300), ..Options::new((0.0, 1.0), 1) };
        let many = usize::MAX / 2;
        for options in [
            Options { block_rows: many, ..usual.clone() },
            Options { highest_order: many, ..usual.clone() },
            Options { decimation: Decimation::Filtered { stride: many }, ..usual.clone() },
            Options { decimation: Decimation::Plain { stride: many }, ..usual.clone() },
        ] {
            let found = refusal(&sound(), 1e-5, &options);
            assert!(matches!(found, IdentifyError::TooShort { .. }), "{found}");
        }
    }
}
