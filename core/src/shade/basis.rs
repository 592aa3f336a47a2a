//! Directions around another one.

use crate::accel::Number;

/// The z of the edge of the cap around -z, with 30 fraction bits. Outside of it 1 + z is at least 2^-8, so quotients by it
/// lose 8 bits at most.
const CAP: i32 = -(255 << 22);

/// Returns two directions that are perpendicular to one of length 1 and to each other.
///
/// They turn steadily with it, except at the edge of a cap of 5 degrees around -z. So the samples of a pixel, for which
/// it differs by little, stay spread evenly around it. (Frisvad, "Building an Orthonormal Basis from a 3D Unit Vector
/// Without Normalization", 2012. In the cap, half a turn around x before and after keeps it precise.)
pub(super) fn perpendicular<N: Number>(direction: [N; 3]) -> [[N; 3]; 2] {
    if direction[2] < N::ratio(CAP) {
        return outside_the_cap(turned(direction)).map(turned);
    }
    outside_the_cap(direction)
}

#[inline(always)]
fn outside_the_cap<N: Number>([x, y, z]: [N; 3]) -> [[N; 3]; 2] {
    let half = N::ONE.half() + z.half();
    let part = |product: N| product.half().div(half);
    let (square, mixed) = (part(x * x), part(x * y));
    [[N::ONE - square, -mixed, -x], [-mixed, square + z, -y]]
}

/// Half a turn around x.
fn turned<N: Number>([x, y, z]: [N; 3]) -> [N; 3] {
    [x, -y, -z]
}

/// The cross product of two directions.
pub(super) fn cross<N: Number>(a: [N; 3], b: [N; 3]) -> [N; 3] {
    let component = |k: usize, l: usize| a[k] * b[l] - a[l] * b[k];
    [component(1, 2), component(2, 0), component(0, 1)]
}

/// The cross product of two directions, rounded once.
#[inline(always)]
pub(super) fn wide_cross<N: Number>(a: [N; 3], b: [N; 3]) -> [N; 3] {
    let component = |k: usize, l: usize| N::from_wide(a[k].wide(b[l]) - a[l].wide(b[k]));
    [component(1, 2), component(2, 0), component(0, 1)]
}

#[cfg(test)]
mod tests;
