use super::*;
use crate::scene::tests::samples::{self, load};
use crate::scene::{Imported, Shape};
use crate::shape::{Cone, Sphere};
use std::collections::BTreeMap;

fn read(text: &str) -> Result<Imported, SceneError> {
    samples::read("t.nff", text)
}

fn fault(text: &str) -> String {
    read(text).unwrap_err().to_string()
}

const VIEW: &str = "v\nfrom 0 0 9\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 64 48\n";

#[test]
fn patches_have_their_normals() {
    let patch = "pp 3\n0 0 0 0 0 1\n1 0 0 .5 0 1\n0 1 0 0 0 -1\np 3\n0 0 0\n1 0 0\n0 1 0\n";
    let scene = read(&format!("{VIEW}f 1 1 1 1 0 0 0 0\n{patch}"))
        .unwrap()
        .scene;
    let [smooth, flat] = [0, 1].map(|number: usize| &scene.objects[number].normals);
    assert_eq!(smooth.triangles, [[0, 1, 2]]);
    assert_eq!(smooth.vectors[2], -DVec3::Z);
    assert!(flat.is_flat());
}

#[test]
fn patches_with_a_normal_of_length_0_are_flat() {
    let patch = "pp 3\n0 0 0 0 0 1\n1 0 0 0 0 0\n0 1 0 .5 0 1\n";
    let imported = read(&format!("{VIEW}f 1 1 1 1 0 0 0 0\n{patch}")).unwrap();
    assert!(imported.scene.objects[0].normals.is_flat());
    let [warning] = &imported.warnings[..] else {
        panic!("{:?}", imported.warnings);
    };
    assert!(warning.contains("t.nff:11: a normal is 0 0 0"), "{warning}");
}

#[test]
fn everything_the_format_has() {
    let text = format!(
        "b .1 .2 .3 # sky\n{VIEW}l 1 2 3\nl 4 5 6\nl 4 5 6 1 .5 0\nf 1 .5 0 .8 .25 20 .5 1.5\ns 1 2 3 -4\n\
         c\n0 0 0 2\n0 0 5 1\np 3\n0 0 0\n1 0 0\n0 1 0\npp 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n\
         f 1 1 1 1 0 0 0 0\ns 0 0 0 1\nf 1 .5 0 .8 .25 20 .5 1.5\ns 0 0 0 1\n"
    );
    let Imported {
        scene, warnings, ..
    } = read(&text).unwrap();
    assert_eq!(warnings, [] as [&str; 0]);
    assert!(scene.display_values);
    assert_eq!(scene.background, Some([0.1, 0.2, 0.3]));
    let camera = scene.camera.unwrap();
    assert_eq!(
        (camera.eye, camera.fov_degrees),
        (DVec3::new(0.0, 0.0, 9.0), 40.0)
    );
    assert_eq!((scene.render.width, scene.render.height), (64, 48));
    let colors: Vec<Color> = scene
        .lights
        .iter()
        .map(|light| match light {
            Light::Point { color, .. } | Light::Directional { color, .. } => *color,
        })
        .collect();
    assert_eq!(
        colors,
        [
            [1.0 / 3.0_f64.sqrt(); 3],
            [1.0 / 3.0_f64.sqrt(); 3],
            [1.0, 0.5, 0.0]
        ]
    );
    assert_eq!(scene.materials.len(), 2);
    let glass = &scene.materials[0];
    assert_eq!(glass.diffuse, Diffuse::Plain([0.4, 0.2, 0.0]));
    assert_eq!(
        (glass.highlight, glass.mirror, glass.transmit),
        ([0.25; 3], [0.25; 3], [0.5, 0.25, 0.0])
    );
    assert_eq!((glass.shininess, glass.ior), (80, 1.5));
    let names: Vec<_> = scene
        .objects
        .iter()
        .map(|o| (o.name.as_str(), o.material, o.place.line))
        .collect();
    assert_eq!(
        names,
        [
            ("sphere 1", 0, 13),
            ("cone 1", 0, 14),
            ("polygon 1", 0, 17),
            ("polygon 2", 0, 21),
            ("sphere 2", 1, 26),
            ("sphere 3", 0, 28)
        ]
    );
    assert_eq!(
        scene.objects[0].shape,
        Shape::Sphere(Sphere {
            center: DVec3::new(1.0, 2.0, 3.0),
            radius: 4.0
        })
    );
}

