//! `gridel completions` and `gridel man`: completion scripts for shells, and man pages.

use super::failure::Failure;
use super::help;
use super::output::{print, write_texts};
use clap::{Args, Command};
use clap_complete::Shell;
use clap_mangen::Man;
use std::path::PathBuf;

/// Print the completions of a shell
///
/// For bash, for example: `gridel completions bash >~/.local/share/bash-completion/completions/gridel`
#[derive(Args)]
#[command(after_help = super::failure::EXIT_CODES)]
pub struct CompletionArguments {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

/// Write the manual's pages, one for each command, into a folder
///
/// `man -l DIR/gridel-build.1` shows one of them.
#[derive(Args)]
#[command(after_help = super::failure::EXIT_CODES)]
pub struct ManArguments {
    /// The folder; it is made if need be
    #[arg(value_name = "DIR")]
    folder: PathBuf,
}

/// Prints completions.
pub fn completions(arguments: &CompletionArguments, mut program: Command) -> Result<(), Failure> {
    // The program itself takes a subject as an argument, and has its own error for others.
    let help = help::with_subjects(&program);
    program = program.mut_subcommand("help", |_| help);
    let mut text = Vec::new();
    clap_complete::generate(arguments.shell, &mut program, "gridel", &mut text);
    print(String::from_utf8_lossy(&text))
}

/// Writes pages.
pub fn man(arguments: &ManArguments, mut program: Command) -> Result<(), Failure> {
    let folder = &arguments.folder;
    program.build();
    let pages: Vec<(String, String)> = std::iter::once(&program)
        .chain(program.get_subcommands())
        .map(|command| {
            let page = Man::new(command.clone());
            let mut text = Vec::new();
            // Writing to memory cannot fail.
            let _ = page.render(&mut text);
            let text = String::from_utf8_lossy(&text).into_owned();
            (page.get_filename(), text)
        })
        .collect();
    std::fs::create_dir_all(folder).map_err(|error| Failure::writing(folder, &error))?;
    let pages: Vec<(&str, String)> = pages
        .iter()
        .map(|(name, text)| (name.as_str(), text.clone()))
        .collect();
    write_texts(folder, &pages)
}
