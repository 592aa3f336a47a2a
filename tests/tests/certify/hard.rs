//! Hard cases: contact shadows, critical angles, grazing edges. Every pixel is proved and right, or open and named.

use super::exact::Exact;
use super::{holds, settings, small};
use gridel_core::{Format, Scene, Structure};
use gridel_host::blob::Blob;
use gridel_host::certify::{Enclosed, LEVELS, World, code, enclose, linear};
use gridel_host::render::{Job, render};
use gridel_host::shape::exact::Real;
use gridel_tests::effort::full;
use gridel_tests::scenes;
use rayon::prelude::*;

fn blob(text: &str) -> Blob {
    scenes::blob(&small::scene(text), 24)
}

/// The 16-bit values of an exact pixel.
pub fn values(exact: &[Real; 3]) -> [u16; 3] {
    exact.each_ref().map(|x| {
        let value = x * Real::of(65535.0) + Real::of(0.5);
        value.to_f64().clamp(0.0, 65535.0) as u16
    })
}

/// Compares each pixel with the evaluation in 320 bits, at every level. Returns the open ones.
fn never_wrong(scene: &Scene<'_>, size: [u16; 2]) -> Vec<([u16; 2], Enclosed)> {
    let [width, height] = size;
    let all = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    never_wrong_at(scene, size, all.collect())
}

/// Compares some of the pixels like [`never_wrong`].
fn never_wrong_at(
    scene: &Scene<'_>,
    size: [u16; 2],
    pixels: Vec<[u16; 2]>,
) -> Vec<([u16; 2], Enclosed)> {
    let settings = settings(scene, size, 1);
    let world = World::of(scene).expect("a scene that is known");
    let exact = Exact::of(scene, settings);
    let pixels = pixels.into_par_iter().filter_map(|pixel| {
        let value = exact.pixel(pixel);
        for levels in 1..=LEVELS.len() {
            let enclosed = enclose(&world, &settings, pixel, levels);
            let holds = holds(enclosed.linear, &value);
            assert!(
                holds,
                "{pixel:?}: {enclosed:?}, {:?}",
                value.each_ref().map(Real::to_f64)
            );
            if let Some(proved) = enclosed.proved() {
                assert_eq!(proved, code(values(&value)), "{pixel:?}");
            }
        }
        if let (linear, true) = linear(&world, &settings, pixel) {
            assert_eq!(linear, values(&value), "{pixel:?}");
        }
        let enclosed = enclose(&world, &settings, pixel, LEVELS.len());
        let is_open = enclosed.proved().is_none();
        assert_eq!(is_open, enclosed.reason().is_some(), "{pixel:?}");
        is_open.then_some((pixel, enclosed))
    });
    pixels.collect()
}

#[track_caller]
fn check(text: &str, size: [u16; 2], most_open: usize) {
    // Half as many, and still an odd number, so that a row and a column lie in the middle.
    let size = if full() {
        size
    } else {
        size.map(|side| (side / 2) | 1)
    };
    let blob = blob(text);
    let open = never_wrong(&blob.scene().expect("a scene"), size);
    assert!(open.len() <= most_open, "{}: {open:?}", open.len());
}

/// A ball and a block that rest on a ground of growing size, and the light low: shadows begin where they touch it.
#[test]
fn contact_shadows_are_proved_or_named() {
    for extent in [1e2, 1e3, 1e4] {
        let text = format!(
            "ambient = 0.1\n\
             [camera]\neye = [0, 1.5, 6]\ntarget = [0, 0.25, 0]\nfov = 30\n\
             [[light]]\nkind = 'directional'\ndirection = [-3, -1, -0.5]\ncolor = 0.8\n\
             [[light]]\nkind = 'point'\nposition = [0, 0.0625, 4]\ncolor = 0.4\n\
             [material.board]\nchecker = {{ even = 0.8, odd = 0.2, size = 0.5 }}\n\
             [[object]]\nkind = 'box'\nmin = [-{extent}, -1, -{extent}]\nmax = [{extent}, 0, {extent}]\n\
             material = 'board'\n\
             [[object]]\nkind = 'sphere'\ncenter = [-0.75, 0.5, 0]\nradius = 0.5\n\
             [[object]]\nkind = 'box'\nmin = [0.25, 0, -0.5]\nmax = [1.25, 0.75, 0.5]\n\
             [[object]]\nkind = 'torus'\ncenter = [0, 0.125, 1.5]\naxis = [0, 1, 0]\n\
             major_radius = 0.5\nminor_radius = 0.125\n"
        );
        check(&text, [41, 31], 3);
    }
}

