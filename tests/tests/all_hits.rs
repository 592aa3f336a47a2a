//! All hits of a ray: each structure lists the same, nothing twice and nothing lost, and closed meshes are crossed an
//! even number of times.

use glam::DVec3;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::{
    Fixed, Format, HitList, Kind, Number, Ray, Scene, Solid, Stack, Structure, containment_ray,
};
use gridel_host::scene::{self, Shape};
use gridel_host::shape::{Cuboid, Disc, Plane, Sphere, Torus};
use gridel_host::verify::rays::rays;
use gridel_tests::effort::{part_of, third_of};
use gridel_tests::every_format;
use gridel_tests::query::{HitBits, UnitRay};
use gridel_tests::random::Random;
use gridel_tests::scenes;

/// A hit, whether the ray leaves there, and the bits of its t.
type Listed = (Option<HitBits>, bool, u64);

/// All hits, listed so many at a time.
fn list<N: Number, const SIZE: usize>(scene: &Scene<'_>, ray: &Ray<N>) -> Vec<Listed> {
    let mut stack = Stack::<MAX_STACK_DEPTH>::new();
    let mut list = HitList::<N, SIZE>::new();
    let mut all = Vec::new();
    loop {
        let more = scene.all_hits(ray, stack.as_view(), &mut list);
        assert!(more == (list.len() == SIZE));
        all.extend(list.iter().map(|hit| {
            let whole = hit.hit(scene, ray);
            let t = N::far_to_f64(hit.t).to_bits();
            (whole.as_ref().map(HitBits::of), hit.leaves(), t)
        }));
        if !more {
            let again = scene.all_hits(ray, stack.as_view(), &mut list);
            assert!(!again && list.is_empty(), "a list that is done stays done");
            return all;
        }
    }
}

fn every_structure(scene: &scene::Scene) -> gridel_host::blob::Blob {
    scenes::blob_with_gridels(scene, 24, 1)
}

/// Compares the lists of all structures, and of lists of several sizes; returns the number of hits.
pub(crate) fn all_agree<N: Number>(name: &str, scene: &Scene<'_>, ray: &UnitRay) -> usize {
    let ready = ray.ready::<N>(scene).expect("a ray");
    let brute = scene.choose(Structure::List).expect("the list");
    let expected = list::<N, 64>(&brute, &ready);
    let about = || format!("{name}, {}: {ray:?}", N::FORMAT.name());
    let ts = expected.iter().map(|hit| f64::from_bits(hit.2));
    assert!(ts.is_sorted(), "{}", about());
    assert!(expected.iter().all(|hit| hit.0.is_some()), "{}", about());
    assert_eq!(list::<N, 1>(&brute, &ready), expected, "{}", about());
    for structure in Structure::ALL {
        let Some(chosen) = scene.choose(structure) else {
            continue;
        };
        let about = || format!("{}, {}", structure.name(), about());
        assert_eq!(list::<N, 3>(&chosen, &ready), expected, "{}", about());
        let count = chosen.count_hits(&ready, Stack::<MAX_STACK_DEPTH>::new().as_view());
        assert_eq!(count as usize, expected.len(), "{}", about());
    }
    expected.len()
}

#[test]
fn every_structure_lists_the_same_hits_in_lists_of_any_size() {
    fn compare<N: Number>(name: &str, scene: &Scene<'_>, count: usize) {
        let hits: usize = rays(scene, 5)
            .take(count)
            .map(|ray| all_agree::<N>(name, scene, &ray))
            .sum();
        eprintln!(
            "{name:10} {:5}: {count} rays, {hits} hits",
            N::FORMAT.name()
        );
        assert!(hits > count / 4, "{name}: {hits} hits");
    }
    let (vertices, triangles) = scenes::icosphere(2);
    let ball = Shape::Mesh {
        vertices,
        triangles,
    };
    let mut soup = scenes::soup(3, 80, 0.6);
    let planes = [DVec3::X, DVec3::new(1.0, 2.0, -1.0)].map(|normal| {
        Shape::Plane(Plane {
            point: 0.3 * normal,
            normal,
        })
    });
    let others = (0..6_u32).map(torus).chain(planes);
    soup.objects.extend(scenes::of(others).objects);
    for (name, scene) in [("soup", soup), ("ball", scenes::of([ball]))] {
        let blob = every_structure(&scene);
        let scene = blob.scene().expect("a scene");
        every_format!(compare(name, &scene, part_of(third_of(900), 100_000)));
    }
}

