//! Normal maps: surfaces are lit as if they had the normals of the image, and stay where they are.

use glam::{DAffine2, DQuat, DVec2, DVec3};
use gridel_core::{Effects, Format, Scene, Settings, Structure};
use gridel_host::blob::Blob;
use gridel_host::compile::{Options, compile};
use gridel_host::render::{Aov, Job, Values, render_aovs, render_linear};
use gridel_host::scene::{
    self, Attributes, Camera, Diffuse, Image, Instance, Light, Material, NormalMap, Normals, Part,
    Placement, Shape, SourceSpan, Texture,
};
use gridel_tests::scenes;

/// The corners of a square, from the lower left one on, counter-clockwise.
const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// The triangles' corners.
const TRIANGLES: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

const SIDE: u16 = 48;

/// The map from a point of the square, 0 to 1 to the right and up, to u and v of the image.
#[derive(Clone, Copy)]
struct Lies(DAffine2);

/// Upright, in a mirror, turned, upside down, and sheared.
fn layouts() -> [Lies; 5] {
    let of = |right: [f64; 2], up: [f64; 2], origin: [f64; 2]| {
        Lies(DAffine2::from_cols(
            DVec2::from(right),
            DVec2::from(up),
            DVec2::from(origin),
        ))
    };
    [
        of([1.0, 0.0], [0.0, -1.0], [0.0, 1.0]),
        of([-1.0, 0.0], [0.0, -1.0], [1.0, 1.0]),
        of([0.0, 1.0], [1.0, 0.0], [0.0, 0.0]),
        of([1.5, 0.0], [0.0, 1.5], [0.25, 0.0]),
        of([0.8, 0.3], [0.2, -0.9], [0.0, 1.0]),
    ]
}

/// An image whose normals lean to all sides.
fn bumps() -> Image {
    let pixel = |number: u32| {
        let (x, y) = (number % 8, number / 8);
        [
            40 + 25 * x as u8,
            220 - 25 * y as u8,
            190 + 8 * x as u8,
            255,
        ]
    };
    Image::new("bumps", 8, 8, (0..64).map(pixel).collect()).expect("an image")
}

