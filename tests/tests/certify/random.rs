//! Random points, and directions that are drawn by them.

use super::numbers::{fraction, mixed, one};
use gridel_core::Angle;
use gridel_host::shape::exact::{Real, Vector};

/// A coordinate of a random point, from 0 to 1: its upper 30 bits.
pub fn part(coordinate: u32) -> Real {
    fraction(coordinate >> 2, 30)
}

/// Sine and cosine of a random part of a turn.
pub fn turn(coordinate: u32) -> [Real; 2] {
    Angle(coordinate).sin_cos().map(|x| fraction(x, 30))
}

/// Two directions perpendicular to one of length 1, and to each other.
pub fn beside([x, y, z]: &Vector) -> [Vector; 2] {
    let is_in_cap = (z + fraction(255, 8)).is_negative();
    let signed = |value: Real| if is_in_cap { -value } else { value };
    let scale = -(one() / (one() + signed(z.clone())));
    let across = x * y * &scale;
    [
        [one() + x * x * &scale, across.clone(), signed(-x)],
        [signed(across), signed(one() + y * y * &scale), -y],
    ]
}

/// A direction on the hemisphere around another one, drawn in proportion to the cosine.
pub fn around(normal: &Vector, [u, v]: [u32; 2]) -> Vector {
    let square = part(u);
    let (away, toward) = (square.sqrt(), (one() - &square).sqrt());
    let [sine, cosine] = turn(v);
    let [first, second] = beside(normal);
    mixed(
        [&first, &second, normal],
        [&(&away * cosine), &(&away * sine), &toward],
    )
}
