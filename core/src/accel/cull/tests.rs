use crate::accel::cull::{Cull, Culling, PairCulling};
use crate::accel::cull_axis::CullArithmetic;
use crate::accel::number::Number;
use crate::format::record::UnitBox;
use crate::number::Fixed;
use crate::ray::Ray;
use proptest::prelude::*;

/// Fraction bits of origins and slopes here, which every number format holds exactly.
const ORIGIN_BITS: u32 = 8;
const SLOPE_BITS: u32 = 23;

/// An exact fraction with a denominator above 0.
#[derive(Clone, Copy, Debug)]
struct Fraction(i128, i128);

impl Fraction {
    fn new(numerator: i128, denominator: i128) -> Self {
        Self(numerator * denominator.signum(), denominator.abs())
    }

    fn at_least(self, other: Self) -> bool {
        self.0 * other.1 >= other.0 * self.1
    }
}

/// A slope in 2^-23: often about 2^-12, where culling changes its rule, or 0.
fn slope() -> impl Strategy<Value = i32> {
    let one = 1 << SLOPE_BITS;
    prop_oneof![
        -one..=one,
        prop_oneof![Just(0), Just(2048), Just(-2048), 2040..2056, -2056..-2040],
        -40..40,
    ]
}

/// One axis: the ray's origin and slope, and a box's lower and upper reach around the ray.
type Axis = (i32, i32, i16, i16);

fn axis() -> impl Strategy<Value = Axis> {
    let reach = || prop_oneof![0..3_i16, 0..30_000_i16];
    (-8_388_352..=8_388_352_i32, slope(), reach(), reach())
}