/// The square at z = 0, seen from the front, and lit from one direction.
fn square(lies: Lies, scale: f64, bilinear: bool, to_light: DVec3) -> scene::Scene {
    let place = |[x, y]: [f64; 2]| DVec3::new(x, y, 0.0);
    let mesh = Shape::Mesh {
        vertices: CORNERS.map(place).to_vec(),
        triangles: TRIANGLES.to_vec(),
    };
    let mut scene = scenes::of([mesh]);
    let at = |[x, y]: [f64; 2]| lies.0.transform_point2(DVec2::new(x + 1.0, y + 1.0) / 2.0);
    scene.objects[0].attributes = Attributes {
        colors: Vec::new(),
        coordinates: CORNERS.map(at).to_vec(),
        triangles: TRIANGLES.to_vec(),
        displacements: Vec::new(),
    };
    scene.materials = vec![Material {
        diffuse: Diffuse::Plain([1.0; 3]),
        normal_map: Some(NormalMap {
            texture: Texture {
                bilinear,
                ..Texture::of(bumps().into())
            },
            scale,
        }),
        ..Material::default()
    }];
    scene.lights = vec![Light::Directional {
        direction: -to_light,
        color: [1.0; 3],
    }];
    (scene.ambient, scene.background) = ([0.0; 3], Some([0.0; 3]));
    scene.camera = Some(Camera {
        eye: DVec3::new(0.0, 0.0, 4.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        fov_degrees: 30.0,
    });
    scene
}

fn blob_of(scene: &scene::Scene) -> Blob {
    let options = Options {
        structures: vec![Structure::DualSplit, Structure::Wide, Structure::Grid],
        ..Options::default()
    };
    compile(scene, &options).expect("compiles").blob
}

fn job(scene: &Scene<'_>, format: Format, structure: Structure) -> Job {
    let settings = Settings {
        width: SIDE,
        height: SIDE,
        samples: 1,
        ..Settings::of(scene)
    };
    Job::whole(format, structure, settings)
}

fn red(blob: &Blob, format: Format, structure: Structure) -> Vec<f64> {
    let scene = blob.scene().expect("valid");
    let job = job(&scene, format, structure);
    let picture = render_linear(&scene, &job, &|| ()).expect("a picture");
    let red = picture.pixels.iter().map(|pixel| f64::from(pixel[0]));
    red.collect()
}

/// Returns the places of the square that pixels show, except at its border and at its diagonal.
fn places() -> impl Iterator<Item = (usize, DVec2)> {
    let side = usize::from(SIDE);
    let scale = 4.0 * 15_f64.to_radians().tan();
    let all = (0..side * side).map(move |pixel| {
        let at = |index: usize| (2.0 * index as f64 + 1.0) / side as f64 - 1.0;
        (
            pixel,
            scale * DVec2::new(at(pixel % side), -at(pixel / side)),
        )
    });
    all.filter(|(_, at)| at.abs().max_element() < 0.98 && (at.x - at.y).abs() > 0.02)
}

/// The channels of the image at u and v, from -1 to 1, by their definition; `None` near a border between texels.
fn looked_up(image: &Image, at: DVec2, bilinear: bool) -> Option<DVec3> {
    let texel = |x: f64, y: f64| {
        let [x, y] = [x, y].map(|it| it.rem_euclid(8.0) as usize);
        let [r, g, b, _] = image.pixels()[8 * y + x];
        DVec3::from_array([r, g, b].map(|it| f64::from(it) / 127.5 - 1.0))
    };
    let place = 8.0 * at;
    if !bilinear {
        let to_border = (place - place.round()).abs().min_element();
        return (to_border > 0.02).then(|| texel(place.x.floor(), place.y.floor()));
    }
    let place = place - 0.5;
    let (first, part) = (place.floor(), place - place.floor());
    let row = |y: f64| texel(first.x, y).lerp(texel(first.x + 1.0, y), part.x);
    Some(row(first.y).lerp(row(first.y + 1.0), part.y))
}

/// The normal at a place of the square: the image's, whose axes are those in which u grows and v falls.
fn expected(lies: Lies, at: DVec2, scale: f64, bilinear: bool) -> Option<DVec3> {
    let image = bumps();
    let texel = looked_up(&image, lies.0.transform_point2((at + 1.0) / 2.0), bilinear)?;
    let inverse = lies.0.matrix2.inverse();
    let right = inverse.x_axis.normalize().extend(0.0);
    // At right angles to it, to the side on which v falls.
    let up = DVec3::Z.cross(right);
    let up = if up.truncate().dot(inverse.y_axis) < 0.0 {
        up
    } else {
        -up
    };
    let normal = scale * texel.x * right + scale * texel.y * up + texel.z * DVec3::Z;
    Some(normal.normalize())
}

const TO_LIGHT: DVec3 = DVec3::new(0.48, 0.6, 0.64);

#[test]
fn surfaces_are_lit_as_if_they_had_the_normals_of_the_image() {
    for lies in layouts() {
        for (scale, bilinear) in [(1.0, true), (1.0, false), (0.25, true), (3.0, true)] {
            let blob = blob_of(&square(lies, scale, bilinear, TO_LIGHT));
            let scene = blob.scene().expect("valid");
            let required = Effects::NORMAL_MAP.with(Effects::SHADOW);
            assert_eq!(scene.effects(), required);
            for format in Format::ALL {
                let found = red(&blob, format, Structure::DualSplit);
                let mut compared = 0;
                for (pixel, at) in places() {
                    let Some(normal) = expected(lies, at, scale, bilinear) else {
                        continue;
                    };
                    compared += 1;
                    let cosine = normal.dot(TO_LIGHT).max(0.0);
                    // Weights of texels have 8 bits.
                    let off = (found[pixel] - cosine).abs();
                    assert!(
                        off < 9e-3 * scale.max(1.0),
                        "{format:?}, {scale}, {bilinear}, {at}: {} for {cosine}",
                        found[pixel]
                    );
                }
                assert!(compared > 900, "{compared}");
            }
        }
    }
}

/// A flat image, and one without a scale, change only roundings.
#[test]
fn flat_normals_are_those_of_the_mesh() {
    let plain = |smooth: bool| {
        let mut scene = square(layouts()[4], 1.0, true, TO_LIGHT);
        scene.materials[0].normal_map = None;
        if smooth {
            make_smooth(&mut scene);
        }
        scene
    };
    for smooth in [false, true] {
        let expected = blob_of(&plain(smooth));
        let mut flat = square(layouts()[4], 0.0, true, TO_LIGHT);
        if smooth {
            make_smooth(&mut flat);
        }
        let flat = blob_of(&flat);
        for format in Format::ALL {
            let [expected, found] =
                [&expected, &flat].map(|it| red(it, format, Structure::DualSplit));
            let off = expected.iter().zip(&found).map(|(a, b)| (a - b).abs());
            let most = off.fold(0.0, f64::max);
            assert!(most < 2e-6, "{format:?}, smooth {smooth}: {most}");
        }
    }
}

/// Gives the corners normals that lean outwards.
fn make_smooth(scene: &mut scene::Scene) {
    scene.objects[0].normals = Normals {
        vectors: CORNERS
            .map(|[x, y]| DVec3::new(0.4 * x, 0.4 * y, 1.0).normalize())
            .to_vec(),
        triangles: TRIANGLES.to_vec(),
        changes: Vec::new(),
    };
}

/// The back shows the same bumps from behind.
#[test]
fn bumps_of_the_back_are_turned_around() {
    for lies in layouts() {
        let mut scene = square(lies, 1.0, true, TO_LIGHT);
        let front = red(&blob_of(&scene), Format::F64, Structure::List);
        // Seen from the other side, and lit from the opposite direction: the picture is mirrored.
        scene.camera.as_mut().expect("a camera").eye.z = -4.0;
        let turned = -TO_LIGHT;
        scene.lights = vec![Light::Directional {
            direction: -turned,
            color: [1.0; 3],
        }];
        let back = red(&blob_of(&scene), Format::F64, Structure::List);
        let side = usize::from(SIDE);
        for (pixel, _) in places() {
            let mirrored = pixel - pixel % side + side - 1 - pixel % side;
            let off = (front[pixel] - back[mirrored]).abs();
            assert!(off < 2e-3, "{pixel}: {off}");
        }
    }
}

#[test]
fn structures_show_the_same_bumps_to_the_bit() {
    let mut scene = square(layouts()[1], 1.0, true, TO_LIGHT);
    make_smooth(&mut scene);
    let blob = blob_of(&scene);
    for format in Format::ALL {
        let expected = red(&blob, format, Structure::List);
        for structure in [Structure::DualSplit, Structure::Wide, Structure::Grid] {
            assert!(
                red(&blob, format, structure) == expected,
                "{format:?} {structure:?}"
            );
        }
    }
}

#[test]
fn parts_have_the_bumps_of_their_copies() {
    let plain = square(layouts()[4], 1.0, true, TO_LIGHT);
    let placed = scene::Scene {
        objects: Vec::new(),
        parts: vec![Part {
            name: String::from("square"),
            objects: plain.objects.clone(),
            place: SourceSpan::default(),
        }],
        instances: vec![Instance {
            joint: None,
            name: String::from("one"),
            part: 0,
            placement: Placement {
                rotation: DQuat::from_euler(glam::EulerRot::XYZ, 0.3, -0.2, 0.7),
                translation: DVec3::new(0.1, 0.0, -0.2),
                scale: 0.8,
            },
            place: SourceSpan::default(),
        }],
        ..plain
    };
    let copied = blob_of(&placed.flattened().expect("copies"));
    let kept = blob_of(&placed);
    for format in Format::ALL {
        let [kept, copied] = [&kept, &copied].map(|it| red(it, format, Structure::DualSplit));
        let off = kept
            .iter()
            .zip(&copied)
            .filter(|(a, b)| (*a - *b).abs() > 5e-3);
        // Some at the silhouette and at the diagonal.
        let off = off.count();
        assert!(off < 60, "{format:?}: {off}");
        assert!(kept.iter().filter(|it| **it > 0.3).count() > 400);
    }
}

/// Light from behind does not come through, however the normals lean. With smooth normals some comes around the edge.
#[test]
fn light_behind_a_triangle_does_not_reach_its_front() {
    for (smooth, shadows, to_light, until) in [
        (false, true, [0.9, 0.3, -0.1], 1.1),
        (false, false, [0.9, 0.3, -0.1], 1.1),
        (true, true, [0.5, 0.2, -0.85], 0.5),
        (true, false, [0.9, 0.3, -0.1], 1.1),
    ] {
        let to_light = DVec3::from_array(to_light).normalize();
        let mut scene = square(layouts()[0], 16.0, true, to_light);
        scene.render.shadows = shadows;
        if smooth {
            make_smooth(&mut scene);
        }
        let blob = blob_of(&scene);
        for format in Format::ALL {
            let found = red(&blob, format, Structure::DualSplit);
            let inside = places().filter(|(_, at)| at.abs().max_element() < until);
            for (pixel, at) in inside {
                let lit = found[pixel];
                let what = format!("{format:?}, smooth {smooth}, shadows {shadows}, {at}");
                assert!(lit == 0.0, "{what}: {lit}");
            }
        }
    }
}

/// A ray off a bumpy mirror shows objects before the mirror, and never those behind it.
#[test]
fn mirrored_rays_stay_before_the_surface() {
    for smooth in [false, true] {
        let mut scene = square(layouts()[2], 4.0, true, TO_LIGHT);
        if smooth {
            make_smooth(&mut scene);
        }
        (scene.lights, scene.background) = (Vec::new(), Some([1.0; 3]));
        scene.ambient = [1e-9; 3];
        scene.materials[0].diffuse = Diffuse::Plain([0.0; 3]);
        scene.materials[0].mirror = [1.0; 3];
        // Black, and so close behind that every ray that went through would meet it.
        let behind = Shape::Mesh {
            vertices: CORNERS.map(|[x, y]| DVec3::new(x, y, -0.001)).to_vec(),
            triangles: TRIANGLES.to_vec(),
        };
        let mut behind = scenes::of([behind]);
        behind.objects[0].material = 1;
        scene.objects.extend(behind.objects);
        scene.materials.push(Material {
            diffuse: Diffuse::Plain([0.0; 3]),
            ..Material::default()
        });
        let blob = blob_of(&scene);
        for format in Format::ALL {
            let found = red(&blob, format, Structure::DualSplit);
            let dark = found.iter().filter(|it| **it < 0.99).count();
            assert_eq!(dark, 0, "{format:?}, smooth {smooth}");
        }
    }
}

/// If the image is constant along a line there are no axes, and the mesh is shaded as without it.
#[test]
fn triangles_whose_coordinates_have_no_area_are_plain() {
    let mut scene = square(layouts()[0], 1.0, true, TO_LIGHT);
    for coordinates in &mut scene.objects[0].attributes.coordinates {
        coordinates.y = 0.5;
    }
    let found = red(&blob_of(&scene), Format::F32, Structure::DualSplit);
    for (pixel, _) in places() {
        assert!((found[pixel] - TO_LIGHT.z).abs() < 1e-3);
    }
}

#[test]
fn what_has_no_normal_map_pays_for_none() {
    let mut scene = square(layouts()[0], 1.0, true, TO_LIGHT);
    scene.materials[0].texture = Some(Texture::of(bumps().into()));
    let with = blob_of(&scene);
    scene.materials[0].normal_map = None;
    let without = blob_of(&scene);
    let figures = |blob: &Blob| {
        let scene: Scene<'_> = blob.scene().expect("valid");
        (scene.textures().len(), scene.effects())
    };
    // The image of colors is another one than that of normals.
    assert_eq!(figures(&with).0, 2);
    let plain = Effects::SHADOW.with(Effects::TEXTURE);
    assert_eq!(figures(&without), (1, plain));
    assert_eq!(figures(&with).1, plain.with(Effects::NORMAL_MAP));
}

/// A white surface under a white light has the cosine between both.
#[test]
fn normals_of_pixels_are_those_that_light_meets() {
    let to_light = DVec3::new(0.2, -0.1, 1.0).normalize();
    for lies in layouts() {
        let blob = blob_of(&square(lies, 1.0, true, to_light));
        let scene = blob.scene().expect("valid");
        for format in Format::ALL {
            let job = job(&scene, format, Structure::DualSplit);
            let values = render_aovs(&scene, &job, &[Aov::Normal]).expect("pixels");
            let [Values::Vectors(normals)] = &values[..] else {
                panic!("normals are vectors");
            };
            let radiance = red(&blob, format, Structure::DualSplit);
            let mut most = 0.0_f64;
            for (pixel, _) in places() {
                let normal = DVec3::from(normals[pixel].map(f64::from));
                let off = normal.dot(to_light).max(0.0) - radiance[pixel];
                assert!(off.abs() < 1e-3, "{format:?}, pixel {pixel}: {off}");
                most = most.max(normal.x.abs());
            }
            assert!(most > 0.3, "the normals are those of the square: {most}");
        }
    }
}
