//! Deforming meshes. Hits are those of brute force and of a blob that is compiled with the moved vertices. Closed
//! meshes stay closed, and invalid poses are rejected.

mod morph;
mod parts;

use glam::DVec3;
use gridel_core::format::checksum;
use gridel_core::format::record::{Header, Vertex16, Vertex24};
use gridel_core::format::width::Vertex;
use gridel_core::{
    DeformError, Deformation, Kind, Number, Position, Prevalidated, Requirements, Scene as Loaded,
    Structure,
};
use gridel_host::blob::Blob;
use gridel_host::compile::{Options, compile};
use gridel_host::scene::{Scene, Shape};
use gridel_host::shape::{Cuboid, Sphere};
use gridel_tests::effort::part_of;
use gridel_tests::every_format;
use gridel_tests::query::{HitBits, UnitRay, through};
use gridel_tests::random::Random;
use gridel_tests::scenes;
use std::collections::HashMap;
use std::mem::offset_of;

/// A ball of 1,280 triangles and 642 vertices.
fn ball() -> Shape {
    let (vertices, triangles) = scenes::icosphere(3);
    Shape::Mesh {
        vertices: vertices.iter().map(|vertex| vertex * 0.5).collect(),
        triangles,
    }
}

type Mesh<V> = Deformation<V, 642, 1300>;

fn mesh<V: Vertex>(scene: &Loaded<'_>) -> Box<Mesh<V>> {
    Box::new(Deformation::of(scene).expect("a deformation"))
}

/// A mesh and a sphere, between two boxes in the corners of a room.
fn in_a_room(mesh: Shape) -> Scene {
    let corner = |sign: f64| {
        let (a, b) = (DVec3::splat(sign), DVec3::splat(0.96 * sign));
        let (min, max) = (a.min(b), a.max(b));
        Shape::Box(Cuboid { min, max })
    };
    let sphere = Sphere {
        center: DVec3::new(0.3, 0.4, 0.8),
        radius: 0.1,
    };
    scenes::of([corner(-1.0), mesh, Shape::Sphere(sphere), corner(1.0)])
}

fn blob(scene: &Scene, lattice_bits: u8, structures: &[Structure]) -> Blob {
    let options = Options {
        structures: structures.to_vec(),
        lattice_bits,
        ..Options::default()
    };
    compile(scene, &options).expect("compiles").blob
}

fn bvh(scene: &Scene, lattice_bits: u8) -> Blob {
    blob(scene, lattice_bits, &[Structure::Bvh])
}

/// The corners of all triangles in scene-file order where the deformation says that they are, in 1/256 unit.
fn moved_triangles<V: Vertex>(scene: &Loaded<'_>, moved: &[V]) -> Vec<[[i32; 3]; 3]> {
    let stored: &[V] = scene.stored_vertices().expect("vertices of this type");
    let numbers: HashMap<_, _> = stored.iter().map(Vertex::position).zip(0..).collect();
    assert_eq!(numbers.len(), stored.len(), "vertices at one place");
    let mut triangles: Vec<_> = (0..scene.count(Kind::Triangle))
        .map(|slot| {
            let corners = scene.triangle(slot).expect("a triangle");
            let corners = corners.map(|corner| moved[numbers[&corner]].position());
            (scene.primitive(Kind::Triangle, slot as u32), corners)
        })
        .collect();
    triangles.sort_unstable();
    triangles.into_iter().map(|(_, corners)| corners).collect()
}

/// A shape with these triangles.
fn shape(scene: &Loaded<'_>, triangles: &[[[i32; 3]; 3]]) -> Shape {
    let unit = f64::powi(2.0, scene.header().unit_exponent.into()) / 256.0;
    let origin = DVec3::from_array(scene.header().origin);
    let corners = triangles.iter().flatten();
    let place = |corner: &[i32; 3]| origin + unit * DVec3::from_array(corner.map(f64::from));
    Shape::Mesh {
        vertices: corners.map(place).collect(),
        triangles: (0..triangles.len() as u32)
            .map(|number| [0, 1, 2].map(|corner| 3 * number + corner))
            .collect(),
    }
}

