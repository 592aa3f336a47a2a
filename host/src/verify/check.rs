//! Traces one ray through every structure in one number format, and tests the properties of the answers.

use super::closed::ClosedMesh;
use super::judge::{GRAZING, Judge, Mismatch, STEPS};
use super::rounded::{Answer, HitId, RoundedRay, step};
use crate::random::Random;
use gridel_core::accel::DynAccel;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::{
    Accel, Format, Hit, List, NoCount, Number, Ray, Scene, Stack, Structure, any_hit, closest_hit,
};

/// A property that holds for every scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Property {
    /// Every structure gives the list's answer, bit for bit.
    Structures,
    /// Any hit and closest hit agree on whether there is a hit.
    AnyHit,
    /// Hits are those of exact arithmetic, where it finds them, within [`STEPS`].
    Answers,
    /// Numbers of a hit are finite, its t lies in the interval, its normal has the length 1.
    Numbers,
    /// A ray that starts at a hit does not hit the same surface again, and one that starts inside of a solid leaves it.
    SelfHits,
    /// A point in shadow by `f64` is not lit in another format.
    Shadows,
    /// No ray leaves a closed mesh unseen.
    Leaks,
}

impl Property {
    /// All of them, in the order of reports.
    pub const ALL: [Self; 7] = [
        Self::Structures,
        Self::AnyHit,
        Self::Answers,
        Self::Numbers,
        Self::SelfHits,
        Self::Shadows,
        Self::Leaks,
    ];

    /// Returns the property in words, for reports.
    pub const fn text(self) -> &'static str {
        match self {
            Property::Structures => "every structure agrees with brute force, bit for bit",
            Property::AnyHit => "any hit and closest hit agree on whether there is a hit",
            Property::Answers => "hits agree with exact arithmetic",
            Property::Numbers => "hits are finite and in the interval; normals have length 1",
            Property::SelfHits => "secondary rays do not hit the surface that they leave",
            Property::Shadows => "every shadow of `f64` is there in the other formats",
            Property::Leaks => "no ray leaves a closed mesh without a hit",
        }
    }
}

/// A violation of a property.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    pub property: Property,
    pub format: Format,
    pub structure: Structure,
    /// The fault, as a clause.
    pub what: String,
}

/// Tests of a property at a hit: not everything can be tested at every hit.
#[derive(Clone, Debug, Default)]
pub struct Tested {
    /// Number of tests.
    pub tests: u64,
    pub faults: Vec<Fault>,
}

/// The answer of one structure.
#[derive(Clone, Copy, Debug)]
pub struct StructureAnswer<N: Number> {
    pub structure: Structure,
    pub hit: Option<Hit<N>>,
    pub any: bool,
}

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

/// Asks one structure.
pub fn ask<N: Number, A: Accel>(scene: &Scene<'_>, ray: &Ray<N>) -> StructureAnswer<N> {
    let mut stack = Stack::<MAX_STACK_DEPTH>::new();
    StructureAnswer {
        structure: A::STRUCTURE,
        hit: closest_hit::<N, A, _>(scene, ray, stack.as_view(), &mut NoCount),
        any: any_hit::<N, A, _>(scene, ray, stack.as_view(), &mut NoCount),
    }
}

