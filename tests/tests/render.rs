//! Pictures: the same bytes however they are made, and the laws of physics that they obey.
//!
//! `fixtures/check.toml` holds a hash of a small picture of every fixture in every number format,
//! and its costs. After an intended change of these, `gridel check --bless fixtures/check.toml`
//! writes them again; the difference belongs into the same commit.

use glam::DVec3;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::{
    Counters, Effects, Flagged, Format, NoCount, Number, Renderer, Rgb888, Scene, Settings,
    Structure, Workspace,
};
use gridel_host::blob::Blob;
use gridel_host::check::{self, Manifest};
use gridel_host::render::{Job, Picture, render};
use gridel_host::scene::{Camera, Diffuse, Light, Material, Scene as SceneFile, Shape};
use gridel_host::shape::{Cuboid, Sphere};
use gridel_tests::{every_format, scenes};

fn small(scene: &Scene<'_>) -> Settings {
    Settings {
        width: 48,
        height: 36,
        samples: 2,
        ..Settings::of(scene)
    }
}

fn job(format: Format, settings: Settings) -> Job {
    Job::whole(format, Structure::DualSplit, settings)
}

fn picture(scene: &Scene<'_>, job: &Job) -> Picture {
    render(scene, job, &|| ()).expect("a picture")
}

#[test]
fn fixtures_are_as_recorded() {
    let manifest = Manifest::read(&scenes::manifest()).expect("fixtures/check.toml");
    for (name, _) in scenes::fixtures() {
        let listed = manifest.checks.iter().find(|check| check.name == name);
        let check = listed.unwrap_or_else(|| panic!("fixtures/check.toml has no check {name}"));
        assert_eq!(check.formats, Format::ALL, "{name}");
        assert!(check.hash.is_some(), "{name}");
    }
    let report = check::run(&manifest, &|| ());
    eprintln!("{}", report.table());
    let (broken, not_run) = (report.failed(), report.not_run());
    assert_eq!(
        (broken, not_run),
        (0, 0),
        "see `gridel check --help` if that was meant to change"
    );
}

#[test]
fn threads_rows_and_structures_do_not_matter() {
    for (name, scene) in scenes::fixtures() {
        let blob = scenes::blob(&scene, 24);
        let scene = blob.scene().expect("a scene");
        for format in Format::ALL {
            let whole = job(format, small(&scene));
            let with_threads = |threads: usize, job: &Job| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
                pool.expect("threads")
                    .install(|| picture(&scene, job))
                    .pixels
            };
            let one = with_threads(1, &whole);
            assert!(
                one == with_threads(2, &whole),
                "{name}, {format:?}: threads"
            );
            let part = Job {
                rows: 7..20,
                ..whole.clone()
            };
            let rows = 7 * 48..20 * 48;
            assert!(
                one[rows] == with_threads(2, &part),
                "{name}, {format:?}: rows"
            );
            let plain = Job {
                structure: Structure::Bvh,
                count: true,
                ..whole
            };
            assert!(
                one == with_threads(2, &plain),
                "{name}, {format:?}: bvh, counted"
            );
        }
    }
}

/// No format is far from another, and none has a black pixel where another has light. A NaN would
/// be black.
#[test]
fn formats_agree() {
    for (name, scene) in scenes::fixtures() {
        let blob = scenes::blob(&scene, 24);
        let scene = blob.scene().expect("a scene");
        let [fixed, f32, f64] =
            Format::ALL.map(|format| picture(&scene, &job(format, small(&scene))).pixels);
        for (format, other) in [("fixed", fixed), ("f32", f32)] {
            let apart = |a: u16, b: u16| f64::from(a.abs_diff(b)) / 65_535.0;
            let channels = other.iter().flatten().zip(f64.iter().flatten());
            let mean = channels.map(|(&a, &b)| apart(a, b)).sum::<f64>() / (3 * f64.len()) as f64;
            let dark = |pixel: &[u16; 3]| pixel.iter().all(|&channel| channel < 8);
            let lost = other
                .iter()
                .zip(&f64)
                .filter(|(a, b)| dark(a) != dark(b))
                .count();
            eprintln!(
                "{name:16} {format:5} against f64: mean difference {mean:.2e}, {lost} pixels lost"
            );
            assert!(mean < 0.01 && lost <= 4, "{name}, {format}");
        }
    }
}

/// A floor and a ball of one material, under a light that casts shadows or does not.
fn ball_on_floor(material: Material, shadows: bool) -> Blob {
    let ball = Shape::Sphere(Sphere {
        center: DVec3::new(0.0, 1.0, 0.0),
        radius: 1.0,
    });
    let floor = Shape::Box(Cuboid {
        min: DVec3::new(-4.0, -0.5, -4.0),
        max: DVec3::new(4.0, 0.0, 4.0),
    });
    let mut scene = scenes::of([ball, floor]);
    scene.materials = vec![material];
    scene.lights = vec![Light::Point {
        position: DVec3::new(3.0, 6.0, 4.0),
        color: [0.9, 0.8, 0.7],
    }];
    scene.background = Some([0.2, 0.3, 0.5]);
    scene.ambient = [0.1; 3];
    scene.render.shadows = shadows;
    scenes::blob(&scene, 24)
}