/// The camera inside of glass: rays on both sides of the critical angle, which lies between pixels.
#[test]
fn critical_angles_are_proved_or_named() {
    let around = "background = [0.2, 0.5, 0.9]\n[render]\ndepth = 4\n\
        [material.glass]\ndiffuse = 0\ntransmit = 1\nior = 2\nabsorption = [0.1, 0.2, 0.3]\n\
        [[object]]\nkind = 'sphere'\ncenter = [0, 6, -9]\nradius = 2\n";
    // In a block, straight at one of its faces: the critical angle is a circle of 30 degrees around the middle.
    let block = "[camera]\neye = [0.25, 0.125, 0.5]\ntarget = [0.25, 0.125, -1]\nfov = 120\n\
        [[object]]\nkind = 'box'\nmin = [-2, -2, -2]\nmax = [2, 2, 2]\nmaterial = 'glass'\n";
    check(&format!("{around}{block}"), [33, 33], 12);
    // Off the middle of a ball.
    let ball = "[camera]\neye = [1.75, 0, 0]\ntarget = [1.75, 0, -1]\nfov = 110\n\
        [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 2\nmaterial = 'glass'\n";
    check(&format!("{around}{ball}"), [33, 25], 3);
    // From outside at a prism.
    let prism = "[camera]\neye = [0.125, 0.5, 6]\ntarget = [0, 0.5, 0]\nfov = 35\n\
        [[object]]\nkind = 'mesh'\nmaterial = 'glass'\n\
        vertices = [[-1, 0, -1], [1, 0, -1], [0, 1.75, -1], [-1, 0, 1], [1, 0, 1], [0, 1.75, 1]]\n\
        faces = [[0, 2, 1], [3, 4, 5], [0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]]\n";
    check(&format!("{around}{prism}"), [33, 25], 8);
}

/// Rays exactly along faces, through edges and corners, and tangent to round solids.
#[test]
fn grazing_edges_are_proved_or_named() {
    // The eye lies in the planes of the upper faces, and the middle column in those of the sides.
    let blocks = "[camera]\neye = [0, 1, 8]\ntarget = [0, 1, 0]\nfov = 40\n\
        [[object]]\nkind = 'box'\nmin = [0, 0, -1]\nmax = [1, 1, 1]\n\
        [[object]]\nkind = 'box'\nmin = [-1, 1, -1]\nmax = [0, 2, 1]\n\
        [[object]]\nkind = 'disc'\ncenter = [-2, 1, 0]\nnormal = [0, 1, 0]\nradius = 0.5\n\
        [[object]]\nkind = 'cylinder'\nbase = [2, 0, 0]\ntop = [2, 1, 0]\nradius = 0.5\n\
        [[object]]\nkind = 'cone'\nbase = [0, -2, 0]\napex = [0, -1, 0]\nradius = 1\n";
    // Fields of view are rounded, so the middle ray and the middle column and row alone are exact.
    check(blocks, [41, 31], 24);
    // Tangent: the middle ray touches a ball, a tube and a ring from above.
    for (object, most) in [
        (
            "kind = 'sphere'\ncenter = [0, -1, 0]\nradius = 1\n",
            [31, 31],
        ),
        (
            "kind = 'cylinder'\nbase = [-1, -1, 0]\ntop = [1, -1, 0]\nradius = 1\n",
            [31, 31],
        ),
        (
            "kind = 'torus'\ncenter = [0, -0.25, 0]\naxis = [0, 1, 0]\nmajor_radius = 1\nminor_radius = 0.25\n",
            [31, 31],
        ),
        (
            "kind = 'torus'\ncenter = [0, 0, 0]\naxis = [0, 0, 1]\nmajor_radius = 0.5\nminor_radius = 0.5\n",
            [31, 31],
        ),
        (
            "kind = 'torus'\ncenter = [0, 0, 0]\naxis = [0, 0, 1]\nmajor_radius = 0.25\nminor_radius = 0.5\n",
            [31, 31],
        ),
    ] {
        let text = format!(
            "[camera]\neye = [0, 0, 8]\ntarget = [0, 0, 0]\nfov = 20\n[[object]]\n{object}"
        );
        check(&text, most, 31);
    }
}