#[test]
fn faults_name_line_and_cause() {
    assert_eq!(fault(""), "t.nff: the file has no objects");
    assert_eq!(fault("s 1 2 3\n"), "t.nff:1: the line has 3 of 4 numbers");
    assert_eq!(
        fault("\n\ns 1 2 x 3\n"),
        "t.nff:3: a number of `s x y z radius` is \"x\", which is not a number"
    );
    assert_eq!(
        fault("s 1 2 inf 3\n"),
        "t.nff:1: a number of `s x y z radius` is \"inf\", which is not a finite number"
    );
    assert_eq!(fault("s 1 2 3 0\n"), "t.nff:1: the radius of a sphere is 0");
    assert_eq!(
        fault("p 4000000000\n0 0 0\n1 0 0\n"),
        "t.nff:1: the file ends after 2 of the 4000000000 vertices of this polygon"
    );
    assert_eq!(
        fault("p -3\n"),
        "t.nff:1: the vertex count of a polygon is \"-3\""
    );
    assert_eq!(
        fault("p\n"),
        "t.nff:1: the vertex count of a polygon is \"\""
    );
    assert_eq!(
        fault("p 2\n0 0 0\n1 0 0"),
        "t.nff:1: a polygon of 2 vertices has no surface"
    );
    assert_eq!(
        fault("p 3\n0 0 0\n1 0 0\ns 0 0 0 1\n"),
        "t.nff:4: \"s\" stands where vertex 3 of 3 is due"
    );
    assert_eq!(
        fault("p 3\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"),
        "t.nff:5: the number 0 belongs to no entity"
    );
    assert_eq!(
        fault("c 0 0 0 1 0 0 1\n"),
        "t.nff:1: the line has 7 of 8 numbers"
    );
    assert_eq!(
        fault("c\n0 0 0 1\n"),
        "t.nff:1: the file ends before the apex of this cone"
    );
    assert_eq!(
        fault("c\n0 0 0 1\n0 0 0 2\n"),
        "t.nff:1: the base and the apex of a cone are the same point"
    );
    assert_eq!(
        fault("c\n0 0 0 1\n0 0 1 -2\n"),
        "t.nff:1: one radius of a cone is negative and one is not"
    );
    assert_eq!(
        fault("l 1 2 3 4\n"),
        "t.nff:1: a light has a position (3 numbers) or a position and a color (6), not 4 numbers"
    );
    assert_eq!(
        fault("f 1 1 1 1 0\n"),
        "t.nff:1: the line has 5 of 8 numbers"
    );
    assert_eq!(
        fault("f 1 1 1 1 0 1 .5\n"),
        "t.nff:1: a transparent material has no index of refraction"
    );
    assert_eq!(
        fault("v\nfrom 0 0 0\nat 0 0 1\nup 0 1 0\n"),
        "t.nff:1: the view has no line `angle`"
    );
    assert_eq!(
        fault(&VIEW.replace("up 0 1 0", "up 0 0 -1")),
        "t.nff:1: the up vector of the view is zero or parallel to the direction of view"
    );
    assert_eq!(
        fault(&VIEW.replace("40", "180")),
        "t.nff:5: the angle of view is 180 degrees"
    );
    assert_eq!(
        fault(&VIEW.replace("64 48", "64 4000000000")),
        "t.nff:7: the resolution 4000000000 is no number of pixels"
    );
    assert_eq!(
        fault(&VIEW.replace("64 48", "65535 1")),
        "t.nff:7: the picture is more than 64 times as wide as high"
    );
}

#[test]
fn dialects_are_read_with_warnings() {
    let text = "s 5 5 5 3\nf 0 0 1 0 1 1\ns 1 2 3 4 8 8\nf 1 1 1 .5 .5 45 0 1 earth.jpg\ns 1 2 3 4\ntess 0\n";
    let Imported {
        scene, warnings, ..
    } = read(text).unwrap();
    assert_eq!(scene.objects.len(), 3);
    assert_eq!(
        warnings,
        [
            "t.nff:1: an object before the first `f` line has the default material",
            "t.nff:2: a material of 6 numbers instead of 8 is read as opaque",
            "t.nff:3: what follows the 4 numbers of `s x y z radius` is ignored",
            "t.nff:4: what follows the 8 numbers of `f r g b Kd Ks Shine T ior` is ignored",
            "t.nff:6: the entity \"tess\" is unknown and ignored",
        ]
    );
}

