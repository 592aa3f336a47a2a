//! Walking the grid and the octree where it goes wrong (rays in planes, through corners, from afar).
//!
//! Small spheres lie in every cell and at the corners of many. Every ray is traced in windows along
//! its path, so that each cell on it must yield its primitives. A skipped cell gives an answer that
//! differs from brute force.

use glam::DVec3;
use gridel_core::{Counters, Grid, Number, Scene, Structure};
use gridel_host::blob::Blob;
use gridel_host::compile::{CompileError, Options, compile};
use gridel_host::scene::{self, Shape};
use gridel_host::shape::{Cone, Cuboid, Disc, Sphere};
use gridel_tests::query::{HitBits, UnitRay, closest, through};
use gridel_tests::random::Random;
use gridel_tests::{every_format, scenes};

const CELLS: u32 = 8;

fn blob(scene: &scene::Scene, divisions: [u32; 3]) -> Blob {
    let options = Options {
        structures: vec![Structure::Grid, Structure::Octree],
        grid: Some(divisions),
        ..Options::default()
    };
    compile(scene, &options).expect("compiles").blob
}

/// A sphere in the middle of every cell of a cube of 8, and at every third corner, about `middle`.
fn lattice(middle: DVec3, flat: bool) -> scene::Scene {
    let mut shapes = vec![Shape::Box(Cuboid {
        min: middle - 4.0,
        max: middle - 3.999,
    })];
    shapes.push(Shape::Box(Cuboid {
        min: middle + 3.999,
        max: middle + 4.0,
    }));
    let layers = if flat { 1 } else { CELLS };
    for z in 0..layers {
        for y in 0..CELLS {
            for x in 0..CELLS {
                let cell = DVec3::new(x.into(), y.into(), z.into());
                let place = middle + cell - 3.5;
                let sphere = |center, radius| Shape::Sphere(Sphere { center, radius });
                shapes.push(sphere(
                    place,
                    0.2 + 0.02 * f64::from((x + 3 * y + 5 * z) % 7),
                ));
                if (x + y + z) % 3 == 0 && x > 0 && y > 0 && z > 0 {
                    shapes.push(sphere(place - 0.5, 0.25));
                }
            }
        }
    }
    if flat {
        let disc = |x: u32, y: u32| {
            Shape::Disc(Disc {
                center: middle + DVec3::new(f64::from(x) - 3.5, f64::from(y) - 3.5, 0.0),
                normal: DVec3::Z,
                radius: 0.3,
            })
        };
        shapes = (0..CELLS)
            .flat_map(|x| (0..CELLS).map(move |y| disc(x, y)))
            .collect();
    }
    scenes::of(shapes)
}

/// Traces a ray in windows along its path, through brute force and through both structures.
fn probe<N: Number>(name: &str, scene: &Scene<'_>, ray: UnitRay) {
    let size = 65_536.0;
    let major = ray
        .direction
        .iter()
        .fold(0.0_f64, |most, x| most.max(x.abs()));
    let before = ray
        .origin
        .iter()
        .fold(0.0_f64, |most, x| most.max(x.abs()))
        .max(size)
        - size;
    for window in 0..6 {
        let start = before + size * f64::from(window) / 3.0 - size / 3.0;
        let ray = UnitRay {
            tmin: if window == 0 { 0.0 } else { start },
            tmax: if window == 0 {
                f64::INFINITY
            } else {
                start + size / 3.0
            },
            direction: ray.direction.map(|x| x / major),
            ..ray
        };
        let ready = ray.ready::<N>(scene).expect("a ray");
        let (listed, any) = through::<N>(Structure::List, scene, &ready);
        for structure in [Structure::Grid, Structure::Octree] {
            let (hit, met) = through::<N>(structure, scene, &ready);
            let about = || {
                format!(
                    "{name}, {}, {}: {ray:?}",
                    structure.name(),
                    N::FORMAT.name()
                )
            };
            let bits = |hit: &Option<gridel_core::Hit<N>>| hit.as_ref().map(HitBits::of);
            assert_eq!(bits(&hit), bits(&listed), "{}", about());
            assert_eq!(met, any, "{}", about());
        }
    }
}

/// The plane of a cell of the grid, in units.
fn plane(scene: &Scene<'_>, axis: usize, division: usize) -> f64 {
    let [low, high] = scene.bounds().0[axis].map(f64::from);
    low + (high - low) * division as f64 / f64::from(CELLS)
}

