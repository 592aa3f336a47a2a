//! Renders over and over and talks to nobody, so that its ELF holds what a product's would: the
//! tests look in it for routines that must not be there.
#![no_std]
#![no_main]

use core::hint::black_box;
use core::panic::PanicInfo;
use cortex_m_rt::entry;
use gridel_core::{NoCount, Rgb565, Scene, Settings};
use gridel_firmware::scene::{BLOB, SceneRenderer, Space, WIDTH};

#[entry]
fn main() -> ! {
    static mut SPACE: Space = Space::new();
    static mut ROW: [Rgb565; WIDTH] = [Rgb565(0); WIDTH];
    loop {
        render(SPACE, ROW);
    }
}

fn render(space: &mut Space, row: &mut [Rgb565; WIDTH]) {
    let Ok(scene) = Scene::from_bytes(black_box(BLOB)) else {
        return;
    };
    let settings = Settings::of(&scene);
    let Ok(renderer) = SceneRenderer::new(&scene, settings) else {
        return;
    };
    let mut space = space.as_view();
    for y in 0..settings.height {
        renderer.row(0, y, row, &mut space, &mut NoCount);
        black_box(&mut *row);
    }
}

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    loop {}
}