#[test]
fn values_beyond_a_blob_are_limited_with_a_warning() {
    let text = "b 1 1 3000\nl 0 5 0 5000 1 2047\nl 0 5 0\nf 1 1 1 1.5 0 0 0 1\ns 0 0 0 1\n\
                f 4 .5 0 .5 1.25 9 2 1\ns 3 0 0 1\nf 1 1 1 .5 .5 300 0 1\ns 6 0 0 1\n\
                f 2 1 1 .5 0 300 0 1\ns 9 0 0 1\n";
    let Imported {
        scene, warnings, ..
    } = read(text).unwrap();
    assert_eq!(
        warnings,
        [
            "t.nff:1: the background is limited to the range 0 to 2047",
            "t.nff:2: the color of a light is limited to the range 0 to 2047",
            "t.nff:4: the color of a material times Kd (1 - T) is limited to the range 0 to 1",
            "t.nff:6: Ks is limited to the range 0 to 1",
            "t.nff:6: the color of a material times T is limited to the range 0 to 1",
            "t.nff:8: Shine is limited to the range 0 to 256",
        ]
    );
    assert_eq!(scene.background, Some([1.0, 1.0, 2047.0]));
    let Light::Point { color, .. } = scene.lights[0] else {
        panic!()
    };
    assert_eq!(color, [2047.0, 1.0, 2047.0]);
    let [white, glass, shiny, within] = &scene.materials[..] else {
        panic!("{:?}", scene.materials);
    };
    assert_eq!(white.diffuse, Diffuse::Plain([1.0; 3]));
    assert_eq!((glass.mirror, glass.transmit), ([1.0; 3], [1.0, 1.0, 0.0]));
    assert_eq!(shiny.shininess, 1024);
    assert_eq!(within.diffuse, Diffuse::Plain([1.0, 0.5, 0.5]));
}

#[test]
fn bytes_that_are_not_utf8_are_harmless_in_comments_alone() {
    let read = |bytes: &[u8]| samples::read("t.nff", bytes);
    assert!(read(b"# caf\xe9\ns 0 0 0 1\n").is_ok());
    let error = read(b"# caf\xe9\ns 0 0 \xe9 1\n").unwrap_err();
    assert_eq!(error.line, Some(2));
}

/// Counts objects by kind as `s`, `c` and `p`, and lights as `l`.
fn counts(scene: &Scene) -> BTreeMap<char, usize> {
    let mut counts = BTreeMap::from([('l', scene.lights.len())]);
    for object in &scene.objects {
        let kind = match object.shape {
            Shape::Sphere(Sphere { .. }) => 's',
            Shape::Cone(Cone { .. }) => 'c',
            _ => 'p',
        };
        *counts.entry(kind).or_default() += 1;
    }
    counts
}

/// Twice the area vector of a closed outline, summed around its first vertex.
fn outline(vertices: &[DVec3]) -> DVec3 {
    vertices.windows(2).fold(DVec3::ZERO, |sum, pair| {
        sum + (pair[0] - vertices[0]).cross(pair[1] - vertices[0])
    })
}

#[test]
fn standard_procedural_databases_keep_their_primitives() {
    let facts: [(&str, &[(char, usize)]); 9] = [
        ("balls.nff", &[('s', 7381), ('p', 1), ('l', 3)]),
        ("balls_s2.nff", &[('s', 91), ('p', 1), ('l', 3)]),
        ("gears.nff", &[('p', 9345), ('l', 5)]),
        ("jacks.nff", &[('s', 6), ('c', 3), ('l', 1)]),
        ("mount.nff", &[('p', 8192), ('s', 4), ('l', 1)]),
        ("sample.nff", &[('c', 1), ('p', 880), ('l', 1)]),
        ("sombrero.nff", &[('p', 1922), ('l', 1)]),
        ("teapot.nff", &[('p', 9264), ('l', 2)]),
        ("tetra.nff", &[('p', 4096), ('l', 1)]),
    ];
    for (name, expected) in facts {
        let Some(path) = samples::find(&format!("spd/{name}")) else {
            continue;
        };
        let Imported {
            scene, warnings, ..
        } = load(&path).unwrap();
        let patches = ["sample.nff", "teapot.nff"].contains(&name);
        assert_eq!(warnings, [] as [&str; 0], "{name}");
        let is_smooth = scene.objects.iter().any(|it| !it.normals.is_flat());
        assert_eq!(is_smooth, patches, "{name}");
        assert_eq!(counts(&scene), expected.iter().copied().collect(), "{name}");
        assert!(scene.camera.is_some());
        for object in &scene.objects {
            let Shape::Mesh {
                vertices,
                triangles,
            } = &object.shape
            else {
                continue;
            };
            // The polygons are flat within the rounding of their six digits, so all area vectors
            // point one way and their lengths add up.
            let whole = outline(vertices).length();
            let sum: f64 = triangles
                .iter()
                .map(|t| outline(&t.map(|i| vertices[i as usize])).length())
                .sum();
            assert!(
                (sum - whole).abs() <= 1e-4 * whole,
                "{name} {}: {sum} for {whole}",
                object.name
            );
        }
    }
}

