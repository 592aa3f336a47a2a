//! Certified pixels: the exact picture that a blob defines, enclosed pixel by pixel.
//!
//! A blob defines one exact picture: its lattice geometry, camera, samples, lights and effects, evaluated in real
//! arithmetic. Here every number is an interval that contains the exact one, so a pixel whose interval gives one 8-bit
//! value is *proved*. Pixels that stay open are evaluated again with 128 and 256 bits.
//!
//! The exact picture is the *sampled* one, with the stated samples per pixel, and not the integral behind it.
//!
//! | file | what is in it |
//! |---|---|
//! | `number.rs` | what a number that encloses another one can do |
//! | `interval.rs`, `deep.rs` | intervals of double precision; balls of 128 and 256 bits |
//! | `world.rs` | a blob's integers, and a hierarchy of boxes |
//! | `shapes.rs`, `cone.rs` | where rays cross primitives |
//! | `trace.rs`, `shade.rs` | the rays of a sample, and the rules of effects |
//! | `picture.rs` | pixels, with more bits where that is needed |

mod cone;
mod deep;
mod interval;
mod number;
mod picture;
mod shade;
mod shapes;
mod trace;
mod world;

pub use picture::{Enclosed, LEVELS, code, enclose, explain};
pub use trace::{Open, Reason, Step};
pub use world::{NONE, Unknown, World};
