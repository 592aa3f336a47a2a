//! Objects of size 1 in scenes of 1e2 to 1e6: what a surface's error bound is worth is its own place and
//! size, not the scene's.

use glam::DVec3;
use gridel_core::render::{Pixel, Rgb888};
use gridel_core::{Format, Settings, Structure};
use gridel_host::blob::Blob;
use gridel_host::compile::{Compiled, Options, compile};
use gridel_host::render::{Job, render};
use gridel_host::resolution::unresolved;
use gridel_host::scene::{Camera, Diffuse, Light, Material, Scene, Shape};
use gridel_host::shape::{Cuboid, Disc, Plane, Sphere};
use gridel_host::verify::{Property, verify};
use gridel_tests::scenes;

/// Pixels as a screen has them.
fn picture(blob: &Blob, format: Format, [width, height]: [u16; 2]) -> Vec<[u8; 3]> {
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

/// How many pixels differ by more than 8 of 255.
fn differing(a: &[[u8; 3]], b: &[[u8; 3]]) -> usize {
    let differ = |(a, b): &(&[u8; 3], &[u8; 3])| (0..3).any(|k| a[k].abs_diff(b[k]) > 8);
    a.iter().zip(b).filter(differ).count()
}

fn blob(scene: &Scene) -> Blob {
    let options = Options::default();
    compile(scene, &options).expect("compiles").blob
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
        for extent in [1e3, 1e4, 1e5, 1e6] {
            let plain = box_on(ground, extent);
            let Compiled { blob, report } = compile(&plain, &Options::default()).expect("compiles");
            let size = [640, 480];
            let right = picture(&blob, Format::F64, size);
            let off = |format| differing(&picture(&blob, format, size), &right);
            let (f32, fixed) = (off(Format::F32), off(Format::Fixed));
            // What a step of the lattice changes is what the scene itself is known to.
            let mut looked = plain.clone();
            if let Some(camera) = &mut looked.camera {
                camera.eye += report.step;
            }
            let looked = self::blob(&looked);
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
        for extent in [1e2, 1e3, 1e4, 1e5] {
            let plain = ball_on(ground, extent, DVec3::ZERO);
            let one = compile(&plain, &Options::default()).expect("compiles");
            let step = one.report.step;
            let size = [320, 240];
            let right = picture(&one.blob, Format::F64, size);
            let off = |format| differing(&picture(&one.blob, format, size), &right);
            let moved = |shift: DVec3| {
                let moved = blob(&ball_on(ground, extent, shift * step));
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
            blob(&scene)
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

/// A box of 0.6 on the top of a ball so large that single precision does not know where that is.
fn box_on_a_ball() -> Scene {
    let mut scene = box_on(Ground::Slab, 1e6);
    scene.objects[0].shape = Shape::Sphere(Sphere {
        center: DVec3::new(0.0, -1e6, 0.0),
        radius: 1e6,
    });
    scene
}

#[test]
fn a_box_on_a_large_box_is_resolved_and_on_a_large_ball_it_is_not() {
    let unresolved_in = |scene: &Scene| {
        let blob = blob(scene);
        unresolved(&blob.scene().expect("a scene"))
    };
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

#[test]
fn verify_reports_contact_shadows_that_single_precision_loses() {
    let report = |scene: &Scene| {
        let blob = blob(scene);
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
