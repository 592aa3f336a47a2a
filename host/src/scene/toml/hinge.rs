//! Rotations by angles about one axis, as keys of quaternions.
//!
//! The way between two quaternions is less than half a turn, and that of an angle has any number of turns. So keys are
//! added between those of the file. On the way of a linear track they are exact, on that of a spline within
//! [`TOLERANCE`].

use crate::scene::{Interpolation, Key, TICKS_PER_SECOND};
use crate::shape::unit;
use glam::DVec3;

/// Most keys that one track of angles becomes.
const MOST_KEYS: usize = 65_536;

/// Degrees from a key to the next one of a linear track.
const LINEAR_STEP: f64 = 90.0;

/// Largest distance of a spline of quaternions from that of the angles, in radians.
const TOLERANCE: f64 = 2e-5;

/// Degrees that are certainly less than half a turn.
const MOST_DEGREES: f64 = 150.0;

/// Keys of rotations about an axis, given keys of angles in degrees and their changes.
///
/// # Errors
/// If that takes too many keys, or too fast a turn: cause and remedy.
pub(super) fn rotations(
    axis: DVec3,
    interpolation: Interpolation,
    keys: &[Key],
) -> Result<Vec<Key>, (String, &'static str)> {
    let axis = unit(axis);
    let mut all: Vec<Key> = Vec::new();
    let Some(first) = keys.first() else {
        return Ok(all);
    };
    let mut last = first.value[0];
    all.push(rotation(axis, first.seconds, last, [0.0; 2]));
    for pair in keys.windows(2) {
        let segment = Segment::of(interpolation, &pair[0], &pair[1]);
        let pieces = segment.pieces;
        if all.len() as f64 + pieces > MOST_KEYS as f64 {
            let cause = format!("the track turns so far that it takes more than {MOST_KEYS} keys");
            return Err((cause, "use fewer turns"));
        }
        if let Some(key) = all.last_mut() {
            key.leaving = tangent(axis, last, segment.slope(0.0));
        }
        let [from, to] = [&pair[0], &pair[1]].map(|key| tick(key.seconds));
        let pieces = pieces as u32;
        let mut before = from;
        for piece in 1..=pieces {
            let part = f64::from(piece) / f64::from(pieces);
            let time = (from + (to - from) * part).round();
            let is_last = piece == pieces;
            if !is_last && (time <= before || time >= to) {
                continue;
            }
            let (seconds, part, angle) = match is_last {
                true => (pair[1].seconds, 1.0, pair[1].value[0]),
                false => {
                    let seconds = time / f64::from(TICKS_PER_SECOND);
                    let part = (seconds - pair[0].seconds) / segment.duration;
                    let part = part.clamp(0.0, 1.0);
                    (seconds, part, segment.angle(part))
                }
            };
            if interpolation != Interpolation::Step && (angle - last).abs() > MOST_DEGREES {
                let cause = format!("the track turns too fast at {seconds} s");
                return Err((cause, "use smaller angles, or more time between them"));
            }
            (before, last) = (time, angle);
            let slope = segment.slope(part);
            all.push(rotation(axis, seconds, angle, [slope, slope]));
        }
    }
    Ok(all)
}

/// Turns quaternions to those of the same rotations that are nearest to the ones before.
pub(super) fn on_one_side(keys: &mut [Key]) {
    for number in 1..keys.len() {
        let before = keys[number - 1].value;
        let value = &mut keys[number].value;
        let product: f64 = before.iter().zip(*value).map(|(a, b)| a * b).sum();
        if product < 0.0 {
            *value = value.map(|it| -it);
        }
    }
}

/// The nearest tick to a time.
fn tick(seconds: f64) -> f64 {
    (seconds * f64::from(TICKS_PER_SECOND)).round()
}

/// Angles from a key to the next one: a polynomial of the part of the time that has passed.
struct Segment {
    duration: f64,
    /// The coefficients by rising powers.
    angles: [f64; 4],
    /// Number of keys that follow the first one.
    pieces: f64,
    interpolation: Interpolation,
}

