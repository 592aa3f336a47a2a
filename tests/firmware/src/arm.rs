//! The joints of an arm, bent further frame by frame; for programs of boards and, to the bit, for the host.

use gridel_core::{Angle, BlobError, Motion, Position, Tracks};

/// Frames of the arm's way.
pub const FRAMES: u32 = 8;

/// Writes the motions of all joints in a frame: the first turns about the axis that points up, the others bend.
pub fn bend(tracks: &Tracks<'_>, frame: u32, motions: &mut [Motion]) -> Result<(), BlobError> {
    let joints = tracks.joints().iter().zip(motions.iter_mut());
    for ((joint, motion), number) in joints.zip(0_i32..) {
        let axis = if number == 0 { [0, 1, 0] } else { [0, 0, 1] };
        let degrees = (frame as i32).wrapping_mul(5 + number);
        let turn = Motion::turn(Position(joint.pivot), axis, Angle::degrees(degrees));
        *motion = turn.unwrap_or(Motion::REST);
    }
    tracks.chain(motions)
}

/// Where the range finder in the hand is, and where it points: along the last link, away from the joint before it.
pub fn hand(tracks: &Tracks<'_>, motions: &[Motion]) -> Option<(Position, [i32; 3])> {
    let [.., before, last] = tracks.joints() else {
        return None;
    };
    let motion = motions.last()?;
    let [from, to] = [before.pivot, last.pivot];
    let way = |axis: usize| {
        let way = i64::from(*to.get(axis)?) - i64::from(*from.get(axis)?);
        // Half of it has 31 bits, and a sign.
        Some((way >> 2) as i32)
    };
    let direction = [way(0)?, way(1)?, way(2)?];
    Some((motion.position(Position(to)), motion.direction(direction)))
}
