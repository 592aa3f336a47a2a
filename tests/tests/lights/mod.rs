//! Lights with an area, a falloff or a spot: pictures have the values that analysis gives.

mod near_by;

use gridel_core::{Effects, Format};
use gridel_host::blob::Blob;
use gridel_host::compile::{Options, compile};
use gridel_tests::measured::{
    ROUNDING, check, convergence, measured, measured_color, read, wrong_pixels,
};
use std::f64::consts::PI;

/// A scene with a white surface, seen by 4 by 4 pixels that show nearly one point of it.
fn scene(lights: &str, eye: &str, target: &str, objects: &str) -> Blob {
    let text = format!(
        "[camera]\neye = {eye}\ntarget = {target}\nup = [0.3, 0.2, 1]\nfov = 0.2\n\
         [render]\nwidth = 4\nheight = 4\nsamples = 1\n\
         [material.white]\ndiffuse = 1\n{objects}\n{lights}"
    );
    compile(&read(&text), &Options::default())
        .expect("a blob")
        .blob
}

const FLOOR: &str =
    "[[object]]\nkind = 'box'\nmin = [-900, -100, -900]\nmax = [1500, 0, 1500]\nmaterial = 'white'";

/// Returns the irradiance of the Cornell box's light, over its radiance. It is integrated over the light with midpoints
/// of 400 by 400 cells.
#[test]
fn cornell_light_gives_the_analytic_irradiance() {
    const LIGHT: &str = "[[light]]\nkind = 'rectangle'\ncorner = [213, 548.8, 227]\n\
                         edges = [[130, 0, 0], [0, 0, 105]]\nradiance = 15";
    for ([x, z], ratio) in [
        ([278.0, 279.6], 0.044_632_5),
        ([100.0, 100.0], 0.030_656_7),
        ([500.0, 500.0], 0.025_732_2),
    ] {
        let blob = scene(
            LIGHT,
            &format!("[{x}, 30, {z}]"),
            &format!("[{x}, 0, {z}]"),
            FLOOR,
        );
        assert!(
            blob.scene()
                .expect("a scene")
                .effects()
                .contains(Effects::AREA_LIGHT)
        );
        check("floor", &blob, 15.0 * ratio / PI);
    }
    let wall = "[[object]]\nkind = 'box'\nmin = [-500, -500, 559.2]\nmax = [1000, 1000, 700]\nmaterial = 'white'";
    let blob = scene(LIGHT, "[278, 274.4, 530]", "[278, 274.4, 559.2]", wall);
    check("wall", &blob, 15.0 * 0.043_652_6 / PI);
}

/// A lamp may be farther from a small scene than the lattice is wide, and a face that glows as large as the scene.
#[test]
fn far_lamps_and_large_faces_light_small_scenes() {
    const GROUND: &str =
        "[[object]]\nkind = 'box'\nmin = [-1, -0.1, -1]\nmax = [1, 0, 1]\nmaterial = 'white'";
    for (height, range) in [(7.0_f64, 1e9_f64), (10.0, 30.0), (40.0, 1e3), (60.0, 1e3)] {
        let color = 0.5 * height * height;
        let light = format!(
            "[[light]]\nkind = 'point'\nposition = [0, {height}, 0]\nfalloff = 'square'\ncolor = {color}\n\
             range = {range}"
        );
        let blob = scene(&light, "[0, 0.3, 0]", "[0, 0, 0]", GROUND);
        let exact = 0.5 * (1.0 - (height / range).powi(4));
        for format in Format::ALL {
            let (mean, _) = measured(&blob, format, 16);
            assert!(
                (mean / exact - 1.0).abs() < 0.006,
                "{height} {range} {format:?} {mean} {exact}"
            );
        }
    }
    for (radius, height) in [(0.5_f64, 20.0_f64), (1.5, 80.0), (2.0, 120.0)] {
        let radiance = 0.5 * (height / radius).powi(2);
        let light = format!(
            "[[light]]\nkind = 'sphere'\ncenter = [0, {height}, 0]\nradius = {radius}\nradiance = {radiance}\n"
        );
        let blob = scene(&light, "[0, 0.3, 0]", "[0, 0, 0]", GROUND);
        check("ball", &blob, 0.5);
    }
    for width in [0.7_f64, 1.0, 1.5, 2.0, 3.0, 7.9] {
        let half = width / 2.0;
        let glowing = format!(
            "[material.lamp]\ndiffuse = 0\nemission = 1\n[[object]]\nkind = 'mesh'\nvertices = \
             [[-{half}, {width}, -{half}], [-{half}, {width}, {half}], [{half}, {width}, {half}], \
             [{half}, {width}, -{half}]]\nfaces = [[0, 3, 2, 1]]\nmaterial = 'lamp'\n\
             [[object]]\nkind = 'box'\nmin = [-0.1, -0.1, -0.1]\nmax = [0.1, 0, 0.1]\nmaterial = 'white'"
        );
        let blob = scene("", "[0, 0.03, 0]", "[0, 0, 0]", &glowing);
        // A square of side a, a above its middle: of its four quarters with x = y = 1/2 in a.
        let side = 0.5 / 1.25_f64.sqrt();
        check("face", &blob, 4.0 * side * side.atan() / PI);
    }
}

