//! Joints: what hangs on what, and the tracks that move it.

use super::{load, load_in, scene};
use crate::scene::{ImportOptions, Instances, Interpolation, Posed, Scene, Track, TrackTarget};
use glam::{DQuat, DVec3};

const PART: &str = "[[part]]\nname = 'link'\n\
    [[part.object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n";

/// A door, whose track has these keys.
fn door(track: &str) -> Scene {
    scene(&format!(
        "{PART}[[joint]]\nname = 'hinge'\npivot = [1, 0, 0]\n\
         [[instance]]\npart = 'link'\njoint = 'hinge'\n\
         [[track]]\ntarget = 'joint.hinge.rotation'\n{track}"
    ))
}

fn assert_near(found: DVec3, expected: DVec3) {
    assert!(found.distance(expected) < 1e-9, "{found} is not {expected}");
}

/// Returns the position at a time of the point of a door that is at the origin at rest.
fn at(scene: &Scene, seconds: f64) -> DVec3 {
    scene.instances_at(seconds)[0].placement.point(DVec3::ZERO)
}

#[test]
fn chain_moves_what_hangs_on_it() {
    let scene = scene(&format!(
        "{PART}[[joint]]\nname = 'shoulder'\n\
         [[joint]]\nname = 'elbow'\nparent = 'shoulder'\npivot = [1, 0, 0]\n\
         [[instance]]\npart = 'link'\njoint = 'elbow'\ntranslate = [2, 0, 0]\n\
         [[instance]]\npart = 'link'\n\
         [[track]]\ntarget = 'joint.shoulder.rotation'\naxis = [0, 0, 2]\ntimes = [0, 1]\nvalues = [0, 90]\n\
         [[track]]\ntarget = 'joint.elbow.rotation'\naxis = [0, 0, 1]\ntimes = [0, 1]\nvalues = [0, 90]\n\
         [[track]]\ntarget = 'joint.elbow.scale'\ntimes = [0, 1]\nvalues = [1, 2]\n\
         [[track]]\ntarget = 'joint.shoulder.shift'\ntimes = [0, 1]\nvalues = [[0, 0, 0], [0, 0, 5]]\n"
    ));
    let [hand, still] = &scene.instances_at(1.0)[..] else {
        panic!("{:?}", scene.instances)
    };
    assert_eq!(hand.joint, Some(1));
    assert_near(
        hand.placement.point(DVec3::ZERO),
        DVec3::new(-2.0, 1.0, 5.0),
    );
    assert_near(hand.placement.point(DVec3::X), DVec3::new(-4.0, 1.0, 5.0));
    assert_eq!(
        (still.joint, still.placement),
        (None, scene.instances[1].placement)
    );
    assert_eq!(
        scene.instances_at(-1.0)[0].placement.point(DVec3::ZERO),
        DVec3::X * 2.0
    );
}

/// Times are rounded to those of a blob.
#[test]
fn times_are_those_of_ticks() {
    let scene = scene(&format!(
        "{PART}[[joint]]\nname = 'hinge'\n[[instance]]\npart = 'link'\njoint = 'hinge'\n\
         [[track]]\ntarget = 'joint.hinge.shift'\ninterpolation = 'step'\n\
         times = [0, 0.3333333333]\nvalues = [[0, 0, 0], [3, 0, 0]]\n"
    ));
    for (seconds, x) in [(0.33333333, 3.0), (0.33332, 0.0), (0.33334, 3.0)] {
        assert_eq!(at(&scene, seconds).x, x, "{seconds}");
    }
}

#[test]
fn hinge_turns_as_often_as_its_angles_say() {
    let door = door("axis = [0, 0, 1]\ntimes = [0, 3]\nvalues = [-30, 1050]\n");
    assert_eq!(door.tracks[0].keys.len(), 13);
    for step in 0..=300 {
        let seconds = f64::from(step) / 100.0;
        let angle = (seconds * 360.0 - 30.0).to_radians();
        let expected = DVec3::new(1.0 - angle.cos(), -angle.sin(), 0.0);
        assert_near(at(&door, seconds), expected);
    }
    let steps = self::door(
        "axis = [0, 0, 1]\ntimes = [0, 1, 2]\nvalues = [0, 90, 450]\ninterpolation = 'step'\n",
    );
    assert_eq!(steps.tracks[0].keys.len(), 3);
    assert_near(at(&steps, 0.9), DVec3::ZERO);
    assert_near(at(&steps, 1.5), DVec3::new(1.0, -1.0, 0.0));
    assert_near(at(&steps, 2.0), DVec3::new(1.0, -1.0, 0.0));
}

