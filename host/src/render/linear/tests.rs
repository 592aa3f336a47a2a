//! Linear pictures against pictures of displays, and against what scenes state.

use super::*;
use crate::render::render;
use crate::render::test_pictures::{MIDDLE, OTHERS, WIDTH, blob, job};

/// Two balls, one of them a mirror, under a strong and a weak light.
const BALLS: &str = "
    background = [0.25, 0.5, 3.0]
    [camera]
    eye = [0, 1, 6]
    target = [0, 0, 0]
    fov = 40
    [[light]]
    kind = 'directional'
    direction = [-1, -1, -1]
    color = [9.0, 0.5, 0.25]
    [material.mirror]
    diffuse = [0.1, 0.1, 0.1]
    mirror = [0.8, 0.8, 0.8]
    [[object]]
    kind = 'sphere'
    center = [-1, 0, 0]
    radius = 1
    [[object]]
    kind = 'sphere'
    center = [1.2, 0, 0]
    radius = 1
    material = 'mirror'";

fn linear(scene: &Scene<'_>, job: &Job) -> Vec<[f32; 3]> {
    render_linear(scene, job, &|| ()).expect("a picture").pixels
}

/// With one sample a display shows the radiance, limited to white.
#[test]
fn displays_show_the_limited_radiance() {
    let blob = blob("test.toml", BALLS);
    let scene = &blob.scene().expect("a scene");
    for format in Format::ALL {
        let job = job(scene, format, 1);
        let shown = render(scene, &job, &|| ()).expect("a picture").pixels;
        let linear = linear(scene, &job);
        assert!(linear.iter().any(|pixel| pixel[0] > 4.0), "{format:?}");
        for (shown, linear) in shown.iter().flatten().zip(linear.iter().flatten()) {
            let limited = f64::from(*linear).clamp(0.0, 1.0) * 65535.0;
            let apart = (f64::from(*shown) - limited).abs();
            assert!(apart <= 1.0, "{format:?}: {shown} for {limited}");
        }
    }
}

#[test]
fn backgrounds_and_ambient_light_come_out_as_the_scene_states_them() {
    let scene = "
        background = [0.25, 0.5, 3.0]
        ambient = [2.0, 4.0, 8.0]
        [material.gray]
        diffuse = [0.5, 0.25, 0.125]
        [[object]]
        kind = 'sphere'
        center = [0, 0, 0]
        radius = 1
        material = 'gray'";
    let blob = blob("test.toml", scene);
    let scene = &blob.scene().expect("a scene");
    for format in Format::ALL {
        for samples in [1, 5] {
            let pixels = linear(scene, &job(scene, format, samples));
            let near = |pixel: [f32; 3], expected: [f32; 3]| {
                let apart = |k: usize| (pixel[k] - expected[k]).abs();
                assert!((0..3).all(|k| apart(k) < 1e-4), "{format:?}: {pixel:?}");
            };
            near(pixels[0], [0.25, 0.5, 3.0]);
            near(pixels[MIDDLE], [1.0; 3]);
        }
    }
}

#[test]
fn bits_depend_on_neither_structure_nor_rows() {
    let blob = blob("test.toml", BALLS);
    let scene = &blob.scene().expect("a scene");
    for format in Format::ALL {
        let whole = job(scene, format, 3);
        let expected = linear(scene, &whole);
        for structure in OTHERS {
            let other = Job {
                structure,
                ..whole.clone()
            };
            assert!(linear(scene, &other) == expected, "{structure:?}");
        }
        let part = Job {
            rows: 7..9,
            ..whole
        };
        let rows = 7 * usize::from(WIDTH)..9 * usize::from(WIDTH);
        assert!(linear(scene, &part) == expected[rows]);
    }
}

/// The strongest lights that a scene file may have: `fixed` limits the light of a ray to 2,048, other formats do not.
#[test]
fn strongest_lights_are_limited_in_fixed_alone() {
    let light = "[[light]]\nkind = 'directional'\ndirection = [0, 0, -1]\ncolor = 2047\n";
    let scene = "[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\n[material.white]\ndiffuse = 1\n\
                 [[object]]\nkind = 'box'\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\nmaterial = 'white'\n";
    for (lights, in_fixed) in [(1, 2047.0), (2, 2048.0), (3, 2048.0)] {
        let blob = blob("test.toml", &(light.repeat(lights) + scene));
        let scene = &blob.scene().expect("a scene");
        for format in Format::ALL {
            let expected = match format {
                Format::Fixed => in_fixed,
                _ => 2047.0 * lights as f32,
            };
            let [red, ..] = linear(scene, &job(scene, format, 1))[MIDDLE];
            let apart = (red / expected - 1.0).abs();
            assert!(apart < 1e-6, "{format:?}: {red} under {lights} lights");
        }
    }
}

/// A scene of display values shows what it states. Its linear picture is decoded from sRGB.
#[test]
fn display_values_are_decoded() {
    let nff = "b 0.5 0.25 1\nv\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 1\nresolution 48 32\n\
               l 3 4 5\nf 1 .75 .33 .8 0 0 0 1\ns 0 0 0 .5\n";
    let blob = blob("ball.nff", nff);
    let scene = blob.scene().expect("a scene");
    let job = job(&scene, Format::F64, 1);
    let corner = linear(&scene, &job)[0];
    for (linear, exact) in corner.into_iter().zip([0.214_041_14, 0.050_876_09, 1.0]) {
        assert!((linear - exact).abs() < 1e-5, "{linear} for {exact}");
    }
    assert!((linear_of_srgb(2.0) - 4.953_846).abs() < 1e-4);
}
