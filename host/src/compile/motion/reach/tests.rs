use super::*;
use crate::scene::tests::chains::{Random, chain};
use crate::scene::{Key, SourceSpan, TrackTarget};

#[test]
fn reach_holds_random_chains_at_all_times() {
    let mut random = Random(7);
    let mut smallest = f64::INFINITY;
    for _ in 0..500 {
        let scene = chain(&mut random, true);
        let part = [DVec3::new(-1.0, -2.0, 0.5), DVec3::new(3.0, 0.0, 1.0)];
        let reach = Reach::of(&scene, &[part]);
        let [low, high] = reach.swept.with_margin(0.0).unwrap();
        let rest = scene.instances[0].placement;
        let mut taken = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        for step in -1..=100 {
            let placement = match step {
                -1 => rest,
                _ => scene.instances_at(f64::from(step) * 0.02)[0].placement,
            };
            for corner in 0..8 {
                let side = |axis: usize| part[corner >> axis & 1];
                let corner = placement.point(DVec3::new(side(0).x, side(1).y, side(2).z));
                assert!(
                    corner.cmpge(low).all() && corner.cmple(high).all(),
                    "{corner} is not in {low} to {high} at step {step}: {scene:?}"
                );
                taken = [taken[0].min(corner), taken[1].max(corner)];
            }
            let scale = placement.scale / rest.scale;
            let [least, greatest] = reach.scales[0];
            let limit = |scale: f64| scale.clamp(LEAST_SCALE, LARGEST_SCALE);
            assert!(
                (least - 1e-12..=greatest + 1e-12).contains(&limit(scale)),
                "{scale}"
            );
        }
        smallest = smallest.min((taken[1] - taken[0]).max_element() / (high - low).max_element());
    }
    // It is not much larger than the true region, except for scales in a row.
    assert!(smallest > 0.01, "{smallest}");
}

/// The reach of a box from 1 to 2 along x, half as high and deep, on one joint.
fn of_tracks(tracks: Vec<(TrackTarget, Vec<[f64; 4]>)>) -> [DVec3; 2] {
    let mut scene = chain(&mut Random(1), true);
    scene.joints.truncate(1);
    scene.joints[0].pivot = DVec3::ZERO;
    scene.instances[0].joint = Some(0);
    scene.instances[0].placement = Placement::IDENTITY;
    let key = |(number, &value): (usize, &[f64; 4])| Key {
        seconds: number as f64,
        value,
        ..Key::default()
    };
    let track = |(target, values): (TrackTarget, Vec<[f64; 4]>)| Track {
        target,
        index: 0,
        interpolation: Interpolation::Linear,
        keys: values.iter().enumerate().map(key).collect(),
        place: SourceSpan::default(),
    };
    scene.tracks = tracks.into_iter().map(track).collect();
    let part = [DVec3::new(1.0, -0.25, -0.25), DVec3::new(2.0, 0.25, 0.25)];
    Reach::of(&scene, &[part]).swept.corners.unwrap()
}

#[test]
fn reach_of_shifts_and_hinges_is_tight() {
    let near = |found: [DVec3; 2], low: [f64; 3], high: [f64; 3]| {
        let error =
            (found[0] - DVec3::from_array(low)).abs() + (found[1] - DVec3::from_array(high)).abs();
        assert!(error.max_element() < 0.01, "{found:?}");
    };
    let rest = [0.0, 0.0, 0.0, 1.0];
    near(
        of_tracks(Vec::new()),
        [1.0, -0.25, -0.25],
        [2.0, 0.25, 0.25],
    );
    let lift = vec![(
        TrackTarget::JointShift,
        vec![[0.0; 4], [0.0, 4.0, 0.0, 0.0]],
    )];
    near(of_tracks(lift), [1.0, -0.25, -0.25], [2.0, 4.25, 0.25]);
    let hinge = vec![(TrackTarget::JointRotation, vec![rest, [0.0, 0.0, 1.0, 0.0]])];
    let round = 2.0_f64.hypot(0.25);
    near(
        of_tracks(hinge),
        [-round, -round, -0.25],
        [round, round, 0.25],
    );
    let axle = vec![(TrackTarget::JointRotation, vec![rest, [1.0, 0.0, 0.0, 0.0]])];
    let round = 0.25_f64.hypot(0.25);
    near(of_tracks(axle), [1.0, -round, -round], [2.0, round, round]);
}

