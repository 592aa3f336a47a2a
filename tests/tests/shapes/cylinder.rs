//! Capped cylinders: hard cases D12 to D14 and D24.

use super::{hold, hold_all, of_every_sort};
use glam::DVec3;
use gridel_core::{List, NoCount, Number};
use gridel_host::shape::Cone;
use gridel_host::shape::Solid;
use gridel_tests::cases::{Case, lattice, slope};
use gridel_tests::effort::part_of;
use gridel_tests::every_format;
use gridel_tests::exact::Line;
use gridel_tests::exact::Real;
use gridel_tests::judge::blob_of;
use gridel_tests::query::{UnitRay, closest};
use gridel_tests::random::Random;

/// A cylinder between lattice points; the second is moved if they are one.
pub fn cylinder(base: DVec3, apex: DVec3, radius: f64) -> Solid {
    let (base, mut apex) = (base.map(lattice), apex.map(lattice));
    if base == apex {
        apex.x += 1.0 / 256.0;
    }
    let radius = lattice(radius).max(1.0 / 256.0);
    Solid::Cone(Cone {
        base,
        apex,
        base_radius: radius,
        apex_radius: radius,
    })
}

fn direction(random: &mut Random) -> DVec3 {
    DVec3::from_array(random.direction())
}

fn ray(origin: DVec3, way: DVec3) -> ([f64; 3], [f64; 3]) {
    (origin.map(lattice).to_array(), slope(way))
}

#[test]
fn cylinders_and_rays_of_every_sort_hold_the_bounds() {
    of_every_sort(4);
}

/// Rays run along the axis, from outside through both caps, from inside through one, and past it (D12).
#[test]
fn rays_parallel_to_the_axis_meet_the_caps() {
    fn judge<N: Number>() {
        let mut random = Random(10);
        let mut inside = |inside: bool| -> Vec<Case> {
            (0..part_of(40, 2000))
                .map(|_| {
                    let axis = random.below(3);
                    let base = direction(&mut random) * 9000.0;
                    let height = random.magnitude(1.0 / 64.0, 9000.0);
                    let radius = random.magnitude(1.0 / 64.0, 9000.0);
                    let up = DVec3::AXES[axis];
                    let rays = (0..20).map(|_| {
                        let side = up.cross(direction(&mut random)).normalize();
                        let part = if inside { 0.99 } else { 1.01 };
                        let from = base
                            + side * (radius * part + if inside { 0.0 } else { 0.1 })
                            + up * height * random.signed();
                        let up = if random.one_in(2) { up } else { -up };
                        ray(from - up * lattice(2.0 * height), up)
                    });
                    let rays = rays.collect();
                    Case {
                        class: "parallel",
                        solid: cylinder(base, base + up * height, radius),
                        rays,
                    }
                })
                .collect()
        };
        let through = hold::<N>("along axes, inside", "cylinder", &inside(true));
        assert!(through.hits * 10 >= through.rays * 9, "{}", through.hits);
        let past = hold::<N>("along axes, outside", "cylinder", &inside(false));
        assert_eq!(past.hits, 0);
    }
    every_format!(judge());
}

/// Hairs, coins and both far away (D13).
#[test]
fn needles_and_coins_hold_the_bounds() {
    let mut random = Random(11);
    let cases: Vec<Case> = (0..part_of(60, 4000))
        .map(|number| {
            let base = direction(&mut random) * 20_000.0;
            let (height, radius) = if number % 2 == 0 {
                (20_000.0, random.magnitude(1.0 / 256.0, 1.0))
            } else {
                (1.0 / 128.0, random.magnitude(1.0, 9000.0))
            };
            let up = direction(&mut random);
            let apex = base - base.normalize() * height * 0.5 + up * height * 0.5;
            let rays = (0..40).map(|_| {
                let target = base + (apex - base) * random.unit();
                let side = up.cross(direction(&mut random));
                let target = target + side * radius * random.signed();
                let origin = direction(&mut random) * random.magnitude(1.0, 30_000.0);
                ray(origin, target - origin)
            });
            Case {
                class: "needle or coin",
                rays: rays.collect(),
                solid: cylinder(base, apex, radius),
            }
        })
        .collect();
    hold_all("needles and coins", "cylinder", &cases);
}

