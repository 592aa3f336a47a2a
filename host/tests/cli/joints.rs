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
