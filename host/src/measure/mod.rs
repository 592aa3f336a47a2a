//! The measuring harness: errors, rays, time and bytes, the same for [`accuracy`](crate::accuracy),
//! [`compare`](crate::compare) and [`check`](crate::check). Also the cost of a scene on boards.
//!
//! | file | what it measures |
//! |---|---|
//! | `picture.rs` | a picture with its time, its rays and its tests |
//! | `rays.rs` | structures on the same rays: counts and times |
//! | `median.rs`, `time.rs` | the median of figures; the spread of repeats |
//! | `contents.rs` | what a blob holds |
//! | `bytes.rs` | the parts of a blob, and working memory |
//! | `deforming.rs` | the memory of deforming meshes |
//! | `errors.rs` | pictures and first hits against a reference; `flip.rs` and `ssim.rs` compare as eyes do |
//! | `first_hits.rs` | the part of a first hit that errors are measured by |
//! | `instances.rs` | what became of instances: primitives as stored and as placed |
//! | `board/` | boards, as data: memory, code, call stack, instructions per ray |

pub mod board;
mod bytes;
mod contents;
mod deforming;
mod errors;
mod first_hits;
mod flip;
mod instances;
mod median;
mod picture;
pub mod rays;
mod ssim;
pub mod time;

pub use bytes::{MemoryMap, Part, WorkingMemory, board_memory, working_memory};
pub use contents::{longest_leaf, structure_names};
pub use deforming::Deforming;
pub use errors::{Errors, difference_picture, rmse_and_largest};
pub use first_hits::FirstHit;
pub use instances::{InstanceCount, primitives};
pub use median::median;
pub use picture::Rendered;
