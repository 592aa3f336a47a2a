//! Right answers, by arithmetic that owes nothing to the kernels: which primitive a ray hits first,
//! within what a number format may be off by.

use crate::shape::Solid;
use crate::shape::exact::{Line, Real};
use gridel_core::format::limits;
use gridel_core::format::record::UnitBox;
use gridel_core::{Format, Kind, Number, Ray, Scene};

/// How many rounding steps an answer may be off by: the shape that it is right for may be so much
/// larger or smaller.
pub const STEPS: f64 = 8.0;

/// The cosine between a surface's normal and a ray below which the ray grazes: t is off there by more
/// than [`STEPS`] steps if the surface is off by one.
pub const GRAZING: f64 = 1.0 / STEPS;

/// How far it is through a scene at the most, in units.
const FARTHEST: f64 = 131_072.0;

/// How far away shapes without bounds are met at the most, in units.
const FARTHEST_HIT: f64 = (limits::FARTHEST_HIT >> 13) as f64;

/// The step of a format: a sub-step of `fixed`, or the unit of rounding times the largest magnitude
/// among the coordinates of ray, hit and shape.
pub fn step(format: Format, magnitude: f64) -> f64 {
    match format {
        Format::Fixed => f64::powi(2.0, -13),
        Format::F32 => f64::powi(2.0, -24) * magnitude,
        Format::F64 => f64::powi(2.0, -53) * magnitude,
    }
}

/// A ray as the kernels of a format have it, rounded; every number is exact.
#[derive(Clone, Copy, Debug)]
pub struct RoundedRay {
    pub start: [f64; 3],
    pub slope: [f64; 3],
    /// The interval that counts, from `start`.
    pub interval: [f64; 2],
    /// The interval that counts for shapes without bounds.
    pub far_interval: [f64; 2],
    /// The t of `start` as hits count it.
    pub moved: f64,
}

impl RoundedRay {
    pub fn of<N: Number>(ray: &Ray<N>) -> Self {
        let (start, moved) = ray.reference_point();
        let moved = N::far_to_f64(moved);
        Self {
            start: start.map(N::far_to_f64),
            slope: ray.slope().map(N::ratio_to_f64),
            interval: ray.interval().map(N::length_to_f64),
            far_interval: ray.given_interval().map(|t| N::far_to_f64(t) - moved),
            moved,
        }
    }

    /// Returns the ray in double precision.
    pub fn in_f64(&self, scene: &Scene<'_>) -> Option<Ray<f64>> {
        let mut kinds = Kind::ALL.into_iter();
        let bounded = kinds.all(|kind| kind.is_bounded() || scene.count(kind) == 0);
        let [first, last] = self.interval_of(bounded);
        Ray::from_f64(scene.bounds(), self.start, self.slope, first, last).ok()
    }

    /// Returns the interval that counts, from `start`, for shapes with bounds or without.
    pub fn interval_of(&self, bounded: bool) -> [f64; 2] {
        if bounded {
            self.interval
        } else {
            self.far_interval
        }
    }

    /// Returns the cosine of the angle between the ray and a vector of length 1.
    pub fn cosine(&self, unit: [f64; 3]) -> f64 {
        let dot = |v: [f64; 3]| (0..3).map(|k| self.slope[k] * v[k]).sum::<f64>();
        dot(unit) / dot(self.slope).sqrt()
    }

    fn line(&self) -> Line {
        Line::new(self.start, self.slope)
    }

    fn magnitude(&self, t: f64) -> f64 {
        largest(self.start).max(t.abs()).max(self.moved.abs())
    }

    /// The step of a format at a shape. A shape without bounds may be met nearer to where a ray begins far away than to
    /// its start; slopes are rounded on the way between them.
    pub fn step(&self, format: Format, t: f64, solid: &Solid) -> f64 {
        let near = step(format, self.magnitude(t).max(solid.extent()));
        let from_origin = (t + self.moved).abs() < t.abs();
        if solid.is_bounded() || format != Format::Fixed || !from_origin {
            return near;
        }
        near.max(f64::powi(2.0, -30) * self.moved.abs())
    }
}

