//! Instances at a time, against the interpolation of their joints in double precision.

use super::{Instance as Record, *};
use crate::compile::{Options, compile};
use crate::scene::tests::chains::{Random, chain};
use crate::scene::{Instance, Part, Scene as SceneFile, TICKS_PER_SECOND};
use crate::shape::exp2;
use glam::{DMat3, DVec3};
use gridel_core::format::instance::MATRIX_BITS;

/// Returns how far the map of a posed instance is from its placement: for a point near the part, in
/// scene units.
fn error(posed: &Scene<'_>, record: &Record, expected: &Instance) -> f64 {
    let header = posed.header();
    let unit = exp2(header.unit_exponent.into());
    let part = posed.parts()[0].header();
    let part_unit = exp2(part.unit_exponent.into());
    let rows = record
        .matrix
        .map(|row| DVec3::from_array(row.map(f64::from)));
    let matrix = DMat3::from_cols_array_2d(&rows.map(|row| row.to_array())).transpose();
    let into_part = matrix * exp2(i32::from(record.exponent) - MATRIX_BITS as i32);
    let center = DVec3::from_array(record.center.map(f64::from)) / 256.0;
    let from_part = into_part.inverse();
    let corners = (0..8).map(|corner| {
        let side = |axis: usize| f64::from(part.bounds.0[axis][corner >> axis & 1]);
        let place = DVec3::new(side(0), side(1), side(2));
        let found = DVec3::from_array(header.origin) + unit * (center + from_part * place);
        let place = DVec3::from_array(part.origin) + part_unit * place;
        found.distance(expected.placement.point(place))
    });
    corners.fold(0.0, f64::max)
}

/// The largest distance of posed instances from their places, in units of the scene.
fn largest_error(scene: &SceneFile, until: f64) -> f64 {
    let options = Options {
        names: false,
        ..Options::default()
    };
    let blob = compile(scene, &options).expect("compiles").blob;
    let loaded = blob.scene().expect("valid");
    let tracks = Tracks::from_bytes(blob.bytes()).expect("valid");
    let unit = exp2(loaded.header().unit_exponent.into());
    let mut largest = 0_f64;
    for step in 0..=100 {
        let seconds = f64::from(step) * until / 100.0;
        let time = ticks(&tracks, seconds).unwrap();
        let state = State::at(&blob, &loaded, &tracks, time)
            .unwrap_or_else(|error| panic!("{error}: {scene:?}"));
        let posed = state.apply(&loaded).expect("in range");
        let seconds = f64::from(time) / f64::from(TICKS_PER_SECOND);
        let expected = scene.instances_at(seconds);
        for record in posed.instances() {
            let expected = &expected[record.number as usize];
            largest = largest.max(error(&posed, record, expected) / unit);
        }
    }
    largest
}

#[test]
fn random_chains_are_where_their_tracks_lead() {
    let mut random = Random(11);
    let mut largest = 0_f64;
    for _ in 0..60 {
        largest = largest.max(largest_error(&chain(&mut random, false), 2.0));
    }
    // A lattice has 65,534 units.
    assert!(largest < 0.25, "{largest} units");
}

#[test]
fn many_instances_are_where_their_joints_lead_whatever_their_order() {
    let mut random = Random(2);
    let mut scene = chain(&mut random, false);
    let first = scene.instances[0].clone();
    for number in 0..100 {
        let mut placement = first.placement;
        placement.translation = random.vector() * 4.0;
        scene.instances.push(Instance {
            placement,
            joint: (number % 3 > 0).then_some(random.below(scene.joints.len())),
            ..first.clone()
        });
    }
    assert!(largest_error(&scene, 2.0) < 0.25);
}

#[test]
fn instances_behind_one_of_an_empty_part_keep_their_joints() {
    let mut scene = chain(&mut Random(3), false);
    let empty = Part {
        objects: Vec::new(),
        ..scene.parts[0].clone()
    };
    scene.parts.push(empty);
    let nothing = Instance {
        part: 1,
        joint: None,
        ..scene.instances[0].clone()
    };
    scene.instances.insert(0, nothing);
    let blob = compile(&scene, &Options::default()).expect("compiles").blob;
    let tracks = Tracks::from_bytes(blob.bytes()).expect("valid");
    assert_eq!(blob.scene().expect("valid").instances().len(), 1);
    assert_eq!(tracks.joint_of(0), scene.instances[1].joint);
}

#[test]
fn scene_without_joints_has_no_poses() {
    let mut scene = chain(&mut Random(1), false);
    scene.tracks.clear();
    scene.joints.clear();
    scene.instances[0].joint = None;
    let blob = compile(&scene, &Options::default()).expect("compiles").blob;
    let loaded = blob.scene().expect("valid");
    let tracks = Tracks::from_bytes(blob.bytes()).expect("valid");
    assert!(tracks.joints().is_empty());
    assert_eq!(
        State::at(&blob, &loaded, &tracks, 0)
            .expect("a state")
            .poses,
        None
    );
}

#[test]
fn poses_of_another_scene_are_rejected() {
    let mut random = Random(5);
    let [one, mut other] = [(); 2].map(|()| chain(&mut random, false));
    other.instances.push(other.instances[0].clone());
    let [one, other] =
        [one, other].map(|it| compile(&it, &Options::default()).expect("compiles").blob);
    let tracks = Tracks::from_bytes(other.bytes()).expect("valid");
    let state = State::at(&other, &other.scene().expect("valid"), &tracks, 0).expect("a state");
    let poses = state.poses.expect("two instances");
    assert!(poses.apply(&one.scene().expect("valid")).is_err());
}