/// A light that shines away lights nothing.
#[test]
fn rectangles_and_discs_shine_to_one_side() {
    for light in [
        "kind = 'rectangle'\ncorner = [0, 100, 0]\nedges = [[0, 0, 50], [50, 0, 0]]",
        "kind = 'disc'\ncenter = [0, 100, 0]\nradius = 20\nnormal = [0, 1, 0]",
    ] {
        let light = format!("[[light]]\n{light}\nradiance = 50");
        let blob = scene(&light, "[10, 30, 10]", "[10, 0, 10]", FLOOR);
        for format in Format::ALL {
            assert_eq!(measured(&blob, format, 4), (0.0, 0.0), "{light} {format:?}");
        }
    }
}

/// A sphere above a floor: L (r / d)². A disc above its axis: L r² / (r² + h²).
#[test]
fn spheres_and_discs_give_the_analytic_irradiance() {
    for (radius, height) in [(20.0_f64, 100.0_f64), (60.0, 100.0), (0.5, 200.0)] {
        let radiance = (0.4 * (height / radius).powi(2)).min(2000.0);
        let light = |rest: &str| {
            format!(
                "[[light]]\ncenter = [0, {height}, 0]\nradius = {radius}\nradiance = {radiance}\n{rest}"
            )
        };
        let blob = scene(&light("kind = 'sphere'"), "[0, 10, 0]", "[0, 0, 0]", FLOOR);
        check("sphere", &blob, radiance * (radius / height).powi(2));
        let disc = light("kind = 'disc'\nnormal = [0, -1, 0]");
        let blob = scene(&disc, "[0, 10, 0]", "[0, 0, 0]", FLOOR);
        let square = radius * radius;
        check(
            "disc",
            &blob,
            radiance * square / (square + height * height),
        );
    }
}

/// An edge under the middle of a far light hides half of it.
#[test]
fn half_plane_hides_half_of_a_light() {
    let light = "[[light]]\nkind = 'rectangle'\ncorner = [-20, 1000, -20]\n\
                 edges = [[40, 0, 0], [0, 0, 40]]\nradiance = 800";
    let edge =
        "[[object]]\nkind = 'box'\nmin = [0, 400, -900]\nmax = [900, 420, 900]\nmaterial = 'white'";
    let without = 800.0 * 1600.0 / 1e6 / PI * (1.0 - 4.0 * 400.0 / 3.0 / 1e6);
    for (objects, exact) in [
        (String::from(FLOOR), without),
        (format!("{FLOOR}\n{edge}"), without / 2.0),
    ] {
        let blob = scene(light, "[0, 60, 0]", "[0, 0, 0]", &objects);
        check("edge", &blob, exact);
    }
}

