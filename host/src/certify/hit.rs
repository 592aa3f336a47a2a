//! Hits, and surfaces as they are shaded.

use super::crossing::Start;
use super::log2::Log2;
use super::media::{Crossed, Inside, Interface};
use super::number::*;
use super::path::Path;
use gridel_core::format::record::Material;

/// A hit: where, and the surface there.
#[derive(Clone, Copy, Debug)]
pub struct Hit<N> {
    pub t: N,
    pub point: Three<N>,
    /// Geometric, of length 1, as the primitive has it.
    pub normal: Three<N>,
    pub front: bool,
    pub object: u32,
    pub primitive: u32,
    pub instance: u32,
    pub solid: u32,
    /// The first primitive of the same form, from which a ray starts as well.
    pub twin: u32,
    pub part: u8,
    /// See [`Solid::surfaces`](super::world::Solid::surfaces).
    pub surface: u32,
    /// Planes that the point lies in exactly, too, at an edge.
    pub also: [u32; 2],
}

impl<N: Enclosure> Hit<N> {
    /// Returns the normal on the side from which the ray came.
    pub fn facing(&self) -> Three<N> {
        if self.front {
            self.normal
        } else {
            opposite(self.normal)
        }
    }

    /// Returns the face, for a ray that goes on beyond it.
    pub fn crossed(&self) -> Crossed {
        Crossed {
            object: self.object,
            enters: self.front,
        }
    }

    /// Returns the start of a ray that continues from here.
    pub fn start(&self, outward: bool) -> Start {
        Start::On {
            instance: self.instance,
            twin: self.twin,
            part: self.part,
            surface: self.surface,
            also: self.also,
            inward: !outward,
        }
    }
}

/// A surface as it is shaded.
pub struct Seen<'h, N> {
    /// The ray that met it.
    pub path: &'h Path<N>,
    pub hit: &'h Hit<N>,
    pub material: &'h Material,
    /// True if it is a boundary, and not within a medium of a higher priority.
    pub is_there: bool,
    pub normal: Three<N>,
    /// The direction of the ray, of length 1.
    pub direction: Three<N>,
    pub diffuse: Three<N>,
    /// The ratio of the light from here that arrives at the eye.
    pub weight: Three<N>,
    /// The ratio of the light from behind that passes straight on.
    pub passing: Three<N>,
    pub interface: Interface<N>,
    /// The media that a ray on the far side is inside of.
    pub beyond: Inside,
    /// The length of the rays that led here, if textures have levels.
    pub length: Option<Log2>,
}
