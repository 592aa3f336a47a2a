//! The reasons why a command ends early, and their exit codes.

use gridel_host::compile::CompileError;
use gridel_host::table::shown;
use miette::{Diagnostic, MietteHandlerOpts, Report};
use std::fmt::Display;
use std::io;
use std::path::Path;
use std::process::ExitCode;
use textwrap::{WordSeparator, WordSplitter};

/// The exit codes for scripts; the help of every command shows them.
pub const EXIT_CODES: &str = "\
Exit codes:
  0    success
  1    an input is invalid, a file cannot be read or written, a check fails, or
       there is not enough memory
  2    the command line is wrong, by itself or for this input
  3    the scene does not fit the given memory
  130  interrupted; no output is incomplete";

/// The exit code of a program that is interrupted.
pub const INTERRUPTED: i32 = 130;

/// Breaks lines of an error at spaces, and not within a path or a flag, so that these can be copied.
pub fn break_lines_at_spaces() {
    // Fails only where a handler has been set before, and then lines break as that one has it.
    let _ = miette::set_hook(Box::new(|_| {
        let options = MietteHandlerOpts::new()
            .word_separator(WordSeparator::AsciiSpace)
            .word_splitter(WordSplitter::NoHyphenation)
            .break_words(false);
        Box::new(options.build())
    }));
}

/// The reason why a command ended early.
#[derive(Debug)]
pub enum Failure {
    /// An input is broken, or a file cannot be read or written.
    Failed(Report),
    /// The command line does not fit the input.
    Usage(Report),
    /// A budget would be exceeded.
    Rejected(Report),
    /// A check does not hold, as the report says that was printed.
    Broken,
}

/// The cause of a failure, and its remedy.
#[derive(Debug, thiserror::Error, Diagnostic)]
#[error("{cause}")]
#[diagnostic(help("{remedy}"))]
struct Fault {
    cause: String,
    remedy: String,
}

/// Returns a sentence about what cannot be done with a file.
fn about(path: &Path, done: &str) -> String {
    shown(&format!("{} cannot be {done}", path.display())).into_owned()
}

fn diagnosis(cause: impl Into<String>, remedy: impl Into<String>) -> Report {
    let [cause, remedy] = [cause.into(), remedy.into()].map(|it| shown(&it).into_owned());
    Report::new(Fault { cause, remedy })
}

impl Failure {
    /// Returns a failure with its cause and remedy, sentences without capital and full stop.
    pub fn failed(cause: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self::Failed(diagnosis(cause, remedy))
    }

    /// Returns the error of a wrong command line.
    pub fn usage(cause: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self::Usage(diagnosis(cause, remedy))
    }

    /// Returns the error of a budget that would be exceeded.
    pub fn rejected(cause: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self::Rejected(diagnosis(cause, remedy))
    }

    /// Returns the error of what cannot fail.
    pub fn fault(error: impl Display) -> Self {
        Self::failed(error.to_string(), "report this as a fault of gridel")
    }

    /// Returns the error of a file that cannot be read.
    pub fn reading(path: &Path, error: &io::Error) -> Self {
        Self::failed(
            format!("{} cannot be read: {error}", path.display()),
            "check that the path names a file you may read",
        )
    }

    /// Returns the error of a file that cannot be written; an older file is unchanged.
    pub fn writing(path: &Path, error: &io::Error) -> Self {
        let remedy = match error.kind() {
            io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
                "make room, or write to another device"
            }
            io::ErrorKind::NotFound => "create the folder first",
            io::ErrorKind::AlreadyExists | io::ErrorKind::NotADirectory => {
                "name a folder: there is a file where one must be"
            }
            _ => "check that the path names a file in a folder you may write to",
        };
        Self::failed(
            format!("{} cannot be written: {error}", path.display()),
            remedy,
        )
    }

    /// Returns an error about the content of a file, which its own text does not name.
    pub fn in_file<E>(path: &Path, error: E) -> Self
    where
        E: Diagnostic + Send + Sync + 'static,
    {
        Self::Failed(Report::new(error).wrap_err(about(path, "used")))
    }

    /// Returns the error of a scene that cannot be compiled.
    pub fn compiling(path: &Path, error: CompileError) -> Self {
        let over_budget = matches!(
            error,
            CompileError::TooLarge { .. }
                | CompileError::OverBudget { .. }
                | CompileError::OverMemory { .. }
        );
        let report = Report::new(error).wrap_err(about(path, "compiled"));
        if over_budget {
            Self::Rejected(report)
        } else {
            Self::Failed(report)
        }
    }

    /// Returns the error of settings that nothing is rendered with.
    pub fn rendering(error: impl Display) -> Self {
        Self::usage(
            error.to_string(),
            "change the option, or the scene file's `[render]`",
        )
    }

    /// Prints what happened on standard error and returns the exit code.
    pub fn report(self) -> ExitCode {
        let (report, code) = match self {
            Self::Broken => return ExitCode::from(1),
            Self::Failed(report) => (report, 1),
            Self::Usage(report) => (report, 2),
            Self::Rejected(report) => (report, 3),
        };
        // Standard error may be closed; the exit code still reports the failure.
        let _ = io::Write::write_fmt(&mut io::stderr(), format_args!("{report:?}\n"));
        ExitCode::from(code)
    }
}
