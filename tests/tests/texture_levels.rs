//! Texture levels: distant surfaces show copies of an image whose texels are as large as the area that a sample sees.

use glam::{DAffine2, DQuat, DVec2, DVec3};
use gridel_core::{
    Effects, Event, Fixed, Format, List, Number, Observer, Renderer, Scene, Settings, Structure,
    Workspace,
};
use gridel_host::blob::Blob;
use gridel_host::compile::{Options, compile};
use gridel_host::render::{Job, render_linear};
use gridel_host::scene::{
    self, Attributes, Camera, Diffuse, Image, Instance, Material, NormalMap, Part, Placement,
    Shape, SourceSpan, Texture,
};
use gridel_tests::scenes;

/// The corners of a square, counter-clockwise seen from above.
const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]];
const TRIANGLES: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

/// Half the side of the floor.
const REACH: f64 = 40.0;
/// Texture coordinates per unit of length, to the right and to the front.
const PER_UNIT: DVec2 = DVec2::new(0.5, 1.0);
/// Texels of the image.
const TEXELS: [u32; 2] = [64, 32];

const EYE: DVec3 = DVec3::new(0.0, 2.0, 9.0);
const FOV: f64 = 50.0;

/// Black and white texels by turns, each two wide.
fn squares() -> Image {
    let [width, height] = TEXELS;
    let pixel = |number: u32| {
        let (x, y) = (number % width, number / width);
        let channel = if (x / 2 + y / 2) % 2 == 0 { 255 } else { 0 };
        [channel, channel, channel, 255]
    };
    let pixels = (0..width * height).map(pixel).collect();
    Image::new("squares", width, height, pixels).expect("an image")
}

/// A floor at y = 0, from -[`REACH`] to it, times a factor.
fn floor(factor: f64) -> (Shape, Attributes) {
    let place = |[x, z]: [f64; 2]| DVec3::new(x, 0.0, z) * REACH * factor;
    let at = |[x, z]: [f64; 2]| DVec2::new(x, z) * REACH * PER_UNIT;
    let mesh = Shape::Mesh {
        vertices: CORNERS.map(place).to_vec(),
        triangles: TRIANGLES.to_vec(),
    };
    let attributes = Attributes {
        colors: Vec::new(),
        coordinates: CORNERS.map(at).to_vec(),
        triangles: TRIANGLES.to_vec(),
        displacements: Vec::new(),
    };
    (mesh, attributes)
}

fn texture(levels: bool) -> Texture {
    Texture {
        levels,
        ..Texture::of(squares().into())
    }
}

/// The floor, lit by ambient light alone.
fn scene(levels: bool) -> scene::Scene {
    let (mesh, attributes) = floor(1.0);
    let mut scene = scenes::of([mesh]);
    scene.objects[0].attributes = attributes;
    scene.materials = vec![Material {
        diffuse: Diffuse::Plain([1.0; 3]),
        texture: Some(texture(levels)),
        ..Material::default()
    }];
    (scene.ambient, scene.background) = ([1.0; 3], Some([0.5; 3]));
    scene.lights.clear();
    scene.render.shadows = false;
    scene.camera = Some(Camera {
        eye: EYE,
        target: DVec3::ZERO,
        up: DVec3::Y,
        fov_degrees: FOV,
    });
    scene
}

fn blob_of(scene: &scene::Scene) -> Blob {
    let options = Options {
        structures: vec![Structure::DualSplit],
        ..Options::default()
    };
    compile(scene, &options).expect("compiles").blob
}

/// The coordinates and the levels of texture lookups.
#[derive(Default)]
struct Looked(Vec<(DVec2, f64)>);

impl Observer for Looked {
    const ENABLED: bool = true;

    fn event(&mut self, event: Event) {
        if let Event::Textured {
            coordinates, level, ..
        } = event
        {
            self.0.push((DVec2::from(coordinates), level));
        }
    }
}

fn looked_up<N: Number>(scene: &Scene<'_>, settings: Settings) -> Vec<(DVec2, f64)> {
    let renderer = Renderer::<N, List, { Effects::ALL.0 }>::with_settings(scene, settings);
    let renderer = renderer.expect("a renderer");
    let mut space = Workspace::<N, 0, 16>::new();
    let mut looked = Looked::default();
    for (x, y) in (0..settings.height).flat_map(|y| (0..settings.width).map(move |x| (x, y))) {
        renderer.linear(x, y, &mut space.as_view(), &mut looked);
    }
    looked.0
}

/// The level at a place of the floor, seen from an eye, by the definition.
fn expected(at: DVec2, eye: DVec3, fov: f64, settings: Settings) -> f64 {
    let way = DVec3::new(at.x, 0.0, at.y) - eye;
    let samples = f64::from(settings.samples).sqrt();
    let spread = 2.0 * (fov / 2.0).to_radians().tan() / f64::from(settings.height) / samples;
    let cosine = way.y.abs() / way.length();
    let texels = PER_UNIT * DVec2::from(TEXELS.map(f64::from));
    let density = (texels.x * texels.y).sqrt();
    let side = spread * way.length() / cosine.sqrt();
    (side * density).log2().clamp(0.0, 6.0)
}