fn torus(number: u32) -> Shape {
    let turn = f64::from(number);
    Shape::Torus(Torus {
        center: DVec3::new(turn.sin(), turn.cos(), (3.0 * turn).sin()),
        axis: DVec3::new(1.0, turn, -0.5 * turn),
        major_radius: 0.5,
        minor_radius: 0.05 + 0.02 * turn,
    })
}

/// What the first hit is by both rules, where rays are not aimed at edges.
#[test]
fn the_first_of_all_hits_is_the_closest_one() {
    fn compare<N: Number>(scene: &Scene<'_>, count: usize) {
        let mut stack = Stack::<MAX_STACK_DEPTH>::new();
        let (mut met, mut touched) = (0, 0);
        for ray in gridel_host::verify::rays::plain_rays(scene, 9).take(count) {
            let ray = ray.ready::<N>(scene).expect("a ray");
            let closest = scene.closest_hit(&ray, stack.as_view());
            let mut first = HitList::<N, 1>::new();
            scene.all_hits(&ray, stack.as_view(), &mut first);
            let first = first.iter().next().and_then(|hit| hit.hit(scene, &ray));
            met += usize::from(closest.is_some());
            touched +=
                usize::from(closest.as_ref().map(HitBits::of) != first.as_ref().map(HitBits::of));
        }
        let format = N::FORMAT.name();
        eprintln!("{format}: {count} rays, {met} hits, {touched} differ");
        assert!(
            met > count / 10 && touched * 10_000 <= met,
            "{touched} of {met}"
        );
    }
    let blob = every_structure(&scenes::soup(4, 200, 0.5));
    let scene = blob.scene().expect("a scene");
    every_format!(compare(&scene, part_of(third_of(30_000), 1_000_000)));
}

/// Solids are entered and left in turn; a torus twice.
#[test]
fn rays_leave_each_solid_as_often_as_they_enter_it() {
    fn solids<N: Number>(scene: &Scene<'_>, count: usize) {
        let mut random = Random(8);
        let mut four = 0;
        for _ in 0..count {
            let direction = random.direction();
            let through = [(); 3].map(|()| 20_000.0 * random.signed());
            let origin = [0, 1, 2].map(|k| through[k] - 2e5 * direction[k]);
            let ray = UnitRay::new(origin, direction);
            let ready = ray.ready::<N>(scene).expect("a ray");
            let listed = list::<N, 64>(scene, &ready);
            for object in 0..scene.header().objects {
                let own = listed
                    .iter()
                    .filter(|hit| hit.0.is_some_and(|it| it.object == object));
                let leaves: Vec<bool> = own.map(|hit| hit.1).collect();
                let in_turn: Vec<bool> = (0..leaves.len()).map(|it| it % 2 == 1).collect();
                assert_eq!(leaves, in_turn, "{object}: {ray:?}");
                assert!(
                    leaves.len().is_multiple_of(2) && leaves.len() <= 4,
                    "{object}: {ray:?}"
                );
                four += usize::from(leaves.len() == 4);
            }
        }
        assert!(four > count / 100, "{four} tori are met twice");
    }
    let mut random = Random(77);
    let shapes = (0..40).map(|number| {
        let place = DVec3::from_array([(); 3].map(|()| random.signed()));
        match number % 4 {
            0 => torus(number),
            1 => scenes::shape(&mut random, 2, place, 0.8),
            2 => scenes::shape(&mut random, 3, place, 0.8),
            _ => scenes::shape(&mut random, 5 + number as usize % 3, place, 0.8),
        }
    });
    let blob = scenes::blob(&scenes::of(shapes), 24);
    let scene = blob.scene().expect("a scene");
    every_format!(solids(&scene, part_of(third_of(3000), 100_000)));
}

