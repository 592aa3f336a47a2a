//! Between loading a blob and the last pixel nothing is allocated, in any format and structure.

use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::{
    Accel, Bvh, Effects, Fixed, Flagged, List, NoCount, Number, Renderer, Rgb888, Scene, Settings,
    Workspace,
};
use gridel_tests::scenes;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::hint::black_box;

/// The system's allocator, counted thread by thread: what the harness allocates on its own thread
/// meanwhile is not the renderer's.
struct Counted;

thread_local! {
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

// SAFETY: hands everything to the system's allocator, unchanged.
unsafe impl GlobalAlloc for Counted {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.set(ALLOCATIONS.get() + 1);
        // SAFETY: the caller keeps the promises that the system requires.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counted = Counted;

#[test]
fn nothing_is_allocated_between_load_and_last_pixel() {
    let before = ALLOCATIONS.get();
    drop(black_box(vec![1_u8]));
    assert!(ALLOCATIONS.get() > before, "the allocator counts");

    let mut scene = scenes::read(&scenes::fixture_folder().join("quick.toml"));
    (scene.render.width, scene.render.height) = (24, 18);
    let blob = scenes::blob(&scene, 24);
    let bytes = blob.bytes();
    render::<Fixed, List>(bytes);
    render::<Fixed, Bvh>(bytes);
    render::<Fixed, Flagged>(bytes);
    render::<f32, Flagged>(bytes);
    render::<f64, Flagged>(bytes);
}

fn render<N: Number, A: Accel>(blob: &[u8]) {
    let mut row = [Rgb888::default(); 24];
    let mut space = Workspace::<N, MAX_STACK_DEPTH, { Effects::MAX_WORK_DEPTH }>::new();
    let before = ALLOCATIONS.get();
    let scene = Scene::from_bytes(blob).expect("the compiler's own blob");
    let settings = Settings::of(&scene);
    let renderer = Renderer::<N, A, { Effects::ALL.0 }>::with_settings(&scene, settings);
    let renderer = renderer.expect("the scene is for this renderer");
    for y in 0..settings.height {
        renderer.row(0, y, &mut row, &mut space.as_view(), &mut NoCount);
        black_box(&row);
    }
    let allocations = ALLOCATIONS.get() - before;
    assert_eq!(
        allocations,
        0,
        "{} through {}",
        N::FORMAT.name(),
        A::STRUCTURE.name()
    );
}
