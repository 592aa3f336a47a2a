//! Clusters: strips of triangles and packs of spheres, in rows of eight lanes.
//!
//! A cluster holds its geometry itself, so that a leaf of the eight-wide structure is one record. A vertex that several
//! triangles share is stored, converted and projected once, and no index is needed. Where
//! [`Structure::Wide`](crate::Structure::Wide) is a blob's only structure, only clusters hold its triangles and
//! spheres.
//!
//! **Members.** The triangles of all strips, and then the spheres of all packs, are counted from 0 in stored order. The
//! section of that name has the primitive of each. All packs but the last are full, so the sphere in lane `l` of pack
//! `p` is number `8 p + l`.
//!
//! **Radii.** Few scenes have more than a handful of radii. So a pack on the 24-bit lattice has four bits for each
//! sphere. They are the radius's number in a window of [`RADII`], among those of the section of that name. Where the
//! section is one window, all packs share it; else the window of pack `p` begins at `8 p`.

use crate::format::layout::records;
use crate::format::record::{Vertex16, Vertex24};
use crate::format::width::Vertex;
use crate::simd::Simd;
use bytemuck::{Pod, Zeroable};
use core::array;

/// Lanes of a row: vertices of a strip, spheres of a pack, children of a node.
pub const LANES: usize = 8;
/// Radii of a window.
pub const RADII: usize = 2 * LANES;
/// Maximum number of triangles of a strip.
pub const STRIP_TRIANGLES: usize = LANES - 2;

records! {
    /// Eight points on the 16-bit lattice.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(transparent)]
    #[bytes(48)]
    pub struct Rows16(
        /// `[axis][lane]`, in units.
        pub [[i16; LANES]; 3]
    );

    /// Eight points on the 24-bit lattice.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(72)]
    pub struct Rows24 {
        /// `[axis][lane]`: the low 16 bits of a coordinate in 1/256 unit.
        pub low: [[u16; LANES]; 3],
        /// `[axis][lane mod 4]`: its high 8 bits, with the sign; for lane 0 to 3 in the low half of a
        /// word, for lane 4 to 7 in the high half, which four lanes take apart at once.
        pub high: [[u16; LANES / 2]; 3],
    }

    /// The primitives of a strip, and the vertices at their corners.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(6)]
    pub struct StripMembers {
        /// The number of the first triangle among the members: the number of triangles in all strips before.
        first: [u8; 3],
        /// The triangles and the order of their corners, in the bits of a word of three bytes.
        corners: [u8; 3],
    }

    /// A generalized strip on the 16-bit lattice: up to 6 triangles on 8 vertices, triangle *k* on the
    /// vertices *k*, *k* + 1 and *k* + 2.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(54)]
    pub struct Strip16 {
        /// The vertices; lanes that no triangle needs repeat one.
        pub rows: Rows16,
        /// The triangles that the strip holds, and their corners.
        pub members: StripMembers,
    }

    /// A generalized strip on the 24-bit lattice; see [`Strip16`].
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(78)]
    pub struct Strip24 {
        /// The vertices; lanes that no triangle needs repeat one.
        pub rows: Rows24,
        /// The triangles that the strip holds, and their corners.
        pub members: StripMembers,
    }

    /// A pack of up to 8 spheres on the 16-bit lattice.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(64)]
    pub struct Pack16 {
        /// The centers.
        pub rows: Rows16,
        /// The radii in units, at most 65534; 0 in the lanes behind the last sphere.
        pub radii: [u16; LANES],
    }

    /// A pack of up to 8 spheres on the 24-bit lattice.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(76)]
    pub struct Pack24 {
        /// The centers.
        pub rows: Rows24,
        /// For each lane the number of its radius in the pack's window: of lane 0 in the low half of the
        /// first byte, of lane 1 in its high half. The radius is 0 in the lanes behind the last sphere.
        pub radii: [u8; LANES / 2],
    }
}

/// A pack on the 24-bit lattice with its window of radii.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Windowed24<'a> {
    pub(crate) pack: &'a Pack24,
    /// In 1/256 unit.
    pub(crate) radii: &'a [i32; RADII],
}

impl StripMembers {
    /// The six ways in which the corners of a triangle, in scene-file order, map to the three vertices of its place.
    pub const ARRANGEMENTS: [[usize; 3]; 6] = [
        [0, 1, 2],
        [1, 2, 0],
        [2, 0, 1],
        [0, 2, 1],
        [2, 1, 0],
        [1, 0, 2],
    ];