#[test]
fn stacked_and_nested_surfaces_are_all_listed() {
    fn stacked<N: Number>(scene: &Scene<'_>) {
        let [x, y, z] = scene
            .bounds()
            .0
            .map(|[low, high]| (f64::from(low) + f64::from(high)) / 2.0);
        // Through the diagonals that the squares' triangles share, and beside them.
        for beside in [0.0, 300.0, -2.5] {
            let ray = UnitRay::new([x, y - beside, z + 1e5], [0.0, 0.0, -1.0]);
            let ready = ray.ready::<N>(scene).expect("a ray");
            let listed = list::<N, 7>(scene, &ready);
            let primitives: Vec<u32> = listed
                .iter()
                .filter_map(|hit| Some(hit.0?.object))
                .collect();
            let expected: Vec<u32> = (0..1000).rev().collect();
            assert_eq!(primitives, expected, "{}", N::FORMAT.name());
        }
    }
    let squares = (0..1000).map(|level| {
        let height = f64::from(level) / 256.0;
        let corner = |x: f64, y: f64| DVec3::new(x, y, height);
        Shape::Mesh {
            vertices: vec![
                corner(-1.0, -1.0),
                corner(1.0, -1.0),
                corner(1.0, 1.0),
                corner(-1.0, 1.0),
            ],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
        }
    });
    let blob = scenes::blob(&scenes::of(squares), 24);
    every_format!(stacked(&blob.scene().expect("a scene")));

    fn nested<N: Number>(scene: &Scene<'_>) {
        let mut random = Random(4);
        for _ in 0..200 {
            let direction = random.direction();
            let ray = UnitRay::new(direction.map(|x| -1e6 * x), direction);
            let ready = ray.ready::<N>(scene).expect("a ray");
            let listed = list::<N, 5>(scene, &ready);
            let objects: Vec<u32> = listed
                .iter()
                .filter_map(|hit| Some(hit.0?.object))
                .collect();
            let (inward, outward) = ((0..50).rev(), 0..50);
            assert!(objects.iter().copied().eq(inward.chain(outward)), "{ray:?}");
        }
    }
    let spheres = (0..50).map(|number| {
        Shape::Sphere(Sphere {
            center: DVec3::ZERO,
            radius: 1.0 + f64::from(number) / 16.0,
        })
    });
    let blob = scenes::blob(&scenes::of(spheres), 24);
    every_format!(nested(&blob.scene().expect("a scene")));
}

/// Vertices and triangles.
type Mesh = (Vec<DVec3>, Vec<[u32; 3]>);

/// The closed meshes of the tests of parity.
fn closed_meshes() -> Vec<(&'static str, Mesh)> {
    let (ball, faces) = scenes::icosphere(3);
    let turned = |v: &DVec3| {
        let turn = glam::DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 0.5, 0.7);
        turn * (*v * DVec3::new(1.0, 0.7, 0.01))
    };
    let bumpy = ball.iter().enumerate();
    let bumpy = bumpy.map(|(i, &v)| v * if i % 3 == 0 { 0.7 } else { 1.0 });
    let (cube, sides) = cube(6);
    let bumpy = bumpy.collect();
    let flat = ball.iter().map(turned).collect();
    vec![
        ("ball", (ball, faces.clone())),
        ("bumpy ball", (bumpy, faces.clone())),
        ("flat ball", (flat, faces)),
        ("cube", (cube, sides)),
    ]
}

/// A cube whose faces are cut into squares of two triangles, all of one mesh of shared vertices.
fn cube(n: i32) -> Mesh {
    let mut numbers = std::collections::HashMap::new();
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    let mut vertex = |at: [i32; 3]| {
        *numbers.entry(at).or_insert_with(|| {
            let place = at.map(|x| 2.0 * f64::from(x) / f64::from(n) - 1.0);
            vertices.push(DVec3::from_array(place));
            vertices.len() as u32 - 1
        })
    };
    for axis in 0..3 {
        for side in [0, n] {
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                let mut corner = |u: i32, v: i32| {
                    let mut at = [side; 3];
                    at[(axis + 1) % 3] = u;
                    at[(axis + 2) % 3] = v;
                    vertex(at)
                };
                let [a, b, c, d] = [
                    corner(i, j),
                    corner(i + 1, j),
                    corner(i + 1, j + 1),
                    corner(i, j + 1),
                ];
                let faces = [[a, b, c], [a, c, d]];
                triangles
                    .extend(faces.map(|[p, q, r]| if side == n { [p, q, r] } else { [p, r, q] }));
            }
        }
    }
    (vertices, triangles)
}

