//! Discs: hard case D11.

use super::{hold, of_every_sort};
use glam::DVec3;
use gridel_core::Number;
use gridel_host::shape::Disc;
use gridel_host::shape::Solid;
use gridel_tests::cases::{Case, lattice, slope};
use gridel_tests::effort::part_of;
use gridel_tests::every_format;
use gridel_tests::random::Random;

#[test]
fn discs_and_rays_of_every_sort_hold_the_bounds() {
    of_every_sort(3);
}

/// Straight at points that lie exactly on the rim: hits, because discs are closed. And along the
/// disc's plane: never a hit.
#[test]
fn the_rim_belongs_to_the_disc_and_its_plane_does_not() {
    fn judge<N: Number>() {
        let mut random = Random(6);
        // Whole-numbered points on circles.
        let points = [
            (3.0, 4.0, 5.0),
            (5.0, 12.0, 13.0),
            (8.0, 15.0, 17.0),
            (1.0, 0.0, 1.0),
        ];
        let mut cases = |straight: bool| -> Vec<Case> {
            (0..part_of(60, 3000))
                .map(|_| {
                    let axis = random.below(3);
                    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                    let center =
                        DVec3::from_array([0; 3].map(|_| random.signed() * 9000.0)).map(lattice);
                    let (x, y, radius) = points[random.below(4)];
                    let size = lattice(random.magnitude(1.0 / 256.0, 400.0)).max(1.0 / 256.0);
                    let mut origin = center;
                    let mut way = DVec3::ZERO;
                    if straight {
                        origin[u] += x * size;
                        origin[v] -= y * size;
                        origin[axis] -= lattice(random.unit() * 9000.0);
                        way[axis] = 1.0;
                    } else {
                        (way[u], way[v]) = (random.signed(), random.signed());
                    }
                    Case {
                        class: "rim",
                        solid: Solid::Disc(Disc {
                            center,
                            normal: DVec3::AXES[axis],
                            radius: radius * size,
                        }),
                        rays: vec![(origin.to_array(), slope(way))],
                    }
                })
                .collect()
        };
        let worst = hold::<N>("rims of discs", "disc", &cases(true));
        assert_eq!(worst.hits, worst.rays);
        let worst = hold::<N>("planes of discs", "disc", &cases(false));
        assert_eq!(worst.hits, 0);
    }
    every_format!(judge());
}
