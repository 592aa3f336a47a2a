//! The story of a pixel is that of the pixel that is rendered: the same hits, and parts that add up.

use gridel_core::{Format, Scene, Settings, Structure};
use gridel_host::explain::{
    Culled, Fall, Names, Sample, Shown, Step, Story, Subject, Verdict, Walk, explain,
};
use gridel_host::render::{Job, render};
use gridel_host::scene::{Color, Light, Object, Place, Shape};
use gridel_host::shape::{Cuboid, Sphere};
use gridel_host::trace::{Frame, Query, SceneHit, SceneRay, trace};
use gridel_tests::scenes;
use std::collections::HashMap;

/// The sum of what the rays of a sample add, in the arithmetic of the format.
fn sum(format: Format, sample: &Sample) -> Color {
    let mut sum = [0.0; 3];
    for ray in &sample.rays {
        for (channel, added) in sum.iter_mut().zip(ray.added) {
            *channel += added;
            if format == Format::F32 {
                *channel = f64::from(*channel as f32);
            }
        }
    }
    sum.map(|channel| channel.clamp(0.0, 1.0))
}

fn parts_add_up(name: &str, scene: &Scene<'_>, samples: u16) {
    let settings = Settings {
        width: 32,
        height: 24,
        samples,
        ..Settings::of(scene)
    };
    let structures = Structure::ALL.into_iter().filter(|&s| scene.holds(s));
    for (format, structure) in structures.flat_map(|s| Format::ALL.map(|format| (format, s))) {
        let job = Job {
            count: true,
            ..Job::whole(format, structure, settings)
        };
        let picture = render(scene, &job, &|| ()).expect("a picture");
        let (mut hits, mut rays, mut opened) = (0, 0, 0);
        for place in (0..picture.pixels.len()).step_by(7) {
            let pixel = [(place % 32) as u16, (place / 32) as u16];
            let about = || format!("{name} {} {} {pixel:?}", format.name(), structure.name());
            let story = explain(scene, format, structure, settings, Subject::Pixel(pixel));
            let story = story.expect("a story");
            assert_eq!(story.linear, picture.pixels[place], "{}", about());
            assert_eq!((story.pixel, story.picture), (Some(pixel), Some([32, 24])));
            assert_eq!(story.samples.len(), usize::from(samples));
            for sample in &story.samples {
                assert_eq!(sum(format, sample), sample.radiance, "{}", about());
                for (number, ray) in sample.rays.iter().enumerate() {
                    hits += usize::from(ray.hit.is_some());
                    rays += 1;
                    opened += ray.walk.as_ref().map_or(0, |walk| walk.opened);
                    for &child in &ray.children {
                        assert_eq!(sample.rays[child].parent, Some(number), "{}", about());
                        assert_eq!(sample.rays[child].depth, ray.depth + 1, "{}", about());
                    }
                    // What was met is the last candidate that was the nearest.
                    let met = ray.walk.as_ref().and_then(|walk| walk.met());
                    assert_eq!(
                        ray.hit.as_ref().map(|hit| hit.primitive),
                        met.map(|met| met.primitive),
                        "{}",
                        about()
                    );
                }
            }
            // What is told is what was counted, shadow rays' tests included.
            let walks = || {
                story.samples.iter().flat_map(|s| &s.rays).flat_map(|ray| {
                    let shadows = ray.lights.iter().flat_map(|light| &light.shadow);
                    ray.walk.iter().chain(shadows)
                })
            };
            let candidates: usize = walks().map(|walk| walk.candidates).sum();
            let tested: usize = walks()
                .flat_map(|walk| &walk.steps)
                .filter(|step| matches!(step, Step::Tested(_)))
                .count();
            assert_eq!(
                (tested + candidates) as u32,
                picture.work[place],
                "{}",
                about()
            );
        }
        eprintln!(
            "{name:12} {:5} {:8}: {rays} rays, {hits} hits, {opened} nodes",
            format.name(),
            structure.name()
        );
        assert!(hits > 0);
        assert!(opened > 0 || structure == Structure::List);
    }
}

#[test]
fn parts_add_up_to_the_pixel() {
    for (name, scene) in scenes::fixtures() {
        if ["glass-chess", "quick", "cornell", "c60"].contains(&name.as_str()) {
            let blob = scenes::blob(&scene, 24);
            let scene = blob.scene().expect("a scene");
            parts_add_up(&name, &scene, 1);
            parts_add_up(&name, &scene, 5);
        }
    }
}

