//! Coordinates along the axis of a torus and across it.

use crate::number::{Arithmetic, Convert, Fixed, Format};

/// Three directions at right angles, each of length 1.
pub(super) struct Frame<N> {
    axis: [N; 3],
    across: [[N; 3]; 2],
}

impl<N: Arithmetic> Frame<N> {
    /// The frame of an axis of any length but 0. It does not depend on any ray, so its angles are right even if a ray
    /// moves hardly across the axis.
    ///
    /// In single precision the rounding of its lengths would be a third of all rounding; integers of 30 bits lose next
    /// to nothing.
    pub(super) fn new(axis: [i32; 3]) -> Self {
        if N::FORMAT != Format::F32 {
            return Self::rounded(axis);
        }
        let Frame { axis, across } = Frame::<Fixed>::rounded(axis);
        let single = |v: [Fixed; 3]| v.map(|x| N::ratio(x.to_q30()));
        Self {
            axis: single(axis),
            across: across.map(single),
        }
    }

    /// The frame of an axis, rounded to the format at every step.
    fn rounded(axis: [i32; 3]) -> Self {
        let [x, y, z] = axis.map(i32::unsigned_abs);
        let axis = divided(N::direction(axis.map(i64::from)));
        let [a, b, c] = axis;
        // The axis times that of the coordinates that is farthest from it.
        let first = if x <= y && x <= z {
            [N::ZERO, c, -b]
        } else if y <= z {
            [-c, N::ZERO, a]
        } else {
            [b, -a, N::ZERO]
        };
        let first = divided(first);
        let cross = |i: usize, j: usize| axis[i] * first[j] - axis[j] * first[i];
        Self {
            axis,
            across: [first, [cross(1, 2), cross(2, 0), cross(0, 1)]],
        }
    }

    /// The components of a vector along the axis and across it.
    pub(super) fn parts(&self, v: [N; 3]) -> (N, [N; 2]) {
        let along = |unit: [N; 3]| N::from_wide(N::dot(v, unit));
        (along(self.axis), self.across.map(along))
    }

    /// The vector of parts.
    pub(super) fn vector(&self, along: N, [first, second]: [N; 2]) -> [N; 3] {
        let [a, b] = self.across;
        let axis = |k: usize| along * self.axis[k] + first * a[k] + second * b[k];
        [axis(0), axis(1), axis(2)]
    }
}

/// Returns a vector scaled to length 1: in floats by quotients, which are rounded once, where products with an inverse
/// are rounded twice.
fn divided<N: Arithmetic>(v: [N; 3]) -> [N; 3] {
    let (unit, length) = N::normalize(v);
    if N::FORMAT == Format::Fixed {
        unit
    } else {
        v.map(|x| x.div(length))
    }
}

/// A vector of two numbers scaled to length 1, and its length; `otherwise` where that is 0.
pub(super) fn unit<N: Arithmetic>([a, b]: [N; 2], otherwise: [N; 2]) -> ([N; 2], N) {
    let ([a, b, _], length) = N::normalize([a, b, N::ZERO]);
    if length == N::ZERO {
        (otherwise, length)
    } else {
        ([a, b], length)
    }
}
