//! A range finder: rays of its own, without a camera and without floating point in `fixed`. A sensor above the scene
//! looks down in a fan, and prints how far each ray goes, in steps of scene coordinates.
#![no_std]
#![no_main]

use gridel_core::{NoCount, Stack, closest_hit};
use gridel_firmware::finder::{RAYS, direction, place, reach};
use gridel_firmware::program;
use gridel_firmware::report::{fail, line};
use gridel_firmware::scene::{Accel, BLOB, Number, STACK_DEPTH, load};

program!(run, Stack<STACK_DEPTH>);

fn run(stack: &'static mut Stack<STACK_DEPTH>) {
    let Ok(scene) = load(BLOB) else {
        fail("the blob is rejected")
    };
    let place = place(&scene);
    for number in 0..RAYS {
        let Ok(ray) = scene.ray_within::<Number>(place, direction(number), reach(&scene)) else {
            fail("the ray is rejected")
        };
        match closest_hit::<Number, Accel, _>(&scene, &ray, stack.as_view(), &mut NoCount) {
            Some(hit) => line("distance", scene.distance(&ray, &hit)),
            None => line("miss", number as u64),
        }
    }
}
