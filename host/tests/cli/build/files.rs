//! Input and output files: invalid ones, and those that are never overwritten.

use crate::program::Folder;
use std::path::Path;

#[test]
fn the_input_is_never_overwritten() {
    let folder = Folder::with_quick();
    std::fs::create_dir(folder.path("sub")).unwrap();
    for output in ["quick.toml", "./quick.toml", "sub/../quick.toml"] {
        folder.fails(
            2,
            &["build", "quick.toml", "-o", output],
            &["is the input", "give the output another name"],
        );
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(folder.path("quick.toml"), folder.path("link")).unwrap();
        folder.fails(2, &["build", "quick.toml", "-o", "link"], &["is the input"]);
    }
}

#[test]
fn files_that_are_no_scene_are_rejected_with_the_reason() {
    let folder = Folder::with_quick();
    let fails = |scene: &str, words: &[&str]| {
        folder.fails(1, &["build", scene, "-o", "new.gridel"], words);
    };
    fails("quick.gridel", &["quick.gridel is a blob already"]);
    // The content counts, and not the name.
    folder.write("blob.toml", &folder.read("quick.gridel"));
    fails("blob.toml", &["is a blob already"]);
    folder.write("scene.gridel", &folder.read("quick.toml"));
    let words = ["scene.gridel has the name of a blob", "rename it"];
    fails("scene.gridel", &words);
    fails("absent.toml", &["absent.toml cannot be read"]);
    fails(".", &["not a file"]);
    folder.write("scene.fbx", b"");
    fails("scene.fbx", &["fbx", ".toml, .obj"]);
    folder.write(
        "wrong.toml",
        b"[camera]\neye = [0, 0, 5]\ntraget = [0, 0, 0]\n",
    );
    fails("wrong.toml", &["wrong.toml:3", "target"]);
    folder.write("bent.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
    fails("bent.obj", &["bent.obj:4"]);
}

#[test]
fn unwritable_places_are_errors_that_leave_nothing() {
    let folder = Folder::with_quick();
    let fails = |output: &str, words: &[&str]| {
        folder.fails(1, &["build", "quick.toml", "-o", output], words);
    };
    fails(
        "absent/quick.gridel",
        &["cannot be written", "create the folder"],
    );
    fails(".", &["cannot be written"]);
    #[cfg(target_os = "linux")]
    {
        fails("/dev/full", &["/dev/full cannot be written", "make room"]);
        std::os::unix::fs::symlink("/dev/full", folder.path("full")).unwrap();
        fails("full", &["full cannot be written"]);
    }
}

#[test]
fn numbers_without_end_are_short() {
    let folder = Folder::new();
    folder.write("big.obj", b"v -1e300 0 0\nv 1e300 0 0\nv 0 1 0\nf 1 2 3\n");
    let build = ["build", "big.obj", "-o", "new.gridel"];
    folder.fails(1, &build, &["size is 2e300,"]);
    folder.write("wide.toml", b"render = { width = 6400, height = 10 }\n");
    let build = ["build", "wide.toml", "-o", "new.gridel"];
    folder.fails(1, &build, &["wide.toml:1", "64 times as wide"]);
}

#[test]
fn names_that_mean_something_else_are_rejected() {
    let folder = Folder::with_quick();
    for name in ["x.png", "x.toml", "x.obj", "x.npy", "x.txt"] {
        folder.fails(2, &["build", "quick.toml", "-o", name], &[name, ".gridel"]);
    }
    folder.write("rays.npy", b"");
    let trace = ["trace", "quick.gridel", "--rays", "rays.npy", "-o", "h.txt"];
    folder.fails(2, &trace, &["h.txt", ".npy"]);
}

/// A file of another sort stays what it is.
#[test]
fn nothing_of_the_users_own_is_written_over() {
    let folder = Folder::with_quick();
    let own = b"a buffer, or a program";
    let build = [
        "build",
        "quick.toml",
        "-o",
        "scene.bin",
        "--emit-rust",
        "src",
    ];
    for (path, said) in [
        ("scene.bin", "scene.bin exists and is not a blob"),
        (
            "src/scene.rs",
            "scene.rs exists and is not a module of Gridel",
        ),
    ] {
        std::fs::create_dir_all(folder.path("src")).unwrap();
        folder.write(path, own);
        folder.fails(2, &build, &[said, "move that file away"]);
        assert_eq!(folder.read(path), own);
        std::fs::remove_file(folder.path(path)).unwrap();
    }
    // What was written before is written anew.
    folder.done(&build);
    folder.done(&build);
    // Neither is a file taken for a folder, nor does a folder stay that nothing came into.
    let build = [
        "build",
        "quick.toml",
        "-o",
        "b.gridel",
        "--emit-rust",
        "quick.toml",
    ];
    folder.fails(2, &build, &["quick.toml is not a folder"]);
    let build = [
        "build",
        "quick.toml",
        "-o",
        "none/b.gridel",
        "--emit-rust",
        "new",
    ];
    folder.fails(1, &build, &["none/b.gridel cannot be written"]);
    assert!(!folder.path("new").exists());
}

/// The blob can lie in the module's folder, which need not exist.
#[test]
fn a_new_folder_takes_the_module_and_the_blob() {
    let folder = Folder::with_quick();
    for (output, module) in [
        ("new/scene.gridel", "new"),
        ("new/scene.gridel", "new"),
        ("./other/b.gridel", "other/"),
    ] {
        folder.done(&["build", "quick.toml", "-o", output, "--emit-rust", module]);
        let copy = Path::new(module).join("scene.gridel");
        assert!(folder.read(output) == folder.read(copy.to_str().unwrap()));
        assert!(folder.path(module).join("scene.rs").exists());
    }
    // Nothing else comes into another new folder.
    let build = [
        "build",
        "quick.toml",
        "-o",
        "a/b/s.gridel",
        "--emit-rust",
        "a",
    ];
    folder.fails(1, &build, &["cannot be written"]);
    assert!(!folder.path("a").exists());
}

/// The blob and the module's two files come together or not at all.
#[test]
fn files_that_belong_together_are_written_together() {
    let folder = Folder::with_quick();
    folder.write("n.gridel", b"old");
    for name in ["scene.rs", "scene.gridel"] {
        let module = folder.path("em");
        std::fs::create_dir_all(module.join(name)).unwrap();
        let build = ["build", "quick.toml", "-o", "n.gridel", "--emit-rust", "em"];
        folder.fails(1, &build, &[name, "cannot be written"]);
        let left = std::fs::read_dir(&module).unwrap();
        let left: Vec<_> = left.map(|entry| entry.unwrap().file_name()).collect();
        assert_eq!(left, [name]);
        std::fs::remove_dir_all(&module).unwrap();
    }
    // Neither does a picture come without its heat map.
    std::fs::create_dir(folder.path("heat.png")).unwrap();
    let render = [
        "render",
        "quick.gridel",
        "-o",
        "a.png",
        "--heat-map",
        "heat.png",
    ];
    folder.fails(1, &render, &["heat.png cannot be written"]);
}

/// Outputs are tested before the work.
#[test]
fn blobs_that_cannot_be_written_are_rejected_before_the_scene_is_read() {
    let folder = Folder::new();
    folder.write("broken.toml", b"[[object]]");
    let build = ["build", "broken.toml", "-o", "nowhere/n.gridel"];
    folder.fails(1, &build, &["nowhere", "cannot be written"]);
}
