//! Directions around another one.

use crate::accel::Number;

/// The z at which directions around another one change sides, with 30 fraction bits.
const CAP: i32 = -(255 << 22);

/// Returns two directions that are perpendicular to one of length 1 and to each other.
///
/// They turn steadily with it, except where it enters a cap of 5 degrees around -z. Samples of a pixel that differ in
/// it by little are so drawn in the same order, and stay spread evenly. (Frisvad, "Building an Orthonormal Basis from a
/// 3D Unit Vector Without Normalization", 2012; in the cap its mirror image, which is precise there.)
pub(super) fn beside<N: Number>([x, y, z]: [N; 3]) -> [[N; 3]; 2] {
    let is_in_cap = z < N::ratio(CAP);
    let signed = |value: N| if is_in_cap { -value } else { value };
    let half = N::ONE.half() + signed(z.half());
    let part = |product: N| product.half().div(half);
    let (square, mixed) = (part(x * x), part(x * y));
    [
        [N::ONE - square, -mixed, signed(-x)],
        [signed(-mixed), signed(square) + z, -y],
    ]
}

/// The cross product of two directions.
pub(super) fn cross<N: Number>(a: [N; 3], b: [N; 3]) -> [N; 3] {
    let component = |k: usize, l: usize| a[k] * b[l] - a[l] * b[k];
    [component(1, 2), component(2, 0), component(0, 1)]
}
