//! The README's example: a scene in flash, its picture row by row, no heap and no frame buffer.
#![no_std]
#![no_main]

use core::hint::black_box;
use cortex_m_rt::entry;
use gridel_core::{DualSplit, Effects, NoCount, Renderer, Rgb565, Scene, Settings, Workspace};

static BLOB: &[u8] = gridel_core::include_blob!(env!("GRIDEL_BLOB"));
/// In the number format `f32`, with dual-split nodes, for every effect.
type Picture<'s> = Renderer<'s, 'static, f32, DualSplit, { Effects::ALL.0 }>;

#[entry]
fn main() -> ! {
    // The stack depth and the work depth that `gridel inspect` prints.
    static mut SPACE: Workspace<f32, 12, 7> = Workspace::new();
    static mut ROW: [Rgb565; 320] = [Rgb565(0); 320];
    let scene = Scene::from_bytes(BLOB).unwrap_or_else(|_| halt());
    let settings = Settings::of(&scene);
    let picture = Picture::with_settings(&scene, settings).unwrap_or_else(|_| halt());
    let mut space = SPACE.as_view();
    picture.check_workspace(&space).unwrap_or_else(|_| halt());
    for y in 0..settings.height {
        picture.row(0, y, ROW, &mut space, &mut NoCount);
        black_box(&ROW); // to the display
    }
    halt()
}

fn halt() -> ! {
    loop {
        core::hint::spin_loop();
    }
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    halt()
}
