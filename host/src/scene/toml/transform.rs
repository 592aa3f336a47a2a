//! Transforms of objects: how a file states them, and what they make of shapes.

use super::value::{Fields, Value};
use crate::scene::direction::{TOLERANCE, unit};
use crate::scene::{SceneError, Shape};
use glam::{DAffine3, DMat3, DVec3};

/// The keys that state a transform.
pub(super) const KEYS: &[&str] = &["translate", "rotate", "scale"];

/// Why a shape cannot be transformed: the cause, without its subject, and the remedy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Misfit {
    pub(super) cause: &'static str,
    pub(super) remedy: &'static str,
}

const SINGULAR: Misfit = Misfit {
    cause: "is flattened to nothing by its transforms",
    remedy: "scale by numbers that are not 0 and whose product is not too small for a 64-bit float",
};
const OUT_OF_RANGE: Misfit = Misfit {
    cause: "leaves the range of numbers when its transforms are applied",
    remedy: "use smaller translations and scales nearer to 1",
};
const UNEVEN: Misfit = Misfit {
    cause: "is scaled unevenly, which would make it a shape that there is not",
    remedy: "scale it, and the groups it is in, by the same number on every axis, or use a mesh",
};

/// Reads `scale`, `rotate` and `translate`, which apply in this order.
pub(super) fn read(fields: &Fields<'_>) -> Result<DAffine3, SceneError> {
    let scale = fields.or("scale", DVec3::ONE, scale)?;
    let rotation = fields.or("rotate", DMat3::IDENTITY, rotation)?;
    let translation = fields.or("translate", DVec3::ZERO, Value::vector)?;
    Ok(DAffine3 {
        matrix3: rotation * DMat3::from_diagonal(scale),
        translation,
    })
}

fn scale(value: Value<'_>) -> Result<DVec3, SceneError> {
    let scale = if value.is_array() {
        value.vector()?
    } else {
        DVec3::splat(value.number()?)
    };
    if scale.cmpeq(DVec3::ZERO).any() {
        return Err(value.error(
            "a scale of 0 flattens the object to nothing",
            "scale by numbers other than 0; negative ones mirror",
        ));
    }
    Ok(scale)
}

/// `[x, y, z]`: degrees about these axes, in this order; or `{ axis, degrees }`.
fn rotation(value: Value<'_>) -> Result<DMat3, SceneError> {
    if value.is_table() {
        let fields = value.fields("rotation", &[&["axis", "degrees"]])?;
        let axis = fields.require("axis")?.direction()?;
        let degrees = fields.require("degrees")?.number()?;
        return Ok(about(unit(axis), degrees));
    }
    if !value.is_array() {
        return Err(value.mistyped(
            "angles about x, y and z, or a table with an axis and degrees",
            "`rotate = [0, 90, 0]` or `rotate = { axis = [1, 1, 0], degrees = 90 }`",
        ));
    }
    let angles = value.vector()?;
    Ok(about(DVec3::Z, angles.z) * about(DVec3::Y, angles.y) * about(DVec3::X, angles.x))
}

/// Rodrigues' rotation; exact for multiples of 90 degrees about x, y and z.
fn about(axis: DVec3, degrees: f64) -> DMat3 {
    let (sine, cosine) = match degrees.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        // libm, because the standard library's sines differ from one machine to another.
        other => libm::sincos(other.to_radians()),
    };
    let cross = DMat3::from_cols(
        DVec3::new(0.0, axis.z, -axis.y),
        DVec3::new(-axis.z, 0.0, axis.x),
        DVec3::new(axis.y, -axis.x, 0.0),
    );
    let outer = DMat3::from_cols(axis * axis.x, axis * axis.y, axis * axis.z);
    DMat3::IDENTITY * cosine + cross * sine + outer * (1.0 - cosine)
}

/// The shape after the transform. Fronts stay fronts, also in a mirror.
pub(super) fn apply(by: &DAffine3, shape: &Shape) -> Result<Shape, Misfit> {
    let moved = match shape {
        Shape::Mesh {
            vertices,
            triangles,
        } => mesh(by, vertices, triangles)?,
        Shape::Box { min, max } => match axis_aligned(by.matrix3) {
            Some(matrix) => {
                let by = DAffine3 {
                    matrix3: matrix,
                    ..*by
                };
                let (a, b) = (by.transform_point3(*min), by.transform_point3(*max));
                Shape::Box {
                    min: a.min(b),
                    max: a.max(b),
                }
            }
            None => {
                let (vertices, triangles) = box_mesh(*min, *max);
                mesh(by, &vertices, &triangles)?
            }
        },
        Shape::Sphere { center, radius } => Shape::Sphere {
            center: by.transform_point3(*center),
            radius: radius * similarity(by.matrix3)?,
        },
        Shape::Disc {
            center,
            normal,
            radius,
        } => Shape::Disc {
            center: by.transform_point3(*center),
            normal: to_size_one(by.matrix3).1 * unit(*normal),
            radius: radius * similarity(by.matrix3)?,
        },
        Shape::Torus {
            center,
            axis,
            major_radius,
            minor_radius,
        } => {
            let scale = similarity(by.matrix3)?;
            Shape::Torus {
                center: by.transform_point3(*center),
                axis: to_size_one(by.matrix3).1 * unit(*axis),
                major_radius: major_radius * scale,
                minor_radius: minor_radius * scale,
            }
        }
        Shape::Cone {
            base,
            base_radius,
            apex,
            apex_radius,
        } => {
            let scale = similarity(by.matrix3)?;
            Shape::Cone {
                base: by.transform_point3(*base),
                base_radius: base_radius * scale,
                apex: by.transform_point3(*apex),
                apex_radius: apex_radius * scale,
            }
        }
    };
    if in_range(&moved) {
        Ok(moved)
    } else {
        Err(OUT_OF_RANGE)
    }
}

