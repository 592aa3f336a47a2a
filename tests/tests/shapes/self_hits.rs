//! A ray that leaves a surface does not hit it again, and hits a surface that lies just beyond. These are the hard
//! cases F1 to F3, and the nudge test of D25.
//!
//! All shapes but triangles and discs are convex. So a ray from the outside of a face into the half space of that
//! face's normal can never hit the solid again. This holds at rims, at tips and on thin shapes. A ray that continues
//! inside must leave if it starts inside. It starts inside unless the solid is thinner there than the error bound.

use glam::DVec3;
use gridel_core::{Fixed, Hit, List, NoCount, Number, Scene};
use gridel_host::shape::Solid;
use gridel_host::shape::{Cone, Cuboid, Disc, Plane, Sphere, Torus};
use gridel_host::verify::judge::Crossings;
use gridel_tests::cases::{SHAPES, cases, lattice};
use gridel_tests::effort::part_of;
use gridel_tests::every_format;
use gridel_tests::exact::{Line, Real};
use gridel_tests::judge::blob_of;
use gridel_tests::query::{UnitRay, closest, depart, point_of};
use gridel_tests::random::Random;

/// A direction into the half space of a normal, often grazing.
fn outward(random: &mut Random, normal: DVec3) -> DVec3 {
    let direction = DVec3::from_array(random.direction());
    let cosine = direction.dot(normal);
    let lift = if random.one_in(3) {
        random.unit() * 1e-3
    } else {
        cosine.abs()
    };
    direction + (lift - cosine) * normal
}

fn next_hit<N: Number>(scene: &Scene<'_>, from: [f64; 3], way: DVec3) -> Option<Hit<N>> {
    let ray = UnitRay::new(from, way.to_array()).ready::<N>(scene);
    closest::<N, List>(scene, &ray.expect("a ray"), &mut NoCount)
}

/// Returns whether a ray that starts well outside of a torus exactly enters it again. In the pit of a torus that meets
/// its axis, the start is as near to the wall as the pit is narrow. There the ray need only start outside.
fn enters_elsewhere<N: Number>(
    solid: &Solid,
    (from, way): ([f64; 3], DVec3),
    (hit, again): (&Hit<N>, &Hit<N>),
) -> bool {
    let least = match *solid {
        Solid::Torus(Torus {
            major_radius,
            minor_radius,
            ..
        }) if minor_radius < major_radius => 0.5,
        Solid::Torus(Torus { .. }) => 0.0,
        _ => return false,
    };
    let t = N::far_to_f64(again.t);
    let error = again.error.length_to_f64();
    let line = Line::new(from, (way / way.abs().max_element()).to_array());
    let (grown, begin) = (0.5 * error, Real::of(0.0));
    let crossings = Crossings::new(solid, &line, grown);
    let apart = solid.excess(from);
    apart > least * hit.error.length_to_f64() && crossings.may_be_met_at(&Real::of(t), &begin)
}

/// Number of rays that left a solid, that went on inside of it, and that could not because it is too thin.
#[derive(Default)]
struct Left {
    away: usize,
    through: usize,
    thin: usize,
}

impl Left {
    /// Sends rays at the only solid of a scene, and lets others leave it on both sides where it is hit.
    fn leave<N: Number>(
        &mut self,
        solid: &Solid,
        rays: impl IntoIterator<Item = ([f64; 3], [f64; 3])>,
        random: &mut Random,
    ) {
        let blob = blob_of([solid]);
        let scene = blob.scene().expect("a scene");
        for (origin, slope) in rays {
            let hit = next_hit::<N>(&scene, origin, DVec3::from_array(slope));
            let Some(hit) = hit.filter(|hit| hit.primitive == 0) else {
                continue;
            };
            for side in [1.0, -1.0] {
                let normal = side * DVec3::from_array(hit.normal.map(N::ratio_to_f64));
                let mut way = outward(random, normal);
                if !solid.is_bounded() {
                    // A ray nearly parallel to it hits it somewhere, or not, as slopes are rounded.
                    way += normal * f64::powi(2.0, -16);
                }
                let from = depart(&scene, &hit, side > 0.0);
                let outside = side > 0.0 || solid.is_flat();
                if !outside && solid.excess(from) > -0.5 * hit.error.length_to_f64() {
                    self.thin += 1;
                    continue;
                }
                let again = next_hit::<N>(&scene, from, way).filter(|next| next.primitive == 0);
                let about = || {
                    let format = N::FORMAT.name();
                    format!(
                        "{format} {solid:?} {origin:?} {slope:?} {hit:?} {side} {way:?} {again:?}"
                    )
                };
                if outside {
                    self.away += 1;
                    // A torus is not convex.
                    let is_elsewhere = |again: &Hit<N>| {
                        again.front && enters_elsewhere::<N>(solid, (from, way), (&hit, again))
                    };
                    assert!(again.as_ref().is_none_or(is_elsewhere), "{}", about());
                } else {
                    self.through += 1;
                    assert!(again.is_some_and(|again| !again.front), "{}", about());
                }
            }
        }
    }

