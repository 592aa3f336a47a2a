//! Rough mirrors and rough glass: pictures have the values that formulas in double precision give.

mod bright;

use glam::DVec3;
use gridel_core::{Effects, Format};
use gridel_host::blob::Blob;
use gridel_host::compile::{Options, compile};
use gridel_host::scene::{Normals, Shape};
use gridel_tests::measured::measured;
use gridel_tests::scenes;
use std::f64::consts::PI;

type Vector = [f64; 3];

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit(v: Vector) -> Vector {
    let length = dot(v, v).sqrt();
    v.map(|x| x / length)
}

/// A direction over the floor, whose normal is y.
fn over(cos: f64, turn: f64) -> Vector {
    let sin = (1.0 - cos * cos).sqrt();
    [sin * turn.cos(), cos, sin * turn.sin()]
}

/// The Λ of Smith's masking, by the tangent.
fn lambda(alpha: f64, cos: f64) -> f64 {
    let tan2 = (1.0 - cos * cos) / (cos * cos);
    ((1.0 + alpha * alpha * tan2).sqrt() - 1.0) / 2.0
}

/// GGX for facets that reflect all.
fn brdf(alpha: f64, i: Vector, o: Vector) -> f64 {
    let half = unit([0, 1, 2].map(|k| i[k] + o[k]));
    let cos2 = half[1] * half[1];
    let spread = alpha * alpha + (1.0 - cos2) / cos2;
    let distribution = alpha * alpha / (PI * cos2 * cos2 * spread * spread);
    distribution / (1.0 + lambda(alpha, i[1]) + lambda(alpha, o[1])) / (4.0 * i[1] * o[1])
}

/// Returns the mean over the visible facets: of their normals, each with its weight.
fn over_visible(alpha: f64, i: Vector, value: impl Fn(Vector) -> f64) -> f64 {
    const CELLS: usize = 400;
    let (mut whole, mut sum) = (0.0, 0.0);
    for ring in 0..CELLS {
        // The distribution times the cosine is even over a part from 0 to 1; this is the rest of it.
        let root = (ring as f64 + 0.5) / CELLS as f64;
        let (left, width) = (root.powi(4), root.powi(3));
        let cos = 1.0 / (1.0 + alpha * alpha * (1.0 - left) / left).sqrt();
        for step in 0..CELLS {
            let m = over(cos, (step as f64 + 0.5) / CELLS as f64 * 2.0 * PI);
            let seen = width * dot(i, m).max(0.0) / cos;
            whole += seen;
            sum += seen * value(m);
        }
    }
    sum / whole
}

/// Returns the part of light from everywhere that facets reflect, each by the cosine between it and the ray.
fn reflected(alpha: f64, cos: f64, by_facet: impl Fn(f64) -> f64) -> f64 {
    let i = over(cos, 0.0);
    over_visible(alpha, i, |m| {
        let up = 2.0 * dot(i, m) * m[1] - i[1];
        if up <= 0.0 {
            return 0.0;
        }
        let (both, one) = (
            1.0 + lambda(alpha, i[1]) + lambda(alpha, up),
            1.0 + lambda(alpha, i[1]),
        );
        by_facet(dot(i, m)) * one / both
    })
}

/// The part of unpolarized light that glass reflects, seen from outside (Fresnel).
fn fresnel(ior: f64, cos: f64) -> f64 {
    let inner = (1.0 - (1.0 - cos * cos) / (ior * ior)).sqrt();
    let across = (cos - ior * inner) / (cos + ior * inner);
    let along = (ior * cos - inner) / (ior * cos + inner);
    (across * across + along * along) / 2.0
}

/// The part of light that comes into glass through facets.
fn transmitted(alpha: f64, ior: f64, cos: f64) -> f64 {
    let i = over(cos, 0.0);
    over_visible(alpha, i, |m| {
        let cos = dot(i, m);
        let inner = (1.0 - (1.0 - cos * cos) / (ior * ior)).sqrt();
        let down = (i[1] - cos * m[1]) / ior + inner * m[1];
        if down <= 0.0 {
            return 0.0;
        }
        (1.0 - fresnel(ior, cos)) / (1.0 + lambda(alpha, down))
    })
}

