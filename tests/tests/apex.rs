//! Apex lists are used by the rays of their points only; ray classes by the scene's own.

use glam::DVec3;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::{
    Accel, Apex, Counters, List, NoCount, Number, Ray, RayClasses, Scene, Settings, Stack,
    Structure, any_hit,
};
use gridel_host::compile::{Options, compile};
use gridel_host::picture_rays::PictureRays;
use gridel_host::scene::{Camera, Light, Scene as SceneFile, Shape};
use gridel_host::shape::Sphere;
use gridel_tests::every_format;
use gridel_tests::query::{HitBits, any, closest};
use gridel_tests::scenes;

/// A scene with a camera and two point lights, one of them among the objects.
fn lit_soup() -> SceneFile {
    let color = [0.5; 3];
    SceneFile {
        lights: [DVec3::new(3.0, 5.0, 4.0), DVec3::new(0.1, 0.2, -0.3)]
            .map(|position| Light::Point { position, color })
            .to_vec(),
        ..scenes::soup(31, 200, 0.25)
    }
}

/// The scene with lights far away: one askew, one along an axis, and one between two axes.
fn soup_lit_from_afar() -> SceneFile {
    let mut scene = lit_soup();
    let color = [0.2; 3];
    let directions = [
        DVec3::new(0.3, -1.0, 0.4),
        DVec3::new(0.0, 0.0, -2.0),
        DVec3::new(-1.0, 1.0, 0.1),
    ];
    let lights = directions.map(|direction| Light::Directional { direction, color });
    scene.lights.extend(lights);
    scene
}

fn settings(scene: &Scene<'_>) -> Settings {
    Settings {
        width: 64,
        height: 48,
        samples: 1,
        ..Settings::of(scene)
    }
}

/// Returns how many rays use the hierarchy. All answers must equal those of brute force.
fn fallen_back<N: Number, A: Accel>(scene: &Scene<'_>, rays: &[Ray<N>]) -> usize {
    let falls = |ray: &&Ray<N>| {
        let mut work = Counters::default();
        let hit = closest::<N, A>(scene, ray, &mut work);
        let listed = closest::<N, List>(scene, ray, &mut NoCount);
        let bits = listed.as_ref().map(HitBits::of);
        assert_eq!(hit.as_ref().map(HitBits::of), bits, "{ray:?}");
        assert_eq!(any::<N, A>(scene, ray), bits.is_some(), "{ray:?}");
        work.planes > 0
    };
    rays.iter().filter(falls).count()
}

#[test]
fn apexes_serve_the_rays_of_the_eye_and_of_lights() {
    fn in_format<N: Number>(name: &str, scene: &Scene<'_>) {
        let rays = PictureRays::<N>::of(scene, settings(scene)).expect("rays");
        // A ray that misses everything may miss the windows too, and then starts at the hierarchy's
        // root.
        let meets = |ray: &&Ray<N>| any::<N, List>(scene, ray);
        let seen: Vec<_> = rays.primary.iter().filter(meets).copied().collect();
        let format = N::FORMAT.name();
        assert!(seen.len() > 300, "{name}, {format}: {} hits", seen.len());
        assert_eq!(fallen_back::<N, Apex>(scene, &seen), 0, "{name}, {format}");
        fallen_back::<N, Apex>(scene, &rays.primary);
        let shaded: Vec<_> = rays.shadow.iter().filter(meets).copied().collect();
        assert!(!shaded.is_empty(), "{name}, {format}");
        // Lists show whether anything is in the way, though they are cut; the first hit may lie
        // behind the cut.
        let asks_on = |ray: &&Ray<N>| {
            let mut work = Counters::default();
            let mut stack = Stack::<MAX_STACK_DEPTH>::new();
            assert!(any_hit::<N, Apex, _>(
                scene,
                ray,
                stack.as_view(),
                &mut work
            ));
            work.planes > 0
        };
        let any = shaded.iter().filter(asks_on).count();
        let first = fallen_back::<N, Apex>(scene, &shaded);
        let all = shaded.len();
        println!("{name}, {format}: of {all} rays in shadow {any} and {first} ask the hierarchy");
        assert_eq!(any, 0, "{name}, {format}");
        assert!(10 * first <= all, "{name}, {format}: {first} of {all}");
        fallen_back::<N, Apex>(scene, &rays.shadow);
        fallen_back::<N, Apex>(scene, &rays.bounced);
    }
    let chess = scenes::read(&scenes::fixture_folder().join("glass-chess.toml"));
    for (name, scene) in [("soup", soup_lit_from_afar()), ("glass-chess", chess)] {
        let blob = compile(&scene, &options(Structure::Apex, None))
            .expect("compiles")
            .blob;
        let scene = blob.scene().expect("a scene");
        every_format!(in_format(name, &scene));
    }
}

