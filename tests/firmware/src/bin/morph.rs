//! Moves a mesh by the weights of its morph targets, and casts rays at each time: what they find, and what that costs.
#![no_std]
#![no_main]

use gridel_core::Tracks;
use gridel_core::deform::MorphTargets;
use gridel_firmware::casts::{Casts, RAYS};
use gridel_firmware::measure::{Cost, Meter};
use gridel_firmware::mesh::{Memory, Mesh};
use gridel_firmware::program;
use gridel_firmware::report::{cost, fail, line};
use gridel_firmware::scene::{Accel, BLOB, MORPH_TARGETS, Number, load};
use gridel_firmware::waves::{POSES, sum, sum_of_normals};

program!(run, Memory);

fn run(Memory { stack, mesh }: &'static mut Memory) {
    let meter = Meter::new();
    let Ok(scene) = load(BLOB) else {
        fail("the blob is rejected")
    };
    let (mut tracks, mut morph) = (None, None);
    let read = meter.run(|| {
        tracks = Tracks::from_bytes(BLOB).ok();
        morph = MorphTargets::from_bytes(BLOB).ok();
    });
    let (Some(tracks), Some(morph), Ok(())) = (tracks, morph, mesh.reset(&scene)) else {
        fail("the scene cannot morph")
    };
    let (mut morphs, mut spent) = (Cost::NONE, Cost::NONE);
    for number in 0..POSES {
        let mut moved = false;
        let time = tracks.frame_time(number, 4);
        let cost = meter.run(|| {
            let mut weights = [0; MORPH_TARGETS];
            moved = tracks.weights_at(time, &mut weights).is_ok()
                && mesh.morph(&scene, &morph, &weights).is_ok();
        });
        let moved = scene.with_deformation(mesh).ok().filter(|_| moved);
        let Some(moved) = &moved else {
            fail("the pose is rejected")
        };
        let mut casts = Casts::default();
        let cast = meter.run(|| casts.run::<Number, Accel>(moved, stack.as_view()));
        line("hits", casts.hits.into());
        line("sum", casts.sum.into());
        line("boxes", sum(mesh.pairs()).into());
        line("normals", sum_of_normals(mesh.normals()).into());
        (morphs, spent) = (morphs.then(cost), spent.then(cast));
    }
    line("deformation-bytes", size_of::<Mesh>() as u64);
    cost("read-instructions", "read-stack-bytes", read);
    cost(
        "morph-instructions",
        "morph-stack-bytes",
        morphs.each(POSES),
    );
    let spent = spent.each(POSES * RAYS);
    cost("cast-instructions", "cast-stack-bytes", spent);
}
