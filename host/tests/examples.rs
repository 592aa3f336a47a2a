//! Runs the examples. Displays show the pixels that `render` makes.

#[allow(dead_code)]
#[path = "../examples/build_scene.rs"]
mod build_scene;
#[allow(dead_code)]
#[path = "../examples/display.rs"]
mod display;
#[allow(dead_code)]
#[path = "../examples/quickstart.rs"]
mod quickstart;
#[allow(dead_code)]
#[path = "../examples/spi_display.rs"]
mod spi_display;

use embedded_graphics::framebuffer::{Framebuffer, buffer_size};
use embedded_graphics::geometry::{Point, Size};
use embedded_graphics::image::GetPixel;
use embedded_graphics::pixelcolor::raw::{LittleEndian, RawU1};
use embedded_graphics::pixelcolor::{BinaryColor, IntoStorage};
use embedded_graphics::prelude::DrawTargetExt;
use embedded_graphics::primitives::Rectangle;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::render::Pixel;
use gridel_core::{
    Counters, DualSplit, Effects, Format, Renderer, Rgb565, Settings, Structure, Workspace,
};
use gridel_host::blob::Blob;
use gridel_host::compile::{Options, compile};
use gridel_host::render::{Job, render};
use gridel_host::scene::{MoleculeOptions, load};
use std::path::{Path, PathBuf};

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../fixtures")
        .join(name)
}

fn blob(name: &str) -> Blob {
    let imported = load(&fixture(name), &MoleculeOptions::default()).expect("a scene");
    compile(&imported.scene, &Options::default())
        .expect("compiles")
        .blob
}

/// Returns the picture of `gridel render`, as the pixels of a display.
fn rendered(blob: &Blob, [width, height]: [u16; 2]) -> Vec<u16> {
    let scene = blob.scene().expect("the compiler's blob");
    let settings = Settings {
        width,
        height,
        ..Settings::of(&scene)
    };
    let job = Job::whole(Format::F32, Structure::DualSplit, settings);
    let picture = render(&scene, &job, &|| ()).expect("a picture");
    let pixels = picture.pixels.iter().enumerate().map(|(place, &linear)| {
        let place = [place as u16 % width, place as u16 / width];
        Rgb565::encode(linear, Some(place)).0
    });
    pixels.collect()
}

#[test]
fn quickstart_traces_and_renders() {
    let folder = tempfile::tempdir().expect("a folder");
    let picture = folder.path().join("picture.png");
    let hit = quickstart::run(&fixture("glass-chess.toml"), &picture).expect("a picture");
    // The squares' upper sides are at height 0, and the ray starts at height 100.
    assert!((hit.t - 100.0).abs() < 0.01, "{hit:?}");
    let bytes = std::fs::read(&picture).expect("the picture");
    assert!(bytes.starts_with(b"\x89PNG"));
}

#[test]
fn scene_built_in_rust_compiles_into_a_blob_with_its_objects() {
    let blob = build_scene::blob().expect("compiles");
    let scene = blob.scene().expect("the compiler's blob");
    assert_eq!(scene.header().objects, 2);
    assert!(scene.effects().contains(Effects::SHADOW));
}

#[test]
fn a_display_shows_the_picture_and_the_caption() {
    let blob = blob("glass-chess.toml");
    let scene = blob.scene().expect("the compiler's blob");
    let [width, height] = display::SIZE;
    let mut screen = display::Screen::new();
    display::draw(&scene, "chess", &mut screen).expect("the display takes everything");
    let shown = |x: u16, y: u16| {
        let color = screen.pixel(Point::new(x.into(), y.into()));
        color.map(IntoStorage::into_storage)
    };
    let above = height - display::CAPTION as u16;
    let expected = rendered(&blob, [width, above]);
    for y in 0..above {
        for x in 0..width {
            let found = shown(x, y);
            let place = usize::from(y) * usize::from(width) + usize::from(x);
            assert_eq!(found, Some(expected[place]), "{x}, {y}");
        }
    }
    let mut caption = (above..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    assert!(caption.any(|[x, y]| shown(x, y) == Some(0xffff)));
}

/// Only pixels that can be seen are traced, wherever the display lies.
#[test]
fn pixels_outside_of_a_display_are_not_traced() {
    let blob = blob("quick.toml");
    let scene = blob.scene().expect("the compiler's blob");
    let settings = Settings {
        width: 100,
        height: 60,
        samples: 1,
        dither: true,
        ..Settings::of(&scene)
    };
    let renderer = Renderer::<f32, DualSplit, { Effects::ALL.0 }>::with_settings(&scene, settings);
    let renderer = renderer.expect("a renderer");
    let mut space = Workspace::<f32, MAX_STACK_DEPTH, { Effects::MAX_WORK_DEPTH }>::new();
    let mut space = space.as_view();
    const BYTES: usize = buffer_size::<BinaryColor>(64, 48);
    let mut screen = Framebuffer::<BinaryColor, RawU1, LittleEndian, 64, 48, BYTES>::new();
    let everything = Rectangle::new(Point::new(-5, -5), Size::new(1000, 1000));
    for (corner, seen) in [
        ([0, 0], 64 * 48),
        ([10, 20], 54 * 28),
        ([-50, -30], 50 * 30),
        ([64, 0], 0),
    ] {
        let mut counters = Counters::default();
        let mut moved = screen.translated(corner.into());
        renderer
            .draw(&everything, &mut moved, &mut space, &mut counters)
            .expect("a display that cannot fail");
        assert_eq!(counters.primary, seen, "{corner:?}");
    }
}

#[test]
fn a_panel_on_a_bus_shows_the_picture() {
    let panel = spi_display::panel(&fixture("quick.toml")).expect("a picture");
    assert_eq!((panel.width, panel.height), (160, 128));
    let expected = rendered(&blob("quick.toml"), [160, 128]);
    let shown: Vec<_> = panel.memory.iter().map(|pixel| pixel.0).collect();
    assert!(shown == expected);
    let (last, full) = panel.chunks.split_last().expect("chunks");
    assert!(full.iter().all(|&bytes| bytes == spi_display::CHUNK));
    assert_eq!(full.len() * spi_display::CHUNK + last, 2 * 160 * 128);
}
