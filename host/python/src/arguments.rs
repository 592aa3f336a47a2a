//! Names and numbers that Python gives.

use gridel_core::{Format, Scene, Structure};
use gridel_host::compile::CompileError;
use gridel_host::explained;
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::Path;

/// Numbers of errors that Linux, macOS and Windows share.
const ENOENT: i32 = 2;
const EISDIR: i32 = 21;
const EINVAL: i32 = 22;

/// A ValueError of what is wrong.
pub fn invalid(error: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// A ValueError of what is wrong and what to do.
pub fn rejected(error: impl Into<CompileError>) -> PyErr {
    invalid(in_python(&explained(&error.into())))
}

/// A sentence with the options of the command line as they are written in Python: `--model N` as `model=N`.
pub fn in_python(sentence: &str) -> String {
    const OPTIONS: [&str; 14] = [
        "accel",
        "allow-outside",
        "altloc",
        "animation",
        "assembly",
        "camera",
        "instances",
        "lattice-bits",
        "model",
        "normals",
        "quality",
        "style",
        "texture-bytes",
        "without",
    ];
    OPTIONS.iter().fold(sentence.to_owned(), |sentence, name| {
        let own = name.replace('-', "_");
        sentence
            .replace(&format!("`--{name}`"), &format!("`{own}`"))
            .replace(&format!("`--{name} "), &format!("`{own}="))
    })
}

/// The error of a file: a ValueError names it, others stay as they are.
pub fn in_file(py: Python<'_>, path: &Path, error: PyErr) -> PyErr {
    if error.is_instance_of::<PyValueError>(py) {
        invalid(format!("{}: {}", path.display(), error.value(py)))
    } else {
        error
    }
}

/// Rejects what is not a file to read, with the number, text and path that errors of files have in Python.
pub fn check_file(path: &Path) -> PyResult<()> {
    let (number, text) = match fs::metadata(path) {
        Ok(found) if found.is_file() => return Ok(()),
        Ok(found) if found.is_dir() => (EISDIR, "a directory; name a scene file in it"),
        Ok(_) => (EINVAL, "not a regular file; give its bytes to `from_blob`"),
        Err(_) if path.as_os_str().is_empty() => {
            (ENOENT, "the path is empty; give the path of a scene file")
        }
        Err(error) if error.kind() == ErrorKind::NotFound => (ENOENT, "no such file"),
        Err(error) => return Err(unreadable(&error, path)),
    };
    Err(file_error(Some(number), text.to_owned(), path))
}

/// The error of a file that cannot be read.
pub fn unreadable(error: &io::Error, path: &Path) -> PyErr {
    file_error(error.raw_os_error(), error.to_string(), path)
}

/// Python chooses the class by the number: FileNotFoundError, IsADirectoryError, PermissionError and others.
fn file_error(number: Option<i32>, text: String, path: &Path) -> PyErr {
    PyOSError::new_err((number.unwrap_or(EINVAL), text, path.as_os_str().to_owned()))
}

/// The error of a structure that a scene does not hold.
pub fn not_held(structure: Structure, scene: &Scene<'_>) -> PyErr {
    let held: Vec<_> = scene.structures().map(Structure::name).collect();
    let sentence = format!(
        "accel: the scene does not hold the structure `{}`, but {}; compile it with accel=[...]",
        structure.name(),
        held.join(", ")
    );
    Python::attach(|py| {
        let class = py
            .import("gridel._errors")
            .and_then(|errors| errors.getattr("StructureError"))
            .and_then(|class| class.call1((sentence,)));
        class.map_or_else(|error| error, PyErr::from_value)
    })
}

pub fn structure(name: &str) -> PyResult<Structure> {
    Structure::from_name(name).ok_or_else(|| {
        let names = Structure::ALL.map(Structure::name).join(", ");
        invalid(format!(
            "unknown structure `{name}`; the structures are {names}"
        ))
    })
}

pub fn format(name: &str) -> PyResult<Format> {
    Format::from_name(name).ok_or_else(|| {
        invalid(format!(
            "unknown number format `{name}`; use fixed, f32 or f64"
        ))
    })
}

pub fn structures(names: &[String]) -> PyResult<Vec<Structure>> {
    names.iter().map(|name| structure(name)).collect()
}
