//! The profile of a line in the half planes of a torus's axis, and where it is inside.
//!
//! At a parameter `s` the line is at a height `y`, which is linear, and at a distance from the axis of
//! `rho = sqrt(x^2 + gap^2)`. `x` is linear and 0 where the line is closest to the axis. The line is inside where
//! `h = (rho - R)^2 + y^2 - r^2` is not positive.
//!
//! **Isolation.** With `x = x0 + k s` and the slope's length `L`, `h'' / 2 = L^2 - R k^2 gap^2 / rho^3`. So `h` is
//! concave where `rho^3 < R (k / L)^2 gap^2`, an interval around `x = 0`, and convex on both sides of it: at most three
//! pieces. In a convex piece the line is inside along at most one interval. In the concave one it is outside along at
//! most one interval. The sign of `h` at a piece's ends decides which of the two holds, and with that its roots are
//! counted.
//!
//! **Roots.** Where a convex function is positive, Newton's step never leads beyond its next root. So a walk from a
//! piece's end reaches the root next to it. Or it reaches a place where the function no longer falls: then there is no
//! root. That is a proof as long as the computed slope is not less steep than the real one. So the slope is rounded to
//! the steep side; a step that is too short costs another one.
//!
//! **Signs.** `h` comes from differences of lengths. So rounding moves the point at which it is evaluated by a few
//! roundings of a length. Every sign is that of a point this near. A step below the roundings of a length ends a walk.

use crate::geometry::torus::frame::{Frame, unit};
use crate::number::{Arithmetic, extent};

/// Maximum number of steps of a walk. Let a step lead from `f`, falling by `g`, to `f1`, falling by `g1`. Then
/// `f1 / f + g1 / g <= 1` because `f` is convex, so the product of both falls to a quarter. The product begins below
/// the third power of the reach, and ends before that of half a rounding, 3 times 54 bits lower.
const STEPS: usize = 84;

/// The course of a line near a torus. All lengths are of one scale.
pub(super) struct Profile<N: Arithmetic> {
    /// Height along the axis, and its change along the line.
    y: N,
    rise: N,
    /// Position along the part of the line across the axis, and its change along the line.
    x: N,
    run: N,
    /// The line's distance from the axis.
    gap: N,
    major: N,
    minor: N,
    /// An upper bound of the rounding of a position.
    slack: N,
}

/// A point of the line.
struct Point<N> {
    x: N,
    y: N,
    rho: N,
    /// The distance beyond the circle: `rho - R`.
    beyond: N,
}

/// The ends of pieces in order, of which the one in the middle is concave.
pub(super) type Cuts<N> = [N; 4];

impl<N: Arithmetic> Profile<N> {
    /// The line through a point as seen from the center, along a slope.
    pub(super) fn new(
        frame: &Frame<N>,
        (point, slope): ([N; 3], [N; 3]),
        [major, minor]: [N; 2],
    ) -> Self {
        let (y, [u, v]) = frame.parts(point);
        let (rise, across) = frame.parts(slope);
        // The square of a smaller slope would underflow, and the line does not move along it.
        let moves = extent([across[0], across[1], N::ZERO]) >= N::step_beside(N::ZERO);
        let across = if moves { across } else { [N::ZERO; 2] };
        let ([cos, sin], run) = unit(across, [N::ONE, N::ZERO]);
        Self {
            y,
            rise,
            x: u * cos + v * sin,
            run,
            gap: (v * cos - u * sin).abs(),
            major,
            minor,
            slack: N::error_bound(major + minor).half().half(),
        }
    }

    fn at(&self, s: N) -> Point<N> {
        let x = self.x + s * self.run;
        let rho = N::root(x.wide(x) + self.gap.wide(self.gap));
        Point {
            x,
            y: self.y + s * self.rise,
            rho,
            beyond: rho - self.major,
        }
    }

    /// `h` at a point.
    fn height(&self, point: &Point<N>) -> N::Wide {
        let Point { y, beyond, .. } = *point;
        beyond.wide(beyond) + y.wide(y) - self.minor.wide(self.minor)
    }

    fn is_inside(&self, s: N) -> bool {
        self.height(&self.at(s)) <= N::Wide::default()
    }

