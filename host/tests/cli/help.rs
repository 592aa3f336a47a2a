//! `gridel help`: commands and documents.

use crate::program::Folder;

#[test]
fn help_prints_the_list_of_commands_and_topics() {
    let run = Folder::new().run(&["help"]);
    assert_eq!(run.code, Some(0));
    for word in ["build", "render", "help", "scene", "structures", "paper"] {
        assert!(run.stdout.contains(&format!("\n  {word} ")), "{word}");
    }
}

#[test]
fn help_prints_the_options_of_a_command() {
    let folder = Folder::new();
    let run = folder.run(&["help", "build"]);
    assert_eq!(run.code, Some(0));
    assert!(run.stdout.contains("Usage: gridel build"), "{}", run.stdout);
    assert_eq!(run.stdout, folder.run(&["build", "--help"]).stdout);
}

#[test]
fn help_prints_documents_without_marks() {
    for (topic, title) in [
        ("scene", "# The scene file\n"),
        ("check", "# The check manifest\n"),
        ("structures", "# Acceleration structures\n"),
        ("memory", "# Memory\n"),
        ("benchmarks", "# Benchmarks\n"),
        ("paper", "# The paper's tables and ours\n"),
    ] {
        let run = Folder::new().run(&["help", topic]);
        assert_eq!(run.code, Some(0), "{topic}");
        assert!(run.stdout.starts_with(title), "{topic}");
        assert!(!run.stdout.contains("<!--"), "{topic}");
    }
}

#[test]
fn help_rejects_unknown_subjects() {
    let run = Folder::new().run(&["help", "nonsense"]);
    assert_eq!(run.code, Some(2));
    assert!(
        run.said().contains("no command or topic `nonsense`"),
        "{}",
        run.stderr
    );
}

#[test]
fn help_lists_target_behind_eye() {
    let folder = Folder::new();
    for command in ["render", "explain", "compare"] {
        let help = folder.done(&[command, "--help"]);
        let lines = help.lines().map(str::trim_start);
        let options: Vec<_> = lines
            .filter(|line| line.starts_with("--"))
            .filter_map(|line| line.split_whitespace().next())
            .collect();
        let eye = options
            .iter()
            .position(|option| *option == "--eye")
            .unwrap();
        let view = ["--eye", "--target", "--up", "--fov", "--background"];
        assert_eq!(options[eye..eye + 5], view, "{command}");
    }
}
