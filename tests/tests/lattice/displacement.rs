//! The reported displacement bounds how far apart the given and the snapped surfaces are, and what
//! compiles loads.

use glam::{DVec2, DVec3};
use gridel_core::geometry::Geometry;
use gridel_core::{Bvh, Kind, NoCount, Structure};
use gridel_host::compile::{Compiled, Options, compile};
use gridel_host::scene::{self, Shape};
use gridel_tests::effort::part_of;
use gridel_tests::query::{UnitRay, closest};
use gridel_tests::random::Random;
use gridel_tests::scenes;
use rayon::prelude::*;

/// A surface in units.
#[derive(Clone, Copy, Debug)]
enum Surface {
    Sphere(DVec3, f64),
    Box(DVec3, DVec3),
    Disc(DVec3, DVec3, f64),
    Cone([(DVec3, f64); 2]),
    Triangle([DVec3; 3]),
    Torus(DVec3, DVec3, [f64; 2]),
}

fn any_normal(axis: DVec3) -> DVec3 {
    axis.any_orthonormal_vector()
}

fn vector(random: &mut Random) -> DVec3 {
    DVec3::from_array(random.direction())
}

impl Surface {
    /// A point of the surface, often at an edge.
    fn point(&self, random: &mut Random) -> DVec3 {
        let at_end = random.one_in(2);
        let part = |random: &mut Random| if at_end { 1.0 } else { random.unit() };
        let around = |random: &mut Random, axis: DVec3| {
            let axis = axis.normalize();
            let (sin, cos) = (random.unit() * std::f64::consts::TAU).sin_cos();
            let across = any_normal(axis);
            across * cos + axis.cross(across) * sin
        };
        match *self {
            Self::Sphere(center, radius) => center + vector(random) * radius,
            Self::Box(low, high) => {
                let mut point = DVec3::from_array([0; 3].map(|_| part(random)));
                for k in 0..3 {
                    if random.one_in(2) {
                        point[k] = 1.0 - point[k];
                    }
                }
                point[random.below(3)] = random.below(2) as f64;
                low + (high - low) * point
            }
            Self::Disc(center, normal, radius) => {
                center + around(random, normal) * radius * part(random)
            }
            Self::Cone([(base, base_radius), (apex, apex_radius)]) => {
                let outward = around(random, apex - base);
                let along = random.unit();
                match random.below(3) {
                    0 => base + outward * base_radius * part(random),
                    1 => apex + outward * apex_radius * part(random),
                    _ => {
                        let radius = base_radius + (apex_radius - base_radius) * along;
                        base + (apex - base) * along + outward * radius
                    }
                }
            }
            Self::Torus(center, axis, [major, minor]) => {
                let outward = around(random, axis);
                loop {
                    let angle = std::f64::consts::TAU * random.unit();
                    let across = major + minor * angle.cos();
                    // The inner sheet of a spindle torus is no surface.
                    if across >= 0.0 {
                        let along = axis.normalize() * minor * angle.sin();
                        break center + outward * across + along;
                    }
                }
            }
            Self::Triangle(corners) => {
                if at_end {
                    return corners[random.below(3)];
                }
                let mut weights = [0; 3].map(|_| random.unit());
                if random.one_in(2) {
                    weights[random.below(3)] = 0.0;
                }
                let sum: f64 = weights.iter().sum();
                (0..3).map(|k| corners[k] * (weights[k] / sum)).sum()
            }
        }
    }