/// Moves every vertex by at most `reach` on each axis, in 1/256 unit, within the room.
fn shake<V: Vertex>(random: &mut Random, scene: &Loaded<'_>, vertices: &mut [V], reach: i32) {
    let room = scene.bounds().0;
    for vertex in vertices {
        let place = vertex.position();
        let steps = [0, 1, 2].map(|k| {
            let [low, high] = room[k].map(|x| i32::from(x) << 8);
            // Many vertices in a face would make needles.
            let [low, high] = [low.max(place[k] - reach), high.min(place[k] + reach)];
            random.within(low, high) >> (8 - V::STEP_BITS)
        });
        *vertex = V::from_steps(steps);
    }
}

/// A ray from around the room to a place in it, or to one of these.
fn ray<N: Number>(
    random: &mut Random,
    scene: &Loaded<'_>,
    places: &[[[i32; 3]; 3]],
) -> gridel_core::Ray<N> {
    let mut point = |reach: f64| {
        scene.bounds().0.map(|[low, high]| {
            let (low, high) = (f64::from(low), f64::from(high));
            low.midpoint(high) + reach * random.signed() * (high - low) / 2.0
        })
    };
    let (from, mut to) = (point(3.0), point(1.0));
    if random.one_in(2) {
        let corners = places[random.below(places.len())];
        to = corners[random.below(3)].map(|x| f64::from(x) / 256.0);
    }
    let way = [0, 1, 2].map(|k| to[k] - from[k]);
    UnitRay::new(from, way).ready(scene).expect("a ray")
}