/// The error falls at least as N^-0.7 from 16 to 4,096 samples; of random points it falls as N^-0.5.
#[test]
fn soft_shadows_converge() {
    let light = "[[light]]\nkind = 'rectangle'\ncorner = [-20, 100, -20]\n\
                 edges = [[40, 0, 0], [0, 0, 40]]\nradiance = 10";
    let ball = "[[object]]\nkind = 'sphere'\ncenter = [8, 50, 5]\nradius = 12\nmaterial = 'white'";
    let blob = scene(
        light,
        "[3, 20, 0]",
        "[3, 0, 0]",
        &format!("{FLOOR}\n{ball}"),
    );
    let exponent = convergence(&blob);
    assert!(exponent >= 0.7, "{exponent}");
}

/// Ranges on both sides of the longest near one (8 here) and of the longest that is kept (256), and lights at their
/// ends.
#[test]
fn long_ranges_end_light_where_they_say() {
    const GROUND: &str =
        "[[object]]\nkind = 'box'\nmin = [-1, -0.1, -1]\nmax = [1, 0, 1]\nmaterial = 'white'";
    for (height, range) in [
        (6.0_f64, 7.99_f64),
        (6.0, 8.01),
        (6.0, 6.1),
        (10.0, 9.9),
        (10.0, 10.1),
        (10.0, 12.0),
        (10.0, 255.9),
        (10.0, 256.1),
        (200.0, 199.0),
        (200.0, 202.0),
        (200.0, 255.9),
        (200.0, 1e4),
    ] {
        let color = 0.5 * height * height;
        let light = format!(
            "[[light]]\nkind = 'point'\nposition = [0, {height}, 0]\nfalloff = 'square'\ncolor = {color}\n\
             range = {range}"
        );
        let blob = scene(&light, "[0, 0.3, 0]", "[0, 0, 0]", GROUND);
        let exact = 0.5 * (1.0 - (height / range).powi(4)).max(0.0);
        for format in Format::ALL {
            let (mean, _) = measured(&blob, format, 16);
            assert!(
                (mean - exact).abs() < 0.001,
                "{height} {range} {format:?} {mean} {exact}"
            );
        }
    }
}

/// The directions to a sphere are spread evenly also where those of a pixel's samples lie on both sides of a plane of
/// coordinates.
#[test]
fn spheres_are_sampled_evenly_in_all_directions() {
    let towards = |[x, y, z]: [f64; 3]| {
        format!("[[light]]\nkind = 'sphere'\ncenter = [{x}, {y}, {z}]\nradius = 100\nradiance = 10")
    };
    for center in [[300.0, 20.0, 0.0], [-300.0, 20.0, 0.0], [0.0, 20.0, 300.0]] {
        let blob = scene(&towards(center), "[0, 20, 0]", "[0, 0, 0]", FLOOR);
        let exponent = convergence(&blob);
        assert!(exponent >= 0.7, "{center:?}: {exponent}");
    }
}

/// A point light with a falloff has its color at a distance of 1, spots end, and a range ends light.
#[test]
fn points_fall_off_and_spots_end() {
    let at = |rest: &str| {
        format!("[[light]]\nposition = [0, 50, 0]\ncolor = 1000\nfalloff = 'square'\n{rest}")
    };
    let view = |lights: &str, x: f64| {
        scene(
            lights,
            &format!("[{x}, 20, 0]"),
            &format!("[{x}, 0, 0]"),
            FLOOR,
        )
    };
    let lit = |x: f64| 1000.0 * 50.0 / (x * x + 2500.0_f64).powf(1.5);
    check("point", &view(&at("kind = 'point'"), 30.0), lit(30.0));
    let part = 1.0 - (3400.0_f64 / 10_000.0).powi(2);
    check(
        "range",
        &view(&at("kind = 'point'\nrange = 100"), 30.0),
        lit(30.0) * part,
    );
    let spot = at("kind = 'spot'\ndirection = [0, -1, 0]\ninner = 20\nouter = 40");
    check("spot", &view(&spot, 5.0), lit(5.0));
    let cosine = |degrees: f64| degrees.to_radians().cos();
    let edge =
        (cosine((0.6_f64).atan().to_degrees()) - cosine(40.0)) / (cosine(20.0) - cosine(40.0));
    check(
        "edge of a spot",
        &view(&spot, 30.0),
        lit(30.0) * edge * edge,
    );
    assert_eq!(measured(&view(&spot, 45.0), Format::Fixed, 1), (0.0, 0.0));
}

