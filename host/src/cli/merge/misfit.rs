//! Inputs that do not belong together.

use crate::cli::failure::Failure;
use std::fmt::Display;
use std::path::PathBuf;

/// Returns the failure that two inputs do not belong together.
pub fn misfit(inputs: &[PathBuf], both: [usize; 2], error: &dyn Display, remedy: &str) -> Failure {
    let [one, other] = both.map(|number| inputs[number].display());
    Failure::failed(format!("{one} and {other} do not fit: {error}"), remedy)
}
