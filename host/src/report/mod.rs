//! Charts, pictures of where work goes, and pieces of pages.

#[cfg(not(target_family = "wasm"))]
pub mod chart;
mod heat_map;
mod html;

pub use heat_map::{HeatMap, work_color};
pub(crate) use html::{escape, picture_url};
