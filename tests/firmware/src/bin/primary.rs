//! One ray per pixel, without shading: the hits, and what they cost.
#![no_std]
#![no_main]

use gridel_core::{Scene, Settings, Stack};
use gridel_firmware::measure::Meter;
use gridel_firmware::rays::Until;
use gridel_firmware::report::{cost, fail, line};
use gridel_firmware::scene::{BLOB, STACK_DEPTH, SceneRenderer, load};
use gridel_firmware::{program, rays};

type Memory = Stack<STACK_DEPTH>;

program!(run, Memory);

fn run(stack: &'static mut Memory) {
    let meter = Meter::new();
    let mut scene = None;
    let load = meter.run(|| scene = load(BLOB).ok());
    let Some(scene) = &scene else {
        fail("the blob is rejected")
    };
    line("blob-bytes", BLOB.len() as u64);
    line("workspace-bytes", size_of::<Memory>() as u64);
    // Told at once, so that it takes up no stack while rays are traced.
    cost("load-instructions", "load-stack-bytes", load);
    let mut rays = rays::Rays::default();
    let trace = meter.run(|| trace(scene, stack, &mut rays));
    line("rays", rays.rays.into());
    line("hits", rays.hits.into());
    cost("ray-instructions", "ray-stack-bytes", trace.each(rays.rays));
}

/// Traces every ray of the picture, including the set-up of the camera.
fn trace(scene: &Scene<'static>, stack: &mut Memory, rays: &mut rays::Rays) {
    let settings = Settings::of(scene);
    let Ok(renderer) = SceneRenderer::with_settings(scene, settings) else {
        fail("the scene is not for this renderer")
    };
    for y in 0..settings.height {
        rays.row(Until::Primitive, &renderer, scene, y, stack.as_view());
    }
}
