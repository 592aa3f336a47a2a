//! Pictures: from pixels to rays, and from radiance to pixels.
//!
//! | step | file |
//! |---|---|
//! | a camera that the program places | `camera.rs` |
//! | settings, checked against the scene, and a pixel | `renderer.rs` |
//! | the ray with which a sample begins | `start.rs` |
//! | the point of a sample in its pixel, and the direction of its ray | `sample_pattern.rs`, `pixel_rays.rs` |
//! | the radiance of a ray, with its secondary rays | `trace.rs` |
//! | the rays that wait, and their memory | `workspace.rs` |
//! | how far samples are apart | `spread.rs` |
//! | renderers without a choice of format, structure and effects | `defaults.rs` |
//! | the samples of a pixel, the pixels of a rectangle | `pixel_samples.rs`, `pixels.rs` |
//! | how bright a sample can be | `headroom.rs` |
//! | the moments while a shutter is open | `shutter.rs` |
//! | the state of rendering between two calls | `cursor.rs` |
//! | pixels row by row, or from coarse to fine | `order.rs` |
//! | displays of `embedded-graphics`, with that feature | `display.rs` |
//! | from radiance to the bytes of a display | `encoding.rs` |

mod camera;
mod cursor;
#[cfg(feature = "all-structures")]
mod defaults;
#[cfg(feature = "embedded-graphics-core")]
mod display;
mod encoding;
mod headroom;
mod order;
mod pixel_rays;
mod pixel_samples;
mod pixels;
mod renderer;
mod sample_pattern;
mod shutter;
mod spread;
mod start;
mod trace;
pub(crate) mod workspace;

pub use camera::{Camera, CameraError, Up};
pub use cursor::Cursor;
pub use encoding::{Pixel, Rgb565, Rgb888};
pub use order::{Block, CoarseToFine, Rows};
pub use renderer::{RenderError, Renderer, Settings};
pub use shutter::Shutter;
pub use workspace::{Workspace, WorkspaceView};
