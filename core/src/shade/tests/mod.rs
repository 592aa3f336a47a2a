//! Mock effects, one at each place where effects attach, which test that each effect acts. The self-tests show that
//! they do nothing where they are not in use, because their pictures keep their hashes with these effects listed.

mod mocks;

use crate::accel::Number;
use crate::format::Effects;
use crate::selftest::TinyBlob;
use crate::shade::EffectsThen;
use crate::{Counters, Fixed, List, Renderer, Scene, Settings, Workspace};
use mocks::*;

/// The list of effects of this crate's own tests: a line for each mock, behind the true ones.
macro_rules! with_mocks {
    ($($mock:ident = $bit:literal,)*) => {
        $(impl $mock {
            const BITS: u32 = 1 << $bit;
        })*

        pub(crate) type All = EffectsThen<with_mocks!(@ $($mock,)*)>;
    };
    (@) => { () };
    (@ $first:ident, $($rest:ident,)*) => { ($first, with_mocks!(@ $($rest,)*)) };
}

with_mocks! {
    Print = 21,
    Shift = 22,
    Fog = 23,
    Tint = 24,
    Matt = 25,
    Falloff = 26,
    Veil = 27,
    Sky = 28,
    Pane = 29,
    ToneMap = 30,
    Trail = 31,
}

/// The pixels of the tiny scene, with one sample each, and the rays that they take.
type Picture = (Vec<[u16; 3]>, Counters);

const TRUE: u32 = Effects::ALL.0;

fn picture<N: Number, const EFFECTS: u32>(depth: u8) -> Picture {
    let blob = TinyBlob::new();
    let scene = Scene::from_bytes(blob.bytes()).expect("a scene");
    let settings = Settings {
        samples: 1,
        depth,
        ..Settings::of(&scene)
    };
    let renderer =
        Renderer::<N, List, EFFECTS>::with_settings(&scene, settings).expect("a renderer");
    // Up to three rays wait after a hit.
    let mut space = Workspace::<N, 0, { Effects::MAX_WORK_DEPTH }>::new();
    let mut space = space.as_view();
    let mut counters = Counters::default();
    let places = (0..settings.height).flat_map(|y| (0..settings.width).map(move |x| [x, y]));
    let pixels = places.map(|[x, y]| renderer.linear(x, y, &mut space, &mut counters));
    (pixels.collect(), counters)
}

/// The pixels with and without a mock, without rays that wait.
fn pairs<const WITH_MOCK: u32>() -> Vec<[[u16; 3]; 2]> {
    let (without, _) = picture::<f32, TRUE>(0);
    let (with, _) = picture::<f32, WITH_MOCK>(0);
    without.into_iter().zip(with).map(Into::into).collect()
}

/// The background's pixel.
fn background() -> [u16; 3] {
    picture::<f32, TRUE>(0).0[0]
}

/// Returns true if each channel of a pixel is a part of another's, except for rounding.
fn is_part(part: u32, [whole, found]: [[u16; 3]; 2]) -> bool {
    whole
        .into_iter()
        .zip(found)
        .all(|(whole, found)| u32::from(found).abs_diff(u32::from(whole) / part) <= 1)
}

#[test]
fn tiny_scene_shows_background_and_surfaces() {
    let background = background();
    let (pixels, counters) = picture::<f32, TRUE>(4);
    let empty = pixels.iter().filter(|&&pixel| pixel == background).count();
    assert!((100..180).contains(&empty), "{empty}");
    assert!(counters.shadow > 0 && counters.reflected > 0 && counters.refracted > 0);
}

#[test]
fn camera_mock_moves_every_ray_past_the_scene() {
    const MOCK: u32 = TRUE | Shift::BITS;
    let (pixels, counters) = picture::<f32, MOCK>(4);
    assert!(pixels.iter().all(|&pixel| pixel == background()));
    assert_eq!(counters.secondary(), 0);
}

#[test]
fn arrive_mock_halves_surfaces_and_no_background() {
    let background = background();
    for pair in pairs::<{ TRUE | Fog::BITS }>() {
        let part = if pair[0] == background { 1 } else { 2 };
        assert!(is_part(part, pair), "{pair:?}");
    }
}

#[test]
fn surface_mock_tints_diffuse_light() {
    let background = background();
    // Without highlights, which keep the color of the light.
    const MOCK: u32 = TRUE | Tint::BITS | Matt::BITS;
    for [without, with] in pairs::<MOCK>() {
        let [red, green, blue] = with;
        let tinted = red == 0 && green > 0 && blue == 0;
        assert!(tinted || with == background && with == without, "{with:?}");
    }
}

#[test]
fn surface_mock_changes_the_normal_that_lights_are_computed_with() {
    let (without_lights, _) = picture::<f32, { TRUE | Print::BITS | Matt::BITS }>(0);
    let (found, _) = picture::<f32, { TRUE | Print::BITS }>(0);
    assert_eq!(found, without_lights);
}

