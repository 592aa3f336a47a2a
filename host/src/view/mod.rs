//! Views a scene live: a camera that mouse and keys move, and pictures that appear from coarse to fine.
//!
//! | file | what is in it |
//! |---|---|
//! | `motion.rs` | orbits, pans and zooms of a camera |
//! | `keys.rs` | keys and what they do |
//! | `state.rs` | the camera and the settings that are shown |
//! | `shot.rs` | a picture to draw |
//! | `blocks.rs` | its pixels, one by one |
//! | `refine.rs` | pictures from coarse to fine, drawn by threads of their own |
//! | `frame.rs` | the pixels that are shown so far |
//! | `summary.rs` | the explanation of a pixel in one line |
//! | `notes.rs` | what a saved camera says about its scene |
//! | `save.rs` | a camera as TOML |
//! | `terminal.rs` | half blocks in a terminal |
//! | `terminal_keys.rs` | keys as terminals send them |
//! | `window.rs` | a window, with the Cargo feature `view` |
//! | `clicks.rs` | explanations of the pixels that are clicked in it |
//! | `writer.rs` | texts on standard output beside it |

mod blocks;
#[cfg(feature = "view")]
mod clicks;
mod frame;
mod keys;
mod motion;
mod notes;
mod refine;
mod save;
mod shot;
mod state;
mod summary;
pub mod terminal;
mod terminal_keys;
#[cfg(feature = "view")]
pub mod window;
#[cfg(feature = "view")]
mod writer;

pub use blocks::{Drawn, draw};
pub use frame::Frame;
pub use keys::{Action, KEYS, Key, action, key_help};
pub use notes::Notes;
pub use refine::Refiner;
pub use save::{save, saved};
pub use shot::{Shot, ViewError};
pub use state::{Effect, State};
pub use summary::summary;

#[cfg(test)]
mod test_scene {
    use crate::blob::Blob;
    use crate::compile::{Options, compile};
    use gridel_core::Structure;

    /// `fixtures/quick.toml`, with two hierarchies.
    pub fn quick() -> Blob {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/quick.toml");
        let scene = crate::scene::load(folder.as_ref(), &Default::default())
            .unwrap()
            .scene;
        let options = Options {
            structures: vec![Structure::Bvh, Structure::DualSplit],
            ..Options::default()
        };
        compile(&scene, &options).unwrap().blob
    }
}
