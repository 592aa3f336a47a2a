use super::*;
use crate::compile::{Options, compile};
use crate::scene::{Files, read_among};

#[test]
fn every_texel_with_light_is_drawn() {
    for weights in [
        vec![0.0; 16],
        vec![1.0; 16],
        (0..16)
            .map(|it| f64::from(it) * 1e-9)
            .chain([1e9])
            .collect(),
        vec![0.0, 1e-30, 0.0, 5.0, 0.0, 0.0],
    ] {
        let starts = starts(&weights, 1 << 16);
        assert_eq!(starts[0], 0);
        assert!(starts.is_sorted() && starts.iter().all(|&it| it < 1 << 16));
        let ends = starts.iter().skip(1).copied().chain([1 << 16]);
        for ((start, end), weight) in starts.iter().zip(ends).zip(&weights) {
            assert!(*weight == 0.0 || end > *start, "{weights:?}");
        }
    }
}

#[test]
fn texels_keep_their_radiance_within_a_part_in_511() {
    for exponent in -18..11 {
        for step in 0..100 {
            let red = f64::from(100 + step) * libm::exp2(f64::from(exponent)) / 100.0;
            let color = [red, 0.5 * red, 0.0].map(|it| it.min(2044.0));
            let found = unpacked(packed(color));
            for (found, expected) in found.into_iter().zip(color) {
                let most = color[0] / 511.0 + 0.5 / WHITE;
                assert!((found - expected).abs() <= most, "{color:?}: {found}");
            }
        }
    }
    for exact in [[0.0; 3], [1.0, 0.5, 0.25], [2044.0; 3]] {
        assert_eq!(unpacked(packed(exact)), exact);
    }
}

#[test]
fn solid_angles_are_those_of_a_sphere_and_places_those_of_their_directions() {
    for side in [16, 64] {
        let texels = sampled(side, |towards| [towards.x, towards.y, towards.z]);
        let sum: f64 = texels.iter().map(|it| it.solid_angle).sum();
        assert!((sum / (4.0 * PI) - 1.0).abs() < 1e-4, "{sum}");
        for (index, texel) in texels.iter().enumerate() {
            let towards = DVec3::from_array(texel.radiance);
            assert_eq!(place(towards, side), [index % side, index / side]);
        }
    }
}

/// Pixels of a color that says where they look.
fn picture() -> Panorama {
    let pixels = (0..128 * 64).map(|it| {
        let (column, row) = ((it % 128) as f32 + 0.5, (it / 128) as f32 + 0.5);
        [column / 128.0, row / 64.0, 1.0]
    });
    Panorama::new("directions", 128, 64, pixels.collect()).unwrap()
}

#[test]
fn pictures_lie_around_the_scene_as_they_are_documented() {
    let side = 64;
    for (up, zenith, ahead) in [(Up::Y, DVec3::Y, DVec3::NEG_Z), (Up::Z, DVec3::Z, DVec3::Y)] {
        let seen = |rotation: f64, towards: DVec3| {
            let [x, y] = place(towards, side);
            resampled(side, &picture(), rotation, up)[y * side + x].radiance
        };
        let slanted = |level: f64| ahead + level * zenith + 0.01 * DVec3::X;
        assert!((seen(0.0, ahead)[0] - 0.5).abs() < 0.02);
        assert!((seen(0.0, DVec3::X + 0.01 * zenith)[0] - 0.75).abs() < 0.02);
        assert!((seen(0.0, slanted(1.0))[1] - 0.25).abs() < 0.02);
        assert!((seen(0.0, slanted(-1.0))[1] - 0.75).abs() < 0.02);
        assert!(seen(0.0, zenith + 0.01 * ahead)[1] < 0.05);
        // Counterclockwise as seen from above: what was ahead is on the left.
        assert!((seen(90.0, DVec3::NEG_X + 0.01 * zenith)[0] - 0.5).abs() < 0.02);
    }
}

