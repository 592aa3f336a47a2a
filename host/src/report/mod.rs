//! Charts and pictures of where work goes.

#[cfg(not(target_family = "wasm"))]
pub mod chart;
mod heat_map;

pub use heat_map::{HeatMap, work_color};
