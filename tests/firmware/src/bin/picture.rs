//! Renders the scene's picture into the file `picture.rgb` in QEMU's folder, row by row.
#![no_std]
#![no_main]

use core::panic::PanicInfo;
use cortex_m_rt::entry;
use gridel_core::{NoCount, Rgb888, Scene, Settings};
use gridel_firmware::measure::{Cost, Meter};
use gridel_firmware::scene::{BLOB, SceneRenderer, Space, WIDTH};
use semihosting::fs::File;
use semihosting::io::Write;
use semihosting::println;

#[entry]
fn main() -> ! {
    static mut SPACE: Space = Space::new();
    static mut ROW: [Rgb888; WIDTH] = [Rgb888([0; 3]); WIDTH];
    let meter = Meter::default();
    let mut file = File::create(c"picture.rgb").expect("the host's file can be written to");
    let mut scene = None;
    let load = meter.run(|| scene = Scene::from_bytes(BLOB).ok());
    let scene = scene.as_ref().expect("the build script checked the blob");

    let settings = Settings::of(scene);
    let renderer = SceneRenderer::new(scene, settings).expect("the scene is for this renderer");
    let mut space = SPACE.as_view();
    renderer
        .check_workspace(&space)
        .expect("the build script sized the workspace");
    let mut picture = Cost::default();
    for y in 0..settings.height {
        let cost = meter.run(|| renderer.row(0, y, ROW, &mut space, &mut NoCount));
        picture = picture.then(cost);
        for pixel in &*ROW {
            file.write_all(&pixel.0)
                .expect("the host's file can be written to");
        }
    }
    println!("blob-bytes {}", BLOB.len());
    println!("load-instructions {}", load.instructions);
    println!("load-stack-bytes {}", load.stack);
    println!("picture-instructions {}", picture.instructions);
    println!("picture-stack-bytes {}", picture.stack);
    println!("workspace-bytes {}", size_of::<Space>());
    println!("row-bytes {}", size_of_val(ROW));
    semihosting::process::exit(0)
}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    gridel_firmware::give_up(info)
}
