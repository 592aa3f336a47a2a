//! Turns a camera once around the scene, renders a frame at each of 64 places into the file `orbit.rgb` of
//! the host, and measures what a frame costs before its first ray.
#![no_std]
#![no_main]

use gridel_core::{NoCount, Settings};
use gridel_firmware::board::File;
use gridel_firmware::measure::{Cost, Meter};
use gridel_firmware::orbit::{FRAMES, camera};
use gridel_firmware::program;
use gridel_firmware::report::{cost, fail, line};
use gridel_firmware::scene::{BLOB, PictureMemory, SceneRenderer, Space, load};

/// Pixels that are measured together.
const PART: usize = 16;

program!(run, PictureMemory);

fn run(memory: &'static mut PictureMemory) {
    let meter = Meter::new();
    let Ok(scene) = load(BLOB) else {
        fail("the blob is rejected")
    };
    let settings = Settings::of(&scene);
    let PictureMemory { space, row } = memory;
    let mut space = space.as_view();
    let Some(file) = File::create(c"orbit.rgb") else {
        fail("orbit.rgb cannot be created")
    };
    let (mut placing, mut picture) = (Cost::NONE, Cost::NONE);
    for frame in 0..FRAMES {
        let (mut view, mut seen, mut renderer) = (None, None, None);
        let placed = meter.run(|| view = camera(&scene, frame).map(|it| it.view(&scene)));
        let Some(view) = &view else {
            fail("the camera is rejected")
        };
        let checked = meter.run(|| seen = scene.with_view(view).ok());
        let Some(seen) = &seen else {
            fail("the view is rejected")
        };
        let set_up = meter.run(|| renderer = SceneRenderer::with_settings(seen, settings).ok());
        let Some(renderer) = &renderer else {
            fail("the scene is not for this renderer")
        };
        placing = placing.then(placed).then(checked).then(set_up);
        for y in 0..settings.height {
            // In parts that the slowest core ends before the counter wraps.
            for (x, part) in (0..settings.width).step_by(PART).zip(row.chunks_mut(PART)) {
                let cost = meter.run(|| renderer.row(x, y, part, &mut space, &mut NoCount));
                picture = picture.then(cost);
            }
            if !row.iter().all(|pixel| file.write(&pixel.0)) {
                fail("orbit.rgb cannot be written to")
            }
        }
    }
    line("workspace-bytes", size_of::<Space>() as u64);
    line("row-bytes", size_of_val(row) as u64);
    let (placing, picture) = (placing.each(FRAMES), picture.each(FRAMES));
    cost("frame-instructions", "frame-stack-bytes", placing);
    cost("picture-instructions", "picture-stack-bytes", picture);
}
