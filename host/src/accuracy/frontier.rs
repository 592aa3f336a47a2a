//! The settings that no other one beats in error and cost.

use super::Point;

/// Returns which points are on the Pareto frontier: no other dominates them. A point dominates another if its error is no
/// larger, its cost certainly no higher, and one of the two is better. Costs are those of [`Cost::is_below`](super::Cost::is_below).
pub fn frontier(points: &[Point]) -> Vec<bool> {
    frontier_by(points, |point| point.errors.rmse)
}

/// Returns the frontier by another error.
pub fn frontier_by(points: &[Point], error: impl Fn(&Point) -> f64) -> Vec<bool> {
    let dominates = |a: &Point, b: &Point| {
        let cheaper = a.is_cheaper(b);
        let costs_no_more = cheaper || a.same_work(b);
        let (a, b) = (error(a), error(b));
        costs_no_more && a <= b && (cheaper || a < b)
    };
    let is_best = |b: &Point| !points.iter().any(|a| dominates(a, b));
    points.iter().map(is_best).collect()
}

impl Point {
    /// Returns whether the point certainly costs less: by time where the repeats of both are distinct. Otherwise rays
    /// and tests decide, which repeat exactly and compare within a number format.
    fn is_cheaper(&self, other: &Self) -> bool {
        if self.cost.is_below(&other.cost) {
            return true;
        }
        let (own, others) = (&self.cost, &other.cost);
        self.setting.format == other.setting.format
            && !others.is_below(own)
            && own.rays <= others.rays
            && own.tests <= others.tests
            && !self.same_work(other)
    }

    /// Returns whether both cast the same rays and make the same tests in the same format, and their times
    /// do not differ.
    fn same_work(&self, other: &Self) -> bool {
        let work = |point: &Self| (point.setting.format, point.cost.rays, point.cost.tests);
        work(self) == work(other) && !other.cost.is_below(&self.cost)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Setting;
    use super::super::test_results::{BASE, point, with};
    use super::*;
    use gridel_core::Format;

    #[test]
    fn frontier_keeps_settings_whose_times_differ_by_noise() {
        // As right, and now one, now the other is faster: none dominates.
        let [slow, fast] = [&[1.0, 1.3, 4.9][..], &[1.1, 1.2, 1.25]];
        let points = [
            point(BASE, 0.1, slow, 100),
            point(with(Format::F64), 0.1, fast, 100),
        ];
        assert_eq!(frontier(&points), [true, true]);
        // A little more right, within noise: the times do not decide, and formats' tests differ in cost.
        let points = [
            point(BASE, 0.1, slow, 100),
            point(with(Format::F64), 0.09, fast, 90),
        ];
        assert_eq!(frontier(&points), [true, true]);
    }

    #[test]
    fn frontier_drops_what_is_slower_beyond_the_spread() {
        let points = [
            point(BASE, 0.1, &[1.0, 1.1, 1.2], 100),
            point(with(Format::F64), 0.1, &[1.3, 1.4, 9.0], 100),
        ];
        assert_eq!(frontier(&points), [true, false]);
    }

    #[test]
    fn frontier_goes_by_rays_and_tests_where_times_are_noise() {
        let fewer = Setting { depth: 5, ..BASE };
        let more = |seconds| point(BASE, 0.1, seconds, 100);
        let less = |seconds| point(fewer, 0.1, seconds, 90);
        assert_eq!(
            frontier(&[more(&[1.0, 1.5]), less(&[1.1, 1.6])]),
            [false, true]
        );
        // A single repeat has no spread.
        assert_eq!(frontier(&[more(&[1.0]), less(&[1.1])]), [false, true]);
        // Where times differ beyond their spread, they count.
        assert_eq!(
            frontier(&[more(&[1.0, 1.05]), less(&[1.1, 1.6])]),
            [true, false]
        );
    }
}