/// A ray's own story tells the hit that `trace` gives.
#[test]
fn a_rays_hit_is_the_one_that_is_traced() {
    let blob = scenes::blob(&scenes::soup(11, 200, 0.3), 24);
    let scene = blob.scene().expect("a scene");
    let mut random = gridel_tests::random::Random(5);
    for _ in 0..300 {
        let ray = SceneRay {
            origin: glam::DVec3::from_array(random.direction()) * 3.0,
            direction: glam::DVec3::from_array([0; 3].map(|_| random.signed())),
            tmin: 0.0,
            tmax: f64::INFINITY,
        };
        for format in Format::ALL {
            let query = Query {
                format,
                structure: Structure::Flagged,
                any: false,
            };
            let mut hits = [SceneHit::MISS];
            trace(&scene, &[ray], query, &mut hits);
            let settings = Settings::of(&scene);
            let subject = Subject::Ray(ray);
            let story = explain(&scene, format, Structure::Flagged, settings, subject);
            let story = story.expect("a story");
            let hit = story.samples[0].rays[0].hit.as_ref();
            let [traced] = hits;
            assert_eq!(hit.map_or(u32::MAX, |hit| hit.primitive), traced.primitive);
            if let Some(hit) = hit {
                let distance = traced.t * ray.direction.length();
                // The direction is rounded to the format.
                assert!((hit.distance - distance).abs() <= 1e-6 * distance);
            }
        }
    }
}

/// What stands in a light's way is named, and what is culled says why.
#[test]
fn reasons_are_true() {
    let ball = |x: f64, y: f64| {
        Shape::Sphere(Sphere {
            center: glam::DVec3::new(x, y, 0.0),
            radius: 1.0,
        })
    };
    let mut scene = scenes::of([ball(0.0, 0.0), ball(0.0, 5.0), ball(9.0, 9.0)]);
    scene.objects.push(Object {
        name: String::from("floor"),
        material: 0,
        shape: Shape::Box(Cuboid {
            min: glam::DVec3::new(-20.0, -3.0, -20.0),
            max: glam::DVec3::new(20.0, -2.0, 20.0),
        }),
        place: Place::default(),
    });
    scene.lights = vec![
        Light::Directional {
            direction: -glam::DVec3::Y,
            color: [1.0; 3],
        },
        Light::Directional {
            direction: glam::DVec3::Y,
            color: [1.0; 3],
        },
    ];
    let blob = scenes::blob(&scene, 24);
    let scene = blob.scene().expect("a scene");
    let ray = SceneRay {
        origin: glam::DVec3::new(0.0, 2.5, 10.0),
        direction: glam::DVec3::new(0.0, -1.5, -10.0),
        tmin: 0.0,
        tmax: f64::INFINITY,
    };
    let settings = Settings::of(&scene);
    let story = explain(
        &scene,
        Format::F64,
        Structure::Bvh,
        settings,
        Subject::Ray(ray),
    );
    let story = story.expect("a story");
    let first = &story.samples[0].rays[0];
    assert_eq!(first.hit.as_ref().map(|hit| hit.object), Some(0));
    let falls: Vec<_> = first.lights.iter().map(|light| &light.fall).collect();
    let blocked = Fall::Blocked {
        kind: "sphere",
        primitive: 1,
        object: 1,
    };
    assert_eq!(falls, [&blocked, &Fall::Behind]);
    let walk = first.walk.as_ref().expect("a walk");
    let verdicts = walk.steps.iter().filter_map(|step| match step {
        Step::Candidate(candidate) => Some((candidate.primitive, candidate.verdict)),
        _ => None,
    });
    assert!(verdicts.clone().any(|v| v == (0, Verdict::Nearest)));
}

fn story(scene: &Scene<'_>, format: Format, structure: Structure, ray: SceneRay) -> Story {
    let settings = Settings::of(scene);
    explain(scene, format, structure, settings, Subject::Ray(ray)).expect("a story")
}

/// The way of the ray itself.
fn way(story: &Story) -> &Walk {
    story.samples[0].rays[0].walk.as_ref().expect("a walk")
}

fn rays(seed: u64, count: usize) -> impl Iterator<Item = SceneRay> {
    let mut random = gridel_tests::random::Random(seed);
    (0..count).map(move |_| {
        let origin = glam::DVec3::from_array(random.direction()) * 3.0;
        let target = glam::DVec3::from_array([0; 3].map(|_| random.signed()));
        SceneRay {
            origin,
            direction: target - origin,
            tmin: 0.0,
            tmax: f64::INFINITY,
        }
    })
}

