//! Parts that deform, and their room.

use super::{ball, mesh, ray, shake};
use glam::{DQuat, DVec3};
use gridel_core::format::record::Vertex24;
use gridel_core::{BlobError, Number, Parts, Scene as Loaded, Structure};
use gridel_host::compile::{CompileError, Options, compile};
use gridel_host::measure::Deforming;
use gridel_host::scene::{Instance, Part, Placement, Scene, Shape, SourceSpan};
use gridel_tests::effort::part_of;
use gridel_tests::every_format;
use gridel_tests::query::{HitBits, through};
use gridel_tests::random::Random;
use gridel_tests::scenes;

/// Instances of a part, and of another one that stays.
fn with_parts() -> Scene {
    let part = |name: &str, shape: Shape| Part {
        name: name.to_owned(),
        objects: scenes::of([shape]).objects,
        place: SourceSpan::default(),
    };
    let instance = |part: usize, x: f64, scale: f64| Instance {
        joint: None,
        name: String::from("copy"),
        part,
        placement: Placement {
            rotation: DQuat::from_rotation_z(x),
            translation: DVec3::new(2.0 * x, 0.0, 0.0),
            scale,
        },
        place: SourceSpan::default(),
    };
    let mut scene = scenes::of([ball()]);
    scene.parts = vec![part("stays", ball()), part("moves", ball())];
    scene.instances = vec![
        instance(1, 1.0, 1.0),
        instance(0, 2.0, 0.5),
        instance(1, -1.5, 0.25),
        instance(1, -3.0, 2.0),
    ];
    scene
}

fn same_as_brute_force<N: Number>(moved: &Loaded<'_>, still: &Loaded<'_>) {
    let mut random = Random(8);
    let mut changed = 0;
    for _ in 0..part_of(3000, 100_000) {
        let ray = ray::<N>(&mut random, moved, &[[[0; 3]; 3]]);
        let bits = |structure, scene| {
            let (hit, any) = through::<N>(structure, scene, &ray);
            (hit.as_ref().map(HitBits::of), any)
        };
        let found = bits(Structure::Bvh, moved);
        assert_eq!(found, bits(Structure::List, moved), "{ray:?}");
        changed += usize::from(found != bits(Structure::Bvh, still));
    }
    assert!(changed > 100, "{changed} rays see the part move");
}

#[test]
fn a_part_deforms_wherever_it_is_placed() {
    let options = Options {
        structures: vec![Structure::Bvh],
        room: 0.5,
        ..Options::default()
    };
    let blob = compile(&with_parts(), &options).expect("compiles").blob;
    let parts = Parts::<2>::from_bytes(blob.bytes()).expect("two parts");
    let scene = Loaded::with_parts(blob.bytes(), &parts).expect("a scene");
    let mut deformation = mesh::<Vertex24>(&parts[1]);
    let reach = i32::from(parts[1].bounds().0[0][1]) << 6;
    shake(&mut Random(5), &parts[1], deformation.vertices_mut(), reach);
    deformation.refit(&parts[1]).expect("a pose");
    let moved = parts[1].with_deformation(&deformation).expect("a part");
    let changed = parts.with_part(1, moved).expect("the same part");
    let seen = scene.with_changed_parts(&changed).expect("the same parts");
    every_format!(same_as_brute_force(&seen, &scene));

    // Only in its own place.
    for number in [0, 2] {
        let error = parts.with_part(number, moved).err();
        assert!(
            matches!(error, Some(BlobError::Invalid { .. })),
            "{error:?}"
        );
    }
    let error = scene.with_changed_parts(&changed[..1]).err();
    assert_eq!(
        error,
        Some(BlobError::Parts {
            found: 1,
            expected: 2
        })
    );
    let turned = [changed[1], changed[0]];
    let error = scene.with_changed_parts(&turned).err();
    assert!(
        matches!(error, Some(BlobError::Invalid { .. })),
        "{error:?}"
    );

    let told = Deforming::all(&scene, blob.bytes());
    let whose: Vec<_> = told.iter().map(|it| it.part).collect();
    assert_eq!(whose, [None, Some(0), Some(1)]);
    assert!(told.iter().all(|it| it.vertices == 642));
}

#[test]
fn room_widens_the_box_and_nothing_else() {
    let scene = scenes::of([ball()]);
    let options = |room: f64| Options {
        structures: vec![Structure::Bvh],
        room,
        ..Options::default()
    };
    let narrow = compile(&scene, &options(0.0)).expect("compiles").blob;
    // The lattice has room for this.
    let wide = compile(&scene, &options(1e-3)).expect("compiles").blob;
    let meshes = [&narrow, &wide].map(|blob| {
        let scene = blob.scene().expect("a scene");
        Deforming::all(&scene, blob.bytes()).len()
    });
    assert_eq!(meshes, [0, 1]);
    let [narrow, wide] = [&narrow, &wide].map(|blob| blob.scene().expect("a scene"));
    let unit = f64::powi(2.0, wide.header().unit_exponent.into());
    for (narrow, wide) in narrow.bounds().0.into_iter().zip(wide.bounds().0) {
        for side in 0..2 {
            let moved = f64::from(wide[side].abs_diff(narrow[side])) * unit;
            assert!((1e-3..1e-3 + unit).contains(&moved), "{moved}");
        }
    }
    for room in [-0.5, f64::NAN, f64::INFINITY] {
        let error = compile(&scene, &options(room)).expect_err("no room");
        assert!(matches!(error, CompileError::Room { .. }));
    }
}
