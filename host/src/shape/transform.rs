//! Vectors and lengths after transforms.

use super::direction::{TOLERANCE, unit};
use glam::{DAffine3, DMat3, DVec3};

/// Vertices and triangles.
pub type Mesh = (Vec<DVec3>, Vec<[u32; 3]>);

/// The reason why a shape cannot be transformed: the cause, without its subject, and the remedy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Misfit {
    pub cause: &'static str,
    pub remedy: &'static str,
}

const SINGULAR: Misfit = Misfit {
    cause: "is flattened to nothing by its transforms",
    remedy: "scale by numbers that are not 0 and whose product is not too small for a 64-bit float",
};
pub const OUT_OF_RANGE: Misfit = Misfit {
    cause: "leaves the range of numbers when its transforms are applied",
    remedy: "use smaller translations and scales nearer to 1",
};
pub const UNEVEN: Misfit = Misfit {
    cause: "is scaled unevenly, which would make it a shape that there is not",
    remedy: "scale it, and the groups it is in, by the same number on every axis, or use a mesh",
};

/// Returns the largest entry's size, and the matrix divided by it, which cannot overflow when multiplied.
pub fn to_size_one(matrix: DMat3) -> (f64, DMat3) {
    let DMat3 {
        x_axis: x,
        y_axis: y,
        z_axis: z,
    } = matrix;
    let size = x.abs().max(y.abs()).max(z.abs()).max_element();
    // Vectors are divided exactly where it can be exact; glam multiplies matrices by 1 / size.
    (size, DMat3::from_cols(x / size, y / size, z / size))
}

/// Returns the determinant of the matrix at size 1; negative for a mirror.
pub fn orientation(matrix: DMat3) -> Result<f64, Misfit> {
    let determinant = to_size_one(matrix).1.determinant();
    if determinant == 0.0 {
        Err(SINGULAR)
    } else if determinant.is_finite() {
        Ok(determinant)
    } else {
        Err(OUT_OF_RANGE)
    }
}

/// Returns the scale of a matrix, if it is the same in every direction.
pub fn similarity(matrix: DMat3) -> Result<f64, Misfit> {
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

/// Returns the matrix without its rounding errors, if it takes axes to axes.
pub fn axis_aligned(matrix: DMat3) -> Option<DMat3> {
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

/// Returns a vector in the direction that a matrix gives another.
pub fn turned(matrix: DMat3, vector: DVec3) -> DVec3 {
    to_size_one(matrix).1 * unit(vector)
}

/// Vertices and triangles after a transform. Fronts stay fronts, also in a mirror.
pub fn mesh(by: &DAffine3, vertices: &[DVec3], triangles: &[[u32; 3]]) -> Result<Mesh, Misfit> {
    let mirrored = orientation(by.matrix3)? < 0.0;
    let wind = |&[a, b, c]: &[u32; 3]| if mirrored { [a, c, b] } else { [a, b, c] };
    let moved = vertices.iter().map(|&vertex| by.transform_point3(vertex));
    Ok((moved.collect(), triangles.iter().map(wind).collect()))
}