#[test]
fn hinge_follows_a_spline_of_angles() {
    for (keys, tangents) in [
        ("times = [0, 1, 3]\nvalues = [0, 400, -90]\n", None),
        ("times = [0, 3]\nvalues = [0, 90]\n", Some([0.0, 0.0])),
        ("times = [0, 3]\nvalues = [10, 10]\n", Some([720.0, -90.0])),
    ] {
        let given = tangents.map_or(String::new(), |it| format!("tangents = {it:?}\n"));
        let door = door(&format!(
            "{keys}{given}axis = [0, 0, 1]\ninterpolation = 'cubic'\n"
        ));
        // The spline of the angles themselves, as that of a light's color would be.
        let plain = scene(&format!(
            "[[light]]\nkind = 'point'\nposition = [0, 0, 0]\n\
             [[track]]\ntarget = 'camera.orbit'\n{keys}{given}interpolation = 'cubic'\n"
        ));
        for step in 0..=300 {
            let seconds = f64::from(step) / 100.0;
            let angle = plain.tracks[0].at(seconds)[0].to_radians();
            let expected = DVec3::new(1.0 - angle.cos(), -angle.sin(), 0.0);
            let found = at(&door, seconds);
            assert!(
                found.distance(expected) < 4e-5,
                "{seconds}: {found} is not {expected}"
            );
        }
    }
}

#[test]
fn rotations_without_an_axis_take_the_shorter_way() {
    let door = door(
        "times = [0, 1, 2]\nvalues = [[0, 0, 0], [0, 0, 270], { axis = [0, 0, 1], degrees = 90 }]\n",
    );
    assert_near(
        at(&door, 0.5),
        DVec3::new(1.0 - 0.5_f64.sqrt(), 0.5_f64.sqrt(), 0.0),
    );
    let turn = DQuat::from_array(door.tracks[0].at(2.0));
    assert!(turn.dot(DQuat::from_rotation_z(90_f64.to_radians())).abs() > 1.0 - 1e-12);
    let cubic =
        self::door("times = [0, 1]\nvalues = [[0, 0, 0], [0, 90, 0]]\ninterpolation = 'cubic'\n");
    assert_eq!(cubic.tracks[0].interpolation, Interpolation::Cubic);
    assert_near(at(&cubic, 1.0), DVec3::new(1.0, 0.0, 1.0));
}

#[test]
fn joints_that_move_nothing_are_named() {
    let imported = load(&format!(
        "{PART}[[joint]]\nname = 'used'\n[[joint]]\nname = 'loose'\nparent = 'used'\n\
         [[instance]]\npart = 'link'\njoint = 'used'\n"
    ));
    let warnings = imported.unwrap().warnings;
    assert!(
        warnings.len() == 1 && warnings[0].contains("\"loose\""),
        "{warnings:?}"
    );
}

#[test]
fn joints_of_imports_stand_where_the_import_does() {
    let folder = tempfile::tempdir().unwrap();
    let arm = format!(
        "room = [[0, 0, 0], [9, 9, 9]]\n{PART}\
         [[joint]]\nname = 'base'\n[[joint]]\nname = 'hinge'\nparent = 'base'\npivot = [1, 0, 0]\n\
         [[instance]]\npart = 'link'\nname = 'arm'\njoint = 'hinge'\ntranslate = [2, 0, 0]\n\
         [[track]]\ntarget = 'joint.hinge.rotation'\naxis = [0, 1, 0.5]\ntimes = [0, 1]\nvalues = [0, 130]\n\
         [[track]]\ntarget = 'joint.base.shift'\ntimes = [0, 1]\nvalues = [[0, 0, 0], [1, 2, 3]]\n\
         [[track]]\ntarget = 'joint.base.scale'\ntimes = [0, 1]\nvalues = [1, 3]\n"
    );
    std::fs::write(folder.path().join("arm.toml"), &arm).unwrap();
    let own = load_in(folder.path(), &arm).unwrap().scene;
    let object = "[[object]]\nkind = 'import'\nfile = 'arm.toml'\nrotate = [10, 20, 30]\nscale = 2\n\
        translate = [1, 2, 3]\n";
    let grouped = format!(
        "[[object]]\nkind = 'group'\nname = 'crew'\n[[object.{}",
        object.strip_prefix("[[").unwrap()
    );
    for text in [
        String::from(object),
        grouped,
        format!("{object}{object}name = 'second'\n"),
    ] {
        let imported = load_in(folder.path(), &text).unwrap();
        assert_eq!(imported.warnings, Vec::<String>::new());
        let scene = imported.scene;
        let copies = scene.instances.len();
        assert_eq!(
            (scene.joints.len(), scene.tracks.len()),
            (2 * copies, 3 * copies)
        );
        assert!(scene.joints[1].name.ends_with("arm/hinge"));
        let outer = |place: DVec3| {
            let rest = [&own, &scene].map(|it| it.instances[0].placement);
            // From the scene of the import to this one, by the placements at rest.
            let [inner, outer] = rest.map(|it| it.affine());
            outer.transform_point3(inner.inverse().transform_point3(place))
        };
        for instance in scene.instances_at(0.7) {
            let expected = outer(own.instances_at(0.7)[0].placement.point(DVec3::X));
            assert_near(instance.placement.point(DVec3::X), expected);
        }
    }
    let imported = load_in(folder.path(), object).unwrap().scene;
    let [low, high] = imported.room.unwrap();
    assert!((high - low).max_element() > 18.0);
}

