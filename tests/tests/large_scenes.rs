//! Objects of size 1 in scenes of 1e2 to 1e6. A surface's error bound depends on its own position and size, not on the
//! scene's.

use glam::{DQuat, DVec3};
use gridel_core::render::{Pixel, Rgb888};
use gridel_core::{Format, Settings, Structure};
use gridel_host::blob::Blob;
use gridel_host::compile::{Compiled, Options, compile};
use gridel_host::render::{Job, render};
use gridel_host::resolution::{Unresolved, unresolved};
use gridel_host::scene::{
    Camera, Diffuse, Instance, Light, Material, Part, Placement, Scene, Shape, SourceSpan,
};
use gridel_host::shape::{Cuboid, Disc, Plane, Sphere};
use gridel_host::verify::{Property, verify};
use gridel_tests::effort::part_of;
use gridel_tests::measured::compiled;
use gridel_tests::scenes;

/// Pixels as a screen has them.
pub(crate) fn picture(blob: &Blob, format: Format, [width, height]: [u16; 2]) -> Vec<[u8; 3]> {
    let scene = blob.scene().expect("a scene");
    let settings = Settings {
        width,
        height,
        samples: 1,
        ..Settings::of(&scene)
    };
    let job = Job::whole(format, Structure::DualSplit, settings);
    let picture = render(&scene, &job, &|| ()).expect("a picture");
    let encode = |&pixel: &[u16; 3]| Rgb888::encode(pixel, None).0;
    picture.pixels.iter().map(encode).collect()
}

/// Returns the number of pixels that differ by more than 8 of 255.
pub(crate) fn differing(a: &[[u8; 3]], b: &[[u8; 3]]) -> usize {
    let differ = |(a, b): &(&[u8; 3], &[u8; 3])| (0..3).any(|k| a[k].abs_diff(b[k]) > 8);
    a.iter().zip(b).filter(differ).count()
}

/// The ground of a small box.
#[derive(Clone, Copy, Debug)]
enum Ground {
    Slab,
    Cube,
    Triangles,
    Disc,
    TiltedTriangles,
    TiltedDisc,
    Plane,
    TiltedPlane,
}

const TILT: f64 = 1e-3;

impl Ground {
    const ALL: [Ground; 8] = [
        Ground::Slab,
        Ground::Cube,
        Ground::Triangles,
        Ground::Disc,
        Ground::TiltedTriangles,
        Ground::TiltedDisc,
        Ground::Plane,
        Ground::TiltedPlane,
    ];

    fn shape(self, extent: f64) -> Shape {
        let corner = |x: f64, y: f64, z: f64| DVec3::new(x, y, z) * extent;
        let quad = |tilt: f64| Shape::Mesh {
            vertices: vec![
                corner(-1.0, -tilt, -1.0),
                corner(-1.0, -tilt, 1.0),
                corner(1.0, tilt, 1.0),
                corner(1.0, tilt, -1.0),
            ],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
        };
        let disc = |normal| {
            Shape::Disc(Disc {
                center: DVec3::ZERO,
                normal,
                radius: extent,
            })
        };
        match self {
            Ground::Slab => Shape::Box(Cuboid {
                min: DVec3::new(-extent, -1.0, -extent),
                max: DVec3::new(extent, 0.0, extent),
            }),
            Ground::Cube => Shape::Box(Cuboid {
                min: corner(-1.0, -1.0, -1.0),
                max: corner(1.0, 0.0, 1.0),
            }),
            Ground::Triangles => quad(0.0),
            Ground::Disc => disc(DVec3::Y),
            Ground::TiltedTriangles => quad(TILT),
            Ground::TiltedDisc => disc(DVec3::new(-TILT, 1.0, 0.0)),
            Ground::Plane => Shape::Plane(Plane {
                point: corner(0.5, 0.0, 0.0),
                normal: DVec3::Y,
            }),
            Ground::TiltedPlane => Shape::Plane(Plane {
                point: DVec3::ZERO,
                normal: DVec3::new(-TILT, 1.0, 0.0),
            }),
        }
    }
}

