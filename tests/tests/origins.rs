//! Origins and directions of every magnitude (hard cases F: origins at 10^k, directions of 10^-k).
//!
//! What is answered is right within the bounds of a hit in the scene, not of the distance that the ray
//! comes from; t is rounded once more. What is not answered is rejected with a reason. Nothing else.

use glam::DVec3;
use gridel_core::format::limits::{FARTHEST, MAX_RAY_DEPTH, MAX_STACK_DEPTH};
use gridel_core::render::RenderError;
use gridel_core::{
    DualSplit, Effects, Fixed, Format, List, NoCount, Number, Pencil, Ray, RayError, Renderer,
    Scene, Settings, Structure, Workspace,
};
use gridel_host::blob::Blob;
use gridel_host::compile::{Options, compile};
use gridel_host::scene::{Camera, Light, Scene as SceneFile, Shape};
use gridel_host::shape::Sphere;
use gridel_host::trace::{Frame, Query, Rejection, SceneHit, SceneRay, trace};
use gridel_host::verify::judge::{Crossings, Judge, step};
use gridel_tests::effort::part_of;
use gridel_tests::every_format;
use gridel_tests::exact::Line;
use gridel_tests::exact::{Real, Vector, along, minus, scaled, vector};
use gridel_tests::query::{HitBits, closest, held, through};
use gridel_tests::random::Random;
use gridel_tests::scenes;

/// The farthest coordinate that is answered, in units.
const LIMIT: f64 = (FARTHEST >> 13) as f64;

/// A ball of radius 1, in a blob with every structure.
fn ball(center: DVec3) -> Blob {
    let radius = 1.0;
    scenes::compact_blob(&scenes::of([Shape::Sphere(Sphere { center, radius })]), 16)
}

/// Every structure's answers to a ray in scene units, in every format; all must be the same.
fn answers(scene: &Scene<'_>, ray: SceneRay) -> [(Format, SceneHit, Option<Rejection>); 3] {
    Format::ALL.map(|format| {
        let ask = |structure: Structure, any: bool| {
            let (mut hits, query) = (
                [SceneHit::MISS],
                Query {
                    format,
                    structure,
                    any,
                },
            );
            let rejections = trace(scene, &[ray], query, &mut hits);
            assert_eq!(rejections.count, usize::from(hits[0].is_rejected()));
            (hits[0], rejections.first.map(|(_, why)| why))
        };
        let (hit, why) = ask(Structure::List, false);
        for structure in held(scene) {
            let (other, other_why) = ask(structure, false);
            let same = other == hit || other.is_rejected() && hit.is_rejected();
            assert!(
                same && why == other_why,
                "{} {structure:?} {ray:?}",
                format.name()
            );
            let (any, any_why) = ask(structure, true);
            // Of any hit no t is told that could leave its range.
            if !matches!(any_why.or(why), Some(Rejection::Multiple(_))) {
                assert_eq!(any_why, why);
                assert_eq!(any.object == 0, hit.object == 0, "{structure:?} {ray:?}");
            }
        }
        (format, hit, why)
    })
}

fn endless(origin: DVec3, direction: DVec3) -> SceneRay {
    let (tmin, tmax) = (0.0, f64::INFINITY);
    SceneRay {
        origin,
        tmin,
        direction,
        tmax,
    }
}

/// What t may be off by: its own rounding, and the ball's.
fn slack(format: Format, t: f64, unit: f64) -> f64 {
    let rounding = match format {
        Format::Fixed => 0.0,
        Format::F32 => f64::powi(2.0, -23),
        Format::F64 => f64::powi(2.0, -52),
    };
    t * rounding.max(f64::powi(2.0, -52)) + 8.0 * step(format, 65_536.0) * unit
}

