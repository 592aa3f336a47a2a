//! Errors within sentences.

use miette::Diagnostic;

/// Returns an error and its remedy in one sentence.
///
/// ```
/// use gridel_host::explained;
/// use gridel_host::scene::SceneError;
///
/// let error = SceneError::new("ball.toml".as_ref(), "the radius is -1", "make it greater than 0");
/// assert_eq!(explained(&error), "ball.toml: the radius is -1; make it greater than 0");
/// ```
pub fn explained(error: &(impl Diagnostic + std::fmt::Display)) -> String {
    match error.help() {
        Some(help) => format!("{error}; {help}"),
        None => error.to_string(),
    }
}
