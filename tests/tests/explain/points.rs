//! Hits lie on their rays within the printed bound.

use super::{explanation, rays, way};
use glam::DVec3;
use gridel_core::{Format, Settings, Structure};
use gridel_host::explain::{Explanation, Names, Shown, Step, Subject, Verdict, explain};
use gridel_host::trace::{Frame, SceneRay};
use gridel_tests::scenes;

/// Checks that `origin + distance * direction` is the point of every hit of a explanation, in JSON and
/// in print. Returns the number of hits, and the largest bound.
fn hits_lie_on_their_rays(explanation: &Explanation, about: &dyn Fn() -> String) -> (usize, f64) {
    let names = Names::default();
    let text = Shown {
        explanation,
        names: &names,
        all_walks: false,
    };
    let text = text.to_string();
    let json = serde_json::to_value(explanation).expect("JSON");
    let numbers = |value: &serde_json::Value| {
        let number = |k: usize| value[k].as_f64().expect("a number");
        glam::DVec3::new(number(0), number(1), number(2))
    };
    let (mut hits, mut largest) = (0, 0.0_f64);
    for sample in json["samples"].as_array().expect("samples") {
        for ray in sample["rays"].as_array().expect("rays") {
            let hit = &ray["hit"];
            if hit.is_null() {
                continue;
            }
            let [origin, direction] =
                ["origin", "direction"].map(|name| numbers(&ray["walk"][name]));
            let number = |name: &str| hit[name].as_f64().expect("a number");
            let (distance, error) = (number("distance"), number("distance_error"));
            let apart = (origin + distance * direction).distance(numbers(&hit["point"]));
            assert!(apart <= error, "{}: {apart:e} beyond {error:e}", about());
            hits += 1;
            largest = largest.max(error);
        }
    }
    let mut printed = 0;
    let mut ray = None;
    let mut distance = None;
    for line in text.lines().map(str::trim) {
        let vector = |text: &str| {
            let numbers = text.trim_start_matches('(').split(", ");
            let numbers: Vec<f64> = numbers.map(|x| x.parse().expect("a number")).collect();
            glam::DVec3::from_slice(&numbers)
        };
        if let Some(rest) = line.strip_prefix("from (") {
            let (origin, rest) = rest.split_once(") along (").expect("a direction");
            let (direction, _) = rest.split_once("):").expect("an end");
            ray = Some((vector(origin), vector(direction)));
        } else if line.starts_with("hits the ") {
            let (_, rest) = line.rsplit_once(", at distance ").expect("a distance");
            let (at, within) = rest.split_once(" within ").expect("a bound");
            let number = |text: &str| text.parse::<f64>().expect("a number");
            distance = Some((number(at), number(within)));
        } else if let Some(rest) = line.strip_prefix("at (") {
            let (point, _) = rest.split_once("), which").expect("a point");
            let ((origin, direction), (at, within)) = ray.zip(distance).expect("a ray");
            let apart = (origin + at * direction).distance(vector(point));
            assert!(apart <= within, "{}: {line}, off by {apart:e}", about());
            printed += 1;
        }
    }
    assert_eq!(printed, hits, "{}", about());
    (hits, largest)
}

/// The origin in an explanation is the ray's own, wherever the kernels start, and distances count from it.
#[test]
fn explain_gives_points_that_lie_on_the_given_ray() {
    let blob = scenes::blob(&scenes::soup(13, 150, 0.3), 24);
    let scene = blob.scene().expect("a scene");
    let frame = Frame::of(&scene);
    let size = frame.length(65_536.0);
    for exponent in [0, 1, 4, 10, 20] {
        let far = f64::powi(2.0, exponent);
        let mut hits = 0;
        for (number, near) in rays(8, 60).enumerate() {
            let target = near.origin + near.direction;
            let origin = far * near.origin;
            let ray = SceneRay {
                origin,
                direction: (target - origin) * [1.0, 1e-3, 7e5][number % 3],
                ..near
            };
            for format in Format::ALL {
                for structure in [Structure::List, Structure::DualSplit, Structure::Wide] {
                    let explanation = explanation(&scene, format, structure, ray);
                    let about = || format!("{} {} {ray:?}", format.name(), structure.name());
                    let walk = way(&explanation);
                    assert_eq!(walk.origin, ray.origin.to_array(), "{}", about());
                    let (found, error) = hits_lie_on_their_rays(&explanation, &about);
                    hits += found;
                    // The bound is no excuse: a few steps of the format, and of these numbers.
                    let (bits, digits) = match format {
                        Format::Fixed => (18, 46),
                        Format::F32 => (18, 19),
                        Format::F64 => (46, 46),
                    };
                    let most = f64::powi(2.0, -bits) * size
                        + f64::powi(2.0, -digits) * ray.origin.length();
                    assert!(error <= most, "{}: {error:e} {most:e}", about());
                    // The rest of the way counts from the same place.
                    let met = walk.met().and_then(|met| met.crossing);
                    let hit = explanation.samples[0].rays[0].hit.as_ref();
                    if let (Some([enter, leave]), Some(hit)) = (met, hit) {
                        let apart = |t: f64| (t - hit.distance).abs();
                        let nearest = apart(enter).min(apart(leave));
                        assert!(nearest <= most, "{}: {nearest:e}", about());
                    }
                }
            }
        }
        assert!(hits > 100, "{hits} hits from {far} times as far");
    }
}

