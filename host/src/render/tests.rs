//! Pictures of meshes with smooth normals.

use super::*;
use crate::blob::Blob;
use crate::compile::{Options, compile};
use crate::sample::icosphere;
use crate::scene::{
    Attributes, Camera, Instance, Light, Material, Normals, NormalsChoice, Object, Part, Placement,
    Scene as Model, Shape, SourceSpan,
};
use glam::{DQuat, DVec3};
use gridel_core::{Ray, Stack};

/// The light comes from the right, at right angles to the view.
const TO_LIGHT: DVec3 = DVec3::X;

/// A sphere of triangles with computed normals, seen along -z, under one light.
fn ball(levels: u32) -> Model {
    let mut scene = icosphere(levels);
    scene.objects[0].shade(NormalsChoice::Smooth(180.0));
    scene.camera = Some(Camera {
        eye: DVec3::new(0.0, 0.0, 4.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        fov_degrees: 36.0,
    });
    scene.lights = vec![Light::Directional {
        direction: -TO_LIGHT,
        color: [1.0; 3],
    }];
    (scene.ambient, scene.background) = ([0.0; 3], Some([0.0; 3]));
    scene
}

fn blob(scene: &Model) -> Blob {
    let options = Options {
        structures: vec![Structure::DualSplit],
        ..Options::default()
    };
    compile(scene, &options).expect("a blob").blob
}

const SIZE: u16 = 96;

fn picture(blob: &Blob, format: Format, structure: Structure) -> Vec<[u16; 3]> {
    let scene = blob.scene().expect("a scene");
    let settings = Settings {
        width: SIZE,
        height: SIZE,
        samples: 1,
        ..Settings::of(&scene)
    };
    let job = Job::whole(format, structure, settings);
    render(&scene, &job, &|| ()).expect("a picture").pixels
}

/// The hit in the middle of a pixel: geometric and smooth normal, towards the eye.
fn normals<N: Number>(scene: &Scene<'_>, x: u16, y: u16) -> Option<[DVec3; 2]> {
    let settings = Settings {
        width: SIZE,
        height: SIZE,
        samples: 1,
        ..Settings::of(scene)
    };
    let renderer = Renderer::<N, DualSplit, ALL>::with_settings(scene, settings).ok()?;
    let ray: Ray<N> = renderer.primary_ray(x, y).ok()?;
    let mut stack = Stack::<MAX_STACK_DEPTH>::new();
    let hit = scene.closest_hit(&ray, stack.as_view())?;
    let vector = |v: [N; 3]| DVec3::from_array(v.map(N::ratio_to_f64));
    assert!(hit.front);
    Some([vector(hit.normal), vector(hit.shading_normal(scene))])
}

/// Returns the largest angles between the smooth or flat normals of a sphere's hits and the sphere's own, in radians.
fn errors<N: Number>(levels: u32) -> [f64; 2] {
    let blob = blob(&ball(levels));
    let scene = blob.scene().expect("a scene");
    let unit = f64::powi(2.0, scene.header().unit_exponent.into());
    let origin = DVec3::from_array(scene.header().origin);
    let mut worst = [0.0_f64; 2];
    for index in 0..200_u32 {
        // A spiral around the sphere.
        let z = 1.0 - (2.0 * f64::from(index) + 1.0) / 200.0;
        let (sine, cosine) = (2.4 * f64::from(index)).sin_cos();
        let radial = DVec3::new(
            (1.0 - z * z).sqrt() * cosine,
            (1.0 - z * z).sqrt() * sine,
            z,
        );
        let from = (3.0 * radial - origin) / unit;
        let ray = Ray::<N>::from_f64(
            scene.bounds(),
            from.to_array(),
            (-radial).to_array(),
            0.0,
            1e9,
        );
        let mut stack = Stack::<MAX_STACK_DEPTH>::new();
        let hit = scene
            .closest_hit(&ray.expect("a ray"), stack.as_view())
            .expect("a hit");
        for (worst, normal) in worst
            .iter_mut()
            .zip([hit.shading_normal(&scene), hit.normal])
        {
            let normal = DVec3::from_array(normal.map(N::ratio_to_f64));
            *worst = worst.max((normal - radial).length());
        }
    }
    worst
}

fn check_convergence<N: Number>() {
    // At level 1 all vertices are alike, and have the sphere's own normals.
    let exact = errors::<N>(1);
    assert!(exact[0] < 1e-3 && exact[1] > 0.3, "{exact:?}");
    let all = [2, 3, 4].map(errors::<N>);
    for pair in all.windows(2) {
        let [[smooth, flat], [finer, finer_flat]] = [pair[0], pair[1]];
        assert!(finer < 0.6 * smooth, "{all:?}");
        assert!(finer_flat > 0.4 * flat, "{all:?}");
    }
    assert!(
        all.iter().all(|[smooth, flat]| *smooth < flat / 14.0),
        "{all:?}"
    );
}

#[test]
fn smooth_normals_of_a_sphere_converge_to_the_spheres() {
    check_convergence::<f32>();
    check_convergence::<f64>();
    check_convergence::<Fixed>();
}

#[test]
fn coarse_ball_is_lit_by_its_smooth_normals_alone() {
    let blob = blob(&ball(1));
    let scene = blob.scene().expect("a scene");
    for format in [Format::F32, Format::F64, Format::Fixed] {
        let found = picture(&blob, format, Structure::DualSplit);
        let (mut behind, mut lit, mut dark) = (0, 0, 0);
        for (place, pixel) in (0..).zip(&found) {
            let Some([flat, smooth]) = normals::<f64>(&scene, place % SIZE, place / SIZE) else {
                assert_eq!(*pixel, [0; 3]);
                continue;
            };
            let expected = 0.8 * smooth.dot(TO_LIGHT).max(0.0);
            let off = f64::from(pixel[0]) / 65535.0 - expected;
            assert!(
                off.abs() < 2e-3,
                "{format:?} {place}: {pixel:?} for {expected}"
            );
            behind += u32::from(flat.dot(TO_LIGHT) < 0.0 && expected > 0.01);
            lit += u32::from(expected > 0.0);
            dark += u32::from(expected == 0.0);
        }
        assert!(
            behind > 50 && lit > 1000 && dark > 1000,
            "{behind} {lit} {dark}"
        );
    }
}

#[test]
fn light_behind_a_sheet_does_not_leak_through() {
    // A hollow square: the normals on the left lean to the right, those on the right to the left.
    let mut scene = ball(0);
    let corner = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    scene.objects[0].shape = Shape::Mesh {
        vertices: vec![
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
        ],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    };
    scene.objects[0].normals = Normals {
        vectors: [1.0, -1.0]
            .map(|x| DVec3::new(x, 0.0, 1.0).normalize())
            .to_vec(),
        triangles: vec![[0, 1, 1], [0, 1, 0]],
        changes: Vec::new(),
    };
    for (z, is_lit) in [(-0.5, false), (0.5, true)] {
        scene.lights = vec![Light::Directional {
            direction: DVec3::new(-1.0, 0.0, -z),
            color: [1.0; 3],
        }];
        let blob = blob(&scene);
        for format in [Format::F32, Format::Fixed] {
            let found = picture(&blob, format, Structure::DualSplit);
            let any = found.iter().any(|pixel| *pixel != [0; 3]);
            assert_eq!(any, is_lit, "{format:?} from z = {z}");
        }
    }
}

#[test]
fn mirrored_and_refracted_rays_do_not_go_to_the_wrong_side() {
    // A ray that is reflected off a convex ball misses it, and sees the white background.
    let mut scene = ball(1);
    (scene.lights, scene.background) = (Vec::new(), Some([1.0; 3]));
    scene.ambient = [1e-9; 3];
    scene.materials = vec![Material {
        diffuse: crate::scene::Diffuse::Plain([0.0; 3]),
        mirror: [1.0; 3],
        ..Material::default()
    }];
    let mirror = blob(&scene);
    for format in [Format::F32, Format::F64, Format::Fixed] {
        let found = picture(&mirror, format, Structure::DualSplit);
        let least = found.iter().map(|pixel| pixel[0]).min();
        assert!(least > Some(65_500), "{format:?}: {least:?}");
    }
    // Whatever a path through glass meets, it comes out again.
    scene.materials[0].transmit = [1.0; 3];
    scene.materials[0].mirror = [0.0; 3];
    scene.render.depth = 16;
    scene.render.cutoff = 1e-4;
    let glass = blob(&scene);
    for format in [Format::F32, Format::Fixed] {
        let found = picture(&glass, format, Structure::DualSplit);
        let dark = found.iter().filter(|pixel| pixel[0] < 60_000).count();
        assert!(dark * 50 < found.len(), "{format:?}: {dark}");
    }
}

#[test]
fn instances_have_the_normals_of_their_parts() {
    let plain = ball(1);
    let placement = Placement {
        rotation: DQuat::from_euler(glam::EulerRot::XYZ, 0.4, 1.1, -0.3),
        translation: DVec3::new(0.1, -0.1, 0.2),
        scale: 0.7,
    };
    let placed = Model {
        objects: Vec::new(),
        parts: vec![Part {
            name: String::from("ball"),
            objects: plain.objects.clone(),
            place: SourceSpan::default(),
        }],
        instances: vec![Instance {
            joint: None,
            name: String::from("one"),
            part: 0,
            placement,
            place: SourceSpan::default(),
        }],
        ..plain
    };
    let (kept, copied) = (blob(&placed), blob(&placed.flattened().expect("copies")));
    let of_part: Vec<_> = kept
        .scene()
        .expect("a scene")
        .parts()
        .iter()
        .map(|it| it.effects())
        .collect();
    assert_eq!(of_part, [Effects::SMOOTH]);
    for format in [Format::F32, Format::Fixed] {
        let [kept, copied] = [&kept, &copied].map(|it| picture(it, format, Structure::DualSplit));
        let differs = |(a, b): &(&[u16; 3], &[u16; 3])| a[0].abs_diff(b[0]) > 200;
        let different = kept.iter().zip(&copied).filter(differs).count();
        // Some at the silhouette.
        assert!(different < 20, "{format:?}: {different}");
    }
}

#[test]
fn structures_agree_on_smooth_pictures() {
    let options = Options {
        structures: vec![Structure::DualSplit, Structure::Wide, Structure::Grid],
        ..Options::default()
    };
    let all = compile(&ball(2), &options).expect("a blob").blob;
    let wide = Options {
        structures: vec![Structure::Wide],
        ..Options::default()
    };
    let wide = compile(&ball(2), &wide).expect("a blob").blob;
    for format in [Format::F32, Format::F64, Format::Fixed] {
        let expected = picture(&all, format, Structure::List);
        for structure in [Structure::DualSplit, Structure::Wide, Structure::Grid] {
            assert!(
                picture(&all, format, structure) == expected,
                "{format:?} {structure:?}"
            );
        }
        assert!(
            picture(&wide, format, Structure::Wide) == expected,
            "{format:?} alone"
        );
    }
}

fn object(shape: Shape, normals: Normals) -> Object {
    Object {
        name: String::from("thing"),
        material: 0,
        shape,
        normals,
        attributes: Attributes::default(),
        place: SourceSpan::default(),
    }
}

#[test]
fn normals_take_four_bytes_and_flat_ones_nothing() {
    let (smooth, mut flat) = (ball(2), ball(2));
    flat.objects[0].shade(NormalsChoice::Flat);
    let [with, without] = [&smooth, &flat].map(blob);
    let scene = with.scene().expect("a scene");
    assert_eq!((scene.normals(), scene.vertices()), (162, 162));
    assert_eq!(scene.effects(), Effects::SMOOTH.with(Effects::SHADOW));
    // A line of the section table, and what aligns sections.
    let more = with.bytes().len() - without.bytes().len();
    assert!((4 * 162..4 * 162 + 48).contains(&more), "{more}");
    assert_eq!(without.scene().expect("a scene").effects(), Effects::SHADOW);
    // Edges of more than 10 degrees stay sharp, so all normals are those of the faces.
    let mut sharp = ball(1);
    sharp.objects[0].shade(NormalsChoice::Smooth(10.0));
    let mut plain = ball(1);
    plain.objects[0].shade(NormalsChoice::Flat);
    assert_eq!(blob(&sharp).bytes(), blob(&plain).bytes());
}

#[test]
fn flat_and_smooth_meshes_share_a_blob() {
    let mut scene = ball(2);
    let Shape::Mesh {
        vertices,
        triangles,
    } = scene.objects[0].shape.clone()
    else {
        panic!("a mesh");
    };
    let beside = vertices.iter().map(|it| *it + 2.5 * DVec3::X).collect();
    let beside = Shape::Mesh {
        vertices: beside,
        triangles,
    };
    scene.objects.insert(0, object(beside, Normals::default()));
    let blob = blob(&scene);
    let scene = blob.scene().expect("a scene");
    assert_eq!((scene.normals(), scene.vertices()), (162, 324));
}