    /// Creates members from number `first` on. `arrangements` is, for each place, the number of one of the
    /// [`ARRANGEMENTS`](Self::ARRANGEMENTS), or `None` where there is no triangle.
    pub fn new(first: u32, arrangements: [Option<u32>; STRIP_TRIANGLES]) -> Self {
        let word = (0..).zip(arrangements).fold(0, |word, (place, number)| {
            number.map_or(word, |number| {
                word | number << (3 * place) | 1 << (18 + place)
            })
        });
        Self {
            first: to_24(first),
            corners: to_24(word),
        }
    }

    /// Returns the number of the first triangle among the members.
    #[inline(always)]
    pub fn first(&self) -> u32 {
        from_24(self.first)
    }

    /// One bit for each place with a triangle.
    #[inline(always)]
    pub fn lanes(&self) -> u32 {
        from_24(self.corners) >> 18
    }

    /// Number of triangles.
    #[inline(always)]
    pub fn count(&self) -> u32 {
        self.lanes().count_ones()
    }

    /// Returns the vertices of a place's triangle in the order of its corners; `None` if the number of the arrangement
    /// is invalid.
    #[inline(always)]
    pub(crate) fn corners(&self, place: u32) -> Option<[usize; 3]> {
        let number = from_24(self.corners) >> ((3 * place) & 31) & 7;
        let arrangement = Self::ARRANGEMENTS.get(number as usize)?;
        let [a, b, c] = *arrangement;
        let first = place as usize;
        Some([a + first, b + first, c + first])
    }

    /// The number of a place's triangle among the members.
    #[inline(always)]
    pub(crate) fn member(&self, place: u32) -> u32 {
        let before = self.lanes() & !(u32::MAX << (place & 31));
        self.first() + before.count_ones()
    }
}

#[inline(always)]
fn from_24([low, middle, high]: [u8; 3]) -> u32 {
    u32::from_le_bytes([low, middle, high, 0])
}

fn to_24(value: u32) -> [u8; 3] {
    let [low, middle, high, _] = value.to_le_bytes();
    [low, middle, high]
}

/// Eight points in either storage.
pub(crate) trait Rows: Pod {
    /// One point.
    type Vertex: Vertex;
    /// One coordinate of every point in the steps of [`Vertex`]; exact.
    fn measure<S: Simd>(&self, simd: S, axis: usize) -> S::F32x8;
    /// One coordinate of every point in units; exact.
    fn units<S: Simd>(&self, simd: S, axis: usize) -> S::F32x8;
    /// The point in a lane.
    fn vertex(&self, lane: usize) -> Self::Vertex;
    /// The point in a lane, in 1/256 unit.
    fn position(&self, lane: usize) -> [i32; 3];
}

impl Rows for Rows16 {
    type Vertex = Vertex16;

    #[inline(always)]
    fn measure<S: Simd>(&self, simd: S, axis: usize) -> S::F32x8 {
        simd.of_i16(row(&self.0, axis))
    }

    #[inline(always)]
    fn units<S: Simd>(&self, simd: S, axis: usize) -> S::F32x8 {
        self.measure(simd, axis)
    }

    #[inline(always)]
    fn vertex(&self, lane: usize) -> Vertex16 {
        let [x, y, z] = &self.0;
        Vertex16([x[lane & 7], y[lane & 7], z[lane & 7]])
    }

    #[inline(always)]
    fn position(&self, lane: usize) -> [i32; 3] {
        self.vertex(lane).position()
    }
}

impl Rows for Rows24 {
    type Vertex = Vertex24;

    #[inline(always)]
    fn measure<S: Simd>(&self, simd: S, axis: usize) -> S::F32x8 {
        simd.of_i24(row(&self.low, axis), row(&self.high, axis))
    }

    #[inline(always)]
    fn units<S: Simd>(&self, simd: S, axis: usize) -> S::F32x8 {
        self.measure(simd, axis) * simd.splat(1.0 / 256.0)
    }

    #[inline(always)]
    fn vertex(&self, lane: usize) -> Vertex24 {
        Vertex24(self.position(lane))
    }

    #[inline(always)]
    fn position(&self, lane: usize) -> [i32; 3] {
        let axis = |axis: usize| {
            let high = high_byte(&self.high[axis], lane) as i8;
            i32::from(self.low[axis][lane & 7]) | i32::from(high) << 16
        };
        [axis(0), axis(1), axis(2)]
    }
}

