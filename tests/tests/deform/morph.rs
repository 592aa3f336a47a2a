//! Morph targets. Vertices are where exact arithmetic has them, to the rounding that is promised. Devices and hosts see
//! the same, meshes stay closed, and normals turn with them.

use super::{ball, moved_triangles, no_leaks, same_hits};
use glam::DVec3;
use gridel_core::deform::MorphTargets;
use gridel_core::format::record::{Vertex16, Vertex24};
use gridel_core::format::width::Vertex;
use gridel_core::{
    DeformError, Deformation, Kind, Requirements, Scene as Loaded, Structure, Tracks,
};
use gridel_host::blob::Blob;
use gridel_host::compile::{Options, compile};
use gridel_host::deformation::{self, HeapDeformation};
use gridel_host::morphed::morphed;
use gridel_host::scene::{
    Displacements, Interpolation, Key, MorphTarget, NormalChanges, Normals, NormalsChoice, Scene,
    Shape, SourceSpan, Track, TrackTarget,
};
use gridel_host::state::State;
use gridel_tests::effort::part_of;
use gridel_tests::every_format;
use gridel_tests::random::Random;
use gridel_tests::scenes;

/// A weight of 1.
const ONE: f64 = (1 << 24) as f64;

fn target(number: usize, weight: f64, range: [f64; 2]) -> MorphTarget {
    MorphTarget {
        name: format!("target {number}"),
        weight,
        range,
        place: SourceSpan::default(),
    }
}

/// A mesh with morph targets of these displacements, for each vertex.
fn scene_of(mesh: Shape, displacements: &[Vec<DVec3>], range: [f64; 2]) -> Scene {
    let mut scene = scenes::of([mesh]);
    for (number, vectors) in displacements.iter().enumerate() {
        scene.morph_targets.push(target(number, 0.0, range));
        scene.objects[0]
            .attributes
            .displacements
            .push(Displacements {
                target: number,
                vectors: vectors.clone(),
            });
    }
    scene
}

fn built(scene: &Scene, lattice_bits: u8) -> Blob {
    let options = Options {
        structures: vec![Structure::Bvh],
        lattice_bits,
        flat_meshes: true,
        ..Options::default()
    };
    compile(scene, &options).expect("compiles").blob
}

fn vertices(shape: &Shape) -> &[DVec3] {
    match shape {
        Shape::Mesh { vertices, .. } => vertices,
        _ => panic!("a mesh"),
    }
}

/// A ball and three shakes of its vertices, the first of which leaves half of them where they are.
fn shaken(random: &mut Random) -> Scene {
    let ball = ball();
    let count = vertices(&ball).len();
    let mut shake = |reach: f64, moves: fn(usize) -> bool| -> Vec<DVec3> {
        let vector = |random: &mut Random| DVec3::from_array([(); 3].map(|()| random.signed()));
        (0..count)
            .map(|number| match moves(number) {
                true => reach * vector(random),
                false => DVec3::ZERO,
            })
            .collect()
    };
    let all = [
        shake(0.3, |number| number % 2 == 0),
        shake(0.05, |_| true),
        shake(2.0, |_| true),
    ];
    scene_of(ball, &all, [-1.0, 1.0])
}

