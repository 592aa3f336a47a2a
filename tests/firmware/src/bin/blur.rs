//! Renders the scene with the shutter open while a camera turns, into the file `blur.rgb` of the host.
#![no_std]
#![no_main]

use gridel_core::render::Shutter;
use gridel_core::{NoCount, Scene, Settings};
use gridel_firmware::board::File;
use gridel_firmware::measure::{Cost, Meter};
use gridel_firmware::orbit::{MOMENTS, SAMPLES, camera};
use gridel_firmware::program;
use gridel_firmware::report::{cost, fail, line};
use gridel_firmware::scene::{BLOB, PictureMemory, SceneRenderer, load};

/// Pixels that are measured together.
const PART: usize = 4;

program!(run, PictureMemory);

fn run(memory: &'static mut PictureMemory) {
    let meter = Meter::new();
    let Ok(scene) = load(BLOB) else {
        fail("the blob is rejected")
    };
    let settings = Settings {
        samples: SAMPLES,
        ..Settings::of(&scene)
    };
    let mut views = [*scene.view(); MOMENTS];
    for (moment, view) in (0..).zip(&mut views) {
        let Some(camera) = camera(&scene, moment) else {
            fail("the camera is rejected")
        };
        *view = camera.view(&scene);
    }
    let mut scenes = [scene; MOMENTS];
    for (seen, view) in scenes.iter_mut().zip(&views) {
        let Ok(moved) = scene.with_view(view) else {
            fail("the view is rejected")
        };
        *seen = moved;
    }
    let renderer = |scene| {
        let made = SceneRenderer::with_settings(scene, settings);
        made.unwrap_or_else(|_| fail("the scene is not for this renderer"))
    };
    let [a, b, c, d]: &[Scene<'_>; MOMENTS] = &scenes;
    let renderers = [renderer(a), renderer(b), renderer(c), renderer(d)];
    let Ok(shutter) = Shutter::new(&renderers) else {
        fail("the moments are rejected")
    };
    let Some(file) = File::create(c"blur.rgb") else {
        fail("blur.rgb cannot be created")
    };
    let PictureMemory { space, row } = memory;
    let mut space = space.as_view();
    let mut picture = Cost::NONE;
    for y in 0..settings.height {
        // In parts that the slowest core ends before the counter wraps.
        for (x, part) in (0..settings.width).step_by(PART).zip(row.chunks_mut(PART)) {
            let cost = meter.run(|| shutter.row(x, y, part, &mut space, &mut NoCount));
            picture = picture.then(cost);
        }
        if !row.iter().all(|pixel| file.write(&pixel.0)) {
            fail("blur.rgb cannot be written to")
        }
    }
    line("moments-bytes", size_of_val(&renderers) as u64);
    cost("picture-instructions", "picture-stack-bytes", picture);
}
