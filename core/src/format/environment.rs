//! The record of the light around a scene.

use crate::format::layout::records;
use crate::format::range::{ONE, RADIANCE};
use crate::format::record::Light;
use bytemuck::{Pod, Zeroable};

records! {
    /// The light around a scene: an octahedral map, and a sun in it.
    ///
    /// The map is a square. A direction meets the octahedron |x| + |y| + |z| = 1 in a point; seen along z, its upper half
    /// is the middle of the square, with x to the right and y down, from -1 to 1. The four faces of the lower half are
    /// turned outwards about the edges that they share with the upper half: where z is below 0, (x, y) lies at (1 - |y|,
    /// 1 - |x|) with the signs of x and y.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(32)]
    pub struct Environment {
        /// The map has 2 to this power rows, and as many texels in a row.
        #[valid(EnvironmentSize: 4..=8)]
        pub size_bits: u32,
        /// The direction towards the middle of the sun: length 1, 30 fraction bits.
        #[valid(SunDirection: -ONE..=ONE)]
        pub sun_direction: [i32; 3],
        /// The length from the middle of the sun to its edge, on a sphere with radius 1, 30 fraction bits; 0 without a sun.
        #[valid(SunSize: 0..=ONE)]
        pub sun_radius: i32,
        /// The radiance of the sun where it is seen, which adds to that of the map, 20 fraction bits. As a light it has
        /// the color of its light. A brighter channel is 2^31 - 1; rough surfaces then reflect the sun as a light alone.
        #[valid(SunRadiance: 0..=RADIANCE)]
        pub sun_radiance: [i32; 3],
    }
}

impl Environment {
    /// The largest exponent of a texel.
    pub const MOST_EXPONENT: u32 = 22;

    /// The largest radiance of a texel, with 20 fraction bits.
    pub const BRIGHTEST: u32 = 511 << Self::MOST_EXPONENT;

    /// Returns true if the sun may be brighter than [`sun_radiance`](Self::sun_radiance) holds.
    ///
    /// ```
    /// use gridel_core::format::environment::Environment;
    ///
    /// let mut record: Environment = bytemuck::Zeroable::zeroed();
    /// assert!(!record.is_sun_limited());
    /// record.sun_radiance[1] = i32::MAX;
    /// assert!(record.is_sun_limited());
    /// ```
    pub const fn is_sun_limited(&self) -> bool {
        let [red, green, blue] = self.sun_radiance;
        red == i32::MAX || green == i32::MAX || blue == i32::MAX
    }
}

impl Light {
    /// The value of [`kind`](Self::kind) that marks the map of the environment as a light. Its color and
    /// vector are not used.
    pub const ENVIRONMENT: u32 = 4;
    /// The value of [`kind`](Self::kind) that marks the sun of the environment. Its vector is not used;
    /// its color is the sun's radiance times the square of the sun's radius.
    pub const SUN: u32 = 5;

    /// Returns true if the light is the map or the sun of the environment.
    pub const fn is_environment(&self) -> bool {
        matches!(self.kind, Self::ENVIRONMENT | Self::SUN)
    }
}