/// A box of 0.6 on a ground, in the light of a sun.
fn box_on(ground: Ground, extent: f64) -> Scene {
    let small = Shape::Box(Cuboid {
        min: DVec3::new(-0.3, 0.0, -0.3),
        max: DVec3::new(0.3, 0.6, 0.3),
    });
    let mut scene = scenes::of([ground.shape(extent), small]);
    scene.ambient = [0.2; 3];
    scene.lights = vec![Light::Directional {
        direction: DVec3::new(-1.0, -2.0, -0.75),
        color: [0.7; 3],
    }];
    scene.camera = Some(Camera {
        eye: DVec3::new(1.5, 1.25, 2.0),
        target: DVec3::new(-0.125, 0.25, 0.0),
        up: DVec3::Y,
        fov_degrees: 45.0,
    });
    scene
}

#[test]
fn a_box_on_a_large_ground_keeps_its_shadow() {
    for ground in Ground::ALL {
        let step = part_of(3, 1);
        for extent in [1e3, 1e4, 1e5, 1e6].into_iter().step_by(step) {
            let plain = box_on(ground, extent);
            let Compiled { blob, report } = compile(&plain, &Options::default()).expect("compiles");
            let size = [640, 480];
            let right = picture(&blob, Format::F64, size);
            let off = |format| differing(&picture(&blob, format, size), &right);
            let (f32, fixed) = (off(Format::F32), off(Format::Fixed));
            // A step of the lattice is the uncertainty of the scene itself; this is its effect on the picture.
            let mut looked = plain.clone();
            if let Some(camera) = &mut looked.camera {
                camera.eye += report.step;
            }
            let looked = compiled(&looked);
            let moved = differing(&picture(&looked, Format::F64, size), &right);
            eprintln!("{ground:?} {extent:e}: f32 {f32} fixed {fixed}, a step of the eye {moved}");
            assert!(f32 <= 5, "{ground:?} {extent:e}: f32 {f32}");
            assert!(
                fixed <= moved,
                "{ground:?} {extent:e}: fixed {fixed}, {moved}"
            );
        }
    }
}

/// A ball of glass that lies on a ground of chequers.
fn ball_on(ground: Ground, extent: f64, shift: DVec3) -> Scene {
    let ball = Shape::Sphere(Sphere {
        center: DVec3::new(0.0, 0.75, 0.0) + shift,
        radius: 0.75,
    });
    let mut scene = scenes::of([ground.shape(extent), ball]);
    scene.materials = vec![
        Material {
            diffuse: Diffuse::Checker {
                even: [0.8; 3],
                odd: [0.2, 0.1, 0.1],
                size: 0.5,
                origin: DVec3::ZERO,
            },
            ..Material::default()
        },
        Material {
            diffuse: Diffuse::Plain([0.05; 3]),
            transmit: [0.9; 3],
            ior: 1.5,
            ..Material::default()
        },
    ];
    scene.objects[1].material = 1;
    scene.background = Some([0.3, 0.5, 0.8]);
    scene.ambient = [0.2; 3];
    scene.lights = vec![Light::Directional {
        direction: DVec3::new(-1.0, -2.0, -0.75),
        color: [0.7; 3],
    }];
    scene.camera = Some(Camera {
        eye: DVec3::new(0.5, 1.5, 4.0),
        target: DVec3::new(0.0, 0.625, 0.0),
        up: DVec3::Y,
        fov_degrees: 40.0,
    });
    scene.render.depth = 6;
    scene
}

#[test]
fn a_glass_ball_differs_by_no_more_than_a_step_of_the_lattice() {
    for ground in [Ground::Slab, Ground::Cube, Ground::Disc, Ground::Triangles] {
        for extent in [1e2, 1e3, 1e4, 1e5].into_iter().step_by(part_of(3, 1)) {
            let plain = ball_on(ground, extent, DVec3::ZERO);
            let one = compile(&plain, &Options::default()).expect("compiles");
            let step = one.report.step;
            let size = [320, 240];
            let right = picture(&one.blob, Format::F64, size);
            let off = |format| differing(&picture(&one.blob, format, size), &right);
            let moved = |shift: DVec3| {
                let moved = compiled(&ball_on(ground, extent, shift * step));
                differing(&picture(&moved, Format::F64, size), &right)
            };
            let moved = DVec3::AXES.map(moved);
            let (f32, fixed) = (off(Format::F32), off(Format::Fixed));
            eprintln!(
                "{ground:?} {extent:e}: f32 {f32} fixed {fixed}, a step of the ball {moved:?}"
            );
            let most = moved.into_iter().max().expect("three");
            assert!(f32 <= most && fixed <= most, "{ground:?} {extent:e}");
        }
    }
}

