//! Smooth normals: those of a triangle's vertices, interpolated.
//!
//! **Storage.** A normal is a point of the octahedron `|x| + |y| + |z| = 32767`, whose lower half is folded
//! over the upper one, so that two numbers of 16 bits say all (Cigolle, Donow, Evangelakos, Mara, McGuire, Meyer, "A
//! Survey of Efficient Representations for Independent Unit Vectors", JCGT 2014): four bytes per vertex, at most
//! 8e-5 radians off. Vertices with a normal come first; a triangle is smooth if its three vertices have one.
//!
//! **Interpolation.** The normals, of length 1, are weighted by the areas that the point cuts the triangle into, as seen
//! along the largest component of the geometric normal.
//!
//! **Light behind the triangle.** Near the terminator a triangle can face away from a light that its smooth normal
//! faces, and would be black. [`SmoothTriangle::lift`] moves the start of the shadow ray out to the curved surface for
//! which the triangle stands (Hanika, "Hacking the Shadow Terminator", *Ray Tracing Gems II*, 2021): the point is
//! projected onto the tangent plane of each vertex, and the projections are interpolated.

use crate::axis::pick;
use crate::format::range::At;
use crate::format::{BlobError, Field, SectionKind};
use crate::number::{Arithmetic, extent};

/// The largest coordinate of a stored normal; the sum of the magnitudes of all three.
pub const LARGEST: i16 = i16::MAX;

/// The stored form of a direction, which need not have length 1; the nearest one, but for rounding. Zero becomes some
/// direction.
///
/// ```
/// use gridel_core::geometry::smooth::{LARGEST, encode};
///
/// assert_eq!(encode([0.0, 0.0, 2.0]), [0, 0]);
/// assert_eq!(encode([1.0, 0.0, 0.0]), [LARGEST, 0]);
/// assert_eq!(encode([0.0, 0.0, -1.0]), [LARGEST, LARGEST]);
/// ```
pub fn encode([x, y, z]: [f64; 3]) -> [i16; 2] {
    let sum = x.abs() + y.abs() + z.abs();
    // NaN, infinities and zero as well.
    if !(sum > 0.0 && sum < f64::INFINITY) {
        return [0; 2];
    }
    let [x, y, z] = [x / sum, y / sum, z / sum];
    let sign = |x: f64| if x < 0.0 { -1.0 } else { 1.0 };
    let [x, y] = if z < 0.0 {
        [(1.0 - y.abs()) * sign(x), (1.0 - x.abs()) * sign(y)]
    } else {
        [x, y]
    };
    [x, y].map(|x| libm::round(x * f64::from(LARGEST)) as i16)
}

/// The direction that a stored normal stands for, on the octahedron.
#[inline(always)]
fn unfold([x, y]: [i16; 2]) -> [i16; 3] {
    let (x, y) = (i32::from(x), i32::from(y));
    let largest = i32::from(LARGEST);
    let (across, up) = (x.abs(), y.abs());
    let z = largest.wrapping_sub(across).wrapping_sub(up);
    let (x, y) = if z < 0 {
        let with_sign = |rest: i32, of: i32| if of < 0 { rest.wrapping_neg() } else { rest };
        (
            with_sign(largest.wrapping_sub(up), x),
            with_sign(largest.wrapping_sub(across), y),
        )
    } else {
        (x, y)
    };
    [x as i16, y as i16, z as i16]
}

/// The normal of length 1 that a stored one stands for.
#[inline(always)]
pub(crate) fn decode<N: Arithmetic>(stored: [i16; 2]) -> [N; 3] {
    N::normalize(unfold(stored).map(N::from_unit)).0
}

/// Proves that normals are those of vertices, and that their coordinates are in range.
pub(crate) fn validate(normals: &[[i16; 2]], vertices: usize) -> Result<(), BlobError> {
    let section = SectionKind::Normals;
    if normals.len() > vertices {
        return Err(BlobError::Count {
            section,
            found: normals.len(),
            expected: vertices,
        });
    }
    let most = i64::from(LARGEST);
    normals.iter().enumerate().try_for_each(|(index, normal)| {
        At { section, index }.all_within(Field::Normal, &normal.map(i64::from), -most, most)
    })
}

