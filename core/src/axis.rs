//! Access to components of vectors by the number of their axis.

/// Returns a component by number. Unlike an index, it keeps the vector in registers.
#[inline(always)]
pub(crate) fn pick<T: Copy>(v: [T; 3], axis: usize) -> T {
    match axis {
        0 => v[0],
        1 => v[1],
        _ => v[2],
    }
}