/// A corner of the grid.
fn corner(scene: &Scene<'_>, random: &mut Random) -> [f64; 3] {
    [0, 1, 2].map(|axis| plane(scene, axis, random.below(CELLS as usize + 1)))
}

fn sign(random: &mut Random) -> f64 {
    if random.one_in(2) { 1.0 } else { -1.0 }
}

/// Rays of the hard sorts, B1, B3, B4, B5, B7 and B9 of the project's list of hard cases.
fn hard_rays(scene: &Scene<'_>, count: usize) -> Vec<(&'static str, UnitRay)> {
    let mut random = Random(0x9121d);
    let mut rays = Vec::new();
    for number in 0..count {
        let through_corner = corner(scene, &mut random);
        let back = |point: [f64; 3], direction: [f64; 3], by: f64| {
            [0, 1, 2].map(|k| point[k] - by * direction[k])
        };
        let diagonal = [0; 3].map(|_| sign(&mut random));
        let some = match number % 8 {
            0 => (
                "an exact diagonal through corners",
                diagonal,
                through_corner,
                7e4,
            ),
            1 => {
                let mut along = diagonal;
                along[random.below(3)] = if random.one_in(2) { 0.0 } else { -0.0 };
                (
                    "a diagonal in a plane, through edges",
                    along,
                    through_corner,
                    7e4,
                )
            }
            2 => {
                let mut along = [0.0, -0.0, 0.0];
                along[random.below(3)] = sign(&mut random);
                ("along an edge of cells", along, through_corner, 7e4)
            }
            3 => {
                let mut along = random.direction();
                along[random.below(3)] = 0.0;
                ("in a plane of cells", along, through_corner, 7e4)
            }
            4 => ("from a corner", random.direction(), through_corner, 0.0),
            5 => {
                let axis = random.below(3);
                let mut start = corner(scene, &mut random);
                start[axis] = f64::from(scene.bounds().0[axis][random.below(2)]);
                ("from a face of the scene", random.direction(), start, 0.0)
            }
            6 => (
                "at a corner from afar",
                random.direction(),
                through_corner,
                random.magnitude(1e6, 1e11),
            ),
            _ => {
                let slope = random.magnitude(1e-7, 1e-2);
                let along = [1.0, slope, -slope * random.unit()].map(|x| x * sign(&mut random));
                ("nearly along an edge", along, through_corner, 3e4)
            }
        };
        let (name, direction, point, distance) = some;
        let norm = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
        let origin = back(point, direction.map(|x| x / norm), distance);
        rays.push((name, UnitRay::new(origin, direction)));
    }
    rays
}

fn probe_scene(name: &str, scene: &scene::Scene, divisions: [u32; 3], count: usize) {
    let blob = blob(scene, divisions);
    let scene = blob.scene().expect("a scene");
    for (sort, ray) in hard_rays(&scene, count) {
        let name = format!("{name}, {sort}");
        every_format!(probe(&name, &scene, ray));
    }
}

#[test]
fn no_cell_is_passed_over() {
    probe_scene("lattice", &lattice(DVec3::ZERO, false), [CELLS; 3], 1600);
}

#[test]
fn far_scenes_are_walked_alike() {
    let place = DVec3::new(1e6, -3e5, 7.5e4);
    probe_scene("far lattice", &lattice(place, false), [CELLS; 3], 400);
}

#[test]
fn flat_scenes_have_one_layer() {
    probe_scene("flat", &lattice(DVec3::ZERO, true), [CELLS; 3], 800);
}

#[test]
fn grids_of_one_cell_and_of_uneven_cells_agree_with_brute_force() {
    let scene = lattice(DVec3::ZERO, false);
    for divisions in [[1; 3], [1, 1, 40], [33, 2, 5], [64, 64, 64]] {
        probe_scene("uneven", &scene, divisions, 160);
    }
}

