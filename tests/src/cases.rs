//! Shapes and rays that are hard on a kernel, all on the lattice, so that no number is rounded
//! before the kernel sees it.

pub use crate::shapes::lattice;

use crate::random::Random;
use crate::shapes::{self, Room, lattice_point, own_direction, place};
use glam::DVec3;
use gridel_core::Kind;
use gridel_host::shape::Solid;
use std::sync::LazyLock;

/// A shape, and rays at it.
pub struct Case {
    pub class: &'static str,
    pub solid: Solid,
    /// Origins and slopes (the largest component is 1 or -1).
    pub rays: Vec<([f64; 3], [f64; 3])>,
}

/// Names of shapes, in the order of their numbers here.
pub static SHAPES: LazyLock<Vec<&str>> =
    LazyLock::new(|| shapes::names().map(|named| named.name).collect());

/// The numbers of those that have a box.
pub static BOUNDED: LazyLock<Vec<usize>> = LazyLock::new(|| {
    let is_bounded = |name: &str| {
        let mut kinds = Kind::ALL.into_iter();
        kinds.all(|kind| kind.name() != name || kind.is_bounded())
    };
    (0..SHAPES.len())
        .filter(|&shape| is_bounded(SHAPES[shape]))
        .collect()
});

/// Sizes of shapes, and their distances from the scene's middle, in units.
const SIZES: [(&str, f64, f64); 5] = [
    ("ordinary", 900.0, 9000.0),
    ("tiny", 0.05, 20_000.0),
    ("small", 3.0, 30_000.0),
    ("huge", 12_000.0, 3000.0),
    ("near", 4.0, 8.0),
];

/// Slopes with 23 fraction bits, exact in every number format.
pub fn slope(direction: DVec3) -> [f64; 3] {
    let scaled = direction / direction.abs().max_element();
    let steps = f64::powi(2.0, 23);
    (scaled * steps).to_array().map(|x| x.round() / steps)
}

/// Origin and slope of one ray.
fn ray(random: &mut Random, solid: &Solid, size: f64) -> ([f64; 3], [f64; 3]) {
    let target = place(solid, random);
    let direction = match random.below(6) {
        0 => DVec3::AXES[random.below(3)],
        1 => own_direction(solid, random),
        // Past the shape: at right angles to where it is seen from.
        2 => (target - place(solid, random)).cross(DVec3::from_array(random.direction())),
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
        (target + place(solid, random)) * 0.5
    } else {
        target - DVec3::from_array(slopes) * back
    };
    (lattice_point(origin).to_array(), slopes)
}

/// Hard cases of one shape.
pub fn cases(seed: u64, shape: usize, count: usize, rays_each: usize) -> Vec<Case> {
    let mut random = Random(seed);
    (0..count)
        .map(|number| {
            let (class, size, distance) = SIZES[number % SIZES.len()];
            let center = DVec3::from_array(random.direction()) * distance * random.unit();
            let stretch = [1.0, 1.0, 100.0, 1e5][random.below(4)];
            let room = Room {
                center,
                size,
                stretch,
            };
            let solid = shapes::random(&mut random, SHAPES[shape], room);
            let rays = (0..rays_each)
                .map(|_| ray(&mut random, &solid, size))
                .collect();
            Case { class, solid, rays }
        })
        .collect()
}
