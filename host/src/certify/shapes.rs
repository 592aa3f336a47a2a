//! Crossings of rays with primitives, and the surface there, by the formulas that define the shapes.
//!
//! Solids are closed. A ray from a surface starts exactly on it. The t of its start is excluded by what is known of the
//! start, not by a comparison. A free start may lie on a surface by chance: it meets that surface at t = 0.

use super::cone;
use super::crossing::{
    APEX, BASE, Crossing, Grazes, MANTLE, Ray, Start, axis_of, compare, exact, flat_normal,
};
use super::number::*;
use super::torus;
use super::world::{Form, NONE, PlacedPart, Solid};
use std::cmp::Ordering;

impl PlacedPart {
    /// A power of two and the matrix of integers.
    fn rotate<N: Enclosure>(&self, v: Three<N>) -> Three<N> {
        let power = N::float(f64::powi(2.0, self.exponent));
        self.matrix.map(|row| dot(exact(row), v) * power)
    }

    /// Converts a place of the scene to the part.
    pub fn point<N: Enclosure>(&self, place: Three<N>) -> Three<N> {
        self.rotate(minus(place, exact(self.center)))
    }

    /// Converts a ray of the scene to the part; its t stays.
    pub fn ray<N: Enclosure>(&self, ray: &Ray<N>) -> Ray<N> {
        Ray {
            origin: self.point(ray.origin),
            direction: self.rotate(ray.direction),
            start: ray.start,
        }
    }

    /// Converts a normal of the part to the scene, with the part's lattice steps per step along it as its length.
    pub fn normal<N: Enclosure>(&self, normal: Three<N>) -> Three<N> {
        let power = N::float(f64::powi(2.0, self.exponent));
        let column = |k: usize| exact([self.matrix[0][k], self.matrix[1][k], self.matrix[2][k]]);
        [0, 1, 2].map(|k| dot(column(k), normal) * power)
    }
}

/// Returns the crossings of a primitive ahead of a ray.
///
/// # Errors
/// If the ray grazes the primitive so that it is open where it crosses it.
pub fn crossings<N: Enclosure>(
    (solid, instance): (&Solid, u32),
    ray: &Ray<N>,
    found: &mut Vec<Crossing<N>>,
) -> Result<(), Grazes> {
    let before = found.len();
    all_crossings((solid, instance), ray, found)?;
    // Kernels compute exactly where surfaces across an axis are. At others their rounding decides about t = 0.
    let is_exact = match solid.form {
        Form::Cuboid { .. } => instance == NONE,
        Form::Plane { normal, .. } | Form::Disc { normal, .. } => {
            instance == NONE && axis_of(normal).is_some()
        }
        _ => false,
    };
    if ray.start == Start::Free && !is_exact {
        let found = found[before..].iter_mut();
        found
            .filter(|it| it.t.sign() == Some(Ordering::Equal))
            .for_each(|it| it.sure = false);
    }
    Ok(())
}

