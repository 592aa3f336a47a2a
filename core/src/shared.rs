//! Items that the compiler of blobs and the tests share with this crate. Not part of the public interface: they
//! change without notice.

pub use crate::accel::candidates::lists::ListSections;
pub use crate::accel::candidates::ray_classes::{ClassPoint, ClassRange};
pub use crate::accel::candidates::{
    apex, cylinder_cube, cylinder_cube_entry, cylinder_cube_tight, ray_classes,
};
pub use crate::accel::cells::grid::MARGIN;
pub use crate::accel::cells::lists::{Divisions, cells_of, divide};
pub use crate::accel::cells::octree::MOST_LEVELS;
pub use crate::accel::cull::{Cull, Culling, PairCulling};
pub use crate::accel::hierarchy::bvh::walk as walk_bvh;
pub use crate::accel::hierarchy::direction::{DIRECTION_COUNTS, DIRECTIONS};
pub use crate::accel::hierarchy::reach::Reach;
pub use crate::accel::hierarchy::slabs::Volume;
pub use crate::render::workspace::bytes_per_ray;
