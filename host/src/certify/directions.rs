//! Random points as ratios and directions. The points are integers, and so are sines and cosines: all of them exact.

use super::number::*;
use gridel_core::Angle;
use std::cmp::Ordering;

/// Returns a coordinate of a point with 32 fraction bits as a ratio; 30 of the bits count.
pub fn ratio<N: Enclosure>(coordinate: u32) -> N {
    N::scaled((coordinate >> 2).into(), 30)
}

/// Returns the sine and the cosine of a turn, given by a coordinate.
pub fn turn<N: Enclosure>(coordinate: u32) -> [N; 2] {
    Angle(coordinate).sin_cos().map(ratio_of)
}

/// Returns two directions that are perpendicular to one of length 1 and to each other; `None` where they are open.
pub fn perpendiculars<N: Enclosure>([x, y, z]: Three<N>) -> Option<[Three<N>; 2]> {
    let one = N::one();
    // The kernels' `CAP`.
    let is_in_cap = (z + N::scaled(255, 8)).sign()? == Ordering::Less;
    let signed = |value: N| if is_in_cap { -value } else { value };
    let scale = -one.div(one + signed(z))?;
    let mixed = x * y * scale;
    Some([
        [one + x.square() * scale, mixed, signed(-x)],
        [signed(mixed), signed(one + y.square() * scale), -y],
    ])
}

/// Returns a direction with given parts along an axis of length 1, and along two others.
pub fn combined<N: Enclosure>(
    axis: Three<N>,
    along: N,
    [first, second]: [Three<N>; 2],
    [right, up]: [N; 2],
) -> Three<N> {
    [0, 1, 2].map(|k| axis[k] * along + first[k] * right + second[k] * up)
}

/// Returns a direction around a normal, more often the nearer to it, by the cosine.
pub fn around<N: Enclosure>(normal: Three<N>, [u, v]: [u32; 2]) -> Option<Three<N>> {
    let square = ratio::<N>(u);
    let (away, toward) = (square.sqrt(), (N::one() - square).sqrt());
    let [sine, cosine] = turn::<N>(v);
    let sides = perpendiculars(normal)?;
    Some(combined(
        normal,
        toward,
        sides,
        [away * cosine, away * sine],
    ))
}