#[test]
fn without_effects_there_are_no_secondary_rays() {
    let blob = ball_on_floor(Material::default(), false);
    let scene = blob.scene().expect("a scene");
    assert_eq!(scene.effects(), Effects::NONE);
    for format in Format::ALL {
        let counted = Job {
            count: true,
            ..job(format, small(&scene))
        };
        let counters = picture(&scene, &counted).counters.expect("counters");
        assert_eq!((counters.primary, counters.secondary()), (48 * 36 * 2, 0));
    }
}

fn bytes<N: Number, const EFFECTS: u32>(scene: &Scene<'_>) -> Vec<[u8; 3]> {
    let settings = small(scene);
    let renderer =
        Renderer::<N, Flagged, EFFECTS>::with_settings(scene, settings).expect("a renderer");
    let mut space = Workspace::<N, MAX_STACK_DEPTH, { Effects::MAX_WORK_DEPTH }>::new();
    let mut pixels = Vec::new();
    let size = [settings.width, settings.height];
    let sink = |_, _, pixel: Rgb888| pixels.push(pixel.0);
    renderer.rectangle([0, 0], size, &mut space.as_view(), &mut NoCount, sink);
    pixels
}

/// A picture made a few rays at a time equals the one made row by row, whatever the steps. No step
/// traces more rays than its limit.
fn steps_do_not_matter<N: Number>(name: &str, scene: &Scene<'_>) {
    let settings = small(scene);
    let renderer = Renderer::<N, Flagged, { Effects::ALL.0 }>::with_settings(scene, settings);
    let renderer = renderer.expect("a renderer");
    let mut space = Workspace::<N, MAX_STACK_DEPTH, { Effects::MAX_WORK_DEPTH }>::new();
    let (corner, size) = ([5, 7], [settings.width - 9, settings.height - 11]);
    let mut whole = Vec::new();
    let mut counted = Counters::default();
    let sink = |x, y, pixel: Rgb888| whole.push((x, y, pixel.0));
    renderer.rectangle(corner, size, &mut space.as_view(), &mut counted, sink);
    // Shadow rays belong to the ray that met the surface.
    let rays = |counters: &Counters| counters.rays() - counters.shadow;
    for budget in [1, 2, 7, 64, 1000, u32::MAX] {
        let mut pixels = Vec::new();
        let mut sum = Counters::default();
        let mut steps = 0;
        let mut cursor = renderer.cursor(corner, size, space.as_view());
        while !cursor.is_done() {
            let mut count = Counters::default();
            cursor.step(budget, &mut count, |x, y, pixel: Rgb888| {
                pixels.push((x, y, pixel.0));
            });
            assert!(rays(&count) <= budget.into(), "{name}, steps of {budget}");
            sum = sum.plus(&count);
            steps += 1;
        }
        assert!(
            pixels == whole,
            "{name}, {}, steps of {budget}",
            N::FORMAT.name()
        );
        assert_eq!(sum, counted, "{name}, steps of {budget}");
        // Every ray of these cameras has a direction, so no step but the last is short.
        assert_eq!(
            steps,
            rays(&sum).div_ceil(budget.into()),
            "{name}, steps of {budget}"
        );
        // Nothing is left to do, and nothing is done.
        cursor.step(budget, &mut sum, |_, _, _: Rgb888| {
            panic!("{name}: a pixel too many")
        });
        assert_eq!(sum, counted, "{name}, behind the end");
        assert!(coarse_to_fine(&renderer, corner, size, budget) == whole);
    }
}

/// A rectangle drawn from coarse to fine, a few rays at a time.
fn coarse_to_fine<N: Number, const EFFECTS: u32>(
    renderer: &Renderer<'_, '_, N, Flagged, EFFECTS>,
    corner: [u16; 2],
    size: [u16; 2],
    budget: u32,
) -> Vec<(u16, u16, [u8; 3])> {
    let mut space = Workspace::<N, MAX_STACK_DEPTH, { Effects::MAX_WORK_DEPTH }>::new();
    let places = (corner[1]..corner[1] + size[1])
        .flat_map(|y| (corner[0]..corner[0] + size[0]).map(move |x| (x, y)));
    let mut drawn: Vec<_> = places.map(|(x, y)| (x, y, [0; 3])).collect();
    let mut cursor = renderer.coarse_to_fine(corner, size, space.as_view());
    while !cursor.is_done() {
        cursor.step(budget, &mut NoCount, |block, Rgb888(pixel)| {
            let [x, y] = [block.x - corner[0], block.y - corner[1]].map(usize::from);
            for row in y..y + usize::from(block.height) {
                let first = row * usize::from(size[0]) + x;
                for drawn in &mut drawn[first..first + usize::from(block.width)] {
                    drawn.2 = pixel;
                }
            }
        });
    }
    drawn
}

