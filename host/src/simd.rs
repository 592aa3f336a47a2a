//! The instructions that queries use: the best that the processor has, unless the environment chooses.

use gridel_core::SimdLevel;
use std::sync::OnceLock;

/// The environment variable that names a level, to compare levels on one machine.
const VARIABLE: &str = "GRIDEL_SIMD";

/// Returns the level for scenes of this program.
pub fn level() -> SimdLevel {
    static LEVEL: OnceLock<SimdLevel> = OnceLock::new();
    *LEVEL.get_or_init(|| from_environment().unwrap_or_else(|_| SimdLevel::detect()))
}

/// Returns the level that the environment names, or else the processor's best.
///
/// # Errors
/// If the environment names a level that is unknown, or that this processor does not have.
pub fn from_environment() -> Result<SimdLevel, String> {
    match std::env::var_os(VARIABLE) {
        Some(name) => named(&name.to_string_lossy()),
        None => Ok(SimdLevel::detect()),
    }
}

fn named(name: &str) -> Result<SimdLevel, String> {
    let level = SimdLevel::available().find(|level| level.name() == name);
    level.ok_or_else(|| {
        let names: Vec<_> = SimdLevel::available().map(SimdLevel::name).collect();
        format!(
            "{VARIABLE} is \"{name}\"; on this processor it can be {}",
            names.join(" or ")
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_have_names_and_unknown_ones_are_rejected() {
        for level in SimdLevel::available() {
            assert_eq!(named(level.name()), Ok(level));
        }
        let error = named("sse9").unwrap_err();
        assert!(error.starts_with("GRIDEL_SIMD is \"sse9\""), "{error}");
        assert!(error.contains("portable"), "{error}");
    }
}
