//! Flat surfaces: the point of a plane next to a computed point, and its error bound.

use crate::axis::pick;
use crate::geometry::Surface;
use crate::number::Arithmetic;

/// The face of a plane at right angles to an axis, at a point of it.
///
/// The point's coordinate on that axis is the plane's own, without any rounding.
#[inline(always)]
pub(crate) fn face<N: Arithmetic>(
    axis: usize,
    is_upper: bool,
    coordinate: N,
    point: [N; 3],
) -> Surface<N> {
    let outward = if is_upper { N::ONE } else { -N::ONE };
    let on = |k: usize, there: N, elsewhere: N| if k == axis { there } else { elsewhere };
    let normal = |k: usize| on(k, outward, N::ZERO);
    let point = |k: usize| on(k, coordinate, point[k]);
    Surface {
        normal: [normal(0), normal(1), normal(2)],
        point: [point(0), point(1), point(2)],
        error: N::step_beside(coordinate),
        is_exact: true,
    }
}

/// The axis at right angles to which a plane with this normal lies, if there is one.
#[inline(always)]
fn axis_of<N: Arithmetic>(normal: [N; 3]) -> Option<usize> {
    let [x, y, z] = normal.map(|component| component == N::ZERO);
    match (x, y, z) {
        (false, true, true) => Some(0),
        (true, false, true) => Some(1),
        (true, true, false) => Some(2),
        _ => None,
    }
}

/// The normal of length 1 of a [`surface`].
#[inline(always)]
pub(crate) fn unit_normal<N: Arithmetic>(normal: [N; 3]) -> [N; 3] {
    match axis_of(normal) {
        Some(axis) => {
            let toward = |k: usize| match k == axis {
                true if normal[k] > N::ZERO => N::ONE,
                true => -N::ONE,
                false => N::ZERO,
            };
            [toward(0), toward(1), toward(2)]
        }
        None => N::normalize(normal).0,
    }
}

/// The surface of a plane, at a point of it next to `point`. `normal` is of any length, and `through` is the point of
/// the plane from which t was computed.
#[inline(always)]
pub(crate) fn surface<N: Arithmetic>(
    normal: [N; 3],
    through: [i32; 3],
    point: [N; 3],
) -> Surface<N> {
    let through = through.map(N::from_lattice);
    let Some(axis) = axis_of(normal) else {
        return tilted(N::normalize(normal).0, through, point);
    };
    face(
        axis,
        pick(normal, axis) > N::ZERO,
        pick(through, axis),
        point,
    )
}

/// The surface of a plane at right angles to no axis, given its normal of length 1. The point moves onto the plane
/// along the normal, by its distance from `through`.
#[inline(always)]
fn tilted<N: Arithmetic>(normal: [N; 3], through: [N; 3], point: [N; 3]) -> Surface<N> {
    let relative = |k: usize| through[k] - point[k];
    let relative = [relative(0), relative(1), relative(2)];
    let away = N::from_wide(N::dot(relative, normal));
    let axis = |k: usize| point[k] + away * normal[k];
    let point = [axis(0), axis(1), axis(2)];
    Surface {
        normal,
        point,
        error: N::plane_error(normal, relative, point),
        is_exact: false,
    }
}
