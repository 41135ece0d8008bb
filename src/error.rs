//! Errors of the command, each shown as one message.

use std::io;
use std::path::{Path, PathBuf};

use experiments::branches::BranchError;
use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteDiagnostic, NamedSource};
use scene::{Fault, SceneError};

/// What a verb returns.
pub(crate) type Result<T, E = CommandError> = std::result::Result<T, E>;

/// Why the command could not run (exit code 2).
#[derive(Debug, thiserror::Error)]
pub enum CommandError {
    /// A scene that cannot be used.
    #[error("{}: {source}", path.display())]
    Scene {
        /// Its file.
        path: PathBuf,
        /// Its faults.
        source: SceneError,
    },
    /// A valid scene that the verb cannot use.
    #[error("{}: {reason}", path.display())]
    Unfit {
        /// Its file.
        path: PathBuf,
        /// What is missing, by key.
        reason: String,
    },
    /// A study that cannot be run.
    #[error("{}: {error}", path.display())]
    Study {
        /// Its file.
        path: PathBuf,
        /// What is wrong with it, by key.
        #[source]
        error: experiments::study::StudyError,
    },
    /// A file that cannot be read or written.
    #[error("{what} `{}`: {source}", path.display())]
    File {
        /// What was tried.
        what: &'static str,
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        source: std::io::Error,
    },
    /// An argument that parses but whose value is not allowed.
    #[error("argument {argument}: {reason}")]
    Argument {
        /// Name of the argument.
        argument: &'static str,
        /// What is allowed and why.
        reason: String,
    },
    /// Results could not be written.
    #[error("results cannot be written: {0}")]
    Output(#[from] std::io::Error),
    /// A result could not be put into JSON.
    #[error("results cannot be written: {0}")]
    Json(#[from] serde_json::Error),
    /// The models or the reference data could not be used.
    #[error(transparent)]
    Validation(#[from] validation::ValidationError),
    /// A results folder cannot be read.
    #[error(transparent)]
    Folder(#[from] validation::results::FolderError),
    /// Results that can be read and not judged.
    #[error("{}: {reason}", path.display())]
    Results {
        /// The folder.
        path: PathBuf,
        /// Why not.
        reason: String,
    },
    /// A list of frequencies cannot be read.
    #[error(transparent)]
    List(#[from] validation::results::TableError),
    /// Results cannot be judged.
    #[error(transparent)]
    Judge(#[from] validation::results::JudgeError),
    /// A figure could not be saved.
    #[cfg(feature = "charts")]
    #[error(transparent)]
    Figure(#[from] crate::figures::FigureError),
    /// Modes of a linearised set could not be computed.
    #[error(transparent)]
    Modal(#[from] experiments::modal::ModalError),
    /// A model could not be set up, or steady states could not be computed or kept.
    #[error(transparent)]
    Sweep(#[from] experiments::sweep::SweepError),
    /// Branches could not be followed.
    #[error(transparent)]
    Branch(#[from] BranchError),
}

impl From<csv::Error> for CommandError {
    fn from(error: csv::Error) -> Self {
        let text = error.to_string();
        // The I/O error is kept, because a closed pipe must be told from other errors.
        Self::Output(match error.into_kind() {
            csv::ErrorKind::Io(error) => error,
            _ => std::io::Error::other(text),
        })
    }
}

/// The error for an argument whose value is not allowed.
pub(crate) fn refused(argument: &'static str, reason: impl ToString) -> CommandError {
    CommandError::Argument { argument, reason: reason.to_string() }
}

/// The error for a valid scene that a verb cannot use.
pub(crate) fn unfit(path: &Path, reason: impl ToString) -> CommandError {
    CommandError::Unfit { path: path.to_owned(), reason: reason.to_string() }
}

/// The error for a scene that FE/contact cannot use or cannot solve.
pub(crate) fn fe_refused(path: &Path) -> impl Fn(fe_contact::FeError) -> CommandError + '_ {
    |e| unfit(path, e)
}

/// The error for a file that cannot be written.
pub(crate) fn unwritten(path: &Path) -> impl Fn(io::Error) -> CommandError + '_ {
    |source| CommandError::File { what: "cannot write", path: path.into(), source }
}

/// The error for a file that cannot be read.
pub(crate) fn unread(path: &Path) -> impl Fn(io::Error) -> CommandError + '_ {
    |source| CommandError::File { what: "cannot read", path: path.into(), source }
}

impl CommandError {
    /// Whether the reader of the output closed the pipe, which is not reported as an error.
    pub fn is_closed_pipe(&self) -> bool {
        match self {
            Self::Output(e) => e.kind() == std::io::ErrorKind::BrokenPipe,
            Self::Json(e) => e.io_error_kind() == Some(std::io::ErrorKind::BrokenPipe),
            _ => false,
        }
    }

    /// The message as shown to people; scene faults with their lines underlined.
    pub fn rendered(&self) -> String {
        match self {
            Self::Scene { path, source: SceneError::Invalid { text, faults } } => {
                let name = path.display().to_string();
                let mut shown: String =
                    faults.iter().map(|fault| render_fault(&name, text, fault)).collect();
                let plural = if faults.len() == 1 { "" } else { "s" };
                shown.push_str(&format!("{name}: {} fault{plural}\n", faults.len()));
                shown
            }
            Self::Scene { source, .. } => format!("error: {source}\n"),
            other => format!("error: {other}\n"),
        }
    }
}

/// One fault with its line underlined.
fn render_fault(name: &str, text: &str, fault: &Fault) -> String {
    let title = format!("`{}` is {}", fault.key, fault.value);
    let diagnostic = MietteDiagnostic::new(title)
        .with_help(format!("allowed: {}", fault.allowed))
        .with_label(LabeledSpan::at(fault.span.clone(), fault.why.clone()));
    let report =
        miette::Report::new(diagnostic).with_source_code(NamedSource::new(name, text.to_owned()));
    let handler = GraphicalReportHandler::new_themed(GraphicalTheme::unicode()).with_width(100);
    let mut shown = String::new();
    match handler.render_report(&mut shown, report.as_ref()) {
        Ok(()) => shown + "\n",
        Err(_) => format!("{fault}\n"),
    }
}