fn all_crossings<N: Enclosure>(
    (solid, instance): (&Solid, u32),
    ray: &Ray<N>,
    found: &mut Vec<Crossing<N>>,
) -> Result<(), Grazes> {
    let (surfaces, itself) = match ray.start {
        Start::On {
            instance: from,
            twin,
            part,
            surface,
            also: [second, third],
            inward,
        } if from == instance => (
            [surface, second, third],
            (solid.twin == twin).then_some((part, inward)),
        ),
        _ => ([NONE; 3], None),
    };
    let starts_on = |of: u32| of != NONE && surfaces.contains(&of);
    match solid.form {
        Form::Triangle {
            corners, normal, ..
        } => {
            if starts_on(solid.surfaces[0]) || itself.is_some() {
                return Ok(());
            }
            triangle(corners, normal, ray, found)
        }
        Form::Disc {
            center,
            normal,
            radius,
        } => {
            if starts_on(solid.surfaces[0]) || itself.is_some() {
                return Ok(());
            }
            disc((center, normal, radius), ray, found)
        }
        Form::Plane { point, normal } => {
            if starts_on(solid.surfaces[0]) || itself.is_some() {
                return Ok(());
            }
            let relative = minus(exact(point), ray.origin);
            if let Some(crossing) = flat(exact(normal), relative, ray)? {
                crossing.keep(ray.start, found);
            }
            Ok(())
        }
        Form::Sphere { center, radius } => sphere(center, radius, itself, ray, found),
        Form::Cuboid { lowest, highest } => {
            if itself.is_some_and(|(_, inward)| !inward) {
                return Ok(());
            }
            let at = solid.surfaces.map(starts_on);
            cuboid([lowest, highest], at, ray, found)
        }
        Form::Cone(cone) => {
            if itself.is_some_and(|(_, inward)| !inward) {
                return Ok(());
            }
            let at = [
                starts_on(solid.surfaces[0]) || itself.is_some_and(|(part, _)| part == MANTLE),
                starts_on(solid.surfaces[1]) || itself.is_some_and(|(part, _)| part == BASE),
                starts_on(solid.surfaces[2]) || itself.is_some_and(|(part, _)| part == APEX),
            ];
            cone::crossings(&cone, at, ray, found)
        }
        Form::Torus(torus) => torus::crossings(&torus, itself.is_some(), ray, found),
    }
}

/// Returns the crossing of a ray with a plane; `None` if it runs along it.
pub fn flat<N: Enclosure>(
    normal: Three<N>,
    relative: Three<N>,
    ray: &Ray<N>,
) -> Result<Option<Crossing<N>>, Grazes> {
    let (above, approach) = (dot(normal, relative), dot(normal, ray.direction));
    match approach.sign() {
        Some(Ordering::Equal) => return Ok(None),
        Some(_) => {}
        None => return Err(Grazes),
    }
    let t = above.div(approach).ok_or(Grazes)?;
    Ok(Some(Crossing {
        t,
        fraction: Some([above, approach]),
        part: 0,
        leaves: false,
        sure: true,
    }))
}

fn triangle<N: Enclosure>(
    corners: [[i64; 3]; 3],
    normal: [i64; 3],
    ray: &Ray<N>,
    found: &mut Vec<Crossing<N>>,
) -> Result<(), Grazes> {
    if normal == [0; 3] {
        return Ok(());
    }
    let [a, b, c] = corners.map(|corner| minus(exact(corner), ray.origin));
    let (mut above, mut below, mut open) = (false, false, false);
    for (p, q) in [(b, c), (c, a), (a, b)] {
        match dot(ray.direction, cross(p, q)).sign() {
            Some(Ordering::Greater) => above = true,
            Some(Ordering::Less) => below = true,
            Some(Ordering::Equal) => {}
            None => open = true,
        }
        if above && below {
            return Ok(());
        }
    }
    if let Some(mut crossing) = flat(exact(normal), a, ray)? {
        crossing.sure = !open;
        crossing.keep(ray.start, found);
    }
    Ok(())
}

fn disc<N: Enclosure>(
    (center, normal, radius): ([i64; 3], [i64; 3], i64),
    ray: &Ray<N>,
    found: &mut Vec<Crossing<N>>,
) -> Result<(), Grazes> {
    let relative = minus(exact(center), ray.origin);
    // Not if the line stays away from the disc's sphere.
    let radius = N::int(radius);
    let length = norm2(ray.direction);
    let closest = dot(relative, ray.direction).div(length).ok_or(Grazes)?;
    let apart = norm2(along(relative, -closest, ray.direction));
    if (radius.square() - apart).sign() == Some(Ordering::Less) {
        return Ok(());
    }
    let Some(mut crossing) = flat(exact(normal), relative, ray)? else {
        return Ok(());
    };
    let apart = norm2(along(relative, -crossing.t, ray.direction));
    match (radius.square() - apart).sign() {
        Some(Ordering::Less) => return Ok(()),
        Some(_) => {}
        None => crossing.sure = false,
    }
    crossing.keep(ray.start, found);
    Ok(())
}

