//! Tori: thin rings, horns and spindles. Rays go through the hole, along the axis, in the plane of the circle, along
//! tangents, from inside and from far away.

use super::{hold, hold_all, of_every_sort};
use glam::{DQuat, DVec3};
use gridel_core::{List, NoCount, Number, Scene};
use gridel_host::shape::Solid;
use gridel_host::shape::Torus;
use gridel_host::shape::rounding::step;
use gridel_tests::cases::{Case, lattice, slope};
use gridel_tests::effort::part_of;
use gridel_tests::every_format;
use gridel_tests::judge::blob_of;
use gridel_tests::query::{UnitRay, closest};
use gridel_tests::random::Random;
use std::f64::consts::TAU;

/// A torus as a ray is aimed at it.
struct Target {
    center: DVec3,
    /// Direction of length 1, like those across it, which are at right angles.
    axis: DVec3,
    outward: DVec3,
    around: DVec3,
    major: f64,
    minor: f64,
}

fn direction(random: &mut Random) -> DVec3 {
    DVec3::from_array(random.direction())
}

/// Tori of a proportion each, and rays aimed at them.
fn tori(
    class: &'static str,
    seed: u64,
    proportion: impl Fn(&mut Random) -> f64,
    aim: impl Fn(&mut Random, &Target) -> (DVec3, DVec3),
) -> Vec<Case> {
    let mut random = Random(seed);
    let length = |x: f64| lattice(x).max(1.0 / 256.0);
    let case = |_| {
        let random = &mut random;
        let reach = random.magnitude(0.05, 8000.0);
        let axis = match random.below(3) {
            0 => DVec3::AXES[random.below(3)],
            1 => {
                DVec3::from_array([0; 3].map(|_| f64::from(random.within(-2, 2)))) + DVec3::Z * 0.5
            }
            _ => direction(random),
        };
        let axis = axis / axis.abs().max_element() * f64::from(1 << 24);
        let axis = axis.round() / f64::from(1 << 24);
        let major = length(reach);
        let minor = length(major * proportion(random));
        let center = (direction(random) * random.unit() * 8000.0).map(lattice);
        let solid = Solid::Torus(Torus {
            center,
            axis,
            major_radius: major,
            minor_radius: minor,
        });
        let rays = (0..30).map(|_| {
            let axis = axis.normalize();
            let outward = axis.cross(direction(random)).normalize();
            let target = Target {
                center,
                axis,
                outward,
                around: axis.cross(outward),
                major,
                minor,
            };
            let (origin, way) = aim(random, &target);
            let way = if random.one_in(2) { way } else { -way };
            (origin.map(lattice).to_array(), slope(way))
        });
        let rays = rays.collect();
        Case { class, solid, rays }
    };
    (0..part_of(6, 400)).map(case).collect()
}

fn any(random: &mut Random) -> f64 {
    [1.0, 1.5, random.magnitude(1e-5, 1.0), random.unit()][random.below(4)]
}

#[test]
fn tori_and_rays_of_every_sort_hold_the_bounds() {
    of_every_sort(7);
}

#[test]
fn rays_through_the_hole_and_along_the_axis_hold_the_bounds() {
    let cases = tori("hole", 70, any, |random, target| {
        let part = [0.0, 1.0, random.unit()][random.below(3)];
        let place = target.center + target.outward * (target.major - target.minor) * part;
        let lean = direction(random) * [0.0, random.magnitude(1e-6, 1.0)][random.below(2)];
        (
            place - target.axis * random.magnitude(1e-2, 4.0) * target.major,
            target.axis + lean,
        )
    });
    hold_all("holes of tori", "torus", &cases);
}

/// Slopes whose squares are no ordinary numbers, or 0, lead where a slope of 0 leads.
#[test]
fn rays_nearly_along_the_axis_hit_where_those_along_it_do() {
    fn t<N: Number>(scene: &Scene<'_>, origin: DVec3, way: DVec3) -> Option<f64> {
        let ray = UnitRay::new(origin.to_array(), way.to_array()).ready::<N>(scene);
        let hit = closest::<N, List>(scene, &ray.expect("a ray"), &mut NoCount)?;
        Some(N::far_to_f64(hit.t))
    }

    fn judge<N: Number>(axis: DVec3) {
        let mut random = Random(76);
        let (major_radius, minor_radius) = (25_600.0, 3840.0);
        let solid = Solid::Torus(Torus {
            center: DVec3::ZERO,
            axis,
            major_radius,
            minor_radius,
        });
        let blob = blob_of([&solid]);
        let scene = blob.scene().expect("a scene");
        let outward = axis.any_orthonormal_vector();
        for _ in 0..part_of(500, 10_000) {
            let turned = DQuat::from_axis_angle(axis, TAU * random.unit()) * outward;
            let beyond = 0.9 * random.signed() * minor_radius;
            let place = (turned * (major_radius + beyond) - axis * 20_000.0).map(lattice);
            let straight = t::<N>(&scene, place, axis).expect("a hit");
            let nearly = axis + outward * random.magnitude(1e-44, 1e-18);
            let t = t::<N>(&scene, place, nearly).expect("a hit");
            let off = step(N::FORMAT, 32_768.0) * 8.0;
            let about = || format!("{:?} {place} {nearly:?} {t} {straight}", N::FORMAT);
            assert!((t - straight).abs() < off, "{}", about());
        }
    }
    for axis in DVec3::AXES {
        every_format!(judge(axis));
    }
}

