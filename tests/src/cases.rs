//! Shapes and rays that are hard on a kernel, all on the lattice, so that no number is rounded
//! before the kernel sees it.

use crate::random::Random;
use crate::solid::Solid;
use glam::DVec3;
use gridel_host::scene::Shape;

/// A shape, and rays at it.
pub struct Case {
    pub class: &'static str,
    pub solid: Solid,
    /// Origins and slopes (the largest component is 1 or -1).
    pub rays: Vec<([f64; 3], [f64; 3])>,
}

/// Names of shapes, in the order of their numbers here.
pub const SHAPES: [&str; 8] = [
    "sphere", "triangle", "box", "disc", "cylinder", "cone", "frustum", "torus",
];

/// How large, and how far from the scene's middle: units.
const SIZES: [(&str, f64, f64); 5] = [
    ("ordinary", 900.0, 9000.0),
    ("tiny", 0.05, 20_000.0),
    ("small", 3.0, 30_000.0),
    ("huge", 12_000.0, 3000.0),
    ("near", 4.0, 8.0),
];

/// On the storage lattice, inside the scene.
pub fn lattice(x: f64) -> f64 {
    (x * 256.0).round().clamp(-8_380_000.0, 8_380_000.0) / 256.0
}

fn lattice_point(p: DVec3) -> [f64; 3] {
    p.to_array().map(lattice)
}

/// A length above 0 on the lattice.
fn length(x: f64) -> f64 {
    lattice(x).max(1.0 / 256.0)
}

/// A random shape of a number in [`SHAPES`].
fn solid(random: &mut Random, shape: usize, center: DVec3, size: f64, stretch: f64) -> Solid {
    let offset = |random: &mut Random| DVec3::from_array([0; 3].map(|_| random.signed() * size));
    // Along an axis of the lattice, or anywhere.
    let direction = |random: &mut Random| {
        if random.one_in(3) {
            DVec3::AXES[random.below(3)]
        } else {
            DVec3::from_array(random.direction())
        }
    };
    match shape {
        0 => Solid::Sphere {
            center: lattice_point(center),
            radius: length(size * (0.2 + random.unit())),
        },
        1 => loop {
            let first = center + offset(random);
            let second = center + offset(random);
            let middle = first + (second - first) * random.unit();
            let third = middle + offset(random) / stretch;
            let corners = [first, second, third].map(lattice_point);
            let [a, b, c] = corners.map(DVec3::from_array);
            if (b - a).cross(c - a) != DVec3::ZERO {
                break Solid::Triangle(corners);
            }
        },
        2 => {
            let mut reach = offset(random).abs();
            reach[random.below(3)] /= stretch;
            Solid::Box {
                lowest: lattice_point(center - reach),
                highest: lattice_point(center + reach),
            }
        }
        3 => {
            let normal = direction(random);
            let normal = normal / normal.abs().max_element() * f64::from(1 << 24);
            Solid::Disc {
                center: lattice_point(center),
                // As the compiler rounds it, so that it stays as it is.
                normal: (normal.round() / f64::from(1 << 24)).to_array(),
                radius: length(size * (0.2 + random.unit())),
            }
        }
        7 => {
            // Rings, thin ones, horns and spindles.
            let axis = direction(random);
            let axis = axis / axis.abs().max_element() * f64::from(1 << 24);
            let major_radius = length(size * (0.1 + 0.5 * random.unit()));
            let share = [0.5 / stretch, 0.9, 1.0, 1.5][random.below(4)];
            Solid::Torus {
                center: lattice_point(center),
                axis: (axis.round() / f64::from(1 << 24)).to_array(),
                major_radius,
                minor_radius: length(major_radius * share),
            }
        }
        _ => {
            // Needles and coins.
            let flat = random.one_in(2);
            let (tall, wide) = if flat {
                (1.0 / stretch, 1.0)
            } else {
                (1.0, 1.0 / stretch)
            };
            let axis = direction(random) * size * tall;
            let radius = length(size * wide * (0.2 + random.unit()));
            let other = length(size * wide * (0.2 + random.unit()));
            let (base, mut apex) = (lattice_point(center - axis), lattice_point(center + axis));
            if base == apex {
                apex[random.below(3)] += 1.0 / 256.0;
            }
            Solid::Cone {
                base,
                apex,
                base_radius: radius,
                apex_radius: match shape {
                    4 => radius,
                    5 => 0.0,
                    _ if other == radius => radius + 1.0 / 256.0,
                    _ => other,
                },
            }
        }
    }
}

/// The shape in the scene's terms.
pub fn shape_of(solid: &Solid) -> Shape {
    let v = DVec3::from_array;
    match *solid {
        Solid::Sphere { center, radius } => Shape::Sphere {
            center: v(center),
            radius,
        },
        Solid::Box { lowest, highest } => Shape::Box {
            min: v(lowest),
            max: v(highest),
        },
        Solid::Disc {
            center,
            normal,
            radius,
        } => Shape::Disc {
            center: v(center),
            normal: v(normal),
            radius,
        },
        Solid::Cone {
            base,
            apex,
            base_radius,
            apex_radius,
        } => Shape::Cone {
            base: v(base),
            base_radius,
            apex: v(apex),
            apex_radius,
        },
        Solid::Torus {
            center,
            axis,
            major_radius,
            minor_radius,
        } => Shape::Torus {
            center: v(center),
            axis: v(axis),
            major_radius,
            minor_radius,
        },
        Solid::Triangle(corners) => Shape::Mesh {
            vertices: corners.map(v).to_vec(),
            triangles: vec![[0, 1, 2]],
        },
    }
}

