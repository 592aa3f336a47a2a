//! What is right, by arithmetic that owes nothing to the kernels: which primitive a ray meets first,
//! within what a number format may be off by.

use super::exact::Real;
use super::solid::{Line, Solid};
use gridel_core::blob::Geometry;
use gridel_core::blob::record::UnitBox;
use gridel_core::{Format, Kind, Number, Ray, Scene};

/// How many rounding steps an answer may be off by: the shape that it is right for may be so much
/// larger or smaller.
pub const STEPS: f64 = 8.0;

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
    /// What counts, from `start`.
    pub interval: [f64; 2],
    /// The t of `start` as hits count it.
    pub moved: f64,
}

impl RoundedRay {
    pub fn of<N: Number>(ray: &Ray<N>) -> Self {
        Self {
            start: ray.start().map(N::length_to_f64),
            slope: ray.slope().map(N::ratio_to_f64),
            interval: ray.interval().map(N::length_to_f64),
            moved: N::far_to_f64(ray.moved()),
        }
    }

    /// The same ray in double precision.
    pub fn in_f64(&self, bounds: &UnitBox) -> Option<Ray<f64>> {
        let [first, last] = self.interval;
        Ray::from_f64(bounds, self.start, self.slope, first, last).ok()
    }

    fn line(&self) -> Line {
        Line::new(self.start, self.slope)
    }

    fn magnitude(&self, t: f64) -> f64 {
        largest(self.start).max(t.abs()).max(self.moved.abs())
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
pub enum Wrong {
    /// The primitive is not met, or not there.
    NotThere,
    /// Another primitive is met before.
    Missed { primitive: u32, t: f64 },
}

/// The primitives of a scene as exact shapes.
pub struct Judge {
    solids: Vec<(u32, UnitBox, Solid)>,
    /// The place of each primitive among them.
    places: Vec<u32>,
}

impl Judge {
    pub fn of(scene: &Scene<'_>) -> Self {
        let mut solids = Vec::new();
        let mut places = vec![u32::MAX; scene.header().primitives as usize];
        for kind in Kind::ALL {
            for slot in 0..scene.count(kind) {
                let bounds = scene.primitive_bounds(kind, slot);
                let solid = scene.geometry(kind, slot).map(solid);
                let primitive = scene.primitive(kind, slot as u32);
                if let (Some(bounds), Some(solid)) = (bounds, solid) {
                    if let Some(place) = places.get_mut(primitive as usize) {
                        *place = solids.len() as u32;
                    }
                    solids.push((primitive, bounds, solid));
                }
            }
        }
        Self { solids, places }
    }

    /// The shape of a primitive.
    pub fn solid(&self, primitive: u32) -> Option<&Solid> {
        let &place = self.places.get(primitive as usize)?;
        self.solids.get(place as usize).map(|(_, _, solid)| solid)
    }

    /// Whether an answer is right, within [`STEPS`].
    pub fn check(
        &self,
        format: Format,
        ray: &RoundedRay,
        answer: Option<Answer>,
    ) -> Result<(), Wrong> {
        let line = ray.line();
        let [tmin, tmax] = ray.interval;
        let mut end = Real::of(tmax.min(1e300));
        if let Some(answer) = answer {
            let solid = self.solid(answer.primitive).ok_or(Wrong::NotThere)?;
            let off = STEPS * step(format, ray.magnitude(answer.t).max(solid.extent()));
            let first = is_there(solid, &line, answer.t, tmin, off).ok_or(Wrong::NotThere)?;
            if answer.t < tmin - off || answer.t > tmax + off {
                return Err(Wrong::NotThere);
            }
            end = first;
        }
        for (primitive, bounds, solid) in &self.solids {
            let itself = answer.is_some_and(|answer| answer.primitive == *primitive);
            if itself || !may_meet(ray, bounds) {
                continue;
            }
            // Shrunk by what the format may be off by, it is met all the same, and before.
            let off = STEPS
                * step(
                    format,
                    ray.magnitude(0.0).max(solid.extent()).max(131_072.0),
                );
            let Some((enter, leave)) = solid.span(&line, &Real::of(-off)) else {
                continue;
            };
            let begin = Real::of(tmin + off);
            let end = &end - Real::of(off);
            let met = [enter, leave].into_iter().find(|t| *t > begin);
            if let Some(t) = met.filter(|t| *t < end) {
                return Err(Wrong::Missed {
                    primitive: *primitive,
                    t: t.to_f64(),
                });
            }
        }
        Ok(())
    }

    /// Whether a ray meets a primitive beyond its start.
    pub fn meets(&self, primitive: u32, ray: &RoundedRay) -> bool {
        let crossed = |solid: &Solid| solid.span(&ray.line(), &Real::of(0.0));
        self.solid(primitive)
            .and_then(crossed)
            .is_some_and(|(_, leave)| leave.is_positive())
    }

    /// Whether a ray crosses a primitive at `t`, within [`STEPS`].
    pub fn crosses(&self, format: Format, primitive: u32, ray: &RoundedRay, t: f64) -> bool {
        self.solid(primitive).is_some_and(|solid| {
            let off = STEPS * step(format, ray.magnitude(t).max(solid.extent()));
            let span = solid.span(&ray.line(), &Real::of(off));
            let near = |place: &Real| (place - Real::of(t)).to_f64().abs() <= 4.0 * off;
            span.is_some_and(|(enter, leave)| near(&enter) || near(&leave))
        })
    }
}

/// Whether a shape that differs by no more than `off` is met at `t`; if so, where the largest of them
/// begins.
fn is_there(solid: &Solid, line: &Line, t: f64, tmin: f64, off: f64) -> Option<Real> {
    let (first, last) = solid.span(line, &Real::of(off))?;
    let place = Real::of(t);
    let within = first <= place && place <= last;
    if solid.is_flat() {
        return within.then_some(first);
    }
    let shrunk = solid.span(line, &Real::of(-off));
    let (enter, leave) = shrunk.unwrap_or((last.clone(), first.clone()));
    let entering = within && place <= enter;
    let leaving = within && leave <= place && first <= Real::of(tmin + off);
    if entering {
        Some(first)
    } else {
        leaving.then_some(leave)
    }
}

/// Whether a ray can meet a box, or one that is larger by a unit.
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

fn solid(geometry: Geometry) -> Solid {
    let length = |steps: i32| f64::from(steps) / 256.0;
    match geometry {
        Geometry::Triangle(corners) => Solid::Triangle(corners.map(|c| c.map(length))),
        Geometry::Sphere { center, radius } => Solid::Sphere {
            center: center.map(length),
            radius: length(radius),
        },
        Geometry::Box(cuboid) => Solid::Box {
            lowest: cuboid.lowest.map(length),
            highest: cuboid.highest.map(length),
        },
        Geometry::Disc(disc) => Solid::Disc {
            center: disc.center.map(length),
            normal: disc.normal.map(f64::from),
            radius: length(disc.radius),
        },
        Geometry::Cone(cone) => Solid::Cone {
            base: cone.base.map(length),
            apex: cone.apex.map(length),
            base_radius: length(cone.base_radius),
            apex_radius: length(cone.apex_radius),
        },
    }
}