/// A ray through places of a mesh where counting goes wrong: vertices, edges, and in faces, from outside or inside.
fn aimed(triangles: &[[[i32; 3]; 3]], random: &mut Random) -> UnitRay {
    let place = |random: &mut Random| -> [f64; 3] {
        let corners =
            triangles[random.below(triangles.len())].map(|it| it.map(|x| f64::from(x) / 256.0));
        let part = [0.0, 0.5, 0.25, random.unit()][random.below(4)];
        let side = random.below(3);
        let (a, b) = (corners[side], corners[(side + 1) % 3]);
        [0, 1, 2].map(|k| a[k] + part * (b[k] - a[k]))
    };
    let target = place(random);
    let direction = match random.below(4) {
        // Along an axis.
        0 => {
            let mut axis = [0.0; 3];
            axis[random.below(3)] = if random.one_in(2) { 1.0 } else { -1.0 };
            axis
        }
        // Through two places, often along an edge or in a face.
        1 => {
            let corners = triangles[random.below(triangles.len())];
            let [a, b] = [random.below(3), random.below(3)];
            [0, 1, 2].map(|k| f64::from(corners[a][k] - corners[(b + usize::from(a == b)) % 3][k]))
        }
        2 => {
            let other = place(random);
            [0, 1, 2].map(|k| target[k] - other[k])
        }
        _ => random.direction(),
    };
    let longest = direction.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let direction = if longest > 0.0 {
        direction
    } else {
        [0.0, 0.0, 1.0]
    };
    let far = 2e5 / longest.max(1e-3);
    UnitRay::new([0, 1, 2].map(|k| target[k] - far * direction[k]), direction)
}

/// No closed mesh is crossed an odd number of times by a ray from outside.
#[test]
fn closed_meshes_are_crossed_an_even_number_of_times() {
    fn parity<N: Number>(name: &str, scene: &Scene<'_>, count: usize) {
        let triangles: Vec<_> = (0..scene.count(Kind::Triangle))
            .filter_map(|slot| scene.triangle(slot))
            .collect();
        let structures: Vec<_> = Structure::ALL
            .into_iter()
            .filter_map(|it| Some((it, scene.choose(it)?)))
            .collect();
        let mut stack = Stack::<MAX_STACK_DEPTH>::new();
        let mut random = Random(0x0dd);
        let (mut odd, mut hits) = (0, 0);
        for number in 0..count {
            let ray = aimed(&triangles, &mut random);
            let Some(ready) = ray.ready::<N>(scene) else {
                panic!("{ray:?} is rejected");
            };
            // The list takes long.
            let (_, chosen) = match &structures[number % structures.len()] {
                (Structure::List, _) if number % 64 != 0 => &structures[1],
                other => other,
            };
            let crossed = chosen.count_hits(&ready, stack.as_view());
            if !crossed.is_multiple_of(2) {
                odd += 1;
                eprintln!("{name}: {crossed} crossings of {ray:?}");
            }
            hits += u64::from(crossed);
        }
        eprintln!(
            "{name:10} {:5}: {count} rays, {hits} crossings, {odd} odd",
            N::FORMAT.name()
        );
        assert_eq!(odd, 0, "{name}, {}", N::FORMAT.name());
    }
    for (name, (vertices, triangles)) in closed_meshes() {
        let shape = Shape::Mesh {
            vertices,
            triangles,
        };
        for bits in [16, 24] {
            let blob = scenes::blob_with_gridels(&scenes::of([shape.clone()]), bits, 1);
            let scene = blob.scene().expect("a scene");
            let name = format!("{name}, {bits}");
            every_format!(parity(&name, &scene, part_of(third_of(12_000), 1_250_000)));
        }
    }
}

