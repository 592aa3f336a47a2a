//! The rules of effects, in exact arithmetic.

use super::crossing::exact;
use super::hit::{Hit, Seen};
use super::media::Interface;
use super::number::*;
use super::world::{Form, World};
use gridel_core::format::record::Material;
use gridel_core::geometry::smooth::LARGEST;
use std::cmp::Ordering;

/// Returns the part of light that is left after a length of glass, in lattice steps.
pub fn absorbed<N: Enclosure>(material: &Material, length: N) -> Three<N> {
    // Coefficients have 32 fraction bits, less the shift, and count units of 256 steps.
    let bits = 40 - material.absorption_shift();
    material
        .absorption
        .map(|coefficient| (length * N::scaled(coefficient.into(), bits)).exp_neg())
}

/// Returns whether a point lies in an odd cell, looked up just beneath the surface; `None` if that is open.
pub fn is_odd<N: Enclosure>(hit: &Hit<N>, material: &Material) -> Option<bool> {
    let size = N::scaled(material.checker_size.into(), 5);
    let mut is_odd = false;
    for k in 0..3 {
        let place = hit.point[k] - N::scaled(material.checker_origin[k].into(), 5);
        let cell = (place.middle() / size.middle()).floor();
        // The nearest boundary may be the cell's lower or its upper one.
        let mut cell = N::float(cell);
        let mut number = cell.middle() as i64;
        match (place - cell * size).sign()? {
            Ordering::Less => {
                cell = cell - N::one();
                number -= 1;
                if (place - cell * size).sign()? != Ordering::Greater {
                    return None;
                }
            }
            // Exactly between two cells, the normal decides which cell is beneath.
            Ordering::Equal => {
                if hit.normal[k].sign()? == Ordering::Greater {
                    number -= 1;
                }
            }
            Ordering::Greater => {
                let above = (place - (cell + N::one()) * size).sign()?;
                if above == Ordering::Greater {
                    return None;
                }
                if above == Ordering::Equal && hit.normal[k].sign()? != Ordering::Greater {
                    number += 1;
                }
            }
        }
        is_odd ^= number & 1 == 1;
    }
    Some(is_odd)
}

/// A ray of length 1 at a glass surface.
pub struct Split<N> {
    /// The part that is reflected.
    pub reflected: N,
    /// The direction of the rest; `None` where all is reflected.
    pub refracted: Option<Three<N>>,
    /// True if it cannot be decided whether all is reflected.
    pub is_open: bool,
}

/// The reflected part, by Fresnel's equations.
fn fresnel<N: Enclosure>(k: N, cos_in: N, cos_out: N) -> N {
    let whole = N::zero().hull(N::one());
    let part = |a: N, b: N| match (a - b).div(a + b) {
        Some(amplitude) => within(amplitude.square(), whole),
        // Both may be 0 where the surface is seen edge on.
        None => whole,
    };
    (part(k * cos_in, cos_out).half() + part(cos_in, k * cos_out).half()).at_most(N::one())
}

/// Returns `whole` if it lies within the number's bounds, else the number, which is known to lie in `whole`.
fn within<N: Enclosure>(number: N, whole: N) -> N {
    let ([low, high], [least, most]) = (number.bounds(), whole.bounds());
    if low < least && high > most {
        whole
    } else {
        number
    }
}

/// The square of the sine for a cosine.
fn sine_squared<N: Enclosure>(cos: N) -> N {
    (N::one() - cos.square()).at_least(N::zero())
}

/// Splits a ray of length 1 at a surface by Snell's law.
pub fn split<N: Enclosure>(
    interface: &Interface<N>,
    direction: Three<N>,
    normal: Three<N>,
    cos_in: N,
) -> Option<Split<N>> {
    let &Interface { k, to_denser } = interface;
    if !interface.is_bending() {
        return Some(Split {
            reflected: N::zero(),
            refracted: Some(direction),
            is_open: false,
        });
    }
    let sine = sine_squared(cos_in);
    let mut is_open = false;
    let (cos_out, scaled, lift);
    if to_denser {
        cos_out = (N::one() - k.square() * sine).sqrt();
        (scaled, lift) = (k, k * cos_in - cos_out);
    } else {
        let total = k.square() - sine;
        match positive(total) {
            Some(false) => {
                return Some(Split {
                    reflected: N::one(),
                    refracted: None,
                    is_open: false,
                });
            }
            Some(true) => {}
            None => is_open = true,
        }
        cos_out = total.div(k.square())?.sqrt();
        (scaled, lift) = (N::one(), cos_in - k * cos_out);
    }
    let mut reflected = fresnel(k, cos_in, cos_out);
    if is_open {
        reflected = reflected.hull(N::one());
    }
    Some(Split {
        reflected,
        refracted: Some([0, 1, 2].map(|i| scaled * direction[i] + lift * normal[i])),
        is_open,
    })
}

