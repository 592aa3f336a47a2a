//! Hits as arrays of NumPy's, and blobs as bytes of Python's.

use crate::arguments::invalid;
use crate::query::{self, Columns, Hit, How, Placed, Rows};
use crate::rays::Rays;
use gridel_core::Scene;
use gridel_host::trace::SceneRay;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::collections::TryReserveError;

pub type Arrays<'py, T> = Bound<'py, PyArray1<T>>;

/// Hits as arrays: t, object, primitive, instance, normal, uv.
pub type HitArrays<'py> = (
    Arrays<'py, f64>,
    Arrays<'py, u32>,
    Arrays<'py, u32>,
    Arrays<'py, u32>,
    Bound<'py, PyArray2<f32>>,
    Bound<'py, PyArray2<f32>>,
);

/// First hits as Open3D has them: t, object, primitive, normal, uv.
pub type MeshHitArrays<'py> = (
    Arrays<'py, f32>,
    Arrays<'py, u32>,
    Arrays<'py, u32>,
    Bound<'py, PyArray2<f32>>,
    Bound<'py, PyArray2<f32>>,
);

/// The first hits of rays, in memory of NumPy's, which takes large pages where there are some.
pub struct Cast<'py, T> {
    pub t: Arrays<'py, T>,
    pub object: Arrays<'py, u32>,
    pub primitive: Arrays<'py, u32>,
    pub instance: Arrays<'py, u32>,
    pub normal: Bound<'py, PyArray2<f32>>,
    pub uv: Bound<'py, PyArray2<f32>>,
}

/// Zeros, which are not written to before they are filled in. NumPy's own function, as it reports when memory is short.
pub fn zeros<T: numpy::Element>(py: Python<'_>, length: usize) -> PyResult<Arrays<'_, T>> {
    let zeros = py
        .import("numpy")?
        .call_method1("zeros", (length, T::get_dtype(py)))?;
    Ok(zeros.cast_into()?)
}

/// A copy as Python has it; a MemoryError where memory is short, of which `PyBytes::new` panics.
pub fn bytes<'py>(py: Python<'py>, from: &[u8]) -> PyResult<Bound<'py, PyBytes>> {
    PyBytes::new_with(py, from.len(), |to| {
        to.copy_from_slice(from);
        Ok(())
    })
}

/// The error of work that needs more memory than there is.
pub fn too_large(_: TryReserveError) -> PyErr {
    PyMemoryError::new_err("the result does not fit in memory: ask for fewer rays at once")
}

impl<'py, T: numpy::Element + Send + Copy> Cast<'py, T> {
    /// Finds the first hit of each ray.
    pub fn of(
        py: Python<'py>,
        (scene, rays, how): (&Scene<'_>, Rays<'_>, How),
        has_instances: bool,
        form: &Rows<
            impl Fn(&Hit) + Sync + Send,
            impl Fn(&SceneRay, &Hit) -> Option<Placed> + Sync + Send,
            impl Fn(&Hit) -> (T, u32) + Sync + Send,
        >,
    ) -> PyResult<Self> {
        let length = rays.len();
        let t = zeros(py, length)?;
        let (object, primitive) = (zeros(py, length)?, zeros(py, length)?);
        let instance = zeros(py, if has_instances { length } else { 0 })?;
        let (normal, uv) = (zeros(py, 3 * length)?, zeros(py, 2 * length)?);
        {
            let mut t = t.readwrite();
            let [mut object, mut primitive, mut instance] =
                [&object, &primitive, &instance].map(|array| array.readwrite());
            let [mut normal, mut uv] = [&normal, &uv].map(|array| array.readwrite());
            let (normal, _) = normal.as_slice_mut().map_err(invalid)?.as_chunks_mut();
            let (uv, _) = uv.as_slice_mut().map_err(invalid)?.as_chunks_mut();
            let columns = Columns {
                t: t.as_slice_mut().map_err(invalid)?,
                object: object.as_slice_mut().map_err(invalid)?,
                primitive: primitive.as_slice_mut().map_err(invalid)?,
                instance: instance.as_slice_mut().map_err(invalid)?,
                normal,
                uv,
            };
            let cast = || query::cast(scene, rays, how, columns, form);
            query::detach(py, how, length, cast)?;
        }
        Ok(Self {
            t,
            object,
            primitive,
            instance,
            normal: normal.reshape([length, 3])?,
            uv: uv.reshape([length, 2])?,
        })
    }
}

/// Collects what each hit has.
pub fn collected<T>(hits: &[(usize, Hit)], of: impl Fn(&(usize, Hit)) -> T) -> PyResult<Vec<T>> {
    let mut all = Vec::new();
    all.try_reserve_exact(hits.len()).map_err(too_large)?;
    all.extend(hits.iter().map(of));
    Ok(all)
}

/// Collects one number of each hit.
pub fn column<'py, T: numpy::Element>(
    py: Python<'py>,
    hits: &[(usize, Hit)],
    number: impl Fn(&(usize, Hit)) -> T,
) -> PyResult<Arrays<'py, T>> {
    Ok(collected(hits, number)?.into_pyarray(py))
}

/// Copies values to the start of a slice, and returns the rest of it.
pub fn append<'s, T: Copy>(to: &'s mut [T], values: &[T]) -> &'s mut [T] {
    let (first, rest) = to.split_at_mut(values.len());
    first.copy_from_slice(values);
    rest
}

/// An array of rows.
pub fn rows<'py, T: numpy::Element, const WIDTH: usize>(
    py: Python<'py>,
    rows: Vec<[T; WIDTH]>,
) -> PyResult<Bound<'py, PyArray2<T>>> {
    let length = rows.len();
    rows.into_flattened()
        .into_pyarray(py)
        .reshape([length, WIDTH])
}
