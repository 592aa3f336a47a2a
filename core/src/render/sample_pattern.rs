//! The places of a pixel's samples: a fixed low-discrepancy pattern.

/// Steps per axis into which a pixel is divided.
pub(crate) const SUBPIXELS: i32 = 256;

/// The place of sample `index` of `count` of a pixel, in subpixels from the picture's upper left
/// corner.
#[inline(always)]
pub(crate) fn place(pixel: [u16; 2], index: u16, count: u16) -> [i32; 2] {
    let [dx, dy] = within(index, count);
    // At most 2^24 and 2^8.
    let [x, y] = pixel.map(|corner| i32::from(corner) * SUBPIXELS);
    [x.wrapping_add(dx), y.wrapping_add(dy)]
}

/// The place of sample `index` of `count` in its pixel, in subpixels from its upper left corner.
///
/// The first two dimensions of Sobol's sequence, which fill every binary division of the pixel
/// evenly, moved to the middle of their cells. A single sample lies in the pixel's middle.
fn within(index: u16, count: u16) -> [i32; 2] {
    if count == 1 {
        return [SUBPIXELS / 2; 2];
    }
    let mirrored = (index as u8).reverse_bits();
    // The second dimension's generator matrix is Pascal's triangle modulo 2.
    let (mut column, mut second) = (0x80_u8, 0_u8);
    for bit in 0..8 {
        if index >> bit & 1 == 1 {
            second ^= column;
        }
        column ^= column >> 1;
    }
    // Half a cell of the finest power of two that holds the samples.
    let bits = u16::BITS - count.min(256).saturating_sub(1).leading_zeros();
    let half_cell = (SUBPIXELS / 2) >> bits;
    [
        i32::from(mirrored) + half_cell,
        i32::from(second) + half_cell,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every power of two of samples has one sample in each column and one in each row.
    #[test]
    fn samples_are_stratified() {
        for bits in 1..=8 {
            let count = 1_u16 << bits;
            for axis in 0..2 {
                let mut seen = vec![false; count.into()];
                for index in 0..count {
                    let place = within(index, count)[axis];
                    assert!((0..SUBPIXELS).contains(&place));
                    let cell = (place * i32::from(count) / SUBPIXELS) as usize;
                    assert!(
                        !seen[cell],
                        "two of {count} samples in cell {cell} of axis {axis}"
                    );
                    seen[cell] = true;
                }
            }
        }
    }
}
