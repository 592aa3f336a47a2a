//! Nested dielectrics: where glass overlaps, light takes the same path as through bodies that fit.

use gridel_core::{Effects, Format, Settings, Structure};
use gridel_host::blob::Blob;
use gridel_host::compile::{CompileError, Options, compile};
use gridel_host::render::{Job, render};
use gridel_host::scene::Scene;
use gridel_tests::measured::{blob, measured, read};

/// A body with faces square to the axis along which the camera looks, which comes from large z.
struct Slab {
    /// Its end, and its start.
    z: [f64; 2],
    medium: Medium,
}

#[derive(Clone, Copy)]
struct Medium {
    name: &'static str,
    ior: f64,
    absorption: f64,
    priority: u8,
}

const fn medium(name: &'static str, ior: f64, absorption: f64, priority: u8) -> Medium {
    Medium {
        name,
        ior,
        absorption,
        priority,
    }
}

const GLASS: Medium = medium("glass", 1.5, 0.1, 2);
const WATER: Medium = medium("water", 1.33, 0.3, 1);
const BUBBLE: Medium = medium("bubble", 1.0, 0.0, 9);
const DIAMOND: Medium = medium("diamond", 2.4, 0.05, 5);

fn slab(medium: Medium, z: [f64; 2]) -> Slab {
    Slab { z, medium }
}

/// The slabs and their materials in a scene file.
fn text(slabs: &[Slab]) -> String {
    let mut text = String::new();
    let mut written: Vec<&str> = Vec::new();
    for slab in slabs {
        let Medium {
            name,
            ior,
            absorption,
            priority,
        } = slab.medium;
        if !written.contains(&name) {
            written.push(name);
            text += &format!(
                "[material.{name}]\ndiffuse = 0\ntransmit = 1\nior = {ior}\nabsorption = {absorption}\n\
                 priority = {priority}\n"
            );
        }
    }
    for slab in slabs {
        let [low, high] = slab.z;
        text += &format!(
            "[[object]]\nkind = 'box'\nmin = [-90, -90, {low}]\nmax = [90, 90, {high}]\nmaterial = '{}'\n",
            slab.medium.name
        );
    }
    text
}

/// The slabs before a wall that glows with 1, in the dark, seen from a height under an angle.
fn seen(slabs: &[Slab], from: f64, degrees: f64) -> Blob {
    before_the_wall(&text(slabs), from, degrees)
}

fn before_the_wall(glass: &str, from: f64, degrees: f64) -> Blob {
    let aside = degrees.to_radians().tan();
    let (eye, target) = (
        [aside * from, 0.0, from],
        [aside * (from - 1.0), 0.0, from - 1.0],
    );
    blob(&format!(
        "[camera]\neye = {eye:?}\ntarget = {target:?}\nup = [0, 1, 0]\nfov = 0.01\n\
         [render]\nwidth = 4\nheight = 4\ndepth = 24\ncutoff = 1e-6\n\
         [material.wall]\ndiffuse = 0\nemission = 1\nlights = false\n\
         [[object]]\nkind = 'box'\nmin = [-95, -95, -21]\nmax = [95, 95, -20]\nmaterial = 'wall'\n{glass}"
    ))
}

/// The parts that a stack of layers reflects on its near side, transmits, and reflects on its far side.
#[derive(Clone, Copy)]
struct Stack([f64; 3]);

impl Stack {
    fn then(self, next: Self) -> Self {
        let (Self([near, through, far]), Self([next_near, next_through, next_far])) = (self, next);
        let between = 1.0 / (1.0 - far * next_near);
        Self([
            near + through * through * next_near * between,
            through * next_through * between,
            next_far + next_through * next_through * far * between,
        ])
    }

    /// Layers of media, each with an index of refraction, an absorption and a thickness, between surroundings of 1.
    fn of(layers: &[(Medium, f64)], degrees: f64) -> Self {
        let sin = degrees.to_radians().sin();
        let cos = |ior: f64| (1.0 - (sin / ior) * (sin / ior)).sqrt();
        let face = |a: f64, b: f64| {
            let r = reflected([a, b], [cos(a), cos(b)]);
            Self([r, 1.0 - r, r])
        };
        let mut stack = Self([0.0, 1.0, 0.0]);
        let mut ior = 1.0;
        for &(medium, thickness) in layers {
            let length = thickness / cos(medium.ior);
            let left = (-medium.absorption * length).exp();
            stack = stack
                .then(face(ior, medium.ior))
                .then(Self([0.0, left, 0.0]));
            ior = medium.ior;
        }
        stack.then(face(ior, 1.0))
    }
}

/// The part of unpolarized light that a face between two media reflects (Fresnel).
fn reflected([a, b]: [f64; 2], [cos_a, cos_b]: [f64; 2]) -> f64 {
    let part = |x: f64, y: f64| ((x - y) / (x + y)).powi(2);
    0.5 * (part(a * cos_a, b * cos_b) + part(a * cos_b, b * cos_a))
}

