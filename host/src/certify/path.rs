//! Rays on their way from the eye, and their history.

use super::crossing::Ray;
use super::log2::Log2;
use super::media::Inside;
use super::number::*;
use gridel_core::RayKind;
use gridel_core::shade::sampler::Sampler;

/// A ray of a sample.
#[derive(Clone, Copy, Debug)]
pub struct Path<N> {
    pub ray: Ray<N>,
    /// The part of its light that arrives at the eye.
    pub weight: Three<N>,
    /// Secondary rays that led to it, of which it is the last.
    pub depth: u8,
    pub kind: RayKind,
    /// The random points of its sample.
    pub points: Sampler,
    /// Diffuse reflections that led to it.
    pub reflections: u8,
    pub inside: Inside,
    /// The length of the rays before it, if textures have levels.
    pub length: Option<Log2>,
}

impl<N> Path<N> {
    /// Returns a random point of the unit square, with 32 fraction bits.
    pub fn point(&self, dimension: u16) -> [u32; 2] {
        let bounce = u16::from(self.depth) << 8 | self.kind as u16;
        self.points.point(bounce, dimension)
    }
}
