//! The trait that tests need of every shape.

use crate::random::Random;
use glam::DVec3;
use gridel_host::shape::exact::Real;

/// A name of a shape, and what kernels may be off by: see [`crate::bounds`].
pub struct Named {
    pub name: &'static str,
    /// Steps that t may be off by, and the reason.
    pub crossing: (f64, &'static str),
    /// Steps that normals may be off by, and the reason.
    pub normal: (f64, &'static str),
}

/// The size and the place of a random shape.
#[derive(Clone, Copy)]
pub struct Room {
    pub center: DVec3,
    pub size: f64,
    /// Ratio of length to width.
    pub stretch: f64,
}

impl Room {
    pub fn offset(&self, random: &mut Random) -> DVec3 {
        DVec3::from_array([0; 3].map(|_| random.signed() * self.size))
    }
}

pub trait Sample: Sized {
    const NAMES: &[Named];

    /// One for pictures: about a unit wide, above the origin, with a cost that can be measured.
    fn example() -> Self;

    /// A random shape of a name, its numbers on the lattice.
    fn random(random: &mut Random, name: &str, room: Room) -> Self;

    /// A place that matters: middle, rim, tip, corner, or anywhere on the surface.
    fn place(&self, random: &mut Random) -> DVec3;

    /// A direction that the shape itself suggests: along its axis, a line of its mantle, its plane.
    fn own_direction(&self, random: &mut Random) -> DVec3;

    /// A point of the surface, often at an edge.
    fn surface_point(&self, random: &mut Random) -> DVec3;

    /// Returns the distance of a point from the surface.
    fn distance(&self, point: DVec3) -> f64;

    /// Returns its exact reach along a direction of an axis.
    fn reach(&self, axis: usize, sign: f64) -> Real;
}

/// Rounds a coordinate to the storage lattice, inside the scene.
pub fn lattice(x: f64) -> f64 {
    (x * 256.0).round().clamp(-8_380_000.0, 8_380_000.0) / 256.0
}

pub fn lattice_point(p: DVec3) -> DVec3 {
    p.map(lattice)
}

/// A length above 0 on the lattice.
pub fn length(x: f64) -> f64 {
    lattice(x).max(1.0 / 256.0)
}

/// Returns a random direction, along an axis of the lattice or any.
pub fn direction(random: &mut Random) -> DVec3 {
    if random.one_in(3) {
        DVec3::AXES[random.below(3)]
    } else {
        DVec3::from_array(random.direction())
    }
}

/// Returns a random direction that is rounded as by the compiler, so that compiling does not change it.
pub fn rounded_direction(random: &mut Random) -> DVec3 {
    let direction = direction(random);
    let direction = direction / direction.abs().max_element() * f64::from(1 << 24);
    direction.round() / f64::from(1 << 24)
}

/// Returns a random vector at right angles to an axis.
pub fn around(random: &mut Random, axis: DVec3, radius: f64) -> DVec3 {
    let side = axis.any_orthonormal_vector();
    let angle = std::f64::consts::TAU * random.unit();
    radius * (side * angle.cos() + axis.cross(side) * angle.sin())
}

/// 1, or a random part.
pub fn part(random: &mut Random, at_end: bool) -> f64 {
    if at_end { 1.0 } else { random.unit() }
}

/// Returns a vector's length along an axis, and its distance from it.
pub fn cylindrical(vector: DVec3, axis: DVec3) -> (f64, f64) {
    let axis = axis.normalize();
    let along = vector.dot(axis);
    (along, (vector - axis * along).length())
}

pub fn from_segment(point: DVec3, from: DVec3, to: DVec3) -> f64 {
    let way = to - from;
    let part = (point - from).dot(way) / way.length_squared().max(f64::MIN_POSITIVE);
    point.distance(from + way * part.clamp(0.0, 1.0))
}

/// Returns the reach of a sphere along a direction of an axis.
pub fn end(place: f64, sign: f64, radius: f64) -> Real {
    Real::of(sign * place) + Real::of(radius)
}

/// Returns how far a disc reaches, which depends on the tilt of its plane against the axis.
pub fn rim(place: f64, sign: f64, normal: &Real, radius: f64) -> Real {
    let tilt = Real::of(1.0) - normal * normal;
    Real::of(sign * place) + Real::of(radius) * tilt.sqrt()
}
