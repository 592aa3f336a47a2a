//! From where scene files are seen.

use crate::program::Folder;

/// A box of 2 by 1 by 4, in OBJ.
fn cuboid() -> String {
    let corners = (0..8).map(|corner| {
        let [x, y, z] = [corner & 1, corner >> 1 & 1, corner >> 2];
        format!("v {} {} {}\n", 2 * x, y, 4 * z)
    });
    let faces = [
        "1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6",
    ];
    corners.collect::<String>() + &faces.map(|face| format!("f {face}\n")).concat()
}

/// This box in STL, on its side: 2 by 4 by 1.
fn lying() -> String {
    let mut text = String::from("solid box\n");
    let corner = |corner: usize| {
        let [x, z, y] = [corner & 1, corner >> 1 & 1, corner >> 2];
        format!("vertex {} {} {}\n", 2 * x, 4 * y, z)
    };
    for face in [
        [0, 1, 3, 2],
        [4, 6, 7, 5],
        [0, 4, 5, 1],
        [2, 3, 7, 6],
        [0, 2, 6, 4],
        [1, 5, 7, 3],
    ] {
        for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
            let corners = [a, b, c].map(|index| corner(face[index])).concat();
            text += &format!("facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n");
        }
    }
    text + "endsolid box\n"
}

/// The columns and rows of a PPM whose pixels are not the background's, which is that of the first pixel.
fn covered(folder: &Folder, name: &str, [width, height]: [usize; 2]) -> ([u8; 3], [usize; 4]) {
    let picture = folder.read(name);
    let pixels = &picture[picture.len() - width * height * 3..];
    let pixel = |at: usize| [pixels[3 * at], pixels[3 * at + 1], pixels[3 * at + 2]];
    let background = pixel(0);
    let seen: Vec<_> = (0..width * height)
        .filter(|&at| pixel(at) != background)
        .collect();
    let columns = seen.iter().map(|at| at % width);
    let rows = seen.iter().map(|at| at / width);
    let bounds = [
        columns.clone().min().unwrap(),
        columns.max().unwrap(),
        rows.clone().min().unwrap(),
        rows.max().unwrap(),
    ];
    (background, bounds)
}

#[test]
fn a_file_without_a_camera_fills_80_percent_of_the_picture_on_a_light_background() {
    let folder = Folder::new();
    folder.write("a.obj", cuboid().as_bytes());
    folder.write("a.stl", lying().as_bytes());
    for name in ["a.obj", "a.stl"] {
        folder.done(&["render", name, "-o", "a.ppm", "--size", "80x60"]);
        let (background, bounds) = covered(&folder, "a.ppm", [80, 60]);
        assert!(
            background.iter().all(|&channel| channel > 230),
            "{background:?}"
        );
        // Twice as wide as high, and 80 % of 80 columns wide.
        assert_eq!(bounds, [8, 71, 14, 45], "{name}");
    }
}

/// Shapes of which the part of their box that the camera faces is not what is seen of them.
const OBJECTS: [(&str, &str); 9] = [
    (
        "sphere",
        "kind = \"sphere\"\ncenter = [1000, -3, 7]\nradius = 2\n",
    ),
    ("box", "kind = \"box\"\nmin = [0, 0, 0]\nmax = [4, 1, 2]\n"),
    (
        "deep box",
        "kind = \"box\"\nmin = [0, 0, 0]\nmax = [1, 3, 20]\n",
    ),
    (
        "torus",
        "kind = \"torus\"\ncenter = [0, 1, 0]\naxis = [1, 2, 3]\nmajor_radius = 3\nminor_radius = 1\n",
    ),
    (
        "disc",
        "kind = \"disc\"\ncenter = [0, 0, 0]\nnormal = [2, 1, 1]\nradius = 5\n",
    ),
    (
        "cylinder",
        "kind = \"cylinder\"\nbase = [0, 0, 0]\ntop = [3, 8, 9]\nradius = 2\n",
    ),
    (
        "cone away from the eye",
        "kind = \"cone\"\nbase = [0, 0, 0]\napex = [5, 1, -4]\nradius = 3\n",
    ),
    (
        "cone towards the eye",
        "kind = \"cone\"\nbase = [0, 0, 0]\napex = [0, 0, 1]\nradius = 2\n",
    ),
    (
        "two spheres, one behind the other",
        "kind = \"sphere\"\ncenter = [-3, 0, 6]\nradius = 1\n[[object]]\n\
         kind = \"sphere\"\ncenter = [4, 2, -9]\nradius = 2\n",
    ),
];

#[test]
fn object_fills_80_percent_of_a_picture_of_any_shape() {
    let folder = Folder::new();
    for (name, object) in OBJECTS {
        folder.write("a.toml", format!("[[object]]\n{object}").as_bytes());
        let mut limited = [0, 0];
        for size in [[320, 240], [240, 320], [200, 200], [640, 96], [96, 640]] {
            let [width, height] = size;
            let named = format!("{width}x{height}");
            folder.done(&["render", "a.toml", "-o", "a.ppm", "--size", &named]);
            let [left, right, top, bottom] = covered(&folder, "a.ppm", size).1;
            let across = (right + 1 - left) as f64 / width as f64;
            let along = (bottom + 1 - top) as f64 / height as f64;
            let share = across.max(along);
            assert!(
                (share - 0.8).abs() < 0.025,
                "{name} {named}: {across} {along}"
            );
            limited[usize::from(along > across)] += 1;
            // The side that is filled is in the middle, and no other one exceeds the part.
            let [low, high, side] = match along > across {
                true => [top, bottom, height],
                false => [left, right, width],
            };
            assert!((low + high + 1).abs_diff(side) <= 2, "{name} {named}");
        }
        assert!(limited[0] > 0 && limited[1] > 0, "{name}: {limited:?}");
    }
}

