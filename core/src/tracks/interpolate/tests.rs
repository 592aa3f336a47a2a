use super::*;
use crate::format::track::{Timeline, TrackTarget};
use crate::tracks::records::Records;
use proptest::prelude::*;
use std::vec::Vec;

const ENDS: [i32; 7] = [i32::MIN, i32::MIN + 1, -1, 0, 1, i32::MAX - 1, i32::MAX];

/// The value of the one track over these keys.
fn value<const N: usize>(
    target: TrackTarget,
    interpolation: Interpolation,
    times: &[i32],
    words: &[i32],
    time: i32,
) -> [i32; N] {
    let tracks = [Track {
        target: target as u16,
        interpolation: interpolation as u16,
        index: 0,
        keys: times.len() as u32,
        first_time: 0,
        first_word: 0,
    }];
    let all = Tracks(Records {
        weights: &[],
        joints: &[],
        instance_joints: &[],
        timeline: Timeline {
            ticks_per_second: 1,
            first: 0,
            last: 0,
        },
        tracks: &tracks,
        times,
        words,
    });
    let sample = all.sample(&tracks[0], target.kind(), time);
    sample.expect("a value").value()
}

fn turns(interpolation: Interpolation, times: &[i32], words: &[i32], time: i32) -> i32 {
    let [value] = value(TrackTarget::CameraOrbit, interpolation, times, words, time);
    value
}

/// `numerator / denominator` to nearest, the half away from 0.
fn nearest(numerator: i128, denominator: i128) -> i128 {
    let magnitude = (2 * numerator.abs() + denominator) / (2 * denominator);
    magnitude * numerator.signum()
}

fn check_linear([from, to]: [i32; 2], [start, end]: [i32; 2], time: i32) {
    let found = turns(Interpolation::Linear, &[start, end], &[from, to], time);
    let time = time.clamp(start, end);
    let [a, b, start, end, time] = [from, to, start, end, time].map(i128::from);
    let expected = a + nearest((b - a) * (time - start), end - start);
    assert_eq!(
        i128::from(found),
        expected,
        "{from} to {to}, {start}..{end} at {time}"
    );
}

/// Tests a spline against its bound, in exact arithmetic; for durations of at most 30 bits.
fn check_cubic(words: [i32; 4], [start, end]: [i32; 2], time: i32) {
    let [from, leaving, entering, to] = words;
    let keys = [0, from, leaving, entering, to, 0];
    let found = turns(Interpolation::Cubic, &[start, end], &keys, time);
    let [from, leaving, entering, to] = words.map(i128::from);
    let [start, end, time] = [start, end, time].map(i128::from);
    let (elapsed, duration) = (time.clamp(start, end) - start, end - start);
    let square = 3 * (to - from) - 2 * leaving - entering;
    let cube = leaving + entering - 2 * (to - from);
    // Over the third power of the duration.
    let way = cube * elapsed.pow(3)
        + square * elapsed.pow(2) * duration
        + leaving * elapsed * duration.pow(2);
    let over = duration.pow(3);
    let lowest = (i128::from(i32::MIN) - from) * over;
    let highest = (i128::from(i32::MAX) - from) * over;
    let error = (i128::from(found) - from) * over - way.clamp(lowest, highest);
    let steepest = leaving.abs() + 2 * square.abs() + 3 * cube.abs();
    let error = error.abs() as f64 / over as f64;
    let bound = 0.5 + f64::powi(2.0, -14) + steepest as f64 * f64::powi(2.0, -33);
    assert!(
        error <= bound,
        "{words:?}, {elapsed} of {duration}: {found} is off by {error}"
    );
}

#[test]
fn lines_are_exact_from_end_to_end_of_values_and_times() {
    for from in ENDS {
        for to in ENDS {
            for (number, start) in ENDS.into_iter().enumerate() {
                for end in ENDS.into_iter().skip(number + 1) {
                    for time in ENDS.into_iter().chain([start.midpoint(end), 12_345]) {
                        check_linear([from, to], [start, end], time);
                    }
                }
            }
        }
    }
}

