//! The reported displacement bounds the distance between the given and the snapped surfaces, and
//! compiled scenes load.

use glam::DVec3;
use gridel_core::geometry::Geometry;
use gridel_core::{Bvh, Kind, NoCount, Structure};
use gridel_host::compile::{Compiled, Options, compile};
use gridel_host::scene::{self, Shape};
use gridel_host::shape::{Cone, Cuboid, Disc, Map, Solid, Sphere, Torus};
use gridel_tests::effort::part_of;
use gridel_tests::query::{UnitRay, closest};
use gridel_tests::random::Random;
use gridel_tests::scenes;
use gridel_tests::shapes::{self, distance, surface_point};
use rayon::prelude::*;

fn vector(random: &mut Random) -> DVec3 {
    DVec3::from_array(random.direction())
}

/// The shapes of a scene in units, by primitive.
fn given(scene: &scene::Scene, origin: DVec3, unit: f64) -> Vec<Solid> {
    let in_units = Map {
        point: &|point| (point - origin) / unit,
        direction: &|direction| direction,
        length: &|length| length / unit,
    };
    let objects = scene.objects.iter();
    objects
        .flat_map(|object| shapes::primitives(&object.shape.map(&in_units)))
        .collect()
}

/// Samples all surfaces of a compiled scene that was not cut, and returns the largest displacement
/// reported, in steps.
fn check(scene: &scene::Scene, compiled: &Compiled, samples: usize, random: &mut Random) -> f64 {
    let blob = compiled.blob.scene().expect("what compiles loads");
    let header = blob.header();
    let unit = f64::powi(2.0, header.unit_exponent.into());
    let origin = DVec3::from_array(header.origin);
    let given = given(scene, origin, unit);
    let report = &compiled.report;
    assert_eq!(report.displacements.len(), given.len());
    let largest = report.largest_displacement / report.step;
    for kind in Kind::ALL {
        for slot in 0..blob.count(kind) {
            let number = blob.primitive(kind, slot as u32) as usize;
            let snapped = Solid::of(blob.geometry(kind, slot).expect("a shape"));
            let steps = f64::from(report.displacements[number]);
            assert!(steps <= largest);
            // The rounding of this arithmetic.
            let bound = steps * report.step / unit + 1e-9;
            for _ in 0..samples {
                let surfaces = [&given[number], &snapped];
                for (from, to) in [(0, 1), (1, 0)] {
                    let point = surface_point(surfaces[from], random);
                    let distance = distance(surfaces[to], point);
                    assert!(
                        distance <= bound,
                        "{surfaces:?} at {point}: {distance} units, {bound} reported"
                    );
                }
            }
        }
    }
    largest
}

fn point(random: &mut Random, size: f64) -> DVec3 {
    DVec3::from_array([0; 3].map(|_| random.signed() * size))
}

/// A random shape, flat or long as often as not.
fn shape(random: &mut Random, kind: usize) -> Shape {
    let size = random.magnitude(1e-3, 1.0);
    let center = point(random, 1.0);
    let thin = if random.one_in(2) {
        random.magnitude(1e-7, 1.0)
    } else {
        1.0
    };
    match kind {
        0 => Shape::Sphere(Sphere {
            center,
            radius: size,
        }),
        1 => {
            let reach = point(random, size).abs() * DVec3::new(1.0, thin, 1.0);
            Shape::Box(Cuboid {
                min: center - reach,
                max: center + reach,
            })
        }
        2 => Shape::Mesh {
            vertices: vec![
                center,
                center + point(random, size),
                center + point(random, size * thin),
            ],
            triangles: vec![[0, 1, 2]],
        },
        3 => Shape::Disc(Disc {
            center,
            normal: if random.one_in(2) {
                point(random, 1.0)
            } else {
                (point(random, 20.0)).round() + DVec3::X * 40.0
            },
            radius: size,
        }),
        7 => Shape::Torus(Torus {
            center,
            axis: point(random, 1.0),
            major_radius: size,
            minor_radius: size * [thin, 0.5, 1.0, 2.0][random.below(4)],
        }),
        _ => {
            let (tall, wide) = if random.one_in(2) {
                (thin, 1.0)
            } else {
                (1.0, thin)
            };
            let axis = vector(random) * size * tall;
            let radius = size * wide * random.magnitude(0.1, 1.0);
            let other = size * wide * random.magnitude(0.1, 1.0);
            Shape::Cone(Cone {
                base: center - axis,
                apex: center + axis,
                base_radius: radius,
                apex_radius: match kind {
                    4 => radius,
                    5 => 0.0,
                    _ => other,
                },
            })
        }
    }
}

