//! A range finder: casts rays of its own straight down onto the scene, without a camera, and prints how
//! far each one goes, in units of the blob.
#![no_std]
#![no_main]

use gridel_core::number::{Convert, Products};
use gridel_core::{NoCount, Ray, Stack, closest_hit};
use gridel_firmware::program;
use gridel_firmware::report::{fail, line};
use gridel_firmware::scene::{Accel, BLOB, Number, STACK_DEPTH, load};

/// Rays that are cast, in a row along x.
const RAYS: i64 = 8;

program!(run, Stack<STACK_DEPTH>);

fn run(stack: &'static mut Stack<STACK_DEPTH>) {
    let Ok(scene) = load(BLOB) else {
        fail("the blob is rejected")
    };
    // `far` takes lengths with 13 fraction bits.
    let length = |units: i64| Number::far(units << 13);
    let [x, y, z] = scene.bounds().0.map(|side| side.map(i64::from));
    let down = [0, -1, 0].map(length);
    for step in 0..RAYS {
        let origin = [
            x[0] + (x[1] - x[0]) * step / (RAYS - 1),
            y[1] + 1,
            (z[0] + z[1]) / 2,
        ];
        let (start, end) = (length(0), length(1 << 40));
        let Ok(ray) = Ray::<Number>::new(scene.bounds(), origin.map(length), down, start, end)
        else {
            fail("the ray is rejected")
        };
        match closest_hit::<Number, Accel, _>(&scene, &ray, stack.as_view(), &mut NoCount) {
            Some(hit) => line("distance", Number::narrow(hit.t).to_q13() as u64 >> 13),
            None => line("miss", step as u64),
        }
    }
}
