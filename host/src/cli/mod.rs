//! The command line: one file per command, and what the commands share.
//!
//! | file | what is in it |
//! |---|---|
//! | `failure.rs` | why a command ends, and the exit code that says so |
//! | `arguments/` | options that several commands have |
//! | `input.rs` | a file or standard input |
//! | `source/` | the blob or scene file that a command works on |
//! | `effects.rs` | what requires the effects of a scene |
//! | `output.rs` | files and standard output |
//! | `shell.rs` | completion scripts for shells, and man pages |
//! | `progress.rs` | the sign of life of long work |
//! | `saving.rs` | when unfinished work is saved |
//! | `threads.rs` | threads of long work |
//! | `names.rs` | the names of hit objects |
//! | `changes.rs` | what `--light`, `--material` and their like change |

mod arguments;
mod changes;
mod effects;
mod failure;
mod input;
mod names;
mod output;
mod progress;
mod saving;
mod source;
mod threads;

mod accuracy;
mod build;
mod certify;
mod check;
mod compare;
mod explain;
mod help;
mod inspect;
mod merge;
mod render;
mod sample;
#[cfg(feature = "shell")]
mod shell;
mod trace;
mod verify;
mod view;
mod web;

use clap::{Arg, CommandFactory, FromArgMatches, Parser, Subcommand};
use gridel_host::output::unfinished;
use peak_alloc::PeakAlloc;
use std::io::{self, IsTerminal, Write};
use std::process::ExitCode;

/// Compile scenes into blobs, and ray trace them on a microcontroller or on a host
#[derive(Parser)]
#[command(
    name = "gridel",
    version,
    after_help = format!("{}\n\n{}", help::TOPIC_LIST, failure::EXIT_CODES),
    arg_required_else_help = true,
    disable_help_subcommand = true
)]
struct Program {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Build(build::Arguments),
    Compare(compare::Arguments),
    Inspect(inspect::Arguments),
    Render(render::Arguments),
    View(view::Arguments),
    Merge(merge::Arguments),
    Trace(trace::Arguments),
    Accuracy(accuracy::Arguments),
    Verify(verify::Arguments),
    Certify(certify::Arguments),
    Explain(explain::Arguments),
    Sample(sample::Arguments),
    Check(check::Arguments),
    Web(web::Arguments),
    Help(help::Arguments),
    #[cfg(feature = "shell")]
    Completions(shell::CompletionArguments),
    #[cfg(feature = "shell")]
    Man(shell::ManArguments),
}

/// Runs the program.
///
/// `memory` is the program's allocator, which knows how much is in use.
pub fn run(memory: &PeakAlloc) -> ExitCode {
    failure::break_lines_at_spaces();
    let program = match parsed() {
        Ok(program) => program,
        Err(answer) => return answered(&answer),
    };
    // Without a handler an interrupt would only leave a temporary file behind.
    let _ = ctrlc::set_handler(|| {
        if io::stderr().is_terminal() {
            // What is shown of progress ends in the middle of a line.
            unfinished::within_limits(|| drop(io::stderr().write_all(b"\r\x1b[2K")));
        }
        unfinished::exit_removing_unfinished(failure::INTERRUPTED)
    });
    if let Err(cause) = gridel_host::simd::from_environment() {
        return failure::Failure::usage(cause, "unset the variable for the fastest").report();
    }
    let done = match program.command {
        Command::Build(arguments) => build::run(&arguments),
        Command::Compare(arguments) => compare::run(&arguments, memory),
        Command::Inspect(arguments) => inspect::run(&arguments),
        Command::Render(arguments) => render::run(&arguments),
        Command::View(arguments) => view::run(&arguments),
        Command::Merge(arguments) => merge::run(&arguments),
        Command::Trace(arguments) => trace::run(&arguments),
        Command::Accuracy(arguments) => accuracy::run(&arguments),
        Command::Verify(arguments) => verify::run(&arguments),
        Command::Certify(arguments) => certify::run(&arguments),
        Command::Explain(arguments) => explain::run(&arguments),
        Command::Sample(arguments) => sample::run(&arguments),
        Command::Check(arguments) => check::run(&arguments),
        Command::Web(arguments) => web::run(&arguments),
        Command::Help(arguments) => help::run(&arguments, Program::command()),
        #[cfg(feature = "shell")]
        Command::Completions(arguments) => shell::completions(&arguments, Program::command()),
        #[cfg(feature = "shell")]
        Command::Man(arguments) => shell::man(&arguments, Program::command()),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}

/// Reads the command line.
fn parsed() -> Result<Program, clap::Error> {
    let mut command = negative_numbers_as_values(Program::command());
    let mut matches = command.try_get_matches_from_mut(std::env::args_os())?;
    let program = Program::from_arg_matches_mut(&mut matches);
    program.map_err(|error| error.format(&mut command))
}

/// Lets options take numbers below 0, so that `--room -1` is a value out of range and not an unknown option.
fn negative_numbers_as_values(program: clap::Command) -> clap::Command {
    let allow = |option: Arg| match option.is_positional() || !option.get_action().takes_values() {
        true => option,
        false => option.allow_negative_numbers(true),
    };
    program.mut_subcommands(|command| command.mut_args(allow))
}

/// Prints what clap answers by itself: the help, the version, or what is wrong with the command line.
fn answered(answer: &clap::Error) -> ExitCode {
    let printed = answer.print().and_then(|()| io::stdout().flush());
    // Standard error may be closed; the exit code says enough.
    match output::printed(printed) {
        Err(failure) if !answer.use_stderr() => failure.report(),
        _ => ExitCode::from(u8::try_from(answer.exit_code()).unwrap_or(2)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        negative_numbers_as_values(Program::command()).debug_assert();
    }
}
