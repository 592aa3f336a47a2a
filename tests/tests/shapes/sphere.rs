//! Spheres: hard cases D1 to D4, D15 and D24.

use super::{hold, hold_all, of_every_sort};
use glam::DVec3;
use gridel_core::Number;
use gridel_host::shape::Solid;
use gridel_host::shape::Sphere;
use gridel_tests::cases::{Case, lattice, slope};
use gridel_tests::effort::part_of;
use gridel_tests::every_format;
use gridel_tests::random::Random;

fn case(class: &'static str, center: DVec3, radius: f64, rays: Vec<(DVec3, DVec3)>) -> Case {
    Case {
        class,
        solid: Solid::Sphere(Sphere {
            center: center.map(lattice),
            radius,
        }),
        rays: rays
            .into_iter()
            .map(|(origin, way)| (origin.map(lattice).to_array(), slope(way)))
            .collect(),
    }
}

fn direction(random: &mut Random) -> DVec3 {
    DVec3::from_array(random.direction())
}

#[test]
fn spheres_and_rays_of_every_sort_hold_the_bounds() {
    of_every_sort(0);
}

/// A radius down to a millionth of the distance (D1).
#[test]
fn small_spheres_far_away_hold_the_bounds() {
    let mut random = Random(1);
    let cases: Vec<Case> = (0..part_of(40, 2000))
        .map(|_| {
            let center = direction(&mut random) * 25_000.0;
            let radius = lattice(random.magnitude(1.0 / 256.0, 4.0)).max(1.0 / 256.0);
            let rays = (0..50).map(|_| {
                // The slopes' 23 bits are a step of 1/128 at that distance.
                let target = center + direction(&mut random) * radius;
                let origin = -center * random.unit();
                (origin, target - origin)
            });
            case("far", center, radius, rays.collect())
        })
        .collect();
    hold_all("small spheres far away", "sphere", &cases);
}

/// The ground as a sphere that all but fills the lattice, seen from just above it (D2).
#[test]
fn a_huge_sphere_as_ground_holds_the_bounds() {
    let mut random = Random(2);
    let cases: Vec<Case> = (0..part_of(20, 1000))
        .map(|_| {
            let radius = lattice(random.magnitude(1000.0, 30_000.0));
            let up = direction(&mut random);
            let rays = (0..50).map(|_| {
                let origin = up * (radius + random.magnitude(1.0 / 256.0, 100.0));
                let flat = direction(&mut random).cross(up);
                (origin, flat - up * random.magnitude(1e-4, 1.0))
            });
            case("ground", DVec3::ZERO, radius, rays.collect())
        })
        .collect();
    hold_all("huge spheres", "sphere", &cases);
}

/// Tangents to within a step of the lattice, and exact ones, which are hits (D3).
#[test]
fn tangents_hold_the_bounds_and_exact_ones_hit() {
    let mut random = Random(3);
    let cases: Vec<Case> = (0..part_of(40, 2000))
        .map(|_| {
            let center = (direction(&mut random) * 9000.0).map(lattice);
            let radius = lattice(random.magnitude(0.1, 9000.0));
            let rays = (0..50).map(|number| {
                if number % 2 == 0 {
                    let axis = random.below(3);
                    let mut origin = center;
                    origin[(axis + 1) % 3] += radius;
                    let way = DVec3::AXES[axis];
                    return (origin - way * lattice(random.unit() * 20_000.0), way);
                }
                let way = DVec3::from_array(slope(direction(&mut random)));
                let side = way.cross(direction(&mut random)).normalize();
                (center + side * radius - way * random.unit() * 2e4, way)
            });
            case("tangent", center, radius, rays.collect())
        })
        .collect();
    hold_all("tangents of spheres", "sphere", &cases);
    // Closed: every exact tangent is a hit.
    fn exact<N: Number>() {
        let ball = |axis: usize, sign: f64| {
            let mut origin = DVec3::new(10.0, -20.0, 30.0);
            origin[(axis + 1) % 3] += sign * 8.0;
            case(
                "exact tangent",
                DVec3::new(10.0, -20.0, 30.0),
                8.0,
                vec![(origin - DVec3::AXES[axis] * 100.0, DVec3::AXES[axis])],
            )
        };
        let cases: Vec<Case> = (0..3).flat_map(|k| [ball(k, 1.0), ball(k, -1.0)]).collect();
        let worst = hold::<N>("exact tangents", "sphere", &cases);
        assert_eq!(worst.hits, 6);
    }
    every_format!(exact());
}

/// Rays from inside always hit the far side, where they leave (D24); rays from behind miss (D15).
#[test]
fn rays_from_inside_hit_and_rays_from_behind_miss() {
    fn judge<N: Number>() {
        let mut random = Random(4);
        let mut cases = |inside: bool| -> Vec<Case> {
            (0..part_of(20, 500))
                .map(|_| {
                    let center = direction(&mut random) * 9000.0;
                    let radius = lattice(random.magnitude(1.0, 9000.0));
                    let rays = (0..50).map(|_| {
                        let way = direction(&mut random);
                        let origin = if inside {
                            center + direction(&mut random) * radius * 0.99 * random.unit()
                        } else {
                            center + way * radius * (1.01 + random.unit())
                        };
                        (origin, way)
                    });
                    case("inside or behind", center, radius, rays.collect())
                })
                .collect()
        };
        let inside = hold::<N>("from inside", "sphere", &cases(true));
        assert_eq!(inside.hits, inside.rays);
        let behind = hold::<N>("from behind", "sphere", &cases(false));
        assert_eq!(behind.hits, 0);
    }
    every_format!(judge());
}