fn compiled(scene: &scene::Scene, lattice_bits: u8, structures: &[Structure]) -> Compiled {
    let options = Options {
        structures: structures.to_vec(),
        lattice_bits,
        ..Options::default()
    };
    compile(scene, &options).expect("compiles")
}

#[test]
fn displacement_bounds_every_surface_at_every_lattice() {
    let all = Structure::ALL.into_iter();
    let proved: Vec<_> = all.filter(|structure| structure.is_proved()).collect();
    (0..part_of(60, 3000)).into_par_iter().for_each(|batch| {
        let mut random = Random(batch as u64);
        for lattice_bits in 10..=24 {
            // Alone it reaches to the ends of the lattice.
            let count = if random.one_in(2) { 1 } else { 8 };
            let kind = random.below(8);
            let shapes = (0..count).map(|more| shape(&mut random, (kind + more) % 8));
            let scene = scenes::of(shapes.collect::<Vec<_>>());
            let compiled = compiled(&scene, lattice_bits, &proved);
            check(&scene, &compiled, 24, &mut random);
        }
    });
}

/// A coin, its thickness in steps of a lattice over a scene of half size 1.
fn coin(random: &mut Random, lattice_bits: u8, center: DVec3, radius: f64) -> Shape {
    let step = f64::powi(2.0, 1 - i32::from(lattice_bits));
    let axis = vector(random) * step * random.magnitude(0.2, 30.0) * 0.5;
    Shape::Cone(Cone {
        base: center - axis,
        base_radius: radius,
        apex: center + axis,
        apex_radius: radius * if random.one_in(2) { 1.0 } else { random.unit() },
    })
}

/// 10^6 coins in the full run, alone and many together.
#[test]
fn tilted_coins_load_and_lie_within_their_displacement() {
    let batches = part_of(100, 20_000);
    let far = (0..batches).into_par_iter().map(|batch| {
        let mut random = Random(0xc01 + batch as u64);
        let mut most = 0.0_f64;
        for lattice_bits in [10, 12, 14, 16, 20, 24] {
            let alone = coin(&mut random, lattice_bits, DVec3::ZERO, 1.0);
            let many = (0..8).map(|_| {
                let (center, radius) = (point(&mut random, 0.5), random.unit());
                coin(&mut random, lattice_bits, center, radius)
            });
            let many: Vec<_> = many.collect();
            for shapes in [vec![alone], many] {
                let scene = scenes::of(shapes);
                let compiled = compiled(&scene, lattice_bits, &[Structure::DualSplit]);
                let largest = check(&scene, &compiled, 12, &mut random);
                if lattice_bits <= 16 {
                    most = most.max(largest);
                } else {
                    let is_far = compiled.report.far_moved.count() > 0;
                    assert_eq!(is_far, largest > 4.0, "{largest} steps");
                    // A coin as wide as the scene.
                    assert!(largest < 4000.0, "{largest} steps");
                }
            }
        }
        most
    });
    let most = far.reduce(|| 0.0, f64::max);
    eprintln!(
        "{} coins; at most {most:.2} steps up to 16 bits",
        batches * 54
    );
    // The least that 10^6 of them keep; beyond 4 steps the compiler warns.
    assert!(most <= 8.0, "{most} steps");
}

