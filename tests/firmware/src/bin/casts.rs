//! Ray casts alone, as range finders and collisions need them: what they find, and what they cost.
#![no_std]
#![no_main]

use gridel_core::Stack;
use gridel_firmware::casts::{Casts, RAYS};
use gridel_firmware::measure::Meter;
use gridel_firmware::program;
use gridel_firmware::report::{cost, fail, line};
use gridel_firmware::scene::{Accel, BLOB, Number, STACK_DEPTH, load};

type Memory = Stack<STACK_DEPTH>;

program!(run, Memory);

fn run(stack: &'static mut Memory) {
    let meter = Meter::new();
    let mut scene = None;
    meter.run(|| scene = load(BLOB).ok());
    let Some(scene) = &scene else {
        fail("the blob is rejected")
    };
    let mut casts = Casts::default();
    let spent = meter.run(|| casts.run::<Number, Accel>(scene, stack.as_view()));
    line("hits", casts.hits.into());
    line("sum", casts.sum.into());
    line("cast-workspace-bytes", size_of::<Memory>() as u64);
    cost("cast-instructions", "cast-stack-bytes", spent.each(RAYS));
}