#[test]
fn light_of_pictures_is_kept() {
    // Small and large pictures, and one bright pixel.
    for (width, height) in [(1, 1), (2, 1), (7, 5), (300, 150)] {
        let mut pixels = vec![[0.5_f32, 1.0, 2.0]; width * height];
        let bright = (height / 3) * width + width / 2;
        pixels[bright] = [50.0, 100.0, 200.0];
        let step = |row: usize| PI * row as f64 / height as f64;
        let row = bright / width;
        let part = TAU / width as f64 * (libm::cos(step(row)) - libm::cos(step(row + 1)));
        let expected = 0.5 * (4.0 * PI - part) + 50.0 * part;
        let picture = Panorama::new("light", width, height, pixels).unwrap();
        for side in [16, 64] {
            let texels = resampled(side, &picture, 20.0, Up::Y);
            let sum: f64 = texels
                .iter()
                .map(|it| it.radiance[0] * it.solid_angle)
                .sum();
            assert!(
                (sum / expected - 1.0).abs() < 0.02,
                "{width} {side}: {sum} {expected}"
            );
        }
    }
}

#[test]
fn gradients_have_their_colors_above_and_below() {
    let sky = Sky::Gradient {
        zenith: [1.0, 0.0, 0.0],
        horizon: [0.0, 1.0, 0.0],
        ground: [0.0, 0.0, 1.0],
    };
    assert_eq!(gradient(&sky, DVec3::Y, Up::Y), [1.0, 0.0, 0.0]);
    assert_eq!(gradient(&sky, DVec3::X, Up::Y), [0.0, 1.0, 0.0]);
    assert_eq!(gradient(&sky, DVec3::Y, Up::Z), [0.0, 1.0, 0.0]);
    assert_eq!(gradient(&sky, DVec3::NEG_Z, Up::Z), [0.0, 0.0, 1.0]);
    // h (2 - h) of 1/2.
    let found = gradient(&sky, DVec3::new(0.0, 0.5, 0.0), Up::Y);
    assert_eq!(found, [0.75, 0.25, 0.0]);
}

#[test]
fn what_is_too_bright_is_limited_with_a_warning_or_rejected() {
    let plain = Exposure { factor: 1.0 };
    let compiled = |level: f32| {
        let mut pixels = vec![[1.0; 3]; 64 * 32];
        pixels[500] = [level; 3];
        let picture = Panorama::new("sun", 64, 32, pixels).unwrap();
        EnvironmentData::of(
            &Environment::of(Sky::Picture(picture.into())),
            Up::Y,
            &plain,
        )
    };
    let bright = compiled(1e5).unwrap();
    assert!(bright.figures.lost > 0.5 && bright.figures.warning().unwrap().contains("lost"));
    assert_eq!(compiled(100.0).unwrap().figures.warning(), None);
    let gray = Sky::Gradient {
        zenith: [1000.0; 3],
        horizon: [1000.0; 3],
        ground: [1000.0; 3],
    };
    let error = EnvironmentData::of(&Environment::of(gray), Up::Y, &plain).unwrap_err();
    assert!(error.to_string().contains("the environment"), "{error}");
}

#[test]
fn whole_turns_of_a_picture_change_nothing() {
    let mut files = Files::new();
    let picture = include_bytes!("../../../../../fixtures/tiles.png");
    files.insert("tiles.png", picture.to_vec());
    let mut compiled = |rotation: &str| {
        let file = format!(
            "[environment]\nimage = 'tiles.png'\nsize = 16\nrotation = {rotation}\n\
             [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1"
        );
        files.insert("turned.toml", file.into_bytes());
        let imported = read_among("turned.toml".as_ref(), &files, &Default::default()).unwrap();
        let blob = compile(&imported.scene, &Options::default()).unwrap().blob;
        blob.bytes().to_vec()
    };
    let [still, turned] = ["0", "37.5"].map(&mut compiled);
    assert_ne!(still, turned);
    for whole in ["360", "-720", "3.6e17"] {
        assert_eq!(compiled(whole), still, "{whole}");
    }
    assert_eq!(compiled("397.5"), turned);
}
