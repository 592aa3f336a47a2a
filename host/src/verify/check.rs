//! Tests the properties of the answers to one ray, in one number format.

use super::ask::{StructureAnswer, ask};
use super::judge::{GRAZING, Judge, Mismatch, STEPS};
use super::property::{Fault, Property};
use super::rounded::{Answer, HitId, RoundedRay};
use crate::shape::rounding::step;
use gridel_core::{Format, Hit, List, Number, Ray, Scene};

/// The result of checking a ray's answers.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    pub faults: Vec<Fault>,
    /// Error of t in steps, against the same ray in double precision.
    pub error: f64,
    /// True if the ray grazes the surface that it hits, see [`GRAZING`].
    pub grazes: bool,
    /// True if exact arithmetic judged it.
    pub judged: bool,
}

/// Tests the properties of answers. The first is brute force's answer. `control` uses exact arithmetic even where
/// nothing seems to be wrong.
pub fn check<N: Number>(
    scene: &Scene<'_>,
    judge: &Judge,
    ray: &Ray<N>,
    answers: &[StructureAnswer<N>],
    control: bool,
) -> Outcome {
    let Some(list) = answers.first() else {
        return Outcome::default();
    };
    let mut faults = agreement(scene, list, answers);
    let rounded = RoundedRay::of(ray);
    let of_list = |property| move |what| Fault::of::<N>(property, list.structure, what);
    let hit = list.hit.as_ref();
    let wrong = hit.and_then(|hit| numbers(&rounded, judge, hit));
    faults.extend(wrong.map(of_list(Property::Numbers)));

    let mut outcome = Outcome::default();
    let is_close = compared(scene, judge, &rounded, hit, &mut outcome);
    if !is_close || control {
        outcome.judged = true;
        let wrong = judged(scene, judge, &rounded, hit);
        faults.extend(wrong.map(of_list(Property::Answers)));
    }
    Outcome { faults, ..outcome }
}

/// Returns the faults of answers that differ from brute force, or where any hit and closest hit differ.
fn agreement<N: Number>(
    scene: &Scene<'_>,
    list: &StructureAnswer<N>,
    answers: &[StructureAnswer<N>],
) -> Vec<Fault> {
    let mut faults = Vec::new();
    for other in answers {
        let hit = || described(scene, other.hit.as_ref());
        let mut fault = |property, what| {
            faults.push(Fault::of::<N>(property, other.structure, what));
        };
        if bits(&other.hit) != bits(&list.hit) {
            let listed = described(scene, list.hit.as_ref());
            let what = format!("hits {}, brute force {listed}", hit());
            fault(Property::Structures, what);
        }
        if other.any != other.hit.is_some() {
            let what = format!(
                "any hit says {}, and the closest hit is {}",
                other.any,
                hit()
            );
            fault(Property::AnyHit, what);
        }
    }
    faults
}

fn described<N: Number>(scene: &Scene<'_>, hit: Option<&Hit<N>>) -> String {
    let text = |hit: &Hit<N>| {
        let t = N::far_to_f64(hit.t);
        format!("{} at {t:?}", HitId::of(hit).written(scene))
    };
    hit.map_or(String::from("nothing"), text)
}

/// The answer of brute force, counted from the start of the rounded ray.
fn answer<N: Number>(ray: &RoundedRay, hit: Option<&Hit<N>>) -> Option<Answer> {
    hit.map(|hit| Answer {
        t: N::far_to_f64(hit.t) - ray.moved,
        hit: HitId::of(hit),
    })
}

