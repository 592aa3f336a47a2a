//! Renders from the module that `gridel build --emit-rust` wrote into the folder `GRIDEL_MODULE`,
//! into the file `picture.rgb`, and measures what loading takes.
#![no_std]
#![no_main]

mod scene {
    include!(concat!(env!("GRIDEL_MODULE"), "/scene.rs"));
}

use gridel_core::{NoCount, Rgb888, Settings};
use gridel_firmware::board::File;
use gridel_firmware::measure::Meter;
use gridel_firmware::program;
use gridel_firmware::report::{cost, fail, line};

struct Memory {
    space: scene::Space,
    row: [Rgb888; scene::WIDTH],
}

impl Memory {
    const fn new() -> Self {
        Self {
            space: scene::Space::new(),
            row: [Rgb888([0; 3]); scene::WIDTH],
        }
    }
}

program!(run, Memory);

fn run(memory: &'static mut Memory) {
    let meter = Meter::new();
    let mut loaded = None;
    let load = meter.run(|| loaded = scene::load().ok());
    let Some(scene) = &loaded else {
        fail("the blob is rejected")
    };
    let Ok(picture) = scene::Picture::with_settings(scene, Settings::of(scene)) else {
        fail("the scene is not for this renderer")
    };
    let mut space = memory.space.as_view();
    if picture.check_workspace(&space).is_err() {
        fail("the workspace is too small")
    }
    let Some(file) = File::create(c"picture.rgb") else {
        fail("picture.rgb cannot be created")
    };
    for y in 0..scene::HEIGHT as u16 {
        picture.row(0, y, &mut memory.row, &mut space, &mut NoCount);
        if !memory.row.iter().all(|pixel| file.write(&pixel.0)) {
            fail("picture.rgb cannot be written to")
        }
    }
    line("blob-bytes", scene::BLOB_BYTES as u64);
    cost("load-instructions", "load-stack-bytes", load);
}
