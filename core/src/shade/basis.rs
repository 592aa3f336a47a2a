//! Directions around another one.

use crate::accel::Number;

/// Returns two directions that are perpendicular to one of length 1 and to each other. (Duff, Burgess, Christensen,
/// Hery, Kensler, Liani and Villemin, "Building an Orthonormal Basis, Revisited", 2017.)
pub(super) fn beside<N: Number>([x, y, z]: [N; 3]) -> [[N; 3]; 2] {
    let one = N::ONE.half();
    let signed = |value: N| if z < N::ZERO { -value } else { value };
    let scale = -one.div(one + z.abs().half());
    let mixed = x * y * scale;
    [
        [N::ONE + x * x * scale, mixed, signed(-x)],
        [signed(mixed), signed(N::ONE + y * y * scale), -y],
    ]
}

/// The cross product of two directions.
pub(super) fn cross<N: Number>(a: [N; 3], b: [N; 3]) -> [N; 3] {
    let component = |k: usize, l: usize| a[k] * b[l] - a[l] * b[k];
    [component(1, 2), component(2, 0), component(0, 1)]
}