/// Issue 16: from 1e11 `fixed` answered t 6.87e10, from 1e20 a negative one; `f32` infinity, of an object.
#[test]
fn origins_at_every_power_of_ten_are_answered_or_rejected() {
    let blob = ball(DVec3::ZERO);
    let scene = blob.scene().expect("a scene");
    let unit = f64::powi(2.0, scene.header().unit_exponent.into());
    let (mut answered, mut rejected) = (0, 0);
    for k in 1..=300 {
        for axis in 0..3 {
            for sign in [1.0, -1.0] {
                let away = f64::powi(10.0, k) * sign;
                let axis = DVec3::AXES[axis];
                for (format, hit, why) in answers(&scene, endless(axis * away, -axis * sign)) {
                    let t = away.abs() - 1.0;
                    if away.abs() > LIMIT * unit {
                        assert_eq!(why, Some(RayError::Distance.into()), "1e{k}");
                        rejected += 1;
                    } else {
                        let off = (hit.t - t).abs();
                        assert!(off <= slack(format, t, unit), "{format:?} 1e{k}: {hit:?}");
                        assert_eq!(
                            (hit.object, hit.normal),
                            (0, (axis * sign).as_vec3().into())
                        );
                        answered += 1;
                    }
                }
                // Away from the ball, and past it by far.
                let sideways = DVec3::new(axis.y, axis.z, axis.x) * away;
                for ray in [endless(axis * away, axis * sign), endless(sideways, axis)] {
                    for (_, hit, why) in answers(&scene, ray) {
                        assert!(hit == SceneHit::MISS || why == Some(RayError::Distance.into()));
                    }
                }
            }
        }
    }
    // From 2^20 times the ball's width, and from no nearer than promised.
    assert!(LIMIT * unit >= 2.0 * f64::powi(2.0, 20));
    assert!(
        answered >= 6 * 3 * 6 && rejected >= 6 * 3 * 290,
        "{answered} {rejected}"
    );
}

#[test]
fn directions_of_every_length_are_answered_or_leave_the_range_of_t() {
    let blob = ball(DVec3::new(0.25, -0.5, 0.0));
    let scene = blob.scene().expect("a scene");
    let unit = f64::powi(2.0, scene.header().unit_exponent.into());
    let mut rejected = 0;
    let powers = (-323..=307).map(|k| format!("1e{k}").parse().expect("a number"));
    let ends = [5e-324, 1e-323, f64::MIN_POSITIVE, 1.7e308, f64::MAX, 2.0];
    for length in powers.chain(ends) {
        let length: f64 = length;
        for origin in [3.0, 1000.0] {
            let ray = endless(
                DVec3::new(0.25, -0.5, origin),
                DVec3::new(0.0, 0.0, -length),
            );
            // 1 from the middle; exact.
            let (distance, t) = (origin - 1.0, (origin - 1.0) / length);
            for (format, hit, why) in answers(&scene, ray) {
                if t > f64::MAX {
                    assert_eq!(why, Some(Rejection::Multiple("short")), "{length:e}");
                    rejected += 1;
                    continue;
                }
                let off = hit.t * length - distance;
                let denormal = f64::powi(2.0, -1074) * length;
                let bound = slack(format, distance, unit) + denormal;
                assert!(off.abs() <= bound, "{format:?} {length:e}: {hit:?}");
                assert_eq!((hit.object, hit.normal), (0, [0.0, 0.0, 1.0]));
            }
        }
    }
    assert!(rejected > 3 * 2 * 10, "{rejected}");
    // Slanted, so that a short direction has few digits in any component.
    for (direction, met) in [
        ([5e-324, 0.0, -5e-324], false),
        ([0.0, 0.0, -5e-324], true),
        ([5e-324, -1e-323, -1.6e-322], true),
        ([1.7e308, 0.0, -1.7e308], false),
        ([1e307, -2e307, -1.7e308], true),
    ] {
        let ray = endless(DVec3::new(0.0, 0.0, 4.0), DVec3::from_array(direction));
        for (format, hit, why) in answers(&scene, ray) {
            let answer = if met {
                hit != SceneHit::MISS
            } else {
                hit == SceneHit::MISS
            };
            assert!(answer, "{format:?} {direction:?}: {hit:?} {why:?}");
        }
    }
}

/// In a scene so small that t in multiples of the longest directions has few digits.
#[test]
fn t_with_too_few_digits_is_rejected() {
    let (center, radius) = (DVec3::ZERO, 1e-200);
    let blob = scenes::compact_blob(&scenes::of([Shape::Sphere(Sphere { center, radius })]), 16);
    let scene = blob.scene().expect("a scene");
    for (length, why) in [
        (1e-200, None),
        (1.0, None),
        (1e100, None),
        (1e123, Some(Rejection::Multiple("long"))),
        (1e307, Some(Rejection::Multiple("long"))),
    ] {
        let ray = endless(DVec3::Z * 4e-200, DVec3::NEG_Z * length);
        for (format, hit, found) in answers(&scene, ray) {
            assert_eq!(found, why, "{length:e}");
            if why.is_none() {
                let off = hit.t * length / 3e-200 - 1.0;
                assert!(off.abs() < 1e-4, "{format:?} {length:e}: {hit:?}");
            }
        }
    }
}