#[test]
fn a_moved_camera_falls_back() {
    let blob = compile(&lit_soup(), &options(Structure::Apex, None))
        .expect("compiles")
        .blob;
    let scene = blob.scene().expect("a scene");
    let eye = scene.view().eye.map(|x| x as f64 / 8192.0);
    let rays = |moved: f64| -> Vec<Ray<f32>> {
        let target = |number: u32| {
            let [x, y] = [number % 32, number / 32].map(|part| f64::from(part) / 16.0 - 1.0);
            [9000.0 * x, 9000.0 * y, 9000.0 * (x - y)]
        };
        let origin = [eye[0] + moved, eye[1] - moved, eye[2] + moved];
        let ray = |number| {
            let target: [f64; 3] = target(number);
            let direction = [0, 1, 2].map(|k| target[k] - origin[k]);
            Ray::from_f64(scene.bounds(), origin, direction, 0.0, 1e9).ok()
        };
        (0..1024).filter_map(ray).collect()
    };
    assert_eq!(fallen_back::<f32, Apex>(&scene, &rays(0.0)), 0);
    // By a thousandth of the scene.
    assert_eq!(fallen_back::<f32, Apex>(&scene, &rays(65.0)), 1024);
}

/// Where a list has few cells, they reach far beyond the picture.
#[test]
fn rays_beyond_the_picture_find_all_objects() {
    fn in_format<N: Number>(served: &mut usize, scene: &Scene<'_>) {
        let eye = scene.view().eye.map(|x| x as f64 / 8192.0);
        let sides = scene.bounds().0.map(|side| side.map(f64::from));
        // All over the scene's box, and beside it.
        let ray = |number: u32| {
            let [x, y] = [number % 64, number / 64].map(|part| f64::from(part) / 63.0);
            let at = [1.2 * x - 0.1, 1.2 * y - 0.1, (x * 7.0 + y * 5.0) % 1.0];
            let direction = [0, 1, 2].map(|k| {
                let [low, high] = sides[k];
                low + (high - low) * at[k] - eye[k]
            });
            Ray::<N>::from_f64(scene.bounds(), eye, direction, 0.0, 1e9).ok()
        };
        let rays: Vec<_> = (0..4096).filter_map(ray).collect();
        *served += rays.len() - fallen_back::<N, Apex>(scene, &rays);
    }
    let ball = |x: f64| {
        Shape::Sphere(Sphere {
            center: DVec3::new(x, 0.0, 0.0),
            radius: 1.0,
        })
    };
    let mut served = 0;
    for count in [1, 2, 5, 30] {
        for fov_degrees in [12.0, 41.0, 80.0, 120.0] {
            // One within the picture, and one far aside.
            let balls = scenes::of([ball(0.0), ball(7.5)].into_iter().take(count as usize));
            let soup = scenes::soup(count, count as usize, 0.4);
            for (mut scene, distance) in [(balls, 10.0), (soup, 4.0)] {
                scene.camera = Some(Camera {
                    eye: DVec3::new(0.3, 0.2, distance),
                    target: DVec3::new(0.0, 0.1 * fov_degrees / 40.0, 0.0),
                    up: DVec3::Y,
                    fov_degrees,
                });
                let blob = compile(&scene, &options(Structure::Apex, None))
                    .expect("compiles")
                    .blob;
                let scene = blob.scene().expect("a scene");
                every_format!(in_format(&mut served, &scene));
            }
        }
    }
    assert!(served > 100_000, "{served}");
}

#[test]
fn classes_serve_the_scenes_own_rays_within_their_budget() {
    // A view in which rays run in many directions.
    let scene = SceneFile {
        camera: Some(Camera {
            eye: DVec3::new(2.4, 1.9, 5.3),
            target: DVec3::ZERO,
            up: DVec3::Y,
            fov_degrees: 40.0,
        }),
        ..lit_soup()
    };
    let mut last = usize::MAX;
    for budget in [20_000, 200_000, 2_000_000] {
        let compiled = compile(&scene, &options(Structure::RayClasses, Some(budget)));
        let compiled = compiled.expect("compiles");
        let figures = compiled.report.tables[0].figures;
        assert!(figures.bytes <= budget, "{figures:?}");
        let scene = compiled.blob.scene().expect("a scene");
        let rays = PictureRays::<f32>::of(&scene, settings(&scene));
        let rays = rays.expect("rays");
        let all = [rays.primary, rays.shadow, rays.bounced].concat();
        let fallen = fallen_back::<f32, RayClasses>(&scene, &all);
        eprintln!(
            "{budget} bytes: {fallen} of {} rays ask the hierarchy",
            all.len()
        );
        assert!(fallen <= last);
        last = fallen;
    }
}

fn options(structure: Structure, budget: Option<u64>) -> Options {
    Options {
        // The hierarchy through which the picture's rays are found.
        structures: vec![structure, Structure::Flagged],
        budget,
        ..Options::default()
    }
}