    fn report<N: Number>(&self, name: &str) {
        let Self {
            away,
            through,
            thin,
        } = self;
        eprintln!(
            "{name:9} {:5}: {away} rays away and {through} rays through, no self-hit; {thin} where \
             the solid is thinner than the error bound",
            N::FORMAT.name()
        );
    }
}

fn no_self_hits<N: Number>(shape: usize, shapes: usize, rays_each: usize) {
    let mut random = Random(77);
    let mut left = Left::default();
    for case in cases(500 + shape as u64, shape, shapes, rays_each) {
        left.leave::<N>(&case.solid, case.rays, &mut random);
    }
    left.report::<N>(SHAPES[shape]);
}

/// A ground as large as the lattice. Its top lies near a height, level or nearly so.
fn ground(random: &mut Random, shape: usize) -> (Solid, f64) {
    // Spheres and cones reach twice as far down.
    let most = if matches!(SHAPES[shape], "triangle" | "box" | "disc") {
        15_000.0
    } else {
        8000.0
    };
    let extent = lattice(random.magnitude(100.0, most));
    let height = lattice(random.signed() * [0.0, 100.0, 15_000.0][random.below(3)]);
    let mut tilt = || [0.0, lattice(extent * random.magnitude(1e-6, 1e-2))][random.below(2)];
    let (rise, turn) = (tilt(), tilt());
    let solid = match SHAPES[shape] {
        "sphere" => Solid::Sphere(Sphere {
            center: [0.0, height - extent, 0.0].into(),
            radius: extent,
        }),
        "box" => Solid::Box(Cuboid {
            min: [-extent, height - 1.0, -extent].into(),
            max: [extent, height, extent].into(),
        }),
        "disc" => Solid::Disc(Disc {
            center: [0.0, height, 0.0].into(),
            normal: [(-rise * 256.0).round(), (extent * 256.0).round(), 0.0].into(),
            radius: extent,
        }),
        "triangle" => Solid::Triangle([
            [-extent, height - rise, -extent].into(),
            [0.0, height + turn, extent].into(),
            [extent, height + rise, -extent].into(),
        ]),
        _ => Solid::Cone(Cone {
            base: [-turn, height - extent, -rise].into(),
            apex: [0.0, height, 0.0].into(),
            base_radius: extent,
            apex_radius: lattice(extent * [1.0, 0.5][random.below(2)]),
        }),
    };
    (solid, height)
}

/// A ray that hits a ground as large as the scene from close by leaves it. The bound is that of the place and not of
/// the scene.
#[test]
fn rays_that_leave_a_large_ground_do_not_meet_it() {
    fn judge<N: Number>(shape: usize) {
        let mut random = Random(79);
        let mut left = Left::default();
        for _ in 0..part_of(300, 3000) {
            let (solid, height) = ground(&mut random, shape);
            let rays = (0..part_of(60, 300)).map(|_| {
                let reach = random.magnitude(0.01, 1000.0);
                let mut near = || reach * random.signed();
                let target = [near(), height, near()];
                let from = [near(), height + near().abs() + reach, near()];
                (from, [0, 1, 2].map(|k| target[k] - from[k]))
            });
            let rays: Vec<_> = rays.collect();
            left.leave::<N>(&solid, rays, &mut random);
        }
        assert!(left.away > 1000, "{}", left.away);
        left.report::<N>(SHAPES[shape]);
    }
    for shape in 0..5 {
        every_format!(judge(shape));
    }
}

/// In the middle of the lattice every coordinate of a hit can be 0, and the bound as small as it gets.
#[test]
fn rays_that_leave_the_middle_of_the_lattice_do_not_come_back() {
    fn judge<N: Number>(solid: &Solid, random: &mut Random) -> usize {
        let blob = blob_of([solid]);
        let scene = blob.scene().expect("a scene");
        let way = DVec3::from_array(random.direction());
        let Some(hit) = next_hit::<N>(&scene, (-way).to_array(), way) else {
            return 0;
        };
        let outside = DVec3::from_array(hit.normal.map(N::ratio_to_f64));
        for side in [true, false] {
            let normal = if side { outside } else { -outside };
            let way = outward(random, normal) + normal * f64::powi(2.0, -16);
            let again = next_hit::<N>(&scene, depart(&scene, &hit, side), way);
            assert!(again.is_none(), "{solid:?} {hit:?} {way} {again:?}");
        }
        1
    }
    let mut random = Random(80);
    let mut hits = 0;
    for _ in 0..part_of(2000, 20_000) {
        let normal = (DVec3::from_array(random.direction()) * 256.0).round();
        let (across, along) = normal.normalize().any_orthonormal_pair();
        let corner = |x: f64, y: f64| (across * x + along * y).map(lattice);
        let corners = [corner(8.0, 0.0), corner(-4.0, 7.0)];
        let solids = [
            Solid::Disc(Disc {
                center: DVec3::ZERO,
                normal,
                radius: 8.0,
            }),
            Solid::Plane(Plane {
                point: DVec3::ZERO,
                normal,
            }),
            Solid::Triangle([corners[0], corners[1], -corners[0] - corners[1]]),
        ];
        for solid in &solids {
            hits += judge::<Fixed>(solid, &mut random);
            hits += judge::<f32>(solid, &mut random);
            hits += judge::<f64>(solid, &mut random);
        }
    }
    assert!(hits > 1000, "{hits}");
}

