//! Polygons cut into triangles by clipping ears (Meisters 1975).

use glam::{DVec2, DVec3};

/// The most corners a polygon may have; cutting takes up to the third power of them in time.
pub(super) const MAX_CORNERS: usize = 1024;

/// Why a polygon cannot be cut into triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Flaw {
    NoArea,
    CrossesItself,
}

/// Cuts a polygon into triangles that wind as it does; they hold indices of `corners`. A convex
/// one becomes a fan around its first corner. A polygon that is not flat is cut as it looks along
/// its average normal.
pub(super) fn triangulate(corners: &[DVec3]) -> Result<Vec<[usize; 3]>, Flaw> {
    let points = flatten(corners)?;
    if crosses_itself(&points) {
        return Err(Flaw::CrossesItself);
    }
    let mut rest: Vec<usize> = (0..points.len()).collect();
    let mut triangles = Vec::with_capacity(points.len() - 2);
    while rest.len() > 3 {
        let tip = (1..=rest.len())
            .map(|index| index % rest.len())
            .find(|&index| is_ear(&points, &rest, index))
            .ok_or(Flaw::CrossesItself)?;
        triangles.push(around(&rest, tip));
        rest.remove(tip);
    }
    let last = around(&rest, 1);
    if turns_left(&points, last) {
        triangles.push(last);
        Ok(triangles)
    } else {
        Err(Flaw::CrossesItself)
    }
}

/// The corners seen along the axis nearest to the normal, counter-clockwise.
fn flatten(corners: &[DVec3]) -> Result<Vec<DVec2>, Flaw> {
    let origin = corners.first().copied().ok_or(Flaw::NoArea)?;
    let extent = corners
        .iter()
        .map(|&corner| (corner - origin).abs().max_element())
        .fold(0.0, f64::max);
    // Brought to a size of 1, so that no product overflows or underflows.
    let scaled = |corner: &DVec3| (*corner - origin) / extent;
    let next = corners.iter().cycle().skip(1);
    let normal: DVec3 = corners
        .iter()
        .zip(next)
        .map(|(a, b)| scaled(a).cross(scaled(b)))
        .sum();
    let axis = normal.abs().max_position();
    let along = normal[axis];
    if along == 0.0 || !along.is_finite() {
        return Err(Flaw::NoArea);
    }
    let flat = |corner: &DVec3| {
        let point = scaled(corner);
        let (u, v) = (point[(axis + 1) % 3], point[(axis + 2) % 3]);
        if along > 0.0 {
            DVec2::new(u, v)
        } else {
            DVec2::new(v, u)
        }
    };
    Ok(corners.iter().map(flat).collect())
}

/// The corner at `index` of the polygon `rest` between its neighbours.
fn around(rest: &[usize], index: usize) -> [usize; 3] {
    let count = rest.len();
    [
        rest[(index + count - 1) % count],
        rest[index],
        rest[(index + 1) % count],
    ]
}

/// Twice the area of a triangle; positive where it turns left.
fn turn(points: &[DVec2], [a, b, c]: [usize; 3]) -> f64 {
    (points[b] - points[a]).perp_dot(points[c] - points[a])
}

fn turns_left(points: &[DVec2], corner: [usize; 3]) -> bool {
    turn(points, corner) > 0.0
}

/// Whether the corner can be cut off: it turns left, and no corner that might poke into its
/// triangle does. Only corners that do not turn left can.
fn is_ear(points: &[DVec2], rest: &[usize], index: usize) -> bool {
    let ear = around(rest, index);
    let [a, b, c] = ear;
    turns_left(points, ear)
        && !(0..rest.len()).any(|other| {
            let point = rest[other];
            !ear.contains(&point)
                && !turns_left(points, around(rest, other))
                && [[a, b, point], [b, c, point], [c, a, point]]
                    .into_iter()
                    .all(|side| turn(points, side) >= 0.0)
        })
}

/// Whether two sides that are not neighbours cross.
fn crosses_itself(points: &[DVec2]) -> bool {
    let count = points.len();
    let apart = |a, b, c, d| turn(points, [a, b, c]) * turn(points, [a, b, d]) < 0.0;
    (0..count).any(|i| {
        (i + 2..count).any(|j| {
            let (a, b, c, d) = (i, i + 1, j, (j + 1) % count);
            apart(a, b, c, d) && apart(c, d, a, b)
        })
    })
}