/// The axis leaned by 28 degrees, or the blob did not load.
#[test]
fn coin_of_ten_lattice_bits_keeps_its_axis() {
    let (base, apex) = (
        DVec3::new(0.12, -0.53, -0.95),
        DVec3::new(0.118, -0.522, -0.949),
    );
    let scene = scenes::of([Shape::Cone(Cone {
        base,
        base_radius: 1.0,
        apex,
        apex_radius: 1.0,
    })]);
    let compiled = compiled(&scene, 10, &[Structure::Bvh]);
    check(&scene, &compiled, 2000, &mut Random(1));
    let blob = compiled.blob.scene().expect("loads");
    let Some(Geometry::Cone(cone)) = blob.geometry(Kind::Cone, 0) else {
        panic!("a cone");
    };
    let axis = [0, 1, 2].map(|k| f64::from(cone.apex[k] - cone.base[k]));
    let lean = DVec3::from_array(axis).angle_between(apex - base);
    assert!(lean.to_degrees() < 0.1, "{} degrees", lean.to_degrees());
    assert!(compiled.report.largest_displacement < 2.0 * compiled.report.step);
}

#[test]
fn disc_with_small_integer_normal_is_exact() {
    let disc = |normal: DVec3| {
        scenes::of([Shape::Disc(Disc {
            center: DVec3::ZERO,
            normal,
            radius: 4.0,
        })])
    };
    for normal in [[1.0, 3.0, 0.0], [-2.0, 5.0, 7.0], [0.1, 0.3, 0.0]] {
        let normal = DVec3::from_array(normal);
        let compiled = compiled(&disc(normal), 24, &[Structure::Bvh]);
        assert!(compiled.report.largest_displacement < 1e-12);
        let blob = compiled.blob.scene().expect("loads");
        let Some(Geometry::Disc(disc)) = blob.geometry(Kind::Disc, 0) else {
            panic!("a disc");
        };
        let stored = DVec3::from_array(disc.normal.map(f64::from));
        assert!(stored.abs().max_element() <= 7.0, "{stored}");
        // From twice the normal, back along it, through the center.
        let ray = UnitRay::new((stored * 1000.0).to_array(), (-stored).to_array());
        let ray = ray.ready::<f64>(&blob).expect("a ray");
        let hit = closest::<f64, Bvh>(&blob, &ray, &mut NoCount).expect("a hit");
        assert_eq!(hit.t, 1000.0 * stored.abs().max_element());
    }
    let rounded = compiled(
        &disc(DVec3::new(1.0, 2.0_f64.sqrt(), 3.0_f64.sqrt())),
        24,
        &[],
    );
    assert!(rounded.report.largest_displacement > 0.0);
    check(
        &disc(DVec3::new(1.0, 2.0_f64.sqrt(), 3.0_f64.sqrt())),
        &rounded,
        500,
        &mut Random(2),
    );
}

/// Surfaces that the lattice does not move have displacement 0.
#[test]
fn surfaces_on_the_lattice_have_no_displacement() {
    let on_lattice = |k: u32| f64::from(k) / 64.0;
    let scene = scenes::of([
        Shape::Sphere(Sphere {
            center: DVec3::splat(on_lattice(3)),
            radius: on_lattice(70),
        }),
        Shape::Cone(Cone {
            base: DVec3::ZERO,
            base_radius: on_lattice(9),
            apex: DVec3::new(on_lattice(1), on_lattice(2), 0.0),
            apex_radius: 0.0,
        }),
        Shape::Box(Cuboid {
            min: DVec3::ZERO,
            max: DVec3::ONE,
        }),
    ]);
    let report = compiled(&scene, 16, &[]).report;
    assert_eq!(report.displacements, [0.0; 3]);
    assert_eq!(report.largest_displacement, 0.0);
}