/// Returns a row by number, which is below 3. It computes an address, without a branch that would be mispredicted.
#[inline(always)]
fn row<T, const N: usize>(rows: &[[T; N]; 3], axis: usize) -> &[T; N] {
    rows.get(axis).unwrap_or(&rows[0])
}

/// The high byte of a lane.
#[inline(always)]
fn high_byte(words: &[u16; LANES / 2], lane: usize) -> u8 {
    let place = (lane & 3) << 1 | lane >> 2 & 1;
    let bytes = bytemuck::bytes_of(words);
    bytes.get(place).copied().unwrap_or_default()
}

/// High bytes as words.
pub const fn high_bytes(bytes: [u8; LANES]) -> [u16; LANES / 2] {
    let [a, b, c, d, e, f, g, h] = bytes;
    [
        u16::from_le_bytes([a, e]),
        u16::from_le_bytes([b, f]),
        u16::from_le_bytes([c, g]),
        u16::from_le_bytes([d, h]),
    ]
}

/// A strip in either storage.
pub(crate) trait Strip: Pod {
    /// Its vertices' storage.
    type Rows: Rows;
    fn rows(&self) -> &Self::Rows;
    fn members(&self) -> &StripMembers;

    /// The corners of a place's triangle.
    #[inline(always)]
    fn vertices(&self, place: u32) -> Option<[<Self::Rows as Rows>::Vertex; 3]> {
        let [a, b, c] = self.members().corners(place)?;
        let rows = self.rows();
        Some([rows.vertex(a), rows.vertex(b), rows.vertex(c)])
    }

    /// The corners of a place's triangle, in 1/256 unit.
    #[inline(always)]
    fn triangle(&self, place: u32) -> Option<[[i32; 3]; 3]> {
        // Written out, because the compiler may call `array::map` and pass the corners through memory.
        let [a, b, c] = self.members().corners(place)?;
        let rows = self.rows();
        Some([rows.position(a), rows.position(b), rows.position(c)])
    }
}

/// A pack in either storage.
pub(crate) trait Pack {
    /// Its centers' storage.
    type Rows: Rows;
    fn rows(&self) -> &Self::Rows;
    /// All radii in units; exact.
    fn radii<S: Simd>(&self, simd: S) -> S::F32x8;
    /// The radius in a lane, in 1/256 unit.
    fn radius(&self, lane: usize) -> i32;

    /// Center and radius of a sphere, in 1/256 unit; `None` in an empty lane.
    #[inline(always)]
    fn sphere(&self, lane: u32) -> Option<([i32; 3], i32)> {
        let radius = self.radius(lane as usize);
        (radius > 0).then(|| (self.rows().position(lane as usize), radius))
    }

    /// One bit for each lane that holds a sphere.
    fn lanes(&self) -> u32 {
        let holds = |lane: &usize| self.radius(*lane) > 0;
        (0..LANES)
            .filter(holds)
            .fold(0, |lanes, lane| lanes | 1 << lane)
    }
}

macro_rules! strip {
    ($strip:ident, $rows:ident) => {
        impl Strip for $strip {
            type Rows = $rows;

            #[inline(always)]
            fn rows(&self) -> &$rows {
                &self.rows
            }

            #[inline(always)]
            fn members(&self) -> &StripMembers {
                &self.members
            }
        }
    };
}

strip!(Strip16, Rows16);
strip!(Strip24, Rows24);

impl Pack for Pack16 {
    type Rows = Rows16;

    #[inline(always)]
    fn rows(&self) -> &Rows16 {
        &self.rows
    }

    #[inline(always)]
    fn radii<S: Simd>(&self, simd: S) -> S::F32x8 {
        simd.of_u16(&self.radii)
    }

    #[inline(always)]
    fn radius(&self, lane: usize) -> i32 {
        i32::from(self.radii[lane & 7]) << 8
    }
}

impl Pack for Windowed24<'_> {
    type Rows = Rows24;

    #[inline(always)]
    fn rows(&self) -> &Rows24 {
        &self.pack.rows
    }

    #[inline(always)]
    fn radii<S: Simd>(&self, simd: S) -> S::F32x8 {
        let radii = array::from_fn(|lane| self.radius(lane));
        simd.of_i32(&radii) * simd.splat(1.0 / 256.0)
    }

    #[inline(always)]
    fn radius(&self, lane: usize) -> i32 {
        let numbers = u32::from_le_bytes(self.pack.radii);
        self.radii[(numbers >> (4 * (lane & 7)) & 15) as usize]
    }
}