fn sphere<N: Enclosure>(
    center: [i64; 3],
    radius: i64,
    itself: Option<(u8, bool)>,
    ray: &Ray<N>,
    found: &mut Vec<Crossing<N>>,
) -> Result<(), Grazes> {
    let crossing = |t: N, leaves: bool, sure: bool| Crossing {
        t,
        fraction: None,
        part: 0,
        leaves,
        sure,
    };
    let relative = minus(exact(center), ray.origin);
    let length = norm2(ray.direction);
    if itself.is_some_and(|(_, inward)| !inward) {
        return Ok(());
    }
    // Where the length may be 0, nothing is known of the ray: that is open, and no miss.
    let closest = dot(relative, ray.direction).div(length).ok_or(Grazes)?;
    if itself.is_some() {
        // The other root is 0.
        crossing(closest + closest, true, true).keep(ray.start, found);
        return Ok(());
    }
    let apart = norm2(along(relative, -closest, ray.direction));
    let square = N::int(radius).square() - apart;
    let sure = match square.sign() {
        Some(Ordering::Less) => return Ok(()),
        sign => sign.is_some(),
    };
    let half = square.div(length).ok_or(Grazes)?.sqrt();
    crossing(closest - half, false, sure).keep(ray.start, found);
    crossing(closest + half, true, sure).keep(ray.start, found);
    Ok(())
}

/// Returns the last of several crossings, or the first if `sign` is less. Returns each crossing that may be it.
fn extreme<N: Enclosure>(all: &[Crossing<N>], sign: Ordering) -> Vec<Crossing<N>> {
    let beaten = |index: usize| {
        (0..all.len()).any(|other| {
            // At one and the same t the earlier axis counts.
            match compare(&all[other], &all[index]) {
                Some(order) if order == sign => true,
                Some(Ordering::Equal) => other < index,
                _ => false,
            }
        })
    };
    let left = (0..all.len()).filter(|&index| !beaten(index));
    left.map(|index| all[index]).collect()
}

fn cuboid<N: Enclosure>(
    [lowest, highest]: [[i64; 3]; 2],
    at: [bool; 6],
    ray: &Ray<N>,
    found: &mut Vec<Crossing<N>>,
) -> Result<(), Grazes> {
    let (mut enters, mut leaves) = (Vec::with_capacity(3), Vec::with_capacity(3));
    let (mut sure, mut grazes) = (true, false);
    for k in 0..3 {
        let to = |side: usize, coordinate: i64| {
            if at[2 * k + side] {
                N::zero()
            } else {
                N::int(coordinate) - ray.origin[k]
            }
        };
        let (below, above) = (to(0, lowest[k]), to(1, highest[k]));
        let slope = ray.direction[k];
        let face = |distance: N, part: usize, leaves: bool| {
            let t = distance.div(slope)?;
            Some(Crossing {
                t,
                fraction: Some([distance, slope]),
                part: part as u8,
                leaves,
                sure: true,
            })
        };
        let (near, far) = match slope.sign() {
            Some(Ordering::Greater) => (face(below, 2 * k, false), face(above, 2 * k + 1, true)),
            Some(Ordering::Less) => (face(above, 2 * k + 1, false), face(below, 2 * k, true)),
            Some(Ordering::Equal) => {
                match (below.sign(), above.sign()) {
                    (Some(Ordering::Greater), _) | (_, Some(Ordering::Less)) => return Ok(()),
                    (Some(_), Some(_)) => {}
                    _ => sure = false,
                }
                continue;
            }
            None => {
                grazes = true;
                continue;
            }
        };
        enters.push(near.ok_or(Grazes)?);
        leaves.push(far.ok_or(Grazes)?);
    }
    for enter in &enters {
        // Between the faces of one axis it is known, also where they are one and the same.
        for leave in leaves.iter().filter(|it| it.part / 2 != enter.part / 2) {
            match compare(enter, leave) {
                Some(Ordering::Greater) => return Ok(()),
                Some(_) => {}
                None => sure = false,
            }
        }
    }
    if grazes {
        let behind = |it: &Crossing<N>| ray.start.is_before(it.t) == Some(false);
        return if leaves.iter().any(behind) {
            Ok(())
        } else {
            Err(Grazes)
        };
    }
    for all in [
        extreme(&enters, Ordering::Greater),
        extreme(&leaves, Ordering::Less),
    ] {
        for crossing in &all {
            Crossing {
                sure: sure && all.len() == 1,
                ..*crossing
            }
            .keep(ray.start, found);
        }
    }
    Ok(())
}

