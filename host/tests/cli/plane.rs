//! A ground without end, through every command.

use crate::program::Folder;
use serde_json::json;

const GROUND: &str = "
[[object]]
name = 'ground'
kind = 'plane'
point = [0, 0, 0]
normal = [0, 1, 0]
";

const BALL: &str = "
[[object]]
name = 'ball'
kind = 'sphere'
center = [0, 1, 0]
radius = 1
";

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("ground.toml", [GROUND, BALL].concat().as_bytes());
    folder.done(&["build", "ground.toml", "-o", "ground.gridel"]);
    folder
}

#[test]
fn a_plane_enlarges_neither_box_nor_lattice() {
    let folder = folder();
    let inspection = folder.json(&["inspect", "ground.gridel"]);
    let contents = &inspection["contents"];
    assert_eq!(contents["kinds"], json!({"plane": 1, "sphere": 1}));
    folder.write("ball.toml", BALL.as_bytes());
    let ball = folder.json(&["inspect", "ball.toml"]);
    assert_eq!(ball["contents"]["kinds"], json!({"sphere": 1}));
    for key in ["bounds", "unit"] {
        assert_eq!(inspection["limits"][key], ball["limits"][key], "{key}");
    }
}

#[test]
fn a_plane_is_met_far_from_the_scene() {
    let folder = folder();
    for format in ["fixed", "f32", "f64"] {
        let ray = ["--ray", "1000,5,-2000,0,-1,0", "--format", format];
        let text = folder.done(&[&["explain", "ground.gridel"], &ray[..]].concat());
        assert!(text.contains("ground (object 0)"), "{text}");
        assert!(text.contains("at distance 5"), "{text}");
    }
}

#[test]
fn a_scene_with_a_plane_keeps_its_promises() {
    let folder = folder();
    folder.done(&["verify", "ground.gridel", "--rays", "300"]);
    folder.done(&["render", "ground.gridel", "-o", "ground.png"]);
    folder.done(&["compare", "ground.toml", "--size", "16x12"]);
}

/// A ray that passes the box of the bounded objects has a start that is none of its points.
#[test]
fn a_plane_beside_the_box_is_explained_within_its_error() {
    let folder = folder();
    for x in ["30", "1000"] {
        let ray = format!("{x},5,0,0.1,-1,0");
        let explain = ["explain", "ground.gridel", "--ray", &ray, "--format", "f64"];
        let text = folder.done(&explain);
        let errors = text.split("within ").skip(1);
        let errors = errors.filter_map(|it| it.split_whitespace().next()?.parse::<f64>().ok());
        let largest = errors.fold(0.0, f64::max);
        assert!(largest > 0.0 && largest < 1e-9, "{text}");
    }
}

/// A lattice of planes alone is as fine as the camera's distance asks.
#[test]
fn planes_alone_are_drawn_alike_at_every_scale() {
    let folder = Folder::new();
    let mut pictures = Vec::new();
    for (number, scale) in [1.0, 1e-4, 1e5].into_iter().enumerate() {
        let file = format!(
            "{GROUND}[camera]\neye = [0, {}, {}]\ntarget = [0, 0, 0]\nfov = 40\n\
             [material.default]\nchecker = {{ even = 1, odd = 0.1, size = {scale}, \
             origin = [{}, 0, {}] }}\n",
            2.0 * scale,
            9.0 * scale,
            0.3 * scale,
            0.1 * scale,
        );
        folder.write("planes.toml", file.as_bytes());
        let output = format!("planes{number}.ppm");
        let render = ["render", "planes.toml", "-o", &output];
        let options = ["--size", "40x30", "--format", "f64"];
        folder.done(&[&render[..], &options[..]].concat());
        let picture = folder.read(&output);
        pictures.push(picture[picture.len() - 3 * 40 * 30..].to_vec());
    }
    for other in &pictures[1..] {
        let differ = pictures[0].iter().zip(other);
        let differ = differ.filter(|(a, b)| a.abs_diff(**b) > 8).count();
        assert!(differ < 60, "{differ}");
    }
}

#[test]
fn a_scene_without_objects_is_drawn_with_a_warning() {
    let folder = Folder::new();
    folder.write("empty.toml", b"# nothing\n");
    let report = folder.json(&["build", "empty.toml", "-o", "empty.gridel"]);
    let warnings = report["warnings"].to_string();
    assert!(warnings.contains("the scene has no object"), "{report}");
}

#[test]
fn large_checkerboards_of_planes_are_rejected_with_their_line() {
    let folder = Folder::new();
    let scene = "[[object]]\nkind = 'plane'\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nmaterial = 'm'\n\
        [[object]]\nkind = 'sphere'\ncenter = [0, 1, 0]\nradius = 1\n\
        [material.m]\nchecker = { even = 1, odd = 0, size = 100 }\n";
    folder.write("a.toml", scene.as_bytes());
    let build = ["build", "a.toml", "-o", "a.gridel"];
    let words = [
        "material m (a.toml:10): a plane's checkerboard",
        "4 times the scene",
    ];
    folder.fails(1, &build, &words);
}