/// A place of a floor that is seen under a cosine.
fn floor(cos: f64, material: &str, rest: &str, depth: u8) -> Blob {
    floor_with(cos, material, rest, &format!("depth = {depth}"))
}

/// A floor with keys of `[render]`.
fn floor_with(cos: f64, material: &str, rest: &str, render: &str) -> Blob {
    let eye = over(cos, 0.0).map(|x| 40.0 * x);
    let text = format!(
        "{rest}\n[camera]\neye = {eye:?}\ntarget = [0, 0, 0]\nup = [0.1, 0.2, 1]\nfov = 0.02\n\
         [render]\nwidth = 4\nheight = 4\n{render}\n[material.rough]\n{material}\n\
         [[object]]\nkind = 'box'\nmin = [-100, -40, -100]\nmax = [100, 0, 100]\nmaterial = 'rough'"
    );
    read(text)
}

fn read(text: String) -> Blob {
    let imported = gridel_host::scene::read(
        "glossy.toml".as_ref(),
        text.clone().into(),
        &Default::default(),
    );
    let imported = imported.unwrap_or_else(|error| panic!("{error}: {text}"));
    compile(&imported.scene, &Options::default())
        .expect("a blob")
        .blob
}

fn check(name: &str, blob: &Blob, samples: u16, exact: f64) {
    for format in Format::ALL {
        let (mean, error) = measured(blob, format, samples);
        eprintln!("{name} {format:?}: {mean:.6} +- {error:.6}, exact {exact:.6}");
        let off = (mean - exact).abs();
        assert!(
            off <= 3.0 * error + 3e-5 + 1e-3 * exact,
            "{name} {format:?}: {mean} +- {error}, {exact}"
        );
    }
}

/// Samples that also draw steep facets, which are few.
const MANY: u16 = 1024;

const ROUGHNESSES: [f64; 5] = [0.05, 0.2, 0.4, 0.7, 1.0];

#[test]
fn white_rough_mirrors_under_white_light_lose_what_facets_lose() {
    for roughness in ROUGHNESSES {
        for cos in [1.0, 0.7, 0.3, 0.1] {
            let material = format!("diffuse = 0\nmirror = 1\nroughness = {roughness}");
            let blob = floor(cos, &material, "background = 0.8\nambient = 0.1", 1);
            let effects = blob.scene().expect("a scene").effects();
            assert!(effects.contains(Effects::GLOSSY.with(Effects::MIRROR)));
            let exact = 0.8 * reflected(roughness * roughness, cos, |_| 1.0);
            assert!(exact <= 0.8);
            check(&format!("furnace {roughness} {cos}"), &blob, MANY, exact);
        }
    }
    // A white light seen from above by facets of every slope: 1 - ln 2.
    let exact = reflected(1.0, 1.0, |_| 1.0);
    assert!((exact - (1.0 - 2.0_f64.ln())).abs() < 1e-3);
}

/// A row of balls whose middles are seen from above.
#[test]
fn rough_balls_reflect_as_rough_floors() {
    for (number, roughness) in ROUGHNESSES.into_iter().enumerate() {
        let x = 10 * number;
        let text = format!(
            "background = 0.9\nambient = 0.1\n[camera]\neye = [{x}, 0, 50]\ntarget = [{x}, 0, 0]\nfov = 0.02\n\
             [render]\nwidth = 4\nheight = 4\ndepth = 1\n\
             [material.rough]\ndiffuse = 0\nmirror = [0.5, 0.7, 0.9]\nroughness = {roughness}\n\
             [[object]]\nkind = 'sphere'\ncenter = [{x}, 0, 0]\nradius = 4\nmaterial = 'rough'"
        );
        let exact = 0.45 * reflected(roughness * roughness, 1.0, |_| 1.0);
        check(&format!("ball {roughness}"), &read(text), MANY, exact);
    }
}