fn as_promised<V: Vertex>(lattice_bits: u8) {
    let mut random = Random(lattice_bits.into());
    let file = shaken(&mut random);
    let blob = built(&file, lattice_bits);
    let scene = blob.scene().expect("a scene");
    let morph = MorphTargets::from_bytes(blob.bytes()).expect("morph targets");
    let rest: &[V] = scene.stored_vertices().expect("vertices");
    let step =
        f64::powi(2.0, scene.header().unit_exponent.into()) / f64::powi(2.0, V::STEP_BITS as i32);
    let places = vertices(&file.objects[0].shape);
    let origin = DVec3::from_array(scene.header().origin);
    // Which vertex of the file each is, by its place.
    let number_of = |vertex: &V| {
        let place = [0, 1, 2].map(|k| f64::from(vertex.steps(k)));
        let place = origin + step * DVec3::from_array(place);
        let distance = |it: &usize| places[*it].distance_squared(place);
        let nearest = (0..places.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.expect("a vertex")
    };
    let numbers: Vec<usize> = rest.iter().map(number_of).collect();
    let mut mesh: HeapDeformation<V> = deformation::of(&scene).expect("a deformation");
    for _ in 0..6 {
        let weights = [(); 3].map(|()| (random.signed() * ONE) as i32);
        mesh.morph(&scene, &morph, &weights).expect("a pose");
        for ((moved, rest), &number) in mesh.vertices().iter().zip(rest).zip(&numbers) {
            for k in 0..3 {
                let way = file.objects[0].attributes.displacements.iter();
                let way = way.zip(weights).map(|(displacements, weight)| {
                    displacements.vectors[number].to_array()[k] / step * f64::from(weight) / ONE
                });
                let expected = f64::from(rest.steps(k)) + way.sum::<f64>();
                let error = (f64::from(moved.steps(k)) - expected).abs();
                // Half a step for each morph target, and for the sum.
                assert!(error <= 2.0 + 1e-6, "{error} steps");
            }
        }
        // What the host renders.
        let host = morphed(&blob, &scene, &weights).expect("a pose");
        let host = host.expect("vertices move");
        let seen = host.scene().expect("boxes of the pose");
        let stored: &[V] = seen.stored_vertices().expect("vertices");
        assert!(
            stored
                .iter()
                .map(Vertex::position)
                .eq(mesh.vertices().iter().map(Vertex::position))
        );
        let moved = scene.with_deformation(&mesh).expect("a scene");
        let triangles = moved_triangles(&scene, mesh.vertices());
        let rays = part_of(300, 40_000);
        let seen = (&seen, &[Structure::Bvh][..]);
        every_format!(same_hits(&moved, seen, &triangles, rays));
    }
    mesh.morph(&scene, &morph, &[0; 3]).expect("at rest");
    assert_eq!(
        bytemuck::cast_slice::<V, u8>(mesh.vertices()),
        bytemuck::cast_slice::<V, u8>(rest)
    );
    assert!(morphed(&blob, &scene, &[0; 3]).expect("at rest") == Some(blob.clone()));
}

#[test]
fn morphed_vertices_of_16_bits_are_as_promised() {
    as_promised::<Vertex16>(16);
}

#[test]
fn morphed_vertices_of_24_bits_are_as_promised() {
    as_promised::<Vertex24>(24);
}

/// Coordinates are snapped more coarsely than they are stored, and weights at rest are not 0.
#[test]
fn weights_at_rest_leave_the_blob_as_it_is() {
    let mut file = shaken(&mut Random(5));
    for (target, weight) in file.morph_targets.iter_mut().zip([0.3, -2.0, 0.5]) {
        target.weight = weight;
    }
    for lattice_bits in [11, 20] {
        let blob = built(&file, lattice_bits);
        let scene = blob.scene().expect("a scene");
        let morph = MorphTargets::from_bytes(blob.bytes()).expect("morph targets");
        let rest = morph.weights_at_rest().to_vec();
        assert_eq!(rest[1], -2 << 24);
        assert!(morphed(&blob, &scene, &rest).expect("at rest") == Some(blob.clone()));
        // All corners of the ranges have room.
        for corner in 0..8 {
            let weight = |k: usize| [-1, 1][corner >> k & 1] << 24;
            let weights = [weight(0), weight(1), weight(2)];
            assert!(morphed(&blob, &scene, &weights).expect("a pose").is_some());
        }
        let beyond = morphed(&blob, &scene, &[0, 0, 3 << 24]);
        assert!(
            beyond.is_err_and(|error| error.to_string().contains("outside of the scene's box")),
        );
    }
}

/// At the ends of the range of weights, of all morph targets together, and beyond them.
#[test]
fn largest_weights_have_room() {
    let most = 1 << 30;
    for lattice_bits in [16, 24] {
        let mut random = Random(lattice_bits.into());
        let mut file = shaken(&mut random);
        for target in &mut file.morph_targets {
            target.range = [-64.0, 64.0];
        }
        let blob = built(&file, lattice_bits);
        let scene = blob.scene().expect("a scene");
        for corner in 0..8 {
            let weight = |k: usize| [-most, most][corner >> k & 1];
            let weights = [weight(0), weight(1), weight(2)];
            let moved = morphed(&blob, &scene, &weights).expect("a pose");
            assert!(moved.expect("vertices move").scene().is_ok());
        }
        for beyond in [most + 1, -most - 1, i32::MAX, i32::MIN] {
            let error = morphed(&blob, &scene, &[0, beyond, 0]).expect_err("beyond");
            assert!(error.to_string().contains("morph target 1 is beyond ±64"));
        }
        file.morph_targets[1].range = [0.0, 64.5];
        let options = Options {
            structures: vec![Structure::Bvh],
            lattice_bits,
            ..Options::default()
        };
        let error = compile(&file, &options).expect_err("beyond").to_string();
        assert!(error.contains("target 1"), "{error}");
    }
}

/// Closed at all times: a ball that grows from one place, and a torus whose vertices lie at one place in pairs at rest.
#[test]
fn meshes_that_open_from_nothing_are_closed() {
    let ball = ball();
    let Shape::Mesh {
        vertices,
        triangles,
    } = &ball
    else {
        panic!("a mesh")
    };
    let grown = Shape::Mesh {
        vertices: vec![DVec3::new(0.25, -0.5, 0.125); vertices.len()],
        triangles: triangles.clone(),
    };
    let file = scene_of(grown, std::slice::from_ref(vertices), [0.0, 1.0]);
    // Flat at rest, front and back at the same places: all that opens is kept.
    let flat = Shape::Mesh {
        vertices: vertices
            .iter()
            .map(|it| DVec3::new(it.x, it.y, 0.0))
            .collect(),
        triangles: triangles.clone(),
    };
    let lifts = vertices.iter().map(|it| DVec3::Z * it.z).collect();
    let puffed = scene_of(flat, &[lifts], [0.0, 1.0]);
    for (file, about) in [(file, [0.25, -0.5, 0.125]), (puffed, [0.0; 3])] {
        let blob = built(&file, 24);
        let scene = blob.scene().expect("a scene");
        let mut random = Random(6);
        for weight in [0.01, 0.4, random.unit(), 1.0] {
            let weights = [(weight * ONE) as i32];
            let moved = morphed(&blob, &scene, &weights).expect("a pose");
            let moved = moved.expect("vertices move");
            let moved = moved.scene().expect("a scene");
            let units = |scene: &Loaded<'_>| {
                let header = *scene.header();
                let unit = f64::powi(2.0, header.unit_exponent.into());
                [0, 1, 2].map(|k: usize| (about[k] - header.origin[k]) / unit)
            };
            let triangles: Vec<_> = (0..moved.count(Kind::Triangle))
                .filter_map(|slot| moved.triangle(slot))
                .collect();
            assert!(triangles.len() > 1000, "{} triangles", triangles.len());
            let from = units(&moved);
            every_format!(no_leaks(&moved, &triangles, from));
        }
    }
}

