//! Nodes and planes that a ray tests.

use super::{explanation, rays, way};
use gridel_core::{Format, Structure};
use gridel_host::explain::{Culled, Names, Shown, Step, Walk};
use gridel_host::trace::{Frame, SceneRay};
use gridel_tests::scenes;
use std::collections::HashMap;

/// A hierarchy reports where a ray is in the same units, whether it culls in integers or in lanes.
#[test]
fn spans_are_reported_in_units() {
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
            let [fixed, f32, f64] =
                Format::ALL.map(|format| explanation(&scene, format, structure, ray));
            if fixed.samples[0].rays[0].hit.is_some() {
                continue;
            }
            let fixed = spans(way(&fixed));
            for other in [&f32, &f64].map(|explanation| spans(way(explanation))) {
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

/// Places that are reported as culled are not opened; all others are opened or given up.
#[test]
fn reported_walks_are_the_walks_of_queries() {
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
            let explanation = explanation(&scene, format, structure, *ray);
            let about = || format!("{} {} {ray:?}", format.name(), structure.name());
            let (mut left_out, mut opened, mut entered) = (vec![], vec![], vec![]);
            for step in &way(&explanation).steps {
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
                    Step::Candidate(_)
                    | Step::InstanceEntered { .. }
                    | Step::InstanceLeft { .. } => {}
                }
            }
            for place in entered {
                // A grid has no node for all of it.
                let done = opened.contains(&place) || place == "grid 0";
                assert!(done, "{place} {}", about());
            }
            // No two tests read the same.
            let names = Names::default();
            let shown = Shown {
                explanation: &explanation,
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
