//! Pictures as OpenEXR, by the program and read back.

use exr::prelude::{
    AnyChannels, FlatSamples, IntegerBounds, Vec2, read_first_flat_layer_from_file,
};
use std::path::Path;
use std::process::Command;

fn render(scene: &str, output: &Path, options: &[&str]) {
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures");
    let done = Command::new(env!("CARGO_BIN_EXE_gridel"))
        .args(["render", "--size", "40x30"])
        .arg(fixtures.join(scene))
        .arg("-o")
        .arg(output)
        .args(options)
        .output()
        .expect("the program");
    let errors = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{errors}");
}

/// The bytes of the channels with some names, one after the other.
fn samples(channels: &AnyChannels<FlatSamples>, names: &[&str]) -> Vec<Vec<u8>> {
    let channel = |name: &&str| {
        let found = channels.list.iter().find(|it| it.name == **name);
        match &found
            .unwrap_or_else(|| panic!("no channel {name}"))
            .sample_data
        {
            FlatSamples::F32(values) => values.iter().flat_map(|x| x.to_le_bytes()).collect(),
            FlatSamples::U32(values) => values.iter().flat_map(|x| x.to_le_bytes()).collect(),
            FlatSamples::F16(_) => panic!("{name} has 16 bits"),
        }
    };
    names.iter().map(channel).collect()
}

/// The data of an array file with some bytes per pixel.
fn array(path: &Path, bytes: usize) -> Vec<u8> {
    let file = std::fs::read(path).expect("an array");
    file[file.len() - 40 * 30 * bytes..].to_vec()
}

/// Every other group of four bytes: one component of vectors.
fn component(data: &[u8], axis: usize) -> Vec<u8> {
    let vectors = data.chunks(12);
    vectors
        .flat_map(|it| it[4 * axis..][..4].to_vec())
        .collect()
}

#[test]
fn channels_hold_what_array_files_hold() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let aovs = "depth,normal,albedo,object,primitive,instance";
    for scene in ["quick.toml", "robot-arm.toml"] {
        render(scene, &path("a.exr"), &["--aov", aovs]);
        render(scene, &path("a.npy"), &["--aov", aovs]);
        let image = read_first_flat_layer_from_file(path("a.exr")).expect("a picture");
        let layer = image.layer_data;
        assert_eq!(layer.size, Vec2(40, 30));
        let comments = layer.attributes.comments.expect("how it was made");
        assert!(comments.to_string().contains("format f32"), "{comments}");
        let channels = layer.channel_data;
        assert_eq!(channels.list.len(), 13);
        let find = |names: &[&str]| samples(&channels, names);
        for (file, names) in [
            ("a.npy", ["R", "G", "B"]),
            ("a.normal.npy", ["normal.X", "normal.Y", "normal.Z"]),
            ("a.albedo.npy", ["albedo.R", "albedo.G", "albedo.B"]),
        ] {
            let data = array(&path(file), 12);
            assert!(
                find(&names) == [0, 1, 2].map(|axis| component(&data, axis)),
                "{file}"
            );
        }
        for (file, name) in [
            ("a.depth.npy", "Z"),
            ("a.object.npy", "object"),
            ("a.primitive.npy", "primitive"),
            ("a.instance.npy", "instance"),
        ] {
            assert!(find(&[name]) == [array(&path(file), 4)], "{file}");
        }
    }
}

#[test]
fn rows_keep_their_place() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    render("quick.toml", &path("a.exr"), &[]);
    render(
        "quick.toml",
        &path("b.exr"),
        &["--rows", "7..12", "--threads", "1"],
    );
    let read = |name| read_first_flat_layer_from_file(path(name)).expect("a picture");
    let (whole, part) = (read("a.exr"), read("b.exr"));
    let window = IntegerBounds::from_dimensions(Vec2(40_usize, 30));
    assert_eq!(part.attributes.display_window, window);
    assert_eq!(part.layer_data.attributes.layer_position, Vec2(0, 7));
    assert_eq!(part.layer_data.size, Vec2(40, 5));
    let names = ["R", "G", "B"];
    let [whole, part] = [whole, part].map(|it| samples(&it.layer_data.channel_data, &names));
    for (whole, part) in whole.iter().zip(&part) {
        assert!(whole[7 * 160..12 * 160] == part[..]);
    }
}

#[test]
fn environments_are_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    render("quick.toml", &path("sky.exr"), &[]);
    render("quick.toml", &path("part.exr"), &["--rows", "7..12"]);
    let load = |image: &str| {
        let text = format!(
            "[environment]\nimage = '{image}'\n[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n"
        );
        std::fs::write(path("a.toml"), text).expect("a file");
        gridel_host::scene::load(&path("a.toml"), &Default::default())
    };
    let scene = load("sky.exr").expect("a scene").scene;
    let Some(gridel_host::scene::Sky::Picture(picture)) = scene.environment.map(|it| it.sky) else {
        panic!("no picture");
    };
    assert_eq!(picture.size(), [40, 30]);
    let file = read_first_flat_layer_from_file(path("sky.exr")).expect("a picture");
    let channels = samples(&file.layer_data.channel_data, &["R", "G", "B"]);
    for (axis, channel) in channels.iter().enumerate() {
        let pixels = picture.rows().flatten();
        let found: Vec<u8> = pixels.flat_map(|it| it[axis].to_le_bytes()).collect();
        assert!(found == *channel, "{axis}");
    }
    let error = load("part.exr").expect_err("rows").to_string();
    assert!(
        error.contains("40x5 pixels of a picture of 40x30"),
        "{error}"
    );
    let whole = std::fs::read(path("sky.exr")).expect("a file");
    for length in [5, 100, whole.len() - 9] {
        std::fs::write(path("cut.exr"), &whole[..length]).expect("a file");
        let error = load("cut.exr").expect_err("a cut file").to_string();
        assert!(error.contains("cannot be read as OpenEXR"), "{error}");
    }
}
