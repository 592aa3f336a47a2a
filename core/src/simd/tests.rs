use crate::simd::{Avx2, F32x8, Portable, Simd};

const NUMBERS: [f32; 8] = [1.5, -0.0, 0.0, -3.25, 1e-40, f32::MAX, -1e30, 7.0];

/// Calls a generic function with every set of instructions that this processor has.
macro_rules! every_level {
    ($function:ident) => {
        $function(Portable);
        if let Some(avx2) = Avx2::detect() {
            $function(avx2);
            // Compiled for the instructions, too.
            avx2.call(
                |avx2, (), (), (), (), ()| $function(avx2),
                ((), (), (), (), ()),
            );
        }
    };
}

#[test]
fn lanes_match_scalar_numbers() {
    every_level!(check_lanes);
}

fn check_lanes<S: Simd>(simd: S) {
    for turn in 0..8 {
        let others: [f32; 8] = core::array::from_fn(|lane| NUMBERS[(lane + turn) % 8]);
        let (a, b) = (simd.lanes(&NUMBERS), simd.lanes(&others));
        let check = |found: S::F32x8, expected: fn(f32, f32) -> f32| {
            for (lane, found) in found.to_array().into_iter().enumerate() {
                let expected = expected(NUMBERS[lane], others[lane]);
                assert_eq!(found.to_bits(), expected.to_bits(), "lane {lane}");
            }
        };
        check(a + b, |a, b| a + b);
        check(a - b, |a, b| a - b);
        check(a * b, |a, b| a * b);
        check(a.abs(), |a, _| a.abs());
        let sums = a.mul_add(b, a).to_array().into_iter().enumerate();
        for (lane, found) in sums {
            let (a, b) = (NUMBERS[lane], others[lane]);
            let allowed = [a * b + a, a.mul_add(b, a)].map(f32::to_bits);
            assert!(allowed.contains(&found.to_bits()), "lane {lane}: {found}");
        }
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
fn integers_convert_exactly() {
    every_level!(check_integers);
}

fn check_integers<S: Simd>(simd: S) {
    let shorts = [0, 1, -1, i16::MAX, i16::MIN, 255, -256, 77];
    assert_eq!(simd.of_i16(&shorts).to_array(), shorts.map(f32::from));
    let words = [0, 1, u16::MAX, 0x7fff, 0x8000, 255, 256, 77];
    assert_eq!(simd.of_u16(&words).to_array(), words.map(f32::from));
    let bytes: [u8; 8] = [0, 1, 0x7f, 0x80, 0xff, 0xfe, 3, 200];
    let words = [[0, 0xff], [1, 0xfe], [0x7f, 3], [0x80, 200]].map(u16::from_le_bytes);
    let long = [0, 1, -1, 0xff_ffff, 1 << 24, -(1 << 24), 77, 65_536];
    assert_eq!(simd.of_i32(&long).to_array(), long.map(|x| x as f32));
    let low: [u16; 8] = [0, 1, 0xffff, 0x8000, 0x7fff, 2, 3, 0xfffe];
    let expected: [f32; 8] = core::array::from_fn(|lane| {
        (i32::from(low[lane]) | i32::from(bytes[lane] as i8) << 16) as f32
    });
    assert_eq!(simd.of_i24(&low, &words).to_array(), expected);
}
