//! Angles as integers, with the same sines on every machine.

/// An angle: a part of a turn with 32 fraction bits, so that sums wrap around as angles do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Angle(pub u32);

impl Angle {
    /// A quarter of a turn.
    pub const QUARTER: Self = Self(1 << 30);

    /// Half a turn.
    pub const HALF: Self = Self(1 << 31);

    /// Returns the angle of `part` of `whole` turns, to nearest; whole turns are dropped. A `whole` of 0 counts as 1.
    ///
    /// ```
    /// use gridel_core::Angle;
    ///
    /// // A dial with 24 steps.
    /// assert_eq!(Angle::of_turn(6, 24), Angle::QUARTER);
    /// assert_eq!(Angle::of_turn(-6, 24), Angle(3 << 30));
    /// ```
    pub const fn of_turn(part: i32, whole: u32) -> Self {
        let whole = if whole == 0 { 1 } else { whole as i64 };
        // Below 2^32 each, so the quotient of 64 bits is that of the numbers.
        let scaled = ((part as i64) << 32).wrapping_add(whole / 2);
        Self(scaled.div_euclid(whole) as u32)
    }

    /// Returns the angle of this many degrees, to nearest.
    ///
    /// ```
    /// use gridel_core::Angle;
    ///
    /// assert_eq!(Angle::degrees(90), Angle::QUARTER);
    /// assert_eq!(Angle::degrees(-90), Angle::degrees(270));
    /// ```
    pub const fn degrees(degrees: i32) -> Self {
        Self::of_turn(degrees, 360)
    }

    /// Returns the sum of this angle and another one.
    pub const fn plus(self, other: Self) -> Self {
        Self(self.0.wrapping_add(other.0))
    }

    /// Returns the opposite angle.
    pub const fn negative(self) -> Self {
        Self(self.0.wrapping_neg())
    }

    /// Returns the sine and the cosine, as ratios with 30 fraction bits, within 2^-29; exact at multiples of a quarter
    /// turn. Cost: 14 products of 32 bits.
    ///
    /// ```
    /// use gridel_core::Angle;
    ///
    /// assert_eq!(Angle::QUARTER.sin_cos(), [1 << 30, 0]);
    /// let [sine, cosine] = Angle::degrees(30).sin_cos();
    /// assert_eq!(sine, 1 << 29);
    /// ```
    pub const fn sin_cos(self) -> [i32; 2] {
        let rest = self.0 & (Self::QUARTER.0 - 1);
        // Beyond an eighth of a turn, uses the complement to a quarter of a turn.
        let swapped = rest > Self::QUARTER.0 / 2;
        let [sine, cosine] = if swapped {
            let [sine, cosine] = small_sin_cos(Self::QUARTER.0 - rest);
            [cosine, sine]
        } else {
            small_sin_cos(rest)
        };
        match self.0 >> 30 {
            0 => [sine, cosine],
            1 => [cosine, sine.wrapping_neg()],
            2 => [sine.wrapping_neg(), cosine.wrapping_neg()],
            _ => [cosine.wrapping_neg(), sine],
        }
    }
}

/// Sine and cosine of up to an eighth of a turn: power series, whose first omitted term is below 2^-33.
const fn small_sin_cos(turn: u32) -> [i32; 2] {
    /// 2 pi with 29 fraction bits.
    const TURN: u64 = 3_373_259_426;

    const fn upper(a: u32, b: u32) -> u32 {
        ((a as u64 * b as u64) >> 32) as u32
    }

    /// One over a number with 32 fraction bits, to nearest.
    const fn one_over(number: u64) -> u32 {
        (((1 << 33) / number + 1) >> 1) as u32
    }

    // Fractions with 32 bits: the angle is at most .786, and its square .617.
    let angle = ((turn as u64 * TURN) >> 29) as u32;
    let square = upper(angle, angle);
    let mut odd = one_over(39_916_800);
    odd = one_over(362_880).wrapping_sub(upper(square, odd));
    odd = one_over(5_040).wrapping_sub(upper(square, odd));
    odd = one_over(120).wrapping_sub(upper(square, odd));
    odd = one_over(6).wrapping_sub(upper(square, odd));
    let mut even = one_over(3_628_800);
    even = one_over(40_320).wrapping_sub(upper(square, even));
    even = one_over(720).wrapping_sub(upper(square, even));
    even = one_over(24).wrapping_sub(upper(square, even));
    even = one_over(2).wrapping_sub(upper(square, even));
    let sine = angle.wrapping_sub(upper(angle, upper(square, odd))) as u64;
    let cosine = (1_u64 << 32).wrapping_sub(upper(square, even) as u64);
    [
        (sine.wrapping_add(2) >> 2) as i32,
        (cosine.wrapping_add(2) >> 2) as i32,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn check(angle: u32) {
        let turn = f64::from(angle) / 4_294_967_296.0 * core::f64::consts::TAU;
        let [sine, cosine] = Angle(angle)
            .sin_cos()
            .map(|x| f64::from(x) / f64::from(1 << 30));
        let bound = f64::powi(2.0, -29);
        assert!((sine - libm::sin(turn)).abs() <= bound, "sine of {angle}");
        assert!(
            (cosine - libm::cos(turn)).abs() <= bound,
            "cosine of {angle}"
        );
    }

    #[test]
    fn sines_are_right_around_every_eighth_of_a_turn() {
        for eighth in 0..8_u32 {
            for beside in -3_i32..=3 {
                check((eighth << 29).wrapping_add_signed(beside));
            }
        }
        let right_angles = [0, 1, 2, 3].map(|quarter| Angle(quarter << 30).sin_cos());
        let one = 1 << 30;
        assert_eq!(right_angles, [[0, one], [one, 0], [0, -one], [-one, 0]]);
    }

    #[test]
    fn parts_of_turns_wrap_and_round_at_their_ends() {
        assert_eq!(Angle::of_turn(i32::MIN, 1), Angle(0));
        assert_eq!(Angle::of_turn(i32::MAX, 0), Angle(0));
        assert_eq!(Angle::of_turn(1, u32::MAX), Angle(1));
        assert_eq!(Angle::of_turn(-1, u32::MAX), Angle(u32::MAX));
        assert_eq!(Angle::degrees(1), Angle(11_930_465));
        assert_eq!(Angle::degrees(360 * 1000 + 45), Angle(1 << 29));
        assert_eq!(Angle::QUARTER.plus(Angle(3 << 30)), Angle(0));
        assert_eq!(Angle::QUARTER.negative(), Angle(3 << 30));
    }

    proptest! {
        #[test]
        fn sines_are_within_their_bound(angle: u32) {
            check(angle);
        }
    }
}
