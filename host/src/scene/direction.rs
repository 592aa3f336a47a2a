//! Directions: of length 1, and parallel ones.

use glam::DVec3;

/// How far apart two lengths or angles may be, relatively, and still count as equal: far above
/// what rounding does to a product of matrices, and far below what 24 bits of the lattice show.
pub(super) const TOLERANCE: f64 = 1.0 / (1_u64 << 30) as f64;

/// The vector at length 1, also where its square is out of range.
pub(super) fn unit(vector: DVec3) -> DVec3 {
    (vector / vector.abs().max_element()).normalize()
}

/// Whether two vectors are parallel, or one of them has no length.
pub(super) fn parallel(a: DVec3, b: DVec3) -> bool {
    let sine = unit(a).cross(unit(b)).length();
    sine.is_nan() || sine <= TOLERANCE
}