    /// How far a point lies from the surface.
    fn distance(&self, point: DVec3) -> f64 {
        match *self {
            Self::Sphere(center, radius) => (point.distance(center) - radius).abs(),
            Self::Box(low, high) => {
                let outside = (low - point).max(point - high);
                if outside.max_element() <= 0.0 {
                    -outside.max_element()
                } else {
                    outside.max(DVec3::ZERO).length()
                }
            }
            Self::Disc(center, normal, radius) => {
                let (along, across) = cylindrical(point - center, normal);
                along.hypot((across - radius).max(0.0))
            }
            Self::Cone([(base, base_radius), (apex, apex_radius)]) => {
                let axis = apex - base;
                let (along, across) = cylindrical(point - base, axis);
                let height = axis.length();
                let profile = [
                    [0.0, 0.0],
                    [0.0, base_radius],
                    [height, apex_radius],
                    [height, 0.0],
                ];
                let ends = profile.windows(2);
                ends.map(|ends| {
                    let [from, to] = [0, 1].map(|k| DVec3::new(ends[k][0], ends[k][1], 0.0));
                    from_segment(DVec3::new(along, across, 0.0), from, to)
                })
                .fold(f64::INFINITY, f64::min)
            }
            Self::Torus(center, axis, [major, minor]) => {
                let (along, across) = cylindrical(point - center, axis);
                let from_circle = (across - major).hypot(along);
                if from_circle >= minor || minor <= major {
                    return (from_circle - minor).abs();
                }
                // Beneath the surface of a spindle torus: outward, or if that leads to the axis, to the pit.
                let part = minor / from_circle.max(f64::MIN_POSITIVE);
                let above = DVec2::new(major + (across - major) * part, along.abs() * part);
                let pit = DVec2::new(0.0, (minor * minor - major * major).sqrt());
                let nearest = if above.x < 0.0 { pit } else { above };
                nearest.distance(DVec2::new(across, along.abs()))
            }
            Self::Triangle([a, b, c]) => {
                let normal = (b - a).cross(c - a);
                let is_inside = [(a, b), (b, c), (c, a)]
                    .iter()
                    .all(|(from, to)| (to - from).cross(point - from).dot(normal) >= 0.0);
                if is_inside {
                    (point - a).dot(normal.normalize()).abs()
                } else {
                    [(a, b), (b, c), (c, a)]
                        .iter()
                        .map(|&(from, to)| from_segment(point, from, to))
                        .fold(f64::INFINITY, f64::min)
                }
            }
        }
    }
}

/// How far a vector goes along an axis, and away from it.
fn cylindrical(vector: DVec3, axis: DVec3) -> (f64, f64) {
    let axis = axis.normalize();
    let along = vector.dot(axis);
    (along, (vector - axis * along).length())
}

fn from_segment(point: DVec3, from: DVec3, to: DVec3) -> f64 {
    let way = to - from;
    let part = (point - from).dot(way) / way.length_squared().max(f64::MIN_POSITIVE);
    point.distance(from + way * part.clamp(0.0, 1.0))
}

/// The shapes of a scene as surfaces, by primitive.
fn given(scene: &scene::Scene, in_units: impl Fn(DVec3) -> DVec3, unit: f64) -> Vec<Surface> {
    let surfaces = scene.objects.iter().flat_map(|object| match &object.shape {
        Shape::Sphere { center, radius } => {
            vec![Surface::Sphere(in_units(*center), radius / unit)]
        }
        Shape::Box { min, max } => vec![Surface::Box(in_units(*min), in_units(*max))],
        Shape::Disc {
            center,
            normal,
            radius,
        } => vec![Surface::Disc(in_units(*center), *normal, radius / unit)],
        Shape::Torus {
            center,
            axis,
            major_radius,
            minor_radius,
        } => {
            let radii = [major_radius / unit, minor_radius / unit];
            vec![Surface::Torus(in_units(*center), *axis, radii)]
        }
        Shape::Cone {
            base,
            base_radius,
            apex,
            apex_radius,
        } => vec![Surface::Cone([
            (in_units(*base), base_radius / unit),
            (in_units(*apex), apex_radius / unit),
        ])],
        Shape::Mesh {
            vertices,
            triangles,
        } => triangles
            .iter()
            .map(|it| Surface::Triangle(it.map(|vertex| in_units(vertices[vertex as usize]))))
            .collect(),
    });
    surfaces.collect()
}

fn snapped(geometry: Geometry) -> Surface {
    let length = |x: i32| f64::from(x) / 256.0;
    let point = |p: [i32; 3]| DVec3::from_array(p.map(length));
    match geometry {
        Geometry::Triangle(corners) => Surface::Triangle(corners.map(point)),
        Geometry::Sphere { center, radius } => Surface::Sphere(point(center), length(radius)),
        Geometry::Box(cuboid) => Surface::Box(point(cuboid.lowest), point(cuboid.highest)),
        Geometry::Disc(disc) => Surface::Disc(
            point(disc.center),
            DVec3::from_array(disc.normal.map(f64::from)),
            length(disc.radius),
        ),
        Geometry::Torus(torus) => Surface::Torus(
            point(torus.center),
            DVec3::from_array(torus.axis.map(f64::from)),
            [length(torus.major_radius), length(torus.minor_radius)],
        ),
        Geometry::Cone(cone) => Surface::Cone([
            (point(cone.base), length(cone.base_radius)),
            (point(cone.apex), length(cone.apex_radius)),
        ]),
    }
}