#[test]
fn distant_lights_are_reflected_by_the_formula() {
    for roughness in ROUGHNESSES {
        for (cos_in, cos_out, turn) in [
            (0.7, 0.7, PI + 0.02),
            (0.5, 0.8, PI),
            (0.9, 0.3, 2.0),
            (0.2, 0.6, 3.0),
        ] {
            let (i, o) = (over(cos_in, 0.0), over(cos_out, turn));
            let ratio = PI * brdf(roughness * roughness, i, o) * o[1];
            // As bright as makes it half white, in the steps of a blob.
            let color = ((0.5 / (0.3 * cos_out + 0.6 * ratio)) * 1_048_576.0).round() / 1_048_576.0;
            let direction = o.map(|x| -x);
            let light = format!(
                "[[light]]\nkind = 'directional'\ndirection = {direction:?}\ncolor = {color}"
            );
            let material = format!("diffuse = 0.3\nmirror = 0.6\nroughness = {roughness}");
            let blob = floor(cos_in, &material, &light, 1);
            let exact = color * (0.3 * cos_out + 0.6 * ratio);
            check(&format!("sun {roughness} {cos_in}"), &blob, 16, exact);
        }
    }
}

/// A lamp above a rough floor gives π f cos of all its points, once. This holds whether the lamp is visible or not, and
/// through a pane.
#[test]
fn lamps_are_reflected_once() {
    let cos = 0.8;
    for roughness in [0.5, 0.7, 1.0] {
        let i = over(cos, 0.0);
        let (mut sum, cells) = (0.0, 300);
        for x in 0..cells {
            for z in 0..cells {
                let at = |cell: i32| (f64::from(cell) + 0.5) / f64::from(cells) * 40.0 - 20.0;
                let way = [at(x) - 75.0, 100.0, at(z)];
                let (o, square) = (unit(way), dot(way, way));
                sum += brdf(roughness * roughness, i, o) * o[1] * o[1] / square;
            }
        }
        let exact = 2.0 * sum * 1600.0 / f64::from(cells * cells);
        let material = format!("diffuse = 0\nmirror = 1\nroughness = {roughness}");
        let pane = "[material.pane]\ntransmit = 1\nior = 1\ndiffuse = 0\n\
                    [[object]]\nkind = 'box'\nmin = [-120, 60, -90]\nmax = [20, 70, 90]\nmaterial = 'pane'";
        for (visible, rest) in [(false, ""), (true, ""), (true, pane)] {
            let light = format!(
                "[[light]]\nkind = 'rectangle'\ncorner = [-95, 100, -20]\nedges = [[40, 0, 0], [0, 0, 40]]\n\
                 radiance = 2\nvisible = {visible}\n{rest}"
            );
            let blob = floor(cos, &material, &light, 6);
            check(&format!("lamp {roughness} {visible}"), &blob, 256, exact);
        }
    }
}

/// A lamp fills the reflection in a little rough mirror, brighter than a sample can be. Its points are not drawn.
#[test]
fn lamps_fill_little_rough_mirrors() {
    for roughness in [0.05, 0.1, 0.2] {
        let light = "[[light]]\nkind = 'rectangle'\ncorner = [-175, 100, -100]\nedges = [[200, 0, 0], [0, 0, 200]]\n\
                     radiance = 30\nvisible = true";
        let material = format!("diffuse = 0\nmirror = [0.5, 1, 1]\nroughness = {roughness}");
        let blob = floor(0.8, &material, light, 2);
        for format in Format::ALL {
            let (mean, _) = measured(&blob, format, 16);
            assert!(mean > 0.98, "{roughness} {format:?}: {mean}");
        }
        // Dark lamps and the formula agree.
        let dark = light.replace("radiance = 30", "radiance = 0.5");
        let exact = 0.25 * within(roughness * roughness, 0.8);
        check(
            &format!("little {roughness}"),
            &floor(0.8, &material, &dark, 2),
            MANY,
            exact,
        );
    }
}