fn largest(v: [f64; 3]) -> f64 {
    v.iter().fold(0.0, |most, x| most.max(x.abs()))
}

/// An answer of a kernel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// From the ray's start.
    pub t: f64,
    /// In scene-file order.
    pub primitive: u32,
}

/// Why an answer is wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mismatch {
    /// The primitive is not met, or not there.
    NotThere,
    /// Another primitive is met before.
    Missed { primitive: u32, t: f64 },
}

/// The primitives of a scene as exact shapes.
pub struct Judge {
    /// In ascending order of the primitives' numbers, which the pieces of a cut triangle share.
    solids: Vec<(u32, Option<UnitBox>, Solid)>,
}

impl Judge {
    pub fn of(scene: &Scene<'_>) -> Self {
        let mut solids = Vec::new();
        for kind in Kind::ALL {
            for slot in 0..scene.count(kind) {
                let bounds = scene.primitive_bounds(kind, slot);
                let solid = scene.geometry(kind, slot).map(Solid::of);
                let primitive = scene.primitive(kind, slot as u32);
                solids.extend(solid.map(|solid| (primitive, bounds, solid)));
            }
        }
        solids.sort_by_key(|&(primitive, _, _)| primitive);
        Self { solids }
    }

    /// The shape of a primitive, or of a piece of it.
    pub fn solid(&self, primitive: u32) -> Option<&Solid> {
        self.pieces(primitive).next()
    }

    /// The shapes of the pieces of a primitive: one, unless it is a triangle that was cut.
    fn pieces(&self, primitive: u32) -> impl Iterator<Item = &Solid> {
        let first = self.solids.partition_point(|it| it.0 < primitive);
        let behind = self.solids.iter().skip(first);
        behind
            .take_while(move |it| it.0 == primitive)
            .map(|(_, _, solid)| solid)
    }

    /// Returns whether an answer is right, within [`STEPS`].
    pub fn check(
        &self,
        format: Format,
        ray: &RoundedRay,
        answer: Option<Answer>,
    ) -> Result<(), Mismatch> {
        let line = ray.line();
        let met = answer.and_then(|answer| self.solid(answer.primitive));
        let [tmin, tmax] = ray.interval_of(met.is_none_or(Solid::is_bounded));
        let begin = Real::of(tmin);
        let mut end = None;
        if let Some(answer) = answer {
            let pieces = || self.pieces(answer.primitive);
            let step = pieces().map(|solid| ray.step(format, answer.t, solid));
            let off = STEPS * step.reduce(f64::max).ok_or(Mismatch::NotThere)?;
            let there = pieces().any(|solid| {
                Crossings::new(solid, &line, off).may_be_met_at(&Real::of(answer.t), &begin)
            });
            if !there || answer.t < tmin - off || answer.t > tmax + off {
                return Err(Mismatch::NotThere);
            }
            // Hits count from the ray's own start, which rounds once more.
            end = Some(answer.t - off);
        }
        let reach = answer.map_or(FARTHEST, |answer| answer.t);
        for (primitive, bounds, solid) in &self.solids {
            let itself = answer.is_some_and(|answer| answer.primitive == *primitive);
            if itself || bounds.is_some_and(|bounds| !may_meet(ray, &bounds)) {
                continue;
            }
            let [begin, last] = ray.interval_of(solid.is_bounded());
            let begin = Real::of(begin);
            let end = Real::of(end.unwrap_or(last.min(FARTHEST_HIT)));
            let met_by = |reach: f64| {
                let off = STEPS * ray.step(format, reach, solid);
                Crossings::new(solid, &line, off).are_met_by(&begin)
            };
            let met = match met_by(reach) {
                // It may be met far beyond.
                Some(t) if !solid.is_bounded() => met_by(t.to_f64().max(reach)),
                met => met,
            };
            if let Some(t) = met.filter(|t| *t < end) {
                return Err(Mismatch::Missed {
                    primitive: *primitive,
                    t: t.to_f64(),
                });
            }
        }
        Ok(())
    }