/// A ray from far away in exact arithmetic, from where the core moved it to.
fn exact_line(origin: [f64; 3], direction: [f64; 3], major: usize, plane: f64) -> (Line, Real) {
    let along_major = Real::of(direction[major]);
    let slope: Vector = scaled(&vector(direction), &(Real::of(1.0) / along_major.abs()));
    let moved = (Real::of(plane) - Real::of(origin[major])) / &slope[major];
    let origin = along(&vector(origin), &moved, &slope);
    (Line { origin, slope }, moved)
}

/// Puts rays from 10^k units to all structures and judges them by the line that was given.
fn judge_far_rays<N: Number>(
    scene: &Scene<'_>,
    judge: &Judge,
    primitives: u32,
    rays: usize,
) -> f64 {
    let mut random = Random(0xfa7);
    let bounds = scene.bounds().0.map(|side| side.map(f64::from));
    let (mut hits, mut worst) = (0, 0.0_f64);
    for number in 0..rays {
        let target = bounds.map(|[low, high]| low + (high - low) * random.unit());
        // From where all numbers are near to the limit.
        let distance = f64::powf(10.0, 4.0 + 7.0 * number as f64 / rays as f64).min(0.99 * LIMIT);
        let toward = random.direction();
        let largest = toward.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let toward = toward.map(|x| x / largest);
        let origin = [0, 1, 2].map(|k| target[k] - distance * toward[k]);
        let direction = [0, 1, 2].map(|k| target[k] - origin[k]);
        let length = f64::powi(10.0, random.within(-290, 290)) / distance;
        let direction = direction.map(|x| x * length);
        let ray = Ray::<N>::from_f64(scene.bounds(), origin, direction, 0.0, f64::INFINITY);
        let ray = ray.expect("a ray");
        let hit = closest::<N, List>(scene, &ray, &mut NoCount);
        for structure in held(scene) {
            let (other, any) = through::<N>(structure, scene, &ray);
            let same = other.as_ref().map(HitBits::of) == hit.as_ref().map(HitBits::of);
            assert!(
                same && any == hit.is_some(),
                "{structure:?} {origin:?} {direction:?}"
            );
        }
        let major = ray.major_axis();
        let plane = ray.start()[major].length_to_f64();
        let (line, moved) = exact_line(origin, direction, major, plane);
        let about = || format!("{} {origin:?} {direction:?}: {hit:?}", N::FORMAT.name());
        let begin = if moved.is_negative() {
            -&moved
        } else {
            Real::of(0.0)
        };
        // The slope is rounded, and then all that the kernels round.
        let off = |extent: f64| 16.0 * step(N::FORMAT, extent.max(32_768.0));
        let mut end = Real::of(1e300);
        if let Some(hit) = hit {
            hits += 1;
            // From the start along the major axis, which is exact.
            let sign = line.slope[major].to_f64();
            let local = (hit.point[major].length_to_f64() - plane) * sign;
            let solid = judge.solid(hit.primitive).expect("a primitive");
            let there = |steps: f64| {
                let within = steps * off(solid.extent()) / 16.0;
                Crossings::new(solid, &line, within).may_be_met_at(&Real::of(local), &begin)
            };
            assert!(there(16.0), "{}", about());
            let needed = (1..=16).map(f64::from).find(|&steps| there(steps));
            worst = worst.max(needed.unwrap_or(f64::INFINITY));
            let t = N::far_to_f64(hit.t);
            let exact = (&moved + Real::of(local)).to_f64();
            let rounding = match N::FORMAT {
                Format::Fixed => 2.0 * step(Format::Fixed, 0.0),
                format => 2.0 * step(format, exact),
            };
            assert!(
                (t - exact).abs() <= rounding + off(0.0),
                "{} {exact}",
                about()
            );
            end = Real::of(local - off(solid.extent()));
        }
        for primitive in 0..primitives {
            let Some(solid) = judge.solid(primitive) else {
                continue;
            };
            let missed = Crossings::new(solid, &line, off(solid.extent())).are_met_by(&begin);
            let missed = missed.filter(|t| *t < end);
            assert!(missed.is_none(), "{} misses {primitive}", about());
        }
    }
    assert!(3 * hits > rays, "{hits} of {rays}");
    worst
}

