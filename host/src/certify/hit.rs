//! Hits, and surfaces as they are shaded.

use super::crossing::Start;
use super::number::*;
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
    pub plane: u32,
    /// Planes of other surfaces that the point lies in exactly, at an edge.
    pub also: [u32; 2],
}

impl<N: Enclosure> Hit<N> {
    /// The normal on the side from which the ray came.
    pub fn facing(&self) -> Three<N> {
        if self.front {
            self.normal
        } else {
            opposite(self.normal)
        }
    }

    /// What a ray starts on that goes on from here.
    pub fn start(&self, outward: bool) -> Start {
        Start::On {
            instance: self.instance,
            twin: self.twin,
            part: self.part,
            plane: self.plane,
            also: self.also,
            inward: !outward,
        }
    }
}

/// A surface as it is shaded.
pub struct Seen<'h, N> {
    pub hit: &'h Hit<N>,
    pub material: &'h Material,
    pub normal: Three<N>,
    pub direction: Three<N>,
    pub diffuse: Three<N>,
    pub depth: u8,
}

/// A radiance with 20 fraction bits.
pub fn radiance_of<N: Enclosure>(q20: i32) -> N {
    N::scaled(q20.into(), 20)
}

/// A ratio with 30 fraction bits.
pub fn ratio_of<N: Enclosure>(q30: i32) -> N {
    N::scaled(q30.into(), 30)
}
