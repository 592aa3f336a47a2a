//! Renders over and over and talks to nobody: its ELF holds what a product's would.
#![no_std]
#![no_main]

use core::hint::black_box;
use gridel_core::{NoCount, Rgb565, Settings};
use gridel_firmware::program;
use gridel_firmware::scene::{BLOB, PartViews, SceneRenderer, Space, WIDTH};

struct Memory {
    space: Space,
    row: [Rgb565; WIDTH],
    parts: PartViews,
}

impl Memory {
    const fn new() -> Self {
        Self {
            space: Space::new(),
            row: [Rgb565(0); WIDTH],
            parts: PartViews::new(),
        }
    }
}

program!(run, Memory);

fn run(memory: &'static mut Memory) {
    loop {
        render(memory);
    }
}

fn render(memory: &mut Memory) {
    let Memory { space, row, parts } = memory;
    let Ok(scene) = parts.load(black_box(BLOB)) else {
        return;
    };
    let settings = Settings::of(&scene);
    let Ok(renderer) = SceneRenderer::with_settings(&scene, settings) else {
        return;
    };
    let mut space = space.as_view();
    for y in 0..settings.height {
        renderer.row(0, y, row, &mut space, &mut NoCount);
        black_box(&mut *row);
    }
}