/// Returns the weight of what glass reflects of a ray, in all channels.
pub fn mirrored<N: Enclosure>(material: &Material, reflected: N) -> N {
    let [red, green, blue] = material.transmit;
    ratio_of::<N>(red.max(green).max(blue)) * reflected
}

/// Returns the part of light that passes a surface straight on, for shadows.
pub fn filtered<N: Enclosure>(
    hit: &Hit<N>,
    material: &Material,
    k: N,
    to_light: Three<N>,
) -> Option<Three<N>> {
    let transmit = material.transmit.map(ratio_of);
    if (k - N::one()).sign() == Some(Ordering::Equal) {
        return Some(transmit);
    }
    let cos = dot(hit.normal, to_light).abs().at_most(N::one());
    let cos_out = (N::one() - k.square() * sine_squared(cos)).sqrt();
    let passed = N::one() - fresnel(k, cos, cos_out);
    Some(scale(transmit, passed))
}

/// Adds the highlight of a light to the reflected light of a surface.
pub fn highlight<N: Enclosure>(
    seen: &Seen<'_, N>,
    to_light: Three<N>,
    reflected: Three<N>,
) -> Option<Three<N>> {
    let halfway = unit([0, 1, 2].map(|k| to_light[k].half() - seen.direction[k].half()))?;
    let cos = dot(seen.normal, halfway).at_least(N::zero());
    let mut power = N::one();
    let (mut square, mut rest) = (cos.at_most(N::one()), seen.material.exponent());
    while rest > 0 {
        if rest & 1 == 1 {
            power = power * square;
        }
        square = square.square();
        rest >>= 1;
    }
    let highlight = seen.material.highlight.map(|x| ratio_of::<N>(x) * power);
    Some([0, 1, 2].map(|k| (reflected[k] + highlight[k]).at_most(N::one())))
}

/// Returns a smooth normal, turned until it is level with a ray of length 1 that meets it from behind.
pub fn turned_to_ray<N: Enclosure>(normal: Three<N>, direction: Three<N>) -> Option<Three<N>> {
    let behind = dot(normal, direction);
    match behind.sign() {
        Some(Ordering::Less) => Some(normal),
        // Where it is open on which side, this holds both outcomes.
        _ => unit(along(normal, -behind.at_least(N::zero()), direction)),
    }
}

/// The coordinates of a stored normal.
fn unfolded([x, y]: [i16; 2]) -> [i64; 3] {
    let (x, y, largest) = (i64::from(x), i64::from(y), i64::from(LARGEST));
    let z = largest - x.abs() - y.abs();
    let signed = |rest: i64, of: i64| if of < 0 { -rest } else { rest };
    if z < 0 {
        [
            signed(largest - y.abs(), x),
            signed(largest - x.abs(), y),
            z,
        ]
    } else {
        [x, y, z]
    }
}

/// Returns a corner's normal for interpolation: nearly of length 1, by the line and the step that define its length.
fn corner_normal<N: Enclosure>(stored: [i16; 2]) -> Three<N> {
    let v = unfolded(stored).map(|x| N::scaled(x, 15));
    let square = norm2(v);
    let root = N::scaled(2_128_961_606, 30) - N::scaled(1_114_232_640, 30) * square;
    let step = N::scaled(3, 1) - (square * root.square()).half();
    scale(v, root * step)
}