/// What is answered is right for the ray that was given, not for one beside it.
#[test]
fn far_rays_keep_their_place() {
    let blob = scenes::compact_blob(&scenes::soup(0x0516, 24, 0.6), 24);
    let scene = blob.scene().expect("a scene");
    let judge = Judge::of(&scene);
    let (primitives, rays) = (scene.header().primitives, part_of(150, 10_000));
    let worst = [
        judge_far_rays::<Fixed>(&scene, &judge, primitives, rays),
        judge_far_rays::<f32>(&scene, &judge, primitives, rays),
        judge_far_rays::<f64>(&scene, &judge, primitives, rays),
    ];
    eprintln!("far rays are off by {worst:?} steps at worst");
}

/// Where the lattice's zero has as many digits as a number, and the difference to a far origin has more.
#[test]
fn far_rays_of_scenes_off_centre_keep_their_place() {
    let blob = ball(DVec3::new(0.1, -1.0 / 3.0, 123.456_789));
    let scene = blob.scene().expect("a scene");
    let (frame, header) = (Frame::of(&scene), scene.header());
    let unit = f64::powi(2.0, header.unit_exponent.into());
    let mut random = Random(0x0ff);
    let mut worst = 0.0_f64;
    for number in 0..part_of(5000, 500_000) {
        let toward = DVec3::from_array(random.direction());
        let target = DVec3::from_array(header.origin) + DVec3::splat(random.signed());
        let origin = target - toward * f64::powf(2.0, 30.0 * random.unit() - 8.0);
        let direction = (target - origin) * f64::powi(10.0, [0, 300, -300][number % 3]);
        let made = frame.ray::<f64>(&scene, &endless(origin, direction));
        let Ok((ray, _)) = made else {
            let apart = (origin - target).abs().max_element() / unit;
            assert!(apart > LIMIT - 65_536.0, "{made:?}");
            continue;
        };
        let from = [0, 1, 2]
            .map(|k| (Real::of(origin[k]) - Real::of(header.origin[k])) * Real::of(1.0 / unit));
        let major = ray.major_axis();
        let slope = scaled(
            &vector(direction.to_array()),
            &(Real::of(1.0) / Real::of(direction[major]).abs()),
        );
        let start = vector(ray.start());
        let moved = (&start[major] - &from[major]) / &slope[major];
        let apart = minus(&start, &along(&from, &moved, &slope));
        for x in apart {
            worst = worst.max(x.abs().to_f64() / step(Format::F64, 65_536.0));
        }
    }
    eprintln!("off by {worst} steps at worst");
    assert!(worst <= 20.0, "{worst}");
}

/// The start of a ray whose numbers are those of its own format.
fn native_starts<N: Number>() {
    let blob = ball(DVec3::ZERO);
    let scene = blob.scene().expect("a scene");
    let mut random = Random(0x9a71);
    let mut worst = 0.0_f64;
    let mut within = 0;
    for number in 0..part_of(20_000, 2_000_000) {
        let distance = f64::powf(2.0, 17.0 + random.unit() * 19.9);
        let toward = random.direction();
        let target = [0; 3].map(|_| random.signed() * 3e4);
        // As the format has it.
        let native = |x: f64| N::far_from_f64(x);
        let origin = [0, 1, 2].map(|k| native(target[k] - distance * toward[k]));
        let from = origin.map(N::far_to_f64);
        let length = match (N::FORMAT, number % 4) {
            (_, 0) => 1.0,
            (Format::Fixed, exponent) => f64::powi(2.0, 3 * exponent as i32 - 6),
            (Format::F32, _) => f64::powi(10.0, random.within(-38, 24)) / distance * 1e5,
            (Format::F64, _) => f64::powi(10.0, random.within(-300, 290)),
        };
        let direction = [0, 1, 2].map(|k| native((target[k] - from[k]) * length));
        let given = direction.map(N::far_to_f64);
        let (zero, end) = (N::Wide::default(), N::far(1 << 60));
        let ray = Ray::<N>::new(scene.bounds(), origin, direction, zero, end).expect("a ray");
        let pencil = Pencil::<N>::new(scene.bounds(), origin).expect("a pencil");
        let shared = pencil.ray(direction).expect("a ray");
        assert_eq!(format!("{ray:?}"), format!("{shared:?}"));
        let [tmin, tmax] = ray.interval();
        if tmax < tmin {
            continue;
        }
        within += 1;
        let major = ray.major_axis();
        let start = ray.start().map(N::length_to_f64);
        let (line, moved) = exact_line(from, given, major, start[major]);
        let apart = minus(&vector(start), &line.origin);
        let apart = apart
            .iter()
            .fold(0.0_f64, |most, x| most.max(x.abs().to_f64()));
        let steps = apart / step(N::FORMAT, 32_768.0);
        // Of a ray from near by, the way to the box is rounded with its slope.
        let is_far = N::far_to_f64(ray.moved()) > 3.0 * 32_767.0;
        let most = if is_far { 2.0 } else { 5.0 };
        assert!(
            steps <= most,
            "{from:?} {given:?}: {start:?}, off by {steps}"
        );
        if is_far {
            worst = worst.max(steps);
        }
        let (t, exact) = (N::far_to_f64(ray.moved()), moved.to_f64());
        assert!((t - exact).abs() <= step(N::FORMAT, exact), "{t} {exact}");
    }
    assert!(within > 10_000, "{within}");
    eprintln!(
        "{}: starts are off by {worst} steps at worst",
        N::FORMAT.name()
    );
}

