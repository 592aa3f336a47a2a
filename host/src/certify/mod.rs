//! Certified pixels: the exact picture that a blob defines, enclosed pixel by pixel.
//!
//! A blob defines one exact picture: its lattice geometry, camera, samples, lights and effects, evaluated in real
//! arithmetic. Here every number is an interval that contains the exact one, so a pixel whose interval gives one 8-bit
//! value is *proved*. Pixels that stay open are evaluated again with 128 and 256 bits.
//!
//! The exact picture is the *sampled* one, with the stated samples per pixel, and not the integral behind it. Where a
//! kernel starts a ray beside a surface, by the error bound of the hit, the exact ray starts on it, and does not meet it
//! there again. Of hits at one and the same t, the one that comes first in the scene file counts.
//!
//! | file | what is in it |
//! |---|---|
//! | `number.rs` | what a number that encloses another one can do |
//! | `interval.rs`, `deep.rs` | intervals of double precision; balls of 128 and 256 bits |
//! | `world.rs` | a blob's integers |
//! | `tree.rs` | a hierarchy of boxes around them |
//! | `crossing.rs`, `shapes.rs`, `cone.rs`, `torus.rs` | where rays cross primitives |
//! | `hit.rs`, `search.rs` | hits, and every crossing that may be the nearest |
//! | `trace.rs`, `light.rs`, `shade.rs` | the rays of a sample, and the rules of effects |
//! | `reason.rs` | why a pixel is open |
//! | `picture.rs` | pixels, with more bits where that is needed |
//! | `report.rs`, `page.rs` | what was found |

mod cone;
mod crossing;
mod deep;
mod hit;
mod interval;
mod light;
mod number;
mod page;
mod paint;
mod picture;
mod reason;
mod report;
mod search;
mod shade;
mod shapes;
mod torus;
mod trace;
mod tree;
mod world;

pub use page::{Pictures, page, sentence};
pub use picture::{Enclosed, LEVELS, code, enclose, explain, linear};
pub use reason::Reason;
pub use report::{FormatReport, OpenPixel, OpenPixels, Report, Width, certify, exact_picture, map};
pub use search::{Open, Step};
pub use world::{NONE, Unknown, World};
