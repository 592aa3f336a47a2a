//! The joints of an arm, bent further frame by frame; for programs of boards and, to the bit, for the host.

use gridel_core::{Angle, BlobError, Motion, Position, Tracks};

/// Frames of the arm's way.
pub const FRAMES: u32 = 8;

/// The joint on which the hand hangs; its fingers hang on joints behind it.
const WRIST: usize = 3;

/// Writes the motions of all joints in a frame: the first turns about the axis that points up, the others up to the
/// wrist bend.
pub fn bend(tracks: &Tracks<'_>, frame: u32, motions: &mut [Motion]) -> Result<(), BlobError> {
    for ((number, joint), motion) in (0..).zip(tracks.joints()).zip(motions.iter_mut()) {
        let axis = if number == 0 { [0, 1, 0] } else { [0, 0, 1] };
        let degrees = if number <= WRIST { 5 } else { 0 };
        let angle = Angle::degrees((frame as i32).wrapping_mul(degrees));
        *motion = Motion::turn(Position(joint.pivot), axis, angle).unwrap_or(Motion::REST);
    }
    tracks.chain(motions)
}

/// Returns the position of the range finder in the hand, beyond its fingers, and its direction: straight down.
pub fn hand(tracks: &Tracks<'_>, motions: &[Motion]) -> Option<(Position, [i32; 3])> {
    let [elbow, wrist] = [WRIST - 1, WRIST].map(|number| tracks.joints().get(number));
    let [from, to] = [elbow?.pivot, wrist?.pivot];
    let tip = |axis: usize| {
        let to = *to.get(axis)?;
        to.checked_add(to.checked_sub(*from.get(axis)?)? / 2)
    };
    let tip = Position([tip(0)?, tip(1)?, tip(2)?]);
    Some((motions.get(WRIST)?.position(tip), [0, -1, 0]))
}
