//! Broken blobs: rejected with words that name the place, or else a scene that works.

mod claims;
mod forged;
mod fuzz;
mod mutants;
mod names;
mod old;
mod prevalidated;
mod reasons;

use glam::{DVec2, DVec3};
use gridel_core::format::BlobError;
use gridel_core::scene::part_blobs;
use gridel_core::{Format, Hit, List, NoCount, Number, Scene, Settings, Structure};
use gridel_host::blob::Blob;
use gridel_host::compile::{Options, compile};
use gridel_host::render::{Job, render};
use gridel_host::scene::{
    Alpha, Attributes, Camera, Diffuse, Image, Light, Material, Shape, Texture,
};
use gridel_host::shape::{Plane, Torus};
use gridel_tests::effort::step;
use gridel_tests::fuzz::{moves, sealed, speaks};
use gridel_tests::query::{UnitRay, any, closest, held, through};
use gridel_tests::random::Random;
use gridel_tests::{every_format, rays, scenes};

/// Every kind of record, every effect, and a hierarchy of a few levels.
fn small_scene() -> gridel_host::scene::Scene {
    let mut scene = scenes::soup(21, 16, 0.4);
    scene.objects.push(
        scenes::of([Shape::Mesh {
            vertices: [
                [0.0, 0.0, 0.0],
                [1.0, 0.0, 0.2],
                [0.0, 1.0, 0.1],
                [1.0, 1.0, 0.9],
            ]
            .map(DVec3::from_array)
            .to_vec(),
            triangles: vec![[0, 1, 2], [1, 3, 2]],
        }])
        .objects
        .remove(0),
    );
    let mesh = scene.objects.last_mut().expect("the mesh");
    mesh.attributes = Attributes {
        colors: vec![[1.0, 0.5, 0.1], [0.2; 3], [0.9; 3], [0.0, 1.0, 0.0]],
        coordinates: [[0.0, 0.0], [1.5, 0.0], [0.0, 1.0], [1.0, -0.5]]
            .map(DVec2::from_array)
            .to_vec(),
        triangles: vec![[0, 1, 2], [1, 3, 2]],
        displacements: Vec::new(),
    };
    mesh.material = 2;
    let torus = Shape::Torus(Torus {
        center: DVec3::new(0.5, 0.4, 0.3),
        axis: DVec3::new(1.0, 2.0, 0.0),
        major_radius: 0.3,
        minor_radius: 0.1,
    });
    let plane = Shape::Plane(Plane {
        point: DVec3::new(0.5, -0.4, 0.3),
        normal: DVec3::new(1.0, 2.0, 0.0),
    });
    scene.objects.extend(scenes::of([torus, plane]).objects);
    scene.materials.push(Material {
        name: String::from("everything"),
        diffuse: Diffuse::Checker {
            even: [0.9, 0.1, 0.1],
            odd: [0.1, 0.9, 0.1],
            size: 0.2,
            origin: DVec3::splat(0.05),
        },
        highlight: [0.5; 3],
        mirror: [0.2; 3],
        transmit: [0.7; 3],
        absorption: [0.1, 0.2, 0.3],
        ..Material::default()
    });
    let pixels = (0..6).map(|it| [40 * it, 255 - it, 9, 255]);
    let image = Image::new("six", 3, 2, pixels.collect()).expect("six pixels");
    scene.materials.push(Material {
        name: String::from("image"),
        texture: Some(Texture::of(image.into())),
        alpha: Some(Alpha::Blend(0.9)),
        ..Material::default()
    });
    let plain = scene.objects.iter_mut().filter(|it| it.material == 0);
    for object in plain.step_by(3) {
        object.material = 1;
    }
    let color = [0.8; 3];
    let position = DVec3::new(3.0, 4.0, 5.0);
    let direction = DVec3::new(-1.0, -2.0, -0.5);
    scene.lights = vec![
        Light::Point { position, color },
        Light::Directional { direction, color },
    ];
    scene.camera = Some(Camera {
        eye: DVec3::new(0.5, 0.7, 4.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        fov_degrees: 50.0,
    });
    scene.tracks = scenes::moving(&scene, false);
    scene
}

fn small_blob(lattice_bits: u8) -> Vec<u8> {
    let options = scenes::compact_options(lattice_bits);
    let options = Options {
        names: true,
        ..options
    };
    let blob = compile(&small_scene(), &options).expect("compiles").blob;
    blob.bytes().to_vec()
}

/// Uses a scene that was accepted. All structures that loading proves agree, and the others and
/// pictures terminate.
fn works(scene: &Scene<'_>, rays_each: usize) {
    every_format!(structures_agree(scene, rays_each));
    let samples = 1;
    let settings = Settings::of(scene);
    render_small(
        scene,
        Settings {
            samples,
            ..settings
        },
    );
}

/// Renders a picture of 4 by 3 pixels in each format, each through another structure.
fn render_small(scene: &Scene<'_>, settings: Settings) {
    let settings = Settings {
        width: 4,
        height: 3,
        ..settings
    };
    for (format, structure) in Format::ALL.into_iter().zip(held(scene)) {
        let job = Job::whole(format, structure, settings);
        let picture = render(scene, &job, &|| ()).expect("a picture");
        assert_eq!(picture.pixels.len(), 12);
    }
}

fn structures_agree<N: Number>(scene: &Scene<'_>, rays_each: usize) {
    // The position and the primitive of a hit; slots may share a number in a forged blob.
    let answer =
        |hit: Option<Hit<N>>| hit.map(|hit| (N::far_to_f64(hit.t).to_bits(), hit.primitive));
    for ray in rays::rays(scene, 3).take(rays_each) {
        let Some(ready) = ray.ready::<N>(scene) else {
            continue;
        };
        let listed = answer(closest::<N, List>(scene, &ready, &mut NoCount));
        let check = |other, any: bool| {
            assert_eq!(listed, answer(other), "{}: {ray:?}", N::FORMAT.name());
            assert_eq!(listed.is_some(), any);
        };
        check(
            closest::<N, List>(scene, &ready, &mut NoCount),
            any::<N, List>(scene, &ready),
        );
        for structure in held(scene) {
            let (hit, any) = through::<N>(structure, scene, &ready);
            // Lists of candidates that were tampered with may lack something.
            if structure.is_proved() {
                check(hit, any);
            }
        }
    }
}

/// Counts of the outcomes of forged blobs.
#[derive(Debug, Default)]
struct Fate {
    rejected: usize,
    accepted: usize,
}

impl Fate {
    fn of(&mut self, blob: &Blob, rays_each: usize) {
        match blob.scene() {
            Ok(scene) => {
                self.accepted += 1;
                works(&scene, rays_each);
                moves(&scene, blob);
            }
            Err(error) => {
                self.rejected += 1;
                speaks(&error);
            }
        }
    }
}

#[test]
fn the_blob_itself_works() {
    for lattice_bits in [16, 24] {
        let blob = Blob::new(&small_blob(lattice_bits));
        eprintln!("{lattice_bits} bits: {} bytes", blob.bytes().len());
        works(&blob.scene().expect("a scene"), 1000);
        assert_eq!(sealed(blob.bytes()).bytes(), blob.bytes());
    }
}

#[test]
fn a_blob_cut_off_anywhere_is_rejected() {
    for lattice_bits in [16, 24] {
        let bytes = small_blob(lattice_bits);
        for length in 0..bytes.len() {
            for blob in [Blob::new(&bytes[..length]), sealed(&bytes[..length])] {
                speaks(&blob.scene().expect_err("a part of a blob was accepted"));
            }
        }
        let longer = [&bytes[..], &[0; 16]].concat();
        speaks(&sealed(&longer).scene().expect_err("trailing bytes"));
    }
}

#[test]
fn a_flipped_bit_is_rejected_or_after_sealing_harmless() {
    for lattice_bits in [16, 24] {
        let mut bytes = small_blob(lattice_bits);
        let mut fate = Fate::default();
        for bit in (0..8 * bytes.len()).step_by(step()) {
            bytes[bit / 8] ^= 1 << (bit % 8);
            speaks(
                &Blob::new(&bytes)
                    .scene()
                    .expect_err("a flipped bit was accepted"),
            );
            fate.of(&sealed(&bytes), 12);
            bytes[bit / 8] ^= 1 << (bit % 8);
        }
        eprintln!("{lattice_bits} bits: bits flipped and sealed again: {fate:?}");
        let many = 1000 / step();
        assert!(fate.rejected > many && fate.accepted > many);
    }
}

#[test]
fn words_of_extreme_value_are_rejected_or_harmless() {
    let bytes = small_blob(24);
    let mut fate = Fate::default();
    let mut put = |offset: usize, value: &[u8]| {
        let mut forged = bytes.clone();
        if let Some(place) = forged.get_mut(offset..offset + value.len()) {
            place.copy_from_slice(value);
            fate.of(&sealed(&forged), 12);
        }
    };
    for offset in (0..bytes.len()).step_by(2 * step()) {
        for word in [i16::MIN, i16::MAX, 0, -1] {
            put(offset, &word.to_le_bytes());
        }
    }
    for offset in (0..bytes.len()).step_by(4 * step()) {
        for word in [i32::MIN, i32::MIN + 1, i32::MAX, -1, -2, 0] {
            put(offset, &word.to_le_bytes());
        }
    }
    for offset in (0..bytes.len()).step_by(8 * step()) {
        for word in [i64::MIN, i64::MAX, 1 << 50, -(1 << 50), 1 << 62] {
            put(offset, &word.to_le_bytes());
        }
    }
    eprintln!("words of extreme value: {fate:?}");
}

#[test]
fn random_bytes_are_rejected() {
    let mut random = Random(5);
    let valid = small_blob(24);
    for round in 0..20_000 {
        let length = random.below(600);
        let mut bytes: Vec<u8> = (0..length).map(|_| random.bits() as u8).collect();
        // As far as a true header, every other time.
        let kept = if round % 2 == 0 {
            0
        } else {
            length.min(random.below(200))
        };
        bytes[..kept].copy_from_slice(&valid[..kept]);
        speaks(
            &sealed(&bytes)
                .scene()
                .expect_err("random bytes were accepted"),
        );
    }
}

#[test]
fn bytes_changed_at_random_are_rejected_or_harmless() {
    let mut random = Random(6);
    let valid = small_blob(24);
    let mut fate = Fate::default();
    for _ in 0..20_000 {
        let mut bytes = valid.clone();
        for _ in 0..=random.below(4) {
            let (place, bits) = (random.below(bytes.len()), random.bits());
            bytes[place] = [
                bits as u8,
                0,
                0x80,
                0xff,
                0x7f,
                valid[place].wrapping_add(1),
            ][random.below(6)];
        }
        fate.of(&sealed(&bytes), 6);
    }
    eprintln!("bytes changed at random: {fate:?}");
}

#[test]
fn a_misaligned_blob_is_rejected() {
    let bytes = small_blob(24);
    for offset in 1..=16 {
        let shifted = Blob::new(&[&vec![0; offset], &bytes[..], &[0; 16]].concat());
        let result = Scene::from_bytes(&shifted.bytes()[offset..][..bytes.len()]);
        let expected = (offset % 4 != 0).then_some(BlobError::Misaligned);
        assert_eq!(result.err(), expected, "offset {offset}");
    }
}

/// A blob may begin at any multiple of 4 bytes, on a workstation too.
#[test]
fn pictures_do_not_depend_on_where_the_blob_lies() {
    for (name, scene) in scenes::fixtures() {
        let blob = scenes::blob(&scene, 24);
        let here = blob.scene().expect("a scene");
        let settings = Settings {
            width: 24,
            height: 18,
            samples: 2,
            ..Settings::of(&here)
        };
        for shift in [4, 8, 12] {
            let moved = Blob::new(&[&vec![0; shift], blob.bytes()].concat());
            let bytes = &moved.bytes()[shift..];
            assert_eq!(bytes.as_ptr().addr() % 16, shift);
            let parts: Vec<_> = part_blobs(bytes)
                .and_then(|parts| parts.map(Scene::from_bytes).collect())
                .expect("parts");
            let there = Scene::with_parts(bytes, &parts).expect("a scene");
            for format in Format::ALL {
                let job = Job::whole(format, Structure::DualSplit, settings);
                let [here, there] = [&here, &there]
                    .map(|scene| render(scene, &job, &|| ()).expect("a picture").pixels);
                assert!(here == there, "{name}, {format:?}, moved by {shift} bytes");
            }
        }
    }
}

/// Every kind of invalid ray is rejected.
#[test]
fn invalid_rays_are_rejected() {
    let blob = Blob::new(&small_blob(24));
    let scene = blob.scene().expect("a scene");
    fn rejected<N: Number>(scene: &Scene<'_>) {
        let good = UnitRay::new([0.0; 3], [1.0, 0.5, 0.25]);
        assert!(good.ready::<N>(scene).is_some());
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for axis in 0..3 {
                let (mut origin, mut direction) = (good, good);
                origin.origin[axis] = bad;
                direction.direction[axis] = bad;
                assert!(origin.ready::<N>(scene).is_none());
                assert!(direction.ready::<N>(scene).is_none());
            }
        }
        let windows = [
            (f64::NAN, 1.0),
            (0.0, f64::NAN),
            (1.0, 0.5),
            (f64::INFINITY, 0.0),
        ];
        for (tmin, tmax) in windows {
            assert!(UnitRay { tmin, tmax, ..good }.ready::<N>(scene).is_none());
        }
        for zero in [0.0, -0.0] {
            let direction = [zero; 3];
            assert!(UnitRay { direction, ..good }.ready::<N>(scene).is_none());
        }
    }
    every_format!(rejected(&scene));
}