/// A visible light lights as an invisible one: its own surface does not block it.
#[test]
fn visible_lights_light_as_invisible_ones() {
    let rectangle = 15.0 * 0.044_632_5 / PI;
    for (light, exact) in [
        (
            "kind = 'rectangle'\ncorner = [213, 548.8, 227]\nedges = [[130, 0, 0], [0, 0, 105]]\nradiance = 15",
            rectangle,
        ),
        (
            "kind = 'sphere'\ncenter = [278, 100, 279.6]\nradius = 20\nradiance = 10",
            10.0 * 0.04,
        ),
        (
            "kind = 'disc'\ncenter = [278, 100, 279.6]\nnormal = [0, -1, 0]\nradius = 20\nradiance = 10",
            10.0 * 400.0 / 10_400.0,
        ),
    ] {
        for visible in [true, false] {
            let text = format!("[[light]]\n{light}\nvisible = {visible}");
            let blob = scene(&text, "[278, 30, 279.6]", "[278, 0, 279.6]", FLOOR);
            let effects = blob.scene().expect("a scene").effects();
            assert_eq!(effects.contains(Effects::EMISSION), visible);
            check("visible", &blob, exact);
        }
    }
}

/// Objects that glow are lights: a box and a mesh give what their faces give.
#[test]
fn surfaces_that_glow_light_others_and_are_seen() {
    let lamp = "[material.lamp]\ndiffuse = 0\nemission = 15";
    let mesh = format!(
        "{lamp}\n[[object]]\nkind = 'mesh'\nvertices = [[213, 548.8, 227], [343, 548.8, 227], \
         [343, 548.8, 332], [213, 548.8, 332]]\nfaces = [[0, 1, 2], [0, 2, 3]]\nmaterial = 'lamp'\n{FLOOR}"
    );
    let blob = scene("", "[278, 30, 279.6]", "[278, 0, 279.6]", &mesh);
    check("mesh", &blob, 15.0 * 0.044_632_5 / PI);
    // Only the lower face of a box is visible from below.
    let cuboid = format!(
        "{lamp}\n[[object]]\nkind = 'box'\nmin = [213, 548.8, 227]\nmax = [343, 600, 332]\nmaterial = 'lamp'\n{FLOOR}"
    );
    let blob = scene("", "[278, 30, 279.6]", "[278, 0, 279.6]", &cuboid);
    check("box", &blob, 15.0 * 0.044_632_5 / PI);
    // The front glows, and the back does not.
    let half = mesh.replace("emission = 15", "emission = 0.5");
    for format in Format::ALL {
        let below = scene("", "[278, 30, 279.6]", "[278, 548.8, 279.6]", &half);
        let (mean, _) = measured(&below, format, 1);
        assert!((mean - 0.5).abs() < ROUNDING, "{format:?} {mean}");
        let above = scene("", "[278, 900, 279.6]", "[278, 548.8, 279.6]", &half);
        assert_eq!(measured(&above, format, 1).0, 0.0, "{format:?}");
    }
}

/// A triangle gives half of the parallelogram that it is a half of, on the axis of symmetry.
#[test]
fn triangles_shine_from_their_area() {
    let lamp = |faces: &str| {
        let objects = format!(
            "[material.lamp]\nemission = 12\n[[object]]\nkind = 'mesh'\nvertices = [[-50, 200, -50], \
             [50, 200, -50], [50, 200, 50], [-50, 200, 50]]\nfaces = {faces}\nmaterial = 'lamp'\n{FLOOR}"
        );
        scene("", "[0, 30, 0]", "[0, 0, 0]", &objects)
    };
    // Midpoints of 2000 by 2000 cells of the square.
    let mut sum = 0.0;
    for x in 0..2000 {
        for z in 0..2000 {
            let at = |cell: i32| (f64::from(cell) + 0.5) / 20.0 - 50.0;
            let square = at(x).powi(2) + at(z).powi(2) + 40_000.0;
            sum += 40_000.0 / (square * square) / 400.0;
        }
    }
    check("square", &lamp("[[0, 1, 2], [0, 2, 3]]"), 12.0 * sum / PI);
    check("triangle", &lamp("[[0, 1, 2]]"), 12.0 * sum / PI / 2.0);
}

