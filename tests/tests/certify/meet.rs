//! Crossings of lines with the shapes of `verify`, one after the other.

use super::exact::Exact;
use super::numbers::{nothing, real, sum};
use super::placed::{Met, Placed};
use gridel_core::scene::Footprint;
use gridel_host::shape::Solid;
use gridel_host::shape::exact::{
    Line, Real, Vector, along, cross, dot, minus, norm, scaled, unit, vector,
};

impl Exact<'_> {
    /// The crossings of a line between two t, in any order.
    fn crossings(&self, line: &Line, end: Option<&Real>) -> Vec<(Real, &Placed, bool)> {
        let mut all = Vec::new();
        for placed in &self.solids {
            let line = placed.line(line);
            let origin = line.origin.each_ref().map(Real::to_f64);
            let slope = line.slope.each_ref().map(Real::to_f64);
            if placed
                .bounds
                .is_some_and(|it| !may_meet(origin, slope, &it))
            {
                continue;
            }
            for (enter, leave) in placed.solid.spans(&line, &real(0.0)) {
                let mut keep = |t: Real, leaves: bool| {
                    if t > nothing() && end.is_none_or(|end| &t + nothing() < *end) {
                        all.push((t, placed, leaves));
                    }
                };
                if placed.solid.is_flat() {
                    keep(enter, false);
                } else {
                    keep(enter, false);
                    keep(leave, true);
                }
            }
        }
        all
    }

    /// The first crossing. At the same t the scene's own primitives come before those of instances, and the lower number
    /// first.
    pub fn nearest(&self, line: &Line, end: Option<&Real>) -> Option<Met<'_>> {
        let mut best: Option<(Real, &Placed, bool)> = None;
        for next in self.crossings(line, end) {
            let is_better = match &best {
                None => true,
                Some(best) => {
                    let apart = &next.0 - &best.0;
                    let rank = |placed: &Placed| (placed.instance, placed.primitive);
                    apart < -nothing() || apart < nothing() && rank(next.1) < rank(best.1)
                }
            };
            if is_better {
                best = Some(next);
            }
        }
        let (t, placed, leaves) = best?;
        let point = line.at(&t);
        let line_there = placed.line(line);
        let mut normal = outward(placed, (&line_there.at(&t), &line_there.slope), leaves)?;
        if let Some(map) = &placed.map {
            normal = map.normal(&normal);
        }
        let front = if placed.solid.is_flat() {
            dot(&normal, &line.slope).is_negative()
        } else {
            !leaves
        };
        Some(Met {
            placed,
            t,
            point,
            normal,
            front,
            object: placed.object,
            footprint: Footprint::point(),
        })
    }
}

/// The gradient of how far the surface lies inside of the point, by its definition.
fn outward(placed: &Placed, (point, slope): (&Vector, &Vector), leaves: bool) -> Option<Vector> {
    Some(match &placed.solid {
        Solid::Triangle([a, b, c]) => {
            let [a, b, c] = [a, b, c].map(|corner| vector(corner.to_array()));
            unit(&cross(&minus(&b, &a), &minus(&c, &a)))
        }
        Solid::Sphere(sphere) => unit(&minus(point, &vector(sphere.center.to_array()))),
        Solid::Disc(disc) => unit(&vector(disc.normal.to_array())),
        Solid::Plane(plane) => unit(&vector(plane.normal.to_array())),
        Solid::Box(cuboid) => {
            // The face that the point lies on, of those that the line crosses in that direction; at an edge the
            // first.
            let (low, high) = (vector(cuboid.min.to_array()), vector(cuboid.max.to_array()));
            let mut best: Option<(Real, usize, f64)> = None;
            for k in 0..3 {
                let towards = match (slope[k].is_positive(), slope[k].is_negative()) {
                    (true, _) => 1.0,
                    (_, true) => -1.0,
                    _ => continue,
                };
                let sign = if leaves { towards } else { -towards };
                let side = if sign > 0.0 { &high } else { &low };
                let off = (&point[k] - &side[k]).abs();
                if best.as_ref().is_none_or(|best| &off + nothing() < best.0) {
                    best = Some((off, k, sign));
                }
            }
            let (_, axis, sign) = best?;
            [0, 1, 2].map(|k| real(if k == axis { sign } else { 0.0 }))
        }
        Solid::Cone(cone) => {
            let (base, apex) = (vector(cone.base.to_array()), vector(cone.apex.to_array()));
            let way = minus(&apex, &base);
            let (height, axis) = (norm(&way), unit(&way));
            let q = minus(point, &base);
            let y = dot(&q, &axis);
            // A cap counts at its rim if the line crosses it in that direction.
            let crosses = |cap: &Vector| {
                let towards = dot(cap, slope);
                if leaves {
                    towards.is_positive()
                } else {
                    towards.is_negative()
                }
            };
            let below = axis.each_ref().map(|x| -x);
            if y.abs() < nothing() && crosses(&below) {
                return Some(below);
            }
            if (&y - &height).abs() < nothing() && crosses(&axis) {
                return Some(axis);
            }
            let out = unit(&along(&q, &-&y, &axis));
            let narrows = real(cone.base_radius) - real(cone.apex_radius);
            unit(&sum(&scaled(&out, &height), &scaled(&axis, &narrows)))
        }
        Solid::Torus(torus) => {
            let axis = unit(&vector(torus.axis.to_array()));
            let q = minus(point, &vector(torus.center.to_array()));
            let y = dot(&q, &axis);
            let outward = unit(&along(&q, &-&y, &axis));
            unit(&along(&q, &real(-torus.major_radius), &outward))
        }
    })
}

/// Returns whether a line can meet a box in units, or one that is larger by a unit.
fn may_meet(origin: [f64; 3], slope: [f64; 3], bounds: &[[f64; 2]; 3]) -> bool {
    let (mut first, mut last) = (f64::NEG_INFINITY, f64::INFINITY);
    for k in 0..3 {
        let [low, high] = bounds[k];
        let (low, high) = (low - 1.0 - origin[k], high + 1.0 - origin[k]);
        if slope[k] == 0.0 {
            if low > 0.0 || high < 0.0 {
                return false;
            }
            continue;
        }
        let (a, b) = (low / slope[k], high / slope[k]);
        (first, last) = (first.max(a.min(b)), last.min(a.max(b)));
    }
    first <= last
}
