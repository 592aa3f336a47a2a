//! The map of an instance by its integers, for exact arithmetic that shares no code with the kernels.

use super::exact::{Line, Real, Vector, dot, minus};
use gridel_core::format::instance::{Instance, MATRIX_BITS};

/// The map of an instance.
#[derive(Clone, Debug)]
pub struct ExactMap {
    rows: [Vector; 3],
    center: Vector,
    /// These entries in double precision, which is exact for single entries.
    linear: [[f64; 3]; 3],
    middle: [f64; 3],
    /// Units of the part in one of the scene.
    scale: f64,
}

impl ExactMap {
    pub fn of(instance: &Instance) -> Self {
        let power = f64::powi(2.0, i32::from(instance.exponent) - MATRIX_BITS as i32);
        let linear = instance.matrix.map(|row| row.map(|x| f64::from(x) * power));
        let middle = instance.center.map(|x| f64::from(x) / 256.0);
        let [x, y, z] = linear[0];
        Self {
            rows: linear.map(|row| row.map(Real::of)),
            center: middle.map(Real::of),
            linear,
            middle,
            scale: (x * x + y * y + z * z).sqrt(),
        }
    }

    /// Converts a line to the part; its t stays.
    pub fn line(&self, line: &Line) -> Line {
        let from_center = minus(&line.origin, &self.center);
        Line {
            origin: [0, 1, 2].map(|k| dot(&self.rows[k], &from_center)),
            slope: [0, 1, 2].map(|k| dot(&self.rows[k], &line.slope)),
        }
    }

    /// Converts a place of the scene to the part, in double precision.
    pub fn point(&self, place: [f64; 3]) -> [f64; 3] {
        self.direction([0, 1, 2].map(|k| place[k] - self.middle[k]))
    }

    /// Converts a direction of the scene to the part, with the part's length.
    pub fn direction(&self, way: [f64; 3]) -> [f64; 3] {
        self.linear
            .map(|row| (0..3).map(|k| row[k] * way[k]).sum::<f64>())
    }

    /// Converts a place of the part to the scene, in double precision.
    pub fn back(&self, place: [f64; 3]) -> [f64; 3] {
        let square = self.scale * self.scale;
        [0, 1, 2].map(|k| {
            let sum: f64 = (0..3).map(|row| self.linear[row][k] * place[row]).sum();
            self.middle[k] + sum / square
        })
    }

    /// Converts a length of the part to the scene.
    pub fn length(&self, length: f64) -> f64 {
        length / self.scale
    }

    /// Converts a length of the scene to the part.
    pub fn own_length(&self, length: f64) -> f64 {
        length * self.scale
    }

    /// Returns the largest coordinate of a place of the scene, as seen from the instance's center.
    pub fn reach(&self, place: [f64; 3]) -> f64 {
        let from_center = [0, 1, 2].map(|k| (place[k] - self.middle[k]).abs());
        from_center.into_iter().fold(0.0, f64::max)
    }
}
