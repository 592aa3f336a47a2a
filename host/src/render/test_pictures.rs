//! Small pictures of scene files, for the tests of linear pictures and AOVs.

use super::Job;
use crate::blob::Blob;
use crate::compile::{Options, compile};
use crate::scene;
use gridel_core::{Format, Scene, Settings, Structure};

pub(super) const WIDTH: u16 = 33;
pub(super) const HEIGHT: u16 = 25;

/// The place of the pixel in the middle.
pub(super) const MIDDLE: usize = WIDTH as usize * HEIGHT as usize / 2;

/// The structures that a picture is compared through: all that the blobs hold except the one that
/// [`job`] takes.
pub(super) const OTHERS: [Structure; 3] = [Structure::List, Structure::Wide, Structure::Flagged];

/// The blob of a scene file of this name.
pub(super) fn blob(name: &str, text: &str) -> Blob {
    let read = scene::read(name.as_ref(), text.into(), &Default::default());
    let options = Options {
        structures: vec![Structure::DualSplit, Structure::Wide, Structure::Flagged],
        ..Options::default()
    };
    let compiled = compile(&read.expect("a scene").scene, &options);
    compiled.expect("a blob").blob
}

/// Returns a picture with this many samples per pixel.
pub(super) fn job(scene: &Scene<'_>, format: Format, samples: u16) -> Job {
    let settings = Settings {
        width: WIDTH,
        height: HEIGHT,
        samples,
        ..Settings::of(scene)
    };
    Job::whole(format, Structure::DualSplit, settings)
}
