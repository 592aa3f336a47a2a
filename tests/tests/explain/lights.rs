//! Lights at a hit, and what blocks them.

use super::explanation;
use gridel_core::{Format, Settings, Structure};
use gridel_host::explain::{LightOutcome, Step, Subject, Verdict, explain};
use gridel_host::scene::{Light, Object, Shape, SourceSpan};
use gridel_host::shape::{Cuboid, Sphere};
use gridel_host::trace::SceneRay;
use gridel_tests::scenes;

/// An object that blocks a light is named, and culled nodes have a reason.
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
        place: SourceSpan::default(),
        normals: Default::default(),
        attributes: Default::default(),
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
    let explanation = explain(
        &scene,
        Format::F64,
        Structure::Bvh,
        settings,
        Subject::Ray(ray),
    );
    let explanation = explanation.expect("a explanation");
    let first = &explanation.samples[0].rays[0];
    assert_eq!(first.hit.as_ref().map(|hit| hit.object), Some(0));
    let outcomes: Vec<_> = first.lights.iter().map(|light| &light.outcome).collect();
    let blocked = LightOutcome::Blocked {
        kind: "sphere",
        primitive: 1,
        object: 1,
        instance: None,
    };
    assert_eq!(outcomes, [&blocked, &LightOutcome::Behind]);
    let walk = first.walk.as_ref().expect("a walk");
    let verdicts = walk.steps.iter().filter_map(|step| match step {
        Step::Candidate(candidate) => Some((candidate.primitive, candidate.verdict)),
        _ => None,
    });
    assert!(verdicts.clone().any(|v| v == (0, Verdict::Nearest)));
}

/// A light that has no direction, because it lies where the ray to it would start, is reported, too.
#[test]
fn lights_at_the_point_itself_or_turned_off_are_reported() {
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
    let mut falls_at = |height: f64, color: f64| {
        scene.lights = vec![
            Light::Point {
                position: glam::DVec3::Y * height,
                color: [color; 3],
            },
            Light::Directional {
                direction: -glam::DVec3::Y,
                color: [1.0; 3],
            },
        ];
        let blob = scenes::blob(&scene, 24);
        let scene = blob.scene().expect("a scene");
        let explanation = explanation(&scene, Format::Fixed, Structure::Bvh, ray);
        let ray = &explanation.samples[0].rays[0];
        let outcomes: Vec<_> = ray
            .lights
            .iter()
            .map(|l| (l.light, l.outcome.clone()))
            .collect();
        let hit = ray.hit.as_ref().expect("a hit");
        // Rays start on the face itself.
        (outcomes, hit.point[1])
    };
    let (above, start) = falls_at(3.0, 1.0);
    assert_eq!(above, [(0, LightOutcome::Lit), (1, LightOutcome::Lit)]);
    let (here, _) = falls_at(start, 1.0);
    assert_eq!(here, [(0, LightOutcome::Here), (1, LightOutcome::Lit)]);
    let (off, _) = falls_at(3.0, 0.0);
    assert_eq!(off, [(0, LightOutcome::Off), (1, LightOutcome::Lit)]);
}

/// The point of an area, where a spot ends, and how light falls off.
#[test]
fn lights_with_forms_say_from_where_they_shine_and_how_they_fall_off() {
    let text = "
        [[light]]
        kind = 'rectangle'
        corner = [-1, 4, -1]
        edges = [[2, 0, 0], [0, 0, 2]]
        radiance = 9
        [[light]]
        kind = 'spot'
        position = [0, 5, 0]
        direction = [1, 0, 0]
        [[object]]
        kind = 'box'
        min = [-5, -1, -5]
        max = [5, 0, 5]";
    let imported =
        gridel_host::scene::read("lights.toml".as_ref(), text.into(), &Default::default());
    let blob = scenes::blob(&imported.expect("a scene").scene, 24);
    let scene = blob.scene().expect("a scene");
    let ray = SceneRay {
        origin: glam::DVec3::new(0.5, 3.0, 0.5),
        direction: -glam::DVec3::Y,
        tmin: 0.0,
        tmax: f64::INFINITY,
    };
    for format in Format::ALL {
        let explanation = explanation(&scene, format, Structure::Bvh, ray);
        let [area, spot] = &explanation.samples[0].rays[0].lights[..] else {
            panic!("two lights");
        };
        assert_eq!(area.outcome, LightOutcome::Lit, "{format:?}");
        let [arriving, ..] = area.arriving.expect("it falls off");
        // At most the light of the area from straight above, which is 9 * 4 / (pi * 16).
        assert!(arriving > 0.3 && arriving < 0.72, "{arriving}");
        let [x, y, z] = area.from_area.expect("a point of the area");
        assert!((y - 4.0).abs() < 1e-3 && x.abs() <= 1.001 && z.abs() <= 1.001);
        assert_eq!(spot.outcome, LightOutcome::Outside, "{format:?}");
        assert_eq!(spot.from_area, None);
    }
}

/// The facet that is drawn at a rough mirror, and the ray that leaves by it.
#[test]
fn rough_mirrors_say_which_facet_is_drawn() {
    let text = "
        ambient = 0.5
        background = 0.5
        [material.rough]
        mirror = 0.9
        roughness = 0.3
        [[object]]
        kind = 'box'
        min = [-5, -1, -5]
        max = [5, 0, 5]
        material = 'rough'";
    let imported =
        gridel_host::scene::read("rough.toml".as_ref(), text.into(), &Default::default());
    let blob = scenes::blob(&imported.expect("a scene").scene, 24);
    let scene = blob.scene().expect("a scene");
    let ray = SceneRay {
        origin: glam::DVec3::new(0.5, 3.0, 0.5),
        direction: -glam::DVec3::Y,
        tmin: 0.0,
        tmax: f64::INFINITY,
    };
    for format in Format::ALL {
        let explanation = explanation(&scene, format, Structure::Bvh, ray);
        let [hit, leaving] = &explanation.samples[0].rays[..] else {
            panic!("two rays: {:?}", explanation.samples[0].rays);
        };
        let facet = glam::DVec3::from(hit.facet.expect("a facet"));
        assert!(
            (facet.length() - 1.0).abs() < 1e-5 && facet.y > 0.5,
            "{facet}"
        );
        assert_eq!(leaving.kind, "glossy");
        assert!(leaving.weight[0] <= 0.9 && leaving.weight[0] > 0.3);
        assert!(leaving.background && leaving.facet.is_none());
    }
}