fn check(name: &str, blob: &Blob, exact: f64) {
    for format in Format::ALL {
        let (mean, _) = measured(blob, format, 1);
        eprintln!("{name} {format:?}: {mean:.6}, exact {exact:.6}");
        let off = (mean - exact).abs();
        // The depth ends light that is reflected very often.
        assert!(off <= 5e-4, "{name} {format:?}: {mean}, {exact}");
    }
}

#[test]
fn overlapping_slabs_transmit_what_fitting_ones_do() {
    let with = |medium: Medium, priority: u8| Medium { priority, ..medium };
    for degrees in [0.0, 40.0, 70.0] {
        let transmitted = |layers: &[(Medium, f64)]| {
            let Stack([_, through, _]) = Stack::of(layers, degrees);
            through
        };
        // The glass fills what both take, then the water does.
        let both = |priority| {
            [
                slab(GLASS, [0.0, 1.0]),
                slab(with(WATER, priority), [0.5, 3.0]),
            ]
        };
        let check = |name: &str, slabs: &[Slab], layers: &[(Medium, f64)]| {
            let name = format!("{name} at {degrees} degrees");
            check(&name, &seen(slabs, 8.0, degrees), transmitted(layers));
        };
        check("glass first", &both(1), &[(WATER, 2.0), (GLASS, 1.0)]);
        check("water first", &both(3), &[(WATER, 2.5), (GLASS, 0.5)]);
        // Equal priorities: the first of the file.
        check("equal", &both(2), &[(WATER, 2.0), (GLASS, 1.0)]);
        check(
            "within",
            &[slab(GLASS, [0.0, 4.0]), slab(BUBBLE, [1.0, 2.0])],
            &[(GLASS, 2.0), (BUBBLE, 1.0), (GLASS, 1.0)],
        );
        check(
            "hidden",
            &[slab(GLASS, [0.0, 4.0]), slab(WATER, [1.0, 2.0])],
            &[(GLASS, 4.0)],
        );
        check(
            "one body of three",
            &[
                slab(WATER, [0.0, 2.0]),
                slab(WATER, [1.0, 3.0]),
                slab(WATER, [2.5, 4.0]),
            ],
            &[(WATER, 4.0)],
        );
        check(
            "four media",
            &[
                slab(WATER, [0.0, 4.0]),
                slab(GLASS, [1.0, 2.5]),
                slab(DIAMOND, [2.0, 3.0]),
                slab(BUBBLE, [2.75, 3.5]),
            ],
            &[
                (WATER, 0.5),
                (BUBBLE, 0.75),
                (DIAMOND, 0.75),
                (GLASS, 1.0),
                (WATER, 1.0),
            ],
        );
    }
}

#[test]
fn a_camera_within_begins_in_the_medium_that_it_leaves() {
    // Forward again and again, reflected by both faces.
    let r = reflected([1.5, 1.0], [1.0; 2]);
    let clear = Medium {
        absorption: 0.0,
        ..GLASS
    };
    check(
        "within",
        &seen(&[slab(clear, [0.0, 9.0])], 4.0, 0.0),
        1.0 / (1.0 + r),
    );
}

/// Other glass within a medium absorbs its own share, and the medium absorbs along the rest of the way.
#[test]
fn glass_without_a_priority_absorbs_as_itself() {
    let [glass, water] = [0.5, 0.1].map(|absorption| Medium {
        ior: 1.0,
        absorption,
        ..WATER
    });
    let plain = Medium {
        name: "plain",
        ..glass
    };
    let slabs = [slab(water, [2.0, 7.0]), slab(plain, [3.0, 5.0])];
    let text = text(&slabs).replacen("absorption = 0.5\npriority = 1", "absorption = 0.5", 1);
    let exact = f64::exp(-0.1 * 3.0 - 0.5 * 2.0);
    check("within", &before_the_wall(&text, 8.0, 0.0), exact);
    let lit = blob(&(under_a_light(0.0) + &text));
    check("shadow", &lit, exact);
}

#[test]
fn glass_without_a_priority_stays_as_it_is() {
    let plain = |slabs: &[Slab]| text(slabs).replace("priority = 2\n", "");
    let rest = "[camera]\neye = [5, 3, 30]\ntarget = [0, 0, 0]\n";
    let lone = blob(&format!("{rest}{}", plain(&[slab(GLASS, [0.0, 2.0])])));
    assert!(
        !lone
            .scene()
            .expect("valid")
            .effects()
            .contains(Effects::NESTED)
    );
    let beside = blob(&format!(
        "{rest}{}",
        plain(&[slab(GLASS, [0.0, 2.0]), slab(WATER, [-60.0, -50.0])])
    ));
    assert!(
        beside
            .scene()
            .expect("valid")
            .effects()
            .contains(Effects::NESTED)
    );
}

