//! All hits of a ray: each structure lists the same, nothing twice and nothing lost, and closed meshes are crossed an
//! even number of times.

mod exact;
mod points;

use glam::DVec3;
use gridel_core::accel::DynAccel;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::{
    Fixed, Format, HitList, Kind, NoCount, Number, PrimitiveHit, Ray, Scene, Solid, Stack,
    Structure, closest_primitive, containment_ray, every_hit,
};
use gridel_host::scene::{self, Shape};
use gridel_host::shape::{Cuboid, Disc, Plane, Sphere, Torus};
use gridel_host::verify::rays::rays;
use gridel_tests::effort::{part_of, sixth_of};
use gridel_tests::every_format;
use gridel_tests::query::{HitBits, UnitRay};
use gridel_tests::random::Random;
use gridel_tests::scenes;

/// A hit, whether the ray leaves there, and the bits of its t.
type Listed = (Option<HitBits>, bool, u64);

fn listed<N: Number>(scene: &Scene<'_>, ray: &Ray<N>, hit: &PrimitiveHit<N>) -> Listed {
    let whole = hit.hit(scene, ray);
    let t = N::far_to_f64(hit.t).to_bits();
    (whole.as_ref().map(HitBits::of), hit.leaves(), t)
}

/// Returns all hits, found in one walk and then sorted.
fn every<N: Number>(scene: &Scene<'_>, ray: &Ray<N>) -> Vec<Listed> {
    let mut stack = Stack::<MAX_STACK_DEPTH>::new();
    let mut hits = Vec::new();
    let visit = &mut |hit| hits.push(hit);
    every_hit::<N, DynAccel>(scene, ray, stack.as_view(), visit);
    hits.sort_by(|a, b| a.partial_cmp(b).expect("t is a number"));
    hits.dedup();
    let hits = hits.iter();
    hits.map(|found| listed(scene, ray, found.hit())).collect()
}

/// Returns all hits, listed `SIZE` at a time.
fn list<N: Number, const SIZE: usize>(scene: &Scene<'_>, ray: &Ray<N>) -> Vec<Listed> {
    let mut stack = Stack::<MAX_STACK_DEPTH>::new();
    let mut list = HitList::<N, SIZE>::new();
    let mut all = Vec::new();
    loop {
        let more = scene.all_hits(ray, stack.as_view(), &mut list);
        assert!(more == (list.len() == SIZE));
        all.extend(list.iter().map(|hit| listed(scene, ray, hit)));
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

/// A ray from within a box that is as large as the scene meets its faces on both sides.
#[test]
fn boxes_are_crossed_before_and_behind_an_origin_within() {
    fn twice<N: Number>(scene: &Scene<'_>, ray: &UnitRay) {
        let brute = scene.choose(Structure::List).expect("the list");
        let far = |vector: [f64; 3]| vector.map(N::far_from_f64);
        let [tmin, tmax] = [-1e5, 1e5].map(N::far_from_f64);
        let (origin, direction) = (far(ray.origin), far(ray.direction));
        let rounded = Ray::new(scene.bounds(), origin, direction, tmin, tmax);
        for ready in [
            ray.ready::<N>(scene).expect("a ray"),
            rounded.expect("a ray"),
        ] {
            let hits = list::<N, 4>(&brute, &ready);
            assert_eq!(hits.len(), 2, "{:?} {ray:?}", N::FORMAT);
        }
    }
    let mut random = Random(19);
    let cube = Shape::Box(Cuboid {
        min: DVec3::splat(-1.0),
        max: DVec3::new(1.0, 2.0, 1.0),
    });
    let blob = scenes::blob(&scenes::of([cube]), 24);
    let scene = blob.scene().expect("a scene");
    let unit = f64::powi(2.0, scene.header().unit_exponent.into());
    for _ in 0..part_of(2000, 20_000) {
        let origin = [0; 3].map(|_| 0.99 * random.signed() / unit);
        let ray = UnitRay {
            tmin: -1e9,
            ..UnitRay::new(origin, random.direction())
        };
        every_format!(twice(&scene, &ray));
    }
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
        assert_eq!(every(&chosen, &ready), expected, "{}", about());
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
        every_format!(compare(name, &scene, part_of(sixth_of(900), 100_000)));
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

/// The first hit is the same by both rules, where rays are not aimed at edges.
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
            let listed = first.iter().next();
            let first = listed.and_then(|hit| hit.hit(scene, &ray));
            if closest.as_ref().map(HitBits::of) == first.as_ref().map(HitBits::of) {
                // Whatever else a structure keeps with it.
                for scene in Structure::ALL.into_iter().filter_map(|it| scene.choose(it)) {
                    let found = closest_primitive::<N, DynAccel, _>(
                        &scene,
                        &ray,
                        stack.as_view(),
                        &mut NoCount,
                    );
                    assert!(found.as_ref() == listed, "{found:?}, {listed:?}");
                }
            }
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
    every_format!(compare(&scene, part_of(sixth_of(30_000), 1_000_000)));
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
    every_format!(solids(&scene, part_of(sixth_of(3000), 100_000)));
}

#[test]
fn stacked_and_nested_surfaces_are_all_listed() {
    fn stacked<N: Number>(scene: &Scene<'_>) {
        let [x, y, z] = scene
            .bounds()
            .0
            .map(|[low, high]| (f64::from(low) + f64::from(high)) / 2.0);
        // Through the diagonals that the squares' triangles share, and off them.
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
            every_format!(parity(&name, &scene, part_of(600, 1_250_000)));
        }
    }
}
