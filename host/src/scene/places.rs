//! Places of a scene's lights and settings, which call for effects.

use super::source_span::SourceSpan;

/// The places at which files state the lights and settings of a scene, for messages. An unknown place is the default
/// one.
/// Objects and materials have places of their own.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Places {
    /// In the order of the lights; missing at the end where they are not known.
    pub lights: Vec<SourceSpan>,
    /// The camera's aperture.
    pub aperture: SourceSpan,
    pub environment: SourceSpan,
    pub bounces: SourceSpan,
    pub tone_mapping: SourceSpan,
}

impl Places {
    /// The place of a light.
    pub(crate) fn light(&self, number: usize) -> SourceSpan {
        self.lights.get(number).cloned().unwrap_or_default()
    }
}