/// The full run has 1,000 shapes and 1,000 rays at each. The sizes of a shape span seven magnitudes and its offset is
/// up to the lattice's end.
#[test]
fn rays_that_leave_a_shape_do_not_meet_it() {
    let (shapes, rays) = (part_of(50, 1000), part_of(100, 1000));
    let mut failures = Vec::new();
    for shape in 0..SHAPES.len() {
        fn one<N: Number>(shape: usize, shapes: usize, rays: usize, failures: &mut Vec<String>) {
            let result = std::panic::catch_unwind(|| no_self_hits::<N>(shape, shapes, rays));
            let name = || format!("{} {}", SHAPES[shape], N::FORMAT.name());
            failures.extend(result.err().map(|_| name()));
        }
        every_format!(one(shape, shapes, rays, &mut failures));
    }
    assert!(failures.is_empty(), "{failures:?}");
}

/// Cases of earlier defects. One normal leaned along a needle, so that rays along the needle hit it again. Another was
/// turned to the ray although its position was well known.
#[test]
fn normals_of_needles_neither_lean_nor_turn() {
    fn judge<N: Number>(solid: &Solid, origin: [f64; 3], slope: [f64; 3]) {
        let Solid::Cone(Cone {
            base,
            apex,
            base_radius,
            apex_radius,
        }) = *solid
        else {
            unreachable!("needles are cones");
        };
        let blob = blob_of([solid]);
        let scene = blob.scene().expect("a scene");
        let hit = next_hit::<N>(&scene, origin, slope.into()).expect("a hit");
        let normal = DVec3::from_array(hit.normal.map(N::ratio_to_f64));
        let along = DVec3::from_array(apex.into()) - DVec3::from_array(base.into());
        let taper = (base_radius - apex_radius) / along.length();
        let lean = normal.dot(along.normalize()) - taper / taper.hypot(1.0);
        let mantle = &solid.normals(point_of(&hit))[0];
        // The angle of a short cone is known to a sub-step.
        let angle = f64::powi(2.0, -13) / mantle.size;
        assert!(lean.abs() < 1e-6 + angle, "{} {lean}", N::FORMAT.name());
        let exact = DVec3::from_array([0, 1, 2].map(|k| mantle.exact[k].to_f64()));
        assert!(normal.dot(exact) > 0.99, "{} {normal}", N::FORMAT.name());
    }
    let needle = Solid::Cone(Cone {
        base: [-7_134.171_875, -760.988_281_25, 8_139.914_062_5].into(),
        apex: [9_334.457_031_25, -856.992_187_5, -9_317.890_625].into(),
        base_radius: 0.058_593_75,
        apex_radius: 0.0,
    });
    let origin = [-5_363.222_656_25, -771.320_312_5, 6_262.582_031_25];
    let slope = [0.400_294_780_731_201_17, -1.0, 0.383_115_768_432_617_2];
    every_format!(judge(&needle, origin, slope));
    let pin = Solid::Cone(Cone {
        base: [11_404.183_593_75, 2_806.335_937_5, 2_562.867_187_5].into(),
        apex: [11_404.125, 2_806.257_812_5, 2_562.859_375].into(),
        base_radius: 0.003_906_25,
        apex_radius: 0.003_906_25,
    });
    let origin = [11_404.167_968_75, 2_806.308_593_75, 2_541.125];
    // In single precision the pin is thinner than the bound.
    judge::<Fixed>(&pin, origin, [0.0, 0.0, 1.0]);
    judge::<f64>(&pin, origin, [0.0, 0.0, 1.0]);
}