/// Compares hits in a moved scene with those of brute force, and through some structures of another blob.
fn same_hits<N: Number>(
    moved: &Loaded<'_>,
    (fresh, structures): (&Loaded<'_>, &[Structure]),
    places: &[[[i32; 3]; 3]],
    rays: usize,
) {
    let mut random = Random(rays as u64);
    let mut hits = 0;
    for _ in 0..rays {
        let ray = ray::<N>(&mut random, moved, places);
        let bits = |structure, scene| {
            let (hit, any) = through::<N>(structure, scene, &ray);
            (hit.as_ref().map(HitBits::of), any)
        };
        let found = bits(Structure::Bvh, moved);
        assert_eq!(found, bits(Structure::List, moved), "{ray:?}");
        for &structure in structures {
            assert_eq!(found, bits(structure, fresh), "{ray:?}");
        }
        hits += usize::from(found.0.is_some());
    }
    assert!(10 * hits > 3 * rays, "{hits} of {rays} hit");
}

fn moves_give_the_hits_of_a_fresh_blob<V: Vertex>(lattice_bits: u8) {
    let blob = bvh(&in_a_room(ball()), lattice_bits);
    let scene = blob.scene().expect("a scene");
    let mut deformation = mesh::<V>(&scene);
    let at_rest = deformation.pairs().to_vec();
    deformation.refit(&scene).expect("a pose");
    assert_eq!(deformation.pairs(), at_rest, "the compiler's own boxes");
    let mut random = Random(lattice_bits.into());
    for reach in [256, 2_000_000, 20_000_000] {
        shake(&mut random, &scene, deformation.vertices_mut(), reach);
        deformation.refit(&scene).expect("a pose");
        let moved = scene.with_deformation(&deformation).expect("a scene");
        let triangles = moved_triangles(&scene, deformation.vertices());
        let again = in_a_room(shape(&scene, &triangles));
        let structures = [Structure::Bvh, Structure::DualSplit];
        let again = self::blob(&again, lattice_bits, &structures);
        let fresh = again.scene().expect("a scene");
        assert_eq!(fresh.bounds(), scene.bounds());
        assert_eq!(fresh.count(Kind::Triangle), triangles.len());
        let rays = part_of(1500, 200_000);
        every_format!(same_hits(&moved, (&fresh, &structures), &triangles, rays));
    }
}

#[test]
fn moved_meshes_of_16_bits_hit_as_fresh_ones() {
    moves_give_the_hits_of_a_fresh_blob::<Vertex16>(16);
}

#[test]
fn moved_meshes_of_24_bits_hit_as_fresh_ones() {
    moves_give_the_hits_of_a_fresh_blob::<Vertex24>(24);
}

/// Rays from a place within to every vertex and to places on every edge hit, through both structures.
fn no_leaks<N: Number>(moved: &Loaded<'_>, triangles: &[[[i32; 3]; 3]], from: [f64; 3]) {
    for (number, corners) in triangles.iter().enumerate() {
        for side in 0..3 {
            let (a, b) = (corners[side], corners[(side + 1) % 3]);
            for part in [0.0, 0.25, 1.0 / 3.0, 0.5] {
                let to = [0, 1, 2]
                    .map(|k| (f64::from(a[k]) + part * f64::from(b[k] - a[k])) / 256.0 - from[k]);
                let ray = UnitRay::new(from, to).ready::<N>(moved);
                let ray = ray.expect("a ray");
                for structure in [Structure::Bvh, Structure::List] {
                    if structure == Structure::List && number % 64 != 0 {
                        continue;
                    }
                    let (hit, any) = through(structure, moved, &ray);
                    let format = N::FORMAT.name();
                    assert!(
                        hit.is_some() && any,
                        "{format}: {to:?} of triangle {number}"
                    );
                }
            }
        }
    }
}

/// Moves the vertices of a ball along their own directions, and some onto their neighbors.
fn closed_meshes_stay_closed<V: Vertex>(lattice_bits: u8) {
    let options = Options {
        structures: vec![Structure::Bvh],
        lattice_bits,
        room: 0.5,
        ..Options::default()
    };
    let blob = compile(&scenes::of([ball()]), &options)
        .expect("compiles")
        .blob;
    let scene = blob.scene().expect("a scene");
    let mut deformation = mesh::<V>(&scene);
    let stored: &[V] = scene.stored_vertices().expect("vertices");
    let edges: Vec<[usize; 2]> = {
        let numbers: HashMap<_, _> = stored.iter().map(Vertex::position).zip(0..).collect();
        let triangles = (0..scene.count(Kind::Triangle)).filter_map(|slot| scene.triangle(slot));
        triangles
            .map(|[a, b, _]| [numbers[&a], numbers[&b]])
            .collect()
    };
    let mut random = Random(lattice_bits.into());
    for collapses in [0, 1, 20] {
        for (moved, stored) in deformation.vertices_mut().iter_mut().zip(stored) {
            let size = 0.25 + 1.7 * random.unit();
            let steps = [0, 1, 2].map(|k| (size * f64::from(stored.steps(k))) as i32);
            *moved = V::from_steps(steps);
        }
        // Triangles at these edges have no area; their neighbors meet.
        for _ in 0..collapses {
            let [from, to] = edges[random.below(edges.len())];
            let vertices = deformation.vertices_mut();
            vertices[from] = vertices[to];
        }
        deformation.refit(&scene).expect("a pose");
        let moved = scene.with_deformation(&deformation).expect("a scene");
        let triangles = moved_triangles(&scene, deformation.vertices());
        every_format!(no_leaks(&moved, &triangles, [0.25, -0.5, 0.125]));
    }
}

#[test]
fn closed_meshes_of_16_bits_stay_closed() {
    closed_meshes_stay_closed::<Vertex16>(16);
}

#[test]
fn closed_meshes_of_24_bits_stay_closed() {
    closed_meshes_stay_closed::<Vertex24>(24);
}

#[test]
fn invalid_poses_are_rejected() {
    let blob = bvh(&in_a_room(ball()), 24);
    let scene = blob.scene().expect("a scene");
    let mut deformation = mesh::<Vertex24>(&scene);
    let at_rest = scene.with_deformation(&deformation).expect("at rest");
    assert_eq!(at_rest.triangle(5), scene.triangle(5));

    let rest = deformation.vertices()[7];
    let highest = i32::from(scene.bounds().0[1][1]) << 8;
    deformation.vertices_mut()[7].0[1] = highest;
    let moved = scene.with_deformation(&deformation).err();
    assert_eq!(moved, Some(DeformError::NotRefitted));
    assert_eq!(deformation.refit(&scene), Ok(()), "in a face of the room");
    deformation.vertices_mut()[7].0[1] = highest + 1;
    let outside = Err(DeformError::OutsideRoom { vertex: 7 });
    assert_eq!(deformation.refit(&scene), outside);
    let moved = scene.with_deformation(&deformation).err();
    assert_eq!(moved, Some(DeformError::NotRefitted));
    deformation.vertices_mut()[7] = rest;
    assert_eq!(deformation.refit(&scene), Ok(()));

    // The first triangle becomes a needle: a corner lies halfway between the others.
    let stored: &[Vertex24] = scene.stored_vertices().expect("vertices");
    let number = |corner: [i32; 3]| stored.iter().position(|it| it.position() == corner);
    let [a, b, c] = scene
        .triangle(0)
        .expect("a triangle")
        .map(|corner| number(corner).unwrap());
    let vertices = deformation.vertices_mut();
    vertices[a].0 = [0, 2000, -400];
    vertices[b].0 = [1000, 4000, -200];
    vertices[c].0 = [2000, 6000, 0];
    let primitive = scene.primitive(Kind::Triangle, 0);
    let needle = Err(DeformError::Collapsed { primitive });
    assert_eq!(deformation.refit(&scene), needle);
    deformation.vertices_mut()[b].0[2] += 1;
    assert_eq!(deformation.refit(&scene), Ok(()));
    assert_eq!(deformation.reset(&scene), Ok(()));
    assert_eq!(deformation.vertices(), stored);
}

#[test]
fn vertices_are_placed_in_scene_coordinates() {
    for lattice_bits in [16, 24] {
        let blob = bvh(&in_a_room(ball()), lattice_bits);
        let scene = blob.scene().expect("a scene");
        let steps = (0.75 * f64::powi(2.0, -scene.coordinate_exponent())) as i32;
        let place = Position([steps, -steps, 0]);
        fn placed<V: Vertex>(scene: &Loaded<'_>, place: Position) -> [i32; 3] {
            let mut deformation = mesh::<V>(scene);
            assert_eq!(deformation.place(scene, 3, place), Ok(()));
            assert_eq!(deformation.refit(scene), Ok(()));
            let far = Position([i32::MAX; 3]);
            let outside = Err(DeformError::OutsideRoom { vertex: 3 });
            assert_eq!(deformation.place(scene, 3, far), outside);
            let missing = Err(DeformError::NoVertex { vertex: 642 });
            assert_eq!(deformation.place(scene, 642, place), missing);
            assert_eq!(deformation.refit(scene), Ok(()));
            deformation.vertices()[3].position()
        }
        let found = match lattice_bits {
            16 => placed::<Vertex16>(&scene, place),
            _ => placed::<Vertex24>(&scene, place),
        };
        let expected = scene.on_lattice(place).map(|x| x as f64 / 32.0);
        let half = if lattice_bits == 16 { 128.0 } else { 0.5 };
        for (found, expected) in found.into_iter().zip(expected) {
            assert!((f64::from(found) - expected).abs() <= half);
        }
    }
}

#[test]
fn scenes_that_cannot_deform_are_rejected() {
    let scene = in_a_room(ball());
    let wide = bvh(&scene, 24);
    let wide = wide.scene().expect("a scene");
    let storage = Mesh::<Vertex16>::of(&wide).err();
    assert_eq!(storage, Some(DeformError::Storage));
    let few = Deformation::<Vertex24, 641, 1300>::of(&wide).err();
    let (found, most) = (642, 641);
    assert_eq!(few, Some(DeformError::Vertices { found, most }));
    let few = Deformation::<Vertex24, 642, 2>::of(&wide).err();
    assert!(matches!(
        few,
        Some(DeformError::Pairs {
            found: 3..,
            most: 2
        })
    ));
    for structure in [Structure::DualSplit, Structure::Wide, Structure::Apex] {
        let other = blob(&scene, 24, &[structure, Structure::Bvh]);
        let other = other.scene().expect("a scene");
        let error = Mesh::<Vertex24>::of(&other).err();
        assert_eq!(error, Some(DeformError::Structures), "{structure:?}");
    }
    // A deformation of another scene, with as many vertices.
    let mut other = scene.clone();
    other.materials[0].mirror = [0.5; 3];
    let other = bvh(&other, 24);
    let other = other.scene().expect("a scene");
    let mut deformation = mesh::<Vertex24>(&wide);
    assert_eq!(deformation.refit(&other), Err(DeformError::OtherScene));
    let error = other.with_deformation(&deformation).err();
    assert_eq!(error, Some(DeformError::OtherScene));
    let nothing = Box::new(Mesh::<Vertex24>::new());
    assert!(wide.with_deformation(&nothing).is_err());
}

/// Blobs for boards are proved when the program is compiled; the list alone has no boxes.
#[test]
fn prevalidated_scenes_and_lists_deform() {
    for structures in [&[Structure::Bvh][..], &[]] {
        let blob = blob(&in_a_room(ball()), 24, structures);
        let prevalidated = Prevalidated::of(blob.bytes()).expect("valid");
        let scene = Loaded::prevalidated(prevalidated).expect("a scene");
        let requirements = Requirements::of(blob.bytes()).expect("a blob");
        let mut deformation = mesh::<Vertex24>(&scene);
        assert_eq!(requirements.vertices, deformation.vertices().len());
        assert_eq!(requirements.pairs, deformation.pairs().len());
        shake(&mut Random(3), &scene, deformation.vertices_mut(), 1 << 20);
        deformation.refit(&scene).expect("a pose");
        let moved = scene.with_deformation(&deformation).expect("a scene");
        let places = moved_triangles(&scene, deformation.vertices());
        let mut random = Random(4);
        for _ in 0..200 {
            let ray = ray::<f32>(&mut random, &moved, &places);
            let listed = through(Structure::List, &moved, &ray).0;
            if !structures.is_empty() {
                let found = through(Structure::Bvh, &moved, &ray).0;
                assert_eq!(
                    found.map(|it| HitBits::of(&it)),
                    listed.map(|it| HitBits::of(&it))
                );
            }
        }
    }
}

/// Blobs that are proved at compile time can hold any records: nothing panics, and every walk ends.
#[test]
fn forged_prevalidated_blobs_deform_without_a_panic() {
    let honest = bvh(&in_a_room(ball()), 24);
    let mut random = Random(12);
    let (mut loaded, mut refitted) = (0, 0);
    let sections = honest.scene().expect("a scene").header().section_count;
    let start = size_of::<Header>() + 16 * usize::from(sections);
    for _ in 0..300 {
        let mut bytes = honest.bytes().to_vec();
        for _ in 0..1 + random.below(3) {
            let place = start + random.below(bytes.len() - start);
            bytes[place] ^= 1 << random.below(8);
        }
        let place = offset_of!(Header, checksum);
        bytes[place..place + 4].fill(0);
        let sum = checksum(&bytes);
        bytes[place..place + 4].copy_from_slice(&sum.to_le_bytes());
        let blob = Blob::new(&bytes);
        let prevalidated = Prevalidated::of(blob.bytes());
        let Some(Ok(scene)) = prevalidated.ok().map(Loaded::prevalidated) else {
            continue;
        };
        loaded += 1;
        let mut deformation = mesh::<Vertex24>(&scene);
        if deformation.refit(&scene).is_err() {
            continue;
        }
        refitted += 1;
        let moved = scene.with_deformation(&deformation).expect("a scene");
        for _ in 0..20 {
            let ray = ray::<gridel_core::Fixed>(&mut random, &moved, &[[[0; 3]; 3]]);
            through(Structure::Bvh, &moved, &ray);
        }
    }
    assert!(
        loaded > 100 && refitted > 50,
        "{loaded} loaded, {refitted} refitted"
    );
}
