//! The t, the normal and the error bound of every shape against arithmetic of 320 bits.

use glam::DVec3;
use gridel_core::{List, NoCount, Number, Ray};
use gridel_host::blob::Blob;
use gridel_host::scene::Shape;
use gridel_tests::bounds::{CROSSING, NORMAL, allowed, length_step, ratio_step};
use gridel_tests::cases::{SHAPES, cases, shape_of};
use gridel_tests::every_format;
use gridel_tests::exact::Real;
use gridel_tests::query::{UnitRay, closest, depart, point_of};
use gridel_tests::random::Random;
use gridel_tests::scenes;
use gridel_tests::solid::{Line, Solid};

/// A blob of a shape whose lattice is known: one unit is one scene unit, and its zero is the
/// scene's. Two specks at the ends of the lattice see to that.
fn blob_of(solid: &Solid) -> Blob {
    let speck = |corner: f64| Shape::Sphere {
        center: DVec3::splat(corner),
        radius: 1.0 / 256.0,
    };
    let blob = scenes::blob(
        &scenes::of([shape_of(solid), speck(-32_764.0), speck(32_764.0)]),
        24,
    );
    let scene = blob.scene().expect("a scene");
    let header = scene.header();
    assert_eq!((header.unit_exponent, header.origin), (0, [0.0; 3]));
    blob
}

/// Errors that are tried, in steps; the last stands for anything.
const LADDER: [f64; 15] = [
    0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 32.0, 64.0, 1024.0, 1e9,
];

/// Whether an answer is right for a shape that differs by no more than `error`.
fn is_right(solid: &Solid, line: &Line, answer: Option<f64>, error: f64) -> bool {
    let zero = Real::of(0.0);
    let grown = solid.span(line, &Real::of(error));
    let shrunk = solid.span(line, &Real::of(-error));
    let Some(t) = answer.map(Real::of) else {
        return shrunk.is_none_or(|(_, leave)| leave <= zero);
    };
    let Some((first, last)) = grown else {
        return false;
    };
    let (enter, leave) = shrunk.unwrap_or((last.clone(), first.clone()));
    let entering = first <= t && t <= enter;
    let leaving = leave <= t && t <= last && !first.is_positive();
    entering || leaving
}

/// The least error on the ladder that explains an answer.
fn error_of(solid: &Solid, line: &Line, answer: Option<f64>, step: f64) -> f64 {
    let explains = |&&error: &&f64| is_right(solid, line, answer, error * step);
    *LADDER.iter().find(explains).unwrap_or(&f64::INFINITY)
}

/// The worst of a shape in one format.
#[derive(Default)]
struct Worst {
    rays: usize,
    hits: usize,
    crossing: f64,
    flag: f64,
    normal: f64,
    point: f64,
    ray: String,
}

fn judge<N: Number>(shape: usize, count: usize, rays_each: usize) {
    let name = SHAPES[shape];
    let mut worst = Worst::default();
    for case in cases(100 + shape as u64, shape, count, rays_each) {
        let blob = blob_of(&case.solid);
        let scene = blob.scene().expect("a scene");
        for (origin, slope) in case.rays {
            let ray = UnitRay::new(origin, slope);
            let Some(ready) = ray.ready::<N>(&scene) else {
                panic!("{ray:?} is refused");
            };
            assert_eq!(
                ready.slope().map(N::ratio_to_f64),
                slope.map(|x| x + 0.0),
                "{ray:?}"
            );
            let hit = closest::<N, List>(&scene, &ready, &mut NoCount);
            if hit.is_some_and(|hit| hit.primitive != 0) {
                continue;
            }
            worst.rays += 1;
            let line = Line::new(origin, slope);
            let t = hit.map(|hit| N::far_to_f64(hit.t));
            assert!(t.is_none_or(|t| t >= 0.0), "behind: {ray:?}");
            let place = origin.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            let magnitude = place.max(case.solid.extent()).max(t.unwrap_or(0.0));
            let step = length_step::<N>(magnitude);
            let error = error_of(&case.solid, &line, t, step);
            if error > worst.crossing {
                worst.crossing = error;
                worst.ray = format!("{} {:?} {ray:?} gives {t:?}", case.class, case.solid);
            }
            let exists = case
                .solid
                .span(&line, &Real::of(0.0))
                .is_some_and(|(_, leave)| !leave.is_negative());
            if exists != t.is_some() {
                worst.flag = worst.flag.max(error);
            }
            let Some(hit) = hit else { continue };
            worst.hits += 1;
            let point = point_of(&hit);
            assert!(point.iter().all(|x| x.is_finite()));
            let normal = hit.normal.map(N::ratio_to_f64);
            let off = case
                .solid
                .normals(point)
                .into_iter()
                .map(|(exact, condition)| {
                    let apart = [0, 1, 2].map(|k| (&exact[k] - Real::of(normal[k])).to_f64().abs());
                    apart.into_iter().fold(0.0, f64::max) / (ratio_step::<N>() * condition)
                });
            worst.normal = worst.normal.max(off.fold(f64::INFINITY, f64::min));
            // How far the surface is from the point, as a part of the bound that comes with it:
            // along the normal there is a surface within the bound.
            let bound = hit.error.length_to_f64();
            let beside = Line::new(point, normal);
            let reach = case.solid.span(&beside, &Real::of(0.0));
            let apart = reach.map_or(f64::INFINITY, |(enter, leave)| {
                enter.to_f64().abs().min(leave.to_f64().abs())
            });
            if apart > bound {
                // Where the surface is missed by a hair's breadth, at a rim.
                let grown = case.solid.span(&beside, &Real::of(bound));
                let near = grown.is_some_and(|(enter, leave)| {
                    enter.to_f64().abs().min(leave.to_f64().abs()) <= 2.0 * bound
                });
                assert!(
                    near,
                    "{name}: {ray:?}: {apart:e} from the surface, {bound:e} allowed"
                );
            } else {
                worst.point = worst.point.max(apart / bound);
            }
        }
    }
    let format = N::FORMAT.name();
    eprintln!(
        "{name:9} {format:5}: {:6} rays, {:6} hits; K of t {:5}, of wrong flags {:5}, of normals \
         {:8.2}; points at {:.3} of their bound",
        worst.rays, worst.hits, worst.crossing, worst.flag, worst.normal, worst.point
    );
    let most = allowed::<N>(&CROSSING, name);
    if worst.crossing > most || worst.normal > allowed::<N>(&NORMAL, name) {
        panic!("{name} {format}: {}", worst.ray);
    }
}