/// Asks the list and then every structure that a scene holds.
pub fn ask_all<N: Number>(scene: &Scene<'_>, ray: &Ray<N>) -> Vec<StructureAnswer<N>> {
    let list = ask::<N, List>(scene, ray);
    let others = Structure::ALL
        .into_iter()
        .filter(|&structure| structure != Structure::List)
        .filter_map(|structure| {
            let chosen = scene.choose(structure)?;
            Some(StructureAnswer {
                structure,
                ..ask::<N, DynAccel>(&chosen, ray)
            })
        });
    std::iter::once(list).chain(others).collect()
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
    let mut outcome = Outcome::default();
    let Some(list) = answers.first() else {
        return outcome;
    };
    let mut fault = |property, structure, what: String| {
        outcome.faults.push(Fault {
            property,
            format: N::FORMAT,
            structure,
            what,
        });
    };
    let described = |hit: &Option<Hit<N>>| match hit {
        Some(hit) => format!(
            "{} at {:?}",
            HitId::of(hit).written(scene),
            N::far_to_f64(hit.t)
        ),
        None => String::from("nothing"),
    };
    for other in answers {
        if bits(&other.hit) != bits(&list.hit) {
            let what = format!(
                "hits {}, brute force {}",
                described(&other.hit),
                described(&list.hit)
            );
            fault(Property::Structures, other.structure, what);
        }
        if other.any != other.hit.is_some() {
            let what = format!(
                "any hit says {}, and the closest hit is {}",
                other.any,
                described(&other.hit)
            );
            fault(Property::AnyHit, other.structure, what);
        }
    }
    let rounded = RoundedRay::of(ray);
    let hit = list.hit.as_ref();
    if let Some(what) = hit.and_then(|hit| numbers(&rounded, judge, hit)) {
        fault(Property::Numbers, list.structure, what);
    }

    let answer = list.hit.as_ref().map(|hit| Answer {
        t: N::far_to_f64(hit.t) - rounded.moved,
        hit: HitId::of(hit),
    });
    let reference = rounded.in_f64(scene);
    let reference = reference.and_then(|ray| ask::<f64, List>(scene, &ray).hit);
    let close = match (answer, reference) {
        (None, None) => true,
        // A hit where a ray enters a solid is not compared with one where it leaves.
        (Some(answer), Some(reference))
            if answer.hit == HitId::of(&reference)
                && list.hit.is_some_and(|hit| hit.front == reference.front) =>
        {
            let extent = reference.point.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let start = rounded.start.iter().fold(extent, |m, x| m.max(x.abs()));
            let reach = start.max(reference.t.abs()).max(rounded.moved.abs());
            let solid = judge.solid(answer.hit);
            let at_solid = solid.map_or(0.0, |it| it.step(N::FORMAT, &rounded, reference.t));
            let step = step(N::FORMAT, reach).max(at_solid);
            let normals = list.hit.iter().map(|hit| hit.normal.map(N::ratio_to_f64));
            let mut normals = normals.chain([reference.normal]);
            outcome.grazes = normals.any(|normal| rounded.cosine(normal).abs() < GRAZING);
            outcome.error = (answer.t - reference.t).abs() / step;
            outcome.error <= STEPS
        }
        _ => false,
    };
    if !close || control {
        outcome.judged = true;
        if let Err(wrong) = judge.check(N::FORMAT, &rounded, answer) {
            let what = match wrong {
                Mismatch::NotThere => {
                    format!(
                        "hits {}, which exact arithmetic misses",
                        described(&list.hit)
                    )
                }
                Mismatch::Missed { hit, t } => format!(
                    "hits {}; by exact arithmetic it hits {} before, at {:?}",
                    described(&list.hit),
                    hit.written(scene),
                    t + rounded.moved
                ),
            };
            outcome.faults.push(Fault {
                property: Property::Answers,
                format: N::FORMAT,
                structure: list.structure,
                what,
            });
        }
    }
    outcome
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
        tested.faults.push(Fault {
            property: Property::SelfHits,
            format: N::FORMAT,
            structure: Structure::List,
            what: format!(
                "the ray that goes on from {}, from {from:?} along {direction:?} (in units), {what}",
                itself.written(scene)
            ),
        });
    }
    tested
}

/// Follows a ray that starts inside of a closed mesh until it hits the mesh. A ray that never does is a fault.
pub fn sealed<N: Number, A: Accel>(
    scene: &Scene<'_>,
    judge: &Judge,
    mesh: &ClosedMesh,
    origin: [f64; 3],
    direction: [f64; 3],
) -> Option<Fault> {
    /// Surfaces of other objects that a ray is followed through.
    const MOST: usize = 256;
    let mut tmin = 0.0;
    // Where, and how far the ray was moved on.
    let mut passed: Vec<(f64, f64)> = Vec::new();
    let whole = Ray::<N>::from_f64(scene.bounds(), origin, direction, 0.0, f64::INFINITY).ok()?;
    let rounded = RoundedRay::of(&whole);
    for _ in 0..MOST {
        let ray =
            Ray::<N>::from_f64(scene.bounds(), origin, direction, tmin, f64::INFINITY).ok()?;
        let Some(hit) = ask::<N, A>(scene, &ray).hit else {
            // Where surfaces coincide, only one of them was reported.
            let crosses = |&(t, moved_on): &(f64, f64)| {
                let t = t - rounded.moved;
                mesh.hits(scene)
                    .any(|hit| judge.crosses(N::FORMAT, hit, &rounded, t, moved_on))
            };
            let hidden = passed.iter().any(crosses);
            return (!hidden).then(|| Fault {
                property: Property::Leaks,
                format: N::FORMAT,
                structure: A::STRUCTURE,
                what: format!("leaves the closed mesh of {mesh} without a hit"),
            });
        };
        if mesh.holds(&hit) {
            return None;
        }
        let t = N::far_to_f64(hit.t);
        let on = 4.0 * step(N::FORMAT, t.abs().max(1.0)).max(hit.error.length_to_f64());
        passed.push((t, on));
        tmin = t + on;
    }
    None
}