/// With a distant pivot, small rotations and small differences of axes move a part far.
#[test]
fn reach_holds_small_rotations_about_distant_pivots() {
    for (first, second) in [
        (DQuat::IDENTITY, DQuat::from_rotation_z(1.9e-6)),
        (
            DQuat::from_rotation_x(1.0),
            DQuat::from_scaled_axis(DVec3::new(1.0, 0.0, 1e-6)),
        ),
    ] {
        for interpolation in [Interpolation::Linear, Interpolation::Cubic] {
            let mut scene = chain(&mut Random(1), true);
            scene.joints.truncate(1);
            scene.joints[0].pivot = DVec3::new(1e5, 0.0, 0.0);
            scene.instances[0].joint = Some(0);
            scene.instances[0].placement = Placement::IDENTITY;
            let key = |(seconds, rotation): (f64, DQuat)| Key {
                seconds,
                value: rotation.to_array(),
                ..Key::default()
            };
            scene.tracks = vec![Track {
                target: TrackTarget::JointRotation,
                index: 0,
                interpolation,
                keys: [(0.0, first), (1.0, second)].map(key).to_vec(),
                place: SourceSpan::default(),
            }];
            let part = [-DVec3::ONE, DVec3::ONE];
            let [low, high] = Reach::of(&scene, &[part]).swept.corners.unwrap();
            for step in 0..=10 {
                let placement = scene.instances_at(f64::from(step) * 0.1)[0].placement;
                for corner in part {
                    let corner = placement.point(corner);
                    assert!(
                        corner.cmpge(low).all() && corner.cmple(high).all(),
                        "{corner} is not in {low} to {high}"
                    );
                }
            }
        }
    }
}

#[test]
fn room_widens_a_scene_without_joints() {
    let scene = Scene {
        room: Some([DVec3::ZERO, DVec3::splat(8.0)]),
        ..Scene::default()
    };
    let (low, high) =
        Reach::of(&scene, &[]).extent((DVec3::splat(-1.0), DVec3::ONE), 24, |_, _| 0.0);
    assert!(low == DVec3::splat(-1.0) && high.min_element() >= 8.0 && high.max_element() < 8.01);
}

/// A scene with a box on a joint and a light so far away that coordinate steps are many units.
fn with_far_light(track: &str) -> Scene {
    let file = format!(
        "[camera]\neye = [0, 0, 14]\ntarget = [0, 0, 0]\nfov = 10\n\
         [[light]]\nkind = 'point'\nposition = [0, 0, 1e6]\n\
         [[part]]\nname = 'p'\nobject = [{{ kind = 'box', min = [-0.5, -0.2, -0.1], max = [1, 0.3, 0.4] }}]\n\
         [[joint]]\nname = 'a'\npivot = [0.3719, 0, 0]\n\
         [[instance]]\npart = 'p'\njoint = 'a'\n\
         [[track]]\ntimes = [0, 1]\n{track}\n"
    );
    let imported = crate::scene::read("far.toml".as_ref(), file.into(), &Default::default());
    imported.unwrap().scene
}

/// The pivot is off by up to half a step, which the scale multiplies.
#[test]
fn instances_that_coordinate_steps_take_off_stay_in_the_box() {
    for track in [
        "target = 'joint.a.scale'\nvalues = [1, 3]",
        "target = 'joint.a.scale'\nvalues = [1, 0.01]",
        "target = 'joint.a.rotation'\naxis = [0, 1, 0]\nvalues = [0, 170]",
        "target = 'joint.a.shift'\nvalues = [[0, 0, 0], [0, 0, 0.04]]",
    ] {
        let scene = with_far_light(track);
        let compiled = crate::compile::compile(&scene, &Default::default()).unwrap();
        let blob = compiled.blob;
        let tracks = gridel_core::Tracks::from_bytes(blob.bytes()).unwrap();
        for step in 0..=20 {
            let time = crate::state::ticks(&tracks, f64::from(step) * 0.05).unwrap();
            crate::state::Poses::at(&blob.scene().unwrap(), &tracks, time)
                .unwrap_or_else(|error| panic!("{track}: {error}"));
        }
    }
}

#[test]
fn displacement_takes_in_the_steps_of_motion() {
    let scene = with_far_light("target = 'joint.a.shift'\nvalues = [[0, 0, 0], [0, 0, 0.04]]");
    let compiled = crate::compile::compile(&scene, &Default::default()).unwrap();
    let step = crate::shape::exp2(compiled.blob.header().coordinate_exponent());
    let displacement = compiled.report.largest_displacement;
    assert!(
        step >= 1.0 / 512.0 && displacement >= 0.5 * step,
        "{displacement} {step}"
    );
}