impl Segment {
    fn of(interpolation: Interpolation, from: &Key, to: &Key) -> Self {
        let duration = to.seconds - from.seconds;
        let (start, change) = (from.value[0], to.value[0] - from.value[0]);
        let leaving = from.leaving[0] * duration;
        let entering = to.entering[0] * duration;
        let (angles, pieces) = match interpolation {
            Interpolation::Step => ([start, 0.0, 0.0, 0.0], 1.0),
            Interpolation::Linear => (
                [start, change, 0.0, 0.0],
                (change.abs() / LINEAR_STEP).ceil(),
            ),
            Interpolation::Cubic => {
                let square = 3.0 * change - 2.0 * leaving - entering;
                let cube = leaving + entering - 2.0 * change;
                // From control point to control point of the Bézier curve.
                let middle = change - (leaving + entering) / 3.0;
                let pieces = spline_pieces([leaving / 3.0, middle, entering / 3.0]);
                ([start, leaving, square, cube], pieces)
            }
        };
        Self {
            duration,
            angles,
            pieces: pieces.max(1.0),
            interpolation,
        }
    }

    fn angle(&self, part: f64) -> f64 {
        let [start, line, square, cube] = self.angles;
        start + part * (line + part * (square + part * cube))
    }

    /// The change per second.
    fn slope(&self, part: f64) -> f64 {
        let [_, line, square, cube] = self.angles;
        match self.interpolation {
            Interpolation::Cubic => {
                (line + part * (2.0 * square + part * 3.0 * cube)) / self.duration
            }
            _ => 0.0,
        }
    }
}

/// Returns the number of pieces into which a spline of angles is cut. Splines of quaternions replace it. `legs` are the
/// differences between its control points in degrees.
///
/// The error of a cubic Hermite spline is at most 1/384 of the fourth derivative, here that of (sin, cos) of half the
/// angle. With `n` pieces that is at most `(v^4 + 6 v^2 a + 3 a^2 + 4 v j) / n^4`, for bounds of the half's
/// derivatives.
fn spline_pieces(legs: [f64; 3]) -> f64 {
    let [first, middle, last] = legs.map(|leg| leg.to_radians() / 2.0);
    let speed = 3.0 * first.abs().max(middle.abs()).max(last.abs());
    let (from, to) = (middle - first, last - middle);
    let acceleration = 6.0 * from.abs().max(to.abs());
    let jerk = 6.0 * (to - from).abs();
    let square = speed * speed;
    let fourth = square * square
        + 6.0 * square * acceleration
        + 3.0 * acceleration * acceleration
        + 4.0 * speed * jerk;
    (fourth / (384.0 * TOLERANCE)).sqrt().sqrt().ceil()
}

/// Sine and cosine of half an angle in degrees; of a quaternion two turns are one.
fn half(degrees: f64) -> (f64, f64) {
    // libm, because the standard library's sines differ from one machine to another.
    libm::sincos((degrees.rem_euclid(720.0) / 2.0).to_radians())
}

/// The key of an angle, with its changes before and behind.
fn rotation(axis: DVec3, seconds: f64, degrees: f64, [entering, leaving]: [f64; 2]) -> Key {
    let (sine, cosine) = half(degrees);
    let [x, y, z] = (axis * sine).to_array();
    Key {
        seconds,
        value: [x, y, z, cosine],
        entering: tangent(axis, degrees, entering),
        leaving: tangent(axis, degrees, leaving),
    }
}

/// The change per second of the quaternion of an angle.
fn tangent(axis: DVec3, degrees: f64, per_second: f64) -> [f64; 4] {
    let (sine, cosine) = half(degrees);
    let half_speed = per_second.to_radians() / 2.0;
    let [x, y, z] = (axis * (cosine * half_speed)).to_array();
    [x, y, z, -sine * half_speed]
}
