//! The faces of a cube of directions around an apex, and the candidates behind each.

use super::super::bundle::{Bundle, Ranges, Rays};
use super::super::target::Target;
use glam::DVec3;
use gridel_core::accel::Apex;
use gridel_core::format::record::{ApexDirection, Gridels, View};

/// Ratio of the width of the camera's window to that of the picture.
const WIDER: f64 = 1.02;
/// 2^30, the ratio 1.
pub(super) const ONE: f64 = 1_073_741_824.0;

/// A face of a cube of directions, and the candidates behind it.
pub(super) struct Face {
    pub(super) bundle: Bundle,
    /// The content of a window there.
    pub(super) window: Ranges,
    /// The visible targets, the nearest first.
    pub(super) seen: Vec<Seen>,
}

/// A visible target.
#[derive(Clone, Copy)]
pub(super) struct Seen {
    pub(super) slot: u32,
    /// The depth at which its box begins, and where it ends.
    pub(super) depths: [f64; 2],
    /// The rays that can meet it.
    pub(super) ranges: Ranges,
}

impl Seen {
    /// Returns true if some of the rays are within ranges.
    pub(super) fn is_within(&self, ranges: Ranges) -> bool {
        let mut sides = self.ranges.iter().zip(ranges);
        sides.all(|(own, of)| own[0] <= of[1] && own[1] >= of[0])
    }
}

impl Face {
    /// Returns the face as seen from a point; `None` if no target is visible.
    pub(super) fn of_point(
        targets: &[Target],
        at: [i32; 3],
        face: usize,
        view: Option<&View>,
    ) -> Option<Self> {
        let (axis, up) = (face / 2, face % 2 == 1);
        let picture = match view {
            Some(view) => Some(picture_window(view, axis, up)?),
            None => None,
        };
        let apex = at.map(|q8| f64::from(q8) / 256.0);
        let bundle = Bundle {
            axis,
            up,
            start: apex[axis],
            rays: Rays::Through(Gridels::across(axis).map(|across| apex[across])),
        };
        let face = Self::of(bundle, targets, [[-1.0, 1.0]; 2])?;
        let Some(window) = picture else {
            return Some(face);
        };
        // All of the picture, so that rays that meet nothing find an empty list.
        let is_visible = face.seen.iter().any(|it| it.is_within(window));
        is_visible.then_some(Self { window, ..face })
    }

    /// Returns the face as seen from a direction.
    pub(super) fn of_direction(targets: &[Target], direction: &ApexDirection) -> Option<Self> {
        let axis = usize::from(direction.major);
        let up = direction.slope[axis] < 0;
        // Away from the plane, so the other way round.
        let slope = |across: usize| -f64::from(direction.slope[across]) / ONE;
        let bundle = Bundle {
            axis,
            up,
            start: f64::from(direction.plane) / 256.0,
            rays: Rays::Along(Gridels::across(axis).map(slope)),
        };
        Self::of(bundle, targets, [[f64::NEG_INFINITY, f64::INFINITY]; 2])
    }

    /// Returns the part that rays within limits reach.
    fn of(bundle: Bundle, targets: &[Target], limits: Ranges) -> Option<Self> {
        let mut window = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        let mut seen = Vec::new();
        for (slot, target) in targets.iter().enumerate() {
            let Some(ranges) = bundle.ranges_to(target) else {
                continue;
            };
            let inside = [0, 1].map(|side| {
                let ([low, high], [least, most]) = (ranges[side], limits[side]);
                [low.max(least), high.min(most)]
            });
            if inside.iter().all(|[low, high]| low <= high) {
                for (all, one) in window.iter_mut().zip(inside) {
                    *all = [all[0].min(one[0]), all[1].max(one[1])];
                }
                seen.push(Seen {
                    slot: slot as u32,
                    depths: bundle.depths(target.bounds()),
                    ranges: inside,
                });
            }
        }
        seen.sort_by(|a: &Seen, b| a.depths[0].total_cmp(&b.depths[0]));
        (!seen.is_empty()).then_some(Self {
            bundle,
            window,
            seen,
        })
    }

    /// Cells along each side for cells of a size.
    pub(super) fn cells(&self, size: f64) -> [u32; 2] {
        self.window.map(|[low, high]| {
            let cells = ((high - low) / size).ceil();
            cells.clamp(1.0, Apex::MOST_CELLS.into()) as u32
        })
    }
}

/// The slopes of a picture's directions on a face; `None` where it has none there.
fn picture_window(view: &View, axis: usize, up: bool) -> Option<Ranges> {
    let vector = |v: [i32; 3]| DVec3::from_array(v.map(f64::from));
    let right = vector(view.right) * f64::from(view.width) / f64::from(view.height) * WIDER;
    let (forward, above) = (vector(view.forward), vector(view.up) * WIDER);
    let mut corners = vec![
        forward - right - above,
        forward + right - above,
        forward + right + above,
        forward - right + above,
    ];
    // Cut to the pyramid of the face: no slope beyond 1.
    let sign = if up { 1.0 } else { -1.0 };
    let across = Gridels::across(axis);
    for other in across {
        for side in [1.0, -1.0] {
            let inside = |v: &DVec3| sign * v[axis] + side * v[other];
            corners = cut(&corners, inside);
        }
    }
    let mut window = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for corner in corners.iter().filter(|corner| sign * corner[axis] > 0.0) {
        for (other, range) in across.into_iter().zip(&mut window) {
            let slope = corner[other] / (sign * corner[axis]);
            *range = [range[0].min(slope), range[1].max(slope)];
        }
    }
    (window[0][0] <= window[0][1]).then_some(window)
}

/// The part of a polygon where a linear function is not negative.
fn cut(corners: &[DVec3], inside: impl Fn(&DVec3) -> f64) -> Vec<DVec3> {
    let mut kept = Vec::new();
    for (place, &corner) in corners.iter().enumerate() {
        let next = corners[(place + 1) % corners.len()];
        let (here, there) = (inside(&corner), inside(&next));
        if here >= 0.0 {
            kept.push(corner);
        }
        if (here < 0.0) != (there < 0.0) {
            kept.push(corner + (next - corner) * (here / (here - there)));
        }
    }
    kept
}
