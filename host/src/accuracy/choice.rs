//! The best setting within limits of error and rays.

use super::Point;

/// Limits of a search.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Largest root mean square error.
    pub error: f64,
    /// Most rays per pixel.
    pub rays: f64,
}

impl Limits {
    /// Returns whether a point is within.
    pub fn hold(&self, point: &Point) -> bool {
        point.errors.rmse <= self.error && point.rays_per_pixel() <= self.rays
    }
}

/// Returns the point with the smallest error that casts no more rays per pixel; of several the one with the fewest rays
/// and tests.
pub fn most_accurate<'p>(points: &'p [Point], rays: f64, board: Option<&str>) -> Option<&'p Point> {
    let key = |point: &Point| (point.errors.rmse, point.cost.work());
    points
        .iter()
        .filter(|point| point.rays_per_pixel() <= rays)
        .filter(|point| board.is_none_or(|board| point.instructions(board).is_some()))
        .min_by(|a, b| {
            let ((a, more), (b, less)) = (key(a), key(b));
            a.total_cmp(&b).then(more.total_cmp(&less))
        })
}

/// Returns the cheapest point within limits. The cost is time on this machine, or the upper estimate of instructions on
/// a board.
pub fn cheapest<'p>(points: &'p [Point], limits: Limits, board: Option<&str>) -> Option<&'p Point> {
    let price = |point: &Point| match board {
        None => Some(point.cost.time()),
        Some(board) => point.instructions(board).map(|[_, most]| most),
    };
    points
        .iter()
        .filter(|point| limits.hold(point))
        .filter_map(|point| Some((price(point)?, point)))
        .min_by(|(a, _), (b, _)| a.total_cmp(b))
        .map(|(_, point)| point)
}
