#![doc = include_str!("../../docs/CHECK.md")]

mod bless;
mod board;
mod diff;
mod image;
mod junit;
mod manifest;
mod measure;
mod memory;
mod report;

#[cfg(test)]
mod tests;

pub use bless::{Blessed, bless};
pub use image::Image;
pub use manifest::{Board, Budget, Check, Manifest, Named, Program, Reference};
pub use measure::run;
pub use report::{Evidence, Figure, Finding, Outcome, Report};
