//! The record of a light's form. It describes lights that are not points which shine equally in all directions and at
//! all distances.

use crate::format::layout::records;
use crate::format::range::ONE;
use crate::format::record::Light;
use bytemuck::{Pod, Zeroable};

/// The longest length, with 13 fraction bits.
const LONGEST: i64 = 1 << 30;
/// The longest edge: two of them are a length.
const EDGE: i64 = 1 << 29;

records! {
    /// The form of a light at a position: what shines, where to, and how its light falls off.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(56)]
    pub struct LightForm {
        /// Its shape: 0 the position itself, 1 a sphere around it, 2 a rectangle with a corner there, 3 a disc around
        /// it, 4 a triangle with a corner there.
        #[valid(Kind: 0..=4)]
        pub shape: u32,
        /// The distance at which the light has its color, with 13 fraction bits: it falls off with the distance's
        /// square. 0 for light that does not fall off. For lights with an area, the color is the radiance times a
        /// factor, and this is the length whose square is the area over π (for a sphere: its radius), over the factor's
        /// root.
        #[valid(LightReference: 0..=LONGEST)]
        pub reference: i32,
        /// The distance at which light ends, with 13 fraction bits; 0 for none. A longer one is negative: its magnitude
        /// has 8 fraction bits.
        #[valid(LightRange: -LONGEST..=LONGEST)]
        pub range: i32,
        /// The cosine of the angle at which a spot ends, 30 fraction bits; -2^30 where there is none.
        #[valid(ConeCosine: -ONE..=ONE)]
        pub cone_cosine: i32,
        /// For spots: the cosine of the angle up to which they are fully bright, less `cone_cosine`, with 30 fraction
        /// bits. For flat lights: a length with 13 fraction bits. Points are drawn by solid angle where the magnitudes
        /// of the coordinates of the way to the position add up to less, and by area beyond.
        #[valid(LightWidth: 0..=ONE)]
        pub width: i32,
        /// The direction of a spot, or the side on which a rectangle, triangle or disc shines: length 1, 30 fraction bits.
        #[valid(Normal: -ONE..=ONE)]
        pub normal: [i32; 3],
        /// `[edge][axis]`: the edges of a rectangle (any parallelogram) or a triangle, or two perpendicular radii of a
        /// disc, lengths with 13 fraction bits. The first number is the radius of a sphere.
        #[valid(LightEdge: -EDGE..=EDGE)]
        pub edges: [[i32; 3]; 2],
    }
}

impl LightForm {
    /// Fraction bits by which a negative range has fewer than a length.
    pub const FAR_RANGE_BITS: u32 = 5;
    /// The shape of a sphere.
    pub const SPHERE: u32 = 1;
    /// The shape of a rectangle.
    pub const RECTANGLE: u32 = 2;
    /// The shape of a disc.
    pub const DISC: u32 = 3;
    /// The shape of a triangle.
    pub const TRIANGLE: u32 = 4;
}

impl Light {
    /// The value of [`kind`](Self::kind) for a directional light.
    pub const DIRECTIONAL: u32 = 1;

    /// The value for a point light with a form.
    const FORM: u32 = 2;
    /// The value for an area light.
    const AREA: u32 = 3;

    /// Returns the value of [`kind`](Self::kind) for a light whose form has a number below 2^30.
    pub const fn with_form(number: u32, is_area: bool) -> u32 {
        number << 2 | if is_area { Self::AREA } else { Self::FORM }
    }

    /// Returns the number of its form; `None` for a plain point light and for a directional one.
    pub const fn form(&self) -> Option<u32> {
        if self.kind & Self::FORM != 0 {
            Some(self.kind >> 2)
        } else {
            None
        }
    }

    /// Returns true if the light is at a position, with a form or without one.
    pub const fn has_position(&self) -> bool {
        self.kind == 0 || self.form().is_some()
    }

    /// Returns true if the light shines from a point.
    pub const fn is_point(&self) -> bool {
        self.kind == 0 || self.kind & Self::AREA == Self::FORM
    }

    /// Returns true if the light is an area and not a point.
    pub const fn is_area(&self) -> bool {
        self.kind & Self::AREA == Self::AREA
    }
}