/// A shape and the same shape larger by a gap on all sides, along the axes of the lattice.
fn nested(random: &mut Random, shape: usize, gap: f64) -> (Solid, Solid) {
    let place = DVec3::from_array(random.direction()) * random.magnitude(1.0, 10_000.0);
    let place = place.map(lattice);
    let size = lattice(random.magnitude(1.0, 5000.0));
    let axis = random.below(3);
    let up = DVec3::AXES[axis];
    let both = |make: &dyn Fn(f64) -> Solid| (make(0.0), make(gap));
    match SHAPES[shape] {
        "sphere" => both(&|gap| {
            Solid::Sphere(Sphere {
                center: place,
                radius: size + gap,
            })
        }),
        "box" => both(&|gap| {
            Solid::Box(Cuboid {
                min: (place - size - gap),
                max: (place + size + gap),
            })
        }),
        "disc" => both(&|gap| {
            Solid::Disc(Disc {
                center: (place + up * gap),
                normal: up,
                radius: size * if gap > 0.0 { 4.0 } else { 1.0 },
            })
        }),
        "triangle" => both(&|gap| {
            let size = size * if gap > 0.0 { 4.0 } else { 1.0 };
            let (u, v) = (DVec3::AXES[(axis + 1) % 3], DVec3::AXES[(axis + 2) % 3]);
            let place = place + up * gap;
            let corners = [
                place - u * size - v * size,
                place + u * size,
                place + v * size,
            ];
            Solid::Triangle(corners.map(|corner| corner.map(lattice)))
        }),
        _ => both(&|gap| {
            Solid::Cone(Cone {
                base: (place - up * (size + gap)),
                apex: (place + up * (size + gap)),
                base_radius: size + gap,
                apex_radius: size + gap,
            })
        }),
    }
}

/// A second surface at eight error bounds' distance is still met: the departure loses no contact.
#[test]
fn a_second_surface_close_by_is_met() {
    fn judge<N: Number>(shape: usize) {
        let mut random = Random(78);
        let (mut rays, mut least) = (0, f64::INFINITY);
        for _ in 0..part_of(60, 1000) {
            // The bound of the farthest point, in whole steps of the lattice.
            // A box's adds up its coordinates.
            let farthest = if SHAPES[shape] == "box" {
                48_000.0
            } else {
                40_000.0
            };
            let worst = N::error_bound(N::length_from_f64(farthest)).length_to_f64();
            let gap = (8.0 * worst * 256.0).ceil() / 256.0;
            let (inner, outer) = nested(&mut random, shape, gap);
            let blob = blob_of([&inner, &outer]);
            let scene = blob.scene().expect("a scene");
            for _ in 0..part_of(40, 100) {
                // Between the two, or from far away with only the inner one in the way.
                let way = DVec3::from_array(random.direction());
                let Some(hit) = from_between::<N>(&scene, &inner, &mut random, way) else {
                    continue;
                };
                let normal = DVec3::from_array(hit.normal.map(N::ratio_to_f64));
                // Flat shapes are left steeply enough to pass below the second one.
                let way = outward(&mut random, normal) + normal * 0.25;
                let next = next_hit::<N>(&scene, depart(&scene, &hit, true), way);
                let met = next.is_some_and(|next| next.primitive == 1);
                assert!(
                    met,
                    "{} {inner:?} {gap} {hit:?} {way:?} {next:?}",
                    N::FORMAT.name()
                );
                assert!(gap >= 8.0 * hit.error.length_to_f64());
                rays += 1;
                least = least.min(gap / hit.error.length_to_f64());
            }
        }
        assert!(rays > 0);
        eprintln!(
            "{:9} {:5}: {rays} rays met the surface at {least:.1} error bounds' distance or more",
            SHAPES[shape],
            N::FORMAT.name()
        );
    }
    for shape in 0..5 {
        every_format!(judge(shape));
    }
}

/// A hit of the inner of two nested shapes from the outside, by a ray that starts between them.
fn from_between<N: Number>(
    scene: &Scene<'_>,
    inner: &Solid,
    random: &mut Random,
    way: DVec3,
) -> Option<Hit<N>> {
    let middle = match inner {
        Solid::Triangle([a, b, c]) => (a + b + c) / 3.0,
        inner => inner.middle(),
    };
    let extent = inner.size() * 0.2;
    let target = middle + DVec3::from_array(random.direction()) * extent;
    let start = target - way * inner.size() * 4.0;
    // The first hit of the inner one as if the outer one were not there: tmin moves past it.
    let mut ray = UnitRay::new(start.to_array(), way.to_array());
    for _ in 0..4 {
        let ready = ray.ready::<N>(scene)?;
        let hit = closest::<N, List>(scene, &ready, &mut NoCount)?;
        if hit.primitive == 0 {
            return hit.front.then_some(hit);
        }
        let next = N::far_to_f64(hit.t);
        ray.tmin = next + next * f64::powi(2.0, -22) + f64::powi(2.0, -12);
    }
    None
}
