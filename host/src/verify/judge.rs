//! Right answers by arithmetic that is independent of the kernels: which primitive a ray hits first, within the
//! tolerance of a number format.

use super::placed::{PlacedPart, PlacedSolid};
use super::rounded::{Answer, HitId, RoundedRay};
use crate::shape::Solid;
use crate::shape::exact::{Line, Real};
use gridel_core::format::limits;
use gridel_core::format::record::UnitBox;
use gridel_core::{Format, Kind, Scene};

/// Largest error of an answer in rounding steps. It is right for a shape that is larger or smaller by at most that.
pub const STEPS: f64 = 8.0;

/// The cosine between a surface's normal and a ray below which the ray grazes. There, t is off by more than [`STEPS`]
/// steps if the surface is off by one.
pub const GRAZING: f64 = 1.0 / STEPS;

/// Greatest distance through a scene, in units.
const FARTHEST: f64 = 131_072.0;

/// Greatest distance of a hit with a shape without bounds, in units.
const FARTHEST_HIT: f64 = (limits::FARTHEST_HIT >> 13) as f64;

/// The reason why an answer is wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mismatch {
    /// The primitive is not met, or not there.
    NotThere,
    /// Another primitive is met before.
    Missed { hit: HitId, t: f64 },
}

/// The primitives of a scene as exact shapes.
pub struct Judge {
    own: Solids,
    parts: Vec<Solids>,
    placed: Vec<Option<PlacedPart>>,
}

/// The primitives of a blob without its parts, in ascending order of their numbers. The pieces of a cut triangle share
/// a number.
struct Solids(Vec<(u32, Option<UnitBox>, Solid)>);

impl Solids {
    fn of(scene: &Scene<'_>) -> Self {
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
        Self(solids)
    }

    /// The shapes of the pieces of a primitive: one, unless it is a triangle that was cut.
    fn pieces(&self, primitive: u32) -> impl Iterator<Item = &Solid> {
        let first = self.0.partition_point(|it| it.0 < primitive);
        let behind = self.0.iter().skip(first);
        behind
            .take_while(move |it| it.0 == primitive)
            .map(|(_, _, solid)| solid)
    }
}

impl Judge {
    pub fn of(scene: &Scene<'_>) -> Self {
        Self {
            own: Solids::of(scene),
            parts: scene.parts().iter().map(Solids::of).collect(),
            placed: PlacedPart::all(scene),
        }
    }

    /// Returns the shape of a primitive, or of a piece of it.
    pub fn solid(&self, hit: HitId) -> Option<PlacedSolid<'_>> {
        self.pieces(hit).next()
    }

    /// The shapes of the pieces of a primitive.
    fn pieces(&self, hit: HitId) -> impl Iterator<Item = PlacedSolid<'_>> {
        let placed = hit
            .instance
            .map(|it| self.placed.get(it as usize)?.as_ref());
        let (solids, first, map) = match placed {
            None => (Some(&self.own), 0, None),
            Some(None) => (None, 0, None),
            Some(Some(placed)) => (
                self.parts.get(placed.part),
                placed.first_primitive,
                Some(&placed.map),
            ),
        };
        let own = hit.primitive.checked_sub(first);
        let pieces = solids.zip(own).into_iter();
        pieces
            .flat_map(|(solids, own)| solids.pieces(own))
            .map(move |solid| PlacedSolid { solid, map })
    }

    /// Returns whether an answer is right, within [`STEPS`].
    pub fn check(
        &self,
        format: Format,
        ray: &RoundedRay,
        answer: Option<Answer>,
    ) -> Result<(), Mismatch> {
        let line = ray.line();
        let met = answer.and_then(|answer| self.solid(answer.hit));
        let [tmin, tmax] = ray.interval_of(met.is_none_or(|met| met.solid.is_bounded()));
        let begin = Real::of(tmin);
        let mut end = None;
        if let Some(answer) = answer {
            let pieces = || self.pieces(answer.hit);
            let step = pieces().map(|piece| piece.step(format, ray, answer.t));
            let off = STEPS * step.reduce(f64::max).ok_or(Mismatch::NotThere)?;
            let there = pieces().any(|piece| {
                let line = piece.line(&line);
                let crossings = Crossings::new(piece.solid, &line, piece.own_length(off));
                crossings.may_be_met_at(&Real::of(answer.t), &begin)
            });
            if !there || answer.t < tmin - off || answer.t > tmax + off {
                return Err(Mismatch::NotThere);
            }
            // Hits count from the ray's own start, which rounds once more.
            end = Some(answer.t - off);
        }
        let nearest = Nearest {
            judge: self,
            format,
            ray,
            line: &line,
            answer,
            end,
        };
        nearest.among_own()?;
        nearest.among_placed()
    }

    /// Returns whether a ray meets a primitive at `t`, which may be as far off as `within`, or [`STEPS`] more.
    pub fn crosses(
        &self,
        format: Format,
        hit: HitId,
        ray: &RoundedRay,
        t: f64,
        within: f64,
    ) -> bool {
        self.pieces(hit).any(|piece| {
            let off = within + STEPS * piece.step(format, ray, t);
            let begin = Real::of(ray.interval_of(piece.solid.is_bounded())[0]);
            let line = piece.line(&ray.line());
            let crossings = Crossings::new(piece.solid, &line, piece.own_length(off));
            crossings.may_be_met_at(&Real::of(t), &begin)
        })
    }
}