#[test]
fn pictures_are_the_same_a_few_rays_at_a_time() {
    for (name, scene) in scenes::fixtures() {
        let blob = scenes::blob(&scene, 24);
        let scene = blob.scene().expect("a scene");
        every_format!(steps_do_not_matter(&name, &scene));
    }
}

/// An abandoned cursor leaves rays in the workspace, which must not reach the next picture.
/// Rectangles end at the last pixel.
#[test]
fn cursors_can_be_dropped_and_ends_are_ends() {
    let fixture = scenes::read(&scenes::fixture_folder().join("glass-chess.toml"));
    let blob = scenes::blob(&fixture, 24);
    let scene = blob.scene().expect("a scene");
    let renderer =
        Renderer::<f32, Flagged, { Effects::ALL.0 }>::with_settings(&scene, small(&scene));
    let renderer = renderer.expect("a renderer");
    let mut space = Workspace::<f32, MAX_STACK_DEPTH, { Effects::MAX_WORK_DEPTH }>::new();
    let pixel = |space: &mut Workspace<_, _, _>| {
        renderer.linear(24, 20, &mut space.as_view(), &mut NoCount)
    };
    let fresh = pixel(&mut space);
    for rays in 1..40 {
        let mut cursor = renderer.cursor([20, 20], [9, 9], space.as_view());
        cursor.step(rays, &mut NoCount, |_, _, _: Rgb888| ());
        assert!(!cursor.is_done());
        assert_eq!(pixel(&mut space), fresh);
    }
    let end = u16::MAX;
    for (corner, size, expected) in [
        ([0, 0], [0, 5], 0),
        ([0, 0], [5, 0], 0),
        ([end, end], [1, 1], 1),
        ([end, end], [end, end], 1),
        ([end - 1, end - 2], [7, 7], 6),
    ] {
        let mut places = Vec::new();
        let sink = |x, y, _: Rgb888| places.push([x, y]);
        renderer.rectangle(corner, size, &mut space.as_view(), &mut NoCount, sink);
        let mut stepped = Vec::new();
        let mut cursor = renderer.cursor(corner, size, space.as_view());
        while !cursor.is_done() {
            cursor.step(3, &mut NoCount, |x, y, _: Rgb888| stepped.push([x, y]));
        }
        assert_eq!(stepped, places);
        assert_eq!(stepped.len(), expected);
    }
}

/// A picture made with exactly its scene's effects is the one made with all.
fn unused_effects_are_free<const EFFECTS: u32>(material: Material, shadows: bool) {
    fn compare<N: Number, const EFFECTS: u32>(scene: &Scene<'_>) {
        assert!(bytes::<N, EFFECTS>(scene) == bytes::<N, { Effects::ALL.0 }>(scene));
    }
    let blob = ball_on_floor(material, shadows);
    let scene = blob.scene().expect("a scene");
    assert_eq!(scene.effects(), Effects(EFFECTS));
    compare::<gridel_core::Fixed, EFFECTS>(&scene);
    compare::<f32, EFFECTS>(&scene);
    compare::<f64, EFFECTS>(&scene);
}

#[test]
fn unused_effects_change_no_byte() {
    const SHADOW: u32 = Effects::SHADOW.0;
    const CHECKERED: u32 = Effects::CHECKER.0;
    const GLOSSY: u32 = Effects::HIGHLIGHT.0;
    const MIRRORED: u32 = Effects::MIRROR.0 | SHADOW;
    const CLEAR: u32 = Effects::GLASS.0;
    const TINTED: u32 = Effects::GLASS.0 | Effects::ABSORPTION.0 | SHADOW;
    let plain = Material::default;
    unused_effects_are_free::<0>(plain(), false);
    unused_effects_are_free::<SHADOW>(plain(), true);
    let checker = Diffuse::Checker {
        even: [0.9; 3],
        odd: [0.1, 0.2, 0.3],
        size: 0.7,
        origin: DVec3::splat(0.1),
    };
    unused_effects_are_free::<CHECKERED>(
        Material {
            diffuse: checker,
            ..plain()
        },
        false,
    );
    unused_effects_are_free::<GLOSSY>(
        Material {
            highlight: [0.6; 3],
            ..plain()
        },
        false,
    );
    unused_effects_are_free::<MIRRORED>(
        Material {
            mirror: [0.5; 3],
            ..plain()
        },
        true,
    );
    let glass = Material {
        transmit: [0.9; 3],
        ..plain()
    };
    unused_effects_are_free::<CLEAR>(glass.clone(), false);
    let absorption = [0.3, 0.1, 0.6];
    unused_effects_are_free::<TINTED>(
        Material {
            absorption,
            ..glass
        },
        true,
    );
}

