//! The room of vertices that move: boxes are wider by it.

use super::hierarchy::{Primitive, bounds};
use glam::DVec3;
use gridel_core::Kind;
use gridel_core::format::record::UnitBox;

/// Returns an extent that is wider by `room` on all sides.
pub fn widened((lowest, highest): (DVec3, DVec3), room: f64) -> (DVec3, DVec3) {
    (lowest - room, highest + room)
}

/// Returns the box around all primitives, and around all places to which vertices can move by
/// `room` units.
pub fn around(primitives: &[Primitive], room: f64) -> Option<UnitBox> {
    let own = bounds(primitives)?;
    let meshes = primitives.iter().filter(|it| it.kind == Kind::Triangle);
    let meshes = meshes.map(|it| it.bounds).reduce(|a, b| a.union(&b));
    let Some(UnitBox(sides)) = meshes.filter(|_| room > 0.0) else {
        return Some(own);
    };
    // The lattice holds this; -32768 is reserved.
    let room = room.ceil().min(f64::from(u16::MAX)) as i32;
    let within = |plane: i32| plane.clamp(-i32::from(i16::MAX), i16::MAX.into()) as i16;
    let wider = sides.map(|[low, high]| {
        [
            within(i32::from(low) - room),
            within(i32::from(high) + room),
        ]
    });
    Some(own.union(&UnitBox(wider)))
}