#[test]
fn starts_are_right_in_the_rays_own_format() {
    every_format!(native_starts());
}

/// At the limit and one step beyond it, on every axis.
fn limits<N: Number>() {
    let blob = ball(DVec3::ZERO);
    let scene = blob.scene().expect("a scene");
    let most = N::far(FARTHEST);
    let beyond = match N::FORMAT {
        Format::Fixed => N::far(FARTHEST + 1),
        Format::F32 => N::far_from_f64(f64::from((LIMIT as f32).next_up())),
        Format::F64 => N::far_from_f64(LIMIT.next_up()),
    };
    let zero = N::Wide::default();
    let extremes = [N::far(i64::MAX), N::far(i64::MIN + 1), N::far(i64::MIN)];
    for axis in 0..3 {
        let make = |x: N::Wide, forward: bool| {
            let (mut origin, mut direction) = ([zero; 3], [zero; 3]);
            origin[axis] = x;
            direction[axis] = N::far(if forward { 1 << 13 } else { -1 << 13 });
            let ray = Ray::<N>::new(scene.bounds(), origin, direction, zero, N::far(1 << 60));
            let pencil = Pencil::<N>::new(scene.bounds(), origin);
            assert_eq!(ray.as_ref().err(), pencil.as_ref().err());
            ray
        };
        for forward in [true, false] {
            let farthest = if forward { -most } else { most };
            let ray = make(farthest, forward).expect("a ray");
            let hit = closest::<N, List>(&scene, &ray, &mut NoCount).expect("a hit");
            let radius = f64::powi(2.0, -i32::from(scene.header().unit_exponent));
            let off = N::far_to_f64(hit.t) - (LIMIT - radius);
            assert!(off.abs() <= 8.0 * step(N::FORMAT, LIMIT), "{hit:?}");
            assert!(make(-farthest, forward).is_ok());
            let mut wrong = vec![beyond, -beyond];
            wrong.extend(extremes);
            for x in wrong {
                assert_eq!(make(x, forward).err(), Some(RayError::Distance));
            }
        }
    }
    // However long an interval is.
    for tmin in extremes.into_iter().chain([zero]) {
        for tmax in extremes.into_iter().chain([zero]) {
            for x in [-most, most, zero, N::far(5 << 28)] {
                let (origin, direction) = ([zero, zero, x], [zero, zero, N::far(1)]);
                let ray = Ray::<N>::new(scene.bounds(), origin, direction, tmin, tmax);
                let Ok(ray) = ray else {
                    assert!(tmin > tmax);
                    continue;
                };
                let hit = closest::<N, List>(&scene, &ray, &mut NoCount);
                let (backward, forward) = (tmin < zero, tmax > zero);
                // The ball lies ahead, around the origin, or behind.
                let expected = if x < zero {
                    tmin <= zero && forward
                } else if x == zero {
                    tmin <= zero && forward || backward && tmax == zero
                } else {
                    backward && tmax >= zero
                };
                assert_eq!(hit.is_some(), expected, "{tmin:?} {tmax:?} {x:?}");
            }
        }
    }
}

#[test]
fn origins_beyond_the_limit_are_rejected() {
    every_format!(limits());
}