/// Returns whether the answer of brute force is close to that in double precision, and notes its error.
fn compared<N: Number>(
    scene: &Scene<'_>,
    judge: &Judge,
    ray: &RoundedRay,
    hit: Option<&Hit<N>>,
    outcome: &mut Outcome,
) -> bool {
    let reference = ray.in_f64(scene);
    let reference = reference.and_then(|ray| ask::<f64, List>(scene, &ray).hit);
    let (hit, reference) = match (hit, reference) {
        (None, None) => return true,
        (Some(hit), Some(reference)) => (hit, reference),
        _ => return false,
    };
    let id = HitId::of(hit);
    // A hit where a ray enters a solid is not compared with one where it leaves.
    if id != HitId::of(&reference) || hit.front != reference.front {
        return false;
    }
    let extent = reference.point.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let start = ray.start.iter().fold(extent, |m, x| m.max(x.abs()));
    let reach = start.max(reference.t.abs()).max(ray.moved.abs());
    let solid = judge.solid(id);
    let at_solid = solid.map_or(0.0, |it| it.step(N::FORMAT, ray, reference.t));
    let step = step(N::FORMAT, reach).max(at_solid);
    let mut normals = [hit.normal.map(N::ratio_to_f64), reference.normal].into_iter();
    outcome.grazes = normals.any(|normal| ray.cosine(normal).abs() < GRAZING);
    let t = N::far_to_f64(hit.t) - ray.moved;
    outcome.error = (t - reference.t).abs() / step;
    outcome.error <= STEPS
}

/// Returns a fault of the answer of brute force by exact arithmetic.
fn judged<N: Number>(
    scene: &Scene<'_>,
    judge: &Judge,
    ray: &RoundedRay,
    hit: Option<&Hit<N>>,
) -> Option<String> {
    let wrong = judge.check(N::FORMAT, ray, answer(ray, hit)).err()?;
    let hit_text = described(scene, hit);
    Some(match wrong {
        Mismatch::NotThere => format!("hits {hit_text}, which exact arithmetic misses"),
        Mismatch::Missed { hit, t } => format!(
            "hits {hit_text}; by exact arithmetic it hits {} before, at {:?}",
            hit.written(scene),
            t + ray.moved
        ),
    })
}

/// A hit to the last bit.
fn bits<N: Number>(hit: &Option<Hit<N>>) -> Option<(HitId, u32, bool, [u64; 8])> {
    hit.as_ref().map(|hit| {
        let [px, py, pz] = hit.point.map(|x| x.length_to_f64().to_bits());
        let [nx, ny, nz] = hit.normal.map(|x| x.ratio_to_f64().to_bits());
        let error = hit.error.length_to_f64().to_bits();
        let t = N::far_to_f64(hit.t).to_bits();
        (
            HitId::of(hit),
            hit.object,
            hit.front,
            [t, px, py, pz, nx, ny, nz, error],
        )
    })
}

/// Returns a fault of the numbers of a hit.
fn numbers<N: Number>(ray: &RoundedRay, judge: &Judge, hit: &Hit<N>) -> Option<String> {
    let t = N::far_to_f64(hit.t);
    let point = hit.point.map(N::length_to_f64);
    let normal = hit.normal.map(N::ratio_to_f64);
    let error = hit.error.length_to_f64();
    if !(t.is_finite() && error.is_finite() && point.iter().chain(&normal).all(|x| x.is_finite())) {
        return Some(format!(
            "t {t:?}, point {point:?}, normal {normal:?}, error {error:?}"
        ));
    }
    let norm = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
    let ulps = match N::FORMAT {
        Format::Fixed => f64::powi(2.0, -28),
        Format::F32 => f64::powi(2.0, -21),
        Format::F64 => f64::powi(2.0, -50),
    };
    if (norm - 1.0).abs() > ulps {
        return Some(format!("the normal {normal:?} has length {norm:?}"));
    }
    // Hits count from the ray's own start, which rounds once more.
    let slack = 2.0 * step(N::FORMAT, t.abs().max(ray.moved.abs()));
    let solid = judge.solid(HitId::of(hit));
    let interval = ray.interval_of(solid.is_none_or(|it| it.solid.is_bounded()));
    let [first, last] = interval.map(|t| t + ray.moved);
    if t < first - slack || t > last + slack {
        return Some(format!("t {t:?} lies outside of {first:?} to {last:?}"));
    }
    None
}