/// A scene that shows its background alone.
fn background(render: &str) -> Blob {
    let text = format!(
        "background = [0.18, 1, 8]\n[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 9]\n\
         [render]\nwidth = 4\nheight = 4\n{render}\n\
         [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1"
    );
    let imported = gridel_host::scene::read("tone.toml".as_ref(), text.into(), &Default::default());
    compile(&imported.expect("a scene").scene, &Options::default())
        .expect("a blob")
        .blob
}

/// Tones are mapped by their formulas, after the mean of any number of samples.
#[test]
fn tones_are_mapped_by_their_formulas() {
    let reinhard = |x: f64| x / (1.0 + x);
    let aces = |x: f64| (x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)).min(1.0);
    let none = |x: f64| x.min(1.0);
    let curves: [fn(f64) -> f64; 3] = [none, reinhard, aces];
    for (name, curve) in ["none", "reinhard", "aces"].into_iter().zip(curves) {
        for stops in [0.0, -3.0, 1.0] {
            let blob = background(&format!("tone_mapping = '{name}'\nexposure = {stops}"));
            let is_mapped = blob
                .scene()
                .expect("a scene")
                .effects()
                .contains(Effects::TONE_MAPPING);
            assert_eq!(is_mapped, name != "none");
            for format in Format::ALL {
                for samples in [1, 64, 65, 4096] {
                    let (found, _) = measured_color(&blob, format, samples);
                    for (found, radiance) in found.into_iter().zip([0.18, 1.0, 8.0]) {
                        let exact = curve((radiance * f64::exp2(stops)).min(16.0));
                        assert!(
                            (found - exact).abs() < 4e-5,
                            "{name} {stops} {format:?} {samples}: {found}, exact {exact}"
                        );
                    }
                }
            }
        }
    }
}

/// Exposure multiplies lights of every kind, and is no effect: it costs nothing.
#[test]
fn exposure_multiplies_all_light() {
    let lights = "[[light]]\nkind = 'rectangle'\ncorner = [-20, 100, -20]\nedges = [[40, 0, 0], [0, 0, 40]]\n\
                  radiance = 3\n[[light]]\nkind = 'directional'\ndirection = [0, -1, 0]\ncolor = 0.1\n\
                  [[light]]\nkind = 'point'\nposition = [0, 50, 0]\ncolor = 0.2";
    let at = |stops: f64| {
        let text = format!(
            "ambient = 0.05\n[camera]\neye = [0, 30, 0]\ntarget = [0, 0, 0]\nup = [1, 0, 0]\nfov = 0.2\n\
             [render]\nwidth = 4\nheight = 4\nexposure = {stops}\n[material.white]\ndiffuse = 1\n{FLOOR}\n{lights}"
        );
        let imported =
            gridel_host::scene::read("light.toml".as_ref(), text.into(), &Default::default());
        compile(&imported.expect("a scene").scene, &Options::default())
            .expect("a blob")
            .blob
    };
    let (plain, dark) = (at(0.0), at(-2.0));
    let effects = |blob: &Blob| blob.scene().expect("a scene").effects();
    assert_eq!(effects(&plain), effects(&dark));
    for format in Format::ALL {
        let [bright, dim] = [&plain, &dark].map(|blob| measured_color(blob, format, 16).0);
        for (bright, dim) in bright.into_iter().zip(dim) {
            assert!(bright > 0.3 && bright < 1.0);
            assert!(
                (bright / 4.0 - dim).abs() < 4e-5,
                "{format:?} {bright} {dim}"
            );
        }
    }
}

