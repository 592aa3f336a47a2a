//! The rays of an apex on one face of the cube of directions, and what they are sorted by.

use super::shaft::Shaft;
use super::target::Target;
use glam::DVec3;
use gridel_core::accel::Apex;
use gridel_core::format::record::Gridels;

/// Rays from a point along one major axis, or to it; or parallel rays, to a point infinitely far
/// away.
#[derive(Clone, Copy, Debug)]
pub struct Bundle {
    /// The major axis.
    pub axis: usize,
    /// True if the axis increases away from the apex.
    pub up: bool,
    /// The start of the rays on their major axis: the point, or a plane beyond the scene.
    pub start: f64,
    pub rays: Rays,
}

/// The common limits of the rays of a bundle, on the two axes that follow the major one.
#[derive(Clone, Copy, Debug)]
pub enum Rays {
    /// All pass a point; they differ by their slopes away from it.
    Through([f64; 2]),
    /// All have these slopes away from the plane; they differ by where they pass it, in units.
    Along([f64; 2]),
}

/// The ranges by which the rays of a bundle differ, on the two axes that follow the major one.
pub type Ranges = [[f64; 2]; 2];

impl Bundle {
    /// Returns a slope of 1, or a unit of a place, in the window's records.
    pub fn one(&self) -> f64 {
        match self.rays {
            Rays::Through(_) => f64::from(1 << 30),
            Rays::Along(_) => 256.0,
        }
    }

    /// Returns where a box begins and ends along the major axis, seen from the start and not behind
    /// it.
    pub fn depths(&self, bounds: &[[f64; 2]; 3]) -> [f64; 2] {
        let [low, high] = bounds[self.axis].map(|side| side - self.start);
        let (near, far) = if self.up { (low, high) } else { (-high, -low) };
        [near.max(0.0), far]
    }

    /// Returns the ranges of the rays that can meet a target; `None` if none can.
    pub fn ranges_to(&self, target: &Target) -> Option<Ranges> {
        let bounds = target.bounds();
        let [near, far] = self.depths(bounds);
        if far < 0.0 {
            return None;
        }
        let mut ranges = [[0.0; 2]; 2];
        for (side, across) in Gridels::across(self.axis).into_iter().enumerate() {
            let low = bounds[across][0] - Apex::REACH;
            let high = bounds[across][1] + Apex::REACH;
            ranges[side] = match self.rays {
                Rays::Through(point) => {
                    let (low, high) = (low - point[side], high - point[side]);
                    // A quotient by nothing is without bounds.
                    let least = if low < 0.0 { low / near } else { low / far };
                    let most = if high > 0.0 { high / near } else { high / far };
                    [least.max(-1.0), most.min(1.0)]
                }
                Rays::Along(slopes) => {
                    let moved = [near, far].map(|depth| depth * slopes[side]);
                    [low - moved[0].max(moved[1]), high - moved[0].min(moved[1])]
                }
            };
            if ranges[side][0] > ranges[side][1] {
                return None;
            }
        }
        Some(ranges)
    }

    /// Returns a single ray: its start, and its way to a depth of 1.
    pub fn ray(&self, values: [f64; 2]) -> (DVec3, DVec3) {
        let mut from = [self.start; 3];
        let mut way = [if self.up { 1.0 } else { -1.0 }; 3];
        for (side, across) in Gridels::across(self.axis).into_iter().enumerate() {
            (from[across], way[across]) = match self.rays {
                Rays::Through(point) => (point[side], values[side]),
                Rays::Along(slopes) => (values[side], slopes[side]),
            };
        }
        (DVec3::from_array(from), DVec3::from_array(way))
    }

    /// Returns the volume in which rays of some ranges can meet anything, up to a depth.
    pub fn shaft(&self, ranges: Ranges, last: f64) -> Shaft {
        let mut shaft = Shaft {
            low: [self.start; 3],
            high: [self.start; 3],
            low_rate: [if self.up { 1.0 } else { -1.0 }; 3],
            high_rate: [if self.up { 1.0 } else { -1.0 }; 3],
            last,
        };
        for (side, across) in Gridels::across(self.axis).into_iter().enumerate() {
            let (places, rates) = match self.rays {
                Rays::Through(point) => ([point[side]; 2], ranges[side]),
                Rays::Along(slopes) => (ranges[side], [slopes[side]; 2]),
            };
            shaft.low[across] = places[0] - Apex::REACH;
            shaft.high[across] = places[1] + Apex::REACH;
            [shaft.low_rate[across], shaft.high_rate[across]] = rates;
        }
        shaft
    }
}