/// The search for primitives that are met before an answer.
struct Nearest<'j> {
    judge: &'j Judge,
    format: Format,
    ray: &'j RoundedRay,
    line: &'j Line,
    answer: Option<Answer>,
    /// The t before which another must be met.
    end: Option<f64>,
}

impl Nearest<'_> {
    fn among_own(&self) -> Result<(), Mismatch> {
        for (primitive, bounds, solid) in &self.judge.own.0 {
            if bounds.is_none_or(|bounds| may_meet(self.ray.start, self.ray.slope, &bounds)) {
                let piece = PlacedSolid { solid, map: None };
                self.before(HitId::own(*primitive), piece, self.line)?;
            }
        }
        Ok(())
    }

    fn among_placed(&self) -> Result<(), Mismatch> {
        let RoundedRay { start, slope, .. } = *self.ray;
        for (instance, placed) in (0..).zip(&self.judge.placed) {
            let Some(placed) = placed else {
                continue;
            };
            if !may_meet(start, slope, &placed.bounds) {
                continue;
            }
            let map = &placed.map;
            let line = map.line(self.line);
            let (start, slope) = (map.point(start), map.direction(slope));
            for (primitive, bounds, solid) in &self.judge.parts[placed.part].0 {
                if bounds.is_some_and(|bounds| !may_meet(start, slope, &bounds)) {
                    continue;
                }
                let hit = HitId {
                    primitive: placed.first_primitive + primitive,
                    instance: Some(instance),
                };
                let map = Some(map);
                self.before(hit, PlacedSolid { solid, map }, &line)?;
            }
        }
        Ok(())
    }

    /// An error if a primitive is met before the answer. The line is in its coordinates.
    fn before(&self, hit: HitId, piece: PlacedSolid<'_>, line: &Line) -> Result<(), Mismatch> {
        if self.answer.is_some_and(|answer| answer.hit == hit) {
            return Ok(());
        }
        let (ray, solid) = (self.ray, piece.solid);
        let [begin, last] = ray.interval_of(solid.is_bounded());
        let begin = Real::of(begin);
        let end = Real::of(self.end.unwrap_or(last.min(FARTHEST_HIT)));
        let met_by = |reach: f64| {
            let off = STEPS * piece.step(self.format, ray, reach);
            Crossings::new(solid, line, piece.own_length(off)).are_met_by(&begin)
        };
        let reach = self.answer.map_or(FARTHEST, |answer| answer.t);
        let met = match met_by(reach) {
            // It may be met far beyond.
            Some(t) if !solid.is_bounded() => met_by(t.to_f64().max(reach)),
            met => met,
        };
        match met.filter(|t| *t < end) {
            Some(t) => Err(Mismatch::Missed { hit, t: t.to_f64() }),
            None => Ok(()),
        }
    }
}

/// The crossings that a ray may have with a shape that is known only up to a length. Any shape that is larger or
/// smaller by at most that length counts.
///
/// A ray hits a solid where it enters it. A ray that starts inside hits it where it leaves it.
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
        // No ray passes unseen through the region that all of the shapes contain. A ray that may start inside it, or
        // inside a larger shape around it, hits where it leaves.
        let smallest = self.solid.spans(self.line, &-&self.off);
        smallest.iter().all(|(enter, leave)| {
            let is_around = first <= enter && leave <= last;
            t <= enter || leave <= t && (leave <= begin || is_around && first <= begin)
        })
    }

    /// Returns the t by which a ray that counts from `begin` hits every one of the shapes. `None` if it may miss one of
    /// them.
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
fn may_meet(start: [f64; 3], slope: [f64; 3], bounds: &UnitBox) -> bool {
    let mut span = (f64::NEG_INFINITY, f64::INFINITY);
    for axis in 0..3 {
        let [low, high] = bounds.0[axis].map(f64::from);
        let (low, high) = (low - 1.0 - start[axis], high + 1.0 - start[axis]);
        let slope = slope[axis];
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