/// Rays from the camera, through glass and off mirrors lie on the lines of their explanations, too.
#[test]
fn explain_gives_points_that_lie_on_the_rays_of_pixels() {
    for (name, scene) in scenes::fixtures() {
        let blob = scenes::blob(&scene, 24);
        let view = blob.scene().expect("a scene");
        let settings = Settings {
            width: 32,
            height: 24,
            samples: 1,
            ..Settings::of(&view)
        };
        let frame = Frame::of(&view);
        let reach = frame.length(65_536.0) + scene.camera.map_or(0.0, |it| it.eye.length());
        let mut hits = 0;
        for format in Format::ALL {
            for place in (0..32 * 24).step_by(11) {
                let pixel = [(place % 32) as u16, (place / 32) as u16];
                let subject = Subject::Pixel(pixel);
                let explanation = explain(&view, format, Structure::DualSplit, settings, subject);
                let explanation = explanation.expect("a explanation");
                let about = || format!("{name} {} {pixel:?}", format.name());
                let (found, error) = hits_lie_on_their_rays(&explanation, &about);
                hits += found;
                // The bound is no excuse here, either.
                let most = f64::powi(2.0, -14) * reach;
                assert!(error <= most, "{}: {error:e} {most:e}", about());
            }
        }
        assert!(hits > 10, "{name}: {hits} hits");
    }
}

/// The core takes such rays from nearer places.
#[test]
fn explain_gives_the_distances_of_rays_from_afar() {
    let file = "[[object]]\nkind = 'sphere'\ncenter = [0.1, 0, 0]\nradius = 1\n\
                [[object]]\nkind = 'sphere'\ncenter = [7, 0, 0]\nradius = 1\n";
    let scene = gridel_host::scene::read("a.toml".as_ref(), file.into(), &Default::default());
    let scene = scene.expect("a scene").scene;
    let blob = gridel_host::compile::compile(&scene, &Default::default());
    let blob = blob.expect("a blob").blob;
    let scene = blob.scene().expect("a scene");
    for z in [5.0, 100.3, 1000.0, 1e5, 3e6] {
        let ray = SceneRay {
            origin: DVec3::new(0.3, 0.0, z),
            direction: DVec3::NEG_Z * 0.25,
            tmin: 0.0,
            tmax: f64::INFINITY,
        };
        for format in Format::ALL {
            let explained = explanation(&scene, format, Structure::DualSplit, ray);
            let hit = explained.samples[0].rays[0].hit.as_ref().expect("a hit");
            let expected = z - 0.96_f64.sqrt();
            let error = (hit.distance - expected).abs();
            let bound = 1e-5 + 1e-6 * z;
            assert!(
                error <= bound && hit.distance_error <= bound,
                "{z} {format:?} {hit:?}"
            );
        }
    }
}

/// Planes are hit where no lattice reaches: the point follows from the distance there.
#[test]
fn explain_gives_the_points_of_planes_far_away() {
    let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 2, 0]\nradius = 3\n\
                [[object]]\nkind = 'plane'\npoint = [0, -1, 0]\nnormal = [0, 1, 0]\n\
                [[object]]\nkind = 'plane'\npoint = [0, -2, 0]\nnormal = [0.1, 1, 0.2]\n";
    let scene = gridel_host::scene::read("far.toml".as_ref(), file.into(), &Default::default());
    let blob = gridel_host::compile::compile(&scene.expect("a scene").scene, &Default::default());
    let blob = blob.expect("a blob").blob;
    let scene = blob.scene().expect("a scene");
    for format in Format::ALL {
        let mut farthest = 0.0_f64;
        for exponent in 0..14 {
            let ray = SceneRay {
                origin: DVec3::new(0.0, 20.0, 8.0),
                direction: DVec3::new(f64::powi(10.0, exponent), -21.0, 0.0),
                tmin: 0.0,
                tmax: f64::INFINITY,
            };
            let explained = explanation(&scene, format, Structure::DualSplit, ray);
            let about = || format!("{format:?} {exponent}");
            hits_lie_on_their_rays(&explained, &about);
            if let Some(hit) = &explained.samples[0].rays[0].hit {
                farthest = farthest.max(hit.distance);
                // Slopes are rounded by this part of the way.
                let bits = match format {
                    Format::Fixed => 29,
                    Format::F32 => 23,
                    Format::F64 => 51,
                };
                let most = hit.distance_error + f64::powi(2.0, -bits) * hit.distance;
                let [_, y, z] = hit.point;
                let off = (y + 1.0).abs().max((z - 8.0).abs());
                assert!(off <= most, "{}: {off:e} {most:e} {hit:?}", about());
            }
        }
        let expected = if format == Format::Fixed { 1e7 } else { 9e9 };
        assert!(farthest > expected, "{format:?}: {farthest:e}");
    }
}

