//! The arithmetic of a kernel, in three number formats.
//!
//! Every kernel is written once, over [`Number`](crate::accel::Number), and reads the same in `fixed`, `f32` and
//! `f64`. A number represents one of four quantities. In the float formats all four are plain floats. In [`Fixed`] each
//! has its own binary point, and the operations are defined so that the same expression keeps it:
//!
//! | quantity | unit | [`Fixed`] | range |
//! |---|---|---|---|
//! | length (coordinate, t, radius) | one step of the 16-bit box lattice, the *unit* | 13 fraction bits | +-2^18 units |
//! | ratio (slope, cosine, reflectance) | 1 | 30 fraction bits | -2 to 2 |
//! | radiance | display white | 20 fraction bits | +-2048 |
//! | [`Scalar::Wide`] (any product of two of these, a far coordinate) | | an `i64` | |
//!
//! The operator `*` multiplies by a *ratio*: length by ratio is a length, ratio by ratio a ratio, radiance by ratio a
//! radiance. Products of two lengths need [`Products::wide`].
//!
//! The operators of [`Fixed`] wrap and never panic. The ray's set-up establishes ranges (see [`crate::ray`]) and every
//! kernel keeps them, so that no kernel wraps.

mod angle;
mod arithmetic;
mod convert;
mod error_bounds;
pub(crate) mod error_free;
mod extent;
pub(crate) mod fixed;
pub(crate) mod float;
mod format;
pub mod log2;
mod powers;
mod products;
mod root;
pub(crate) mod rotation;
mod scalar;
mod vectors;

pub use angle::Angle;
pub use arithmetic::Arithmetic;
pub use convert::Convert;
pub use error_bounds::ErrorBounds;
pub(crate) use extent::{extent, far_extent, is_finite, taxicab};
pub use fixed::base::Fixed;
#[cfg(feature = "strict-ranges")]
pub use fixed::strict::let_numbers_wrap;
pub use format::Format;
pub use powers::Powers;
pub use products::Products;
pub use scalar::Scalar;
pub use vectors::Vectors;
