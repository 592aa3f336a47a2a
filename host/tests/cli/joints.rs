//! Instances that move: `--time` and `--frames` of pictures, `explain`, `inspect` and modules.

use crate::program::Folder;
use serde_json::json;

/// A ball that is carried four units to the right in two seconds, and one that stands still.
const SCENE: &str = "\
    [render]\nwidth = 24\nheight = 18\n\
    [camera]\neye = [2, 0, 12]\ntarget = [2, 0, 0]\n\
    [[light]]\nkind = 'point'\nposition = [2, 4, 3]\n\
    [[part]]\nname = 'ball'\nobject = [{ kind = 'sphere', center = [0, 0, 0], radius = 0.5 }]\n\
    [[joint]]\nname = 'cart'\n[[joint]]\nname = 'spin'\nparent = 'cart'\npivot = [1, 0, 0]\n\
    [[instance]]\npart = 'ball'\nname = 'moving'\njoint = 'spin'\n\
    [[instance]]\npart = 'ball'\nname = 'still'\ntranslate = [0, 2, 0]\n\
    [[track]]\ntarget = 'joint.cart.shift'\ntimes = [0, 2]\nvalues = [[0, 0, 0], [4, 0, 0]]\n\
    [[track]]\ntarget = 'joint.spin.rotation'\naxis = [0, 0, 1]\ntimes = [0, 2]\nvalues = [0, 720]\n";

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("a.toml", SCENE.as_bytes());
    folder.done(&["build", "a.toml", "-o", "a.gridel"]);
    folder
}

#[test]
fn instances_are_drawn_where_they_are_at_a_time() {
    let folder = folder();
    let accel = ["--accel", "dual-split", "--format", "fixed", "-o", "a.ppm"];
    let picture = |input: &str, options: &[&str]| {
        folder.done(&[&["render", input], options, &accel[..]].concat());
        folder.read("a.ppm")
    };
    for time in ["-1", "0.5", "1.25", "2"] {
        let one = picture("a.toml", &["--time", time]);
        assert!(one == picture("a.gridel", &["--time", time]), "{time}");
        assert_eq!(one == picture("a.gridel", &[]), time == "-1");
        // Copies lie on another lattice, but the ball is as large there.
        let flat = picture("a.toml", &["--instances", "flatten", "--time", time]);
        let differing = one.iter().zip(&flat).filter(|(a, b)| a.abs_diff(**b) > 8);
        assert!(differing.count() < 12, "{time}");
    }
    let numbered = [
        "render", "a.gridel", "--frames", "0..3", "--fps", "2", "-o", "a-%d.ppm",
    ];
    folder.done(&[&numbered[..], &accel[..4]].concat());
    assert!(folder.read("a-1.ppm") == picture("a.gridel", &["--time", "0.5"]));
}

#[test]
fn explain_follows_instances_at_rest_and_at_a_time() {
    let folder = folder();
    let hits = |options: &[&str]| {
        let ray = ["explain", "a.toml", "--ray", "2,-4,0,0,1,0"];
        let explained = folder.json(&[&ray[..], options].concat());
        let hit = explained["samples"][0]["rays"][0]["hit"].clone();
        let warned = explained["warnings"]
            .to_string()
            .contains("where they are at rest");
        (!hit.is_null(), warned)
    };
    assert_eq!(hits(&[]), (false, false));
    assert_eq!(hits(&["--instances", "flatten"]), (false, true));
    // It is led by two units, and turned by a whole turn.
    assert_eq!(hits(&["--time", "1"]), (true, false));
}

#[test]
fn inspect_lists_joints_and_modules_count_them() {
    let folder = folder();
    let inspected = folder.json(&["inspect", "a.gridel"]);
    let joint = |parent: Option<u32>, x: f64, instances: u32| json!({"parent": parent, "pivot": [x, 0.0, 0.0], "instances": instances});
    assert_eq!(
        inspected["joints"],
        json!([joint(None, 0.0, 0), joint(Some(0), 1.0, 1)])
    );
    let tracks = &inspected["tracks"]["tracks"];
    assert_eq!(tracks[0]["target"], "joint.rotation");
    assert_eq!(tracks[1]["target"], "joint.shift");
    let text = folder.done(&["inspect", "a.gridel"]);
    assert!(
        text.contains("1 on joint 0: 1 instance, pivot (1, 0, 0)"),
        "{text}"
    );
    assert!(text.contains("joint 1, rotation: 9 keys, linear"), "{text}");
    folder.done(&["build", "a.toml", "-o", "b.gridel", "--emit-rust", "module"]);
    let module = String::from_utf8(folder.read("module/scene.rs")).unwrap();
    for words in [
        "pub const INSTANCES: usize = 2;",
        "pub const JOINTS: usize = 2;",
        "pub type Poses = gridel_core::Poses<INSTANCES>;",
    ] {
        assert!(module.contains(words), "{module}");
    }
}