    /// Returns whether a ray meets a primitive at `t`, which may be as far off as `within`, or [`STEPS`] more.
    pub fn crosses(
        &self,
        format: Format,
        primitive: u32,
        ray: &RoundedRay,
        t: f64,
        within: f64,
    ) -> bool {
        self.pieces(primitive).any(|solid| {
            let off = within + STEPS * ray.step(format, t, solid);
            let begin = Real::of(ray.interval_of(solid.is_bounded())[0]);
            Crossings::new(solid, &ray.line(), off).may_be_met_at(&Real::of(t), &begin)
        })
    }
}

/// Where a ray may cross a shape that is only known within a length: any of the shapes counts that
/// are larger or smaller by no more than that.
///
/// A ray meets a solid where it enters it; one that starts inside, where it leaves it.
#[derive(Clone, Debug)]
pub struct Crossings<'c> {
    solid: &'c Solid,
    line: &'c Line,
    off: Real,
}

impl<'c> Crossings<'c> {
    pub fn new(solid: &'c Solid, line: &'c Line, off: f64) -> Self {
        let off = Real::of(off);
        Self { solid, line, off }
    }

    /// Returns whether one of the shapes is met at `t` by a ray that counts from `begin`.
    pub fn may_be_met_at(&self, t: &Real, begin: &Real) -> bool {
        let largest = self.solid.spans(self.line, &self.off);
        let Some((first, last)) = largest.iter().find(|(first, last)| first <= t && t <= last)
        else {
            return false;
        };
        if self.solid.is_flat() {
            return true;
        }
        // What all of the shapes hold, no ray passes unseen; one that may have started inside of it, or of
        // a larger one around it, leaves.
        let smallest = self.solid.spans(self.line, &-&self.off);
        smallest.iter().all(|(enter, leave)| {
            let is_around = first <= enter && leave <= last;
            t <= enter || leave <= t && (leave <= begin || is_around && first <= begin)
        })
    }

    /// By where every one of the shapes is met by a ray that counts from `begin`; `None` if one of
    /// them may not be met at all.
    pub fn are_met_by(&self, begin: &Real) -> Option<Real> {
        let smallest = self.solid.spans(self.line, &-&self.off);
        let largest = self.solid.spans(self.line, &self.off);
        smallest.into_iter().find_map(|(enter, leave)| {
            let around = |(first, last): &&(Real, Real)| *first <= enter && leave <= *last;
            let (first, last) = largest.iter().find(around)?.clone();
            match (first > *begin, self.solid.is_flat()) {
                (true, true) => Some(last),
                (true, false) => Some(enter),
                (false, true) => None,
                // It may start inside of one and outside of another.
                (false, false) => (leave > *begin).then_some(last),
            }
        })
    }
}

/// Returns whether a ray can meet a box, or one that is larger by a unit.
fn may_meet(ray: &RoundedRay, bounds: &UnitBox) -> bool {
    let mut span = (f64::NEG_INFINITY, f64::INFINITY);
    for axis in 0..3 {
        let [low, high] = bounds.0[axis].map(f64::from);
        let (low, high) = (low - 1.0 - ray.start[axis], high + 1.0 - ray.start[axis]);
        let slope = ray.slope[axis];
        if slope == 0.0 {
            if low > 0.0 || high < 0.0 {
                return false;
            }
            continue;
        }
        let (a, b) = (low / slope, high / slope);
        span = (span.0.max(a.min(b)), span.1.min(a.max(b)));
    }
    span.0 <= span.1
}
