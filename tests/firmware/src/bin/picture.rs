//! Renders the scene's picture into the file `picture.rgb` of the host, row by row, and measures
//! what loading, the picture, and rays without shading take.
#![no_std]
#![no_main]

use gridel_core::{NoCount, Rgb888, Settings, Stack};
use gridel_firmware::board::File;
use gridel_firmware::measure::{Cost, Meter};
use gridel_firmware::rays::Until;
use gridel_firmware::report::{cost, fail, line};
use gridel_firmware::scene::{BLOB, STACK_DEPTH, SceneRenderer, Space, WIDTH, load};
use gridel_firmware::{program, rays};

/// Pixels that are measured together.
const PART: usize = 16;

struct Memory {
    space: Space,
    row: [Rgb888; WIDTH],
    /// The stack for rays without shading.
    stack: Stack<STACK_DEPTH>,
}

impl Memory {
    const fn new() -> Self {
        Self {
            space: Space::new(),
            row: [Rgb888([0; 3]); WIDTH],
            stack: Stack::new(),
        }
    }
}

program!(run, Memory);

fn run(memory: &'static mut Memory) {
    let meter = Meter::new();
    let mut scene = None;
    let load = meter.run(|| scene = load(BLOB).ok());
    let Some(scene) = &scene else {
        fail("the blob is rejected")
    };
    let settings = Settings::of(scene);
    let Ok(renderer) = SceneRenderer::with_settings(scene, settings) else {
        fail("the scene is not for this renderer")
    };
    let Memory { space, row, stack } = memory;
    let mut space = space.as_view();
    if renderer.check_workspace(&space).is_err() {
        fail("the workspace is too small")
    }
    let Some(file) = File::create(c"picture.rgb") else {
        fail("picture.rgb cannot be created")
    };
    let mut picture = Cost::NONE;
    for y in 0..settings.height {
        // In parts that the slowest core ends before the counter wraps.
        for (x, part) in (0..settings.width).step_by(PART).zip(row.chunks_mut(PART)) {
            let cost = meter.run(|| renderer.row(x, y, part, &mut space, &mut NoCount));
            picture = picture.then(cost);
        }
        if !row.iter().all(|pixel| file.write(&pixel.0)) {
            fail("picture.rgb cannot be written to")
        }
    }
    let stack = stack.as_view();
    let mut traced = [rays::Rays::default(); 4];
    let mut costs = [Cost::NONE; 4];
    for y in 0..settings.height {
        let parts = [
            Until::Camera,
            Until::Primitive,
            Until::Surface,
            Until::Light,
        ];
        for ((until, rays), cost) in parts.into_iter().zip(&mut traced).zip(&mut costs) {
            *cost = cost.then(meter.run(|| rays.row(until, &renderer, scene, y, stack)));
        }
    }
    let [.., traced] = traced;
    let [camera, hits, surfaces, lights] = costs;

    line("blob-bytes", BLOB.len() as u64);
    line("workspace-bytes", size_of::<Space>() as u64);
    line("row-bytes", size_of_val(row) as u64);
    cost("load-instructions", "load-stack-bytes", load);
    cost("picture-instructions", "picture-stack-bytes", picture);
    line("rays", traced.rays.into());
    line("hits", traced.hits.into());
    line("facing", traced.facing.into());
    line("shadows", traced.shadows.into());
    cost(
        "camera-instructions",
        "camera-stack-bytes",
        camera.each(traced.rays),
    );
    cost(
        "ray-instructions",
        "ray-stack-bytes",
        hits.each(traced.rays),
    );
    cost(
        "surface-instructions",
        "surface-stack-bytes",
        surfaces.beyond(hits).each(traced.hits),
    );
    cost(
        "shadow-ray-instructions",
        "shadow-ray-stack-bytes",
        lights.beyond(surfaces).each(traced.facing),
    );
}