/// Mirrors, glass, chequers and shadows: on a plane as on a ground so large that its edge is a pixel away from the
/// horizon.
#[test]
fn a_plane_looks_like_a_large_ground() {
    let size = [320, 240];
    for mirror in [0.0, 0.5] {
        let scene = |ground: Ground| {
            let mut scene = ball_on(ground, 1e4, DVec3::ZERO);
            scene.materials[0].mirror = [mirror; 3];
            compiled(&scene)
        };
        let (plane, tilted) = (scene(Ground::Plane), scene(Ground::TiltedPlane));
        let right = picture(&plane, Format::F64, size);
        let slab = differing(&picture(&scene(Ground::Cube), Format::F64, size), &right);
        let off = |blob: &Blob, format| {
            differing(
                &picture(blob, format, size),
                &picture(blob, Format::F64, size),
            )
        };
        let level = [Format::F32, Format::Fixed].map(|format| off(&plane, format));
        let tilted = [Format::F32, Format::Fixed].map(|format| off(&tilted, format));
        eprintln!("mirror {mirror}: slab {slab}, level {level:?}, tilted {tilted:?}");
        // Chequers near the horizon are smaller than pixels.
        assert!(slab <= 400, "{slab}");
        assert!(
            level.iter().chain(&tilted).all(|&it| it <= 400),
            "{level:?} {tilted:?}"
        );
    }
}

/// Returns a box of 0.6 on the top of a ball. The ball is so large that single precision cannot locate its top.
fn box_on_a_ball() -> Scene {
    let mut scene = box_on(Ground::Slab, 1e6);
    scene.objects[0].shape = Shape::Sphere(Sphere {
        center: DVec3::new(0.0, -1e6, 0.0),
        radius: 1e6,
    });
    scene
}

fn unresolved_in(scene: &Scene) -> Vec<Unresolved> {
    let blob = compiled(scene);
    unresolved(&blob.scene().expect("a scene"))
}

#[test]
fn a_box_on_a_large_box_is_resolved_and_on_a_large_ball_it_is_not() {
    for extent in [1e3, 1e4, 1e5, 1e6] {
        assert_eq!(
            unresolved_in(&box_on(Ground::Slab, extent)),
            [],
            "{extent:e}"
        );
    }
    let [it] = &unresolved_in(&box_on_a_ball())[..] else {
        panic!("one object is not resolved");
    };
    assert_eq!(it.object, 1);
    assert!((it.feature - 0.6).abs() < 0.15, "{it:?}");
    assert!(it.formats.iter().any(|it| it.format == "f32"), "{it:?}");
    assert!(it.resolved_by.contains(&"f64"), "{it:?}");
}

/// Makes a part of an own object, and an instance that moves it. A ball of 20 above it makes the part large enough for
/// scenes of 1e6.
fn place(scene: &mut Scene, object: usize, placement: Placement) {
    let object = scene.objects.remove(object);
    let ball = Shape::Sphere(Sphere {
        center: DVec3::new(0.0, 15.0, 0.0) / placement.scale,
        radius: 10.0 / placement.scale,
    });
    let mut objects = vec![object];
    objects.extend(scenes::of([ball]).objects);
    scene.parts.push(Part {
        name: String::from("part"),
        objects,
        place: SourceSpan::default(),
    });
    scene.instances.push(Instance {
        name: String::from("placed"),
        part: scene.parts.len() - 1,
        placement,
        joint: None,
        place: SourceSpan::default(),
    });
}

fn shift(x: f64, y: f64, z: f64) -> Placement {
    Placement {
        translation: DVec3::new(x, y, z),
        ..Placement::IDENTITY
    }
}

/// The boxes of 0.6 that are not resolved, the instances that place them, and whether `f32` is among the formats.
fn small_boxes(scene: &Scene) -> Vec<(u32, Option<u32>, bool)> {
    let mut found = unresolved_in(scene);
    found.retain(|it| (it.feature - 0.6).abs() < 0.15);
    let is_f32 = |it: &Unresolved| it.formats.iter().any(|it| it.format == "f32");
    let found = found.iter().inspect(|it| {
        assert!(it.resolved_by.contains(&"f64"), "{it:?}");
    });
    found
        .map(|it| (it.object, it.instance, is_f32(it)))
        .collect()
}