#[test]
fn crossings_and_normals_are_as_good_as_the_table_says() {
    let mut failures = Vec::new();
    for shape in 0..SHAPES.len() {
        fn one<N: Number>(shape: usize, failures: &mut Vec<String>) {
            let result = std::panic::catch_unwind(|| judge::<N>(shape, 60, 60));
            failures.extend(
                result
                    .err()
                    .map(|_| format!("{} {}", SHAPES[shape], N::FORMAT.name())),
            );
        }
        every_format!(one(shape, &mut failures));
    }
    assert!(failures.is_empty(), "{failures:?}");
}

/// A ray that leaves a hit on one side or the other does not meet the same surface there.
fn no_self_hits<N: Number>(shape: usize, rays: usize) {
    let flat = matches!(SHAPES[shape], "triangle" | "disc");
    let mut random = Random(77);
    let (mut outside, mut inside) = (0, 0);
    for case in cases(500 + shape as u64, shape, rays / 100, 100) {
        let blob = blob_of(&case.solid);
        let scene = blob.scene().expect("a scene");
        for (origin, slope) in case.rays {
            let ray = UnitRay::new(origin, slope)
                .ready::<N>(&scene)
                .expect("a ray");
            let Some(hit) = closest::<N, List>(&scene, &ray, &mut NoCount) else {
                continue;
            };
            for side in [1.0, -1.0] {
                let normal = hit.normal.map(|x| side * x.ratio_to_f64());
                let mut direction = random.direction();
                let cosine: f64 = (0..3).map(|k| normal[k] * direction[k]).sum();
                // Into the half space of this side; often grazing.
                let lift = if random.one_in(3) {
                    random.unit() * 1e-3
                } else {
                    cosine.abs()
                };
                direction = [0, 1, 2].map(|k| direction[k] + (lift - cosine) * normal[k]);
                let from = depart(&hit, side);
                let ray = UnitRay::new(from, direction)
                    .ready::<N>(&scene)
                    .expect("a ray");
                let again = again::<N>(&scene, &ray, hit.primitive);
                let about = || {
                    format!(
                        "{:?} {origin:?} {slope:?} {hit:?} {side} {direction:?}: {again:?}",
                        case.solid
                    )
                };
                if side > 0.0 || flat {
                    outside += 1;
                    assert!(again.is_none(), "{}", about());
                } else {
                    inside += 1;
                    assert!(again.is_none_or(|front| !front), "{}", about());
                }
            }
        }
    }
    eprintln!(
        "{:9} {:5}: {outside} rays away and {inside} rays through, no self-hit",
        SHAPES[shape],
        N::FORMAT.name()
    );
}

/// The side from which a ray meets a primitive, if it does.
fn again<N: Number>(scene: &gridel_core::Scene<'_>, ray: &Ray<N>, primitive: u32) -> Option<bool> {
    let hit = closest::<N, List>(scene, ray, &mut NoCount)?;
    (hit.primitive == primitive).then_some(hit.front)
}

#[test]
fn no_shape_meets_itself() {
    let mut failures = Vec::new();
    for shape in 0..SHAPES.len() {
        fn one<N: Number>(shape: usize, failures: &mut Vec<String>) {
            let result = std::panic::catch_unwind(|| no_self_hits::<N>(shape, 100_000));
            failures.extend(
                result
                    .err()
                    .map(|_| format!("{} {}", SHAPES[shape], N::FORMAT.name())),
            );
        }
        every_format!(one(shape, &mut failures));
    }
    assert!(failures.is_empty(), "{failures:?}");
}