/// Rays that leave planes outside of the scene's box start where the plane was hit, also if they pass the box.
#[test]
fn explain_gives_points_that_lie_on_rays_that_leave_planes() {
    let file = |z: f64, wall: DVec3, ground: DVec3| {
        let ahead = z - 5.0;
        format!(
            "background = [0.2, 0.4, 0.8]
            [camera]
            eye = [0, 1, {z}]
            target = [5, 1, {ahead}]
            [render]
            width = 32
            height = 24
            depth = 3
            cutoff = 0
            [[light]]
            kind = 'point'
            position = [0, 4, 2]
            [material.glass]
            transmit = 1
            ior = 1.5
            [material.mirror]
            mirror = 0.5
            [[object]]
            kind = 'plane'
            point = [2, 0, 0]
            normal = {:?}
            material = 'glass'
            [[object]]
            kind = 'plane'
            point = [0, -1, 0]
            normal = {:?}
            material = 'mirror'
            [[object]]
            kind = 'sphere'
            center = [0, 0, 0]
            radius = 1",
            wall.to_array(),
            ground.to_array()
        )
    };
    let across = [DVec3::NEG_X, DVec3::Y];
    let tilted = [DVec3::new(-1.0, 0.25, 0.0), DVec3::new(0.125, 1.0, 0.0)];
    for (z, normals) in [
        (30.0, across),
        (10.0, across),
        (30.0, tilted),
        (10.0, tilted),
    ] {
        let file = file(z, normals[0], normals[1]);
        let scene = gridel_host::scene::read("a.toml".as_ref(), file.into(), &Default::default());
        let scene = scene.expect("a scene").scene;
        let blob = gridel_host::compile::compile(&scene, &Default::default());
        let blob = blob.expect("a blob").blob;
        let scene = blob.scene().expect("a scene");
        let frame = Frame::of(&scene);
        let middle = frame.place([0.0; 3]);
        for format in Format::ALL {
            let bits = match format {
                Format::Fixed => 24,
                Format::F32 => 20,
                Format::F64 => 44,
            };
            let (mut sent, mut passing) = (0, 0);
            for number in (0..32 * 24).step_by(5) {
                let pixel = [number % 32, number / 32];
                let subject = Subject::Pixel(pixel);
                let settings = Settings::of(&scene);
                let explained = explain(&scene, format, Structure::DualSplit, settings, subject);
                let explained = explained.expect("an explanation");
                let about = || format!("{z} {normals:?} {} {pixel:?}", format.name());
                hits_lie_on_their_rays(&explained, &about);
                let rays = &explained.samples[0].rays;
                for ray in rays {
                    let Some((hit, walk)) = ray.hit.as_ref().zip(ray.walk.as_ref()) else {
                        continue;
                    };
                    let point = DVec3::from_array(hit.point);
                    let reach = (point - middle).abs().max_element();
                    let most =
                        hit.distance_error + f64::powi(2.0, -bits) * (reach + hit.distance + 8.0);
                    if (hit.primitive as usize) < normals.len() {
                        let through = [DVec3::new(2.0, 0.0, 0.0), DVec3::NEG_Y];
                        let apart = point - through[hit.primitive as usize];
                        let off = apart.dot(DVec3::from_array(hit.normal)).abs();
                        // The compiler rounds the plane's own point.
                        let most = most + frame.length(1.0 / 256.0);
                        assert!(off <= most, "{}: {off:e} {most:e} {hit:?}", about());
                    }
                    // In `fixed`, rays that wait can start elsewhere if they leave a hit beyond lengths.
                    let has_point = format != Format::Fixed || reach < frame.length(262_112.0);
                    let children = ray.children.iter().filter(|_| has_point);
                    let children = children.filter_map(|&child| rays[child].walk.as_ref());
                    let shadows = ray.lights.iter().filter_map(|light| light.shadow.first());
                    for next in children.chain(shadows) {
                        let off = DVec3::from_array(next.origin).distance(point);
                        assert!(off <= most, "{}: {off:e} {most:e} {next:?}", about());
                        sent += 1;
                        passing += usize::from(next.interval[0] > next.interval[1]);
                    }
                    // Beyond the box, too, what lies ahead is in the interval.
                    let ahead = |step: &&Step| match step {
                        Step::Candidate(it) => it.crossing.is_some_and(|[enter, _]| enter > 1e-3),
                        _ => false,
                    };
                    for step in walk.steps.iter().filter(ahead) {
                        let Step::Candidate(candidate) = step else {
                            continue;
                        };
                        let verdict = candidate.verdict;
                        assert_ne!(verdict, Verdict::NotInInterval, "{}: {walk:?}", about());
                    }
                }
            }
            let about = format!("{z} {normals:?} {format:?}: {sent} rays, {passing} pass the box");
            eprintln!("{about}");
            assert!(sent > 100 && passing > 10, "{about}");
        }
    }
}