#[test]
fn rays_in_the_plane_of_the_circle_and_tangents_of_its_equators_hold_the_bounds() {
    let cases = tori("equator", 71, any, |random, target| {
        let equator = match random.below(4) {
            0 => target.major - target.minor,
            1 => target.major + target.minor,
            2 => target.major,
            _ => (target.major + target.minor) * random.unit(),
        };
        let place = target.center + target.outward * equator;
        let lean = direction(random) * [0.0, random.magnitude(1e-7, 1e-2)][random.below(2)];
        (
            place - target.around * random.unit() * target.major,
            target.around + lean,
        )
    });
    hold_all("equators of tori", "torus", &cases);
}

/// Rays are tangents on the circle at the top, inside and outside, at all slants, among them tangents of a saddle.
#[test]
fn tangents_of_tori_hold_the_bounds() {
    let cases = tori("tangent", 72, any, |random, target| {
        let angle = std::f64::consts::TAU * [0.25, random.unit()][random.below(2)];
        let normal = target.outward * angle.cos() + target.axis * angle.sin();
        let up = target.axis * angle.cos() - target.outward * angle.sin();
        let off = [0.0, random.signed() * random.magnitude(1e-7, 1e-2)][random.below(2)];
        let on =
            target.center + target.outward * target.major + normal * target.minor * (1.0 + off);
        let way = target.around * random.signed() + up * random.signed();
        (on - way * random.magnitude(1e-2, 1e2) * target.minor, way)
    });
    hold_all("tangents of tori", "torus", &cases);
}

/// A ray from inside always has a hit, where it leaves.
#[test]
fn rays_from_inside_a_torus_hit_it() {
    fn judge<N: Number>() {
        let proportion = |random: &mut Random| 0.1 + random.unit();
        let cases = tori("inside", 73, proportion, |random, target| {
            let tube = direction(random) * target.minor * 0.9 * random.unit();
            (
                target.center + target.outward * target.major + tube,
                direction(random),
            )
        });
        let roomy = |case: &Case| matches!(case.solid, Solid::Torus(Torus { minor_radius, .. }) if minor_radius > 1.0);
        let cases: Vec<Case> = cases.into_iter().filter(roomy).collect();
        let worst = hold::<N>("inside tori", "torus", &cases);
        assert_eq!(worst.hits, worst.rays);
    }
    every_format!(judge());
}

/// A ring whose tube is one step of the lattice, from its own size up to that of the lattice.
#[test]
fn rings_of_one_step_hold_the_bounds() {
    let thinnest = |_: &mut Random| 0.0;
    let cases = tori("one step", 74, thinnest, |random, target| {
        let tube = direction(random) * target.minor * random.unit();
        let place = target.center + target.outward * target.major + tube;
        let way = match random.below(3) {
            0 => target.around + direction(random) * random.magnitude(1e-6, 1e-1),
            _ => direction(random),
        };
        (place - way * random.magnitude(1e-2, 1e2), way)
    });
    hold_all("rings of one step", "torus", &cases);
}

/// Radii at both ends of their ranges: a step each, and a reach as large as the lattice. The axis is an axis of
/// coordinates or a diagonal, where the torus reaches beyond the lattice's end from the center.
#[test]
fn tori_at_the_ends_of_the_lattice_hold_the_bounds() {
    let mut random = Random(75);
    let step = 1.0 / 256.0;
    let tori = [
        ([0.0, 0.0, 1.0], step, step),
        ([0.0, 0.0, 1.0], 32_000.0, step),
        ([0.0, 0.0, 1.0], step, 32_000.0),
        ([0.0, 0.0, 1.0], 16_000.0, 16_000.0),
        ([0.0, 0.0, 1.0], 16_000.0, 16_000.0 - step),
        ([0.0, 0.0, 1.0], 16_000.0, 16_000.0 + step),
        ([1.0, 1.0, 1.0], 39_000.0, 100.0),
        ([1.0, -1.0, 1.0], 30_000.0, 8000.0),
    ];
    let cases = tori.map(|(axis, major_radius, minor_radius)| {
        let solid = Solid::Torus(Torus {
            center: [0.0; 3].into(),
            axis: axis.into(),
            major_radius,
            minor_radius,
        });
        let axis = DVec3::from_array(axis).normalize();
        let reach = major_radius + minor_radius;
        let rays = (0..part_of(20, 400)).map(|_| {
            let outward = axis.cross(direction(&mut random)).normalize();
            let tube = direction(&mut random) * minor_radius * random.unit();
            let place = outward * major_radius + tube;
            let way = match random.below(4) {
                0 => axis,
                1 => axis.cross(outward),
                _ => direction(&mut random),
            };
            let back = random.unit() * 2.0 * reach;
            ((place - way * back).map(lattice).to_array(), slope(way))
        });
        Case {
            class: "ends",
            rays: rays.collect(),
            solid,
        }
    });
    hold_all("tori at the ends", "torus", &cases);
}
