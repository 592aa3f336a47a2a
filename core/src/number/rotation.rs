//! Rotations in integers.

use crate::number::fixed::base::RATIO_BITS;
use crate::number::{Angle, Fixed, Scalar, Vectors};

/// Returns the matrix of a quaternion of any length, x, y, z and w, as ratios: its columns are the turned axes. `None`
/// if the quaternion has no length.
pub(crate) fn columns(rotation: [i32; 4]) -> Option<[[Fixed; 3]; 3]> {
    let [x, y, z, w] = unit_quaternion(rotation)?;
    let half = Fixed(1 << (RATIO_BITS - 1));
    let twice = |a: Fixed, b: Fixed| {
        let product = a * b;
        product + product
    };
    // Doubled last: after half a turn the sum of both squares is 1, and twice that is out of a ratio's range.
    let diagonal = |a: Fixed, b: Fixed| {
        let halved = half - a * a - b * b;
        halved + halved
    };
    Some([
        [
            diagonal(y, z),
            twice(x, y) + twice(z, w),
            twice(x, z) - twice(y, w),
        ],
        [
            twice(x, y) - twice(z, w),
            diagonal(x, z),
            twice(y, z) + twice(x, w),
        ],
        [
            twice(x, z) + twice(y, w),
            twice(y, z) - twice(x, w),
            diagonal(x, y),
        ],
    ])
}

/// Returns the quaternion that turns about an axis of any length, counterclockwise as seen from its tip; `None` if the
/// axis has no length.
pub(crate) fn about(axis: [i32; 3], angle: Angle) -> Option<[i32; 4]> {
    let (axis, length) = Fixed::normalize(Fixed::direction(axis.map(i64::from)));
    if length == Fixed::ZERO {
        return None;
    }
    let [sine, cosine] = Angle(angle.0 >> 1).sin_cos().map(Fixed);
    let [x, y, z] = axis.map(|x| (x * sine).0);
    Some([x, y, z, cosine.0])
}

/// Returns the quaternion at length 1, as ratios; `None` if it has no length.
fn unit_quaternion(rotation: [i32; 4]) -> Option<[Fixed; 4]> {
    let all = rotation.iter().fold(0, |all, x| all | x.unsigned_abs());
    // 29 bits each, so that the length of three has no more than 30.
    let scaled = rotation.map(|x| {
        let up = i64::from(x).wrapping_shl(all.leading_zeros());
        Fixed((up >> 3) as i32)
    });
    let [x, y, z, w] = scaled;
    let (axis, sine) = Fixed::normalize([x, y, z]);
    let ([sine, cosine, _], length) = Fixed::normalize([sine, w, Fixed::ZERO]);
    let [x, y, z] = axis.map(|x| x * sine);
    (length > Fixed::ZERO).then_some([x, y, z, cosine])
}