/// A walk ends after at most as many cells as there are planes, however fine the grid.
#[test]
fn walks_are_as_long_as_the_grid_is_wide() {
    let scene = scenes::of([0.0, 1.0].map(|z| {
        Shape::Box(Cuboid {
            min: DVec3::new(0.0, 0.0, z),
            max: DVec3::new(1.0, 1.0, z),
        })
    }));
    let blob = blob(&scene, [1024, 1024, 2]);
    let scene = blob.scene().expect("a scene");
    let mut random = Random(77);
    let mut most = 0;
    for _ in 0..20_000 {
        let mut origin = [0; 3].map(|_| 6e4 * random.signed());
        let mut direction = random.direction();
        direction[2] *= random.magnitude(1e-9, 1.0);
        origin[2] *= 0.4;
        fn cells<N: Number>(scene: &Scene<'_>, ray: UnitRay, most: &mut u64) {
            let ready = ray.ready::<N>(scene).expect("a ray");
            let mut count = Counters::default();
            closest::<N, Grid>(scene, &ready, &mut count);
            *most = (*most).max(count.cells);
        }
        every_format!(cells(&scene, UnitRay::new(origin, direction), &mut most));
    }
    assert!((1500..=2050).contains(&most), "{most}");
}

/// A primitive in many cells is hit in the right one, and not where it was first listed (B6).
#[test]
fn long_things_are_hit_where_they_are() {
    let mut random = Random(5);
    let mut point = |size: f64| DVec3::from_array([0; 3].map(|_| size * random.signed()));
    let shapes = (0..60).map(|_| {
        let base = point(4.0);
        Shape::Cone(Cone {
            base,
            base_radius: 0.05,
            apex: -base + point(0.5),
            apex_radius: 0.05,
        })
    });
    let scene = scenes::of(shapes.collect::<Vec<_>>());
    for divisions in [[3; 3], [24; 3]] {
        probe_scene("long cones", &scene, divisions, 400);
    }
}

/// A mirrored ray in a mirrored scene meets the mirrored thing (B5).
#[test]
fn mirrors_do_not_matter() {
    let scene = lattice(DVec3::ZERO, false);
    let mirrored = |axis: usize| {
        let mut mirror = DVec3::ONE;
        mirror[axis] = -1.0;
        let objects = scene.objects.iter().map(|object| {
            let shape = match &object.shape {
                Shape::Sphere(Sphere { center, radius }) => Shape::Sphere(Sphere {
                    center: *center * mirror,
                    radius: *radius,
                }),
                Shape::Box(Cuboid { min, max }) => Shape::Box(Cuboid {
                    min: (*min * mirror).min(*max * mirror),
                    max: (*min * mirror).max(*max * mirror),
                }),
                shape => shape.clone(),
            };
            scene::Object {
                shape,
                ..object.clone()
            }
        });
        scene::Scene {
            objects: objects.collect(),
            ..scene.clone()
        }
    };
    let blob_of = |scene: &scene::Scene| blob(scene, [CELLS; 3]);
    let straight = blob_of(&scene);
    let straight = straight.scene().expect("a scene");
    for axis in 0..3 {
        let other = blob_of(&mirrored(axis));
        let other = other.scene().expect("a scene");
        for (_, ray) in hard_rays(&straight, 400) {
            let mut turned = ray;
            turned.origin[axis] = -turned.origin[axis];
            turned.direction[axis] = -turned.direction[axis];
            for structure in [Structure::Grid, Structure::Octree] {
                let hit = |scene: &Scene<'_>, ray: UnitRay| {
                    let ready = ray.ready::<f64>(scene).expect("a ray");
                    through::<f64>(structure, scene, &ready)
                        .0
                        .map(|hit| hit.primitive)
                };
                // A tie at a corner may go to another sphere, but never to none.
                let (a, b) = (hit(&straight, ray), hit(&other, turned));
                assert_eq!(a.is_some(), b.is_some(), "{}: {ray:?}", structure.name());
            }
        }
    }
}

/// Cells that would take too much memory are rejected with the figure. Without a given number of
/// cells, there are fewer.
#[test]
fn memory_is_bounded() {
    let big = |_| {
        Shape::Sphere(Sphere {
            center: DVec3::ZERO,
            radius: 1.0,
        })
    };
    let options = |grid| Options {
        structures: vec![Structure::Grid],
        grid,
        ..Options::default()
    };
    let few = scenes::of((0..10).map(big));
    let rejected = compile(&few, &options(Some([1024; 3]))).expect_err("12 GiB of cells");
    let CompileError::OverBudget { needed, budget, .. } = rejected else {
        panic!("{rejected}");
    };
    assert!(needed > 12 << 30 && budget == 256 << 20);
    // All in every cell.
    let many = scenes::of((0..6000).map(big));
    let compiled = compile(&many, &options(None)).expect("fewer cells fit");
    assert!(compiled.blob.bytes().len() < budget as usize);
    assert_eq!(compiled.report.longest_list, 6000);
}
