//! Camera, lights and materials.

use crate::format::layout::records;
use crate::format::limits::{FARTHEST, MAX_RAY_DEPTH, MAX_SAMPLES};
use crate::format::range::{ONE, RADIANCE};
use bytemuck::{Pod, Zeroable};

impl View {
    /// The [encoding](Self::encoding) of display values.
    pub const DISPLAY_VALUES: u8 = 1;
    /// The [encoding](Self::encoding) of tones that the curve of Reinhard maps.
    pub const REINHARD: u8 = 2;
    /// The [encoding](Self::encoding) of tones that a curve like that of ACES maps.
    pub const ACES: u8 = 3;
}

records! {
    /// Camera, surroundings and rendering defaults.
    ///
    /// The direction to the point that is *a* half heights to the right of the picture's middle and *b* above it is
    /// `forward` + *a* `right` + *b* `up`. The three vectors have one scale, which has no other meaning. A renderer may
    /// override width, height, samples and depth.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C, packed(4))]
    #[bytes(96)]
    pub struct View {
        /// The eye, in units with 13 fraction bits.
        #[valid(Eye: -FARTHEST..=FARTHEST)]
        pub eye: [i64; 3],
        /// From the eye to the middle of the picture.
        #[valid(CameraVector: -(1 << 28)..=1 << 28)]
        pub forward: [i32; 3],
        /// From the middle of the picture to its right, by half the picture's *height*.
        #[valid(CameraVector: -(1 << 28)..=1 << 28)]
        pub right: [i32; 3],
        /// From the middle of the picture to its upper edge.
        #[valid(CameraVector: -(1 << 28)..=1 << 28)]
        pub up: [i32; 3],
        /// Radiance of rays that meet nothing, 20 fraction bits.
        #[valid(Background: 0..=RADIANCE)]
        pub background: [i32; 3],
        /// Radiance that reaches every surface, 20 fraction bits.
        #[valid(AmbientLight: 0..=RADIANCE)]
        pub ambient: [i32; 3],
        /// A secondary ray that can add no more than this to any channel is not traced: 20 fraction bits.
        #[valid(Cutoff: 0..=RADIANCE)]
        pub cutoff: i32,
        /// Default width of the picture in pixels.
        #[valid(Width: 1..=u16::MAX as i64)]
        pub width: u16,
        /// Default height of the picture in pixels.
        #[valid(Height: 1..=u16::MAX as i64)]
        pub height: u16,
        /// Default number of samples per pixel.
        #[valid(Samples: 1..=MAX_SAMPLES as i64)]
        pub samples: u16,
        /// Maximum number of secondary rays that follow each other: off mirrors, through glass or alpha, diffuse.
        #[valid(RayDepth: 0..=MAX_RAY_DEPTH as i64)]
        pub depth: u8,
        /// 1 where all colors and lights are display values, which are added up and shown as they are. Else they are
        /// linear and the picture is encoded in sRGB: 0 as it is, 2 and 3 after its tones were mapped, by the curve of
        /// Reinhard or one like that of ACES.
        #[valid(Encoding: 0..=3)]
        pub encoding: u8,
    }

    /// The light that a material sends out.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(16)]
    pub struct Emission {
        /// Its radiance, 20 fraction bits.
        #[valid(Emission: 0..=RADIANCE)]
        pub radiance: [i32; 3],
        /// 1 if the scene has lights of the same places, areas and radiance, so that diffuse rays must not bring it again;
        /// else 0.
        #[valid(EmissionLights: 0..=1)]
        pub lights: u32,
    }

    /// A light.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C, packed(4))]
    #[bytes(40)]
    pub struct Light {
        /// A point light's position in units with 13 fraction bits (at most 2^50 in magnitude), or the
        /// unit vector towards a directional light with 30 fraction bits (at most 2^30 in magnitude, not all 0).
        pub vector: [i64; 3],
        /// Radiance, 20 fraction bits.
        #[valid(Color: 0..=RADIANCE)]
        pub color: [i32; 3],
        /// 0 for a point light, 1 for a directional one. Else a light at a position with a
        /// [form](crate::format::light_form::LightForm): its number times 4, and 2 for a point or 3 for an area. 4 and 5 are
        /// the map and the sun of the [environment](crate::format::environment::Environment).
        pub kind: u32,
    }

    /// A surface. Colors are ratios with 30 fraction bits, 0 to 1.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(96)]
    pub struct Material {
        /// Diffuse reflectance; of the even cells where there is a checkerboard.
        #[valid(Diffuse: 0..=ONE)]
        pub diffuse: [i32; 3],
        /// Diffuse reflectance of the odd cells.
        #[valid(Odd: 0..=ONE)]
        pub odd: [i32; 3],
        // The pattern repeats after two cells, which are a length, too.
        /// Edge of a checkerboard's cells, a length with 13 fraction bits; 0 without one.
        #[valid(CheckerSize: 0..=ONE - 1)]
        pub checker_size: i32,
        /// A corner of the checkerboard's cells, lengths with 13 fraction bits.
        #[valid(CheckerOrigin: -ONE..=ONE)]
        pub checker_origin: [i32; 3],
        /// Reflectance of the lights' highlights.
        #[valid(Highlight: 0..=ONE)]
        pub highlight: [i32; 3],
        /// Weight of the mirrored ray.
        #[valid(Mirror: 0..=ONE)]
        pub mirror: [i32; 3],
        /// Weight of the light that comes through glass.
        #[valid(Transmittance: 0..=ONE)]
        pub transmit: [i32; 3],
        /// One over the index of refraction, 30 fraction bits: 0.25 to 1.
        #[valid(InverseIor: ONE / 4..=ONE)]
        pub inverse_ior: i32,
        /// Absorption inside, in 1/unit with 32 fraction bits, over 2 to the power of the shift.
        pub absorption: [u32; 3],
        /// The lower 12 bits are the exponent of the highlight, 1 to 1024, and the upper 4 the shift of the absorption.
        pub shininess: u16,
        /// Its maps: the lower 12 bits are the number of its [`SurfaceMaps`](crate::format::record::SurfaceMaps), and
        /// bit 12 is set where these have a texture, bit 13 where its alpha is used, bit 14 where there is a normal
        /// map, and bit 15 where one of both has levels. 0 for none.
        pub maps: u16,
    }
}
