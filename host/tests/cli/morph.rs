//! Meshes that morph: pictures at times, blobs, and what is said about them.

use crate::program::Folder;

/// A pyramid whose tip rises, beside a box.
const SCENE: &str = "\
    [render]\nwidth = 24\nheight = 18\n\
    [camera]\neye = [0.5, 0.5, 6]\ntarget = [0.5, 0.5, 0]\n\
    [[light]]\nkind = 'directional'\ndirection = [-1, -2, -3]\n\
    [morph.up]\n\
    [[object]]\nkind = 'box'\nmin = [-2, -1, -1]\nmax = [3, -0.5, 1]\n\
    [[object]]\nkind = 'mesh'\nname = 'tent'\n\
    vertices = [[0, 0, 0], [1, 0, 0], [0.5, 0.2, 0.8], [0.5, 0.2, -0.8]]\n\
    faces = [[0, 1, 2], [0, 2, 3], [1, 3, 2], [0, 3, 1]]\n\
    morph = { up = [[0, 0, 0], [0, 0, 0], [0, 1, 0], [0, 1, 0]] }\n\
    [[track]]\ntarget = 'morph.up.weight'\ntimes = [0, 2]\nvalues = [0, 1]\n";

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("a.toml", SCENE.as_bytes());
    folder.done(&["build", "a.toml", "-o", "a.gridel"]);
    folder
}

#[test]
fn meshes_are_drawn_as_they_are_at_a_time() {
    let folder = folder();
    let picture = |input: &str, options: &[&str]| {
        folder.done(&[&["render", input], options, &["-o", "a.ppm"]].concat());
        folder.read("a.ppm")
    };
    let rest = picture("a.toml", &[]);
    for time in ["0", "1", "2"] {
        let one = picture("a.toml", &["--time", time]);
        assert!(one == picture("a.gridel", &["--time", time]), "{time}");
        assert_eq!(one == rest, time == "0", "{time}");
    }
    // The mesh as it is written down at a half.
    let still = SCENE
        .replace(
            "[0.5, 0.2, 0.8], [0.5, 0.2, -0.8]",
            "[0.5, 0.7, 0.8], [0.5, 0.7, -0.8]",
        )
        .replace("values = [0, 1]", "values = [0, 0]");
    folder.write("b.toml", still.as_bytes());
    assert!(picture("b.toml", &[]) == picture("a.toml", &["--time", "1"]));
    let frames = [
        "render", "a.gridel", "--frames", "0..5", "--fps", "2", "-o", "a-%d.ppm",
    ];
    folder.done(&frames);
    assert!(folder.read("a-1.ppm") == picture("a.toml", &["--time", "0.5"]));
    let blurred = ["--time", "0.5", "--shutter", "1", "--samples", "4"];
    let blur = picture("a.toml", &blurred);
    assert!(blur != picture("a.toml", &["--time", "0.5", "--samples", "4"]));
    assert!(blur == picture("a.gridel", &blurred));
}

#[test]
fn queries_see_the_moved_mesh() {
    let folder = folder();
    let hit = |options: &[&str]| {
        let ray = ["explain", "a.toml", "--ray", "0.5,1,5,0,0,-1"];
        let explained = folder.json(&[&ray[..], options].concat());
        explained["samples"][0]["rays"][0]["hit"].clone()
    };
    assert!(hit(&[]).is_null());
    assert!(!hit(&["--time", "2"]).is_null());
}

/// Few structures can follow, so all are compared at rest.
#[test]
fn comparisons_are_of_meshes_at_rest() {
    let folder = folder();
    let compared = folder.json(&["compare", "a.toml", "--size", "16x12", "--repeat", "1"]);
    let warnings = compared["warnings"].to_string();
    assert!(warnings.contains("as they are at rest"), "{compared}");
}

#[test]
fn structures_that_keep_meshes_at_rest_are_warned_of() {
    let folder = folder();
    let said = folder.run(&["build", "a.toml", "--accel", "wide", "-o", "w.gridel"]);
    let said = said.stderr;
    assert!(said.contains("keep their shape at rest"), "{said}");
    let contents = folder.json(&["inspect", "a.gridel"]);
    let tracks = &contents["tracks"]["tracks"];
    assert_eq!(tracks[0]["target"], "morph.weight", "{contents}");
    let [mesh] = &contents["deforming"].as_array().expect("meshes")[..] else {
        panic!("{contents}")
    };
    assert_eq!(
        (mesh["vertices"].as_u64(), mesh["normals"].as_u64()),
        (Some(4), Some(0))
    );
    let text = folder.done(&["inspect", "a.gridel"]);
    assert!(text.contains("weights of 1 morph target"), "{text}");
}

#[test]
fn collapsed_triangles_are_named_with_their_object() {
    let folder = folder();
    let sail = "[[MESH]]\nkind = 'triangle'\nname = 'sail'\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n\
                morph = { up = [[0, 0, 0], [0, 0, 0], [2, -1, 0]] }\n";
    let own = sail.replace("MESH", "object");
    let part = sail.replace("MESH", "part.object") + "[[instance]]\npart = 'boat'\n";
    let ball = "[[object]]\nkind = 'sphere'\ncenter = [0, 5, 0]\nradius = 1\n";
    for mesh in [own, format!("[[part]]\nname = 'boat'\n{part}")] {
        let track = "[[track]]\ntarget = 'morph.up.weight'\ntimes = [0, 2]\nvalues = [0, 1]\n";
        let scene = format!("[morph.up]\n{ball}{mesh}{track}");
        folder.write("sail.toml", scene.as_bytes());
        let command = ["render", "sail.toml", "--time", "2", "-o", "x.png"];
        let words = ["at 2 s object \"sail\"", "primitive 1, a triangle"];
        folder.fails(1, &command, &words);
    }
}