/// A triangle whose vertices have normals: corners in 1/256 unit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SmoothTriangle {
    pub(crate) corners: [[i32; 3]; 3],
    pub(crate) normals: [[i16; 2]; 3],
}

impl SmoothTriangle {
    /// The weights of the corners at a point of the triangle: ratios whose sum is not 1, but at most 3/2. They are
    /// negative on the side away from `facing`, which is the geometric normal or its opposite.
    #[inline(always)]
    fn weights<N: Arithmetic>(&self, point: [N; 3], facing: [N; 3]) -> [N; 3] {
        let [x, y, z] = facing.map(N::abs);
        let axis = if x >= y && x >= z {
            0
        } else if y >= z {
            1
        } else {
            2
        };
        let (first, second) = match axis {
            0 => (1, 2),
            1 => (2, 0),
            _ => (0, 1),
        };
        // So that areas are positive as seen from where `facing` points.
        let (first, second) = if pick(facing, axis) < N::ZERO {
            (second, first)
        } else {
            (first, second)
        };
        let [across, up] = [pick(point, first), pick(point, second)];
        let seen = |corner: [i32; 3]| {
            [
                N::from_lattice(pick(corner, first)) - across,
                N::from_lattice(pick(corner, second)) - up,
            ]
        };
        let [a, b, c] = self.corners;
        let (a, b, c) = (seen(a), seen(b), seen(c));
        let area = |p: [N; 2], q: [N; 2]| p[0].wide(q[1]) - p[1].wide(q[0]);
        N::proportions([area(b, c), area(c, a), area(a, b)])
    }

    /// The interpolated normal of length 1 at a point of the triangle, on the side of `facing`, which is the geometric
    /// normal or its opposite. `None` where the normals of the corners cancel out.
    #[inline(always)]
    pub(crate) fn normal<N: Arithmetic>(&self, point: [N; 3], facing: [N; 3]) -> Option<[N; 3]> {
        let [u, v, w] = self.weights(point, facing);
        let [a, b, c] = self.normals;
        let (a, b, c) = (decode::<N>(a), decode::<N>(b), decode::<N>(c));
        let component = |k: usize| u * a[k] + v * b[k] + w * c[k];
        let (normal, length) = N::normalize([component(0), component(1), component(2)]);
        (length > N::ZERO).then_some(normal)
    }

    /// The way from a point of the triangle out to the curved surface, on the side of `facing`; zero where that
    /// surface lies on the other side.
    #[cold]
    #[inline(never)]
    pub(crate) fn lift<N: Arithmetic>(&self, point: [N; 3], facing: [N; 3]) -> [N; 3] {
        let weights = self.weights(point, facing);
        let sum = weights[0] + weights[1] + weights[2];
        let mut way = [N::ZERO; 3];
        for ((corner, normal), weight) in self.corners.iter().zip(self.normals).zip(weights) {
            // The same weights, and of the side that faces: negative ones by rounding alone.
            let weight = weight.div(sum).max(N::ZERO).min(N::ONE);
            let mut normal = decode::<N>(normal);
            if sum < N::ZERO {
                normal = normal.map(|x| -x);
            }
            let below = |k: usize| N::from_lattice(corner[k]) - point[k];
            let depth = N::from_wide(N::dot([below(0), below(1), below(2)], normal));
            let depth = depth.max(N::ZERO) * weight;
            for (way, normal) in way.iter_mut().zip(normal) {
                *way = *way + depth * normal;
            }
        }
        way
    }
}

/// A place moved along a way, but no farther from the lattice's middle than rays can start.
#[inline(always)]
pub(crate) fn moved<N: Arithmetic>(place: [N; 3], way: [N; 3]) -> [N; 3] {
    let most = N::from_unit(i16::MAX) + N::from_unit(i16::MAX);
    let axis = |k: usize| (place[k] + way[k]).max(-most).min(most);
    let moved = [axis(0), axis(1), axis(2)];
    debug_assert!(extent(moved) <= most);
    moved
}

#[cfg(test)]
mod tests;