/// Checks the levels of all samples of a scene whose floor is seen from an eye.
fn check(what: &str, scene: &scene::Scene, eye: DVec3, samples: u16) {
    let blob = blob_of(scene);
    let scene = blob.scene().expect("valid");
    assert!(scene.effects().contains(Effects::TEXTURE_LEVELS));
    for height in [12, 40] {
        let settings = Settings {
            width: height,
            height,
            samples,
            depth: 2,
            ..Settings::of(&scene)
        };
        for (format, looked) in [
            (Format::Fixed, looked_up::<Fixed>(&scene, settings)),
            (Format::F32, looked_up::<f32>(&scene, settings)),
            (Format::F64, looked_up::<f64>(&scene, settings)),
        ] {
            let mut seen = [f64::INFINITY, f64::NEG_INFINITY];
            for (at, level) in &looked {
                let expected = expected(at / PER_UNIT, eye, FOV, settings);
                assert!(
                    (level - expected).abs() < 0.06,
                    "{what}, {format:?}, {height}: {level} for {expected} at {at}"
                );
                seen = [seen[0].min(*level), seen[1].max(*level)];
            }
            let least = usize::from(height).pow(2) * usize::from(samples) / 4;
            assert!(looked.len() > least, "{what}: {}", looked.len());
            assert!(seen[1] - seen[0] > 1.5, "{what}: {seen:?}");
        }
    }
}

#[test]
fn levels_are_those_of_the_footprints_of_samples() {
    for samples in [1, 4, 64] {
        check("the floor", &scene(true), EYE, samples);
    }
}

/// The eye is 10 to 100,000 times the floor's size away, with lenses as long.
#[test]
fn levels_seen_from_afar_are_those_of_the_distance() {
    for distance in [8e2, 8e4, 8e6] {
        let mut scene = scene(true);
        let way = DVec3::new(0.0, 0.3, 1.0).normalize() * distance;
        let fov = f64::to_degrees(2.0 * (4.0 / distance).atan());
        scene.camera = Some(Camera {
            eye: way,
            fov_degrees: fov,
            ..scene.camera.expect("a camera")
        });
        let blob = blob_of(&scene);
        let scene = blob.scene().expect("valid");
        let settings = Settings {
            width: 24,
            height: 24,
            samples: 1,
            depth: 0,
            ..Settings::of(&scene)
        };
        let check = |format: Format, looked: Vec<(DVec2, f64)>| {
            assert!(looked.len() > 100, "{}", looked.len());
            for (at, level) in looked {
                assert!((1.0..5.5).contains(&level), "{level}");
                let expected = expected(at / PER_UNIT, way, fov, settings);
                assert!(
                    (level - expected).abs() < 0.06,
                    "{format:?}, {distance}: {level} for {expected}"
                );
            }
        };
        check(Format::Fixed, looked_up::<Fixed>(&scene, settings));
        check(Format::F64, looked_up::<f64>(&scene, settings));
        // Directions of `f32` are too coarse for longer lenses.
        if distance < 1e5 {
            check(Format::F32, looked_up::<f32>(&scene, settings));
        }
    }
}

