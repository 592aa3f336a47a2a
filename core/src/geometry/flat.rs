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

/// The surface of a plane, at a point of it next to `point`. `normal` is of any length, and `through` is the point of
/// the plane from which t was computed.
#[inline(always)]
pub(crate) fn surface<N: Arithmetic>(
    normal: [N; 3],
    through: [i32; 3],
    point: [N; 3],
) -> Surface<N> {
    let through = through.map(N::from_lattice);
    let [x, y, z] = normal.map(|component| component == N::ZERO);
    let axis = match (x, y, z) {
        (false, true, true) => 0,
        (true, false, true) => 1,
        (true, true, false) => 2,
        _ => return tilted(N::normalize(normal).0, through, point),
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
