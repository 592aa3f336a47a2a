//! Reciprocals.

use crate::number::fixed::halves::{product, product_unsigned, quotient};
use crate::target::inline_unless_small;

inline_unless_small!(
    /// Returns 2^61 / `d` for `d` in \[2^30, 2^31), to a part in 2^29. Cost: a division in 32 bits, which small cores
    /// have or emulate cheaply, and one step of Newton's iteration.
    pub(crate) fn reciprocal(d: u32) -> u32 {
        let coarse = quotient(d.wrapping_add(1 << 14) >> 15) << 14;
        // d * coarse is 2^61, except for a part in 2^15.
        let excess = (product_unsigned(d, coarse) >> 29) as u32 as i32;
        coarse.wrapping_sub((product(coarse as i32, excess) >> 32) as u32)
    }
);
