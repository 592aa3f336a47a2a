//! Certified pixels: the exact picture that a blob defines, enclosed pixel by pixel.
//!
//! A blob defines one exact picture: its lattice geometry, camera, samples, lights and effects, evaluated in real
//! arithmetic. Here every number is an interval that contains the exact one, so a pixel whose interval gives one 8-bit
//! value is *proved*. Pixels that stay open are evaluated again with 128 and 256 bits.
//!
//! The exact picture is the *sampled* one, with the stated samples per pixel, and not the integral behind it. A kernel
//! starts a ray off a surface, by the error bound of the hit. The exact ray starts on it, and does not hit it there
//! again. If hits have the same t, the one that comes first in the scene file counts.
//!
//! | file | what is in it |
//! |---|---|
//! | `number.rs` | what a number that encloses another one can do |
//! | `interval.rs`, `deep.rs` | intervals of double precision; balls of 128 and 256 bits |
//! | `world.rs`, `tree.rs` | a blob's integers, and a hierarchy of boxes around them |
//! | `crossing.rs`, `shapes.rs`, `cone.rs`, `torus.rs` | where rays cross primitives |
//! | `path.rs`, `camera.rs` | a ray on its way from the eye, and how it begins |
//! | `search.rs`, `nearest.rs`, `hit.rs` | crossings, those that may be the nearest, and the surface there |
//! | `trace.rs`, `surface.rs`, `light.rs`, `aim.rs`, `solid_angle.rs` | the rays of a sample, what they see, and what arrives from lights |
//! | `shade.rs`, `paint.rs`, `log2.rs`, `levels.rs`, `bump.rs`, `media.rs`, `facets.rs`, `sky.rs`, `directions.rs` | the rules of effects |
//! | `tone.rs`, `picture.rs` | from samples to pixels, with more bits where that is needed |
//! | `reason.rs`, `report.rs`, `page.rs` | why a pixel is open, and what was found |

mod aim;
mod bump;
mod camera;
mod cone;
mod crossing;
mod deep;
mod directions;
mod facets;
mod hit;
mod interval;
mod levels;
mod light;
mod log2;
mod media;
mod nearest;
mod number;
mod page;
mod paint;
mod path;
mod picture;
mod reason;
mod report;
mod search;
mod shade;
mod shapes;
mod sky;
mod solid_angle;
mod surface;
mod tone;
mod torus;
mod trace;
mod tree;
mod world;

/// Most pixels that are certified: their state takes 320 MiB.
pub const MOST_PIXELS: usize = 1 << 22;

pub use page::{Pictures, page, sentence};
pub use picture::{Enclosed, LEVELS, code, enclose, explain, linear};
pub use reason::Reason;
pub use report::{
    DifferentPixel, FormatPicture, FormatReport, OpenPixel, OpenPixels, Report, Width, certify,
    exact_picture, map, pictures,
};
pub use search::{Open, Step};
pub use world::{NONE, Unknown, World};
