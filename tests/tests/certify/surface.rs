//! Rays that are followed, and the surfaces that they meet.

use super::media::{Inside, Interface};
use super::placed::Met;
use gridel_core::RayKind;
use gridel_core::format::record::Material;
use gridel_core::shade::sampler::Sampler;
use gridel_host::shape::exact::{Line, Vector};

/// The history of a ray.
#[derive(Clone, Copy)]
pub struct Trail {
    pub pixel: [u16; 2],
    /// Number of bounces that led to it.
    pub depth: u8,
    pub kind: RayKind,
    /// Number of diffuse ones among them.
    pub reflections: u8,
    pub inside: Inside,
    /// The logarithm of the length of the rays that led to it, where textures have levels.
    pub length: Option<i32>,
}

impl Trail {
    /// A random point of the unit square, with 32 fraction bits.
    pub fn point(&self, dimension: u16) -> [u32; 2] {
        let bounce = u16::from(self.depth) << 8 | self.kind as u16;
        Sampler::new(self.pixel, 0).point(bounce, dimension)
    }
}

pub struct Ray {
    pub line: Line,
    /// The ratio of its light that arrives at the eye.
    pub weight: Vector,
    pub trail: Trail,
}

pub struct Surface<'e> {
    pub met: Met<'e>,
    pub material: &'e Material,
    /// The two media that meet there, if it is glass.
    pub interface: Option<Interface>,
    /// The normal for shading, on the side of the ray.
    pub normal: Vector,
    /// The ray's direction, of length 1.
    pub direction: Vector,
    pub diffuse: Vector,
    pub trail: Trail,
    /// The media that a ray is inside of that continues behind the surface.
    pub beyond: Inside,
}

/// A ray that a surface sends on.
pub struct Leaving {
    pub kind: RayKind,
    /// The direction, whose length counts where it is turned into a triangle's plane.
    pub slope: Vector,
    /// True if it leaves on the side of the geometric normal.
    pub outward: bool,
    pub weight: Vector,
}
