//! What the compiler of blobs shares with this crate, and tests ask. No part of the public interface: it changes
//! without notice.

pub use crate::accel::candidates::ray_classes::{ClassPoint, ClassRange};
pub use crate::accel::cells::grid::MARGIN;
pub use crate::accel::cells::lists::{Divisions, cells_of, divide};
pub use crate::accel::cells::octree::MOST_LEVELS;
pub use crate::accel::cull::{Cull, Culling, PairCulling};
pub use crate::accel::hierarchy::bvh::walk as walk_bvh;
pub use crate::accel::hierarchy::direction::{DIRECTION_COUNTS, DIRECTIONS};
pub use crate::accel::hierarchy::reach::Reach;
pub use crate::accel::hierarchy::slabs::Volume;
