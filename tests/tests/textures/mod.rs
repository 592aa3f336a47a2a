//! Colors of vertices and textures: every number format and structure shows the values that these tests compute from
//! the definition.

mod alpha;

use glam::{DQuat, DVec2, DVec3};
use gridel_core::{Effects, Format, List, NoCount, Number, Scene, Settings, Structure};
use gridel_host::blob::Blob;
use gridel_host::certify::{World, enclose};
use gridel_host::compile::{Options, compile};
use gridel_host::render::{Aov, Job, Values, render, render_aovs, render_linear};
use gridel_host::scene::{
    self, Alpha, Attributes, Camera, Diffuse, Image, Instance, Light, Material, Part, Placement,
    Shape, SourceSpan, Texture, Wrap,
};
use gridel_host::shape::Disc;
use gridel_host::srgb::linear_of_srgb;
use gridel_tests::query::{UnitRay, closest, held, point_of};
use gridel_tests::random::Random;
use gridel_tests::{every_format, scenes};

/// The corners of the square, and their texture coordinates, which reach beyond the image.
const SQUARE: [[f64; 4]; 4] = [
    [-1.0, -1.0, -0.6, 1.7],
    [1.0, -1.0, 1.8, 1.9],
    [1.0, 1.0, 1.6, -0.8],
    [-1.0, 1.0, -0.7, -0.5],
];

/// Linear colors of the corners.
const COLORS: [[f64; 3]; 4] = [
    [1.0, 0.0, 0.25],
    [0.0, 1.0, 0.5],
    [1.0, 1.0, 1.0],
    [0.04, 0.16, 0.0],
];

const TRIANGLES: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

const PICTURE: [u16; 2] = [90, 70];

/// Random colors, whose numbers of columns and rows are no powers of two.
fn image() -> Image {
    let mut random = Random(19);
    let mut channel = || random.below(256) as u8;
    let pixels = (0..35).map(|_| [channel(), channel(), channel(), 255]);
    Image::new("random", 7, 5, pixels.collect()).expect("as many pixels")
}

/// A square under white light from everywhere, which fills the picture from top to bottom.
fn square() -> scene::Scene {
    let mut scene = scenes::of([Shape::Mesh {
        vertices: SQUARE.map(|[x, y, ..]| DVec3::new(x, y, 0.0)).to_vec(),
        triangles: TRIANGLES.to_vec(),
    }]);
    scene.materials[0].diffuse = Diffuse::Plain([1.0; 3]);
    scene.ambient = [1.0; 3];
    scene.camera = Some(Camera {
        eye: DVec3::Z * 4.0,
        target: DVec3::ZERO,
        up: DVec3::Y,
        fov_degrees: 2.0 * 0.25_f64.atan().to_degrees(),
    });
    scene
}

fn coordinates() -> Attributes {
    Attributes {
        colors: Vec::new(),
        coordinates: SQUARE.map(|[.., u, v]| DVec2::new(u, v)).to_vec(),
        triangles: TRIANGLES.to_vec(),
        displacements: Vec::new(),
    }
}