/// Joints that each turn by the same angle, on each other, with an instance on the last.
fn chain(joints: usize) -> String {
    let mut scene = String::from(
        "[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\n[[part]]\nname = 'box'\n\
         object = [{ kind = 'box', min = [0, -0.1, -0.1], max = [2, 0.1, 0.1] }]\n",
    );
    for joint in 0..joints {
        let parent = match joint.checked_sub(1) {
            Some(parent) => format!("parent = 'j{parent}'\n"),
            None => String::new(),
        };
        scene += &format!(
            "[[joint]]\nname = 'j{joint}'\n{parent}[[track]]\ntarget = 'joint.j{joint}.rotation'\n\
             axis = [0, 0, 1]\ntimes = [0, 1]\nvalues = [0, 360]\n"
        );
    }
    scene + &format!("[[instance]]\npart = 'box'\njoint = 'j{}'\n", joints - 1)
}

/// The rounding of compositions adds up. All joints of a chain turn the box by a multiple of 90 degrees here.
#[test]
fn long_chains_of_joints_keep_their_instances() {
    let folder = Folder::new();
    for (joints, times) in [(20, ["0.5", "0.525", "0.9"]), (1024, ["0.125", "0.5", "1"])] {
        folder.write("chain.toml", chain(joints).as_bytes());
        for time in times {
            let render = ["render", "chain.toml", "-o", "a.ppm", "--size", "32x24"];
            let render = [&render[..], &["--time", time]].concat();
            folder.done(&render);
            let kept = folder.read("a.ppm");
            folder.done(&[&render[..], &["--instances", "flatten"]].concat());
            let differing = folder.read("a.ppm");
            let differing = kept
                .iter()
                .zip(&differing)
                .filter(|(a, b)| a.abs_diff(**b) > 8);
            // Pixels at edges.
            assert!(differing.count() < 3 * 32, "{joints} joints at {time} s");
        }
    }
}

#[test]
fn what_cannot_move_says_why() {
    let folder = folder();
    let frames = ["render", "a.toml", "--frames", "0..3", "-o", "a.apng"];
    folder.fails(
        2,
        &[&frames[..], &["--instances", "flatten"]].concat(),
        &["copies of them do not", "leave out `--instances flatten`"],
    );
    let tangents = "[[track]]\ntarget = 'material.default.diffuse'\ninterpolation = 'cubic'\n\
                    times = [0, 1]\nvalues = [0.5, 1]\ntangents = [9, 9]\n";
    folder.write("b.toml", (SCENE.to_owned() + tangents).as_bytes());
    let build = ["build", "b.toml", "-o", "b.gridel"];
    folder.fails(
        1,
        &build,
        &["the tangent is too large", "a smaller tangent"],
    );
}

/// A track whose interpolation is none, in a blob with a valid checksum.
#[test]
fn broken_tracks_are_not_taken_for_none() {
    let folder = folder();
    let mut blob = folder.read("a.gridel");
    // The record of the shift's track: its target, its interpolation and the joint's number.
    let target = gridel_core::format::track::TrackTarget::JointShift as u16;
    let record = [target, 1, 0, 0].map(u16::to_le_bytes).concat();
    let mut places = blob.windows(record.len());
    let place = places.position(|bytes| bytes == record).expect("the track");
    blob[place + 2] = 9;
    let sum = gridel_core::format::checksum(&blob).to_le_bytes();
    let field = std::mem::offset_of!(gridel_core::format::record::Header, checksum);
    blob[field..field + 4].copy_from_slice(&sum);
    folder.write("b.gridel", &blob);
    for command in [
        &["render", "b.gridel", "-o", "a.ppm", "--time", "1"][..],
        &[
            "explain",
            "b.gridel",
            "--ray",
            "2,-4,0,0,1,0",
            "--time",
            "1",
        ],
        &["inspect", "b.gridel"],
    ] {
        folder.fails(1, command, &["interpolation is 9"]);
    }
}

/// The message names the joints, and the limit that it states suffices.
#[test]
fn joints_that_shrink_an_instance_too_far_are_rejected_with_the_limit() {
    let folder = Folder::new();
    let scene = |least: &str| {
        format!(
            "[[object]]\nkind = 'box'\nmin = [-20, -1, -20]\nmax = [20, -0.9, 20]\n\
             [[part]]\nname = 'p'\nobject = [{{ kind = 'sphere', center = [0, 0, 0], radius = 0.5 }}]\n\
             [[joint]]\nname = 'j'\n[[instance]]\npart = 'p'\njoint = 'j'\n\
             [[track]]\ntarget = 'joint.j.scale'\ntimes = [0, 1]\nvalues = [1, {least}]\n"
        )
    };
    folder.write("a.toml", scene("0.00001").as_bytes());
    let command = ["build", "a.toml", "-o", "a.gridel"];
    folder.fails(
        1,
        &command,
        &["the joints of the instance", "--instances flatten"],
    );
    let error = folder.run(&command).said();
    let least = error.split("at least ").nth(1).expect("a limit");
    let least = least.split(',').next().expect("a number");
    let least: f64 = least.parse().expect("a number");
    folder.write("a.toml", scene(&(1.06 * least).to_string()).as_bytes());
    folder.done(&command);
    folder.write("a.toml", scene("0.00001").as_bytes());
    folder.done(&[&command[..], &["--instances", "flatten"]].concat());
}