/// The axis along which t is counted.
fn major_axis(slope: [i64; 3]) -> usize {
    // The first of equal ones, as the core chooses.
    (0..3)
        .rev()
        .max_by_key(|&k| slope[k].abs())
        .expect("an axis")
}

/// What a line crosses, by integers alone: a place of the half-open rule is moved by so little that no sign changes but
/// those of zeros.
fn crossed_exactly(
    triangles: &[[[i64; 3]; 3]],
    origin: [i64; 3],
    slope: [i64; 3],
    moved: [i128; 2],
) -> Vec<(i64, i64, usize)> {
    let major = major_axis(slope);
    let (first, second) = ((major + 1) % 3, (major + 2) % 3);
    let scale = slope[major];
    // Times 2^40, in which the moved place is a whole number.
    let project = |corner: [i64; 3]| {
        let depth = corner[major] - origin[major];
        [(first, moved[0]), (second, moved[1])].map(|(k, moved)| {
            let seen = (corner[k] - origin[k]) * scale - depth * slope[k];
            (i128::from(seen) << 40) - moved * i128::from(scale)
        })
    };
    let mut crossed = Vec::new();
    for (number, corners) in triangles.iter().enumerate() {
        let [a, b, c] = corners.map(project);
        let side = |p: [i128; 2], q: [i128; 2]| (p[0] * q[1] - p[1] * q[0]).signum();
        let sides = [side(a, b), side(b, c), side(c, a)];
        assert!(
            !sides.contains(&0) || a == b || b == c || c == a,
            "moved off all lines"
        );
        if sides == [1; 3] || sides == [-1; 3] {
            // t over the slope along the major axis, as a fraction.
            let [p, q, r] = *corners;
            let edge = |to: [i64; 3], k: usize| to[k] - p[k];
            let normal = [0, 1, 2].map(|k| {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                edge(q, i) * edge(r, j) - edge(q, j) * edge(r, i)
            });
            let dot = |v: [i64; 3]| (0..3).map(|k| normal[k] * v[k]).sum::<i64>();
            let (over, under) = (dot([0, 1, 2].map(|k| p[k] - origin[k])), dot(slope));
            crossed.push((over * scale.abs() * under.signum(), under.abs(), number));
        }
    }
    crossed.sort_by(|a, b| {
        let left = i128::from(a.0) * i128::from(b.1);
        left.cmp(&(i128::from(b.0) * i128::from(a.1)))
            .then(a.2.cmp(&b.2))
    });
    crossed
}

