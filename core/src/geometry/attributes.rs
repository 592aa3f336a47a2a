//! Vertex attributes other than place and normal: colors and texture coordinates, interpolated over triangles.
//!
//! **Storage.** A color takes four bytes per vertex: alpha, and red, green and blue as square roots of linear light, of
//! which 255 is 1. So a step is at most one of a display, and decoding is one multiplication. Texture coordinates take
//! four bytes per vertex where all lie in -2 to 2 (14 fraction bits), else eight (20 fraction bits, -1024 to 1024). The
//! lowest u of all means none. Vertices behind the last that has a color are white, and those behind the last that has
//! coordinates have none. A triangle has a texture if its three vertices have coordinates.
//!
//! **Interpolation.** The weights of the corners are computed in the number format, as for [smooth
//! normals](crate::geometry::smooth). They become integers with 30 fraction bits. All later arithmetic is in integers,
//! which all formats share. At a corner the value is that of the vertex. On an edge it depends only on that edge,
//! except for the rounding of the weights.

use crate::format::{BlobError, SectionKind, Sections};
use crate::number::Arithmetic;

/// Fraction bits of texture coordinates in the arithmetic.
pub const COORDINATE_BITS: u32 = 20;

/// Returns the weights of the corners of a triangle at a point, and true if its front is turned away from `facing`.
/// `facing` is the geometric normal or its opposite. Weights are ratios whose sum is not 1, but at most 3/2 in
/// magnitude.
#[inline(always)]
pub(crate) fn weights<N: Arithmetic>(
    corners: [[i32; 3]; 3],
    point: [N; 3],
    facing: [N; 3],
) -> ([N; 3], bool) {
    let [x, y, z] = facing.map(N::abs);
    // Written out by axis, so that nothing is looked up.
    let (areas, across) = if x >= y && x >= z {
        (areas::<N, 1, 2>(corners, point), facing[0])
    } else if y >= z {
        (areas::<N, 2, 0>(corners, point), facing[1])
    } else {
        (areas::<N, 0, 1>(corners, point), facing[2])
    };
    let [u, v, w] = N::proportions(areas);
    // Areas are positive where the front points up that axis.
    ([u, v, w], (u + v + w < N::ZERO) != (across < N::ZERO))
}

/// Twice the areas into which a point cuts a triangle, as seen along an axis. The other two axes are given.
#[inline(always)]
fn areas<N: Arithmetic, const FIRST: usize, const SECOND: usize>(
    corners: [[i32; 3]; 3],
    point: [N; 3],
) -> [N::Wide; 3] {
    let seen = |corner: [i32; 3]| {
        [
            N::from_lattice(corner[FIRST]) - point[FIRST],
            N::from_lattice(corner[SECOND]) - point[SECOND],
        ]
    };
    let [a, b, c] = corners;
    let (a, b, c) = (seen(a), seen(b), seen(c));
    let area = |p: [N; 2], q: [N; 2]| p[0].wide(q[1]) - p[1].wide(q[0]);
    [area(b, c), area(c, a), area(a, b)]
}

/// The place of a point in a triangle. It holds the weights of the second and third corner with 30 fraction bits, which
/// are not negative and at most 1 together. The first corner has the rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Weights([i32; 2]);

impl Weights {
    /// The weights at a point of a triangle with this geometric normal, or its opposite.
    #[inline(always)]
    pub(crate) fn at<N: Arithmetic>(corners: [[i32; 3]; 3], point: [N; 3], normal: [N; 3]) -> Self {
        let ([u, v, w], _) = weights(corners, point, normal);
        let sum = u + v + w;
        // Only rounding makes it negative.
        let second = v.div(sum).max(N::ZERO).min(N::ONE);
        let third = w.div(sum).max(N::ZERO).min(N::ONE - second);
        Self([second.to_q30(), third.to_q30()])
    }

    /// The mean of the corners' values, with 30 more fraction bits.
    #[inline(always)]
    fn mean(self, [a, b, c]: [i32; 3]) -> i64 {
        let [second, third] = self.0;
        let first = (1_i32 << 30).wrapping_sub(second).wrapping_sub(third);
        let product = |value: i32, weight: i32| i64::from(value).wrapping_mul(weight.into());
        product(a, first)
            .wrapping_add(product(b, second))
            .wrapping_add(product(c, third))
    }

    /// The color at the point: linear ratios with 30 fraction bits.
    #[inline(always)]
    pub(crate) fn color(self, corners: [[u8; 4]; 3]) -> [i32; 3] {
        [0, 1, 2].map(|channel: usize| {
            let square = |corner: [u8; 4]| {
                let root = u32::from(corner[channel]);
                root.wrapping_mul(root).cast_signed()
            };
            linear((self.mean(corners.map(square)) >> 14) as u32)
        })
    }

    /// Texture coordinates at the point, with [`COORDINATE_BITS`] fraction bits.
    #[inline(always)]
    pub(crate) fn coordinates(self, corners: [[i32; 2]; 3]) -> [i32; 2] {
        [0, 1].map(|axis: usize| (self.mean(corners.map(|corner| corner[axis])) >> 30) as i32)
    }
}

/// Returns a ratio with 30 fraction bits from the square of a root of 8 bits, of which 255 means 1, with 16 fraction
/// bits.
#[inline(always)]
pub(crate) fn linear(square_q16: u32) -> i32 {
    // 2^62 / (255^2 2^16), rounded up, so that 255 is 1 exactly.
    const SCALE: u64 = (1_u64 << 62).div_ceil((255 * 255) << 16);
    (u64::from(square_q16).wrapping_mul(SCALE) >> 32) as i32
}

/// The texture coordinates of the first vertices.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Coordinates<'a> {
    Short(&'a [[i16; 2]]),
    Long(&'a [[i32; 2]]),
}

impl Default for Coordinates<'_> {
    fn default() -> Self {
        Self::Short(&[])
    }
}

impl<'a> Coordinates<'a> {
    pub(crate) fn read(sections: &Sections<'a>) -> Result<Self, BlobError> {
        let section = SectionKind::TextureCoordinates;
        Ok(if sections.get(section).stride == size_of::<[i32; 2]>() {
            Self::Long(sections.records(section)?)
        } else {
            Self::Short(sections.records(section)?)
        })
    }

    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Short(all) => all.len(),
            Self::Long(all) => all.len(),
        }
    }

    /// Returns the coordinates of three vertices with [`COORDINATE_BITS`] fraction bits; `None` if one has none.
    #[inline(always)]
    pub(crate) fn corners(&self, vertices: [usize; 3]) -> Option<[[i32; 2]; 3]> {
        let [a, b, c] = vertices;
        match self {
            Self::Short(all) => {
                let get = |vertex: usize| {
                    let found = all.get(vertex).filter(|it| it[0] != i16::MIN)?;
                    Some(found.map(|it| i32::from(it) << (COORDINATE_BITS - 14)))
                };
                Some([get(a)?, get(b)?, get(c)?])
            }
            Self::Long(all) => {
                let get = |vertex: usize| all.get(vertex).filter(|it| it[0] != i32::MIN).copied();
                Some([get(a)?, get(b)?, get(c)?])
            }
        }
    }
}

/// Returns an error unless a section has at most as many records as there are vertices.
pub(crate) fn at_most_vertices(
    section: SectionKind,
    found: usize,
    vertices: usize,
) -> Result<(), BlobError> {
    if found > vertices {
        return Err(BlobError::TooMany {
            section,
            found,
            most: vertices,
        });
    }
    Ok(())
}

#[cfg(test)]
mod tests;
