//! Renders the scene in every number format through every structure that the blob holds, into the
//! file `pictures.rgb`, one picture behind the other. The feature of a format says nothing here.
#![no_std]
#![no_main]

use gridel_core::accel::DynAccel;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::{
    Effects, Fixed, NoCount, Number, Renderer, Rgb888, Scene, Settings, Structure, Workspace,
};
use gridel_firmware::board::File;
use gridel_firmware::program;
use gridel_firmware::report::{fail, line, words};
use gridel_firmware::scene::{BLOB, WIDTH};

type Space<N> = Workspace<N, MAX_STACK_DEPTH, { Effects::MAX_WORK_DEPTH }>;

struct Memory {
    fixed: Space<Fixed>,
    single: Space<f32>,
    double: Space<f64>,
    row: [Rgb888; WIDTH],
}

impl Memory {
    const fn new() -> Self {
        Self {
            fixed: Space::new(),
            single: Space::new(),
            double: Space::new(),
            row: [Rgb888([0; 3]); WIDTH],
        }
    }
}

program!(run, Memory);

fn run(memory: &'static mut Memory) {
    let scene = match Scene::from_bytes(BLOB) {
        Ok(scene) => scene,
        Err(error) => {
            words(format_args!("{error}\n"));
            fail("the blob is rejected")
        }
    };
    let Some(file) = File::create(c"pictures.rgb") else {
        fail("pictures.rgb cannot be created")
    };
    let Memory {
        fixed,
        single,
        double,
        row,
    } = memory;
    let held = || {
        let all = Structure::ALL.into_iter();
        all.filter_map(|structure| scene.choose(structure))
    };
    line("structures", held().count() as u64);
    for scene in held() {
        render(&scene, fixed, row, &file);
    }
    for scene in held() {
        render(&scene, single, row, &file);
    }
    for scene in held() {
        render(&scene, double, row, &file);
    }
}

fn render<N: Number>(
    scene: &Scene<'static>,
    space: &mut Space<N>,
    row: &mut [Rgb888; WIDTH],
    file: &File,
) {
    let settings = Settings::of(scene);
    let renderer = Renderer::<N, DynAccel, { Effects::ALL.0 }>::with_settings(scene, settings);
    let Ok(renderer) = renderer else {
        fail("the scene is not for this renderer")
    };
    let mut space = space.as_view();
    for y in 0..settings.height {
        renderer.row(0, y, row, &mut space, &mut NoCount);
        if !row.iter().all(|pixel| file.write(&pixel.0)) {
            fail("pictures.rgb cannot be written to")
        }
    }
}
