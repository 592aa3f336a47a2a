//! Rays, and where they cross surfaces.

use super::number::*;
use std::cmp::Ordering;

/// Numbers of the parts of a cone.
pub const MANTLE: u8 = 0;
pub const BASE: u8 = 1;
pub const APEX: u8 = 2;

/// A ray. Lengths are in lattice steps; t counts directions, of any length.
#[derive(Clone, Copy, Debug)]
pub struct Ray<N> {
    pub origin: Three<N>,
    pub direction: Three<N>,
    pub start: Start,
}

/// The surface that a ray starts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    Free,
    On {
        instance: u32,
        /// The first primitive of its form. A ray leaves all primitives of one form equally.
        twin: u32,
        part: u8,
        /// The surface that the start lies in, if primitives may share it.
        surface: u32,
        /// Planes that it lies in exactly, too.
        also: [u32; 2],
        /// True if it goes to the other side than that of the normal.
        inward: bool,
    },
}

impl Start {
    /// Returns whether a t counts: from 0 on at a free start, above 0 on a surface. `None` if that is open.
    pub fn is_before<N: Enclosure>(self, t: N) -> Option<bool> {
        match self {
            Self::Free => positive(-t).map(|is_behind| !is_behind),
            Self::On { .. } => positive(t),
        }
    }
}

/// A crossing of a primitive's surface ahead of a ray's start.
#[derive(Clone, Copy, Debug)]
pub struct Crossing<N> {
    pub t: N,
    /// Numerator and divisor of t, so that it can be compared without a rounding.
    pub fraction: Option<[N; 2]>,
    /// The face of a box; mantle, base and other cap of a cone.
    pub part: u8,
    /// True if the ray leaves a solid.
    pub leaves: bool,
    /// True if it is certain that the ray crosses here.
    pub sure: bool,
}

/// A ray runs so nearly along a surface that it is open where it crosses it, if at all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grazes;

/// Compares the t of two crossings; `None` if that is open.
pub fn compare<N: Enclosure>(a: &Crossing<N>, b: &Crossing<N>) -> Option<Ordering> {
    if let Some(sign) = (a.t - b.t).sign() {
        return Some(sign);
    }
    let ([p, q], [r, s]) = (a.fraction?, b.fraction?);
    let (difference, divisor) = ((p * s - r * q).sign()?, (q * s).sign()?);
    Some(if divisor == Ordering::Less {
        difference.reverse()
    } else {
        difference
    })
}

/// Converts a vector of integers exactly.
pub fn exact<N: Enclosure>(v: [i64; 3]) -> Three<N> {
    v.map(N::int)
}

impl<N: Enclosure> Crossing<N> {
    /// Adds a crossing if it may be ahead of a start.
    pub fn keep(mut self, start: Start, found: &mut Vec<Self>) {
        match start.is_before(self.t) {
            Some(true) => found.push(self),
            Some(false) => {}
            None => {
                self.sure = false;
                found.push(self);
            }
        }
    }
}

/// Returns the axis of a normal that has one.
pub fn axis_of(normal: [i64; 3]) -> Option<usize> {
    let is = |k: usize| normal[k] != 0 && normal[(k + 1) % 3] == 0 && normal[(k + 2) % 3] == 0;
    (0..3).find(|&k| is(k))
}

pub fn flat_normal<N: Enclosure>(normal: [i64; 3]) -> Option<Three<N>> {
    match axis_of(normal) {
        Some(_) => Some(exact(normal.map(i64::signum))),
        None => unit(exact(normal)),
    }
}
