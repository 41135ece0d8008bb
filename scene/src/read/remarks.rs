//! What reading a scene file decides and notices, beside the scene and its faults.

use crate::warnings::Warning;

/// What was chosen for keys that are left out, and what the digits of the file show.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Remarks {
    /// Values of keys that the file leaves out and that follow from others.
    pub chosen: Vec<Chosen>,
    /// What was taken for zero, and why, one sentence each.
    pub notes: Vec<String>,
    /// Allowed values that are unlikely beside the digits of others.
    pub warnings: Vec<Warning>,
    /// Full dotted paths of keys in the file of which no verb that runs on the scene uses the value.
    pub idle: Vec<String>,
}

/// A value that the file leaves out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Chosen {
    /// Full dotted path of the key.
    pub key: String,
    /// The value in the unit of the key, numbers to five decimals or digits.
    pub value: String,
    /// Where it comes from.
    pub why: String,
}
