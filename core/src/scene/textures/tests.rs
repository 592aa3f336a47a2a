use super::*;
use bytemuck::Zeroable;

const ONE: i32 = 1 << COORDINATE_BITS;

/// Two by two texels: black, white, red, green.
const TEXELS: [u8; 12] = [0, 0, 0, 255, 255, 255, 255, 0, 0, 0, 255, 0];

fn image(form: u8, filter: u8, wrap: u8) -> Texture {
    Texture {
        width: 2,
        height: 2,
        form,
        filter,
        wrap: [wrap; 2],
        ..Texture::zeroed()
    }
}

fn look_up(texels: &[u8], texture: Texture, at: [f64; 2]) -> [f64; 3] {
    let textures = Textures {
        maps: &[],
        textures: &[texture],
        texels,
        ..Textures::none()
    };
    textures.validate().expect("valid");
    let at = at.map(|it| (it * f64::from(ONE)).floor() as i32);
    let found = textures.lookup(&texture, at, Footprint::point()).color;
    found.map(|it| f64::from(it) / f64::from(1 << 30))
}

const BLACK: [f64; 3] = [0.0; 3];
const WHITE: [f64; 3] = [1.0; 3];
const RED: [f64; 3] = [1.0, 0.0, 0.0];
const GREEN: [f64; 3] = [0.0, 1.0, 0.0];

#[test]
fn nearest_texels_repeat_mirror_and_clamp() {
    let at = |wrap, u, v| look_up(&TEXELS, image(2, 0, wrap), [u, v]);
    for wrap in 0..=2 {
        assert_eq!(at(wrap, 0.0, 0.0), BLACK);
        assert_eq!(at(wrap, 0.75, 0.25), WHITE);
        assert_eq!(at(wrap, 0.25, 0.75), RED);
        assert_eq!(at(wrap, 0.999_999, 0.999_999), GREEN);
    }
    assert_eq!(at(0, 1.25, 0.25), BLACK);
    assert_eq!(at(0, -0.25, 0.25), WHITE);
    assert_eq!(at(1, 1.25, 0.25), WHITE);
    assert_eq!(at(1, -0.25, 0.25), BLACK);
    assert_eq!(at(1, 2.25, 0.25), BLACK);
    assert_eq!(at(2, 1.25, 0.25), WHITE);
    assert_eq!(at(2, -7.0, 0.25), BLACK);
    assert_eq!(at(2, 2047.0, 2047.0), GREEN);
    assert_eq!(at(0, -2048.0, -2048.0), BLACK);
}

#[test]
fn bilinear_texels_are_mixed_as_linear_light() {
    let at = |wrap, u, v| look_up(&TEXELS, image(2, 1, wrap), [u, v]);
    for wrap in 0..=2 {
        assert_eq!(at(wrap, 0.25, 0.25), BLACK);
        assert_eq!(at(wrap, 0.75, 0.25), WHITE);
        let middle = at(wrap, 0.5, 0.5);
        let expected = [0.5, 0.5, 0.25];
        assert!(
            middle
                .iter()
                .zip(expected)
                .all(|(a, b)| (a - b).abs() < 1e-8),
            "{middle:?}"
        );
    }
    // At the seam the other edge, or this one again.
    assert_eq!(at(0, 0.0, 0.25), [0.5; 3]);
    assert_eq!(at(1, 0.0, 0.25), BLACK);
    assert_eq!(at(2, 0.0, 0.25), BLACK);
    assert_eq!(at(0, 0.999_999, 0.25)[0], at(0, -1e-6, 0.25)[0]);
}

#[test]
fn all_forms_hold_white_black_and_primaries_exactly() {
    let packed: Vec<u8> = [0x0000_u16, 0xffff, 0xf800, 0x07e0]
        .iter()
        .flat_map(|it| it.to_le_bytes())
        .collect();
    let wide: Vec<u8> = TEXELS
        .chunks(3)
        .flat_map(|it| [it[0], it[1], it[2], 9])
        .collect();
    let mut indexed = wide.clone();
    indexed.resize(1024, 0);
    indexed.extend([0, 1, 2, 3]);
    for (form, texels) in [
        (0, &indexed),
        (1, &packed),
        (2, &TEXELS.to_vec()),
        (3, &wide),
    ] {
        for (place, expected) in [
            ([0.2, 0.2], BLACK),
            ([0.7, 0.2], WHITE),
            ([0.2, 0.7], RED),
            ([0.7, 0.7], GREEN),
        ] {
            assert_eq!(
                look_up(texels, image(form, 0, 0), place),
                expected,
                "{form}"
            );
        }
    }
}

