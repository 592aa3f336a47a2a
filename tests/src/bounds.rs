//! Error bounds of each kernel's answers, as data: the tests read it, and `core/ACCURACY.md`
//! prints it.
//!
//! `u` is 2^-24 in `f32` and 2^-53 in `f64`. There, errors are counted in `u` times the largest magnitude among the
//! coordinates of ray, hit and shape and the hit's distance. In `fixed` they are counted in sub-steps, 2^-13 of a unit.
//! An answer is off by a length if it is right for a shape that is larger or smaller by that length (see
//! [`gridel_host::shape::Geometric`]).

use crate::shapes::{self, Named};
use gridel_core::{Format, Number};
use gridel_host::shape::Normal;
use std::sync::LazyLock;

/// Allowed error of one shape, in all number formats.
#[derive(Clone, Copy, Debug)]
pub struct Bound {
    pub shape: &'static str,
    /// In the format's units.
    pub error: f64,
    pub reason: &'static str,
}

/// Allowed errors of t, and of whether there is a hit.
pub static CROSSING: LazyLock<Vec<Bound>> = LazyLock::new(|| table(|named| named.crossing));

/// Allowed errors of normals: components off by `u` times the condition, in `fixed` by 2^-28.
pub static NORMAL: LazyLock<Vec<Bound>> = LazyLock::new(|| table(|named| named.normal));

fn table(bound: impl Fn(&Named) -> (f64, &'static str)) -> Vec<Bound> {
    let bounds = shapes::names().map(|named| {
        let (error, reason) = bound(named);
        Bound {
            shape: named.name,
            error,
            reason,
        }
    });
    bounds.collect()
}

/// Largest difference of a normal's length from 1, in units of last place.
pub const NORMAL_LENGTH: f64 = 4.0;

/// The bound of a table for a shape.
pub fn allowed(table: &[Bound], shape: &str) -> f64 {
    let bound = table.iter().find(|bound| bound.shape == shape);
    bound
        .unwrap_or_else(|| panic!("no bound for {shape}"))
        .error
}

/// A table as documents print it.
pub fn markdown(table: &[Bound]) -> String {
    let mut text = String::from("| shape | error | how |\n|---|---|---|\n");
    for Bound {
        shape,
        error,
        reason,
    } in table
    {
        text += &format!("| {shape} | {error} | {reason} |\n");
    }
    text
}

/// The distance from 1 to the next number.
pub fn ulp_of_one<N: Number>() -> f64 {
    match N::FORMAT {
        Format::Fixed => f64::powi(2.0, -30),
        Format::F32 => f64::powi(2.0, -23),
        Format::F64 => f64::powi(2.0, -52),
    }
}

/// The unit that errors of directions are counted in.
pub fn ratio_step<N: Number>() -> f64 {
    match N::FORMAT {
        Format::Fixed => f64::powi(2.0, -28),
        Format::F32 => f64::powi(2.0, -24),
        Format::F64 => f64::powi(2.0, -53),
    }
}

/// The unit that errors of a normal are counted in.
pub fn normal_step<N: Number>(normal: &Normal) -> f64 {
    // The angle of a small cone comes from lengths of few sub-steps.
    let angle = match N::FORMAT {
        Format::Fixed => f64::powi(2.0, -13) / normal.size,
        _ => 0.0,
    };
    ratio_step::<N>() * normal.condition + angle
}