/// Whether a hierarchy culls in integers or in lanes, it tells where a ray is in the same units.
#[test]
fn spans_are_told_in_units() {
    let blob = scenes::blob(&scenes::soup(12, 120, 0.1), 24);
    let scene = blob.scene().expect("a scene");
    let unit = Frame::of(&scene).length(1.0);
    let held: Vec<_> = Structure::ALL
        .into_iter()
        .filter(|&s| scene.holds(s))
        .collect();
    for structure in held {
        let mut compared = 0;
        // Where something is met, how far a ray is followed depends on the order of tests.
        let steep = |ray: &SceneRay| {
            let along = ray.direction.abs();
            along.min_element() > 0.2 * along.max_element()
        };
        for ray in rays(6, 400).filter(steep) {
            let [fixed, f32, f64] = Format::ALL.map(|format| story(&scene, format, structure, ray));
            if fixed.samples[0].rays[0].hit.is_some() {
                continue;
            }
            let fixed = spans(way(&fixed));
            for other in [&f32, &f64].map(|story| spans(way(story))) {
                for (place, fixed) in &fixed {
                    let other = other.get(place).into_iter().flatten();
                    for (a, b) in fixed.iter().zip(other) {
                        compared += 1;
                        let apart = [0, 1].map(|side| (a[side] - b[side]).abs() / unit);
                        let about = || format!("{} {place}: {a:?} {b:?}", structure.name());
                        assert!(apart[0].max(apart[1]) < 16.0, "{}", about());
                    }
                }
            }
        }
        eprintln!("{}: {compared} spans", structure.name());
        let culls_in_lanes = [
            Structure::Bvh,
            Structure::Apex,
            Structure::CylinderCubeEntry,
            Structure::RayClasses,
            Structure::Wide,
        ];
        assert!(compared > 100 || !culls_in_lanes.contains(&structure));
    }
}

/// The spans of every place that was tested, in order.
fn spans(walk: &Walk) -> HashMap<&str, Vec<[f64; 2]>> {
    let mut spans: HashMap<&str, Vec<[f64; 2]>> = HashMap::new();
    for step in &walk.steps {
        if let Step::Tested(tested) = step {
            spans.entry(&tested.place).or_default().push(tested.span);
        }
    }
    spans
}

/// What is told to be left out is not gone into, and what is not is gone into or given up.
#[test]
fn what_is_told_is_what_is_done() {
    let path = scenes::fixture_folder().join("glass-chess.toml");
    let blob = scenes::blob(&scenes::read(&path), 24);
    let scene = blob.scene().expect("a scene");
    let of_one = SceneRay {
        origin: glam::DVec3::new(-5.0, 3.0, 0.0),
        direction: glam::DVec3::new(1.0, -0.5, 0.0),
        tmin: 0.0,
        tmax: f64::INFINITY,
    };
    let more = rays(7, 150).map(|ray| SceneRay {
        origin: ray.origin * 4.0,
        direction: ray.direction * 4.0,
        ..ray
    });
    let rays: Vec<_> = std::iter::once(of_one).chain(more).collect();
    let held: Vec<_> = Structure::ALL
        .into_iter()
        .filter(|&s| scene.holds(s))
        .collect();
    for (format, structure) in held.iter().flat_map(|&s| Format::ALL.map(|f| (f, s))) {
        let mut empty = 0;
        for ray in &rays {
            let story = story(&scene, format, structure, *ray);
            let about = || format!("{} {} {ray:?}", format.name(), structure.name());
            let (mut left_out, mut opened, mut entered) = (vec![], vec![], vec![]);
            for step in &way(&story).steps {
                match step {
                    Step::Tested(tested) if tested.culled.is_some() => {
                        left_out.push(&tested.place);
                        empty += usize::from(tested.culled == Some(Culled::Empty));
                    }
                    Step::Tested(tested) => entered.push(&tested.place),
                    Step::Opened { place } => {
                        assert!(!left_out.contains(&place), "{place} {}", about());
                        opened.push(place);
                    }
                    Step::GivenUp { place, .. } => opened.push(place),
                    Step::Candidate(_) => {}
                }
            }
            for place in entered {
                // A grid has no node that stands for all of it.
                let done = opened.contains(&place) || place == "grid 0";
                assert!(done, "{place} {}", about());
            }
            // No two tests read the same.
            let names = Names::default();
            let shown = Shown {
                story: &story,
                names: &names,
                all_walks: false,
            };
            let text = shown.to_string();
            let lines: Vec<_> = text.lines().filter(|line| line.contains("node")).collect();
            let twice = lines.windows(2).find(|pair| pair[0] == pair[1]);
            assert_eq!(twice, None, "{}", about());
        }
        assert_eq!(
            empty > 0,
            structure == Structure::Octree,
            "{}",
            structure.name()
        );
    }
}

