//! Where results go: files, and standard output.

use super::failure::Failure;
use gridel_host::output::write_whole;
use serde::Serialize;
use std::fmt::Display;
use std::io::{self, Write};
use std::path::Path;

/// Writes a file whole or not at all.
pub fn write_file(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), Failure> {
    write_whole(path, write).map_err(|error| Failure::writing(path, &error))
}

/// Refuses to write over a file that is read.
pub fn refuse_same(input: &Path, output: &Path) -> Result<(), Failure> {
    let same = match (input.canonicalize(), output.canonicalize()) {
        (Ok(input), Ok(output)) => input == output,
        // A file that does not exist is no input.
        _ => false,
    };
    if same {
        return Err(Failure::usage(
            format!(
                "the output {} is the input, which would be lost",
                output.display()
            ),
            "give the output another name",
        ));
    }
    Ok(())
}

/// Prints on standard output.
pub fn print(text: impl Display) -> Result<(), Failure> {
    to_standard_output(format!("{text}").as_bytes())
}

/// Prints one JSON document on standard output.
pub fn print_json(value: &impl Serialize) -> Result<(), Failure> {
    let mut text = serde_json::to_vec_pretty(value)
        .map_err(|error| Failure::failed(error.to_string(), "report this as a fault of gridel"))?;
    text.push(b'\n');
    to_standard_output(&text)
}

fn to_standard_output(text: &[u8]) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    let written = out.write_all(text).and_then(|()| out.flush());
    written.map_err(|error| match error.kind() {
        io::ErrorKind::BrokenPipe => Failure::ClosedPipe,
        _ => Failure::failed(
            format!("the report cannot be written: {error}"),
            "check where standard output leads; the files that were asked for are written",
        ),
    })
}

/// Prints a warning on standard error.
pub fn warn(sentence: impl Display) {
    // Standard error may be closed; that is no reason to stop.
    let _ = writeln!(io::stderr(), "warning: {sentence}");
}
