//! Components of vectors.

/// The product of two vectors, in their units squared; it wraps beyond 63 bits.
pub(crate) fn dot([a, b, c]: [i32; 3], [x, y, z]: [i32; 3]) -> i64 {
    let product = |a: i32, b: i32| i64::from(a).wrapping_mul(b.into());
    product(a, x)
        .wrapping_add(product(b, y))
        .wrapping_add(product(c, z))
}

/// Returns a component by number. Unlike an index, it keeps the vector in registers.
#[inline(always)]
pub(crate) fn pick<T: Copy>(v: [T; 3], axis: usize) -> T {
    match axis {
        0 => v[0],
        1 => v[1],
        _ => v[2],
    }
}