#[test]
fn splines_are_within_their_bound_at_the_ends_of_their_range() {
    let ends = [i32::MIN, 0, i32::MAX];
    for number in 0..81 {
        let word = |place: u32| ends[number / 3_usize.pow(place) % 3];
        let words = [word(0), word(1), word(2), word(3)];
        for [start, end] in [[i32::MIN, i32::MIN + 1], [-7, 1000], [0, 1 << 30]] {
            for time in [start, start + 1, start.midpoint(end), end - 1, end] {
                check_cubic(words, [start, end], time);
            }
        }
    }
    // A spline without changes passes halfway between its values.
    let [start, end] = [i32::MIN, i32::MAX];
    let keys = [0, -1000, 0, 0, 2000, 0];
    assert_eq!(turns(Interpolation::Cubic, &[start, end], &keys, 0), 500);
}

#[test]
fn before_the_first_and_behind_the_last_key_values_stay() {
    for interpolation in Interpolation::ALL {
        let spline = interpolation == Interpolation::Cubic;
        let words = |values: &[i32]| -> Vec<i32> {
            let key = |value: &i32| {
                if spline {
                    vec![99, *value, 99]
                } else {
                    vec![*value]
                }
            };
            values.iter().flat_map(key).collect()
        };
        let one = words(&[5]);
        let three = words(&[-4, 8, 6]);
        for time in ENDS {
            assert_eq!(turns(interpolation, &[0], &one, time), 5);
        }
        let times = [-10, 0, 10];
        for (time, expected) in [
            (i32::MIN, -4),
            (-11, -4),
            (-10, -4),
            (0, 8),
            (10, 6),
            (11, 6),
            (i32::MAX, 6),
        ] {
            assert_eq!(turns(interpolation, &times, &three, time), expected);
        }
    }
    assert_eq!(turns(Interpolation::Step, &[0, 10], &[3, 4], 9), 3);
    assert_eq!(turns(Interpolation::Linear, &[0, 10], &[3, 4], 5), 4);
}

#[test]
fn any_of_65535_keys_is_found() {
    let times: Vec<i32> = (0..65_535).map(|key| 3 * key - 100_000).collect();
    let words: Vec<i32> = times.iter().map(|time| time.wrapping_mul(77_777)).collect();
    for (key, &time) in times.iter().enumerate() {
        for (interpolation, behind) in [(Interpolation::Step, 2), (Interpolation::Linear, 0)] {
            let found = turns(interpolation, &times, &words, time + behind);
            assert_eq!(found, words[key]);
        }
    }
}

/// The middle of a spline between two values, with these changes.
fn middle(target: TrackTarget, changes: [i32; 2], values: [i32; 2]) -> i32 {
    let components = target.kind().components();
    let ([leaving, entering], [from, to]) = (changes, values);
    let groups = [0, from, leaving, entering, to, 0];
    let words: Vec<i32> = groups.iter().flat_map(|it| vec![*it; components]).collect();
    match components {
        1 => value::<1>(target, Interpolation::Cubic, &[0, 2], &words, 1)[0],
        4 => value::<4>(target, Interpolation::Cubic, &[0, 2], &words, 1)[0],
        _ => value::<3>(target, Interpolation::Cubic, &[0, 2], &words, 1)[0],
    }
}

#[test]
fn splines_of_colors_and_angles_stay_in_their_range() {
    let one = 1 << 30;
    for (target, [low, high]) in [
        (TrackTarget::LightColor, [0, i32::MAX]),
        (TrackTarget::MaterialMirror, [0, one]),
        (TrackTarget::CameraFieldOfView, [2, i32::MAX]),
        // A quaternion can be longer than 1 on its way.
        (TrackTarget::CameraRotation, [i32::MIN, i32::MAX]),
        (TrackTarget::CameraEye, [i32::MIN, i32::MAX]),
    ] {
        let up = middle(target, [i32::MAX, i32::MIN], [high, high]);
        let down = middle(target, [i32::MIN, i32::MAX], [low, low]);
        assert_eq!([down, up], [low, high], "{target:?}");
    }
    let rotation = TrackTarget::CameraRotation;
    assert_eq!(middle(rotation, [one, -one], [one, one]), one + one / 4);
}

