//! Motions, compared with floating point.

use super::*;
use crate::format::Location;
use crate::format::range::Ranges;
use bytemuck::Zeroable;
use proptest::prelude::*;

type Vector = [f64; 3];

/// A rotation about a pivot by a quaternion, a scale about it, and a shift, of a place: all in floating point.
fn moved(place: Vector, pivot: Vector, rotation: [i32; 4], scale: f64, shift: Vector) -> Vector {
    let q = rotation.map(f64::from);
    let norm = libm::sqrt(q.iter().map(|x| x * x).sum());
    let matrix = matrix(q.map(|x| x / norm));
    let way: Vector = core::array::from_fn(|axis| place[axis] - pivot[axis]);
    core::array::from_fn(|axis| {
        let turned: f64 = (0..3).map(|k| matrix[axis][k] * way[k]).sum();
        pivot[axis] + scale * turned + shift[axis]
    })
}

/// The matrix of a quaternion of length 1.
fn matrix([x, y, z, w]: [f64; 4]) -> [Vector; 3] {
    [
        [
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y - z * w),
            2.0 * (x * z + y * w),
        ],
        [
            2.0 * (x * y + z * w),
            1.0 - 2.0 * (x * x + z * z),
            2.0 * (y * z - x * w),
        ],
        [
            2.0 * (x * z - y * w),
            2.0 * (y * z + x * w),
            1.0 - 2.0 * (x * x + y * y),
        ],
    ]
}

fn coordinates() -> impl Strategy<Value = [i32; 3]> {
    prop::array::uniform3(-(1 << 28)..(1 << 28))
}

fn rotations() -> impl Strategy<Value = [i32; 4]> {
    let component = prop_oneof![Just(0), Just(1 << 30), any::<i32>()];
    let rotation = prop::array::uniform4(component);
    rotation.prop_filter("a length", |rotation| *rotation != [0; 4])
}

/// The error of a turn that [`Motion::turn`] states: 2^-25, with 30 fraction bits.
const TURN_ERROR: u32 = 32;

/// A turned component can be longer than the range: the square root of 3 times the largest one.
#[test]
fn directions_beyond_the_range_are_halved() {
    let eighth = Angle::of_turn(1, 8);
    let turn = Motion::turn(Position([0; 3]), [0, 0, 1], eighth).expect("an axis");
    let [x, y, z] = turn.direction([i32::MAX, i32::MIN, 5]);
    let half = f64::from(1_u32 << 30) * core::f64::consts::SQRT_2;
    assert!((f64::from(x) - half).abs() <= 64.0, "{x}");
    assert!(y.abs() <= 64, "{y}");
    assert_eq!(z, 2);
    let length = 1 << 30;
    let turn = Motion::turn(Position([0; 3]), [0, 0, 1], Angle::QUARTER).expect("an axis");
    assert_eq!(turn.direction([length, 0, 7]), [0, length, 7]);
}

