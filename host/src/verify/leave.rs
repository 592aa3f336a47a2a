//! Secondary rays, which leave the surface that they start at.

use super::ask::ask;
use super::judge::Judge;
use super::property::{Fault, Property, Tested};
use super::rounded::{HitId, RoundedRay};
use crate::random::Random;
use gridel_core::{Hit, List, Number, Ray, Scene, Structure};

/// Returns where a ray starts that leaves a hit on the normal's side, or else on the other.
pub fn depart<N: Number>(scene: &Scene<'_>, hit: &Hit<N>, outward: bool) -> [f64; 3] {
    let start = if outward {
        hit.outside()
    } else {
        hit.inside(scene)
    };
    start.map(N::length_to_f64)
}

/// Lets rays leave a hit on both sides, as the ray loop does. Faults are rays that hit the same surface again, or never
/// leave the solid that they are in.
pub fn leave<N: Number>(
    scene: &Scene<'_>,
    judge: &Judge,
    hit: &Hit<N>,
    random: &mut Random,
) -> Tested {
    let mut tested = Tested::default();
    let itself = HitId::of(hit);
    let Some(placed) = judge.solid(itself) else {
        return tested;
    };
    let solid = placed.solid;
    for outward in [true, false] {
        let sign = if outward { 1.0 } else { -1.0 };
        let normal = hit.normal.map(|x| sign * x.ratio_to_f64());
        let direction = random.direction();
        let cosine: f64 = (0..3).map(|k| normal[k] * direction[k]).sum();
        // Into the half space of this side; often grazing.
        let lift = if random.one_in(3) {
            1e-3 * random.unit()
        } else {
            cosine.abs()
        };
        let direction = [0, 1, 2].map(|k| direction[k] + (lift - cosine) * normal[k]);
        let from = depart(scene, hit, outward);
        let away = outward || solid.is_flat();
        // Where a solid is thinner than the bound, there is no inside to start from.
        if !away && placed.excess(from) > -0.5 * hit.error.length_to_f64() {
            continue;
        }
        let ray = Ray::<N>::from_f64(scene.bounds(), from, direction, 0.0, f64::INFINITY);
        let Ok(ray) = ray else { continue };
        let next = ask::<N, List>(scene, &ray).hit;
        tested.tests += 1;
        let again = next.filter(|next| HitId::of(next) == itself);
        // A ray can hit a shape that is not convex again elsewhere.
        let elsewhere = again.is_some_and(|again| {
            let rounded = RoundedRay::of(&ray);
            let t = N::far_to_f64(again.t) - rounded.moved;
            away && !solid.is_convex()
                && placed.excess(from) > 0.0
                && again.front
                && judge.crosses(N::FORMAT, itself, &rounded, t, 0.0)
        });
        let what = match (again, next) {
            _ if elsewhere => continue,
            // From inside of a solid it is met again, from the inside.
            (Some(again), _) if away || again.front => {
                format!("hits it again at {:?}", N::far_to_f64(again.t))
            }
            (None, None) if !away => String::from("never leaves it"),
            _ => continue,
        };
        let what = format!(
            "the ray that goes on from {}, from {from:?} along {direction:?} (in units), {what}",
            itself.written(scene)
        );
        let fault = Fault::of::<N>(Property::SelfHits, Structure::List, what);
        tested.faults.push(fault);
    }
    tested
}
