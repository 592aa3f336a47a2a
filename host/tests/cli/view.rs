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

/// The same box in STL, on its side: 2 by 4 by 1.
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

/// The rows and columns of a PPM of 80 by 60 whose pixels are not the background's, which is that of
/// the first pixel.
fn covered(folder: &Folder, name: &str) -> ([u8; 3], [usize; 4]) {
    let picture = folder.read(name);
    let pixels = &picture[picture.len() - 80 * 60 * 3..];
    let pixel = |at: usize| [pixels[3 * at], pixels[3 * at + 1], pixels[3 * at + 2]];
    let background = pixel(0);
    let seen: Vec<_> = (0..80 * 60).filter(|&at| pixel(at) != background).collect();
    let columns = seen.iter().map(|at| at % 80);
    let rows = seen.iter().map(|at| at / 80);
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
        let (background, bounds) = covered(&folder, "a.ppm");
        assert!(
            background.iter().all(|&channel| channel > 230),
            "{background:?}"
        );
        // Twice as wide as high, and 80 % of 80 columns wide.
        assert_eq!(bounds, [8, 71, 14, 45], "{name}");
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
    assert_eq!(covered(&folder, "a.ppm").1[..2], [8, 71]);
    // Seen along +y: 2 wide and 4 high.
    folder.done(&[&render[..], &["--up", "0,0,1"]].concat());
    assert_eq!(covered(&folder, "a.ppm").1[2..], [6, 53]);
}

#[test]
fn cameras_that_cannot_be_and_flags_for_blobs_are_refused() {
    let folder = Folder::with_quick();
    folder.write("a.obj", cuboid().as_bytes());
    let render = |options: &[&str], words: &[&str]| {
        let verb = ["render", "a.obj", "-o", "a.png"];
        folder.fails(2, &[&verb[..], options].concat(), words);
    };
    render(&["--eye", "1,2"], &["write three numbers with commas"]);
    render(&["--fov", "180"], &["above 0 and below 180"]);
    render(&["--background=-1,0,0"], &["at or above 0"]);
    render(
        &["--eye", "1,1,1", "--target", "1,1,1"],
        &["the same point"],
    );
    render(
        &["--eye", "1,9,2", "--target", "1,1,2"],
        &["looks along `--up`"],
    );
    for option in ["--eye", "--target", "--up", "--background"] {
        let render = ["render", "quick.gridel", "-o", "a.png", option, "1,2,3"];
        folder.fails(2, &render, &[&format!("{option} is for scene files")]);
    }
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
