//! A picture to draw, and why there is none.

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
    /// Whether pixels show the boxes and primitives that they had tested.
    pub heat_map: bool,
}

/// Why there is no picture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ViewError {
    #[error(transparent)]
    Render(#[from] RenderError),
    #[error(transparent)]
    Blob(#[from] BlobError),
}