#[test]
fn textures_beyond_their_texels_are_rejected() {
    let check = |texture: Texture, bytes: usize| {
        let texels = vec![0; bytes];
        let textures = Textures {
            maps: &[],
            textures: &[texture],
            texels: &texels,
            ..Textures::none()
        };
        textures.validate().is_ok()
    };
    for (form, bytes) in [(0, 1028), (1, 8), (2, 12), (3, 16)] {
        let texture = image(form, 1, 0);
        assert!(check(texture, bytes));
        assert!(!check(texture, bytes - 1));
        assert!(!check(
            Texture {
                first: 1,
                ..texture
            },
            bytes
        ));
        assert!(!check(
            Texture {
                first: u32::MAX,
                ..texture
            },
            bytes
        ));
        assert!(!check(
            Texture {
                width: 4096,
                height: 4096,
                ..texture
            },
            bytes
        ));
    }
    let texture = image(2, 0, 0);
    assert!(!check(
        Texture {
            width: 0,
            ..texture
        },
        99
    ));
    assert!(!check(
        Texture {
            height: 4097,
            ..texture
        },
        1 << 16
    ));
    assert!(!check(Texture { form: 4, ..texture }, 99));
    assert!(!check(
        Texture {
            filter: 4,
            ..texture
        },
        99
    ));
    // A level of one texel.
    let leveled = Texture {
        filter: 2,
        ..texture
    };
    assert!(check(leveled, 15) && !check(leveled, 14));
    assert!(!check(
        Texture {
            wrap: [0, 3],
            ..texture
        },
        99
    ));
    let maps = [SurfaceMaps {
        color: 2,
        ..SurfaceMaps::zeroed()
    }];
    let textures = Textures {
        maps: &maps,
        textures: &[texture],
        texels: &TEXELS,
        ..Textures::none()
    };
    assert!(textures.validate().is_err());
}

#[test]
fn largest_texture_is_looked_up_at_its_last_texel() {
    let texture = Texture {
        width: 4096,
        height: 4096,
        ..image(1, 0, 2)
    };
    let mut texels = vec![0; texture.bytes()];
    let last = texels.len() - 2;
    texels[last..].copy_from_slice(&[255; 2]);
    assert_eq!(look_up(&texels, texture, [1.0, 1.0]), WHITE);
    let texture = Texture {
        filter: 1,
        ..texture
    };
    assert_eq!(look_up(&texels, texture, [1.0, 1.0]), WHITE);
}

/// The last texel is there in every form, for every number of texels.
#[test]
fn last_texels_of_all_sizes_are_found() {
    for width in 1..=9_u16 {
        for form in 0..=3 {
            let texture = Texture {
                width,
                height: 1,
                ..image(form, 0, 2)
            };
            let mut texels = vec![0; texture.bytes()];
            let last = texels.len() - texture.texel_bytes();
            texels[last..].fill(255);
            if form == 0 {
                texels[1020..1024].fill(255);
            }
            assert_eq!(
                look_up(&texels, texture, [1.0, 0.0]),
                WHITE,
                "{width} of form {form}"
            );
        }
    }
}

#[test]
fn alpha_is_that_of_palettes_and_wide_texels_alone() {
    let colors: Vec<u8> = [0, 85, 170, 255]
        .iter()
        .flat_map(|&alpha| [9, 9, 9, alpha])
        .collect();
    let mut indexed = colors.clone();
    indexed.resize(1024, 0);
    indexed.extend([0, 1, 2, 3]);
    let packed = [9; 12].to_vec();
    for filter in [0, 1] {
        for (form, texels) in [(0, &indexed), (1, &packed), (2, &packed), (3, &colors)] {
            let texture = image(form, filter, 0);
            let textures = Textures {
                maps: &[],
                textures: &[texture],
                texels,
                ..Textures::none()
            };
            textures.validate().expect("valid");
            let at = |u: f64, v: f64| {
                let at = [u, v].map(|it| (it * f64::from(ONE)) as i32);
                f64::from(textures.alpha(&texture, at, Footprint::point())) / f64::from(1 << 30)
            };
            let has_alpha = matches!(form, 0 | 3);
            let expected = |alpha: f64| if has_alpha { alpha } else { 1.0 };
            let near = |found: f64, alpha: f64| (found - expected(alpha)).abs() < 1e-8;
            assert!(near(at(0.25, 0.25), 0.0) && near(at(0.75, 0.75), 1.0));
            assert!(near(at(0.75, 0.25), 85.0 / 255.0));
            if filter == 1 {
                assert!(near(at(0.5, 0.5), 0.5), "{form}");
            }
        }
    }
}

#[test]
fn normals_are_channels_from_minus_1_to_1() {
    // 0, 255 and a value between, which is mixed as it is.
    let texels = [0, 255, 51, 255, 255, 153];
    for (filter, u, expected) in [
        (0, 0.25, [-1.0, 1.0, -0.6]),
        (0, 0.75, [1.0, 1.0, 0.2]),
        (1, 0.5, [0.0, 1.0, -0.2]),
    ] {
        let texture = Texture {
            first: 0,
            width: 2,
            height: 1,
            form: 2,
            filter,
            wrap: [0; 2],
        };
        let textures = Textures {
            textures: &[texture],
            texels: &texels,
            ..Textures::none()
        };
        let at = [(u * f64::from(ONE)) as i32, ONE / 2];
        let found = textures.normal(&texture, at, Footprint::point()).color;
        for (found, expected) in found.into_iter().zip(expected) {
            let found = f64::from(found) / f64::from(1 << 30);
            assert!((found - expected).abs() < 1e-6, "{found} {expected}");
        }
    }
}