#[test]
fn mirrored_imports_stand_still_and_say_so() {
    let folder = tempfile::tempdir().unwrap();
    let arm =
        format!("{PART}[[joint]]\nname = 'hinge'\n[[instance]]\npart = 'link'\njoint = 'hinge'\n");
    std::fs::write(folder.path().join("arm.toml"), arm).unwrap();
    let text = "[[object]]\nkind = 'import'\nfile = 'arm.toml'\nscale = [-1, 1, 1]\n";
    let imported = load_in(folder.path(), text).unwrap();
    assert!(imported.scene.joints.is_empty() && imported.scene.objects.len() == 1);
    let [warning] = &imported.warnings[..] else {
        panic!("{:?}", imported.warnings)
    };
    assert!(warning.contains("as they are at rest"), "{warning}");
}

#[test]
fn flattened_instances_stand_where_they_are_at_a_time() {
    let text = format!(
        "{PART}[[joint]]\nname = 'a'\n[[instance]]\npart = 'link'\njoint = 'a'\n\
         [[track]]\ntarget = 'joint.a.shift'\ntimes = [0, 1]\nvalues = [[0, 0, 0], [8, 0, 0]]\n"
    );
    for (at, x, words) in [(None, 0.0, 1), (Some(0.5), 4.0, 0)] {
        let options = ImportOptions {
            instances: Instances::Flatten,
            time: at,
            ..ImportOptions::default()
        };
        let flat = crate::scene::read("a.toml".as_ref(), text.clone().into(), &options).unwrap();
        assert!(flat.scene.joints.is_empty() && flat.scene.tracks.is_empty());
        assert_eq!(flat.scene.objects[0].shape.support(DVec3::X), x + 1.0);
        let copied = [Posed::AtRest, Posed::AtTime][usize::from(at.is_some())];
        assert_eq!((flat.posed, flat.warnings.len()), (Some(copied), words));
    }
}

#[test]
fn targets_of_joints_are_found_by_name() {
    let text = |target: &str, values: &str| {
        format!(
            "{PART}[[joint]]\nname = 'a.b'\n[[joint]]\nname = 'c'\nparent = 'a.b'\n\
             [[instance]]\npart = 'link'\njoint = 'c'\n\
             [[track]]\ntarget = '{target}'\ntimes = [0]\nvalues = [{values}]\n"
        )
    };
    for (target, values, expected, index) in [
        (
            "joint.a.b.rotation",
            "[0, 0, 0]",
            TrackTarget::JointRotation,
            0,
        ),
        ("joint.c.shift", "[1, 2, 3]", TrackTarget::JointShift, 1),
        ("joint.c.scale", "0.5", TrackTarget::JointScale, 1),
    ] {
        let tracks: Vec<Track> = scene(&text(target, values)).tracks;
        assert_eq!((tracks[0].target, tracks[0].index), (expected, index));
    }
}

#[test]
fn documented_door_swings() {
    let document = include_str!("../../../../docs/SCENE.md");
    let (_, section) = document.split_once("\n## Joints\n").unwrap();
    let (_, example) = section.split_once("```toml\n").unwrap();
    let imported = load(example.split_once("```").unwrap().0).unwrap();
    assert_eq!(imported.warnings, Vec::<String>::new());
    let open = imported.scene.instances_at(2.0);
    assert_near(open[0].placement.point(DVec3::X), DVec3::Z);
    assert_eq!(open[1].joint, Some(1));
}
