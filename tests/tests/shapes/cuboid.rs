//! Boxes as objects: hard cases A1, A6, A7 and D24 for solids.

use super::{hold, of_every_sort};
use glam::DVec3;
use gridel_core::Number;
use gridel_host::shape::Cuboid;
use gridel_host::shape::Solid;
use gridel_tests::cases::{Case, lattice, slope};
use gridel_tests::effort::part_of;
use gridel_tests::every_format;
use gridel_tests::random::Random;

#[test]
fn boxes_and_rays_of_every_sort_hold_the_bounds() {
    of_every_sort(2);
}

/// Rays in a face, along an edge and through a corner, in both directions, hit closed boxes, even
/// boxes without volume.
#[test]
fn faces_edges_and_corners_belong_to_the_box() {
    fn judge<N: Number>() {
        let mut random = Random(5);
        let cases: Vec<Case> = (0..part_of(40, 2000))
            .map(|_| {
                let low = DVec3::from_array([0; 3].map(|_| random.signed() * 9000.0)).map(lattice);
                // One, two or three extents may be zero.
                let size = DVec3::from_array([0; 3].map(|_| {
                    let size = lattice(random.magnitude(1.0 / 256.0, 9000.0));
                    if random.one_in(3) { 0.0 } else { size }
                }));
                let high = low + size;
                let rays = (0..30).map(|_| {
                    let axis = random.below(3);
                    let sign = if random.one_in(2) { 1.0 } else { -1.0 };
                    let mut origin = DVec3::from_array([0, 1, 2].map(|k| match random.below(3) {
                        0 => low[k],
                        1 => high[k],
                        _ => lattice(low[k] + random.unit() * size[k]),
                    }));
                    origin[axis] -= sign * (size[axis] + lattice(random.unit() * 9000.0));
                    let mut way = [0.0 * -sign; 3];
                    way[axis] = sign;
                    (origin.to_array(), slope(DVec3::from_array(way)))
                });
                Case {
                    class: "flat",
                    solid: Solid::Box(Cuboid {
                        min: low,
                        max: high,
                    }),
                    rays: rays.collect(),
                }
            })
            .collect();
        let worst = hold::<N>("in faces of boxes", "box", &cases);
        assert_eq!(worst.hits, worst.rays);
    }
    every_format!(judge());
}