/// `fixed` holds what arrives up to 2048 times white, of lights of any brightness.
#[test]
fn fixed_agrees_with_floats_over_the_range_of_radiance() {
    for (radius, distance) in [(1.6, 100.0), (5.0, 100.0), (30.0, 100.0), (0.2, 12.0)] {
        // As bright as makes the point half white, up to the largest radiance.
        let radiance = 0.5_f64 * (distance / radius) * (distance / radius);
        let light = format!(
            "[[light]]\nkind = 'sphere'\ncenter = [0, {distance}, 0]\nradius = {radius}\nradiance = {radiance}"
        );
        let blob = scene(&light, "[0, 10, 0]", "[0, 0, 0]", FLOOR);
        check("range", &blob, 0.5);
    }
}

/// Light that has passed some surfaces of glass ends before its lamp, whose own surface lies just behind.
#[test]
fn lamps_behind_glass_do_not_shadow_themselves() {
    let text = "ambient = 0.02\n[camera]\neye = [1.7, 3.8, 5.2]\ntarget = [0, 0.3, 0]\nfov = 50\n\
        [render]\nwidth = 32\nheight = 24\nsamples = 1\ndepth = 2\n\
        [material.floor]\ndiffuse = 0.8\n\
        [material.glass]\ndiffuse = 0.05\ntransmit = 0.9\nior = 1.5\n\
        [material.lamp]\ndiffuse = 0\nemission = [6, 4, 3]\n\
        [[object]]\nkind = 'box'\nmaterial = 'floor'\nmin = [-3, -0.5, -3]\nmax = [3, 0, 3]\n\
        [[object]]\nkind = 'mesh'\nmaterial = 'lamp'\n\
        vertices = [[0.6, 1.1, 0], [-0.6, 1.1, 0], [0, 1.7, 0], [0, 0.53, 0], [0, 1.1, 0.6], [0, 1.1, -0.6]]\n\
        faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]\n\
        [[object]]\nkind = 'torus'\nmaterial = 'glass'\ncenter = [0, 0.4, 0]\naxis = [0, 1, 0]\n\
        major_radius = 1\nminor_radius = 0.25\n\
        [[object]]\nkind = 'torus'\nmaterial = 'glass'\ncenter = [0.2, 0.7, 0.1]\naxis = [0, 1, 0]\n\
        major_radius = 1\nminor_radius = 0.22\n";
    let blob = compile(&read(text), &Options::default())
        .expect("a blob")
        .blob;
    for format in Format::ALL {
        let wrong = wrong_pixels(&blob, format);
        assert!(wrong <= 2, "{format:?}: {wrong} of 768 pixels");
    }
}

/// Light passes as many clear surfaces as the format's documentation states, and not one more. Those at one place are
/// one.
#[test]
fn light_passes_128_surfaces() {
    for (panes, doubled, arrives) in [
        (1, 0, true),
        (128, 0, true),
        (128, 3, true),
        (129, 0, false),
    ] {
        let mut objects = String::from(FLOOR);
        objects += "\n[material.clear]\ntransmit = 1\nior = 1\n";
        for pane in (0..panes).chain(0..doubled) {
            let y = 50 + 2 * pane;
            objects += &format!(
                "[[object]]\nkind = 'disc'\ncenter = [0, {y}, 0]\nnormal = [0, 1, 0]\nradius = 100\n\
                 material = 'clear'\n"
            );
        }
        let light = "[[light]]\nkind = 'directional'\ndirection = [0, -1, 0]\ncolor = 0.5";
        let blob = scene(light, "[0, 20, 1]", "[0, 0, 0]", &objects);
        let expected = if arrives { 0.5 } else { 0.0 };
        for format in Format::ALL {
            let (found, _) = measured(&blob, format, 1);
            let off = (found - expected).abs();
            assert!(off < ROUNDING, "{panes}, {doubled}, {format:?}: {found}");
            assert_eq!(
                wrong_pixels(&blob, format),
                0,
                "{panes}, {doubled}, {format:?}"
            );
        }
    }
}
