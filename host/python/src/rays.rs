//! Rays and points as NumPy arrays hold them: read in place.

use glam::DVec3;
use gridel_host::trace::SceneRay;
use numpy::{PyReadonlyArrayDyn, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

/// An array of single or double precision, kept from being written to by Rust while it is read.
pub enum Array<'py> {
    F32(PyReadonlyArrayDyn<'py, f32>),
    F64(PyReadonlyArrayDyn<'py, f64>),
}

/// The numbers of an array in C order.
#[derive(Clone, Copy)]
pub enum Values<'a> {
    F32(&'a [f32]),
    F64(&'a [f64]),
}

impl<'py> Array<'py> {
    /// Borrows an array of one or more rows.
    pub fn borrow(array: &Bound<'py, PyUntypedArray>, what: &str) -> PyResult<Self> {
        if let Ok(array) = array.extract::<PyReadonlyArrayDyn<'py, f64>>() {
            return Ok(Self::F64(array));
        }
        if let Ok(array) = array.extract::<PyReadonlyArrayDyn<'py, f32>>() {
            return Ok(Self::F32(array));
        }
        let kind = array.dtype();
        Err(PyTypeError::new_err(format!(
            "{what}: the array has the type {kind}; it must be float32 or float64"
        )))
    }

    /// The numbers, and how many make a row.
    pub fn rows(&self, what: &str) -> PyResult<(Values<'_>, usize)> {
        let contiguous =
            || PyValueError::new_err(format!("{what}: the array must be C-contiguous"));
        let (values, shape) = match self {
            Self::F32(array) => (
                Values::F32(array.as_slice().map_err(|_| contiguous())?),
                array.shape(),
            ),
            Self::F64(array) => (
                Values::F64(array.as_slice().map_err(|_| contiguous())?),
                array.shape(),
            ),
        };
        let width = shape.last().copied();
        let width =
            width.ok_or_else(|| PyValueError::new_err(format!("{what}: a number is no array")))?;
        Ok((values, width))
    }
}

impl Values<'_> {
    fn len(&self) -> usize {
        match self {
            Self::F32(values) => values.len(),
            Self::F64(values) => values.len(),
        }
    }

    #[inline(always)]
    fn three(&self, at: usize) -> DVec3 {
        match self {
            Self::F32(values) => {
                let values = &values[at..at + 3];
                DVec3::new(values[0].into(), values[1].into(), values[2].into())
            }
            Self::F64(values) => {
                let values = &values[at..at + 3];
                DVec3::new(values[0], values[1], values[2])
            }
        }
    }

    #[inline(always)]
    fn one(&self, at: usize) -> f64 {
        match self {
            Self::F32(values) => values[at].into(),
            Self::F64(values) => values[at],
        }
    }
}

/// Rays: an array of rows, or one of origins and one of directions.
#[derive(Clone, Copy)]
pub enum Rays<'a> {
    /// Origin and direction; with eight numbers origin, tmin, direction, tmax.
    Rows { values: Values<'a>, width: usize },
    Two {
        origins: Values<'a>,
        directions: Values<'a>,
    },
}

impl<'a> Rays<'a> {
    /// Rays in rows of six or eight numbers.
    pub fn rows((values, width): (Values<'a>, usize)) -> PyResult<Self> {
        match width {
            6 | 8 => Ok(Self::Rows { values, width }),
            _ => Err(PyValueError::new_err(format!(
                "rays: rows have {width} numbers; they must have 6 (origin, direction) or 8 (origin, tmin, direction, \
                 tmax)"
            ))),
        }
    }

    /// Rays from as many origins as directions.
    pub fn two(origins: (Values<'a>, usize), directions: (Values<'a>, usize)) -> PyResult<Self> {
        let lengths = [origins.0.len(), directions.0.len()];
        if origins.1 != 3 || directions.1 != 3 || lengths[0] != lengths[1] {
            return Err(PyValueError::new_err(
                "origins and directions must be two arrays of one shape (n, 3)",
            ));
        }
        Ok(Self::Two {
            origins: origins.0,
            directions: directions.0,
        })
    }

    /// Number of rays.
    pub fn len(&self) -> usize {
        match self {
            Self::Rows { values, width } => values.len() / width,
            Self::Two { origins, .. } => origins.len() / 3,
        }
    }

    /// A ray, by its number.
    #[inline(always)]
    pub fn get(&self, number: usize) -> SceneRay {
        match self {
            Self::Rows { values, width: 6 } => SceneRay {
                origin: values.three(6 * number),
                direction: values.three(6 * number + 3),
                tmin: 0.0,
                tmax: f64::INFINITY,
            },
            Self::Rows { values, .. } => SceneRay {
                origin: values.three(8 * number),
                tmin: values.one(8 * number + 3),
                direction: values.three(8 * number + 4),
                tmax: values.one(8 * number + 7),
            },
            Self::Two {
                origins,
                directions,
            } => SceneRay {
                origin: origins.three(3 * number),
                direction: directions.three(3 * number),
                tmin: 0.0,
                tmax: f64::INFINITY,
            },
        }
    }
}

/// Points in rows of three numbers.
#[derive(Clone, Copy)]
pub struct Points<'a>(Values<'a>);

impl<'a> Points<'a> {
    pub fn rows((values, width): (Values<'a>, usize)) -> PyResult<Self> {
        if width != 3 {
            return Err(PyValueError::new_err(format!(
                "points: rows have {width} numbers; they must have 3"
            )));
        }
        Ok(Self(values))
    }

    pub fn len(&self) -> usize {
        self.0.len() / 3
    }

    #[inline(always)]
    pub fn get(&self, number: usize) -> DVec3 {
        self.0.three(3 * number)
    }
}