fn textured(wrap: Wrap, bilinear: bool) -> scene::Scene {
    let mut scene = square();
    scene.objects[0].attributes = coordinates();
    scene.materials[0].texture = Some(Texture {
        wrap: [wrap; 2],
        bilinear,
        ..Texture::of(image().into())
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

fn settings(scene: &Scene<'_>) -> Settings {
    Settings {
        width: PICTURE[0],
        height: PICTURE[1],
        samples: 1,
        ..Settings::of(scene)
    }
}

fn albedo(scene: &Scene<'_>, format: Format) -> Vec<[f32; 3]> {
    let job = Job::whole(format, Structure::DualSplit, settings(scene));
    let values = render_aovs(scene, &job, &[Aov::Albedo]).expect("pixels");
    match &values[..] {
        [Values::Vectors(colors)] => colors.clone(),
        _ => panic!("albedo is colors"),
    }
}

/// Returns the places of the square that pixels show, except at its border.
fn places() -> impl Iterator<Item = (usize, [f64; 2])> {
    let [width, height] = PICTURE.map(f64::from);
    let count = usize::from(PICTURE[0]) * usize::from(PICTURE[1]);
    let place = move |pixel: usize| {
        let (column, row) = (pixel as f64 % width, (pixel as f64 / width).floor());
        let right = (2.0 * column.floor() + 1.0 - width) / height;
        [right, (height - 2.0 * row - 1.0) / height]
    };
    let all = (0..count).map(move |pixel| (pixel, place(pixel)));
    all.filter(|(_, [x, y])| x.abs() < 0.98 && y.abs() < 0.98)
}

/// Returns the square's value at a place by interpolation between the corners of its two triangles.
fn interpolated<const N: usize>([x, y]: [f64; 2], corners: [[f64; N]; 4]) -> [f64; N] {
    let (x, y) = (0.5 * (x + 1.0), 0.5 * (y + 1.0));
    std::array::from_fn(|k| {
        let [a, b, c, d] = corners.map(|corner| corner[k]);
        if x >= y {
            a + (b - a) * (x - y) + (c - a) * y
        } else {
            a + (c - a) * x + (d - a) * (y - x)
        }
    })
}

fn wrapped(texel: f64, count: u32, wrap: Wrap) -> u32 {
    let (texel, count) = (texel as i64, i64::from(count));
    let inside = match wrap {
        Wrap::Repeat => texel.rem_euclid(count),
        Wrap::Mirror => {
            let place = texel.rem_euclid(2 * count);
            place.min(2 * count - 1 - place)
        }
        Wrap::Clamp => texel.clamp(0, count - 1),
    };
    inside as u32
}

/// The linear color of the image at coordinates; for the nearest texel, `None` near a border between two.
fn looked_up(image: &Image, [u, v]: [f64; 2], wrap: Wrap, bilinear: bool) -> Option<[f64; 3]> {
    let [width, height] = image.size();
    let texel = |x: f64, y: f64| {
        let (x, y) = (wrapped(x, width, wrap), wrapped(y, height, wrap));
        let [r, g, b, _] = image.pixels()[(y * width + x) as usize];
        [r, g, b].map(|it| linear_of_srgb(f64::from(it) / 255.0))
    };
    let (x, y) = (u * f64::from(width), v * f64::from(height));
    if !bilinear {
        let is_near = |it: f64| (it - it.round()).abs() < 0.01;
        return (!is_near(x) && !is_near(y)).then(|| texel(x.floor(), y.floor()));
    }
    let (x, y) = (x - 0.5, y - 0.5);
    let (left, upper) = (x.floor(), y.floor());
    let (across, down) = (x - left, y - upper);
    let [a, b] = [0.0, 1.0].map(|step| texel(left + step, upper));
    let [c, d] = [0.0, 1.0].map(|step| texel(left + step, upper + 1.0));
    Some(std::array::from_fn(|k| {
        let above = a[k] + (b[k] - a[k]) * across;
        let below = c[k] + (d[k] - c[k]) * across;
        above + (below - above) * down
    }))
}

fn assert_near(found: [f32; 3], expected: [f64; 3], tolerance: f64, what: &str) {
    let apart = found
        .iter()
        .zip(expected)
        .map(|(a, b)| (f64::from(*a) - b).abs());
    let apart = apart.fold(0.0, f64::max);
    assert!(apart <= tolerance, "{what}: {found:?}, not {expected:?}");
}

#[test]
fn textures_show_the_image_in_every_format_filter_and_wrap_mode() {
    let image = image();
    for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
        for bilinear in [false, true] {
            let blob = blob_of(&textured(wrap, bilinear));
            let scene = blob.scene().expect("valid");
            assert_eq!(scene.effects(), Effects::TEXTURE);
            for format in Format::ALL {
                let found = albedo(&scene, format);
                let mut compared = 0;
                for (pixel, place) in places() {
                    let at = interpolated(place, SQUARE.map(|[.., u, v]| [u, v]));
                    let Some(expected) = looked_up(&image, at, wrap, bilinear) else {
                        continue;
                    };
                    compared += 1;
                    let what = format!("{wrap:?}, {bilinear}, {}, {place:?}", format.name());
                    // Half a step of 8 bits as a root, and bilinear weights of 8 bits.
                    let tolerance = if bilinear { 0.014 } else { 0.0045 };
                    assert_near(found[pixel], expected, tolerance, &what);
                }
                assert!(compared > 4000, "{compared} pixels");
            }
        }
    }
}

#[test]
fn colors_of_vertices_are_interpolated_in_every_format() {
    let mut scene = square();
    scene.objects[0].attributes.colors = COLORS.to_vec();
    let blob = blob_of(&scene);
    let scene = blob.scene().expect("valid");
    assert_eq!(scene.effects(), Effects::VERTEX_COLORS);
    for format in Format::ALL {
        let found = albedo(&scene, format);
        for (pixel, place) in places() {
            let expected = interpolated(place, COLORS);
            assert_near(found[pixel], expected, 0.0045, &format!("{place:?}"));
        }
    }
}

#[test]
fn colors_and_textures_weight_the_diffuse_color_together() {
    let mut scene = textured(Wrap::Repeat, true);
    let alone = blob_of(&scene);
    scene.objects[0].attributes.colors = vec![[0.25; 3]; 4];
    scene.materials[0].diffuse = Diffuse::Plain([0.5, 1.0, 1.0]);
    let weighted = blob_of(&scene);
    let of = |blob: &Blob| albedo(&blob.scene().expect("valid"), Format::F64);
    for (found, whole) in of(&weighted).into_iter().zip(of(&alone)) {
        let [r, g, b] = whole.map(|it| 0.25 * f64::from(it));
        assert_near(found, [0.5 * r, g, b], 0.003, "weighted");
    }
}

fn coordinates_are_interpolated<N: Number>(scene: &Scene<'_>) {
    let sides = scene.bounds().0.map(|side| side.map(f64::from));
    let header = scene.header();
    let unit = f64::from(header.unit_exponent).exp2();
    let mut random = Random(7);
    let mut compared = 0;
    for _ in 0..500 {
        let [x, y, z] = sides.map(|[low, high]| low + (high - low) * random.unit());
        let ray = UnitRay::new([x, y, z.abs() + 64.0], [0.0, 0.0, -1.0]);
        let ray = ray.ready::<N>(scene).expect("a ray");
        let Some(hit) = closest::<N, List>(scene, &ray, &mut NoCount) else {
            continue;
        };
        compared += 1;
        let point = point_of(&hit);
        let place = [0, 1].map(|axis: usize| header.origin[axis] + point[axis] * unit);
        let found = hit.texture_coordinates(scene).expect("a texture");
        let expected = interpolated(place, SQUARE.map(|[.., u, v]| [u, v]));
        for (found, expected) in found.into_iter().zip(expected) {
            // Coordinates of this square are stored with 14 fraction bits.
            assert!((found - expected).abs() < 1e-4, "{found} {expected}");
        }
    }
    assert!(compared > 200, "{compared} hits");
}

#[test]
fn coordinates_of_hits_are_those_between_the_corners() {
    let blob = blob_of(&textured(Wrap::Repeat, true));
    let scene = blob.scene().expect("valid");
    every_format!(coordinates_are_interpolated(&scene));
}

#[test]
fn coordinates_of_pixels_are_an_output_of_their_own() {
    let blob = blob_of(&textured(Wrap::Repeat, true));
    let scene = blob.scene().expect("valid");
    let corners = SQUARE.map(|[.., u, v]| [u, v]);
    for format in Format::ALL {
        let job = Job::whole(format, Structure::DualSplit, settings(&scene));
        let values = render_aovs(&scene, &job, &[Aov::Uv]).expect("pixels");
        let [Values::Coordinates(found)] = &values[..] else {
            panic!("{values:?}");
        };
        for (pixel, place) in places() {
            for (found, exact) in found[pixel].iter().zip(interpolated(place, corners)) {
                let off = f64::from(*found) - exact;
                assert!(off.abs() < 1e-4, "{format:?}, pixel {pixel}: {off}");
            }
        }
        // Beside the square.
        assert_eq!(found[0], [f32::INFINITY; 2]);
    }
}

#[test]
fn structures_show_the_same_colors_to_the_bit() {
    let mut scene = textured(Wrap::Mirror, true);
    scene.objects[0].attributes.colors = COLORS.to_vec();
    let blob = blob_of(&scene);
    let scene = blob.scene().expect("valid");
    for format in Format::ALL {
        let picture = |structure| {
            let job = Job::whole(format, structure, settings(&scene));
            render(&scene, &job, &|| ()).expect("a picture").pixels
        };
        let listed = picture(Structure::List);
        for structure in held(&scene) {
            assert!(picture(structure) == listed, "{}", structure.name());
        }
    }
}

#[test]
fn parts_have_the_colors_of_their_copies() {
    let mut scene = textured(Wrap::Repeat, true);
    scene.objects[0].attributes.colors = COLORS.to_vec();
    let placement = Placement {
        rotation: DQuat::from_rotation_z(0.5),
        translation: DVec3::new(0.1, 0.2, 0.3),
        scale: 0.75,
    };
    scene.parts = vec![Part {
        name: String::from("part"),
        objects: std::mem::take(&mut scene.objects),
        place: SourceSpan::default(),
    }];
    scene.instances = vec![Instance {
        name: String::from("copy"),
        part: 0,
        joint: None,
        placement,
        place: SourceSpan::default(),
    }];
    let kept = compile(&scene, &Options::default()).expect("compiles").blob;
    let mut flat = scene.clone();
    flat.parts[0].objects[0].shape = match &scene.parts[0].objects[0].shape {
        Shape::Mesh {
            vertices,
            triangles,
        } => {
            let place =
                |it: &DVec3| placement.translation + placement.rotation * (*it * placement.scale);
            Shape::Mesh {
                vertices: vertices.iter().map(place).collect(),
                triangles: triangles.clone(),
            }
        }
        _ => panic!("the square is a mesh"),
    };
    flat.objects = flat.parts.remove(0).objects;
    flat.instances.clear();
    let flat = compile(&flat, &Options::default()).expect("compiles").blob;
    for format in Format::ALL {
        let of = |blob: &Blob| albedo(&blob.scene().expect("valid"), format);
        let pairs = of(&kept).into_iter().zip(of(&flat));
        let differ = |(a, b): &([f32; 3], [f32; 3])| (0..3).any(|k| (a[k] - b[k]).abs() > 0.01);
        // Pixels at the border may show the other side.
        let differing = pairs.filter(differ).count();
        assert!(differing < 60, "{differing} pixels in {}", format.name());
    }
}

#[test]
fn what_no_texture_uses_is_not_stored() {
    let plain = blob_of(&square());
    let mut scene = square();
    scene.objects[0].attributes = coordinates();
    assert!(blob_of(&scene).bytes() == plain.bytes());
    let mut without = textured(Wrap::Repeat, true);
    without.remove_effects(Effects::TEXTURE);
    without.materials[0].diffuse = Diffuse::Plain([1.0; 3]);
    assert!(blob_of(&without).bytes() == plain.bytes());
    // The mean of the image takes its place.
    let mut mean = textured(Wrap::Repeat, true);
    mean.remove_effects(Effects::TEXTURE);
    assert_eq!(mean.materials[0].diffuse, Diffuse::Plain(image().mean()));
}

#[test]
fn triangles_without_coordinates_show_the_plain_color() {
    let mut scene = textured(Wrap::Repeat, false);
    scene.materials[0].diffuse = Diffuse::Plain([0.5; 3]);
    scene.objects[0].attributes.triangles[1] = Attributes::NONE;
    let blob = blob_of(&scene);
    let found = albedo(&blob.scene().expect("valid"), Format::F32);
    let upper: Vec<_> = places().filter(|(_, [x, y])| y - x > 0.1).collect();
    assert!(upper.len() > 1000);
    for (pixel, _) in upper {
        assert_near(found[pixel], [0.5; 3], 0.001, "upper left triangle");
    }
}

#[test]
fn coordinates_far_from_the_image_are_exact_or_rejected() {
    let mut scene = textured(Wrap::Repeat, false);
    let near = albedo(&blob_of(&scene).scene().expect("valid"), Format::F64);
    for coordinates in &mut scene.objects[0].attributes.coordinates {
        *coordinates += DVec2::new(1020.0, -1020.0);
    }
    let far = albedo(&blob_of(&scene).scene().expect("valid"), Format::F64);
    let differing = near.iter().zip(&far).filter(|(a, b)| a != b).count();
    assert!(differing < 100, "{differing} pixels");
    scene.objects[0].attributes.coordinates[0].x = 1024.0;
    let error = compile(&scene, &Options::default()).expect_err("too far");
    assert!(error.to_string().contains("texture coordinates"), "{error}");
}

/// Materials of a part's objects are those of the scene that places it.
#[test]
fn parts_hold_objects_with_and_without_images() {
    let text = "[material.tile]\ntexture = 'tiles.png'\n[material.clay]\ndiffuse = 0.5\n\
        [[part]]\nname = 'both'\n\
        [[part.object]]\nkind = 'mesh'\nmaterial = 'tile'\nfaces = [[0, 1, 2, 3]]\n\
        vertices = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]\n\
        coordinates = [[0, 1], [1, 1], [1, 0], [0, 0]]\n\
        [[part.object]]\nkind = 'sphere'\nmaterial = 'clay'\ncenter = [0, 0, 1]\nradius = 0.5\n\
        [[instance]]\npart = 'both'\n[[instance]]\npart = 'both'\ntranslate = [3, 0, 0]\n";
    let path = scenes::fixture_folder().join("both.toml");
    let imported = scene::read(&path, text.into(), &Default::default()).expect("a scene");
    let blob = blob_of(&imported.scene);
    let scene = blob.scene().expect("valid");
    assert_eq!(scene.parts().len(), 1);
    let maps = [0, 1].map(|object| scene.material(object).expect("a material").maps);
    assert!(maps[0] != 0 && maps[1] == 0, "{maps:?}");
}

/// The exact picture of textures: the values of double precision lie in the intervals, except for its own rounding.
#[test]
fn textured_pixels_are_certified() {
    for (wrap, bilinear) in [
        (Wrap::Repeat, true),
        (Wrap::Mirror, false),
        (Wrap::Clamp, true),
    ] {
        let mut scene = textured(wrap, bilinear);
        scene.objects[0].attributes.colors = COLORS.to_vec();
        let blob = blob_of(&scene);
        let scene = blob.scene().expect("valid");
        let world = World::of(&scene).expect("a scene that is known");
        let settings = settings(&scene);
        let job = Job::whole(Format::F64, Structure::DualSplit, settings);
        let picture = render_linear(&scene, &job, &|| ())
            .expect("a picture")
            .pixels;
        let (mut open, mut outside) = (0, 0);
        for (pixel, found) in picture.iter().enumerate() {
            let place = [pixel % 90, pixel / 90].map(|it| it as u16);
            let enclosed = enclose(&world, &settings, place, 1);
            open += usize::from(enclosed.width() > 1e-6);
            let pairs = found.iter().map(|it| f64::from(*it)).zip(enclosed.linear);
            let is_outside =
                |(found, [low, high]): (f64, [f64; 2])| found < low - 1e-6 || found > high + 1e-6;
            outside += usize::from(pairs.into_iter().any(is_outside));
        }
        // A texel or a weight that is another by rounding is rare.
        assert!(outside < 10, "{outside} pixels outside of their intervals");
        // Pixels on the edge between both triangles.
        assert!(open < 200, "{open} open pixels");
    }
}

/// A real file with a texture: pixels of several colors, the same in all formats except for rounding.
#[test]
fn real_box_shows_its_texture() {
    let Some(path) = scenes::real("meshes/BoxTextured.glb") else {
        return;
    };
    let imported = scene::load(&path, &Default::default()).expect("a scene");
    assert!(imported.scene.materials[0].texture.is_some());
    let blob = blob_of(&imported.scene);
    let scene = blob.scene().expect("valid");
    assert!(scene.effects().contains(Effects::TEXTURE));
    let [fixed, single, double] = Format::ALL.map(|format| albedo(&scene, format));
    for other in [fixed, single] {
        let pairs = other.iter().zip(&double);
        let differing = pairs.filter(|(a, b)| (0..3).any(|k| (a[k] - b[k]).abs() > 0.02));
        assert!(differing.count() < 30);
    }
    let mut colors: Vec<_> = double
        .iter()
        .map(|it| it.map(|it| (it * 8.0) as u8))
        .collect();
    colors.sort_unstable();
    colors.dedup();
    assert!(colors.len() > 10, "{} colors", colors.len());
}
