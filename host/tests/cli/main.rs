//! The program as its users see it: commands, files, exit codes.

mod program;

mod accuracy;
mod build;
mod certify;
mod check;
mod compare;
mod ending;
mod explain;
mod frames;
mod help;
mod import;
mod inspect;
mod instances;
mod joints;
mod linear;
mod live;
mod memory_report;
mod merge;
mod morph;
mod names;
mod options;
mod pipe;
mod plane;
mod readme;
mod render;
mod sample;
#[cfg(feature = "shell")]
mod shell;
mod shutter;
mod terminal;
mod trace;
mod view;
