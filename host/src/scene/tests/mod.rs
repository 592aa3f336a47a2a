//! Tests of all importers, and what tests of single importers share.

pub(crate) mod chains;
mod damaged;
mod long_words;
mod malformed;
pub(in crate::scene) mod samples;
