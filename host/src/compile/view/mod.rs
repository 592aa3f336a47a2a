//! The camera, and the integer coordinates in which it stands.
//!
//! | file | what it holds |
//! |---|---|
//! | `framing.rs` | the camera and the background of a scene that states none |
//! | `coordinates.rs` | the choice of integer coordinates |
//! | `camera.rs` | the camera of a scene file in these coordinates |

pub mod camera;
pub mod coordinates;
pub mod framing;