/// Rays among many mirrored balls: each reflection widens them, until nothing is known of a direction.
#[test]
fn rays_of_unknown_direction_do_not_miss_balls() {
    let mut text = String::from(
        "background = [0.9, 0.9, 0.9]\nambient = 1\n\
         [camera]\neye = [0, 0, 8]\ntarget = [0, 0, 0]\n[render]\ndepth = 32\ncutoff = 0.001\n\
         [material.mirror]\ndiffuse = 0\nmirror = 1\n[material.dark]\ndiffuse = [0.05, 0.05, 0.3]\n",
    );
    for number in 0..100 {
        // Spread by the golden ratio and its like, on the lattice.
        let place = |by: f64| {
            let part = (f64::from(number + 500) * by).fract();
            ((8.0 * part - 4.0) * 64.0).round() / 64.0
        };
        let center = [0.8191725133961645, 0.6710436067037893, 0.5497004779019703].map(place);
        let material = if number % 4 == 0 { "dark" } else { "mirror" };
        text += &format!(
            "[[object]]\nkind = 'sphere'\ncenter = {center:?}\nradius = 0.75\nmaterial = '{material}'\n"
        );
    }
    let blob = blob(&text);
    let rows = [20, 26].into_iter();
    let pixels = rows.flat_map(|y| (36..48).map(move |x| [x, y])).collect();
    let open = never_wrong_at(&blob.scene().expect("a scene"), [48, 36], pixels);
    assert!(open.is_empty(), "{open:?}");
}

/// A light within absorbing glass: the cutoff of its light is compared at the surface, before the rest of the way.
#[test]
fn light_that_the_last_stretch_weakens_is_not_cut_off() {
    let text = "[camera]\neye = [0, 3, 8]\ntarget = [0, 0, 0]\n\
        [material.glass]\ndiffuse = 0\ntransmit = 1\nior = 1.5\nabsorption = 7\n\
        [[light]]\nkind = 'point'\nposition = [0, 4, 0]\ncolor = 400\n\
        [[object]]\nkind = 'sphere'\ncenter = [0, 4, 0]\nradius = 1\nmaterial = 'glass'\n\
        [[object]]\nkind = 'plane'\npoint = [0, -1, 0]\nnormal = [0, 1, 0]\n";
    check(text, [17, 13], 0);
}

/// Instances in one place: the first of them in the scene file counts, whichever part it places.
#[test]
fn instances_at_one_place_are_ordered_as_in_the_scene_file() {
    let part = |name: &str, color: &str| {
        format!(
            "[material.{name}]\ndiffuse = {color}\n[[part]]\nname = '{name}'\n\
             [[part.object]]\nkind = 'box'\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\nmaterial = '{name}'\n"
        )
    };
    let text = format!(
        "[camera]\neye = [0, 0, 8]\ntarget = [0, 0, 0]\n[render]\nshadows = false\n\
         [[light]]\nkind = 'directional'\ndirection = [0, 0, -1]\n{}{}\
         [[instance]]\npart = 'red'\ntranslate = [8, 0, 0]\n[[instance]]\npart = 'blue'\n[[instance]]\npart = 'red'\n",
        part("red", "[0.9, 0.1, 0.1]"),
        part("blue", "[0.1, 0.1, 0.9]"),
    );
    check(&text, [17, 13], 0);
    // The kernels agree, which the exact picture does not use.
    let blob = blob(&text);
    let scene = blob.scene().expect("a scene");
    let settings = settings(&scene, [17, 13], 1);
    let job = Job::whole(Format::F64, Structure::DualSplit, settings);
    let picture = render(&scene, &job, &|| ()).expect("a picture");
    let world = World::of(&scene).expect("a scene that is known");
    let middle = enclose(&world, &settings, [8, 6], LEVELS.len());
    let shown = picture.pixels[6 * 17 + 8];
    assert!(shown[2] > shown[0], "{shown:?}");
    assert_eq!(middle.error_of(code(shown)), Some(0));
}
