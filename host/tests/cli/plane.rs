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
