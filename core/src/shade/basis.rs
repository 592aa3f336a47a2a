//! Directions around another one.

use crate::accel::Number;

/// The z at which directions around another one change sides, with 30 fraction bits.
const CAP: i32 = -(255 << 22);

/// Returns two directions that are perpendicular to one of length 1 and to each other.
///
/// They turn steadily with it, except where it enters a cap of 5 degrees around -z. Samples of a pixel that differ in
/// it by little are so drawn in the same order, and stay spread evenly. (Frisvad, "Building an Orthonormal Basis from a
/// 3D Unit Vector Without Normalization", 2012; in the cap half a turn around x makes it precise.)
pub(super) fn beside<N: Number>(direction: [N; 3]) -> [[N; 3]; 2] {
    if direction[2] < N::ratio(CAP) {
        return around_z(turned(direction)).map(turned);
    }
    around_z(direction)
}

#[inline(always)]
fn around_z<N: Number>([x, y, z]: [N; 3]) -> [[N; 3]; 2] {
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
