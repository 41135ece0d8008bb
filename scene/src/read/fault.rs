//! What is wrong with a scene file, and where.

use std::fmt;
use std::ops::Range;
use std::path::PathBuf;

/// One fault of a scene file: the key, what it holds, what it may hold and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// Full dotted path of the key, e.g. `geometry.sun.tip_diameter_mm`.
    pub key: String,
    /// What the file holds there, as written; `absent` if it holds nothing.
    pub value: String,
    /// What is allowed.
    pub allowed: String,
    /// Why: the mechanics or the convention behind the limit.
    pub why: String,
    /// Byte range in the source text to underline.
    pub span: Range<usize>,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` is {}: allowed: {} ({})", self.key, self.value, self.allowed, self.why)
    }
}

/// Why a scene could not be read.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The file could not be read.
    #[error("scene file `{}` cannot be read: {cause}", path.display())]
    Unreadable {
        /// The path asked for.
        path: PathBuf,
        /// Error of the operating system.
        #[source]
        cause: std::io::Error,
    },
    /// The file was read and is not a valid scene; every fault found is here.
    #[error("{} fault{} in the scene: {}", faults.len(), if faults.len() == 1 { "" } else { "s" }, join(faults))]
    Invalid {
        /// Source text the spans of `faults` point into.
        text: String,
        /// Every fault, in the order of the file.
        faults: Vec<Fault>,
    },
}

/// What is wrong with a scene that was built in a program: the faults that its file would have.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{} fault{} in the scene: {}", .0.len(), if .0.len() == 1 { "" } else { "s" }, join(.0))]
pub struct SceneFaults(pub Vec<Fault>);

/// The text with every control character but line ends and tabs replaced, byte for byte, so that it can be
/// shown on a terminal and spans into it stay valid.
pub(crate) fn printable(text: &str) -> String {
    let is_line_end = |at: usize| text[at + 1..].starts_with('\n');
    text.char_indices()
        .map(|(at, c)| match c {
            '\n' | '\t' => c,
            '\r' if is_line_end(at) => c,
            // U+0080 to U+009F have two bytes, as `¿`; all others have one.
            c if c.is_control() => {
                if c.len_utf8() == 2 {
                    '¿'
                } else {
                    '?'
                }
            }
            c => c,
        })
        .collect()
}

fn join(faults: &[Fault]) -> String {
    faults.iter().map(Fault::to_string).collect::<Vec<_>>().join("; ")
}

impl SceneError {
    /// The faults, empty when the file could not be read at all.
    pub fn faults(&self) -> &[Fault] {
        match self {
            Self::Unreadable { .. } => &[],
            Self::Invalid { faults, .. } => faults,
        }
    }
}