/// Samples all surfaces of a compiled scene that was not cut, and returns the largest displacement
/// reported, in steps.
fn check(scene: &scene::Scene, compiled: &Compiled, samples: usize, random: &mut Random) -> f64 {
    let blob = compiled.blob.scene().expect("what compiles loads");
    let header = blob.header();
    let unit = f64::powi(2.0, header.unit_exponent.into());
    let origin = DVec3::from_array(header.origin);
    let given = given(scene, |point| (point - origin) / unit, unit);
    let report = &compiled.report;
    assert_eq!(report.displacements.len(), given.len());
    let largest = report.largest_displacement / report.step;
    for kind in Kind::ALL {
        for slot in 0..blob.count(kind) {
            let number = blob.primitive(kind, slot as u32) as usize;
            let snapped = snapped(blob.geometry(kind, slot).expect("a shape"));
            let steps = f64::from(report.displacements[number]);
            assert!(steps <= largest);
            // What the arithmetic here rounds.
            let bound = steps * report.step / unit + 1e-9;
            for _ in 0..samples {
                let surfaces = [given[number], snapped];
                for (from, to) in [(0, 1), (1, 0)] {
                    let point = surfaces[from].point(random);
                    let distance = surfaces[to].distance(point);
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
        0 => Shape::Sphere {
            center,
            radius: size,
        },
        1 => {
            let reach = point(random, size).abs() * DVec3::new(1.0, thin, 1.0);
            Shape::Box {
                min: center - reach,
                max: center + reach,
            }
        }
        2 => Shape::Mesh {
            vertices: vec![
                center,
                center + point(random, size),
                center + point(random, size * thin),
            ],
            triangles: vec![[0, 1, 2]],
        },
        3 => Shape::Disc {
            center,
            normal: if random.one_in(2) {
                point(random, 1.0)
            } else {
                (point(random, 20.0)).round() + DVec3::X * 40.0
            },
            radius: size,
        },
        7 => Shape::Torus {
            center,
            axis: point(random, 1.0),
            major_radius: size,
            minor_radius: size * [thin, 0.5, 1.0, 2.0][random.below(4)],
        },
        _ => {
            let (tall, wide) = if random.one_in(2) {
                (thin, 1.0)
            } else {
                (1.0, thin)
            };
            let axis = vector(random) * size * tall;
            let radius = size * wide * random.magnitude(0.1, 1.0);
            let other = size * wide * random.magnitude(0.1, 1.0);
            Shape::Cone {
                base: center - axis,
                apex: center + axis,
                base_radius: radius,
                apex_radius: match kind {
                    4 => radius,
                    5 => 0.0,
                    _ => other,
                },
            }
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
    Shape::Cone {
        base: center - axis,
        base_radius: radius,
        apex: center + axis,
        apex_radius: radius * if random.one_in(2) { 1.0 } else { random.unit() },
    }
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
    assert!(most <= 4.0, "{most} steps");
}

/// The axis leaned by 28 degrees, or the blob did not load.
#[test]
fn coin_of_ten_lattice_bits_keeps_its_axis() {
    let (base, apex) = (
        DVec3::new(0.12, -0.53, -0.95),
        DVec3::new(0.118, -0.522, -0.949),
    );
    let scene = scenes::of([Shape::Cone {
        base,
        base_radius: 1.0,
        apex,
        apex_radius: 1.0,
    }]);
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
        scenes::of([Shape::Disc {
            center: DVec3::ZERO,
            normal,
            radius: 4.0,
        }])
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
        // From twice the normal, back along it, through the centre.
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

/// What the lattice does not move is said not to be moved.
#[test]
fn surfaces_on_the_lattice_have_no_displacement() {
    let on_lattice = |k: u32| f64::from(k) / 64.0;
    let scene = scenes::of([
        Shape::Sphere {
            center: DVec3::splat(on_lattice(3)),
            radius: on_lattice(70),
        },
        Shape::Cone {
            base: DVec3::ZERO,
            base_radius: on_lattice(9),
            apex: DVec3::new(on_lattice(1), on_lattice(2), 0.0),
            apex_radius: 0.0,
        },
        Shape::Box {
            min: DVec3::ZERO,
            max: DVec3::ONE,
        },
    ]);
    let report = compiled(&scene, 16, &[]).report;
    assert_eq!(report.displacements, [0.0; 3]);
    assert_eq!(report.largest_displacement, 0.0);
}
