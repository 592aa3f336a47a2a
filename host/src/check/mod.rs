#![doc = include_str!("../../docs/CHECK.md")]

mod board;
mod certified;
mod diff;
mod image;
mod junit;
mod manifest;
mod memory;
mod pictures;
mod recording;
mod report;
mod run;

#[cfg(test)]
mod tests;

pub use image::Image;
pub use manifest::{Board, Budget, Check, Manifest, Named, Program, Reference};
pub use recording::{Recorded, record};
pub use report::{Evidence, Figure, Finding, Outcome, Report};
pub use run::run;
