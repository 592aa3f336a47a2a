//! The planes of a tested node, and why a ray does not go into it.

use super::InUnits;
use super::step::{Culled, Plane, Side, Tested};
use crate::shape::rounding::step;
use gridel_core::observe::event::Sides;

impl InUnits {
    pub(super) fn tested(&self, place: String, sides: Sides, span: [f64; 2]) -> Tested {
        let mut planes = Vec::new();
        for (axis, sides) in sides.iter().enumerate() {
            for (side, plane) in sides.iter().enumerate() {
                planes.extend(plane.map(|plane| self.plane(axis, side, plane)));
            }
        }
        let culled = (span[0] > span[1]).then(|| self.reason(&planes, span));
        Tested {
            place,
            planes,
            span: span.map(|t| t * self.scale),
            units: span,
            culled,
        }
    }

    fn plane(&self, axis: usize, side: usize, plane: i16) -> Plane {
        let away = f64::from(plane) - self.start[axis];
        let slope = self.slope[axis];
        // Along the plane the ray is inside of its slab for ever, or never.
        let inside = (side == 0) == (away <= 0.0) || away == 0.0;
        let (distance, entry) = if slope == 0.0 {
            let never = if inside { -1.0 } else { 1.0 };
            (never * f64::INFINITY, true)
        } else {
            (away / slope * self.scale, (side == 0) == (slope > 0.0))
        };
        let mut corner = [0.0; 3];
        corner[axis] = f64::from(plane);
        Plane {
            axis: ['x', 'y', 'z'][axis],
            side: [Side::Lower, Side::Upper][side],
            at: self.frame.place(corner).to_array()[axis],
            distance,
            entry,
        }
    }

    /// Returns the reason why a span is empty, by the planes that were tested.
    fn reason(&self, planes: &[Plane], span: [f64; 2]) -> Culled {
        let interval = self.interval.map(|t| t * self.scale);
        if planes.is_empty() {
            return Culled::NotInVolume;
        }
        let by_distance = |a: &&Plane, b: &&Plane| a.distance.total_cmp(&b.distance);
        let enters = planes.iter().filter(|p| p.entry).max_by(by_distance);
        let leaves = planes.iter().filter(|p| !p.entry).min_by(by_distance);
        if let Some(&along) = enters.filter(|plane| plane.distance == f64::INFINITY) {
            return Culled::Outside { along };
        }
        if let (Some(&enters), Some(&leaves)) = (enters, leaves)
            && enters.distance > leaves.distance
        {
            return Culled::Beside { leaves, enters };
        }
        let hit = self.limit * self.scale;
        let begins = span[0] * self.scale;
        if let Some(&enters) = enters
            && self.limit * self.scale < interval[1]
            && begins.max(enters.distance) > hit
        {
            return Culled::BehindHit { enters, hit };
        }
        let begins_late = enters.is_some_and(|plane| plane.distance > interval[1]);
        let ends_early = leaves.is_some_and(|plane| plane.distance < interval[0]);
        if begins_late || ends_early {
            return Culled::NotInInterval;
        }
        // Tests between the parent and this node have narrowed the interval as well.
        let [first, last] = self.around.map(|t| t * self.scale);
        let [begins, ends] = span.map(|t| t * self.scale);
        let late = [first, last.min(ends)];
        let early = [first.max(begins), last];
        if let Some(&plane) = enters.filter(|plane| plane.distance > late[1]) {
            return Culled::NotInParent {
                plane,
                around: late,
            };
        }
        if let Some(&plane) = leaves.filter(|plane| plane.distance < early[0]) {
            return Culled::NotInParent {
                plane,
                around: early,
            };
        }
        // Volumes have boundaries that are no planes of axes.
        let margin = 64.0 * step(self.format, span[0].abs().max(span[1].abs()));
        match span[0] - span[1] > margin {
            true => Culled::NotInVolume,
            false => Culled::Margin,
        }
    }
}
