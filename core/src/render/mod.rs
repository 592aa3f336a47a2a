//! Pictures: from a pixel to rays, through what they meet, and back to a pixel.
//!
//! | step | file |
//! |---|---|
//! | a camera that the program places | `camera.rs` |
//! | where in the pixel, and in which direction | `sample.rs`, `pixel_rays.rs` |
//! | what the ray and those it causes bring | `trace.rs` |
//! | without a choice of format, structure and effects | `defaults.rs` |
//! | the samples of a pixel, all pixels of a rectangle | `samples.rs`, `rows.rs` |
//! | where rendering is between two calls | `cursor.rs` |
//! | onto a display of `embedded-graphics`, where the feature is on | `display.rs` |
//! | from radiance to the bytes of a display | `pixel.rs` |

mod camera;
mod cursor;
#[cfg(feature = "all-structures")]
mod defaults;
#[cfg(feature = "embedded-graphics-core")]
mod display;
mod pixel;
mod pixel_rays;
mod renderer;
mod rows;
mod sample;
mod samples;
mod trace;

pub use camera::{Camera, CameraError, Up};
pub use cursor::Cursor;
pub use pixel::{Pixel, Rgb565, Rgb888};
pub use renderer::{RenderError, Renderer, Settings};
pub use trace::{Workspace, WorkspaceView};
