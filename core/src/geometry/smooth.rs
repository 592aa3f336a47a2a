//! Smooth normals: those of a triangle's vertices, interpolated.
//!
//! **Storage.** A normal is a point of the octahedron `|x| + |y| + |z| = 32767`, whose lower half is folded over the
//! upper one. So two numbers of 16 bits are enough: four bytes per vertex, at most 8e-5 radians off. (Cigolle, Donow,
//! Evangelakos, Mara, McGuire, Meyer, "A Survey of Efficient Representations for Independent Unit Vectors", JCGT 2014.)
//! Vertices with a normal come first; a triangle is smooth if its three vertices have one.
//!
//! **Interpolation.** The normals, of length 1, are weighted by the areas into which the point cuts the triangle. The
//! areas are seen along the largest component of the geometric normal. Cores without a root instruction need a hundred
//! others for a root. So inverse roots are those of a line and Newton's steps. Those of corners are within 0.5 %, which
//! turns the normal by at most 1/800 of the angle between the corners' normals. That of the sum is within the rounding
//! of the format.
//!
//! **Light behind the triangle.** Near the terminator a triangle can face away from a light that its smooth normal
//! faces, and would be black. `SmoothTriangle::lift` moves the start of the shadow ray out to the curved surface that
//! the triangle approximates. The point is projected onto the tangent plane of each vertex, and the projections are
//! interpolated. (Hanika, "Hacking the Shadow Terminator", *Ray Tracing Gems II*, 2021.)

use crate::format::range::At;
use crate::format::{BlobError, Field, SectionKind};
use crate::geometry::attributes::{at_most_vertices, weights};
use crate::number::{Arithmetic, Format, extent};

/// The largest coordinate of a stored normal; the sum of the magnitudes of all three.
pub const LARGEST: i16 = i16::MAX;

/// Returns the stored form of a direction of any length; the nearest one, except for rounding. Zero becomes some
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

/// The direction of a stored normal, on the octahedron.
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

/// Returns a stored normal after a change on its octahedron, halves with 24 fraction bits. It stays where the change
/// leaves no direction.
pub(crate) fn changed(stored: [i16; 2], change: [i64; 3]) -> [i16; 2] {
    let mut halves = change.into_iter();
    let sum = unfold(stored).map(|x| {
        let half = halves.next().unwrap_or_default();
        // At most 2^40.
        let change = half.saturating_add(1 << 22) >> 23;
        change.wrapping_add(x.into())
    });
    let all = sum.iter().fold(0, |all, x| all | x.unsigned_abs());
    // Magnitudes of 16 bits, whose products with the largest have 31.
    let down = 48_u32.saturating_sub(all.leading_zeros());
    let [across, up, along] = sum.map(|x| (x.unsigned_abs() >> down) as u32);
    let [x, y, z] = sum;
    let length = across.wrapping_add(up).wrapping_add(along);
    let largest = u32::from(LARGEST.unsigned_abs());
    let part = |x: u32| {
        let rounded = x.wrapping_mul(largest).wrapping_add(length / 2);
        rounded.checked_div(length).map(|it| it as i16)
    };
    let (Some(mut across), Some(mut up)) = (part(across), part(up)) else {
        return stored;
    };
    if z < 0 {
        (across, up) = (LARGEST.wrapping_sub(up), LARGEST.wrapping_sub(across));
    }
    let with_sign = |size: i16, of: i64| if of < 0 { size.wrapping_neg() } else { size };
    [with_sign(across, x), with_sign(up, y)]
}

/// The normal of length 1 of a stored one.
#[inline(always)]
pub(crate) fn decode<N: Arithmetic>(stored: [i16; 2]) -> [N; 3] {
    N::normalize(unfold(stored).map(N::from_unit)).0
}

/// The inverse root of a ratio, by some of Newton's steps from `a - b x`, given with 30 fraction bits.
#[inline(always)]
fn inverse_root<N: Arithmetic>(x: N, [a, b]: [i32; 2], steps: usize) -> N {
    let mut root = N::ratio(a) - N::ratio(b) * x;
    for _ in 0..steps {
        let square = x * root * root;
        root = root * (N::ratio(3 << 29) - square.half());
    }
    root
}

/// The line that is within 5.5 % of the inverse root from 1/3 to 1: 1.98275 - 1.03771 x.
const FROM_A_THIRD: [i32; 2] = [2_128_961_606, 1_114_232_640];
/// The line that is within 2.3 % of the inverse root from 1/2 to 1: 1.7877 - 0.80998 x.
const FROM_HALF: [i32; 2] = [1_919_528_257, 869_709_402];

/// A stored normal, nearly of length 1, times a weight.
#[inline(always)]
fn weighted<N: Arithmetic>([x, y]: [i16; 2], weight: N) -> [N; 3] {
    // Fractions of 2^15, so that all three are ratios.
    let ratio = |x: i16| N::ratio(i32::from(x) << 15);
    let (x, y, largest) = (ratio(x), ratio(y), ratio(LARGEST));
    let z = largest - x.abs() - y.abs();
    let v = if z < N::ZERO {
        let with_sign = |rest: N, of: N| if of < N::ZERO { -rest } else { rest };
        [
            with_sign(largest - y.abs(), x),
            with_sign(largest - x.abs(), y),
            z,
        ]
    } else {
        [x, y, z]
    };
    let square = N::from_wide(N::dot(v, v));
    let scale = weight * inverse_root(square, FROM_A_THIRD, 1);
    [v[0] * scale, v[1] * scale, v[2] * scale]
}