/// A white floor under a light, without glass.
fn under_a_light(degrees: f64) -> String {
    let [sin, cos] = [degrees.to_radians().sin(), degrees.to_radians().cos()];
    format!(
        "ambient = 0\n[camera]\neye = [0, -40, 1]\ntarget = [0, 0, -20]\nup = [0, 0, 1]\nfov = 0.01\n\
         [render]\nwidth = 4\nheight = 4\n\
         [[light]]\nkind = 'directional'\ndirection = [{}, 0, {}]\ncolor = 1\n\
         [material.floor]\ndiffuse = 1\n\
         [[object]]\nkind = 'box'\nmin = [-95, -95, -21]\nmax = [95, 95, -20]\nmaterial = 'floor'\n",
        -sin, -cos
    )
}

#[test]
fn shadows_pass_overlapping_glass_as_fitting_glass() {
    for degrees in [0.0_f64, 50.0] {
        let [sin, cos] = [degrees.to_radians().sin(), degrees.to_radians().cos()];
        // Straight on, so every face is met under the same angle.
        let passed = |a: f64, b: f64| {
            let k = (a / b).min(b / a);
            let inner = (1.0 - k * k * sin * sin).sqrt();
            1.0 - reflected([k, 1.0], [cos, inner])
        };
        let left = |medium: Medium, thickness: f64| (-medium.absorption * thickness / cos).exp();
        let slabs = [slab(GLASS, [2.0, 3.0]), slab(WATER, [2.5, 5.0])];
        let exact = cos
            * (passed(1.0, 1.33) * passed(1.33, 1.5) * passed(1.5, 1.0))
            * (left(WATER, 2.0) * left(GLASS, 1.0));
        check(
            &format!("at {degrees} degrees"),
            &blob(&(under_a_light(degrees) + &text(&slabs))),
            exact,
        );
    }
}

#[test]
fn rough_overlapping_glass_creates_no_light() {
    let smooth = text(&[slab(GLASS, [-2.0, 2.0]), slab(WATER, [0.0, 4.0])]);
    let rough = smooth
        .replace("transmit = 1", "transmit = 1\nroughness = 0.3")
        .replace("absorption = 0.1", "absorption = 0")
        .replace("absorption = 0.3", "absorption = 0");
    let blob = blob(&format!(
        "background = 1\n[camera]\neye = [0, 0, 30]\ntarget = [0, 0, 0]\nfov = 0.1\n\
         [render]\nwidth = 4\nheight = 4\ndepth = 16\ncutoff = 1e-4\n{rough}"
    ));
    for format in Format::ALL {
        let (mean, error) = measured(&blob, format, 256);
        eprintln!("{format:?}: {mean} +- {error}");
        assert!(mean <= 1.0 + 1e-4 && mean > 0.9, "{format:?}: {mean}");
    }
}

#[test]
fn a_medium_that_a_program_makes_opaque_is_none() {
    let slabs = [slab(GLASS, [0.0, 1.0]), slab(WATER, [0.5, 3.0])];
    let blob = seen(&slabs, 8.0, 0.0);
    let scene = blob.scene().expect("valid");
    let mut materials = scene.materials().to_vec();
    for &number in scene.media() {
        materials[number as usize].transmit = [0; 3];
    }
    let changed = scene.with_materials(&materials).expect("materials");
    assert_eq!(changed.effects(), scene.effects());
    let job = Job::whole(Format::F32, Structure::List, Settings::of(&changed));
    let picture = render(&changed, &job, &|| ()).expect("a picture");
    // No light reaches an opaque surface that does not glow.
    assert!(picture.pixels.iter().all(|&pixel| pixel == [0; 3]));
}

#[test]
fn priorities_are_checked() {
    let error = |material: &str| {
        let text = format!(
            "[material.a]\n{material}\n[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1"
        );
        gridel_host::scene::read("a.toml".as_ref(), text.into(), &Default::default())
            .expect_err("an error")
            .to_string()
    };
    for text in ["transmit = 1\npriority = 0", "transmit = 1\npriority = 101"] {
        assert!(error(text).contains("1 to 100"), "{}", error(text));
    }
    assert!(error("priority = 1").contains("`priority` needs `transmit`"));

    let media: Vec<Slab> = ["a", "b", "c", "d", "e", "f", "g", "h", "i"]
        .into_iter()
        .zip(1..)
        .map(|(name, priority)| {
            let medium = Medium {
                name,
                priority,
                ..WATER
            };
            slab(medium, [f64::from(priority), f64::from(priority) + 1.5])
        })
        .collect();
    let scene = |slabs: &[Slab]| -> Scene { read(&text(slabs)) };
    let blob = compile(&scene(&media[1..]), &Options::default())
        .expect("8 media")
        .blob;
    let order: Vec<u32> = blob.scene().expect("valid").media().to_vec();
    assert_eq!(order, [7, 6, 5, 4, 3, 2, 1, 0]);
    let error = compile(&scene(&media), &Options::default()).expect_err("9 media");
    assert!(matches!(error, CompileError::Media { count: 9 }), "{error}");
}