#[test]
fn normal_maps_without_textures_or_maps_are_rejected() {
    let texture = Texture {
        first: 0,
        width: 1,
        height: 1,
        form: 2,
        filter: 0,
        wrap: [0; 2],
    };
    let of = |texture: u16| NormalMap {
        texture,
        across: 1,
        along: 1,
    };
    let plain = SurfaceMaps {
        color: 0,
        cutoff: 0,
        opacity: 0,
    };
    for (normal_maps, is_valid) in [
        (&[of(0)][..], true),
        (&[of(1)], true),
        (&[of(2)], false),
        (&[of(1), of(1)], false),
    ] {
        let textures = Textures {
            maps: &[plain],
            normal_maps: NormalMapOnly::new(|| normal_maps),
            textures: &[texture],
            texels: &[0; 3],
        };
        assert_eq!(textures.validate().is_ok(), is_valid, "{normal_maps:?}");
    }
}

/// Five by two texels, then three by one, two by one, and one: the red of a texel is its number.
const PYRAMID: Texture = Texture {
    first: 0,
    width: 5,
    height: 2,
    form: 2,
    filter: Texture::LEVELS,
    wrap: [0; 2],
};

/// The number that a footprint of this binary logarithm reads at a place: the weighted mean of texel numbers.
fn number_seen(texture: Texture, texels: &[u8], at: [f64; 2], side: f64) -> f64 {
    let textures = Textures {
        textures: &[texture],
        texels,
        ..Textures::none()
    };
    textures.validate().expect("valid");
    let at = at.map(|it| (it * f64::from(ONE)) as i32);
    let footprint = Footprint::of_log2((side * 256.0) as i32);
    let ([sum], _) = textures.mixed(&texture, at, footprint, |texel| [texel.channels()[0]]);
    f64::from(sum) / 65_536.0
}

#[test]
fn footprints_see_the_texels_of_the_two_levels_next_to_them() {
    assert_eq!(PYRAMID.texels(), 10 + 3 + 2 + 1);
    let direct: Vec<u8> = (0..16).flat_map(|it| [it, 0, 0]).collect();
    let mut palette: Vec<u8> = (0..16).flat_map(|it| [it, 0, 0, 255]).collect();
    palette.resize(1024, 0);
    palette.extend(0..16);
    // The root of the number of texels in a square of texture coordinates.
    let whole = -(10_f64.log2() / 2.0);
    let indexed = Texture { form: 0, ..PYRAMID };
    for (texture, texels) in [(PYRAMID, &direct), (indexed, &palette)] {
        let seen = |at, level: f64| number_seen(texture, texels, at, whole + level);
        assert_eq!(seen([0.9, 0.9], -3.0), 9.0);
        assert_eq!(seen([0.9, 0.9], -0.01), 9.0);
        for (level, expected) in [
            (0.0, 9.0),
            (1.0, 12.0),
            (2.0, 14.0),
            (3.0, 15.0),
            (9.0, 15.0),
        ] {
            let found = seen([0.9, 0.9], level);
            assert!((found - expected).abs() < 0.06, "{level}: {found}");
        }
        let between = seen([0.1, 0.1], 1.25);
        assert!(
            (between - (0.75 * 10.0 + 0.25 * 13.0)).abs() < 0.06,
            "{between}"
        );
        assert_eq!(Footprint::point().level(&texture), 0);
    }
    // Bilinear in each level: halfway between texels 10 and 11, and between 13 and 14.
    let bilinear = Texture {
        filter: Texture::LEVELS | Texture::BILINEAR,
        ..PYRAMID
    };
    let found = number_seen(bilinear, &direct, [1.0 / 3.0, 0.5], whole + 1.0);
    assert!((found - 10.5).abs() < 0.06, "{found}");
    // Without levels only the image counts.
    let plain = Texture {
        filter: 0,
        ..PYRAMID
    };
    assert_eq!(number_seen(plain, &direct, [0.9, 0.9], 0.0), 9.0);
}

#[test]
fn largest_images_have_all_their_levels() {
    for (width, height, levels) in [(4096, 4096, 12), (4096, 1, 12), (1, 4095, 12), (1, 1, 0)] {
        let texture = Texture {
            width,
            height,
            ..PYRAMID
        };
        let largest = Footprint::of_log2(i32::MAX).level(&texture);
        assert_eq!(largest, levels << 8, "{width} x {height}");
        let [(last, weight), _] = Footprint::of_log2(i32::MAX).levels(&texture);
        assert_eq!((last.size, weight), ([1, 1], 256));
        assert_eq!(last.first as usize + 1, texture.texels());
        assert!(texture.bytes() < 1 << 27);
    }
}