/// The direction that a blob stores.
fn unfolded([x, y]: [i16; 2]) -> DVec3 {
    let [x, y] = [x, y].map(|it| f64::from(it) / f64::from(i16::MAX));
    let z = 1.0 - x.abs() - y.abs();
    let [x, y] = match z < 0.0 {
        true => [(1.0 - y.abs()).copysign(x), (1.0 - x.abs()).copysign(y)],
        false => [x, y],
    };
    DVec3::new(x, y, z).normalize()
}

/// The device's normals are the host's. Those of a squashed ball are the ones that are computed for it, and between the
/// two shapes they lie on the straight way.
#[test]
fn normals_turn_with_the_mesh() {
    let ball = ball();
    let squash = vertices(&ball).iter().map(|it| DVec3::Y * -0.8 * it.y);
    let squash = squash.collect();
    let mut file = scene_of(ball, &[squash], [-1.0, 1.0]);
    file.objects[0].shade(NormalsChoice::Smooth(60.0));
    let Shape::Mesh {
        vertices,
        triangles,
    } = &file.objects[0].shape
    else {
        panic!("a mesh")
    };
    let squashed: Vec<_> = vertices
        .iter()
        .map(|it| *it * DVec3::new(1.0, 0.2, 1.0))
        .collect();
    let shapes = [
        &file.objects[0].normals,
        &Normals::computed(&squashed, triangles, 180.0),
    ];
    let blob = built(&file, 24);
    let scene = blob.scene().expect("a scene");
    let needs = Requirements::of(blob.bytes()).expect("a blob");
    assert_eq!((needs.morph_targets, needs.moving_normals), (1, 642));
    let morph = MorphTargets::from_bytes(blob.bytes()).expect("morph targets");
    assert!(morph.changes_normals());
    let mut mesh = Box::new(Deformation::<Vertex24, 642, 1300, 642>::of(&scene).expect("room"));
    for weight in [-1.0, -0.125, 0.25, 0.5, 1.0] {
        let weights = [(weight * ONE) as i32];
        mesh.morph(&scene, &morph, &weights).expect("a pose");
        let host = morphed(&blob, &scene, &weights).expect("a pose");
        let host = host.expect("vertices move");
        let host = host.scene().expect("a scene");
        let moved = scene.with_deformation(&*mesh).expect("a scene");
        let mut largest = 0_f64;
        for slot in 0..triangles.len() {
            let found = moved.corner_normals(slot).expect("smooth");
            assert_eq!(Some(found), host.corner_normals(slot));
            let triangle = scene.primitive(Kind::Triangle, slot as u32) as usize;
            for (corner, found) in found.into_iter().enumerate() {
                let [rest, target] = shapes
                    .map(|normals| normals.vectors[normals.triangles[triangle][corner] as usize]);
                let expected = rest.lerp(target, weight);
                largest = largest.max(expected.angle_between(unfolded(found)));
            }
        }
        // Steps of the octahedron are 2^-15 and of changes 2^-14; with -1 a normal can be as short as 0.1.
        assert!(largest < 2e-3, "{largest} radians at {weight}");
    }
    let mut small = Box::new(Deformation::<Vertex24, 642, 1300>::of(&scene).expect("room"));
    let (found, most) = (642, 0);
    assert_eq!(
        small.morph(&scene, &morph, &[0]),
        Err(DeformError::Normals { found, most })
    );
    assert_eq!(mesh.normals().len(), 642);
    // A pose that morph targets did not make has none of theirs.
    mesh.vertices_mut();
    assert!(mesh.normals().is_empty());
}

