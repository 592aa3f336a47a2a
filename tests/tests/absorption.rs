//! Glass that absorbs: what lies in it is seen and lit through it, with and without a priority.

use gridel_core::format::limits::{MAX_RAY_DEPTH, MAX_STACK_DEPTH};
use gridel_core::{
    Effects, Format, List, NoCount, Number, Ray, Renderer, Scene, Settings, Workspace,
};
use gridel_host::compile::{Options, compile};
use gridel_tests::every_format;
use gridel_tests::measured::{measured, read, wrong_pixels};

/// Glass with a priority and without.
const PRIORITIES: [&str; 2] = ["", "priority = 1\n"];

/// A look down at the middle of a floor with albedo 0.8 through glass that bends nothing and absorbs half of the light
/// in ln 2 / 0.5 units.
fn pool(eye_y: f64, rest: &str) -> String {
    format!(
        "[camera]\neye = [0, {eye_y}, 0]\ntarget = [0, 0, 0]\nup = [0, 0, 1]\nfov = 0.05\n\
         [render]\nwidth = 4\nheight = 4\ncutoff = 1e-6\n\
         [material.floor]\ndiffuse = 0.8\n\
         [material.glass]\ndiffuse = 0\ntransmit = 1\nior = 1\nabsorption = 0.5\n{rest}\
         [[object]]\nkind = 'box'\nmin = [-5, -1, -5]\nmax = [5, 0, 5]\nmaterial = 'floor'\n"
    )
}

fn glass(min: [f64; 3], max: [f64; 3]) -> String {
    format!("[[object]]\nkind = 'box'\nmin = {min:?}\nmax = {max:?}\nmaterial = 'glass'\n")
}

fn check(name: &str, text: &str, exact: f64) {
    let scene = read(text);
    let blob = compile(&scene, &Options::default()).expect("compiles").blob;
    for format in Format::ALL {
        let (mean, _) = measured(&blob, format, 1);
        assert!(
            (mean / exact - 1.0).abs() < 2e-3,
            "{name} {format:?}: {mean} for {exact}"
        );
        assert_eq!(wrong_pixels(&blob, format), 0, "{name} {format:?}");
    }
}

/// Glass in front of the eye absorbs nothing on the way back to a hit before a ray's origin.
#[test]
fn rays_that_begin_before_their_origin_gain_no_light() {
    let text = "background = 0.5\n[material.glass]\ndiffuse = 0\ntransmit = 1\nior = 1\nabsorption = 0.5\n\
                [[object]]\nkind = 'box'\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\nmaterial = 'glass'\n";
    let blob = compile(&read(text), &Options::default())
        .expect("a blob")
        .blob;
    let scene = blob.scene().expect("a scene");
    every_format!(back_through_glass(&scene));
}

fn back_through_glass<N: Number>(scene: &Scene<'_>) {
    let side = f64::from(scene.bounds().0[0][1]);
    let renderer =
        Renderer::<N, List, { Effects::ALL.0 }>::with_settings(scene, Settings::of(scene));
    let renderer = renderer.expect("a renderer");
    let mut space = Workspace::<N, MAX_STACK_DEPTH, { MAX_RAY_DEPTH + 1 }>::new();
    let mut linear = |tmin: f64| {
        let (origin, direction) = ([2.0 * side, 0.0, 0.0], [1.0, 0.0, 0.0]);
        let ray = Ray::<N>::from_f64(scene.bounds(), origin, direction, tmin, 1e5).expect("a ray");
        renderer.linear_along(&ray, &mut space.as_view(), &mut NoCount)
    };
    let around = linear(0.0);
    // The first hit is the box's far side, from within.
    let behind = linear(-1.5 * side);
    assert!(behind <= around, "{:?}: {behind:?} {around:?}", N::FORMAT);
}

const LIGHT: &str = "[[light]]\nkind = 'directional'\ndirection = [0, -1, 0]\n";

#[test]
fn a_floor_under_glass_is_seen_and_lit_through_it() {
    for priority in PRIORITIES {
        // Its sides lie in the floor, two units of it above.
        let text = pool(5.0, priority) + &glass([-4.0, -0.5, -4.0], [4.0, 2.0, 4.0]) + LIGHT;
        // Down to the floor, and up to the eye.
        check("pool", &text, 0.8 * (-2.0_f64).exp());
    }
}

#[test]
fn a_light_in_glass_is_absorbed_up_to_where_the_glass_ends() {
    for priority in PRIORITIES {
        // The eye is below the glass.
        let lamp = "[[light]]\nkind = 'point'\nposition = [0, 3, 0]\n";
        let text = pool(1.0, priority) + &glass([-1.0, 2.0, -1.0], [1.0, 4.0, 1.0]) + lamp;
        check("lamp", &text, 0.8 * (-0.5_f64).exp());
    }
}

#[test]
fn a_light_and_a_surface_in_the_same_glass_are_absorbed_once() {
    for priority in PRIORITIES {
        let lamp = "[[light]]\nkind = 'point'\nposition = [0.5, 1, 0]\n";
        let text = pool(5.0, priority) + &glass([-4.0, -0.5, -4.0], [4.0, 2.0, 4.0]) + lamp;
        let way = 1.25_f64.sqrt();
        check("both", &text, 0.8 / way * (-0.5 * (2.0 + way)).exp());
    }
}

#[test]
fn a_mirror_in_glass_keeps_rays_in_it() {
    for priority in PRIORITIES {
        let mirror = "[material.mirror]\ndiffuse = 0\nmirror = 1\n\
             [material.glow]\ndiffuse = 0\nemission = 1\nlights = false\n\
             [[object]]\nkind = 'disc'\ncenter = [0, 1, 0]\nnormal = [1, 1, 0]\nradius = 0.5\nmaterial = 'mirror'\n\
             [[object]]\nkind = 'box'\nmin = [1.5, 0.5, -0.5]\nmax = [2, 1.5, 0.5]\nmaterial = 'glow'\n";
        let text = pool(5.0, priority) + &glass([-4.0, -0.5, -4.0], [4.0, 2.0, 4.0]) + mirror;
        // One unit down to the mirror, and from there to the box.
        check("mirror", &text, (-0.5_f64 * 2.5).exp());
    }
}

/// Glass that absorbs more than all light per unit of the lattice, in a scene whose units are long.
#[test]
fn thin_panes_of_dense_glass_are_as_dark_as_they_are_thick() {
    for (coefficient, thickness) in [(80.0, 0.0625), (32.0, 0.0625), (1.0, 0.5)] {
        let text = format!(
            "background = 1\nambient = 1\n\
             [camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\nfov = 0.2\n\
             [render]\nwidth = 4\nheight = 4\ncutoff = 0\n\
             [material.glass]\ndiffuse = 0\ntransmit = 1\nior = 1\nabsorption = {coefficient}\n\
             [[object]]\nkind = 'box'\nmin = [-1, -1, -{thickness}]\nmax = [1, 1, 0]\nmaterial = 'glass'\n\
             [[object]]\nkind = 'box'\nmin = [-5000, -101, -5000]\nmax = [5000, -100, 5000]\n"
        );
        let scene = read(&text);
        let blob = compile(&scene, &Options::default()).expect("compiles").blob;
        let exact = f64::exp(-coefficient * thickness);
        for format in Format::ALL {
            let (mean, _) = measured(&blob, format, 1);
            assert!(
                (mean / exact - 1.0).abs() < 0.01,
                "{coefficient} {format:?}: {mean} for {exact}"
            );
            assert_eq!(wrong_pixels(&blob, format), 0, "{coefficient} {format:?}");
        }
    }
}
