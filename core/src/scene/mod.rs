//! Scenes: a blob is checked once and then read in place.
//!
//! [`Scene::from_bytes`] calls each layer to prove its own part: the format its header and sections, the geometry its
//! primitives, the structures their trees and lists.

mod blob;
mod changes;
mod check;
mod coordinates;
pub(crate) mod environment;
mod features;
mod load;
mod lookups;
mod motion;
mod names;
pub(crate) mod parts;
mod poses;
mod prevalidated;
mod read;
pub(crate) mod textures;

pub use blob::Scene;
pub use coordinates::{Position, coordinate_steps};
pub use motion::Motion;
pub use names::Names;
pub use parts::{Parts, part_blobs};
pub use poses::{Poses, PosesView};
pub use prevalidated::Prevalidated;
pub(crate) use read::header;
pub use textures::Footprint;