/// Whether all numbers are finite and no solid has collapsed by rounding.
fn in_range(shape: &Shape) -> bool {
    let length = |length: f64| length > 0.0 && length.is_finite();
    match shape {
        Shape::Sphere { center, radius } => center.is_finite() && length(*radius),
        Shape::Mesh { vertices, .. } => vertices.iter().all(|vertex| vertex.is_finite()),
        Shape::Box { min, max } => min.is_finite() && max.is_finite(),
        Shape::Disc {
            center,
            normal,
            radius,
        } => center.is_finite() && normal.is_finite() && length(*radius),
        Shape::Torus {
            center,
            axis,
            major_radius,
            minor_radius,
        } => {
            center.is_finite()
                && axis.is_finite()
                && length(*major_radius)
                && length(*minor_radius)
        }
        Shape::Cone {
            base,
            base_radius,
            apex,
            apex_radius,
        } => {
            base.is_finite()
                && apex.is_finite()
                && base != apex
                && length(base_radius + apex_radius)
        }
    }
}

/// The largest entry's size, and the matrix divided by it, which cannot overflow when multiplied.
fn to_size_one(matrix: DMat3) -> (f64, DMat3) {
    let DMat3 {
        x_axis: x,
        y_axis: y,
        z_axis: z,
    } = matrix;
    let size = x.abs().max(y.abs()).max(z.abs()).max_element();
    // Vectors are divided exactly where it can be exact; glam multiplies matrices by 1 / size.
    (size, DMat3::from_cols(x / size, y / size, z / size))
}

/// The determinant of the matrix at size 1; negative for a mirror.
fn orientation(matrix: DMat3) -> Result<f64, Misfit> {
    let determinant = to_size_one(matrix).1.determinant();
    if determinant == 0.0 {
        Err(SINGULAR)
    } else if determinant.is_finite() {
        Ok(determinant)
    } else {
        Err(OUT_OF_RANGE)
    }
}

/// How much longer everything gets, if that is the same in every direction.
fn similarity(matrix: DMat3) -> Result<f64, Misfit> {
    orientation(matrix)?;
    let (
        size,
        DMat3 {
            x_axis: x,
            y_axis: y,
            z_axis: z,
        },
    ) = to_size_one(matrix);
    let square = x.length_squared();
    let near = |a: f64, b: f64| (a - b).abs() <= TOLERANCE * square;
    let even = near(y.length_squared(), square) && near(z.length_squared(), square);
    let upright = near(x.dot(y), 0.0) && near(y.dot(z), 0.0) && near(z.dot(x), 0.0);
    if even && upright {
        Ok(size * square.sqrt())
    } else {
        Err(UNEVEN)
    }
}

/// The matrix without its rounding errors, if it takes axes to axes.
fn axis_aligned(matrix: DMat3) -> Option<DMat3> {
    let clean = |column: DVec3| {
        let longest = column.abs().max_element();
        let kept = column.abs().cmpgt(DVec3::splat(longest * TOLERANCE));
        (kept.bitmask().count_ones() == 1).then(|| DVec3::select(kept, column, DVec3::ZERO))
    };
    let clean = DMat3::from_cols(
        clean(matrix.x_axis)?,
        clean(matrix.y_axis)?,
        clean(matrix.z_axis)?,
    );
    // Columns with one entry each may still share a row.
    (orientation(clean).is_ok()).then_some(clean)
}

fn mesh(by: &DAffine3, vertices: &[DVec3], triangles: &[[u32; 3]]) -> Result<Shape, Misfit> {
    let mirrored = orientation(by.matrix3)? < 0.0;
    let wind = |&[a, b, c]: &[u32; 3]| if mirrored { [a, c, b] } else { [a, b, c] };
    Ok(Shape::Mesh {
        vertices: vertices
            .iter()
            .map(|vertex| by.transform_point3(*vertex))
            .collect(),
        triangles: triangles.iter().map(wind).collect(),
    })
}

/// The six faces of a box as twelve triangles, outside in front; a flat box has two faces.
fn box_mesh(min: DVec3, max: DVec3) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    // Bit 0, 1, 2 of a vertex's index: at `max` on x, y, z.
    let corner = |index: u32| {
        let at_max = glam::BVec3::new(index & 1 != 0, index & 2 != 0, index & 4 != 0);
        DVec3::select(at_max, max, min)
    };
    let vertices = (0..8).map(corner).collect();
    let mut triangles = Vec::with_capacity(12);
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        if min[u] == max[u] || min[v] == max[v] {
            continue;
        }
        let (u, v, top) = (1 << u, 1 << v, 1 << axis);
        triangles.extend([[0, v, u | v], [0, u | v, u]]);
        triangles.extend([[top, top | u, top | u | v], [top, top | u | v, top | v]]);
    }
    (vertices, triangles)
}
