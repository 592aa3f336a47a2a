//! Bends an arm whose links are instances: renders a frame of each pose into the file `arm.rgb` of the host, casts a ray
//! from the hand, and measures what poses cost.
#![no_std]
#![no_main]

use gridel_core::number::{Convert, Products};
use gridel_core::{
    Motion, NoCount, Parts, Poses, Rgb888, Scene, Settings, Stack, Tracks, closest_hit,
};
use gridel_firmware::arm::{FRAMES, bend, hand};
use gridel_firmware::board::File;
use gridel_firmware::measure::{Cost, Meter};
use gridel_firmware::program;
use gridel_firmware::report::{cost, fail, line};
use gridel_firmware::scene::{
    Accel, BLOB, INSTANCES, JOINTS, Number, PARTS, STACK_DEPTH, SceneRenderer, Space, WIDTH,
};

/// Pixels that are measured together.
const PART: usize = 16;

struct Memory {
    space: Space,
    row: [Rgb888; WIDTH],
    parts: Parts<'static, PARTS>,
    poses: Poses<INSTANCES>,
    motions: [Motion; JOINTS],
}

impl Memory {
    const fn new() -> Self {
        Self {
            space: Space::new(),
            row: [Rgb888([0; 3]); WIDTH],
            parts: Parts::new(),
            poses: Poses::new(),
            motions: [Motion::REST; JOINTS],
        }
    }
}

program!(run, Memory);

fn run(memory: &'static mut Memory) {
    let meter = Meter::new();
    let Memory {
        space,
        row,
        parts,
        poses,
        motions,
    } = memory;
    if parts.load(BLOB).is_err() {
        fail("a part is rejected")
    }
    let parts: &'static Parts<'static, PARTS> = parts;
    let Ok(scene) = Scene::with_parts(BLOB, parts) else {
        fail("the blob is rejected")
    };
    let Ok(tracks) = Tracks::from_bytes(BLOB) else {
        fail("the joints are rejected")
    };
    let settings = Settings::of(&scene);
    let mut space = space.as_view();
    let Some(file) = File::create(c"arm.rgb") else {
        fail("arm.rgb cannot be created")
    };
    let (mut bending, mut building) = (Cost::NONE, Cost::NONE);
    let (mut setting, mut picture) = (Cost::NONE, Cost::NONE);
    for frame in 0..FRAMES {
        let (mut posed, mut view, mut renderer) = (None, None, None);
        let bent = meter.run(|| {
            let mut at_rest = poses.at_rest(&scene).ok();
            let bent = bend(&tracks, frame, motions);
            let placed = at_rest.as_mut().map(|it| tracks.place(&scene, motions, it));
            view = at_rest.filter(|_| bent.is_ok() && placed == Some(Ok(())));
        });
        let Some(view) = view else {
            fail("the motions are rejected")
        };
        let built = meter.run(|| posed = scene.with_poses(view).ok());
        let Some(posed) = &posed else {
            fail("the poses are rejected")
        };
        let set = meter.run(|| renderer = SceneRenderer::with_settings(posed, settings).ok());
        let Some(renderer) = &renderer else {
            fail("the scene is not for this renderer")
        };
        bending = bending.then(bent);
        building = building.then(built);
        setting = setting.then(set);
        for y in 0..settings.height {
            // In parts that the slowest core ends before the counter wraps.
            for (x, part) in (0..settings.width).step_by(PART).zip(row.chunks_mut(PART)) {
                let cost = meter.run(|| renderer.row(x, y, part, &mut space, &mut NoCount));
                picture = picture.then(cost);
            }
            if !row.iter().all(|pixel| file.write(&pixel.0)) {
                fail("arm.rgb cannot be written to")
            }
        }
        let ray = hand(&tracks, motions)
            .and_then(|(place, direction)| posed.ray_from::<Number>(place, direction).ok());
        let mut stack = Stack::<STACK_DEPTH>::new();
        let hit = ray.and_then(|ray| {
            closest_hit::<Number, Accel, _>(posed, &ray, stack.as_view(), &mut NoCount)
        });
        let q13 = hit.map(|hit| Number::narrow(hit.t).to_q13() as u64);
        line("range", q13.unwrap_or(0));
    }
    line("workspace-bytes", size_of::<Space>() as u64);
    line("poses-bytes", size_of_val(poses) as u64);
    let [bending, building, setting, picture] =
        [bending, building, setting, picture].map(|cost| cost.each(FRAMES));
    cost("bend-instructions", "bend-stack-bytes", bending);
    cost("build-instructions", "build-stack-bytes", building);
    cost("set-up-instructions", "set-up-stack-bytes", setting);
    cost("picture-instructions", "picture-stack-bytes", picture);
}