/// No vertex moves.
#[test]
fn targets_of_normals_alone_turn_them() {
    let mut file = scenes::of([Shape::Mesh {
        vertices: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
        triangles: vec![[0, 1, 2]],
    }]);
    file.morph_targets = vec![target(0, 0.0, [0.0, 1.0])];
    file.objects[0].normals = Normals {
        vectors: vec![DVec3::Z; 3],
        triangles: vec![[0, 1, 2]],
        changes: vec![NormalChanges {
            target: 0,
            vectors: vec![DVec3::X; 3],
        }],
    };
    let blob = built(&file, 24);
    let scene = blob.scene().expect("a scene");
    assert_eq!(scene.corner_normals(0), Some([[0; 2]; 3]));
    let turned = morphed(&blob, &scene, &[1 << 24]).expect("a pose");
    let turned = turned.expect("normals change");
    // Halfway from z to x.
    let turned = turned.scene().expect("a scene").corner_normals(0);
    assert_eq!(turned, Some([[16384, 0]; 3]));
}

#[test]
fn invalid_weights_are_rejected() {
    let blob = built(&shaken(&mut Random(1)), 24);
    let scene = blob.scene().expect("a scene");
    let morph = MorphTargets::from_bytes(blob.bytes()).expect("morph targets");
    let mut mesh = Box::new(Deformation::<Vertex24, 642, 1300>::of(&scene).expect("room"));
    let (found, expected) = (2, 3);
    assert_eq!(
        mesh.morph(&scene, &morph, &[0; 2]),
        Err(DeformError::Weights { found, expected })
    );
    let beyond = [0, 1 << 30, (1 << 30) + 1];
    assert_eq!(
        mesh.morph(&scene, &morph, &beyond),
        Err(DeformError::Weight { number: 2 })
    );
    // The mesh stays as it was.
    scene.with_deformation(&*mesh).expect("a mesh at rest");
    let other = built(&shaken(&mut Random(2)), 24);
    let other = MorphTargets::from_bytes(other.bytes()).expect("morph targets");
    assert_eq!(
        mesh.morph(&scene, &other, &[0; 3]),
        Err(DeformError::OtherScene)
    );
}

