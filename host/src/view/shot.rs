//! A picture to draw, and the reasons why there is none.

use gridel_core::format::record::View;
use gridel_core::render::RenderError;
use gridel_core::{BlobError, Format, Settings, Structure};

/// A picture to draw.
#[derive(Clone, Debug, PartialEq)]
pub struct Shot {
    pub view: View,
    pub format: Format,
    pub structure: Structure,
    pub settings: Settings,
    /// True if pixels show the number of tested boxes and primitives.
    pub heat_map: bool,
}

/// The reason why there is no picture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ViewError {
    #[error(transparent)]
    Render(#[from] RenderError),
    #[error(transparent)]
    Blob(#[from] BlobError),
}
