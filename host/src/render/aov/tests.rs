//! AOVs against what scenes state.

use super::*;
use crate::render::test_pictures::{MIDDLE, OTHERS, WIDTH, blob, job};
use gridel_core::Format;

fn all(scene: &Scene<'_>, job: &Job) -> [Values; 7] {
    let values = render_aovs(scene, job, &Aov::ALL).expect("AOVs");
    values.try_into().expect("as many as were asked for")
}

fn lengths(values: &Values) -> &[f32] {
    match values {
        Values::Lengths(lengths) => lengths,
        _ => panic!("{values:?}"),
    }
}

fn vectors(values: &Values) -> &[[f32; 3]] {
    match values {
        Values::Vectors(vectors) => vectors,
        _ => panic!("{values:?}"),
    }
}

fn numbers(values: &Values) -> &[u32] {
    match values {
        Values::Numbers(numbers) => numbers,
        _ => panic!("{values:?}"),
    }
}

/// A ball before a wall of two materials, which a mirror and lights do not change.
const WALL: &str = "
    [camera]
    eye = [0, 0, 5]
    target = [0, 0, 0]
    fov = 60
    [[light]]
    kind = 'point'
    position = [1, 2, 3]
    color = [7, 7, 7]
    [material.red]
    diffuse = [0.75, 0.25, 0.125]
    mirror = [0.2, 0.2, 0.2]
    [material.board]
    checker = { even = 0.5, odd = 0.25, size = 2, origin = [0, 0, -9] }
    [[object]]
    kind = 'box'
    min = [-2, -2, -2]
    max = [2, 2, -1]
    material = 'board'
    [[object]]
    kind = 'sphere'
    center = [0, 0, 0]
    radius = 0.5
    material = 'red'";

#[test]
fn values_are_those_of_the_scene() {
    let blob = blob("test.toml", WALL);
    let scene = blob.scene().expect("a scene");
    for format in Format::ALL {
        let [depth, normal, albedo, object, primitive, uv, instance] =
            all(&scene, &job(&scene, format, 4));
        let near = |found: f32, expected: f32| {
            let apart = (found - expected).abs();
            assert!(apart < 2e-3, "{format:?}: {found} for {expected}");
        };
        near(lengths(&depth)[MIDDLE], 4.5);
        near(vectors(&normal)[MIDDLE][2], 1.0);
        for (found, expected) in vectors(&albedo)[MIDDLE]
            .into_iter()
            .zip([0.75, 0.25, 0.125])
        {
            near(found, expected);
        }
        assert_eq!(numbers(&object)[MIDDLE], 1);
        assert_eq!(numbers(&primitive)[MIDDLE], 1);
        // The wall to the right of the ball, by how far its pixel's middle is from the picture's.
        let right = MIDDLE + 7;
        let aside = 7.0 / 12.5 * 30_f32.to_radians().tan();
        near(lengths(&depth)[right], 6.0 * (1.0 + aside * aside).sqrt());
        assert_eq!(numbers(&object)[right], 0);
        let cells = [MIDDLE - 7, right].map(|pixel| vectors(&albedo)[pixel][0]);
        assert!(cells.contains(&0.5) && cells.contains(&0.25), "{cells:?}");
        // Nothing is in the corner.
        assert_eq!(lengths(&depth)[0], f32::INFINITY);
        assert_eq!([vectors(&normal)[0], vectors(&albedo)[0]], [[0.0; 3]; 2]);
        assert_eq!(
            [&object, &primitive].map(|it| numbers(it)[0]),
            [u32::MAX; 2]
        );
        assert!(numbers(&instance).iter().all(|&number| number == u32::MAX));
        let Values::Coordinates(pairs) = uv else {
            panic!("{uv:?}");
        };
        assert!(pairs.iter().all(|&pair| pair == [f32::INFINITY; 2]));
    }
}

#[test]
fn bits_depend_on_neither_structure_nor_rows() {
    let blob = blob("test.toml", WALL);
    let scene = blob.scene().expect("a scene");
    for format in Format::ALL {
        let whole = job(&scene, format, 4);
        let expected = all(&scene, &whole);
        for structure in OTHERS {
            let other = Job {
                structure,
                ..whole.clone()
            };
            assert!(all(&scene, &other) == expected, "{structure:?}");
        }
        let part = Job {
            rows: 3..7,
            ..whole
        };
        let rows = 3 * usize::from(WIDTH)..7 * usize::from(WIDTH);
        let [depth, .., object, _, _, _] = all(&scene, &part);
        assert_eq!(lengths(&depth), &lengths(&expected[0])[rows.clone()]);
        assert_eq!(numbers(&object), &numbers(&expected[3])[rows]);
    }
}

