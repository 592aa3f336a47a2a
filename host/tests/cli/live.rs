//! Blobs that are seen by another camera and under other lights than they were built with.

use crate::program::Folder;

const SCENE: &str = "\
    [camera]\neye = [0, 1, 5]\ntarget = [0, 0, 0]\nfov = 45\n\
    [[light]]\nkind = 'point'\nposition = [2, 4, 3]\ncolor = [0.8, 0.8, 0.8]\n\
    [[light]]\nkind = 'directional'\ndirection = [0, -1, -1]\ncolor = [0.2, 0.2, 0.2]\n\
    [[object]]\nkind = 'sphere'\ncenter = [0, 0.5, 0]\nradius = 0.5\n\
    [[object]]\nkind = 'box'\nmin = [-2, -0.5, -2]\nmax = [2, 0, 2]\n";

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("a.toml", SCENE.as_bytes());
    folder.done(&["build", "a.toml", "-o", "a.gridel"]);
    folder
}

const SIZE: [&str; 2] = ["--size", "40x30"];

#[test]
fn camera_and_lights_of_a_blob_change_as_those_of_its_scene_file() {
    let folder = folder();
    let camera = ["--eye", "3,2.5,-4", "--target", "0,0.5,0", "--fov", "60"];
    let light = [
        "--light",
        "0.position=-2,3,1",
        "--light",
        "1.color=0.1,0.3,0.5",
    ];
    let surroundings = ["--background", "0.2,0.3,0.4", "--cutoff", "0.5"];
    for options in [
        &camera[..],
        &light,
        &surroundings,
        &["--light", "1.direction=1,-2,0"],
    ] {
        for (input, output) in [("a.toml", "scene.ppm"), ("a.gridel", "blob.ppm")] {
            let start = ["render", input, "-o", output, "--accel", "dual-split"];
            folder.done(&[&start[..], &SIZE, options].concat());
        }
        assert!(
            folder.read("scene.ppm") == folder.read("blob.ppm"),
            "{options:?}"
        );
    }
    folder.done(&[&["render", "a.gridel", "-o", "own.ppm"], &SIZE[..]].concat());
    assert!(folder.read("own.ppm") != folder.read("blob.ppm"));
}

#[test]
fn a_blob_keeps_what_is_not_changed() {
    let folder = folder();
    folder.done(&[&["render", "a.gridel", "-o", "own.ppm"], &SIZE[..]].concat());
    let same = ["--light", "0.position=2,4,3"];
    folder.done(&[&["render", "a.gridel", "-o", "same.ppm"], &SIZE[..], &same].concat());
    assert!(folder.read("own.ppm") == folder.read("same.ppm"));
    // The eye moves around what is in the middle of the picture.
    folder.done(
        &[
            &["render", "a.gridel", "-o", "moved.ppm"],
            &SIZE[..],
            &["--eye", "0,1,-5"],
        ]
        .concat(),
    );
    assert!(folder.read("own.ppm") != folder.read("moved.ppm"));
}

#[test]
fn an_explained_pixel_of_a_blob_is_that_of_the_changed_camera() {
    let folder = folder();
    let explain = |options: &[&str]| {
        let start = ["explain", "a.gridel", "--pixel", "160,120"];
        folder.json(&[&start[..], options].concat())
    };
    assert_ne!(explain(&[]), explain(&["--eye", "0,5,1"]));
}

#[test]
fn changes_that_do_not_fit_are_rejected() {
    let folder = folder();
    for (options, words) in [
        (
            ["--light", "2.color=1,1,1"],
            "there is no light 2: the scene states 2 lights",
        ),
        (
            ["--light", "0.direction=1,0,0"],
            "light 0 has a position and no direction to change",
        ),
        (
            ["--light", "1.position=1,0,0"],
            "light 1 shines from far away",
        ),
        (["--light", "0.size=1,0,0"], "position, direction or color"),
        (["--light", "0.position=1e30,0,0"], "too far"),
        (["--eye", "1e30,0,0"], "where the blob's coordinates end"),
        (
            ["--lattice-bits", "16"],
            "--lattice-bits is for scene files",
        ),
    ] {
        let start = ["render", "a.gridel", "-o", "a.ppm"];
        folder.fails(2, &[&start[..], &options].concat(), &[words]);
        assert!(!folder.path("a.ppm").exists());
    }
}

/// A surface that glows would keep its color.
#[test]
fn lights_that_are_faces_of_objects_do_not_change() {
    let folder = folder();
    let lamp = "[material.lamp]\nemission = [17, 12, 5]\n[[object]]\nkind = 'mesh'\nmaterial = 'lamp'\n\
                vertices = [[-1, 3, -1], [1, 3, -1], [1, 3, 1], [-1, 3, 1]]\nfaces = [[0, 1, 2, 3]]\n";
    let disc = "[[light]]\nkind = 'disc'\ncenter = [0, 4, 0]\nnormal = [0, -1, 0]\nradius = 1\nradiance = 9\n";
    let rough = "[material.rough]\nmirror = 1\nroughness = 0.3\n[[object]]\nkind = 'sphere'\n\
                 center = [1, 0.5, 0]\nradius = 0.2\nmaterial = 'rough'\n";
    for rough in ["", rough] {
        let scene = format!("{SCENE}{disc}{rough}{lamp}");
        folder.write("lamp.toml", scene.as_bytes());
        folder.done(&["build", "lamp.toml", "-o", "lamp.gridel"]);
        for input in ["lamp.toml", "lamp.gridel"] {
            let render = [
                "render", input, "-o", "lamp.ppm", "--size", "8x6", "--light",
            ];
            for change in ["3.color=5,0,0", "3.position=0,3,1"] {
                let words = ["light 3", "object"];
                folder.fails(2, &[&render[..], &[change]].concat(), &words);
            }
            // No surface stands for the other lights.
            for change in ["0.color=5,0,0", "2.color=5,0,0"] {
                folder.done(&[&render[..], &[change]].concat());
            }
            std::fs::remove_file(folder.path("lamp.ppm")).unwrap();
        }
    }
}

/// The environment of a blob is no light that a scene file states.
#[test]
fn lights_of_an_environment_do_not_change() {
    let folder = folder();
    let sky = format!("{SCENE}[environment]\nzenith = 0.5\nhorizon = 0.5\nground = 0\n");
    folder.write("sky.toml", sky.as_bytes());
    folder.done(&["build", "sky.toml", "-o", "sky.gridel"]);
    for input in ["sky.toml", "sky.gridel"] {
        let render = ["render", input, "-o", "sky.ppm"];
        let light = ["--light", "2.color=0,0,0"];
        let words = ["there is no light 2", "2 lights", "0 to 1"];
        folder.fails(2, &[&render[..], &SIZE, &light].concat(), &words);
    }
}
