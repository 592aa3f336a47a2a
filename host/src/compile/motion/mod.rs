//! Motion: tracks as sections, and the room that they take.
//!
//! | file | what it holds |
//! |---|---|
//! | `tracks/` | tracks as records: times in ticks, values as integers |
//! | `joints.rs` | joints as records |
//! | `morph.rs` | morph targets: motions of vertices, and weights |
//! | `reach.rs` | the box that instances sweep with their joints |
//! | `room.rs` | the extent and the boxes, wider by what moves |

pub mod joints;
pub mod morph;
pub mod reach;
pub mod room;
pub mod tracks;
