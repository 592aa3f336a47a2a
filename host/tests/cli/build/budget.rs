//! Budgets of blobs, tables and boards, and the advice where one is exceeded.

use crate::program::{Folder, fixture};
use gridel_host::table::grouped;

#[test]
fn a_budget_rejects_before_writing() {
    let folder = Folder::with_quick();
    let accels = ["--accel", "bvh", "--accel", "flagged", "--strip-names"];
    folder.done(&[&["build", "quick.toml", "-o", "quick.gridel"], &accels[..]].concat());
    let most = folder.read("quick.gridel").len();
    let build = |bytes: &str| {
        let accels = ["--accel", "bvh", "--accel", "flagged", "--max-bytes"];
        let mut arguments = vec!["build", "quick.toml", "-o", "quick.gridel"];
        arguments.extend(accels);
        arguments.push(bytes);
        arguments.into_iter().map(String::from).collect::<Vec<_>>()
    };
    let run = |bytes: &str, check: &dyn Fn(&[&str])| {
        let arguments = build(bytes);
        check(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
    };
    let advice = ["--max-bytes", "leaving out `--accel bvh` saves"];
    run("1K", &|arguments| folder.fails(3, arguments, &advice));
    run(&(most - 1).to_string(), &|arguments| {
        folder.fails(3, arguments, &advice);
    });
    run(&most.to_string(), &|arguments| {
        folder.done(arguments);
    });
    run("1M", &|arguments| {
        folder.done(arguments);
    });
    run("some", &|arguments| folder.fails(2, arguments, &["64K"]));
}

/// The advised change saves the bytes that the advice states.
#[test]
fn the_advice_for_a_budget_is_exact() {
    let folder = Folder::with_quick();
    let bytes = |accels: &[&str]| {
        let options: Vec<_> = accels.iter().flat_map(|accel| ["--accel", accel]).collect();
        let build = ["build", "quick.toml", "-o", "new.gridel", "--strip-names"];
        folder.done(&[&build, &options[..]].concat());
        folder.read("new.gridel").len()
    };
    let advice = |accels: &[&str]| {
        let options: Vec<_> = accels.iter().flat_map(|accel| ["--accel", accel]).collect();
        let build = [
            "build",
            "quick.toml",
            "-o",
            "new.gridel",
            "--max-bytes",
            "1K",
        ];
        folder.run(&[&build[..], &options].concat()).said()
    };
    let list = bytes(&["list"]);
    for accel in ["dual-split", "flagged", "wide", "apex"] {
        let saved = bytes(&[accel]) - list;
        let said = advice(&[accel]);
        let expected = format!("instead of {accel} saves {} bytes", grouped(saved));
        assert!(said.contains(&expected), "{expected}: {said}");
    }
    let whole = bytes(&["dual-split"]);
    folder.done(&[
        "build",
        "quick.toml",
        "-o",
        "new.gridel",
        "--lattice-bits",
        "16",
        "--strip-names",
    ]);
    let saved = whole - folder.read("new.gridel").len();
    let expected = format!("`--lattice-bits 16` saves {} bytes", grouped(saved));
    let said = advice(&["dual-split"]);
    assert!(said.contains(&expected), "{expected}: {said}");
    let saved = bytes(&["bvh", "flagged"]) - bytes(&["flagged"]);
    let said = advice(&["bvh", "flagged"]);
    let expected = format!("leaving out `--accel bvh` saves {} bytes", grouped(saved));
    assert!(said.contains(&expected), "{expected}: {said}");
}

#[test]
fn a_table_beyond_its_budget_or_the_memory_to_build_it_is_rejected_as_a_blob_is() {
    let folder = Folder::with_quick();
    let build = [
        "build",
        "quick.toml",
        "-o",
        "new.gridel",
        "--accel",
        "cylinder-cube",
    ];
    for (limits, said) in [
        (
            ["--gridels", "1", "--budget", "10"],
            ["1 gridel per side", "--budget", "its budget of 10"],
        ),
        (
            ["--gridels", "64", "--budget", "256M"],
            ["64 gridels per side", "of memory", "--gridels"],
        ),
    ] {
        folder.fails(3, &[&build[..], &limits].concat(), &said);
    }
}

/// The scene does not fit, either, which takes long to find out.
#[test]
fn a_format_that_no_board_was_measured_with_is_rejected_before_the_scene_is_compiled() {
    let folder = Folder::with_quick();
    let build = ["build", "quick.toml", "-o", "new.gridel"];
    let options = [
        "--target",
        "stm32vldiscovery",
        "--format",
        "f64",
        "--emit-rust",
        "module",
    ];
    folder.fails(
        2,
        &[&build[..], &options, &["--max-bytes", "10"]].concat(),
        &["f64 in software, which was not measured"],
    );
}

/// Code and stack of the boards were measured, so they can change: what is asked for here lies far
/// from any border.
#[test]
fn a_scene_that_does_not_fit_a_board_is_rejected_with_figures() {
    let folder = Folder::new();
    folder.write("quick.toml", &fixture("quick"));
    let build = ["build", "quick.toml", "-o", "quick.gridel"];
    let with = |options: &[&'static str]| [&build, options].concat();

    let rejected = |arguments: &[&str]| {
        let run = folder.run(arguments);
        assert_eq!(run.code, Some(3), "{arguments:?}: {}", run.stderr);
        run.said()
    };
    let text = rejected(&with(&["--target", "stm32vldiscovery", "--ram", "1K"]));
    assert!(
        text.contains("bytes of RAM") && text.contains("more than the 1,024"),
        "{text}"
    );
    assert!(
        text.contains("a ray depth of 5 in place of 6 saves 40 bytes"),
        "{text}"
    );
    // Rows are counted whole, so parts of them are no advice.
    assert!(!text.contains("parts of rows"), "{text}");
    let text = rejected(&with(&["--flash", "8K"]));
    assert!(text.contains("bytes of flash"), "{text}");
    assert!(text.contains("with the feature `small`"), "{text}");
    let text = rejected(&with(&["--flash", "8K", "--ram", "1K"]));
    assert_eq!(text.matches("`--accel list`").count(), 1, "{text}");
    assert_eq!(folder.names(), ["quick.toml"]);
    folder.done(&with(&["--target", "mps2-an386"]));
}

/// Advice is true for budgets of the blob and of a board.
#[test]
fn advice_on_flash_is_what_it_saves() {
    let folder = Folder::new();
    // Larger leaves and flagged sides pay where there is a hierarchy to speak of.
    folder.done(&["sample", "nanotube", "-o", "tube.pdb"]);
    let bytes = |options: &[&str]| {
        let build = ["build", "tube.pdb", "-o", "tube.gridel"];
        folder.done(&[&build[..], options].concat());
        folder.read("tube.gridel").len()
    };
    let all = bytes(&[]);
    for rejecting in [["--flash", "8K"], ["--max-bytes", "8K"]] {
        let run =
            folder.run(&[&["build", "tube.pdb", "-o", "new.gridel"], &rejecting[..]].concat());
        assert_eq!(run.code, Some(3), "{}", run.stderr);
        for option in [
            ["--lattice-bits", "16"],
            ["--leaf-size", "8"],
            ["--accel", "flagged"],
            ["--accel", "list"],
        ] {
            let saved = all - bytes(&option);
            let instead = match option[0] {
                "--accel" => " instead of dual-split",
                _ => "",
            };
            let option = option.join(" ");
            let advice = format!("`{option}`{instead} saves {} bytes", grouped(saved));
            assert!(run.said().contains(&advice), "{advice}: {}", run.said());
        }
    }
}

/// Rays that wait have other sizes with nested glass, and one place more than the depth.
#[test]
fn advice_of_a_smaller_depth_states_the_bytes_of_a_board() {
    let folder = Folder::new();
    let tumbler = String::from_utf8(fixture("tumbler")).unwrap();
    assert!(tumbler.contains("\ndepth = "));
    let render = |depth: &str| {
        let lines = tumbler
            .lines()
            .map(|line| match line.starts_with("depth = ") {
                true => format!("depth = {depth}\n"),
                false => format!("{line}\n"),
            });
        folder.write("tumbler.toml", lines.collect::<String>().as_bytes());
        let inspect = [
            "inspect",
            "tumbler.toml",
            "--target",
            "mps2-an386",
            "--ram",
            "100",
        ];
        let run = folder.run(&inspect);
        format!("{} {}", run.stdout.replace('\n', " "), run.said())
    };
    let text = render("1");
    assert!(
        text.contains("a ray depth of 0 in place of 1 saves 88 bytes"),
        "{text}"
    );
    let text = render("3");
    assert!(
        text.contains("a ray depth of 2 in place of 3 saves 44 bytes, and a ray depth of 0 176"),
        "{text}"
    );
}
