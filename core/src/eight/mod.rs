//! Eight numbers of single precision at once.
//!
//! Additions, subtractions and products are those of IEEE 754 in every lane, never fused, so a
//! kernel gives the same bits here as one number at a time, and the same bits whichever of the two
//! forms it is compiled with: two registers of four lanes, or, with the feature `simd`, one of
//! eight where the machine has such.

#[cfg(feature = "simd")]
mod one;
#[cfg(not(feature = "simd"))]
mod two;

#[cfg(feature = "simd")]
pub(crate) use one::Eight;
#[cfg(not(feature = "simd"))]
pub(crate) use two::Eight;

#[cfg(test)]
mod tests {
    use super::Eight;

    const NUMBERS: [f32; 8] = [1.5, -0.0, 0.0, -3.25, 1e-40, f32::MAX, -1e30, 7.0];

    /// Every operation is that of one number at a time.
    #[test]
    fn lanes_are_numbers() {
        for turn in 0..8 {
            let others: [f32; 8] = core::array::from_fn(|lane| NUMBERS[(lane + turn) % 8]);
            let (a, b) = (Eight::new(NUMBERS), Eight::new(others));
            let check = |found: Eight, expected: fn(f32, f32) -> f32| {
                for (lane, found) in found.to_array().into_iter().enumerate() {
                    let expected = expected(NUMBERS[lane], others[lane]);
                    assert_eq!(found.to_bits(), expected.to_bits(), "lane {lane}");
                }
            };
            check(a + b, |a, b| a + b);
            check(a - b, |a, b| a - b);
            check(a * b, |a, b| a * b);
            let bits = |of: fn(f32, f32) -> bool| {
                let lanes = NUMBERS.iter().zip(others).enumerate();
                lanes.fold(0, |bits, (lane, (&a, b))| {
                    bits | u32::from(of(a, b)) << lane
                })
            };
            assert_eq!(a.at_most(b), bits(|a, b| a <= b));
            assert_eq!(b.signs(), bits(|_, b| b.is_sign_negative()));
            assert_eq!(b.zero(), bits(|_, b| b == 0.0));
            let next = b.next().to_array();
            assert!((0..8).all(|lane: usize| next[lane] == others[(lane + 1).min(7)]));
            let larger = a.max(b).to_array();
            let smaller = a.min(b).to_array();
            for lane in 0..8 {
                assert_eq!(larger[lane], NUMBERS[lane].max(others[lane]));
                assert_eq!(smaller[lane], NUMBERS[lane].min(others[lane]));
            }
        }
    }

    #[test]
    fn integers_are_exact() {
        let shorts = [0, 1, -1, i16::MAX, i16::MIN, 255, -256, 77];
        assert_eq!(Eight::from_i16(&shorts).to_array(), shorts.map(f32::from));
        let words = [0, 1, u16::MAX, 0x7fff, 0x8000, 255, 256, 77];
        assert_eq!(Eight::from_u16(&words).to_array(), words.map(f32::from));
        let bytes: [u8; 8] = [0, 1, 0x7f, 0x80, 0xff, 0xfe, 3, 200];
        let words = [[0, 0xff], [1, 0xfe], [0x7f, 3], [0x80, 200]].map(u16::from_le_bytes);
        let long = [0, 1, -1, 0xff_ffff, 1 << 24, -(1 << 24), 77, 65_536];
        assert_eq!(Eight::from_i32(&long).to_array(), long.map(|x| x as f32));
        let low: [u16; 8] = [0, 1, 0xffff, 0x8000, 0x7fff, 2, 3, 0xfffe];
        let expected: [f32; 8] = core::array::from_fn(|lane| {
            (i32::from(low[lane]) | i32::from(bytes[lane] as i8) << 16) as f32
        });
        assert_eq!(Eight::from_i24(&low, &words).to_array(), expected);
    }
}