proptest! {
    #[test]
    fn turns_are_those_of_real_numbers(
        axis in rotations(),
        angle in prop_oneof![any::<u32>(), 0_u32..4096, (0_u32..4096).prop_map(u32::wrapping_neg)],
    ) {
        let [x, y, z, _] = axis;
        let Some(turn) = Motion::turn(Position([0; 3]), [x, y, z], Angle(angle)) else {
            return Ok(());
        };
        let length = libm::sqrt([x, y, z].iter().map(|&x| f64::from(x) * f64::from(x)).sum());
        let half = f64::from(angle) * f64::powi(2.0, -32) * core::f64::consts::PI;
        let [x, y, z] = [x, y, z].map(|x| f64::from(x) / length * libm::sin(half));
        let expected = matrix([x, y, z, libm::cos(half)]);
        for (found, expected) in turn.rotation.into_iter().zip(expected).flat_map(|(a, b)| a.into_iter().zip(b)) {
            let error = (f64::from(found) - expected * f64::powi(2.0, 30)).abs();
            prop_assert!(error <= f64::from(TURN_ERROR), "{} for {}", found, expected);
        }
    }

    #[test]
    fn motions_are_those_of_real_numbers(
        place in coordinates(),
        pivot in coordinates(),
        rotation in rotations(),
        scale in 1_i32 << 20..1 << 25,
        shift in coordinates(),
    ) {
        let turn = Motion::rotation(Position(pivot), rotation).expect("a length");
        let motion = Motion::scale(Position(pivot), scale).then(&turn).then(&Motion::shift(shift));
        let [place_real, pivot_real, shift_real] = [place, pivot, shift].map(|it| it.map(f64::from));
        let scale = f64::from(scale) / f64::powi(2.0, 24);
        let expected = moved(place_real, pivot_real, rotation, scale, shift_real);
        let found = motion.position(Position(place));
        for (found, expected) in found.0.into_iter().zip(expected) {
            let expected = expected.clamp(i32::MIN.into(), i32::MAX.into());
            // Rotations within 2^-29, of coordinates up to 2^30, twice as large.
            prop_assert!((f64::from(found) - expected).abs() <= 16.0, "{} for {}", found, expected);
        }
    }

    #[test]
    fn motions_one_after_the_other_are_their_composition(
        place in coordinates(),
        pivots in prop::array::uniform2(coordinates()),
        rotations in prop::array::uniform2(rotations()),
    ) {
        let [first, second] = [0, 1].map(|k| Motion::rotation(Position(pivots[k]), rotations[k]).expect("a length"));
        let one_by_one = second.position(first.position(Position(place)));
        let at_once = first.then(&second).position(Position(place));
        for (found, expected) in at_once.0.into_iter().zip(one_by_one.0) {
            let clipped = expected.unsigned_abs() >= i32::MAX as u32;
            prop_assert!(clipped || found.abs_diff(expected) <= 8, "{} for {}", found, expected);
        }
    }

    #[test]
    fn no_numbers_make_a_motion_overflow(
        place in prop::array::uniform3(any::<i32>()),
        pivot in prop::array::uniform3(any::<i32>()),
        rotation in prop::array::uniform4(any::<i32>()),
        scale in any::<i32>(),
        shift in prop::array::uniform3(any::<i32>()),
        coordinate_shift in any::<u8>(),
        origin in any::<f64>(),
        center in prop::array::uniform3(any::<i32>()),
    ) {
        let pivot = Position(pivot);
        let mut motion = Motion::scale(pivot, scale).then(&Motion::shift(shift));
        if let Some(turn) = Motion::rotation(pivot, rotation) {
            motion = motion.then(&turn);
        }
        for _ in 0..40 {
            motion = motion.then(&motion);
        }
        motion.position(Position(place));
        let header = Header {
            coordinate_shift,
            origin: [origin; 3],
            counted_from: 1,
            ..Header::zeroed()
        };
        let rest = Instance { matrix: [[1 << 23, 0, 0], [0, 1 << 23, 0], [0, 0, 1 << 23]], center, ..Instance::zeroed() };
        motion.place(&header, &rest);
        motion.place_rounded(&header, &rest);
    }

    /// An instance that is turned by a rounded matrix, and back by a motion, has rows that are longer than 1.
    #[test]
    fn turned_back_matrices_keep_their_range(axis in rotations(), angle in any::<u32>()) {
        let [x, y, z, _] = axis;
        let turn = |angle| Motion::turn(Position([0; 3]), [x, y, z], Angle(angle));
        let (Some(first), Some(back)) = (turn(angle), turn(angle.wrapping_neg())) else {
            return Ok(());
        };
        let whole = [[1 << 23, 0, 0], [0, 1 << 23, 0], [0, 0, 1 << 23]];
        let rest = Instance { matrix: whole, ..Instance::zeroed() };
        let header = Header::zeroed();
        let turned = first.place(&header, &rest);
        for motion in [back, first, Motion::REST] {
            let placed = motion.place_rounded(&header, &turned);
            prop_assert!(placed.check_ranges(Location::Header).is_ok(), "{:?}", placed.matrix);
            crate::instances::bounds::check_rotation(&placed.matrix).expect("a rotation");
        }
    }

    #[test]
    fn long_chains_stay_rotations(axis in rotations(), angle in any::<u32>(), length in 20_usize..3000) {
        let [x, y, z, _] = axis;
        let Some(turn) = Motion::turn(Position([0; 3]), [x, y, z], Angle(angle)) else {
            return Ok(());
        };
        let chain = (1..length).fold(turn, |chain, _| chain.then(&turn));
        let whole = [[1 << 23, 0, 0], [0, 1 << 23, 0], [0, 0, 1 << 23]];
        let rest = Instance { matrix: whole, ..Instance::zeroed() };
        let straight = chain.without_drift();
        let placed = chain.place_rounded(&Header::zeroed(), &rest);
        prop_assert!(placed.check_ranges(Location::Header).is_ok(), "{:?}", placed.matrix);
        crate::instances::bounds::check_rotation(&placed.matrix).expect("a rotation");
        // Each turn goes as far as the angles' sum, except for the rounding of each turn and each composition. Errors
        // of matrices add up. As a vector's stretch, an error of all nine entries is three times as large.
        let at_once = Motion::turn(Position([0; 3]), [x, y, z], Angle(angle.wrapping_mul(length as u32)));
        let at_once = at_once.expect("an axis").rotation.into_iter().flatten();
        for (found, expected) in straight.rotation.into_iter().flatten().zip(at_once) {
            prop_assert!(found.abs_diff(expected) <= 3 * (TURN_ERROR + 1) * length as u32, "{} for {}", found, expected);
        }
    }

    /// An instance at rest is rounded, too.
    #[test]
    fn turned_and_scaled_instances_stay_rotations(
        rest in rotations(), factor in 1_i64 << 22..=1 << 23, rotation in rotations(), scale in SCALES[0]..=SCALES[1],
    ) {
        let origin = Position([0; 3]);
        let rest = Motion::rotation(origin, rest).expect("a length").rotation;
        let rounded = |entry: i32| ((i64::from(entry) * factor + (1 << 29)) >> 30) as i32;
        let matrix = rest.map(|row| row.map(rounded));
        crate::instances::bounds::check_rotation(&matrix).expect("a rotation");
        let motion = Motion::rotation(origin, rotation).expect("a length");
        let motion = motion.then(&Motion::scale(origin, scale));
        let rest = Instance { matrix, ..Instance::zeroed() };
        let placed = motion.place_rounded(&Header::zeroed(), &rest);
        prop_assert!(crate::instances::bounds::check_rotation(&placed.matrix).is_ok(), "{:?}", placed.matrix);
    }

    #[test]
    fn scaled_matrices_keep_their_range(rotation in rotations(), scale in SCALES[0]..=SCALES[1], factor in 1_i32 << 22..=1 << 23) {
        let rest = [[factor, 0, 0], [0, factor, 0], [0, 0, factor]];
        let motion = Motion::rotation(Position([0; 3]), rotation).expect("a length");
        let motion = motion.then(&Motion::scale(Position([0; 3]), scale));
        let (matrix, exponent) = motion.matrix(&rest);
        crate::instances::bounds::check_rotation(&matrix).expect("a rotation");
        let length = libm::sqrt(dot(matrix[0], matrix[0]) as f64) * f64::powi(2.0, exponent.into());
        let expected = f64::from(factor) / (f64::from(scale) / f64::powi(2.0, 24));
        prop_assert!((length / expected - 1.0).abs() < 1e-6, "{} for {}", length, expected);
    }
}

#[test]
fn rest_moves_nothing() {
    let header = Header {
        coordinate_shift: 3,
        origin: [12.5, -1e6, 0.0],
        counted_from: 1,
        ..Header::zeroed()
    };
    let rest = Instance {
        matrix: [[0, -(1 << 22), 0], [1 << 22, 0, 0], [0, 0, 1 << 22]],
        center: [1 << 23, -(1 << 23), 12345],
        exponent: 7,
        part: 3,
        number: 9,
    };
    assert_eq!(Motion::REST.place(&header, &rest), rest);
    let corner = Position([i32::MIN, i32::MAX, 5]);
    assert_eq!(Motion::REST.position(corner), corner);
}

#[test]
fn axes_without_length_turn_nothing() {
    assert_eq!(Motion::turn(Position([0; 3]), [0; 3], Angle::QUARTER), None);
    assert_eq!(Motion::rotation(Position([0; 3]), [0; 4]), None);
}