/// The triangle of a hit that has normals, and the point in its space; `Some(None)` for a surface without them.
///
/// The outer `None` means that the bounds are too wide.
fn smooth<N: Enclosure>(world: &World<'_>, hit: &Hit<N>) -> Option<Option<Smooth<N>>> {
    let solid = &world.space(hit.instance).solids[hit.solid as usize];
    let Form::Triangle {
        corners,
        normal,
        smooth: Some(normals),
    } = solid.form
    else {
        return Some(None);
    };
    let (point, weights) = weights(world, hit, corners, normal)?;
    Some(Some(Smooth {
        corners,
        normals,
        point,
        weights,
    }))
}

/// Returns the point of a hit of a triangle in the triangle's space, and the weights of the corners there, whose sum is
/// 1.
pub fn weights<N: Enclosure>(
    world: &World<'_>,
    hit: &Hit<N>,
    corners: [[i64; 3]; 3],
    normal: [i64; 3],
) -> Option<(Three<N>, Three<N>)> {
    let placed = world.placed.get(hit.instance as usize);
    let point = placed.map_or(hit.point, |placed| placed.point(hit.point));
    // Weights are areas, projected along the largest component of the normal.
    let size = normal.map(i64::abs);
    let (i, j, across) = if size[0] >= size[1] && size[0] >= size[2] {
        (1, 2, normal[0])
    } else if size[1] >= size[2] {
        (2, 0, normal[1])
    } else {
        (0, 1, normal[2])
    };
    let seen = corners.map(|corner| [N::int(corner[i]) - point[i], N::int(corner[j]) - point[j]]);
    let area = |p: [N; 2], q: [N; 2]| p[0] * q[1] - p[1] * q[0];
    let [a, b, c] = seen;
    let areas = [area(b, c), area(c, a), area(a, b)];
    let mut weights = [N::zero(); 3];
    for (weight, area) in weights.iter_mut().zip(areas) {
        *weight = area.div(N::int(across))?;
    }
    Some((point, weights))
}

/// Returns the interpolated normal on the side of the ray; `None` if the surface is not smooth.
///
/// `None` outside where the normals may cancel out.
pub fn smooth_normal<N: Enclosure>(world: &World<'_>, hit: &Hit<N>) -> Option<Option<Three<N>>> {
    let Some(smooth) = smooth(world, hit)? else {
        return Some(None);
    };
    let mut sum = [N::zero(); 3];
    for (stored, weight) in smooth.normals.into_iter().zip(smooth.weights) {
        sum = along(sum, weight, corner_normal(stored));
    }
    let mut normal = unit(sum)?;
    if let Some(placed) = world.placed.get(hit.instance as usize) {
        normal = unit(placed.normal(normal))?;
    }
    Some(Some(if hit.front { normal } else { opposite(normal) }))
}

/// Returns the way from a hit out to the curved surface of its triangle, and whether that lies above it.
pub fn lift<N: Enclosure>(world: &World<'_>, hit: &Hit<N>) -> Option<(Option<bool>, Three<N>)> {
    let nowhere = [N::zero(); 3];
    let Some(smooth) = smooth(world, hit)? else {
        return Some((Some(false), nowhere));
    };
    let mut way = nowhere;
    for k in 0..3 {
        let stored = exact::<N>(unfolded(smooth.normals[k]));
        let mut normal = unit(stored)?;
        if !hit.front {
            normal = opposite(normal);
        }
        let below = minus(exact(smooth.corners[k]), smooth.point);
        let depth = dot(below, normal).at_least(N::zero());
        way = along(way, depth * smooth.weights[k].at_least(N::zero()), normal);
    }
    let facing = hit.facing();
    if let Some(placed) = world.placed.get(hit.instance as usize) {
        if way.iter().all(|x| x.bounds() == [0.0, 0.0]) {
            return Some((Some(false), nowhere));
        }
        // The transposed matrix is used as the inverse, as in the kernels.
        let length = norm2(way).sqrt();
        let direction = unit(way)?;
        let mapped = placed.normal(direction);
        let stretch = norm2(mapped).sqrt();
        let mapped = unit(mapped)?;
        way = scale(mapped, length.div(stretch)?);
    }
    Some((positive(dot(way, facing)), way))
}

/// A triangle with normals at a hit, in its own space.
struct Smooth<N> {
    corners: [[i64; 3]; 3],
    normals: [[i16; 2]; 3],
    point: Three<N>,
    /// Weights of the corners; their sum is 1.
    weights: Three<N>,
}