#[test]
fn explain_frames_the_scene_in_the_given_size() {
    let folder = Folder::new();
    folder.write("a.toml", format!("[[object]]\n{}", OBJECTS[1].1).as_bytes());
    let explain = |pixel: &str| {
        let of = ["explain", "a.toml", "--size", "100x400", "--pixel", pixel];
        folder.json(&of)["samples"][0]["rays"][0]["hit"].is_object()
    };
    // The box is 80 pixels wide, and hit by the middle row from column 10 to 89.
    for (pixel, is_hit) in [
        ("8,200", false),
        ("12,200", true),
        ("87,200", true),
        ("91,200", false),
    ] {
        assert_eq!(explain(pixel), is_hit, "{pixel}");
    }
}

#[test]
fn flags_stand_for_the_camera_and_the_background_of_a_file() {
    let folder = Folder::new();
    folder.write("a.obj", cuboid().as_bytes());
    let import = "[[object]]\nkind = \"import\"\nfile = \"a.obj\"\n";
    let camera = "background = [0.1, 0.2, 0.4]\n\n[camera]\neye = [-3, 4, 9]\ntarget = [1, 0.5, 2]\n\
                  up = [0, 1, 0.25]\nfov = 35\n\n";
    folder.write("a.toml", format!("{camera}{import}").as_bytes());
    let flags = [
        "--eye=-3,4,9",
        "--target",
        "1,0.5,2",
        "--up",
        "0,1,0.25",
        "--fov",
        "35",
        "--background",
        "0.1,0.2,0.4",
    ];
    // An import begins the names of its objects with its own.
    folder.done(&["build", "a.toml", "-o", "a.gridel", "--strip-names"]);
    let build = ["build", "a.obj", "-o", "b.gridel", "--strip-names"];
    folder.done(&[&build, &flags[..]].concat());
    assert!(folder.read("a.gridel") == folder.read("b.gridel"));
    let size = ["--size", "80x60"];
    folder.done(&[&["render", "a.toml", "-o", "a.ppm"], &size[..]].concat());
    folder.done(&[&["render", "a.obj", "-o", "b.ppm"], &size[..], &flags].concat());
    assert!(folder.read("a.ppm") == folder.read("b.ppm"));
    // One flag changes one thing of the file's camera.
    folder.write(
        "c.toml",
        format!("{}{import}", camera.replace("35", "20")).as_bytes(),
    );
    let build = ["build", "c.toml", "-o", "c.gridel", "--strip-names"];
    folder.done(&[&build, &["--fov", "35"][..]].concat());
    assert!(folder.read("c.gridel") == folder.read("a.gridel"));
}

#[test]
fn up_and_angle_alone_leave_the_whole_scene_in_view() {
    let folder = Folder::new();
    folder.write("a.obj", cuboid().as_bytes());
    let render = ["render", "a.obj", "-o", "a.ppm", "--size", "80x60"];
    folder.done(&[&render[..], &["--fov", "5"]].concat());
    assert_eq!(covered(&folder, "a.ppm", [80, 60]).1[..2], [8, 71]);
    // Seen along +y: 2 wide and 4 high.
    folder.done(&[&render[..], &["--up", "0,0,1"]].concat());
    assert_eq!(covered(&folder, "a.ppm", [80, 60]).1[2..], [6, 53]);
}

#[test]
fn cameras_that_cannot_be_and_flags_for_blobs_are_rejected() {
    let folder = Folder::with_quick();
    folder.write("a.obj", cuboid().as_bytes());
    let render = |options: &[&str], words: &[&str]| {
        let command = ["render", "a.obj", "-o", "a.png"];
        folder.fails(2, &[&command[..], options].concat(), words);
    };
    render(&["--eye", "1,2"], &["write three numbers with commas"]);
    render(&["--fov", "180"], &["above 0 and below 180"]);
    render(&["--background=-1,0,0"], &["from 0 to 2047"]);
    render(
        &["--eye", "1,1,1", "--target", "1,1,1"],
        &["the same point"],
    );
    render(
        &["--eye", "1,9,2", "--target", "1,1,2"],
        &["looks along `--up`"],
    );
    // What a blob holds is inspected as it is.
    for option in ["--eye", "--up", "--background"] {
        let inspect = ["inspect", "quick.gridel", option, "1,2,3"];
        folder.fails(2, &inspect, &[&format!("{option} is for scene files")]);
    }
    let inspect = ["inspect", "quick.gridel", "--target", "1,2,3"];
    folder.fails(2, &inspect, &["--target X,Y,Z is for scene files"]);
    let build = [
        "build", "a.obj", "-o", "a.gridel", "--target", "1,2,3", "--target",
    ];
    folder.fails(2, &[&build[..], &["4,5,6"]].concat(), &["given twice"]);
    folder.fails(2, &[&build[..], &["4,5"]].concat(), &["three numbers"]);
    folder.fails(
        2,
        &[&build[..], &["no-board"]].concat(),
        &["stm32vldiscovery"],
    );
    folder.done(&[&build[..], &["mps2-an386"]].concat());
    let trace = [
        "trace", "a.obj", "--rays", "r.npy", "-o", "h.npy", "--eye", "1,2,3",
    ];
    folder.fails(2, &trace, &["--eye"]);
}
