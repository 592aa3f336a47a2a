//! Scenes as Python holds them.

mod place;

use crate::arguments::{format, invalid, options, structure};
use crate::closed::closed;
use crate::hit_arrays::{Arrays, Cast, HitArrays, MeshHitArrays, append, column, rows, zeros};
use crate::meshes::{self, Mesh};
use crate::query::{self, Any, FirstPrimitive, Found, How, NONE};
use crate::rays::{Array, Points, Rays};
use gridel_core::{BlobError, Scene, Settings, Structure};
use gridel_host::blob::{Blob, best_structures};
use gridel_host::compile::{Options, compile};
use gridel_host::picture::srgb;
use gridel_host::render::{Job, render};
use gridel_host::scene::{self, ImportOptions, Imported, Shape};
use gridel_host::trace::SceneRay;
use numpy::{IntoPyArray, PyArray2, PyArrayMethods, PyUntypedArray};
use pyo3::exceptions::{PyFileNotFoundError, PyKeyError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::path::PathBuf;
use std::sync::OnceLock;

type Checked<'b> = Result<Scene<'b>, BlobError>;

self_cell::self_cell!(
    /// A blob and its checked view.
    struct Held {
        owner: Blob,
        #[covariant]
        dependent: Checked,
    }
);

/// A scene, compiled and checked.
#[pyclass(frozen, name = "NativeScene")]
pub struct NativeScene {
    held: Held,
    /// The model that it was compiled from; `None` for a blob.
    model: Option<scene::Scene>,
    /// The number of the first primitive of each object of `model`.
    firsts: Vec<u32>,
    displacement: f64,
    closed: OnceLock<Vec<bool>>,
}

impl NativeScene {
    fn of_blob(blob: Blob, model: Option<scene::Scene>, displacement: f64) -> PyResult<Self> {
        let held = Held::new(blob, |blob| blob.scene());
        if let Err(error) = held.borrow_dependent() {
            return Err(invalid(format!("invalid scene blob: {error}")));
        }
        let mut next = 0;
        let firsts = model
            .iter()
            .flat_map(scene::Scene::all_objects)
            .map(|object| {
                let first = next;
                next += match &object.shape {
                    Shape::Mesh { triangles, .. } => triangles.len() as u32,
                    _ => 1,
                };
                first
            });
        let firsts = firsts.collect();
        Ok(Self {
            held,
            model,
            firsts,
            displacement,
            closed: OnceLock::new(),
        })
    }

    fn compiled(model: scene::Scene, options: &Options) -> PyResult<Self> {
        let compiled = compile(&model, options).map_err(invalid)?;
        let displacement = compiled.report.largest_displacement;
        Self::of_blob(compiled.blob, Some(model), displacement)
    }

    fn scene(&self) -> PyResult<&Scene<'_>> {
        self.held.borrow_dependent().as_ref().map_err(invalid)
    }

    fn how(&self, format_name: &str, accel: Option<&str>, threads: usize) -> PyResult<How> {
        let scene = self.scene()?;
        let structure = match accel {
            Some(name) => structure(name)?,
            None => best_structures(scene).next().unwrap_or(Structure::List),
        };
        if !scene.holds(structure) {
            return Err(PyKeyError::new_err(format!(
                "the scene does not hold the structure `{}`; compile it with accel=[...]",
                structure.name()
            )));
        }
        Ok(How {
            format: format(format_name)?,
            structure,
            threads,
        })
    }

    /// The scene with a structure chosen.
    fn chosen(&self, how: How) -> PyResult<Scene<'_>> {
        let chosen = self.scene()?.choose(how.structure);
        chosen.ok_or_else(|| invalid("the structure is not there"))
    }
}

#[pymethods]
impl NativeScene {
    #[staticmethod]
    #[pyo3(signature = (path, accel, lattice_bits))]
    fn load(py: Python<'_>, path: PathBuf, accel: Vec<String>, lattice_bits: u8) -> PyResult<Self> {
        if !path.is_file() {
            return Err(PyFileNotFoundError::new_err(format!(
                "{}: no such file",
                path.display()
            )));
        }
        let options = options(&accel, lattice_bits)?;
        py.detach(|| {
            if gridel_host::blob::is_blob(&path)? {
                return Self::of_blob(Blob::read(&path)?, None, f64::NAN);
            }
            let imported = scene::load_with(&path, &ImportOptions::default());
            let Imported { scene, .. } = imported.map_err(invalid)?;
            Self::compiled(scene, &options)
        })
    }