#[test]
fn levels_behind_a_mirror_are_those_of_the_whole_path() {
    let mut scene = scene(true);
    // A mirror behind the floor's middle, which fills the picture.
    let corner = |[x, y]: [f64; 2]| DVec3::new(30.0 * x, 30.0 * y, -3.0);
    let mut mirror = scene.objects[0].clone();
    mirror.shape = Shape::Mesh {
        vertices: [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
            .map(corner)
            .to_vec(),
        triangles: TRIANGLES.to_vec(),
    };
    mirror.attributes = Attributes::default();
    mirror.material = 1;
    scene.materials.push(Material {
        diffuse: Diffuse::Plain([0.0; 3]),
        mirror: [1.0; 3],
        ..Material::default()
    });
    scene.objects.push(mirror);
    let blob = blob_of(&scene);
    let scene = blob.scene().expect("valid");
    let settings = Settings {
        width: 40,
        height: 40,
        samples: 1,
        depth: 2,
        ..Settings::of(&scene)
    };
    let mirrored = DVec3::new(EYE.x, EYE.y, -6.0 - EYE.z);
    let mut count = [0; 2];
    for (at, level) in looked_up::<f32>(&scene, settings) {
        let near = |eye| (level - expected(at / PER_UNIT, eye, FOV, settings)).abs() < 0.06;
        // Before the mirror both are seen.
        let place = at.y / PER_UNIT.y;
        assert!(
            near(mirrored) || place > -3.0 && near(EYE),
            "{level} at {at}"
        );
        count[usize::from(near(mirrored))] += 1;
    }
    assert!(count[0] > 200 && count[1] > 200, "{count:?}");
}

#[test]
fn levels_of_instances_are_those_of_their_size() {
    for (factor, turn) in [(1.0, 0.0), (0.3, 0.0), (5.0, 0.0), (0.7, 180.0)] {
        let mut scene = scene(true);
        let mut object = scene.objects.remove(0);
        (object.shape, object.attributes) = floor(factor);
        scene.parts = vec![Part {
            name: String::from("floor"),
            objects: vec![object],
            place: SourceSpan::default(),
        }];
        scene.instances = vec![Instance {
            name: String::from("floor"),
            part: 0,
            placement: Placement {
                rotation: DQuat::from_rotation_y(f64::to_radians(turn)),
                scale: 1.0 / factor,
                ..Placement::IDENTITY
            },
            joint: None,
            place: SourceSpan::default(),
        }];
        // Turned around, the place is the opposite one, and so is the eye.
        let eye = if turn == 0.0 {
            EYE
        } else {
            DVec3::new(-EYE.x, EYE.y, -EYE.z)
        };
        check(&format!("{factor} times"), &scene, eye, 1);
    }
}

fn picture(blob: &Blob, format: Format, samples: u16) -> Vec<f64> {
    let scene = blob.scene().expect("valid");
    let settings = Settings {
        width: 64,
        height: 64,
        samples,
        ..Settings::of(&scene)
    };
    let job = Job::whole(format, Structure::DualSplit, settings);
    let picture = render_linear(&scene, &job, &|| ()).expect("a picture");
    let red = picture.pixels.iter().map(|pixel| f64::from(pixel[0]));
    red.collect()
}

fn rms(a: &[f64], b: &[f64]) -> f64 {
    let sum: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
    (sum / a.len() as f64).sqrt()
}

/// One sample with levels is far closer to the mean of many without, and many are the same with levels and without.
#[test]
fn levels_are_the_mean_of_what_samples_see() {
    let [with, without] = [true, false].map(|levels| blob_of(&scene(levels)));
    let truth = picture(&without, Format::F64, 1024);
    let one = |blob| rms(&picture(blob, Format::F64, 1), &truth);
    assert!(
        one(&with) < 0.4 * one(&without),
        "{} {}",
        one(&with),
        one(&without)
    );
    let many = rms(&picture(&with, Format::F64, 1024), &truth);
    assert!(many < 0.02, "{many}");
}

#[test]
fn formats_see_the_same_levels() {
    let blob = blob_of(&scene(true));
    let exact = picture(&blob, Format::F64, 4);
    for format in [Format::Fixed, Format::F32] {
        let apart = rms(&picture(&blob, format, 4), &exact);
        assert!(apart < 0.002, "{format:?}: {apart}");
    }
}

/// The mean of all normals of a map that leans to both sides is upright: from afar its surface looks flat.
#[test]
fn normal_maps_are_flat_from_afar() {
    let leaning = |number: u32| {
        [
            if number.is_multiple_of(2) { 38 } else { 218 },
            128,
            200,
            255,
        ]
    };
    let image = Image::new("ridges", 32, 32, (0..1024).map(leaning).collect());
    let texture = Texture {
        levels: true,
        transform: DAffine2::from_scale(DVec2::splat(20.0)),
        bilinear: false,
        ..Texture::of(image.expect("an image").into())
    };
    let picture = |levels: bool| {
        let mut scene = scene(true);
        scene.materials[0].texture = None;
        scene.materials[0].normal_map = Some(NormalMap {
            texture: Texture {
                levels,
                ..texture.clone()
            },
            scale: 1.0,
        });
        scene.ambient = [0.0; 3];
        scene.lights = vec![scene::Light::Directional {
            direction: DVec3::new(-0.6, -0.8, 0.0),
            color: [1.0; 3],
        }];
        picture(&blob_of(&scene), Format::F32, 1)
    };
    let [with, without] = [true, false].map(picture);
    let surface = |all: &[f64]| {
        all[40 * 64..]
            .iter()
            .map(|it| (it - 0.8).abs())
            .fold(0.0, f64::max)
    };
    assert!(surface(&with) < 0.02, "{}", surface(&with));
    assert!(surface(&without) > 0.1, "{}", surface(&without));
}

/// Levels add a third of an image's texels, and nothing to scenes that ask for none.
#[test]
fn levels_take_a_third_of_the_image_more() {
    let bytes = |levels| blob_of(&scene(levels)).bytes().len();
    let [with, without] = [true, false].map(bytes);
    // Texels take one byte each, because grays are few. Sections begin at multiples of 16 bytes.
    let [width, height] = TEXELS;
    let level = |number: u32| (width >> number).max(1) * (height >> number).max(1);
    let texels: u32 = (1..7).map(level).sum();
    assert!(
        (with - without).abs_diff(texels as usize) < 16,
        "{with} {without}"
    );
    let plain = blob_of(&scene(false));
    assert!(
        !plain
            .scene()
            .expect("valid")
            .effects()
            .contains(Effects::TEXTURE_LEVELS)
    );
    let mut removed = scene(true);
    removed.remove_effects(Effects::TEXTURE_LEVELS);
    assert_eq!(blob_of(&removed).bytes(), plain.bytes());
}
