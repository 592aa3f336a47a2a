//! Products of two numbers, and coordinates beyond the scene.

use crate::number::scalar::Scalar;
use crate::target::inline_unless_small;

/// Arithmetic of wide numbers.
pub trait Products: Scalar {
    /// Product of two numbers.
    fn wide(self, other: Self) -> Self::Wide;
    /// A number as a wide one with the same binary point: a length as a far coordinate.
    fn widen(self) -> Self::Wide;
    /// The inverse of [`widen`](Self::widen); saturates.
    fn narrow(wide: Self::Wide) -> Self;
    /// The magnitude of a wide number; wraps.
    fn magnitude(wide: Self::Wide) -> Self::Wide;
    /// A wide number times an integer.
    fn wide_times(wide: Self::Wide, factor: i32) -> Self::Wide;
    /// A wide number over a positive integer below 2^24, towards zero.
    fn wide_over(wide: Self::Wide, divisor: i32) -> Self::Wide;
    /// The upper half of a wide number that fills its bits, in a unit of its own: enough for a
    /// direction. Floats have no halves.
    fn upper(wide: Self::Wide) -> Self;
    /// A far coordinate from an integer with 13 fraction bits.
    fn far(q13: i64) -> Self::Wide;
    /// `a - b` of arbitrary far coordinates: wraps in [`Fixed`](crate::Fixed).
    fn difference(a: Self::Wide, b: Self::Wide) -> Self::Wide;
    /// `a - b` of far coordinates, of which `a` is not the smaller, as a length: at most
    /// [`FAR`](crate::number::Scalar::FAR).
    fn difference_as_length(a: Self::Wide, b: Self::Wide) -> Self;
    /// Returns where a line reaches a plane far away, on one axis: `origin + (plane - from) * step / stride` in twice
    /// the precision of a far coordinate. `from` is the origin's coordinate on the plane's own axis. `step` and
    /// `stride` are the direction's on this axis and on that; `stride` is not 0 and `step` no larger. Coordinates are
    /// at most 2^37 units; saturates.
    fn carry(
        origin: Self::Wide,
        from: Self::Wide,
        plane: Self,
        step: Self::Wide,
        stride: Self::Wide,
    ) -> Self;
    inline_unless_small!(
        /// Three products added: `a . b`.
        fn dot(a: [Self; 3], b: [Self; 3]) -> Self::Wide {
            a[0].wide(b[0]) + a[1].wide(b[1]) + a[2].wide(b[2])
        }
    );
    /// A product with a ratio as a single number: undoes one [`wide`](Self::wide) by a ratio; saturates.
    fn from_wide(product: Self::Wide) -> Self;
    /// Product of a `Wide` (length by ratio, or length squared) with a ratio, as the same kind of `Wide`.
    fn wide_scale(wide: Self::Wide, ratio: Self) -> Self::Wide;
    /// Returns the quotient of two products whose kinds differ by one factor, which is a length. The kinds are (length
    /// by ratio) over (ratio by ratio), or (length by length) over (length by ratio). Saturates, and 0 / 0 is 0.
    fn divide(numerator: Self::Wide, denominator: Self::Wide) -> Self;
    /// A far coordinate over a product of two ratios that is not 0, as a far coordinate; saturates at 2^49 units or
    /// beyond.
    fn far_over(wide: Self::Wide, ratios: Self::Wide) -> Self::Wide;
    /// A far coordinate without whole periods: a length in \[0, `period`\].
    fn remainder(wide: Self::Wide, period: Self) -> Self;
    /// Square root of length squared: a length; 0 for anything negative.
    fn root(square: Self::Wide) -> Self;
    /// Length of a vector of three products, as the same kind of product.
    fn wide_norm(v: [Self::Wide; 3]) -> Self::Wide;
    /// Square root of the product of two non-negative products, as the same kind of product.
    fn geometric_mean(a: Self::Wide, b: Self::Wide) -> Self::Wide;
}
