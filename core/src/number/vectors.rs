//! Vectors: directions, norms, and shifts that keep their squares in range.

use crate::number::products::Products;

/// Arithmetic of vectors.
pub trait Vectors: Products {
    /// Returns a vector of integers (below 2^52) as ratios: exact up to one common factor and two roundings each. The
    /// largest magnitude lies in \[1/4, 1\] in [`Fixed`](crate::Fixed), and is unscaled in floats.
    fn direction(v: [i64; 3]) -> [Self; 3];
    /// Products of one kind as numbers in the same proportions: the largest magnitude in \[1/8, 1/2\] in
    /// [`Fixed`](crate::Fixed), unscaled in floats.
    fn proportions(v: [Self::Wide; 3]) -> [Self; 3];
    /// A direction of any length as slopes: divided by the magnitude of its largest component, with
    /// that component's axis. `None` for zero, NaN and infinite vectors.
    fn slopes(v: [Self::Wide; 3]) -> Option<([Self; 3], usize)>;
    /// [`slopes`](Self::slopes) of a direction whose components are single numbers of any one unit.
    fn slopes_of(v: [Self; 3]) -> Option<([Self; 3], usize)>;
    /// 1 / (d . d) for slopes, whose d . d lies in \[1, 3\].
    fn recip_norm2(d: [Self; 3]) -> Self;
    /// A vector of one quantity scaled to length 1 (ratios), and its length. A zero vector stays zero.
    fn normalize(v: [Self; 3]) -> ([Self; 3], Self);
    /// Returns by how many bits lengths up to `size` can be shifted up before products overflow; 0 in floats, which
    /// need no shift.
    fn headroom(size: Self) -> u32;
    /// Shifts a length up by [`headroom`](Self::headroom).
    fn scale_up(self, bits: u32) -> Self;
    /// Undoes [`scale_up`](Self::scale_up), rounding to nearest.
    fn scale_down(self, bits: u32) -> Self;
}