/// The part of the facets' reflection that goes to the lamp above.
fn within(alpha: f64, cos: f64) -> f64 {
    let i = over(cos, 0.0);
    over_visible(alpha, i, |m| {
        let o = [0, 1, 2].map(|k| 2.0 * dot(i, m) * m[k] - i[k]);
        let at = [0, 2].map(|k| o[k] / o[1] * 100.0);
        let is_met = o[1] > 0.0 && (-175.0..25.0).contains(&at[0]) && at[1].abs() < 100.0;
        if !is_met {
            return 0.0;
        }
        let one = 1.0 + lambda(alpha, i[1]);
        one / (one + lambda(alpha, o[1]))
    })
}

/// An object that glows and is no light of the scene is visible in rough mirrors. The narrower they are, the more it
/// looks as in smooth ones.
#[test]
fn little_rough_mirrors_show_what_smooth_ones_show() {
    let ceiling = "ambient = 0.01\n[material.glow]\ndiffuse = 0\nemission = 0.5\nlights = false\n\
                   [[object]]\nkind = 'box'\nmin = [-100, 60, -100]\nmax = [100, 70, 100]\nmaterial = 'glow'";
    let seen = |roughness: f64, format: Format| {
        let material = format!("diffuse = 0\nmirror = 0.8\nroughness = {roughness}");
        measured(&floor(0.8, &material, ceiling, 1), format, 64).0
    };
    for format in Format::ALL {
        let smooth = seen(0.0, format);
        assert!((smooth - 0.4).abs() < 1e-4);
        let off = [0.4, 0.2, 0.1, 0.05].map(|roughness| (seen(roughness, format) - smooth).abs());
        assert!(off.is_sorted_by(|more, less| more >= less), "{off:?}");
        assert!(off[3] < 1e-3, "{off:?}");
    }
}

#[test]
fn rough_glass_splits_light_by_its_facets() {
    for roughness in ROUGHNESSES {
        for cos in [1.0, 0.6, 0.2] {
            let alpha = roughness * roughness;
            let glass = format!("transmit = 1\nior = 1.5\nroughness = {roughness}\ndiffuse =");
            let outside = reflected(alpha, cos, |cos| fresnel(1.5, cos));
            let blob = floor(
                cos,
                &format!("{glass} 0"),
                "background = 0.9\nambient = 0.1",
                1,
            );
            check(
                &format!("glass {roughness} {cos}"),
                &blob,
                256,
                0.9 * outside,
            );
            // Inside, all of its faces have the ambient light alone.
            let through = transmitted(alpha, 1.5, cos);
            assert!(outside + through <= 1.0);
            let blob = floor(cos, &format!("{glass} 1"), "ambient = 0.4", 1);
            check(
                &format!("through {roughness} {cos}"),
                &blob,
                64,
                0.4 + 0.4 * through,
            );
        }
    }
    // From above, smooth glass reflects 4 %.
    assert!((reflected(0.0025, 1.0, |cos| fresnel(1.5, cos)) - 0.04).abs() < 1e-4);
}

/// No light appears from nothing: a slab and a ball of rough glass under light from everywhere.
#[test]
fn lossless_rough_glass_shows_no_more_than_is_there() {
    for roughness in ROUGHNESSES {
        for shape in [
            "kind = 'box'\nmin = [-100, -3, -100]\nmax = [100, 0, 100]",
            "kind = 'sphere'\ncenter = [0, -20, 0]\nradius = 20",
        ] {
            let text = format!(
                "background = 0.9\nambient = 0.1\n[camera]\neye = [20, 50, 3]\ntarget = [0, 0, 0]\nfov = 0.02\n\
                 [render]\nwidth = 4\nheight = 4\ndepth = 16\ncutoff = 0\n\
                 [material.rough]\ndiffuse = 0\ntransmit = 1\nroughness = {roughness}\n\
                 [[object]]\n{shape}\nmaterial = 'rough'"
            );
            let blob = read(text);
            for format in Format::ALL {
                let (mean, error) = measured(&blob, format, 16);
                eprintln!("{roughness} {shape} {format:?}: {mean:.4}");
                assert!(
                    mean <= 0.9 + 3.0 * error + 3e-5,
                    "{roughness} {format:?}: {mean}"
                );
                assert!(mean > 0.2, "{roughness} {format:?}: {mean}");
            }
        }
    }
}

