//! Pictures from far away.

use glam::DVec3;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::render::RenderError;
use gridel_core::{
    DualSplit, Effects, Fixed, NoCount, Number, Renderer, Settings, Structure, Workspace,
};
use gridel_host::compile::{Options, compile};
use gridel_host::scene::Scene as SceneFile;
use gridel_host::scene::{Camera, Light, Shape};
use gridel_host::shape::Sphere;
use gridel_tests::scenes;

/// Renders 24 by 24 pixels of a ball of radius 1 from a distance in radii. The lens is such that the ball fills the
/// picture.
fn picture<N: Number>(away: f64) -> Result<Vec<[u16; 3]>, RenderError> {
    let (center, radius) = (DVec3::ZERO, 1.0);
    let mut scene = scenes::of([Shape::Sphere(Sphere { center, radius })]);
    let direction = DVec3::new(-0.3, -0.8, -0.6);
    scene.lights = vec![Light::Directional {
        direction,
        color: [1.0; 3],
    }];
    rendered::<N>(&mut scene, away)
}

fn rendered<N: Number>(scene: &mut SceneFile, away: f64) -> Result<Vec<[u16; 3]>, RenderError> {
    scene.camera = Some(Camera {
        eye: DVec3::new(0.48, 0.6, 0.64) * away,
        target: DVec3::ZERO,
        up: DVec3::Y,
        fov_degrees: 2.0 * (1.25 / away).atan().to_degrees(),
    });
    let options = Options {
        structures: vec![Structure::DualSplit],
        ..Options::default()
    };
    let blob = compile(scene, &options).expect("compiles").blob;
    let scene = blob.scene().expect("a scene");
    let settings = Settings {
        width: 24,
        height: 24,
        ..Settings::of(&scene)
    };
    let renderer = Renderer::<N, DualSplit, { Effects::ALL.0 }>::with_settings(&scene, settings)?;
    let mut space = Box::new(Workspace::<N, MAX_STACK_DEPTH, { Effects::MAX_WORK_DEPTH }>::new());
    let mut view = space.as_view();
    let pixels = (0..24 * 24).map(|k| renderer.linear(k % 24, k / 24, &mut view, &mut NoCount));
    Ok(pixels.collect())
}

/// An eye in the distance sees what one near by sees through a wider lens, or is rejected.
#[test]
fn far_eyes_see_the_scene_or_are_rejected() {
    fn seen<N: Number>(close: &[[u16; 3]]) -> Vec<Option<usize>> {
        let aways = [1e3, 3e4, 1e6, 4e6];
        let differ = |(a, b): &(&[u16; 3], &[u16; 3])| a[0].abs_diff(b[0]) > 3000;
        let different = |far: Vec<[u16; 3]>| close.iter().zip(&far).filter(differ).count();
        let seen = aways.map(|away| match picture::<N>(away) {
            Ok(far) => Some(different(far)),
            Err(error) => {
                assert_eq!(error, RenderError::Resolution(N::FORMAT));
                // No format is offered in place of itself.
                let offered = format!("`{}`", N::FORMAT.name());
                assert_eq!(error.to_string().matches(&offered).count(), 1, "{error}");
                None
            }
        });
        eprintln!(
            "{}: {seen:?} pixels differ from {aways:?}",
            N::FORMAT.name()
        );
        seen.to_vec()
    }
    let close = picture::<f64>(300.0).expect("a picture");
    let lit = close.iter().filter(|pixel| pixel[0] > 1000).count();
    assert!(lit > 150, "{lit}");
    let few = |seen: &Option<usize>| seen.is_none_or(|different| different <= 12);
    let [fixed, single, double] = [
        seen::<Fixed>(&close),
        seen::<f32>(&close),
        seen::<f64>(&close),
    ];
    for seen in [&fixed, &single, &double] {
        assert!(seen.iter().all(few), "{seen:?}");
        assert!(seen[0].is_some() && seen[1].is_some());
    }
    assert!(fixed[2].is_some() && double[2].is_some() && single[2].is_none());
}

/// A path through glass that exceeds the range of lengths: it wrapped, and the glass shone.
#[test]
fn glass_seen_from_inside_from_far_away_absorbs_all() {
    let mut scene = scenes::of([Shape::Mesh {
        vertices: [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]]
            .map(DVec3::from)
            .to_vec(),
        // Its front is turned away.
        triangles: vec![[0, 2, 1]],
    }]);
    scene.background = Some([0.5; 3]);
    let glass = &mut scene.materials[0];
    (glass.transmit, glass.absorption) = ([1.0; 3], [1.0; 3]);
    let [fixed, single, double] = [
        rendered::<Fixed>(&mut scene, 3e3),
        rendered::<f32>(&mut scene, 3e3),
        rendered::<f64>(&mut scene, 3e3),
    ]
    .map(|picture| picture.expect("a picture"));
    let dark = |picture: &[[u16; 3]]| picture.iter().filter(|pixel| pixel[0] < 100).count();
    assert!(dark(&double) > 100, "{}", dark(&double));
    assert_eq!([dark(&fixed), dark(&single)], [dark(&double); 2]);
}