/// Small integers, for which no format rounds what is projected: the hits are those that exact arithmetic finds, in its
/// order, on edges and vertices as well.
#[test]
fn triangles_are_listed_as_exact_arithmetic_finds_them() {
    fn exact<N: Number>(scene: &Scene<'_>, seed: u64, count: usize) -> usize {
        let mut triangles = vec![[[0; 3]; 3]; scene.count(Kind::Triangle)];
        for slot in 0..triangles.len() {
            let number = scene.primitive(Kind::Triangle, slot as u32) as usize;
            let corners = scene.triangle(slot).expect("a triangle");
            // Whole units.
            triangles[number] = corners.map(|it| it.map(|x| i64::from(x) >> 8));
        }
        let mut random = Random(seed);
        let mut hits = 0;
        for number in 0..count {
            let corner = triangles[random.below(triangles.len())][random.below(3)];
            let major = random.below(3);
            let mut slope = [(); 3].map(|()| i64::from(random.within(-4, 4)));
            slope[major] = if random.one_in(2) { 4 } else { -4 };
            // From far before a vertex, in steps of the slope.
            let origin = [0, 1, 2].map(|k| corner[k] - 1024 * slope[k]);
            let mut moved = [1_i128 << 20, 1];
            if N::FORMAT == Format::Fixed {
                // What is seen is turned into the ray's direction there.
                for (place, moved) in moved.iter_mut().enumerate() {
                    if slope[(major_axis(slope) + 1 + place) % 3] < 0 {
                        *moved = -*moved;
                    }
                }
            }
            let expected = crossed_exactly(&triangles, origin, slope, moved);
            let ray = UnitRay {
                tmin: f64::NEG_INFINITY,
                ..UnitRay::new(origin.map(|x| x as f64), slope.map(|x| x as f64))
            };
            let ready = ray.ready::<N>(scene).expect("a ray");
            assert_eq!(ready.major_axis(), major_axis(slope));
            let structures = Structure::ALL.into_iter().filter_map(|it| scene.choose(it));
            let structures: Vec<_> = structures.collect();
            let listed = list::<N, 4>(&structures[number % structures.len()], &ready);
            let found: Vec<usize> = listed
                .iter()
                .filter_map(|hit| Some(hit.0?.primitive as usize))
                .collect();
            let mut as_expected: Vec<usize> = expected.iter().map(|it| it.2).collect();
            let about = || format!("{}: {ray:?}", N::FORMAT.name());
            for (hit, number) in listed.iter().zip(&found) {
                let (over, under, _) = expected.iter().find(|it| it.2 == *number).expect("crossed");
                let t = *over as f64 / *under as f64;
                let found = f64::from_bits(hit.2);
                assert!((found - t).abs() <= 0.01, "{found}, {t}: {}", about());
            }
            // Places that rounding puts into another order, as hits at an edge.
            let mut found = found;
            found.sort_unstable();
            as_expected.sort_unstable();
            assert_eq!(found, as_expected, "{}", about());
            hits += found.len();
        }
        hits
    }
    let mut random = Random(0xe4ac7);
    for seed in 0..part_of(third_of(12), 200) as u64 {
        let vertices: Vec<DVec3> = (0..30)
            .map(|_| DVec3::from_array([(); 3].map(|()| f64::from(random.within(-8, 8)))))
            .chain([DVec3::splat(-32_000.0), DVec3::splat(32_000.0)])
            .collect();
        let triangles = (0..60).filter_map(|_| {
            let corners = [(); 3].map(|()| random.below(30) as u32);
            let [a, b, c] = corners.map(|it| vertices[it as usize]);
            ((b - a).cross(c - a) != DVec3::ZERO).then_some(corners)
        });
        let triangles: Vec<_> = triangles.collect();
        let ends = [30, 31].map(|end: usize| {
            Shape::Sphere(Sphere {
                center: vertices[end],
                radius: 1.0,
            })
        });
        let shape = Shape::Mesh {
            vertices: vertices[..30].to_vec(),
            triangles,
        };
        let blob =
            scenes::blob_with_gridels(&scenes::of(std::iter::once(shape).chain(ends)), 24, 1);
        let scene = blob.scene().expect("a scene");
        assert_eq!(
            (scene.header().unit_exponent, scene.header().origin),
            (0, [0.0; 3])
        );
        let count = 300;
        let hits = [
            exact::<Fixed>(&scene, seed, count),
            exact::<f32>(&scene, seed, count),
            exact::<f64>(&scene, seed, count),
        ];
        assert!(hits.iter().all(|&hits| hits > count), "{hits:?}");
    }
}

