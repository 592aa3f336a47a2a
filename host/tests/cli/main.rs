//! The program as its users see it: verbs, files, exit codes.

mod program;

mod build;
mod check;
mod compare;
mod ending;
mod inspect;
mod merge;
mod render;
mod sample;
mod trace;