/// The culling interval of a box that a ray meets holds the true one, in exact arithmetic.
fn holds_the_true_interval<N: Number>(
    axes: [Axis; 3],
    major: usize,
    down: bool,
    place: u32,
) -> Result<(), TestCaseError> {
    let one = 1 << SLOPE_BITS;
    let mut slopes = axes.map(|axis| axis.1);
    slopes[major] = if down { -one } else { one };
    // Where the ray is at t = place / 16, in 2^-31 of a unit, and a box of units around that.
    let scale = 1_i128 << (ORIGIN_BITS + SLOPE_BITS);
    let mut bounds = [[0_i16; 2]; 3];
    for k in 0..3 {
        let (origin, _, below, above) = axes[k];
        let moved = (i128::from(slopes[k]) * i128::from(place)) << (ORIGIN_BITS - 4);
        let point = (i128::from(origin) << SLOPE_BITS) + moved;
        let low = point.div_euclid(scale) - i128::from(below);
        let high = -(-point).div_euclid(scale) + i128::from(above);
        if low.abs() > 32_767 || high.abs() > 32_767 {
            // Outside every scene: three cases in four.
            return Ok(());
        }
        bounds[k] = [low as i16, high as i16];
    }
    let world = UnitBox([[-32_767, 32_767]; 3]);
    let origin = axes.map(|axis| f64::from(axis.0) / f64::from(1 << ORIGIN_BITS));
    let direction = slopes.map(|slope| f64::from(slope) / f64::from(one));
    let ray = Ray::<N>::from_f64(&world, origin, direction, 0.0, 1e9).expect("a ray");
    prop_assert_eq!(ray.slope().map(N::ratio_to_f64), direction);
    let around = UnitBox(bounds);
    let interval = <Cull as Culling<N>>::new(&ray).interval(&around);
    prop_assert!(interval.near <= interval.far);
    // The culling form of this machine holds the box, too.
    let taken = PairCulling::root(&N::Cull::new(&ray), &around, N::Cull::limit(ray.tmax));
    prop_assert!(taken.near <= taken.far);
    for k in 0..3 {
        if slopes[k] == 0 {
            continue;
        }
        // Twice the t at which a plane is reached.
        let crossing = |unit: i16| {
            let way = (i128::from(unit) << ORIGIN_BITS) - i128::from(axes[k].0);
            Fraction::new(
                2 * (way << SLOPE_BITS),
                i128::from(slopes[k]) << ORIGIN_BITS,
            )
        };
        let (first, second) = (crossing(bounds[k][0]), crossing(bounds[k][1]));
        let (enter, leave) = if slopes[k] > 0 {
            (first, second)
        } else {
            (second, first)
        };
        // No interval needs to hold a t before the origin or beyond every space.
        let (zero, end) = (Fraction(0, 1), Fraction(2 * 65_536, 1));
        let near = Fraction(interval.near.into(), 1);
        let far = Fraction(interval.far.into(), 1);
        // The interval is cut with those of the other axes, so it holds their intersection.
        let entered_last = (0..3).all(|other| {
            other == k || slopes[other] == 0 || {
                let near_other = bounds[other][usize::from(slopes[other] < 0)];
                let way = (i128::from(near_other) << ORIGIN_BITS) - i128::from(axes[other].0);
                let other = Fraction::new(
                    2 * (way << SLOPE_BITS),
                    i128::from(slopes[other]) << ORIGIN_BITS,
                );
                enter.at_least(other)
            }
        });
        if entered_last && enter.at_least(zero) {
            prop_assert!(enter.at_least(near), "{k}: {enter:?} {interval:?}");
        }
        let left_first = (0..3).all(|other| {
            other == k || slopes[other] == 0 || {
                let far_other = bounds[other][usize::from(slopes[other] > 0)];
                let way = (i128::from(far_other) << ORIGIN_BITS) - i128::from(axes[other].0);
                let other = Fraction::new(
                    2 * (way << SLOPE_BITS),
                    i128::from(slopes[other]) << ORIGIN_BITS,
                );
                other.at_least(leave)
            }
        });
        if left_first && end.at_least(leave) {
            prop_assert!(far.at_least(leave), "{k}: {leave:?} {interval:?}");
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200_000))]

    #[test]
    fn culling_is_conservative(
        axes in [axis(), axis(), axis()],
        major in 0..3_usize,
        down: bool,
        place in 0..1_048_576_u32,
    ) {
        holds_the_true_interval::<Fixed>(axes, major, down, place)?;
        holds_the_true_interval::<f32>(axes, major, down, place)?;
        holds_the_true_interval::<f64>(axes, major, down, place)?;
    }

    /// Shifted planes cull no more than rotated ones, and hardly less.
    #[test]
    fn shifted_planes_are_around_rotated_ones(
        word: u32,
        slope in slope(),
        origin in -8_388_352..=8_388_352_i32,
    ) {
        let axis = Fixed::cull_axis(Fixed(slope << (30 - SLOPE_BITS)), Fixed(origin << 5));
        let (narrow, wide) = (axis.between(word), axis.around_by_shifts(word));
        let unit = (axis.inverse.abs() >> 16) + 1;
        prop_assert!(wide.near <= narrow.near && narrow.near - wide.near <= unit);
        prop_assert!(narrow.far <= wide.far && wide.far - narrow.far <= unit);
    }

    /// A box inside another is culled no later. So all structures agree.
    #[test]
    fn culling_is_monotone(
        outer in [any::<[i16; 2]>(), any::<[i16; 2]>(), any::<[i16; 2]>()],
        parts in [any::<[u8; 2]>(), any::<[u8; 2]>(), any::<[u8; 2]>()],
        origin in [-5e4..5e4_f64, -5e4..5e4, -5e4..5e4],
        direction in [-1.0..1.0_f64, -1.0..1.0, -1e-3..1e-3],
    ) {
        let outer = outer.map(|[a, b]| [a.min(b), a.max(b)]);
        let inner = core::array::from_fn(|k| {
            let [low, high] = outer[k].map(i32::from);
            let at = |part: u8| (low + (high - low) * i32::from(part) / 255) as i16;
            let [a, b] = parts[k].map(at);
            [a.min(b), a.max(b)]
        });
        let (outer, inner) = (UnitBox(outer), UnitBox(inner));
        prop_assert!(outer.contains(&inner));
        let world = UnitBox([[-32_767, 32_767]; 3]);
        prop_assume!(direction.iter().any(|&x| x != 0.0));
        let intervals = |outer, inner| {
            let ray = Ray::<Fixed>::from_f64(&world, origin, direction, 0.0, 1e9).expect("a ray");
            let other = Ray::<f32>::from_f64(&world, origin, direction, 0.0, 1e9).expect("a ray");
            let culls = [<Cull as Culling<Fixed>>::new(&ray), <Cull as Culling<f32>>::new(&other)];
            culls.map(|cull| (cull.interval(outer), cull.interval(inner)))
        };
        for (outer, inner) in intervals(&outer, &inner) {
            prop_assert!(outer.near <= inner.near && inner.far <= outer.far);
        }
    }
}