/// A roughness of 0 is no roughness: not a byte.
#[test]
fn smooth_mirrors_have_the_blobs_of_those_that_say_nothing() {
    let blob = |material: &str| floor(0.5, material, "", 1).bytes().to_vec();
    assert_eq!(blob("mirror = 0.5\nroughness = 0"), blob("mirror = 0.5"));
}

/// There is no surface between equal media, however rough.
#[test]
fn rough_glass_that_bends_no_light_is_invisible() {
    let text = |eye: &str, roughness: f64| {
        format!(
            "background = 0.9\n[camera]\neye = {eye}\ntarget = [0, 0, 0]\nfov = 0.02\n\
             [render]\nwidth = 4\nheight = 4\ndepth = 16\ncutoff = 0\n\
             [material.air]\ndiffuse = 0\ntransmit = 1\nior = 1\nroughness = {roughness}\n\
             [[object]]\nkind = 'box'\nmin = [-100, -3, -100]\nmax = [100, 0, 100]\nmaterial = 'air'"
        )
    };
    for eye in ["[1, 50, 2]", "[50, 9, 2]", "[50, 1, 0]"] {
        for roughness in [0.05, 0.5, 1.0] {
            let blob = read(text(eye, roughness));
            for format in Format::ALL {
                let (mean, error) = measured(&blob, format, 16);
                assert!(
                    (mean - 0.9).abs() < 1e-4 && error < 1e-4,
                    "{eye} {roughness} {format:?}: {mean}"
                );
            }
        }
    }
}

/// If the surface is shaded as if it leant by an angle, mirrored rays go below the triangle. They are turned into its
/// plane, and see the surroundings.
#[test]
fn rough_mirrors_with_their_own_normals_lose_no_rays() {
    for degrees in [30.0_f64, 50.0, 65.0] {
        let text = "background = 0.9\nambient = 0.1\n[camera]\neye = [0.1, 50, 0.1]\ntarget = [0.1, 0, 0.1]\nup = [1, 0, 0]\nfov = 0.02\n\
                    [render]\nwidth = 4\nheight = 4\n[material.rough]\ndiffuse = 0\nmirror = 1\nroughness = 0.05";
        let mut scene = gridel_tests::measured::read(text);
        let vertices = [
            DVec3::new(-9.0, 0.0, -9.0),
            DVec3::new(0.0, 0.0, 9.0),
            DVec3::new(9.0, 0.0, -9.0),
        ];
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let normals = Normals {
            vectors: vec![DVec3::new(sine, cosine, 0.0)],
            triangles: vec![[0; 3]],
            changes: Vec::new(),
        };
        let mut mesh = scenes::of([Shape::Mesh {
            vertices: vertices.to_vec(),
            triangles: vec![[0, 1, 2]],
        }])
        .objects
        .remove(0);
        mesh.normals = normals;
        mesh.material = scene
            .materials
            .iter()
            .position(|it| it.name == "rough")
            .expect("it");
        scene.objects.push(mesh);
        let blob = compile(&scene, &Options::default()).expect("a blob").blob;
        for format in Format::ALL {
            let (mean, _) = measured(&blob, format, 256);
            assert!(
                (0.87..=0.9001).contains(&mean),
                "{degrees} {format:?}: {mean}"
            );
        }
    }
}