/// A picture of 24 by 24 pixels of a ball of radius 1 from so many times its radius, through a lens that
/// fills the picture with it.
fn picture<N: Number>(away: f64) -> Result<Vec<[u16; 3]>, RenderError> {
    let (center, radius) = (DVec3::ZERO, 1.0);
    let mut scene = scenes::of([Shape::Sphere(Sphere { center, radius })]);
    let direction = DVec3::new(-0.3, -0.8, -0.6);
    scene.lights = vec![Light::Directional {
        direction,
        color: [1.0; 3],
    }];
    rendered::<N>(&mut scene, away)
}

fn rendered<N: Number>(scene: &mut SceneFile, away: f64) -> Result<Vec<[u16; 3]>, RenderError> {
    scene.camera = Some(Camera {
        eye: DVec3::new(0.48, 0.6, 0.64) * away,
        target: DVec3::ZERO,
        up: DVec3::Y,
        fov_degrees: 2.0 * (1.25 / away).atan().to_degrees(),
    });
    let options = Options {
        structures: vec![Structure::DualSplit],
        ..Options::default()
    };
    let blob = compile(scene, &options).expect("compiles").blob;
    let scene = blob.scene().expect("a scene");
    let settings = Settings {
        width: 24,
        height: 24,
        ..Settings::of(&scene)
    };
    let renderer = Renderer::<N, DualSplit, { Effects::ALL.0 }>::with_settings(&scene, settings)?;
    let mut space = Box::new(Workspace::<N, MAX_STACK_DEPTH, { MAX_RAY_DEPTH + 1 }>::new());
    let mut view = space.as_view();
    let pixels = (0..24 * 24).map(|k| renderer.linear(k % 24, k / 24, &mut view, &mut NoCount));
    Ok(pixels.collect())
}

/// An eye in the distance sees what one near by sees through a wider lens, or is told that it cannot.
#[test]
fn far_eyes_see_the_scene_or_are_rejected() {
    fn seen<N: Number>(close: &[[u16; 3]]) -> Vec<Option<usize>> {
        let aways = [1e3, 3e4, 1e6, 4e6];
        let differ = |(a, b): &(&[u16; 3], &[u16; 3])| a[0].abs_diff(b[0]) > 3000;
        let different = |far: Vec<[u16; 3]>| close.iter().zip(&far).filter(differ).count();
        let seen = aways.map(|away| match picture::<N>(away) {
            Ok(far) => Some(different(far)),
            Err(error) => {
                assert_eq!(error, RenderError::Resolution(N::FORMAT));
                None
            }
        });
        eprintln!(
            "{}: {seen:?} pixels differ from {aways:?}",
            N::FORMAT.name()
        );
        seen.to_vec()
    }
    let close = picture::<f64>(300.0).expect("a picture");
    let lit = close.iter().filter(|pixel| pixel[0] > 1000).count();
    assert!(lit > 150, "{lit}");
    let few = |seen: &Option<usize>| seen.is_none_or(|different| different <= 12);
    let [fixed, single, double] = [
        seen::<Fixed>(&close),
        seen::<f32>(&close),
        seen::<f64>(&close),
    ];
    for seen in [&fixed, &single, &double] {
        assert!(seen.iter().all(few), "{seen:?}");
        assert!(seen[0].is_some() && seen[1].is_some());
    }
    assert!(fixed[2].is_some() && double[2].is_some() && single[2].is_none());
}

/// A way through glass that is longer than a length can be: it wrapped, and the glass shone.
#[test]
fn glass_seen_from_inside_from_far_away_absorbs_all() {
    let mut scene = scenes::of([Shape::Mesh {
        vertices: [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]]
            .map(DVec3::from)
            .to_vec(),
        // Its front is turned away.
        triangles: vec![[0, 2, 1]],
    }]);
    scene.background = Some([0.5; 3]);
    let glass = &mut scene.materials[0];
    (glass.transmit, glass.absorption) = ([1.0; 3], [1.0; 3]);
    let [fixed, single, double] = [
        rendered::<Fixed>(&mut scene, 3e3),
        rendered::<f32>(&mut scene, 3e3),
        rendered::<f64>(&mut scene, 3e3),
    ]
    .map(|picture| picture.expect("a picture"));
    let dark = |picture: &[[u16; 3]]| picture.iter().filter(|pixel| pixel[0] < 100).count();
    assert!(dark(&double) > 100, "{}", dark(&double));
    assert_eq!([dark(&fixed), dark(&single)], [dark(&double); 2]);
}