/// Between opposite quaternions, whose changes are 0, a spline passes through 0.
#[test]
fn splines_through_a_quaternion_without_a_length_keep_the_earlier_key() {
    let key = [0, 0, 759_250_125, 759_250_125];
    let opposite = key.map(|it: i32| -it);
    let words = [[0; 4], key, [0; 4], [0; 4], opposite, [0; 4]].concat();
    for target in [TrackTarget::CameraRotation, TrackTarget::JointRotation] {
        let at = |time| value::<4>(target, Interpolation::Cubic, &[0, 10], &words, time);
        assert_eq!(at(5), key);
        assert!(at(4) != key && at(6) != key);
    }
}

/// Spherical interpolation in doubles, of quaternions of length 1.
fn slerp(from: [f64; 4], to: [f64; 4], part: f64) -> [f64; 4] {
    let dot: f64 = (0..4).map(|k| from[k] * to[k]).sum();
    let angle = libm::acos(dot.clamp(-1.0, 1.0));
    let sine = libm::sin(angle);
    if sine == 0.0 {
        return from;
    }
    let [one, other] = [libm::sin((1.0 - part) * angle), libm::sin(part * angle)];
    core::array::from_fn(|k| (one * from[k] + other * to[k]) / sine)
}

fn normalized(quaternion: [f64; 4]) -> [f64; 4] {
    let length = libm::sqrt(quaternion.iter().map(|it| it * it).sum());
    quaternion.map(|it| it / length)
}

fn check_rotation(from: [f64; 4], to: [f64; 4], part: u32) {
    let from = normalized(from);
    let to = normalized(to);
    let dot: f64 = (0..4).map(|k| from[k] * to[k]).sum();
    let to = if dot < 0.0 { to.map(|it| -it) } else { to };
    let angle = libm::acos(dot.abs().min(1.0)) / core::f64::consts::TAU * 4_294_967_296.0;
    let words =
        |quaternion: [f64; 4]| quaternion.map(|it| libm::round(it * 1_073_741_824.0) as i32);
    let mut keys: Vec<i32> = words(from).to_vec();
    keys.push(libm::round(angle) as i32);
    keys.extend(words(to));
    keys.push(0);
    let times = [0, 1_000_000];
    let found: [i32; 4] = value(
        TrackTarget::CameraRotation,
        Interpolation::Linear,
        &times,
        &keys,
        part as i32,
    );
    let found = normalized(found.map(f64::from));
    let expected = slerp(from, to, f64::from(part) / 1e6);
    for (found, expected) in found.iter().zip(expected) {
        let bound = f64::powi(2.0, -27);
        assert!(
            (found - expected).abs() <= bound,
            "{from:?} to {to:?} at {part}: {found}, not {expected}"
        );
    }
}

#[test]
fn rotations_turn_evenly() {
    let axis = [1.0, 2.0, 3.0];
    for degrees in [1e-6, 1e-3, 0.1, 1.0, 45.0, 90.0, 179.0, 180.0] {
        let half: f64 = degrees / 360.0 * core::f64::consts::PI;
        let length = libm::sqrt(14.0);
        let [x, y, z] = axis.map(|it: f64| it / length * libm::sin(half));
        for part in [1, 1000, 250_000, 500_000, 999_999] {
            check_rotation([0.0, 0.0, 0.0, 1.0], [x, y, z, libm::cos(half)], part);
        }
    }
    // The same rotation twice.
    check_rotation([1.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], 500_000);
}

proptest! {
    #[test]
    fn lines_are_the_nearest_numbers(values: [i32; 2], times: [i32; 2], time: i32) {
        prop_assume!(times[0] != times[1]);
        let times = [times[0].min(times[1]), times[0].max(times[1])];
        check_linear(values, times, time);
        check_linear(values, times, times[0].midpoint(times[1]));
    }

    #[test]
    fn splines_are_within_their_bound(words: [i32; 4], start in -1_000_000_000..0, duration in 1..1 << 30, part: u32) {
        let passed = (u64::from(part) * duration as u64) >> 32;
        check_cubic(words, [start, start + duration], start + passed as i32);
        let small = words.map(|word| word >> 12);
        check_cubic(small, [start, start + duration], start + passed as i32);
    }

    #[test]
    fn rotations_are_those_of_spherical_interpolation(
        from: [i16; 4],
        to: [i16; 4],
        part in 1_u32..1_000_000,
    ) {
        prop_assume!(from != [0; 4] && to != [0; 4]);
        check_rotation(from.map(f64::from), to.map(f64::from), part);
    }
}
