//! Errors of identification.

/// Why no modes could be identified from a set of records.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum IdentifyError {
    /// No inputs, or no outputs.
    #[error("there are no records")]
    NoRecords,
    /// An input with another number of outputs than the first.
    #[error("input {input} has {found} outputs, the first has {expected}")]
    Outputs {
        /// Index of the input.
        input: usize,
        /// Its number of outputs.
        found: usize,
        /// That of the first input.
        expected: usize,
    },
    /// A record of another length than the first.
    #[error("record {output} of input {input} has {found} samples, the first has {expected}")]
    Length {
        /// Index of the input.
        input: usize,
        /// Index of the output.
        output: usize,
        /// Its number of samples.
        found: usize,
        /// That of the first record.
        expected: usize,
    },
    /// Records too short for the filter and the block Hankel matrix.
    #[error("records of {samples} samples are too short, {needed} are needed")]
    TooShort {
        /// Samples of a record.
        samples: usize,
        /// Samples the filter, the block rows and the block columns need.
        needed: usize,
    },
    /// A sample that is not finite.
    #[error("sample {sample} of record {output} of input {input} is not finite")]
    NotFinite {
        /// Index of the input.
        input: usize,
        /// Index of the output.
        output: usize,
        /// Index of the sample.
        sample: usize,
    },
    /// All samples of all records are zero.
    #[error("all records are zero")]
    Silent,
    /// A sample interval that is not positive and finite.
    #[error("sample interval {value} s is not positive and finite")]
    Interval {
        /// The interval, s.
        value: f64,
    },
    /// A band that is not 0 ≤ low < high.
    #[error("the band from {low} to {high} Hz is not one")]
    Band {
        /// Lower end, Hz.
        low: f64,
        /// Upper end, Hz.
        high: f64,
    },
    /// A band that does not fit below half the sampling rate after decimation.
    #[error(
        "the band up to {high} Hz does not fit below {limit} Hz, half the rate of one in {stride}"
    )]
    Stride {
        /// Upper end of the band, Hz.
        high: f64,
        /// Half the sampling rate that is left, Hz.
        limit: f64,
        /// The stride.
        stride: usize,
    },
    /// An option out of its range.
    #[error("option {option} = {value} is out of range: {expected}")]
    Option {
        /// Its name.
        option: &'static str,
        /// Its value.
        value: f64,
        /// What is allowed.
        expected: &'static str,
    },
    /// Scales for another number of outputs, or one that is not positive and finite.
    #[error("the scales of the outputs must be {outputs} positive numbers")]
    Scales {
        /// Number of outputs.
        outputs: usize,
    },
    /// A singular value or eigenvalue decomposition that did not converge.
    #[error("the decomposition of a matrix of size {size} did not converge")]
    NoConvergence {
        /// Size of the matrix.
        size: usize,
    },
    /// Singular vectors or eigenvectors with too large a residual.
    #[error("the residual {residual:e} of the {of} is above {limit:e}")]
    Residual {
        /// Which vectors.
        of: &'static str,
        /// ‖Hv − σu‖ relative to the largest σ, or ‖Aψ − λψ‖ relative to ‖A‖‖ψ‖.
        residual: f64,
        /// What is allowed.
        limit: f64,
    },
}