#[test]
fn a_box_on_a_large_placed_surface_is_not_resolved() {
    // As own objects are: the box is the second one.
    assert_eq!(small_boxes(&box_on_a_ball()), [(1, None, true)]);
    let mut on_placed_ball = box_on_a_ball();
    place(&mut on_placed_ball, 0, Placement::IDENTITY);
    assert_eq!(small_boxes(&on_placed_ball), [(0, None, true)]);
    let mut both_placed = box_on_a_ball();
    place(&mut both_placed, 0, Placement::IDENTITY);
    place(&mut both_placed, 0, Placement::IDENTITY);
    assert_eq!(small_boxes(&both_placed), [(2, Some(1), true)]);
    // The instance's own number counts, and not that of its part.
    both_placed.instances.swap(0, 1);
    assert_eq!(small_boxes(&both_placed), [(2, Some(0), true)]);

    // A slab's sides are exact; the map of an instance rounds them, the more the farther from its middle.
    let mut slab = box_on(Ground::Slab, 1e6);
    place(&mut slab, 0, Placement::IDENTITY);
    assert_eq!(small_boxes(&slab), [(0, None, false)]);
    place(&mut slab, 0, Placement::IDENTITY);
    assert_eq!(small_boxes(&slab), [(2, Some(1), false)]);
    slab.instances[1].placement = shift(5e5, 0.0, -5e5);
    assert_eq!(small_boxes(&slab), [(2, Some(1), true)]);
}

#[test]
fn a_small_box_placed_far_away_is_not_resolved() {
    let far = DVec3::new(1e6, 0.0, 0.0);
    let turned = Placement {
        rotation: DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.5),
        translation: far,
        scale: 1.0,
    };
    let scaled = Placement {
        scale: 1e-3,
        ..turned
    };
    for placement in [shift(1e6, 0.0, 0.0), turned, scaled] {
        let ball = Shape::Sphere(Sphere {
            center: DVec3::ZERO,
            radius: 1.0,
        });
        let small = Shape::Box(Cuboid {
            min: DVec3::splat(-0.3 / placement.scale),
            max: DVec3::splat(0.3 / placement.scale),
        });
        let mut scene = scenes::of([ball, small]);
        place(&mut scene, 1, placement);
        assert_eq!(small_boxes(&scene), [(1, Some(0), true)]);
        let found = serde_json::to_value(unresolved_in(&scene)).expect("JSON");
        assert_eq!(found[0]["instance"], 0, "{found}");
        // Near the others it is resolved.
        scene.instances[0].placement.translation = DVec3::new(0.0, 1.3, 0.0);
        assert_eq!(unresolved_in(&scene), []);
    }
}

#[test]
fn small_placed_objects_near_the_middle_are_resolved() {
    for extent in [1e3, 1e4, 1e5] {
        let mut scene = box_on(Ground::Slab, extent);
        place(&mut scene, 1, Placement::IDENTITY);
        assert_eq!(unresolved_in(&scene), [], "{extent:e}");
        if extent < 1e5 {
            place(&mut scene, 0, Placement::IDENTITY);
            assert_eq!(unresolved_in(&scene), [], "{extent:e}");
        }
    }
    assert_eq!(
        unresolved_in(&scenes::read(
            &scenes::fixture_folder().join("robot-arm.toml")
        )),
        []
    );
}

#[test]
fn reports_of_own_objects_name_no_instance() {
    let found = serde_json::to_value(unresolved_in(&box_on_a_ball())).expect("JSON");
    assert!(found[0].get("instance").is_none(), "{found}");
}

#[test]
fn verify_reports_contact_shadows_that_single_precision_loses() {
    let report = |scene: &Scene| {
        let blob = compiled(scene);
        let report = verify(&blob.scene().expect("a scene"), 2000, &|| ());
        let shadows = report.properties.into_iter();
        let mut shadows = shadows.filter(|it| it.property == Property::Shadows);
        shadows.next().expect("the property")
    };
    let kept = report(&box_on(Ground::Slab, 1e6));
    assert!(kept.checked > 50, "{kept:?}");
    assert_eq!(kept.broken, 0, "{kept:?}");
    let lost = report(&box_on_a_ball());
    assert!(lost.broken > 0, "{lost:?}");
    let example = &lost.examples[0];
    assert_eq!(example.format, "f32", "{example:?}");
    // As `explain --ray` takes it.
    let numbers: Vec<_> = example.ray.split(',').map(str::parse::<f64>).collect();
    assert!(
        numbers.len() >= 6 && numbers.iter().all(Result::is_ok),
        "{example:?}"
    );
}
