//! One ray a pixel, without shading: the hits, and what they cost.
#![no_std]
#![no_main]

use core::panic::PanicInfo;
use cortex_m_rt::entry;
use gridel_core::{NoCount, Scene, Settings, Stack, closest_primitive};
use gridel_firmware::measure::Meter;
use gridel_firmware::scene::{Accel, BLOB, Number, STACK_DEPTH, SceneRenderer};
use semihosting::println;

#[entry]
fn main() -> ! {
    static mut STACK: Stack<STACK_DEPTH> = Stack::new();
    let meter = Meter::default();
    let mut scene = None;
    let load = meter.run(|| scene = Scene::from_bytes(BLOB).ok());
    let scene = scene.as_ref().expect("the build script checked the blob");
    let (mut rays, mut hits) = (0, 0);
    let trace = meter.run(|| (rays, hits) = trace(scene, STACK));
    println!("blob-bytes {}", BLOB.len());
    println!("load-instructions {}", load.instructions);
    println!("load-stack-bytes {}", load.stack);
    println!("rays {rays}");
    println!("hits {hits}");
    println!("ray-instructions {}", trace.instructions / u64::from(rays));
    println!("ray-stack-bytes {}", trace.stack);
    println!("workspace-bytes {}", size_of_val(STACK));
    semihosting::process::exit(0)
}

/// Rays and hits of a picture, the set-up of the camera included.
fn trace(scene: &Scene<'static>, stack: &mut Stack<STACK_DEPTH>) -> (u32, u32) {
    let settings = Settings::of(scene);
    let renderer = SceneRenderer::new(scene, settings).expect("the scene is for this renderer");
    let (mut rays, mut hits) = (0, 0);
    for y in 0..settings.height {
        for x in 0..settings.width {
            let Ok(ray) = renderer.primary_ray(x, y) else {
                continue;
            };
            rays += 1;
            let hit =
                closest_primitive::<Number, Accel, _>(scene, &ray, stack.as_view(), &mut NoCount);
            hits += u32::from(hit.is_some());
        }
    }
    (rays, hits)
}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    gridel_firmware::give_up(info)
}
