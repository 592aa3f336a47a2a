//! `gridel completions` and `gridel man`.

use crate::program::Folder;

#[test]
fn completions_name_commands_and_options() {
    let folder = Folder::new();
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let text = folder.done(&["completions", shell]);
        for word in ["render", "accuracy", "lattice-bits", "stm32vldiscovery"] {
            assert!(text.contains(word), "{shell}: no {word}");
        }
        // Subjects of `gridel help`.
        for topic in ["benchmarks", "speed against other libraries"] {
            let is_named = text.contains(topic) || (shell == "bash" && topic.contains(' '));
            assert!(is_named, "{shell}: no {topic}");
        }
    }
    folder.fails(2, &["completions", "tcsh"], &["[possible values: bash"]);
}

#[test]
fn every_command_has_a_page_of_the_manual() {
    let folder = Folder::new();
    folder.done(&["man", "man/man1"]);
    let help = folder.done(&["--help"]);
    let commands = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let commands = commands.map_while(|line| line.split_whitespace().next());
    let commands: Vec<_> = commands.collect();
    assert!(commands.len() >= 14, "{commands:?}");
    for command in commands {
        let page = folder.read(&format!("man/man1/gridel-{command}.1"));
        let page = String::from_utf8(page).unwrap();
        assert!(
            page.contains(".SH SYNOPSIS") && (command == "help" || page.contains("Exit codes")),
            "{command}"
        );
    }
    assert!(folder.path("man/man1/gridel.1").is_file());
    folder.write("file", b"");
    folder.fails(1, &["man", "file"], &["file cannot be written"]);
}
