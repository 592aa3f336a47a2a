//! Fixed point in 32 bits, products in 64: for cores without a floating-point unit.

pub(crate) mod base;
mod exponential;
pub(crate) mod halves;
mod number;
mod quotient;
pub(crate) mod reciprocal;
mod root;
#[cfg(feature = "strict-ranges")]
pub(crate) mod strict;
#[cfg(test)]
mod tests;
mod vector;
pub(crate) mod wide;