/// Slopes with 23 fraction bits, exact in every number format.
pub fn slope(direction: DVec3) -> [f64; 3] {
    let scaled = direction / direction.abs().max_element();
    let steps = f64::powi(2.0, 23);
    (scaled * steps).to_array().map(|x| x.round() / steps)
}

/// A place that matters: middle, rim, tip, corner, or anywhere on the surface.
fn place(random: &mut Random, solid: &Solid) -> DVec3 {
    let v = DVec3::from_array;
    let around = |random: &mut Random, axis: DVec3, radius: f64| {
        let side = axis.any_orthonormal_vector();
        let angle = std::f64::consts::TAU * random.unit();
        radius * (side * angle.cos() + axis.cross(side) * angle.sin())
    };
    match *solid {
        Solid::Sphere { center, radius } => {
            v(center) + v(random.direction()) * radius * [1.0, 1.0, 0.999, 0.5][random.below(4)]
        }
        Solid::Box { lowest, highest } => {
            let side = |k: usize, random: &mut Random| match random.below(3) {
                0 => lowest[k],
                1 => highest[k],
                _ => lowest[k] + random.unit() * (highest[k] - lowest[k]),
            };
            DVec3::new(side(0, random), side(1, random), side(2, random))
        }
        Solid::Disc {
            center,
            normal,
            radius,
        } => {
            let part = [1.0, 0.9999, 1.0001, random.unit()][random.below(4)];
            v(center) + around(random, v(normal).normalize(), radius * part)
        }
        Solid::Torus {
            center,
            axis,
            major_radius,
            minor_radius,
        } => {
            let axis = v(axis).normalize();
            let outward = around(random, axis, 1.0);
            let angle = std::f64::consts::TAU
                * [0.0, 0.25, 0.5, random.unit(), random.unit()][random.below(5)];
            let part = [1.0, 1.0, 0.9999, 1.0001, random.unit()][random.below(5)];
            let tube = (outward * angle.cos() + axis * angle.sin()) * minor_radius * part;
            match random.below(8) {
                0 => v(center),
                _ => v(center) + outward * major_radius + tube,
            }
        }
        Solid::Triangle([a, b, c]) => match random.below(4) {
            0 => v(a),
            1 => v(b) + (v(c) - v(b)) * random.unit(),
            _ => {
                let inner = v(b) + (v(c) - v(b)) * random.unit();
                v(a) + (inner - v(a)) * random.unit()
            }
        },
        Solid::Cone {
            base,
            apex,
            base_radius,
            apex_radius,
        } => {
            let up = v(apex) - v(base);
            let part = [0.0, 1.0, random.unit(), random.unit()][random.below(4)];
            let radius = base_radius + part * (apex_radius - base_radius);
            let inner = [1.0, 1.0, 0.0, random.unit()][random.below(4)];
            v(base) + up * part + around(random, up.normalize(), radius * inner)
        }
    }
}

/// A direction that the shape itself suggests: along its axis, a line of its mantle, its plane.
fn own_direction(random: &mut Random, solid: &Solid) -> DVec3 {
    let v = DVec3::from_array;
    match *solid {
        Solid::Cone {
            base,
            apex,
            base_radius,
            apex_radius,
        } => {
            let up = v(apex) - v(base);
            let side = up.normalize().any_orthonormal_vector();
            match random.below(3) {
                0 => up,
                1 => up + side * (apex_radius - base_radius),
                _ => side,
            }
        }
        Solid::Disc { normal, .. } => match random.below(2) {
            0 => v(normal),
            _ => v(normal).any_orthonormal_vector(),
        },
        Solid::Torus { axis, .. } => match random.below(2) {
            0 => v(axis),
            _ => v(axis).cross(v(random.direction())),
        },
        Solid::Triangle([a, b, c]) => match random.below(2) {
            0 => v(b) - v(a),
            _ => v(b) + v(c) - 2.0 * v(a),
        },
        _ => DVec3::AXES[random.below(3)],
    }
}

/// Origin and slope of one ray.
fn ray(random: &mut Random, solid: &Solid, size: f64) -> ([f64; 3], [f64; 3]) {
    let target = place(random, solid);
    let direction = match random.below(6) {
        0 => DVec3::AXES[random.below(3)],
        1 => own_direction(random, solid),
        // Past the shape: at right angles to where it is seen from.
        2 => (target - place(random, solid)).cross(DVec3::from_array(random.direction())),
        _ => DVec3::from_array(random.direction()),
    };
    let direction = if direction.abs().max_element() > 0.0 {
        direction
    } else {
        DVec3::X
    };
    let direction = if random.one_in(2) {
        direction
    } else {
        -direction
    };
    let slopes = slope(direction);
    let back = match random.below(5) {
        0 => size * random.unit(),
        1 => -size * random.unit(),
        2 => 0.0,
        _ => random.magnitude(1.0, 30_000.0),
    };
    let origin = if random.one_in(8) {
        // Inside, or on the surface.
        (target + place(random, solid)) * 0.5
    } else {
        target - DVec3::from_array(slopes) * back
    };
    (lattice_point(origin), slopes)
}

/// Hard cases of one shape.
pub fn cases(seed: u64, shape: usize, count: usize, rays_each: usize) -> Vec<Case> {
    let mut random = Random(seed);
    (0..count)
        .map(|number| {
            let (class, size, distance) = SIZES[number % SIZES.len()];
            let center = DVec3::from_array(random.direction()) * distance * random.unit();
            let stretch = [1.0, 1.0, 100.0, 1e5][random.below(4)];
            let solid = solid(&mut random, shape, center, size, stretch);
            let rays = (0..rays_each)
                .map(|_| ray(&mut random, &solid, size))
                .collect();
            Case { class, solid, rays }
        })
        .collect()
}