/// A clear glass ball in white surroundings, which fills the picture.
fn furnace() -> SceneFile {
    let mut scene = scenes::of([Shape::Sphere(Sphere {
        center: DVec3::new(0.3, -0.2, 0.1),
        radius: 1.0,
    })]);
    scene.materials = vec![Material {
        diffuse: Diffuse::Plain([0.0; 3]),
        transmit: [1.0; 3],
        ior: 1.5,
        ..Material::default()
    }];
    scene.background = Some([1.0; 3]);
    scene.camera = Some(Camera {
        eye: DVec3::new(0.3, -0.2, 40.0),
        target: DVec3::new(0.3, -0.2, 0.1),
        up: DVec3::Y,
        // Up to 0.9 of the ball's radius in the picture's corners.
        fov_degrees: 2.0 * (0.63_f64 / 39.9).atan().to_degrees(),
    });
    scene.render.depth = 16;
    scene.render.cutoff = 0.0;
    scene
}

#[test]
fn glass_in_white_surroundings_is_white() {
    let blob = scenes::blob(&furnace(), 24);
    let scene = blob.scene().expect("a scene");
    let settings = Settings {
        width: 48,
        height: 48,
        samples: 4,
        ..Settings::of(&scene)
    };
    for format in Format::ALL {
        let pixels = picture(&scene, &job(format, settings)).pixels;
        let darkest = pixels.iter().flatten().min().copied().unwrap_or(0);
        let lost = 1.0 - f64::from(darkest) / 65_535.0;
        eprintln!("white furnace, {}: at most {lost:.1e} lost", format.name());
        assert!(lost < 1e-3, "{}", format.name());
    }
}

/// More depth never makes a picture darker: light is only added.
#[test]
fn depth_only_adds_light() {
    let mut scene = furnace();
    scene.materials[0].absorption = [0.05, 0.1, 0.2];
    scene.objects.extend(
        scenes::of([Shape::Box(Cuboid {
            min: DVec3::new(-3.0, -3.0, -5.0),
            max: DVec3::new(3.0, 3.0, -4.0),
        })])
        .objects,
    );
    let blob = scenes::blob(&scene, 24);
    let scene = blob.scene().expect("a scene");
    fn monotone<N: Number>(scene: &Scene<'_>) {
        let mut last = vec![[0; 3]; 48 * 36];
        for depth in 0..=16 {
            let settings = Settings {
                depth,
                ..small(scene)
            };
            let pixels = picture(scene, &job(N::FORMAT, settings)).pixels;
            // Floats round sums; one step of 65,535 is forgiven.
            let fell = pixels
                .iter()
                .flatten()
                .zip(last.iter().flatten())
                .any(|(&now, &then)| now + 1 < then);
            assert!(!fell, "{}, depth {depth}", N::FORMAT.name());
            last = pixels;
        }
        assert!(last.iter().flatten().any(|&channel| channel > 30_000));
    }
    every_format!(monotone(&scene));
}

/// Sums of ambient light, lights and reflections reach far beyond the largest radiance of `fixed`.
#[test]
fn more_light_than_numbers_hold_is_white() {
    let sum = |ambient: f64, lights: usize, color: f64, mirror: f64| {
        let mut file = furnace();
        file.materials = vec![Material {
            diffuse: Diffuse::Plain([1.0; 3]),
            mirror: [mirror; 3],
            ..Material::default()
        }];
        file.ambient = [ambient; 3];
        file.background = Some([ambient.max(2.0); 3]);
        file.lights = vec![
            Light::Directional {
                direction: DVec3::NEG_Z,
                color: [color; 3],
            };
            lights
        ];
        let blob = scenes::blob(&file, 24);
        let scene = blob.scene().expect("a scene");
        let settings = Settings {
            width: 16,
            height: 16,
            samples: 2,
            ..Settings::of(&scene)
        };
        for format in Format::ALL {
            let pixels = picture(&scene, &job(format, settings)).pixels;
            let darkest = pixels.iter().flatten().min().copied();
            let about = format!("{} {ambient} {lights} {color} {mirror}", format.name());
            assert_eq!(darkest, Some(u16::MAX), "{about}");
        }
    };
    for mirror in [0.0, 1.0] {
        for ambient in [0.0, 2.0, 2000.0, 2047.9, 2048.0, 1e9] {
            for color in [2.0, 100.0, 2048.0, 1e9] {
                sum(ambient, 1, color, mirror);
                sum(ambient, 3, color, mirror);
            }
        }
    }
}
