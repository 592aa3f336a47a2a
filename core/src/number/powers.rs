//! Products of far coordinates and powers of two.

use crate::number::products::Products;

/// Arithmetic of far coordinates that are scaled by powers of two, as in maps between coordinate systems.
pub trait Powers: Products {
    /// A product of a length and a ratio times a power of two, from 2^-4 to 2^29, as a far coordinate; rounded to nearest.
    fn far_of_product(product: Self::Wide, exponent: i32) -> Self::Wide;
    /// A far coordinate times a power of two, from 2^-31 to 2^31; rounded to nearest. Wraps in [`Fixed`](crate::Fixed).
    fn far_times_power(wide: Self::Wide, exponent: i32) -> Self::Wide;
}
