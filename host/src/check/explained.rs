//! Errors within sentences.

use miette::Diagnostic;

/// An error and its remedy in one sentence.
pub(super) fn explained(error: &(impl Diagnostic + std::fmt::Display)) -> String {
    match error.help() {
        Some(help) => format!("{error}; {help}"),
        None => error.to_string(),
    }
}
