//! What the firmware's programs share: the scene in flash, the board, and measuring on it.
//!
//! | program | what it does |
//! |---|---|
//! | `picture` | renders the scene's picture to a file on the host |
//! | `primary` | traces one ray a pixel and counts the hits |
//!
//! Both print what they measured, a line each: a name, a number, a unit. The format, the structure
//! and the blob are chosen when they are built: see `Cargo.toml` and `build.rs`.
#![no_std]

pub mod board;
pub mod measure;
pub mod scene;
