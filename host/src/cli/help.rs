//! `gridel help`: the help of a command, and the documents.

use super::failure::Failure;
use super::output::print;
use clap::{Args, Command};

/// Print the help of a command, or a document
#[derive(Args)]
#[command(after_help = TOPIC_LIST)]
pub struct Arguments {
    /// Command or topic [default: the list of commands and topics]
    #[arg(value_name = "COMMAND|TOPIC")]
    subject: Option<String>,
}

/// The topics, as the program's help lists them.
pub const TOPIC_LIST: &str = "\
Topics (`gridel help TOPIC` prints a document):
  scene       the scene file: every table and key
  check       the manifest of `gridel check`: every table and key
  structures  acceleration structures, and when to use which
  python      the Python package: rays and points in NumPy arrays
  web         the web page: scenes, errors and costs in a browser
  memory      bytes of blobs, of RAM and of flash on boards
  benchmarks  speed against other libraries, and what accuracy costs
  exact       the exact picture that `gridel certify` proves
  paper       the tables of the paper, measured again";

/// The documents by their topics.
const TOPICS: [(&str, &str); 9] = [
    ("scene", include_str!("../../docs/SCENE.md")),
    ("check", include_str!("../../docs/CHECK.md")),
    ("structures", include_str!("../../docs/STRUCTURES.md")),
    ("python", include_str!("../../docs/PYTHON.md")),
    ("web", include_str!("../../docs/WEB.md")),
    ("memory", include_str!("../../docs/MEMORY.md")),
    ("benchmarks", include_str!("../../docs/BENCHMARKS.md")),
    ("exact", include_str!("../../docs/EXACT.md")),
    ("paper", include_str!("../../docs/PAPER.md")),
];

/// Returns the command `help` of a program with a command for each of its subjects, as completions of shells list them.
#[cfg(feature = "shell")]
pub fn with_subjects(program: &Command) -> Command {
    let subject = |name: &'static str| Command::new(name).disable_help_flag(true);
    let commands = program.get_subcommands().map(|command| {
        // The name must outlive the command, and the program ends soon.
        let named = subject(command.get_name().to_owned().leak());
        named.about(command.get_about().cloned().unwrap_or_default())
    });
    let about = |name: &str| {
        let mut lines = TOPIC_LIST.lines();
        let line = lines.find_map(|line| line.trim_start().strip_prefix(name));
        line.unwrap_or_default().trim_start()
    };
    // `check` is a command, too.
    let topics = TOPICS.iter().map(|&(name, _)| name);
    let topics = topics.filter(|name| program.find_subcommand(name).is_none());
    let topics = topics.map(|name| subject(name).about(about(name)));
    let help = program.find_subcommand("help");
    let help = help.and_then(Command::get_about).cloned();
    Command::new("help")
        .about(help.unwrap_or_default())
        .disable_help_subcommand(true)
        .subcommands(commands.chain(topics))
}

/// Prints the help of a command of `program`, a document, or the list of both.
pub fn run(arguments: &Arguments, mut program: Command) -> Result<(), Failure> {
    let Some(subject) = arguments.subject.as_deref() else {
        return print(program.render_long_help());
    };
    if let Some((_, document)) = TOPICS.iter().find(|(name, _)| *name == subject) {
        return print(without_marks(document));
    }
    // Names the program in the usage of its commands.
    program.build();
    match program.find_subcommand_mut(subject) {
        Some(command) => print(command.render_long_help()),
        None => Err(Failure::usage(
            format!("there is no command or topic `{subject}`"),
            "run `gridel help` to list them",
        )),
    }
}

/// A document without the marks around its generated tables.
fn without_marks(document: &str) -> String {
    let lines = document.lines().filter(|line| !line.starts_with("<!-- "));
    lines.flat_map(|line| [line, "\n"]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn topic_list_names_every_document() {
        for (name, document) in TOPICS {
            assert!(TOPIC_LIST.contains(&format!("\n  {name} ")), "{name}");
            assert!(document.starts_with("# "), "{name}");
            assert!(!without_marks(document).contains("<!--"), "{name}");
        }
    }
}