/// Returns the mean of normals with length 1, or its opposite, given their weighted sum and that of the weights; `None`
/// where they cancel out.
#[inline(always)]
fn unit<N: Arithmetic>(sum: [N; 3], weights: N, is_away: bool) -> Option<[N; 3]> {
    if N::FORMAT != Format::Fixed {
        let inverse = N::ONE.div(weights);
        let v = [sum[0] * inverse, sum[1] * inverse, sum[2] * inverse];
        let square = N::from_wide(N::dot(v, v));
        // At most a little above 1. Not so for NaN.
        if square >= N::ONE.half() && square <= N::ratio(0x4800_0000) {
            let steps = if N::FORMAT == Format::F32 { 3 } else { 5 };
            let scale = inverse_root(square, FROM_HALF, steps);
            let scale = if is_away { -scale } else { scale };
            return Some([v[0] * scale, v[1] * scale, v[2] * scale]);
        }
    }
    far_unit(sum, (weights < N::ZERO) != is_away)
}

/// [`unit`] of normals that lie far apart.
#[cold]
#[inline(never)]
fn far_unit<N: Arithmetic>(sum: [N; 3], is_opposite: bool) -> Option<[N; 3]> {
    let (normal, length) = N::normalize(sum);
    let normal = if is_opposite {
        normal.map(|x| -x)
    } else {
        normal
    };
    (length > N::ZERO).then_some(normal)
}

/// Proves that normals are those of vertices, and that their coordinates are in range.
pub(crate) fn validate(normals: &[[i16; 2]], vertices: usize) -> Result<(), BlobError> {
    let section = SectionKind::Normals;
    at_most_vertices(section, normals.len(), vertices)?;
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
    /// The weights of the corners at a point of the triangle: see [`weights`].
    #[inline(always)]
    fn weights<N: Arithmetic>(&self, point: [N; 3], facing: [N; 3]) -> ([N; 3], bool) {
        weights(self.corners, point, facing)
    }

    /// Returns the interpolated normal of length 1 at a point of the triangle, on the side of `facing`. `facing` is the
    /// geometric normal or its opposite. Returns `None` where the normals of the corners cancel out.
    #[inline(always)]
    pub(crate) fn normal<N: Arithmetic>(&self, point: [N; 3], facing: [N; 3]) -> Option<[N; 3]> {
        let ([u, v, w], is_away) = self.weights(point, facing);
        let [a, b, c] = self.normals;
        let (a, b, c) = (weighted(a, u), weighted(b, v), weighted(c, w));
        let component = |k: usize| a[k] + b[k] + c[k];
        unit(
            [component(0), component(1), component(2)],
            u + v + w,
            is_away,
        )
    }

    /// Returns the way from a point of the triangle out to the curved surface, on the side of `facing`. It is zero
    /// where that surface lies on the other side.
    #[cold]
    #[inline(never)]
    pub(crate) fn lift<N: Arithmetic>(&self, point: [N; 3], facing: [N; 3]) -> [N; 3] {
        let (weights, is_away) = self.weights(point, facing);
        let sum = weights[0] + weights[1] + weights[2];
        let mut way = [N::ZERO; 3];
        for ((corner, normal), weight) in self.corners.iter().zip(self.normals).zip(weights) {
            // Only rounding makes it negative.
            let weight = weight.div(sum).max(N::ZERO).min(N::ONE);
            let mut normal = decode::<N>(normal);
            if is_away {
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

/// Returns a place moved along a way, but no farther from the lattice's middle than rays can start.
#[inline(always)]
pub(crate) fn moved<N: Arithmetic>(place: [N; 3], way: [N; 3]) -> [N; 3] {
    let most = N::from_unit(i16::MAX) + N::from_unit(i16::MAX);
    let axis = |k: usize| (place[k] + way[k]).max(-most).min(most);
    let moved = [axis(0), axis(1), axis(2)];
    debug_assert!(extent(moved) <= most);
    moved
}

/// The weights of a triangle's corners at a point of it, given its normal or the opposite: at least 0, and 1 in sum.
pub(crate) fn barycentric<N: Arithmetic>(
    corners: [[i32; 3]; 3],
    point: [N; 3],
    facing: [N; 3],
) -> [N; 3] {
    let triangle = SmoothTriangle {
        corners,
        normals: [[0; 2]; 3],
    };
    let (weights, _) = triangle.weights(point, facing);
    let sum = weights[0] + weights[1] + weights[2];
    if sum == N::ZERO {
        return [N::ONE, N::ZERO, N::ZERO];
    }
    // Only rounding takes one out of its range, and in narrow triangles by much.
    let weight = |weight: N| weight.div(sum).max(N::ZERO).min(N::ONE);
    let [_, second, third] = weights.map(weight);
    let third = third.min(N::ONE - second);
    [N::ONE - second - third, second, third]
}

#[cfg(test)]
mod tests;
