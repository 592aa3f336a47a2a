//! Rays from far away, judged in exact arithmetic.

use super::answers::endless;
use super::{LIMIT, ball, exact_line};
use glam::DVec3;
use gridel_core::{Fixed, Format, List, NoCount, Number, Ray, Scene};
use gridel_host::shape::rounding::step;
use gridel_host::trace::Frame;
use gridel_host::verify::judge::{Crossings, Judge};
use gridel_host::verify::rounded::HitId;
use gridel_tests::effort::part_of;
use gridel_tests::exact::{Real, along, minus, scaled, vector};
use gridel_tests::query::{HitBits, closest, held, through};
use gridel_tests::random::Random;
use gridel_tests::scenes;

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
            let solid = judge.solid(HitId::of(&hit)).expect("a primitive").solid;
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
            let Some(solid) = judge.solid(HitId::own(primitive)).map(|it| it.solid) else {
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

/// Answers are right for the given ray, not for a neighboring one.
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

/// Tests a lattice whose zero has as many digits as a number; the difference to a far origin has more.
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