/// Structures that cannot be refitted leave meshes at rest, and the report says so.
#[test]
fn other_structures_keep_the_shape_at_rest() {
    let file = shaken(&mut Random(4));
    let options = Options {
        structures: vec![Structure::Bvh, Structure::Wide],
        ..Options::default()
    };
    let compiled = compile(&file, &options).expect("compiles");
    assert!(compiled.report.keeps_rest);
    let warnings = compiled.report.warnings(24).join("\n");
    assert!(warnings.contains("keep their shape at rest"), "{warnings}");
    let morph = MorphTargets::from_bytes(compiled.blob.bytes()).expect("no morph targets");
    assert!(morph.is_empty() && morph.weights_at_rest().is_empty());
    let mut still = file.clone();
    still.morph_targets.clear();
    still.objects[0].attributes.displacements.clear();
    let still = compile(&still, &options).expect("compiles");
    assert!(still.blob == compiled.blob && !still.report.keeps_rest);
}

/// Parts morph where their instances stand, and tracks give weights at any time.
#[test]
fn states_have_the_weights_of_tracks() {
    let mut file = shaken(&mut Random(9));
    let part = gridel_host::scene::Part {
        name: String::from("part"),
        objects: file.objects.clone(),
        place: SourceSpan::default(),
    };
    file.parts = vec![part];
    file.instances = vec![gridel_host::scene::Instance {
        name: String::from("copy"),
        part: 0,
        placement: gridel_host::scene::Placement {
            translation: DVec3::new(4.0, 0.0, 0.0),
            ..gridel_host::scene::Placement::IDENTITY
        },
        joint: None,
        place: SourceSpan::default(),
    }];
    let key = |seconds: f64, weight: f64| Key {
        seconds,
        value: [weight, 0.0, 0.0, 0.0],
        ..Key::default()
    };
    file.tracks = vec![Track {
        target: TrackTarget::MorphWeight,
        index: 2,
        interpolation: Interpolation::Linear,
        keys: vec![key(1.0, 0.0), key(3.0, -1.0)],
        place: SourceSpan::default(),
    }];
    let blob = built(&file, 24);
    let scene = blob.scene().expect("a scene");
    let tracks = Tracks::from_bytes(blob.bytes()).expect("tracks");
    for (time, weight) in [(0, 0), (48_000, 0), (96_000, -1 << 23), (200_000, -1 << 24)] {
        let mut weights = [7; 3];
        tracks
            .weights_at(time, &mut weights)
            .expect("three weights");
        assert_eq!(weights, [0, 0, weight]);
        let state = State::at(&blob, &scene, &tracks, time).expect("a state");
        assert_eq!(state.morphed.is_none(), weight == 0);
        let seen = state.apply(&scene).expect("a scene");
        let moves = |at: &Loaded<'_>, rest: &Loaded<'_>| at.triangle(0) != rest.triangle(0);
        assert_eq!(moves(&seen, &scene), weight != 0);
        assert_eq!(moves(&seen.parts()[0], &scene.parts()[0]), weight != 0);
    }
    assert!(tracks.weights_at(0, &mut [0; 2]).is_err());
}

/// A pose that leaves the room moves some vertices before it is found out.
#[test]
fn a_failed_morph_leaves_no_pose_in_between() {
    let file = shaken(&mut Random(11));
    let blob = built(&file, 24);
    let scene = blob.scene().expect("a scene");
    let morph = MorphTargets::from_bytes(blob.bytes()).expect("morph targets");
    let rest: &[Vertex24] = scene.stored_vertices().expect("vertices");
    let mut mesh: HeapDeformation<Vertex24> = deformation::of(&scene).expect("a deformation");
    let places = |mesh: &HeapDeformation<Vertex24>| -> Vec<[i32; 3]> {
        mesh.vertices().iter().map(|it| it.0).collect()
    };
    let some = [ONE as i32, 0, ONE as i32 / 2];
    mesh.morph(&scene, &morph, &some).expect("a pose");
    let before = places(&mesh);
    // Wrong arguments change nothing.
    assert!(mesh.morph(&scene, &morph, &[0; 2]).is_err());
    assert!(mesh.morph(&scene, &morph, &[0, i32::MAX, 0]).is_err());
    assert!(scene.with_deformation(&mesh).is_ok() && places(&mesh) == before);
    let beyond = [0, 0, 64 << 24];
    assert!(mesh.morph(&scene, &morph, &beyond).is_err());
    assert!(scene.with_deformation(&mesh).is_err());
    mesh.refit(&scene).expect("the pose at rest");
    let at_rest: Vec<[i32; 3]> = rest.iter().map(|it| it.0).collect();
    assert!(places(&mesh) == at_rest && scene.with_deformation(&mesh).is_ok());
}