    #[staticmethod]
    fn from_blob(py: Python<'_>, bytes: &[u8]) -> PyResult<Self> {
        py.detach(|| Self::of_blob(Blob::new(bytes), None, f64::NAN))
    }

    /// Meshes of vertices (n, 3) float64 and faces (m, 3) int64, each an object.
    #[staticmethod]
    fn from_meshes(
        py: Python<'_>,
        meshes: Vec<Mesh<'_>>,
        accel: Vec<String>,
        lattice_bits: u8,
    ) -> PyResult<Self> {
        let options = options(&accel, lattice_bits)?;
        let model = meshes::model(&meshes)?;
        py.detach(|| Self::compiled(model, &options))
    }

    /// The first hits: t, object, primitive, instance, normal, uv.
    #[pyo3(signature = (rays, format, accel, threads))]
    fn cast<'py>(
        &self,
        py: Python<'py>,
        rays: &Bound<'py, PyUntypedArray>,
        format: &str,
        accel: Option<&str>,
        threads: usize,
    ) -> PyResult<HitArrays<'py>> {
        let (how, array) = (
            self.how(format, accel, threads)?,
            Array::borrow(rays, "rays")?,
        );
        let (scene, rays) = (self.chosen(how)?, Rays::rows(array.rows("rays")?)?);
        let number = |hit: &Found| (hit.t, hit.primitive);
        let place = |ray: &SceneRay, hit: &Found| self.weights(ray, hit);
        let found = Cast::of(py, (&scene, rays, how), true, place, number)?;
        Ok((
            found.t,
            found.object,
            found.primitive,
            found.instance,
            found.normal,
            found.uv,
        ))
    }

    /// The first hits as Open3D has them: t in single precision, object, primitive counted from its object's first,
    /// normal, uv.
    fn cast_rays<'py>(
        &self,
        py: Python<'py>,
        rays: &Bound<'py, PyUntypedArray>,
        threads: usize,
    ) -> PyResult<MeshHitArrays<'py>> {
        let (how, array) = (
            self.how("f32", None, threads)?,
            Array::borrow(rays, "rays")?,
        );
        let (scene, rays) = (self.chosen(how)?, Rays::rows(array.rows("rays")?)?);
        let number = |hit: &Found| {
            // A ray without a direction hits nothing there.
            let t = if hit.t.is_nan() {
                f32::INFINITY
            } else {
                hit.t as f32
            };
            let first = self.firsts.get(hit.object as usize).copied();
            (t, first.map_or(NONE, |first| hit.primitive - first))
        };
        let place = |ray: &SceneRay, hit: &Found| self.weights(ray, hit);
        let found = Cast::of(py, (&scene, rays, how), false, place, number)?;
        Ok((
            found.t,
            found.object,
            found.primitive,
            found.normal,
            found.uv,
        ))
    }

    /// The first primitive of each ray, -1 for none.
    fn first<'py>(
        &self,
        py: Python<'py>,
        origins: &Bound<'py, PyUntypedArray>,
        directions: &Bound<'py, PyUntypedArray>,
        format: &str,
        threads: usize,
    ) -> PyResult<Arrays<'py, i32>> {
        let how = self.how(format, None, threads)?;
        let arrays = [
            Array::borrow(origins, "origins")?,
            Array::borrow(directions, "directions")?,
        ];
        let rays = Rays::two(arrays[0].rows("origins")?, arrays[1].rows("directions")?)?;
        let scene = self.chosen(how)?;
        Ok(py
            .detach(|| query::ask::<FirstPrimitive>(&scene, rays, how))
            .into_pyarray(py))
    }

    /// Returns whether each ray of two arrays hits anything.
    fn any_of<'py>(
        &self,
        py: Python<'py>,
        origins: &Bound<'py, PyUntypedArray>,
        directions: &Bound<'py, PyUntypedArray>,
        format: &str,
        threads: usize,
    ) -> PyResult<Arrays<'py, bool>> {
        let how = self.how(format, None, threads)?;
        let arrays = [
            Array::borrow(origins, "origins")?,
            Array::borrow(directions, "directions")?,
        ];
        let rays = Rays::two(arrays[0].rows("origins")?, arrays[1].rows("directions")?)?;
        let scene = self.chosen(how)?;
        Ok(py
            .detach(|| query::ask::<Any>(&scene, rays, how))
            .into_pyarray(py))
    }

    /// Returns whether each ray hits anything.
    fn any<'py>(
        &self,
        py: Python<'py>,
        rays: &Bound<'py, PyUntypedArray>,
        format: &str,
        accel: Option<&str>,
        threads: usize,
    ) -> PyResult<Arrays<'py, bool>> {
        let (how, array) = (
            self.how(format, accel, threads)?,
            Array::borrow(rays, "rays")?,
        );
        let (scene, rays) = (self.chosen(how)?, Rays::rows(array.rows("rays")?)?);
        Ok(py
            .detach(|| query::ask::<Any>(&scene, rays, how))
            .into_pyarray(py))
    }

    /// The number of hits of each ray.
    fn count<'py>(
        &self,
        py: Python<'py>,
        rays: &Bound<'py, PyUntypedArray>,
        format: &str,
        accel: Option<&str>,
        threads: usize,
    ) -> PyResult<Arrays<'py, u32>> {
        let (how, array) = (
            self.how(format, accel, threads)?,
            Array::borrow(rays, "rays")?,
        );
        let (scene, rays) = (self.chosen(how)?, Rays::rows(array.rows("rays")?)?);
        Ok(py
            .detach(|| query::count(&scene, rays, how))
            .into_pyarray(py))
    }

    /// All hits: ray, t, object, primitive, instance, leaves, normal, uv.
    fn all<'py>(
        &self,
        py: Python<'py>,
        rays: &Bound<'py, PyUntypedArray>,
        format: &str,
        accel: Option<&str>,
        threads: usize,
    ) -> PyResult<(Arrays<'py, i64>, HitArrays<'py>, Arrays<'py, bool>)> {
        let (how, array) = (
            self.how(format, accel, threads)?,
            Array::borrow(rays, "rays")?,
        );
        let (scene, rays) = (self.chosen(how)?, Rays::rows(array.rows("rays")?)?);
        let (hits, uvs) = py.detach(|| {
            let mut hits = query::all(&scene, rays, how).concat();
            // Triangles closer to each other than the lattice moved them keep the order in which they are hit.
            let mut last = (usize::MAX, f64::NEG_INFINITY);
            let uvs: Vec<[f32; 2]> = hits
                .iter_mut()
                .map(|(number, hit)| {
                    let (t, _, uv) = self.place(&rays.get(*number), hit);
                    hit.t = if last.0 == *number { t.max(last.1) } else { t };
                    last = (*number, hit.t);
                    uv.map(|weight| weight as f32)
                })
                .collect();
            (hits, uvs)
        });
        let arrays = (
            column(py, &hits, |(_, hit)| hit.t),
            column(py, &hits, |(_, hit)| hit.object),
            column(py, &hits, |(_, hit)| hit.primitive),
            column(py, &hits, |(_, hit)| hit.instance),
            rows(py, hits.iter().map(|(_, hit)| hit.normal).collect())?,
            rows(py, uvs)?,
        );
        let leaves = column(py, &hits, |(_, hit)| hit.leaves);
        Ok((column(py, &hits, |&(ray, _)| ray as i64), arrays, leaves))
    }

    /// Locations, rays and triangles of the hits of rays: all, or the first of each ray.
    #[expect(clippy::type_complexity, reason = "a tuple of arrays")]
    #[pyo3(signature = (origins, directions, multiple_hits, max_hits, format, threads))]
    #[expect(clippy::too_many_arguments, reason = "the arguments of trimesh")]
    fn locations<'py>(
        &self,
        py: Python<'py>,
        origins: &Bound<'py, PyUntypedArray>,
        directions: &Bound<'py, PyUntypedArray>,
        multiple_hits: bool,
        max_hits: Option<usize>,
        format: &str,
        threads: usize,
    ) -> PyResult<(
        Bound<'py, PyArray2<f64>>,
        Arrays<'py, i64>,
        Arrays<'py, i64>,
    )> {
        let how = self.how(format, None, threads)?;
        let arrays = [
            Array::borrow(origins, "origins")?,
            Array::borrow(directions, "directions")?,
        ];
        let rays = Rays::two(arrays[0].rows("origins")?, arrays[1].rows("directions")?)?;
        let scene = self.chosen(how)?;
        let chunks = py.detach(|| {
            query::locations(&scene, rays, how, multiple_hits, max_hits, |ray, hit| {
                self.place(ray, hit).1.to_array()
            })
        });
        let length = chunks.iter().map(|chunk| chunk.0.len()).sum();
        let places = zeros(py, 3 * length);
        let [numbers, triangles] = [length; 2].map(|length| zeros(py, length));
        {
            let mut places = places.readwrite();
            let [mut numbers, mut triangles] =
                [&numbers, &triangles].map(|array| array.readwrite());
            let mut places = places.as_slice_mut().map_err(invalid)?;
            let mut numbers = numbers.as_slice_mut().map_err(invalid)?;
            let mut triangles = triangles.as_slice_mut().map_err(invalid)?;
            for chunk in chunks {
                places = append(places, chunk.0.as_flattened());
                numbers = append(numbers, &chunk.1);
                triangles = append(triangles, &chunk.2);
            }
        }
        Ok((places.reshape([length, 3])?, numbers, triangles))
    }

    /// Returns whether each point lies in a closed object, or with `closed_only` false in any object by parity.
    #[expect(clippy::too_many_arguments, reason = "keyword arguments of Python")]
    fn contains<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyUntypedArray>,
        closed_only: bool,
        format: &str,
        accel: Option<&str>,
        threads: usize,
    ) -> PyResult<Arrays<'py, bool>> {
        let (how, array) = (
            self.how(format, accel, threads)?,
            Array::borrow(points, "points")?,
        );
        let (scene, points) = (self.chosen(how)?, Points::rows(array.rows("points")?)?);
        let closed = closed_only.then(|| self.closed.get_or_init(|| py.detach(|| closed(&scene))));
        if closed.is_some_and(|closed| !closed.contains(&true)) {
            return Err(invalid(
                "no object of the scene is closed; pass closed_only=False to count crossings all the same",
            ));
        }
        let closed = closed.map(Vec::as_slice);
        Ok(py
            .detach(|| query::contains(&scene, points, closed, how))
            .into_pyarray(py))
    }

    /// A picture: (height, width, 3) uint8.
    #[expect(clippy::too_many_arguments, reason = "keyword arguments of Python")]
    fn render<'py>(
        &self,
        py: Python<'py>,
        size: Option<[u16; 2]>,
        samples: Option<u16>,
        depth: Option<u8>,
        format: &str,
        accel: Option<&str>,
        threads: usize,
    ) -> PyResult<Bound<'py, numpy::PyArray3<u8>>> {
        let how = self.how(format, accel, threads)?;
        let scene = self.scene()?;
        let own = Settings::of(scene);
        let [width, height] = size.unwrap_or([own.width, own.height]);
        let settings = Settings {
            width,
            height,
            samples: samples.unwrap_or(own.samples),
            depth: depth.unwrap_or(own.depth),
            ..own
        };
        let job = Job::whole(how.format, how.structure, settings);
        let picture = py.detach(|| query::with_threads(threads, || render(scene, &job, &|| ())));
        let pixels = srgb(&picture.map_err(invalid)?, false);
        let shape = [usize::from(height), usize::from(width), 3];
        pixels.into_pyarray(py).reshape(shape)
    }

    /// Returns the scene as a blob, compiled again where structures or bits are given.
    fn to_blob<'py>(
        &self,
        py: Python<'py>,
        accel: Option<Vec<String>>,
        lattice_bits: Option<u8>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        if accel.is_none() && lattice_bits.is_none() {
            return Ok(PyBytes::new(py, self.held.borrow_owner().bytes()));
        }
        let Some(model) = &self.model else {
            return Err(invalid(
                "a scene that was read from a blob cannot be compiled anew; load the scene file",
            ));
        };
        let accel = accel.unwrap_or_else(|| self.accels());
        let options = options(&accel, lattice_bits.unwrap_or(24))?;
        let compiled = py.detach(|| compile(model, &options)).map_err(invalid)?;
        Ok(PyBytes::new(py, compiled.blob.bytes()))
    }

    /// The names of the structures, the fastest first.
    #[getter]
    fn accels(&self) -> Vec<String> {
        let names = self.scene().map(|scene| {
            best_structures(scene)
                .map(|structure| structure.name().to_owned())
                .collect()
        });
        names.unwrap_or_default()
    }

    /// Numbers of objects, primitives and instances.
    #[getter]
    fn counts(&self) -> PyResult<(u32, u32, usize)> {
        let scene = self.scene()?;
        let header = scene.header();
        Ok((header.objects, header.primitives, scene.instances().len()))
    }

    /// The farthest that rounding to the lattice moved a surface, NaN of a blob.
    #[getter]
    fn displacement(&self) -> f64 {
        self.displacement
    }

    /// The box of the scene, in scene units: lowest and highest corner.
    #[getter]
    fn bounds(&self) -> PyResult<([f64; 3], [f64; 3])> {
        let scene = self.scene()?;
        let frame = gridel_host::trace::Frame::of(scene);
        let corner = |side: usize| frame.place(scene.bounds().0.map(|it| f64::from(it[side])));
        Ok((corner(0).to_array(), corner(1).to_array()))
    }
}
