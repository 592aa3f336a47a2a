//! The keys of an object in a scene file, as shapes read them.

use glam::DVec3;

pub trait Keys {
    type Error;

    /// An error unless there is a key.
    fn require(&self, key: &'static str) -> Result<(), Self::Error>;

    /// Three finite numbers.
    fn point(&self, key: &'static str) -> Result<DVec3, Self::Error>;

    /// Three finite numbers that are not all 0.
    fn direction(&self, key: &'static str) -> Result<DVec3, Self::Error>;

    /// A finite number above 0.
    fn length(&self, key: &'static str) -> Result<f64, Self::Error>;

    /// Returns the error for a key with an invalid value: the cause, and the remedy.
    fn error(&self, key: &'static str, cause: String, remedy: &str) -> Self::Error;
}
