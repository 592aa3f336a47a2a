//! The boards: how each counts instructions.

mod mps2;

pub use mps2::Counter;
