//! Records in two widths with one interface, so that a kernel is generic over the width.

use crate::axis::pick;
use crate::format::record::{Sphere16, Sphere24, Vertex16, Vertex24};
use bytemuck::Pod;

/// A vertex in either storage.
pub trait Vertex: Pod {
    /// A coordinate in 1/256 unit.
    fn lattice(&self, axis: usize) -> i32;
    /// A unit has 2 to the power of this many steps.
    const STEP_BITS: u32;
    /// A coordinate in steps.
    fn steps(&self, axis: usize) -> i32;
    /// The vertex at coordinates in steps, which its storage can hold.
    fn from_steps(steps: [i32; 3]) -> Self;
    /// All three coordinates in 1/256 unit.
    #[inline(always)]
    fn position(&self) -> [i32; 3] {
        [self.lattice(0), self.lattice(1), self.lattice(2)]
    }
}

impl Vertex for Vertex16 {
    const STEP_BITS: u32 = 0;

    #[inline(always)]
    fn lattice(&self, axis: usize) -> i32 {
        (self.0[axis] as i32) << 8
    }

    #[inline(always)]
    fn steps(&self, axis: usize) -> i32 {
        pick(self.0, axis) as i32
    }

    fn from_steps(steps: [i32; 3]) -> Self {
        Self(steps.map(|step| step as i16))
    }
}

impl Vertex for Vertex24 {
    const STEP_BITS: u32 = 8;

    #[inline(always)]
    fn lattice(&self, axis: usize) -> i32 {
        pick(self.0, axis)
    }

    #[inline(always)]
    fn steps(&self, axis: usize) -> i32 {
        self.lattice(axis)
    }

    fn from_steps(steps: [i32; 3]) -> Self {
        Self(steps)
    }
}

/// A sphere in either storage.
pub trait Sphere: Pod {
    /// Center and radius in 1/256 unit.
    fn lattice(&self) -> ([i32; 3], i32);
}

impl Sphere for Sphere16 {
    #[inline(always)]
    fn lattice(&self) -> ([i32; 3], i32) {
        (self.center.position(), (self.radius as i32) << 8)
    }
}

impl Sphere for Sphere24 {
    #[inline(always)]
    fn lattice(&self) -> ([i32; 3], i32) {
        let center = self.center.map(|[low, middle, high]| {
            i32::from(low) | i32::from(middle) << 8 | i32::from(high as i8) << 16
        });
        let [low, middle, high] = self.radius.map(i32::from);
        (center, low | middle << 8 | high << 16)
    }
}

/// Vertex indices of a triangle in either width.
pub trait Corners: Pod {
    /// The three indices.
    fn corners(&self) -> [usize; 3];
}

impl Corners for [u16; 3] {
    #[inline(always)]
    fn corners(&self) -> [usize; 3] {
        [self[0] as usize, self[1] as usize, self[2] as usize]
    }
}

impl Corners for [u32; 3] {
    #[inline(always)]
    fn corners(&self) -> [usize; 3] {
        [self[0] as usize, self[1] as usize, self[2] as usize]
    }
}