/// Returns the normal of a primitive, of length 1, at a point of its surface: outward, or to the front. `None` where it
/// is open, at the tip of a cone.
pub fn normal<N: Enclosure>(form: &Form, part: u8, point: Three<N>) -> Option<Three<N>> {
    match *form {
        Form::Triangle { normal, .. } | Form::Disc { normal, .. } | Form::Plane { normal, .. } => {
            flat_normal(normal)
        }
        Form::Sphere { center, .. } => unit(minus(point, exact(center))),
        Form::Cuboid { .. } => {
            let mut normal = [0; 3];
            normal[usize::from(part / 2)] = if part.is_multiple_of(2) { -1 } else { 1 };
            Some(exact(normal))
        }
        Form::Cone(cone) => cone::normal(&cone, part, point),
        Form::Torus(torus) => torus::normal(&torus, point),
    }
}

/// Returns the axis and the coordinate of a face that lies across an axis.
pub fn face(form: &Form, part: u8) -> Option<(usize, i64)> {
    match *form {
        Form::Triangle {
            normal,
            corners: [point, ..],
            ..
        }
        | Form::Disc {
            normal,
            center: point,
            ..
        }
        | Form::Plane { normal, point } => axis_of(normal).map(|k| (k, point[k])),
        Form::Cuboid { lowest, highest } => {
            let k = usize::from(part / 2);
            Some((
                k,
                if part.is_multiple_of(2) {
                    lowest[k]
                } else {
                    highest[k]
                },
            ))
        }
        _ => None,
    }
}

impl Form {
    /// Returns whether the shape has no inside.
    pub fn is_flat(&self) -> bool {
        matches!(
            self,
            Form::Triangle { .. } | Form::Disc { .. } | Form::Plane { .. }
        )
    }
}

#[cfg(test)]
mod tests {
    use super::super::interval::Interval;
    use super::super::world::{Cone, Paint, Torus};
    use super::*;

    /// A ray of which nothing is known, as after many mirrors, misses nothing.
    #[test]
    fn direction_that_may_be_zero_is_open_for_every_shape() {
        let (center, axis) = ([0; 3], [0, 0, 256]);
        let forms = [
            Form::Triangle {
                corners: [[0, 0, 0], [256, 0, 0], [0, 256, 0]],
                normal: [0, 0, 65_536],
                smooth: None,
            },
            Form::Sphere {
                center,
                radius: 256,
            },
            Form::Disc {
                center,
                normal: axis,
                radius: 256,
            },
            Form::Plane {
                point: center,
                normal: axis,
            },
            Form::Cuboid {
                lowest: [-256; 3],
                highest: [256; 3],
            },
            Form::Cone(Cone {
                base: center,
                axis,
                base_radius: 256,
                apex_radius: 128,
            }),
            Form::Torus(Torus {
                center,
                axis,
                major: 256,
                minor: 64,
            }),
        ];
        let ray = Ray {
            origin: exact([0, 0, 2560]),
            direction: [Interval::new(-1.0, 1.0); 3],
            start: Start::Free,
        };
        for form in forms {
            let solid = Solid {
                form,
                primitive: 0,
                object: 0,
                surfaces: [NONE; 6],
                twin: 0,
                paint: Paint::default(),
            };
            let mut found = Vec::new();
            let result = crossings((&solid, NONE), &ray, &mut found);
            assert_eq!(result, Err(Grazes), "{form:?}: {found:?}");
        }
    }
}