/// Rays aim at rims, run in the planes of caps, and run along lines of the mantle (D14).
#[test]
fn rays_at_rims_and_in_planes_of_caps_hold_the_bounds() {
    let mut random = Random(12);
    let cases: Vec<Case> = (0..part_of(60, 4000))
        .map(|_| {
            let axis = random.below(3);
            let base = direction(&mut random) * 9000.0;
            let height = random.magnitude(1.0 / 64.0, 9000.0);
            let radius = lattice(random.magnitude(1.0 / 64.0, 9000.0));
            let up = DVec3::AXES[axis];
            let rays = (0..30).map(|number| {
                let side = DVec3::AXES[(axis + 1) % 3];
                let rim = base + side * radius + up * height * f64::from(number & 1);
                match number % 3 {
                    // In the plane of a cap, touching the rim or through the middle.
                    0 => {
                        let way = up.cross(direction(&mut random));
                        ray(rim - way * 100.0, way)
                    }
                    // Along a line of the mantle.
                    1 => ray(rim - up * 2.0 * height, up),
                    _ => ray(rim - direction(&mut random) * 999.0, direction(&mut random)),
                }
            });
            Case {
                class: "rim",
                rays: rays.collect(),
                solid: cylinder(base, base + up * height, radius),
            }
        })
        .collect();
    hold_all("rims of cylinders", "cylinder", &cases);
}

/// A ray that continues behind every hit enters a solid of revolution as often as it leaves it.
/// There is one interval, without a hole at a seam and without a double count (D14).
#[test]
fn solids_are_left_as_often_as_they_are_entered() {
    fn judge<N: Number>() {
        let mut random = Random(13);
        let (mut rays, mut crossings) = (0, 0);
        for number in 0..part_of(200, 20_000) {
            let base = direction(&mut random) * 3000.0;
            let apex = base + direction(&mut random) * random.magnitude(100.0, 9000.0);
            let radius = random.magnitude(100.0, 9000.0);
            let mut solid = cylinder(base, apex, radius);
            if let (1, Solid::Cone(Cone { apex_radius, .. })) = (number % 2, &mut solid) {
                *apex_radius = [0.0, lattice(0.5 * radius)][number / 2 % 2];
            }
            let blob = blob_of([&solid]);
            let scene = blob.scene().expect("a scene");
            for _ in 0..50 {
                let way = direction(&mut random);
                let middle = (base + apex) * 0.5 + direction(&mut random) * radius;
                let start = middle - way * 40_000.0;
                let mut ray = UnitRay::new(start.to_array(), way.to_array());
                let mut depth = 0;
                rays += 1;
                for _ in 0..4 {
                    let ready = ray.ready::<N>(&scene).expect("a ray");
                    let Some(hit) = closest::<N, List>(&scene, &ready, &mut NoCount) else {
                        break;
                    };
                    if hit.primitive != 0 {
                        break;
                    }
                    depth += if hit.front { 1 } else { -1 };
                    crossings += 1;
                    ray.tmin = N::far_to_f64(hit.t);
                    // The next number that the format distinguishes from this one.
                    ray.tmin += ray.tmin * f64::powi(2.0, -21) + f64::powi(2.0, -12);
                }
                // A chord shorter than the steps may be passed over between its ends.
                let line = Line::new(start.to_array(), (way / way.abs().max_element()).to_array());
                let spans = solid.spans(&line, &Real::of(0.0));
                let short = spans
                    .iter()
                    .all(|(enter, leave)| (leave - enter).to_f64() < 0.1);
                assert!(
                    depth == 0 || short,
                    "{}: {solid:?} {ray:?}",
                    N::FORMAT.name()
                );
            }
        }
        eprintln!(
            "{:5}: {rays} rays, {crossings} crossings, all in pairs",
            N::FORMAT.name()
        );
    }
    every_format!(judge());
}
