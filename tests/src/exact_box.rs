//! Tests whether a ray meets a box, in integers, without any rounding.

use gridel_core::format::record::UnitBox;

/// Fraction bits of origins and limits here.
pub const PLACE_BITS: u32 = 8;
/// Fraction bits of slopes here: products of two have 26 + 97 bits.
pub const SLOPE_BITS: u32 = 96;

/// A ray in integers.
#[derive(Clone, Copy, Debug)]
pub struct ExactRay {
    /// In 2^-8 units.
    pub origin: [i64; 3],
    /// In 2^-96; the largest magnitude is 1.
    pub slope: [i128; 3],
    /// The last t that counts, in 2^-8 units.
    pub tmax: i64,
}

/// A length over a slope: a t, the slope above 0.
#[derive(Clone, Copy)]
struct Fraction(i128, i128);

impl Fraction {
    fn at_most(self, other: Self) -> bool {
        self.0 * other.1 <= other.0 * self.1
    }
}

impl ExactRay {
    /// Returns whether a point of the ray from t = 0 to `tmax` lies in the closed box.
    pub fn meets(&self, bounds: &UnitBox) -> bool {
        let one = 1_i128 << SLOPE_BITS;
        let mut enter = Fraction(0, one);
        let mut leave = Fraction(self.tmax.into(), one);
        for axis in 0..3 {
            let [low, high] =
                bounds.0[axis].map(|plane| (i64::from(plane) << PLACE_BITS) - self.origin[axis]);
            let slope = self.slope[axis];
            if slope == 0 {
                if low > 0 || high < 0 {
                    return false;
                }
                continue;
            }
            let at = |way: i64| Fraction(i128::from(way) * slope.signum(), slope.abs());
            let (near, far) = if slope > 0 {
                (at(low), at(high))
            } else {
                (at(high), at(low))
            };
            if enter.at_most(near) {
                enter = near;
            }
            if far.at_most(leave) {
                leave = far;
            }
        }
        enter.at_most(leave)
    }
}