/// Points in and around solids and closed meshes, apart from those that lie next to a surface.
#[test]
fn points_are_contained_where_geometry_says_so() {
    fn contained<N: Number>(scene: &Scene<'_>, count: usize) {
        let structures: Vec<_> = Structure::ALL
            .into_iter()
            .filter_map(|it| scene.choose(it))
            .collect();
        let unit = f64::powi(2.0, scene.header().unit_exponent.into());
        let origin = DVec3::from_array(scene.header().origin);
        let mut stack = Stack::<MAX_STACK_DEPTH>::new();
        let mut random = Random(0xc0);
        let mut inside = [0; 5];
        for number in 0..count {
            let place = DVec3::from_array([(); 3].map(|()| 1.5 * random.signed()));
            // Where each solid has its surface: negative inside.
            let depths = [
                place.length() - 1.0,
                (place - 0.5).abs().max_element() - 0.5,
                (place.xy_length() - 1.0).hypot(place.z) - 0.25,
                // The mesh is inscribed in a ball.
                place.length() - 0.7,
                f64::INFINITY,
            ];
            let units = ((place - origin) / unit).to_array().map(N::far_from_f64);
            let scene = &structures[number % structures.len()];
            for (object, depth) in depths.into_iter().enumerate() {
                let between = if object == 3 {
                    -0.01..1e-3
                } else {
                    -1e-3..1e-3
                };
                if between.contains(&depth) {
                    continue;
                }
                let solid = Solid::own(object as u32);
                let found = scene.contains::<N>(solid, units, stack.as_view());
                assert_eq!(
                    found,
                    Ok(depth < 0.0),
                    "{object} {place} {}",
                    N::FORMAT.name()
                );
                inside[object] += usize::from(depth < 0.0);
            }
        }
        assert!(inside[..4].iter().all(|&it| it > count / 50), "{inside:?}");
    }
    trait XyLength {
        fn xy_length(&self) -> f64;
    }
    impl XyLength for DVec3 {
        fn xy_length(&self) -> f64 {
            self.x.hypot(self.y)
        }
    }
    let (vertices, triangles) = scenes::icosphere(4);
    let shapes = [
        Shape::Sphere(Sphere {
            center: DVec3::ZERO,
            radius: 1.0,
        }),
        Shape::Box(Cuboid {
            min: DVec3::ZERO,
            max: DVec3::ONE,
        }),
        Shape::Torus(Torus {
            center: DVec3::ZERO,
            axis: DVec3::Z,
            major_radius: 1.0,
            minor_radius: 0.25,
        }),
        Shape::Mesh {
            vertices: vertices.iter().map(|&v| 0.7 * v).collect(),
            triangles,
        },
        Shape::Disc(Disc {
            center: DVec3::ZERO,
            normal: DVec3::ONE,
            radius: 1.5,
        }),
    ];
    let blob = scenes::blob(&scenes::of(shapes), 24);
    let scene = blob.scene().expect("a scene");
    every_format!(contained(&scene, part_of(third_of(6000), 300_000)));
    let outside = containment_ray::<f64>(&scene, [1e9, 0.0, 0.0]);
    assert!(matches!(outside, Ok(None)));
    assert!(containment_ray::<f64>(&scene, [f64::NAN, 0.0, 0.0]).is_err());
}

/// The weights of the corners make the point.
#[test]
fn barycentric_coordinates_lead_back_to_the_point() {
    fn weights<N: Number>(scene: &Scene<'_>, count: usize) {
        let mut stack = Stack::<MAX_STACK_DEPTH>::new();
        let mut triangles = 0;
        for ray in rays(scene, 2).take(count) {
            let ready = ray.ready::<N>(scene).expect("a ray");
            let Some(hit) = scene.closest_hit(&ready, stack.as_view()) else {
                continue;
            };
            let slot = (0..scene.count(Kind::Triangle))
                .find(|&slot| scene.primitive(Kind::Triangle, slot as u32) == hit.primitive);
            assert_eq!(hit.barycentric(scene).is_some(), slot.is_some());
            let Some((weights, slot)) = hit.barycentric(scene).zip(slot) else {
                continue;
            };
            // Where a ray runs along a triangle, the point may lie beside it.
            let across: f64 = (0..3)
                .map(|k| hit.normal[k].ratio_to_f64() * ready.slope()[k].ratio_to_f64())
                .sum();
            if across.abs() < 0.1 {
                continue;
            }
            let weights = weights.map(N::ratio_to_f64);
            let corners = scene.triangle(slot).expect("a triangle");
            assert!(
                weights.iter().all(|it| (0.0..=1.0).contains(it)),
                "{weights:?}"
            );
            for (k, point) in hit.point.into_iter().enumerate() {
                let place: f64 = (0..3)
                    .map(|it| weights[it] * f64::from(corners[it][k]) / 256.0)
                    .sum();
                let point = point.length_to_f64();
                assert!(
                    (place - point).abs() < 0.5,
                    "{place} {point} {}",
                    N::FORMAT.name()
                );
            }
            triangles += 1;
        }
        assert!(triangles > count / 20, "{triangles}");
    }
    let blob = scenes::blob(&scenes::soup(11, 120, 0.6), 24);
    let scene = blob.scene().expect("a scene");
    every_format!(weights(&scene, 2000));
}
