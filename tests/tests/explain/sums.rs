//! The rays of a pixel add up to the pixel that is rendered.

use gridel_core::{Format, Scene, Settings, Structure};
use gridel_host::explain::{Sample, Step, Subject, explain};
use gridel_host::render::{Job, render};
use gridel_host::scene::Color;
use gridel_host::trace::{Query, SceneHit, SceneRay, trace};
use gridel_tests::scenes;

/// Returns the sum of the light of a sample's rays, in the arithmetic of the format.
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
            let explanation = explain(scene, format, structure, settings, Subject::Pixel(pixel));
            let explanation = explanation.expect("a explanation");
            assert_eq!(explanation.linear, picture.pixels[place], "{}", about());
            assert_eq!(
                (explanation.pixel, explanation.picture),
                (Some(pixel), Some([32, 24]))
            );
            assert_eq!(explanation.samples.len(), usize::from(samples));
            for sample in &explanation.samples {
                assert_eq!(sum(format, sample), sample.radiance, "{}", about());
                for (number, ray) in sample.rays.iter().enumerate() {
                    hits += usize::from(ray.hit.is_some());
                    rays += 1;
                    opened += ray.walk.as_ref().map_or(0, |walk| walk.opened);
                    for &child in &ray.children {
                        assert_eq!(sample.rays[child].parent, Some(number), "{}", about());
                        assert_eq!(sample.rays[child].depth, ray.depth + 1, "{}", about());
                    }
                    // The hit is the last candidate that was the nearest.
                    let met = ray.walk.as_ref().and_then(|walk| walk.met());
                    assert_eq!(
                        ray.hit.as_ref().map(|hit| hit.primitive),
                        met.map(|met| met.primitive),
                        "{}",
                        about()
                    );
                }
            }
            // The explanation has as many tests as were counted, those of shadow rays included.
            let walks = || {
                explanation
                    .samples
                    .iter()
                    .flat_map(|s| &s.rays)
                    .flat_map(|ray| {
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

/// A ray's own explanation has the hit that `trace` returns.
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
            trace(&scene, &[ray], query, &mut hits).expect("a structure");
            let settings = Settings::of(&scene);
            let subject = Subject::Ray(ray);
            let explanation = explain(&scene, format, Structure::Flagged, settings, subject);
            let explanation = explanation.expect("a explanation");
            let hit = explanation.samples[0].rays[0].hit.as_ref();
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
