//! Names and numbers that Python gives.

use gridel_core::{Format, Structure};
use gridel_host::compile::Options;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

pub fn invalid(error: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

pub fn structure(name: &str) -> PyResult<Structure> {
    let found = Structure::ALL.into_iter().find(|it| it.name() == name);
    found.ok_or_else(|| {
        let names = Structure::ALL.map(Structure::name).join(", ");
        invalid(format!(
            "unknown structure `{name}`; the structures are {names}"
        ))
    })
}

pub fn format(name: &str) -> PyResult<Format> {
    let found = Format::ALL.into_iter().find(|it| it.name() == name);
    found.ok_or_else(|| {
        invalid(format!(
            "unknown number format `{name}`; use fixed, f32 or f64"
        ))
    })
}

pub fn options(accel: &[String], lattice_bits: u8) -> PyResult<Options> {
    if !(16..=24).contains(&lattice_bits) {
        return Err(invalid(format!(
            "lattice_bits is {lattice_bits}; it must be 16 to 24"
        )));
    }
    Ok(Options {
        structures: accel
            .iter()
            .map(|name| structure(name))
            .collect::<PyResult<_>>()?,
        lattice_bits,
        ..Options::default()
    })
}