/// The mean of each channel in codes of 255, in the pictures of the databases' author. Ours has
/// another pattern of samples and Fresnel's reflection.
#[test]
fn pictures_are_as_bright_as_the_databases_own() {
    for name in ["balls", "gears", "mount", "teapot", "tetra"] {
        let paths = ["nff", "png"].map(|end| samples::find(&format!("spd/{name}.{end}")));
        let [Some(scene), Some(picture)] = paths else {
            continue;
        };
        let file = std::io::BufReader::new(std::fs::File::open(picture).unwrap());
        let mut reader = png::Decoder::new(file).read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut bytes).unwrap();
        assert_eq!(
            (info.color_type, info.bit_depth),
            (png::ColorType::Rgb, png::BitDepth::Eight)
        );
        let expected = means(&bytes);

        let mut scene = load(&scene).unwrap().scene;
        (scene.render.width, scene.render.height) = (256, 256);
        let options = crate::compile::Options {
            structures: vec![gridel_core::Structure::Wide],
            ..Default::default()
        };
        let blob = crate::compile::compile(&scene, &options).unwrap().blob;
        let scene = blob.scene().unwrap();
        let job = crate::render::Job {
            format: gridel_core::Format::F32,
            structure: gridel_core::Structure::Wide,
            settings: gridel_core::Settings::of(&scene),
            rows: 0..256,
            count: false,
        };
        let picture = crate::render::render(&scene, &job, &|| ()).unwrap();
        let mut encoded = Vec::new();
        let metadata = crate::picture::RenderMetadata::of(&scene, &job);
        crate::picture::PictureFormat::Ppm
            .write(&mut encoded, &picture, &metadata)
            .unwrap();
        let found = means(&encoded[encoded.len() - 3 * 256 * 256..]);
        println!("{name}: {found:.1?} for {expected:.1?}");
        for (found, expected) in found.into_iter().zip(expected) {
            assert!(
                (found - expected).abs() <= 0.05 * expected,
                "{name}: {found} for {expected}"
            );
        }
    }
}

fn means(pixels: &[u8]) -> [f64; 3] {
    std::array::from_fn(|channel| {
        let codes = pixels.iter().skip(channel).step_by(3);
        codes.map(|&code| f64::from(code)).sum::<f64>() / (pixels.len() / 3) as f64
    })
}

/// A gray of 0.5 is shown as 0.5, also where lights add up to it.
#[test]
fn display_values_are_shown_as_they_are() {
    let text = format!(
        "b .5 .5 .5\n{VIEW}l 0 0 1e4\nf 1 1 1 .5 0 1 0 0\np 4\n-9 -1 0\n0 -1 0\n0 1 0\n-9 1 0\n"
    );
    let mut scene = read(&text).unwrap().scene;
    assert_eq!(scene.ambient, [1.0; 3]);
    scene.ambient = [0.0; 3];
    let blob = crate::compile::compile(&scene, &Default::default())
        .unwrap()
        .blob;
    let scene = blob.scene().unwrap();
    for format in [
        gridel_core::Format::Fixed,
        gridel_core::Format::F32,
        gridel_core::Format::F64,
    ] {
        let job = crate::render::Job {
            format,
            structure: gridel_core::Structure::List,
            settings: gridel_core::Settings::of(&scene),
            rows: 24..25,
            count: false,
        };
        let picture = crate::render::render(&scene, &job, &|| ()).unwrap();
        let mut encoded = Vec::new();
        let metadata = crate::picture::RenderMetadata::of(&scene, &job);
        let ppm = crate::picture::PictureFormat::Ppm;
        ppm.write(&mut encoded, &picture, &metadata).unwrap();
        let row = &encoded[encoded.len() - 3 * 64..];
        for code in [row[3 * 20], row[3 * 60]] {
            assert!((127..=128).contains(&code), "{}: {row:?}", format.name());
        }
    }
}

#[test]
fn patches_that_lack_a_normal_are_warned_of() {
    let text = "f 1 1 1 1 0 1 0 1\npp 3\n0 0 0 0 0 1\n1 0 0\n0 1 0 0 0 1\n";
    let imported = read(text).unwrap();
    let sentence = "a vertex of `pp` has no normal; its polygon is shaded flat";
    let warned = imported.warnings.iter().any(|it| it.ends_with(sentence));
    assert!(warned, "{:?}", imported.warnings);
}
