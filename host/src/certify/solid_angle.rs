//! Points of lights drawn by solid angle, as the core draws them.

use super::directions;
use super::number::*;
use gridel_core::format::light_form::LightForm;

/// A point of a light, and the light that it brings.
#[derive(Clone, Copy, Debug)]
pub struct Drawn<N> {
    /// The way to it.
    pub way: Three<N>,
    pub share: Share<N>,
}

/// The light at a distance, times twice a ratio.
#[derive(Clone, Copy, Debug)]
pub struct Share<N> {
    pub distance: N,
    pub half: N,
}

/// The ratio of a circle's circumference to its diameter, between sums of two floats.
pub fn pi<N: Enclosure>() -> N {
    const REST: f64 = 1.224_646_799_147_353_2e-16;
    let rest = N::float(REST).hull(N::float(REST.next_up()));
    N::float(std::f64::consts::PI) + rest
}

/// Converts a length with 13 fraction bits of a unit, which are 5 fraction bits of a step.
pub fn length<N: Enclosure>(q13: i64) -> N {
    N::scaled(q13, 5)
}

/// Returns the way to where a random direction meets a sphere from outside of it; `None` where the way is open.
pub fn of_sphere<N: Enclosure>(radius: N, way: Three<N>, [u, v]: [u32; 2]) -> Option<Drawn<N>> {
    let one = N::one();
    let distance = norm2(way).sqrt();
    let axis = unit(way)?;
    let widest = radius.div(distance)?;
    let square = widest.square();
    let half = one.div(one + (one - square).sqrt())?;
    // 1 - cos of the direction's angle, of up to that of the cone's.
    let sag = square * half * directions::ratio(u);
    let away = (sag + (sag - sag.square())).sqrt().at_most(widest);
    let toward = one - sag;
    let [sine, cosine] = directions::turn::<N>(v);
    let sides = directions::perpendiculars(axis)?;
    let direction = directions::combined(axis, toward, sides, [away * cosine, away * sine]);
    // From the middle of the chord to the surface.
    let part = away.div(widest)?.at_most(one);
    let inward = radius * (one - part.square()).sqrt();
    Some(Drawn {
        way: scale(direction, distance * toward - inward),
        share: Share { distance, half },
    })
}

/// Returns the way to a random point of a rectangle, triangle or disc; `Some(None)` from behind, and `None` where it is
/// open.
pub fn of_flat<N: Enclosure>(
    form: &LightForm,
    way: Three<N>,
    [u, v]: [u32; 2],
) -> Option<Option<Drawn<N>>> {
    let one = N::one();
    let [first, second] = form.edges.map(|edge| edge.map(|it| length::<N>(it.into())));
    let normal = form.normal.map(ratio_of);
    let (along, side) = (unit(first)?, norm2(first).sqrt());
    let across = cross(normal, along);
    let (height, depth) = (-dot(normal, way), dot(across, second));
    if !positive(height)? || !positive(depth)? {
        return Some(None);
    }
    let from = dot(across, way);
    let near = match form.shape {
        LightForm::DISC => from - side,
        _ => from,
    };
    let far = from + depth;
    let away_from = |row: N| (height.square() + row.square()).sqrt();

    // Rows by the tangent of half their angle.
    let half_tangent = |row: N| row.div(height + away_from(row));
    let nearest = half_tangent(near)?;
    let turn = half_tangent(far)? - nearest;
    let tangent = nearest + turn * directions::ratio(u);
    let narrowing = one.div(one + tangent.square())?;
    let row = height * (tangent + tangent).div(one - tangent.square())?;
    let row = row.at_least(near).at_most(far);

    // Points of a row by the sine of theirs.
    let place = (row - from).div(depth)?;
    let middle = dot(along, way);
    let start = middle + dot(along, second) * place;
    let [left, right] = match form.shape {
        LightForm::DISC => {
            let chord = side * (one - place.square()).at_least(N::zero()).sqrt();
            [middle - chord, middle + chord]
        }
        LightForm::TRIANGLE => [start, start + side * (one - place)],
        _ => [start, start + side],
    };
    let away = away_from(row);
    let sine_of = |end: N| end.div((end.square() + away.square()).sqrt());
    let leftmost = sine_of(left)?;
    let width = sine_of(right)? - leftmost;
    let sine = leftmost + width * directions::ratio(v);
    let cosine = (one - sine.square()).at_least(N::zero()).sqrt();
    let place = (away * sine).div(cosine)?.at_least(left).at_most(right);

    let area = side * depth;
    let area = match form.shape {
        LightForm::DISC => area * pi(),
        LightForm::TRIANGLE => area.half(),
        _ => area,
    };
    Some(Some(Drawn {
        way: [0, 1, 2].map(|k| along[k] * place + across[k] * row - normal[k] * height),
        share: Share {
            distance: area.sqrt().half(),
            half: turn.half() * narrowing * width.half(),
        },
    }))
}

#[cfg(test)]
mod tests {
    use super::super::deep::{Ball, with_bits};
    use super::super::interval::Interval;
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn pi_lies_above_its_float() {
        let Interval { low, high } = pi();
        assert_eq!([low, high], [PI, PI.next_up()]);
        with_bits(128, || {
            let rest = pi::<Ball>() - Ball::float(PI);
            let [low, high] = rest.bounds();
            // The digits of pi after those of the float.
            assert!(low > 1.224_646_799_147_3e-16 && high < 1.224_646_799_147_4e-16);
            assert!(rest.radius() < 1e-31);
        });
    }
}
