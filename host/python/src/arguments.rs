//! Names and numbers that Python gives.

use gridel_core::{Format, Structure};
use gridel_host::compile::{CompileError, Options};
use gridel_host::explained;
use pyo3::exceptions::{PyFileNotFoundError, PyIsADirectoryError, PyValueError};
use pyo3::prelude::*;
use std::path::Path;

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

/// Rejects what is not a file to read.
pub fn check_file(path: &Path) -> PyResult<()> {
    if path.is_file() {
        return Ok(());
    }
    let what = match (path.is_dir(), path.exists()) {
        (true, _) => "a directory; name a scene file in it",
        (_, true) => "not a regular file; give its bytes to `from_blob`",
        (_, false) => "no such file",
    };
    let sentence = format!("{}: {what}", path.display());
    Err(match path.is_dir() {
        true => PyIsADirectoryError::new_err(sentence),
        false => PyFileNotFoundError::new_err(sentence),
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

pub fn options(accel: &[String], lattice_bits: u8) -> PyResult<Options> {
    Ok(Options {
        structures: accel
            .iter()
            .map(|name| structure(name))
            .collect::<PyResult<_>>()?,
        lattice_bits,
        ..Options::default()
    })
}