#[test]
fn instances_are_numbered_in_scene_file_order() {
    let scene = "
        [camera]
        eye = [0, 0, 9]
        target = [0, 0, 0]
        fov = 40
        [[part]]
        name = 'ball'
        [[part.object]]
        kind = 'sphere'
        center = [0, 0, 0]
        radius = 1
        [[instance]]
        part = 'ball'
        translate = [1.5, 0, 0]
        [[instance]]
        part = 'ball'
        translate = [-1.5, 0, 0]";
    let blob = blob("test.toml", scene);
    let scene = blob.scene().expect("a scene");
    assert_eq!(scene.instances().len(), 2);
    for format in Format::ALL {
        let [depth, .., instance] = all(&scene, &job(&scene, format, 4));
        let row = 12 * usize::from(WIDTH)..13 * usize::from(WIDTH);
        let mut seen: Vec<u32> = numbers(&instance)[row].to_vec();
        seen.dedup();
        assert_eq!(seen, [u32::MAX, 1, u32::MAX, 0, u32::MAX], "{format:?}");
        let nearest = lengths(&depth).iter().fold(f32::INFINITY, |a, &b| a.min(b));
        assert!((nearest - 8.1).abs() < 0.1, "{nearest}");
    }
}

/// The eye is inside of glass, whose far side is met after two units.
#[test]
fn albedo_is_not_absorbed_on_the_way_to_a_surface() {
    let scene = "
        camera = { eye = [0, 0, 0], target = [0, 0, -1] }
        [material.glass]
        diffuse = 0.5
        transmit = 0.4
        absorption = [1, 0.1, 0]
        [[object]]
        kind = 'sphere'
        center = [0, 0, 0]
        radius = 2
        material = 'glass'";
    assert_albedo(scene, [0.5; 3]);
}

/// Asserts the albedo in the middle of a scene's picture.
fn assert_albedo(text: &str, expected: [f32; 3]) {
    let blob = blob("test.toml", text);
    let scene = blob.scene().expect("a scene");
    for format in Format::ALL {
        let [_, _, albedo, ..] = all(&scene, &job(&scene, format, 4));
        let found = vectors(&albedo)[MIDDLE];
        let near = |k: usize| (found[k] - expected[k]).abs() < 1e-3;
        assert!(near(0) && near(1) && near(2), "{format:?}: {found:?}");
    }
}

/// A lens and an environment change no property of a surface.
#[test]
fn albedo_is_that_of_the_object_in_the_same_pixel() {
    let text = "[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\nfov = 60\naperture = 2\nfocus = 2\n\
        [environment]\nzenith = 1\nhorizon = 0.5\nground = 0.25\n\
        [material.red]\ndiffuse = [0.5, 0, 0]\n[material.blue]\ndiffuse = [0, 0, 0.5]\n\
        [[object]]\nkind = 'box'\nmin = [-1, -1, -1]\nmax = [0, 1, 0]\nmaterial = 'red'\n\
        [[object]]\nkind = 'box'\nmin = [0, -1, -1]\nmax = [1, 1, 0]\nmaterial = 'blue'\n";
    let blob = blob("lens.toml", text);
    let scene = blob.scene().expect("a scene");
    for format in Format::ALL {
        let job = job(&scene, format, 1);
        let [_, _, albedo, object, ..] = all(&scene, &job);
        let mut seen = [0; 3];
        for (albedo, &object) in vectors(&albedo).iter().zip(numbers(&object)) {
            let expected = match object {
                0 => [0.5, 0.0, 0.0],
                1 => [0.0, 0.0, 0.5],
                _ => [0.0; 3],
            };
            let off = |k: usize| (albedo[k] - expected[k]).abs();
            assert!(
                off(0).max(off(1)).max(off(2)) < 1e-4,
                "{albedo:?} of {object}"
            );
            seen[object.min(2) as usize] += 1;
        }
        assert!(seen.iter().all(|&pixels| pixels > 0), "{seen:?}");
    }
}

#[test]
fn albedo_lacks_the_light_of_a_surface_and_the_exposure() {
    let text = "
        [camera]
        eye = [0, 0, 5]
        target = [0, 0, 0]
        fov = 60
        [render]
        exposure = 2
        [material.lamp]
        diffuse = [0.3, 0.2, 0.1]
        emission = 0.5
        [[object]]
        kind = 'sphere'
        center = [0, 0, 0]
        radius = 0.5
        material = 'lamp'";
    assert_albedo(text, [0.3, 0.2, 0.1]);
}
