//! What each kernel's answers may be off by, as data.
//!
//! `u` is 2^-24 in `f32` and 2^-53 in `f64`, where errors are counted in `u` times the largest
//! magnitude among the coordinates of ray, hit and shape and the hit's distance; in `fixed` they
//! are counted in sub-steps, 2^-13 of a unit. An answer is off by a length if it is right for a shape
//! that is larger or smaller by that length (see [`crate::solid`]).

use crate::solid::Normal;
use gridel_core::{Format, Number};

/// Allowed errors of one shape.
#[derive(Clone, Copy, Debug)]
pub struct Bound {
    pub shape: &'static str,
    pub fixed: f64,
    pub f32: f64,
    pub f64: f64,
}

/// Allowed errors of t, and of whether there is a hit.
pub const CROSSING: [Bound; 7] = [
    bound("sphere", 8.0, 8.0, 8.0),
    bound("triangle", 8.0, 8.0, 8.0),
    bound("box", 8.0, 8.0, 8.0),
    bound("disc", 8.0, 8.0, 8.0),
    bound("cylinder", 8.0, 8.0, 8.0),
    bound("cone", 8.0, 8.0, 8.0),
    bound("frustum", 8.0, 8.0, 8.0),
];

/// Allowed errors of normals: components off by `u` times the condition, in `fixed` by 2^-28.
pub const NORMAL: [Bound; 7] = [
    bound("sphere", 8.0, 8.0, 8.0),
    bound("triangle", 8.0, 8.0, 8.0),
    bound("box", 0.0, 0.0, 0.0),
    bound("disc", 8.0, 8.0, 8.0),
    bound("cylinder", 8.0, 8.0, 8.0),
    bound("cone", 8.0, 8.0, 8.0),
    bound("frustum", 8.0, 8.0, 8.0),
];

const fn bound(shape: &'static str, fixed: f64, f32: f64, f64: f64) -> Bound {
    Bound {
        shape,
        fixed,
        f32,
        f64,
    }
}

/// The bound of a table for a shape and number format.
pub fn allowed<N: Number>(table: &[Bound], shape: &str) -> f64 {
    let Some(bound) = table.iter().find(|bound| bound.shape == shape) else {
        panic!("no bound for {shape}");
    };
    match N::FORMAT {
        Format::Fixed => bound.fixed,
        Format::F32 => bound.f32,
        Format::F64 => bound.f64,
    }
}

/// The unit that errors of lengths are counted in, for numbers of a magnitude.
pub fn length_step<N: Number>(magnitude: f64) -> f64 {
    match N::FORMAT {
        Format::Fixed => f64::powi(2.0, -13),
        Format::F32 => f64::powi(2.0, -24) * magnitude,
        Format::F64 => f64::powi(2.0, -53) * magnitude,
    }
}

/// The unit that errors of a normal are counted in.
pub fn normal_step<N: Number>(normal: &Normal) -> f64 {
    let step = match N::FORMAT {
        Format::Fixed => f64::powi(2.0, -28),
        Format::F32 => f64::powi(2.0, -24),
        Format::F64 => f64::powi(2.0, -53),
    };
    // The angle of a small cone comes from lengths of few sub-steps.
    let angle = match N::FORMAT {
        Format::Fixed => f64::powi(2.0, -13) / normal.size,
        _ => 0.0,
    };
    step * normal.condition + angle
}