#[test]
fn surface_mock_paints_by_place() {
    let background = background();
    let (pixels, _) = picture::<f32, { TRUE | Print::BITS | Matt::BITS }>(0);
    let mut count = [0; 2];
    for pixel in pixels.into_iter().filter(|&pixel| pixel != background) {
        let [red, green, blue] = pixel;
        assert_eq!([red, blue], [0, 0]);
        count[usize::from(green > 0)] += 1;
    }
    assert!(count[0] > 5 && count[1] > 5, "{count:?}");
}

#[test]
fn reflect_mock_leaves_ambient_light_alone() {
    let background = background();
    let lit = pairs::<{ TRUE | Matt::BITS }>().into_iter();
    let darker = lit.filter(|[without, with]| with != without);
    let mut count = 0;
    for [without, with] in darker {
        assert!(without != background);
        assert!((0..3).all(|k| with[k] <= without[k]), "{with:?}");
        count += 1;
    }
    assert!(count > 20, "{count}");
    let (_, counters) = picture::<f32, { TRUE | Matt::BITS }>(0);
    assert_eq!(
        counters.shadow, 0,
        "nothing is reflected, so no light is asked for"
    );
}

#[test]
fn light_mock_halves_what_lights_add() {
    let (ambient, _) = picture::<f32, { TRUE | Matt::BITS }>(0);
    let pairs = pairs::<{ TRUE | Falloff::BITS }>();
    for ([without, with], ambient) in pairs.into_iter().zip(ambient) {
        let from_lights = |pixel: [u16; 3]| [0, 1, 2].map(|k| pixel[k] - ambient[k]);
        let clipped = without.contains(&u16::MAX);
        let halves = is_part(2, [without, with].map(from_lights));
        assert!(clipped || halves, "{without:?} {with:?}");
    }
}

#[test]
fn filter_mock_lets_light_through_all_surfaces() {
    let brighter = pairs::<{ TRUE | Veil::BITS }>().into_iter();
    let mut count = 0;
    for [without, with] in brighter {
        assert!((0..3).all(|k| with[k] >= without[k]), "{with:?}");
        count += usize::from(with != without);
    }
    assert!(count > 0);
}

#[test]
fn miss_mock_paints_the_background() {
    let background = background();
    for [without, with] in pairs::<{ TRUE | Sky::BITS }>() {
        let expected = if without == background {
            [0, 0, u16::MAX]
        } else {
            without
        };
        assert_eq!(with, expected);
    }
}

#[test]
fn bounce_mock_sends_a_ray_per_hit() {
    const MOCK: u32 = TRUE | Pane::BITS;
    let (_, before) = picture::<f32, TRUE>(1);
    let (pixels, after) = picture::<f32, MOCK>(1);
    let background = background();
    let (flat, _) = picture::<f32, TRUE>(0);
    let hits = flat.iter().filter(|&&pixel| pixel != background).count() as u64;
    assert_eq!(after.refracted, before.refracted + hits);
    assert_eq!(after.reflected, before.reflected);
    assert_ne!(pixels, picture::<f32, TRUE>(1).0);
}

#[test]
fn pixel_mock_quarters_radiance_before_it_is_limited() {
    let pairs = pairs::<{ TRUE | ToneMap::BITS }>();
    let quarter =
        |[without, with]: [[u16; 3]; 2]| is_part(4, [without, with]) || without.contains(&u16::MAX);
    assert!(pairs.into_iter().all(quarter));
}

#[test]
fn state_mock_is_inherited_by_the_rays_that_wait() {
    // Each ray goes straight on, and through glass only that ray does.
    const MOCK: u32 = TRUE | Pane::BITS | Trail::BITS | Matt::BITS | Tint::BITS;
    let white = |parts: i32| (65_535 * parts / Trail::PARTS) as u16;
    let (alone, _) = picture::<f32, { TRUE | Trail::BITS }>(0);
    assert!(
        alone[0]
            .iter()
            .all(|&channel| channel.abs_diff(white(1)) <= 1)
    );
    let (pixels, _) = picture::<f32, MOCK>(4);
    // Red has no ambient light here: it counts the rays that miss, one, two or more surfaces behind.
    let seen = |parts: i32| {
        pixels
            .iter()
            .any(|[red, ..]| red.abs_diff(white(parts)) <= 1)
    };
    assert!(seen(1) && seen(3), "{pixels:?}");
}

#[test]
fn mocks_act_in_fixed_point_too() {
    const MOCK: u32 = TRUE | Sky::BITS | ToneMap::BITS;
    let (pixels, _) = picture::<Fixed, MOCK>(0);
    let [red, green, blue] = pixels[0];
    assert_eq!([red, green], [0, 0]);
    assert!(blue.abs_diff(u16::MAX / 4) <= 1, "{blue}");
}