    /// Half of the slope of `h` at a point, down along the line, or with `turned` up: never less steep than the real
    /// one.
    fn descent(&self, point: &Point<N>, turned: bool) -> N::Wide {
        let turn = |x: N| if turned { -x } else { x };
        let (toward, down) = (turn(-point.beyond), turn(-point.y));
        // Next to the axis the way across turns within roundings.
        let slack = self.slack + self.slack;
        let x = if toward > N::ZERO {
            point.x + slack
        } else {
            point.x - slack
        };
        let lean = self.run * x.div(point.rho).max(-N::ONE).min(N::ONE);
        let rounded = slack.wide(lean.abs()) + slack.wide(self.rise.abs());
        toward.wide(lean) + down.wide(self.rise) + rounded
    }

    /// Returns the first place from `from` to `to` where `h` is 0, in a piece of one curvature. `from` must be outside
    /// in a convex piece and inside in a concave one.
    #[inline(never)]
    fn walk(&self, from: N, to: N, is_convex: bool) -> Option<N> {
        let forward = from <= to;
        let mut s = from;
        for _ in 0..STEPS {
            let point = self.at(s);
            let height = self.height(&point);
            let height = if is_convex { height } else { -height };
            if height < N::Wide::default() {
                return Some(s);
            }
            let descent = self.descent(&point, forward != is_convex);
            if descent <= N::Wide::default() {
                return None;
            }
            let step = N::divide(height, descent).half();
            let room = (to - s).abs();
            if step > room {
                return None;
            }
            s = if forward { s + step } else { s - step };
            if step <= self.slack.half() {
                return Some(s);
            }
        }
        Some(s)
    }

    /// The pieces of the line within half a chord of its origin; `None` if it passes above or below the
    /// solid. `recip_norm2` is 1 over the square of the slope's length.
    pub(super) fn cuts(&self, half_chord: N, recip_norm2: N) -> Option<Cuts<N>> {
        let (mut first, mut last) = (-half_chord, half_chord);
        if self.rise == N::ZERO {
            if self.y.abs() > self.minor {
                return None;
            }
        } else {
            let below = (-self.minor - self.y).div(self.rise);
            let above = (self.minor - self.y).div(self.rise);
            first = first.max(below.min(above));
            last = last.min(below.max(above));
        }
        if first > last {
            return None;
        }
        // Where the line is concave at x = 0: see the head of this file.
        let widest = self.major * (self.run * recip_norm2 * self.run);
        if self.gap >= widest {
            return Some([first, last, last, last]);
        }
        let rho = widest * two_thirds_power(self.gap.div(widest));
        let x = N::root(rho.wide(rho) - self.gap.wide(self.gap));
        let cut = |x: N| (x - self.x).div(self.run).max(first).min(last);
        Some([first, cut(-x), cut(x), last])
    }

    /// Returns the first interval inside whose end counts.
    pub(super) fn first_inside(
        &self,
        [first, concave, convex, last]: Cuts<N>,
        counts: impl Fn(N) -> bool,
    ) -> Option<(N, N)> {
        let (mut from, mut enter) = (first, first);
        let mut inside = self.is_inside(first);
        for (to, is_convex) in [(concave, true), (convex, false), (last, true)] {
            if to <= from {
                continue;
            }
            let inside_after = self.is_inside(to);
            // The walk starts at the end from which there is one way to the root.
            let near = inside != is_convex;
            let (start, end) = if near { (from, to) } else { (to, from) };
            if inside == inside_after {
                // Two roots, or none.
                if near && let Some(root) = self.walk(from, to, is_convex) {
                    let back = self.walk(to, from, is_convex).unwrap_or(root).max(root);
                    let leave = if is_convex { back } else { root };
                    if is_convex {
                        enter = root;
                    }
                    if counts(leave) {
                        return Some((enter, leave));
                    }
                    enter = back;
                }
            } else {
                let root = self.walk(start, end, is_convex).unwrap_or(end);
                if inside_after {
                    enter = root;
                } else if counts(root) {
                    return Some((enter, root.max(enter)));
                }
            }
            (from, inside) = (to, inside_after);
        }
        (inside && counts(last)).then_some((enter, last))
    }
}

/// `q^(2/3)` of a ratio in \[0, 1\], or slightly more.
fn two_thirds_power<N: Arithmetic>(q: N) -> N {
    if q == N::ZERO {
        return q;
    }
    // q^(5/8) is more, and Newton's iteration for the root of w^3 = q^2 comes from there without passing
    // it.
    let root = q.sqrt();
    let mut w = root * root.sqrt().sqrt();
    for _ in 0..8 {
        let v = q.div(w);
        w = w - (w - v * v) * N::ratio(357_913_941);
    }
    w
}
