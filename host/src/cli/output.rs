//! Destinations of results: files, and standard output.

use super::failure::Failure;
use super::input::is_standard;
use gridel_host::output::{self, Files, place, write_whole};
use gridel_host::table::shown;
use serde::Serialize;
use std::collections::BTreeSet;
use std::fmt::Display;
use std::fs;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};

/// Writes a binary file whole or not at all, or standard output.
pub fn write_file(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), Failure> {
    if is_standard(path) {
        reject_terminal()?;
    }
    write_text_file(path, write)
}

/// Writes a text file whole or not at all, or standard output, which may be a terminal.
pub fn write_text_file(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), Failure> {
    if is_standard(path) {
        return write_standard(write);
    }
    write_whole(path, write).map_err(|error| Failure::writing(path, &error))
}

/// Rejects to write bytes to a terminal, which would take some of them for commands.
fn reject_terminal() -> Result<(), Failure> {
    if io::stdout().is_terminal() {
        return Err(Failure::usage(
            "standard output is a terminal, and what is written is binary",
            "redirect it to a file or a pipe, or name a file in place of `-`",
        ));
    }
    Ok(())
}

/// Writes all at once, so that an error leaves nothing written.
fn write_standard(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Failure> {
    let mut bytes = Vec::new();
    write(&mut bytes).map_err(|error| Failure::writing(Path::new("<stdout>"), &error))?;
    to_standard_output(&bytes)
}

/// Checks that a binary file can be written, before the work for its content.
pub fn check_writable(path: &Path) -> Result<(), Failure> {
    if is_standard(path) {
        return reject_terminal();
    }
    check_text_writable(path)
}

/// Checks that a text file can be written, before the work for its content.
pub fn check_text_writable(path: &Path) -> Result<(), Failure> {
    if is_standard(path) {
        return Ok(());
    }
    output::check_writable(path).map_err(|error| Failure::writing(path, &error))
}

/// The content of a binary file of [`write_files`].
pub type Content<'c> = &'c dyn Fn(&mut dyn Write) -> io::Result<()>;

/// Writes binary files, or texts that do not go to standard output, all of them or none.
pub fn write_files(files: &[(&Path, Content<'_>)]) -> Result<(), Failure> {
    let mut together = Files::default();
    let is_stream = |(path, _): &&(&Path, Content<'_>)| is_standard(path);
    if files.iter().any(|file| is_stream(&file)) {
        reject_terminal()?;
    }
    for &(path, write) in files.iter().filter(|file| !is_stream(file)) {
        together
            .add(path, write)
            .map_err(|error| Failure::writing(path, &error))?;
    }
    keep(together)?;
    files
        .iter()
        .filter(is_stream)
        .try_for_each(|(_, write)| write_standard(write))
}

/// Rejects `-` as a folder: elsewhere it means standard output, which holds no files.
pub fn check_folder(folder: &Path) -> Result<(), Failure> {
    if is_standard(folder) {
        return Err(Failure::usage(
            "`-` is standard output, and several files are written",
            "name a folder for them; one that is called `-` is written `./-`",
        ));
    }
    Ok(())
}

/// Returns the folder of results: the requested one, or one named after the command and the scene.
pub fn results_folder(requested: Option<&Path>, command: &str, stem: &str) -> PathBuf {
    requested.map_or_else(|| format!("{command}-{stem}").into(), Path::to_owned)
}

/// Returns the error of results that another run left, and that this one does not replace.
pub fn of_another_run(path: &Path) -> Failure {
    Failure::usage(
        format!(
            "{} is from a run with another scene, other options or another build of gridel: it would be overwritten",
            path.display()
        ),
        "give another folder with `-o`, or remove that one",
    )
}

/// Rejects to write over a file of another sort, such as the buffer of a glTF scene, or a program's own.
pub fn reject_foreign(
    path: &Path,
    sort: &str,
    is_one: impl Fn(&Path) -> io::Result<bool>,
) -> Result<(), Failure> {
    let is_foreign = match fs::metadata(path) {
        Ok(there) if there.is_file() && there.len() > 0 => {
            !is_one(path).map_err(|error| Failure::reading(path, &error))?
        }
        // Output to devices and pipes replaces nothing.
        _ => false,
    };
    if is_foreign {
        return Err(Failure::usage(
            format!(
                "{} exists and is not a {sort}: it would be overwritten",
                path.display()
            ),
            "write to another name or folder, or move that file away",
        ));
    }
    Ok(())
}

/// Writes texts into a folder, by the names of their files, all of them or none.
pub fn write_texts(folder: &Path, texts: &[(&str, String)]) -> Result<(), Failure> {
    let mut files = Files::default();
    for (name, text) in texts {
        let path = folder.join(name);
        files
            .add(&path, |out| out.write_all(text.as_bytes()))
            .map_err(|error| Failure::writing(&path, &error))?;
    }
    keep(files)
}

fn keep(files: Files) -> Result<(), Failure> {
    files
        .keep()
        .map_err(|(path, error)| Failure::writing(&path, &error))
}

/// Rejects to write over a file that is read.
pub fn reject_same(input: &Path, output: &Path) -> Result<(), Failure> {
    reject_inputs([input], [output], "the input")
}

/// Rejects to write over files that are read; `role` says what they are.
pub fn reject_inputs<'i>(
    inputs: impl IntoIterator<Item = &'i Path>,
    outputs: impl IntoIterator<Item = impl AsRef<Path>>,
    role: &str,
) -> Result<(), Failure> {
    let inputs = inputs.into_iter().filter(|input| !is_standard(input));
    let inputs: BTreeSet<_> = inputs.map(place).collect();
    for output in outputs {
        let output = output.as_ref();
        if !is_standard(output) && inputs.contains(&place(output)) {
            return Err(Failure::usage(
                format!(
                    "the output {} is {role}, which would be lost",
                    output.display()
                ),
                "give the output another name",
            ));
        }
    }
    Ok(())
}

/// Rejects an extension of another kind of file; a name without one is accepted.
pub fn check_extension(path: &Path, wanted: &[&str], what: &str) -> Result<(), Failure> {
    let Some(extension) = path.extension() else {
        return Ok(());
    };
    if wanted.iter().any(|it| extension.eq_ignore_ascii_case(it)) {
        return Ok(());
    }
    Err(unsupported(
        path,
        what,
        &format!(".{}", wanted.join(" or .")),
    ))
}

/// Returns the error of a file name whose extension names no format of such files.
pub fn unsupported(path: &Path, what: &str, supported: &str) -> Failure {
    let shown = path.display();
    let cause = match path.extension() {
        Some(extension) => {
            format!(
                "{shown}: unsupported {what} format `.{}`",
                extension.display()
            )
        }
        None => format!("{shown}: the name has no extension, which selects the {what} format"),
    };
    Failure::usage(cause, format!("use {supported}"))
}

/// Prints on standard output.
pub fn print(text: impl Display) -> Result<(), Failure> {
    to_standard_output(text.to_string().as_bytes())
}

/// Prints on standard error, where standard output has another document.
pub fn print_aside(text: impl Display) {
    // Standard error may be closed; that is no reason to stop.
    let _ = write!(io::stderr(), "{text}");
}

/// Prints one JSON document on standard output.
pub fn print_json(value: &impl Serialize) -> Result<(), Failure> {
    print(json(value)?)
}

/// Prints one JSON document about a scene, to which it adds what its importer warned of.
pub fn print_json_warned(value: &impl Serialize, warnings: &[String]) -> Result<(), Failure> {
    print(json(&Warned { value, warnings })?)
}

/// A value, to which is added what an importer warned of.
#[derive(Serialize)]
pub struct Warned<'w, T: Serialize> {
    #[serde(flatten)]
    pub value: &'w T,
    pub warnings: &'w [String],
}

/// Returns a value as one JSON document.
pub fn json(value: &impl Serialize) -> Result<String, Failure> {
    let text = serde_json::to_string_pretty(value);
    Ok(text.map_err(Failure::fault)? + "\n")
}

/// Prints a report about `output`: on standard output, or on standard error if the output itself goes to standard
/// output.
pub fn print_about(output: &Path, text: impl Display) -> Result<(), Failure> {
    if is_standard(output) {
        print_aside(text);
        return Ok(());
    }
    print(text)
}

fn to_standard_output(text: &[u8]) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    printed(out.write_all(text).and_then(|()| out.flush()))
}

/// Returns the result of printing on standard output.
pub fn printed(written: io::Result<()>) -> Result<(), Failure> {
    match written {
        // A reader that closes the pipe early is no failure, and changes no finding.
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(Failure::failed(
            format!("standard output cannot be written: {error}"),
            "check where it leads; files that were asked for are written",
        )),
        _ => Ok(()),
    }
}

/// Prints a warning on standard error.
pub fn warn(sentence: impl Display) {
    print_aside(format!("warning: {}\n", shown(&sentence.to_string())));
}
