//! Moves the vertices of a mesh, computes the boxes again, and casts rays at each pose: what they find, and what that
//! costs.
#![no_std]
#![no_main]

use gridel_firmware::casts::{Casts, RAYS};
use gridel_firmware::measure::{Cost, Meter};
use gridel_firmware::mesh::{Memory, Mesh};
use gridel_firmware::program;
use gridel_firmware::report::{cost, fail, line};
use gridel_firmware::scene::{Accel, BLOB, Number, load};
use gridel_firmware::waves::{POSES, pose, sum};

program!(run, Memory);

fn run(Memory { stack, mesh }: &'static mut Memory) {
    let meter = Meter::new();
    let Ok(scene) = load(BLOB) else {
        fail("the blob is rejected")
    };
    let mut made = Ok(());
    let reset = meter.run(|| made = mesh.reset(&scene));
    let (Ok(()), Some(rest)) = (made, scene.stored_vertices()) else {
        fail("the scene cannot deform")
    };
    let (mut refits, mut swaps, mut spent) = (Cost::NONE, Cost::NONE, Cost::NONE);
    for number in 0..POSES {
        pose(rest, mesh.vertices_mut(), number);
        let mut fitted = Ok(());
        let refit = meter.run(|| fitted = mesh.refit(&scene));
        if fitted.is_err() {
            fail("the pose is rejected")
        }
        let mut moved = None;
        let swap = meter.run(|| moved = scene.with_deformation(mesh).ok());
        let Some(moved) = &moved else {
            fail("the deformation is rejected")
        };
        let mut casts = Casts::default();
        let cast = meter.run(|| casts.run::<Number, Accel>(moved, stack.as_view()));
        line("hits", casts.hits.into());
        line("sum", casts.sum.into());
        line("boxes", sum(mesh.pairs()).into());
        (refits, swaps, spent) = (refits.then(refit), swaps.then(swap), spent.then(cast));
    }
    line("deformation-bytes", size_of::<Mesh>() as u64);
    cost("reset-instructions", "reset-stack-bytes", reset);
    cost(
        "refit-instructions",
        "refit-stack-bytes",
        refits.each(POSES),
    );
    cost("swap-instructions", "swap-stack-bytes", swaps.each(POSES));
    let spent = spent.each(POSES * RAYS);
    cost("cast-instructions", "cast-stack-bytes", spent);
}