/// A light that has no direction, because it lies where the ray to it would start, is told of, too.
#[test]
fn a_light_at_the_point_itself_is_told() {
    let mut scene = scenes::of([Shape::Box(Cuboid {
        min: glam::DVec3::splat(-1.0),
        max: glam::DVec3::ONE,
    })]);
    let ray = SceneRay {
        origin: glam::DVec3::new(0.0, 5.0, 0.0),
        direction: -glam::DVec3::Y,
        tmin: 0.0,
        tmax: f64::INFINITY,
    };
    let mut told = |height: f64| {
        scene.lights = vec![
            Light::Point {
                position: glam::DVec3::Y * height,
                color: [1.0; 3],
            },
            Light::Directional {
                direction: -glam::DVec3::Y,
                color: [1.0; 3],
            },
        ];
        let blob = scenes::blob(&scene, 24);
        let scene = blob.scene().expect("a scene");
        let story = story(&scene, Format::Fixed, Structure::Bvh, ray);
        let ray = &story.samples[0].rays[0];
        let falls: Vec<_> = ray
            .lights
            .iter()
            .map(|l| (l.light, l.fall.clone()))
            .collect();
        let hit = ray.hit.as_ref().expect("a hit");
        // Rays start on the face itself.
        (falls, hit.point[1])
    };
    let (above, start) = told(3.0);
    assert_eq!(above, [(0, Fall::Lit), (1, Fall::Lit)]);
    let (here, _) = told(start);
    assert_eq!(here, [(0, Fall::Here), (1, Fall::Lit)]);
}

/// Checks that `origin + distance * direction` is the point of every hit of a story, as it is told and
/// as it is printed. Returns how many hits there were, and the largest bound that was told.
fn hits_lie_on_their_rays(story: &Story, about: &dyn Fn() -> String) -> (usize, f64) {
    let names = Names::default();
    let text = Shown {
        story,
        names: &names,
        all_walks: false,
    };
    let text = text.to_string();
    let told = serde_json::to_value(story).expect("JSON");
    let numbers = |value: &serde_json::Value| {
        let number = |k: usize| value[k].as_f64().expect("a number");
        glam::DVec3::new(number(0), number(1), number(2))
    };
    let (mut hits, mut largest) = (0, 0.0_f64);
    for sample in told["samples"].as_array().expect("samples") {
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

/// The origin that is told is the ray's own, wherever the kernels start, and distances count from it.
#[test]
fn explain_tells_points_that_lie_on_the_ray_as_given() {
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
                    let story = story(&scene, format, structure, ray);
                    let about = || format!("{} {} {ray:?}", format.name(), structure.name());
                    let walk = way(&story);
                    assert_eq!(walk.origin, ray.origin.to_array(), "{}", about());
                    let (found, error) = hits_lie_on_their_rays(&story, &about);
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
                    let hit = story.samples[0].rays[0].hit.as_ref();
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

/// Rays from the camera, through glass and off mirrors lie on the lines that are told, too.
#[test]
fn explain_tells_points_that_lie_on_the_rays_of_pixels() {
    for (name, scene) in scenes::fixtures() {
        let blob = scenes::blob(&scene, 24);
        let view = blob.scene().expect("a scene");
        let settings = Settings {
            width: 32,
            height: 24,
            samples: 1,
            ..Settings::of(&view)
        };
        let mut hits = 0;
        for format in Format::ALL {
            for place in (0..32 * 24).step_by(11) {
                let pixel = [(place % 32) as u16, (place / 32) as u16];
                let subject = Subject::Pixel(pixel);
                let story = explain(&view, format, Structure::DualSplit, settings, subject);
                let story = story.expect("a story");
                let about = || format!("{name} {} {pixel:?}", format.name());
                hits += hits_lie_on_their_rays(&story, &about).0;
            }
        }
        assert!(hits > 10, "{name}: {hits} hits");
    }
}
