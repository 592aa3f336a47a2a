#![doc = include_str!("../../docs/CHECK.md")]

mod bless;
mod board;
mod certified;
mod diff;
mod image;
mod junit;
mod manifest;
mod memory;
mod pictures;
mod report;
mod run;

#[cfg(test)]
mod tests;

pub use bless::{Blessed, bless};
pub use image::Image;
pub use manifest::{Board, Budget, Check, Manifest, Named, Program, Reference};
pub use report::{Evidence, Figure, Finding, Outcome, Report};
pub use run::run;
