//! Scenes as Python holds them.

mod native;
mod place;

pub use native::NativeScene;

use crate::arguments::{check_file, in_file, in_python, invalid, rejected, structures, unreadable};
use crate::hit_arrays::{
    Arrays, Cast, HitArrays, MeshHitArrays, append, bytes, collected, column, rows, too_large,
    zeros,
};
use crate::load_options::LoadOptions;
use crate::meshes::{self, GivenMesh, Mesh};
use crate::model::{Model, warn};
use crate::query::{self, Any, FirstPrimitive, Hit, Inside, NONE, Rows};
use crate::rays::{Array, Points, TwoArrays};
use crate::threads::{in_pool, workers};
use gridel_core::Settings;
use gridel_host::blob::{Blob, is_blob};
use gridel_host::compile::{Options, compile};
use gridel_host::picture::srgb;
use gridel_host::render::{Job, render};
use gridel_host::scene;
use gridel_host::trace::SceneRay;
use numpy::{IntoPyArray, PyArray2, PyArrayMethods, PyUntypedArray};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::io;
use std::path::PathBuf;

/// Rays of a camera after which signals are noticed, where rows are short: a fraction of a second.
const RAYS_PER_BAND: u64 = 1 << 19;

/// Rows of a band at least, so that threads end at about the same time.
const ROWS_PER_THREAD: u64 = 4;

#[pymethods]
impl NativeScene {
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf, given: LoadOptions) -> PyResult<Self> {
        check_file(&path)?;
        // A blob takes no options, whatever they are.
        let unreadable = |error: io::Error| unreadable(&error, &path);
        if is_blob(&path).map_err(unreadable)? {
            given.reject_for_blob(&path)?;
            let blob = py.detach(|| Blob::read(&path)).map_err(unreadable)?;
            let scene = py.detach(|| Self::of_blob(blob, None, f64::NAN));
            return scene.map_err(|error| in_file(py, &path, error));
        }
        let (options, importing) = (given.for_compiler()?, given.for_import()?);
        let without = given.without()?;
        let imported = in_pool(py, 0, || scene::load_with(&path, &importing))?;
        let mut imported = imported.map_err(rejected)?;
        given.check(&path, &imported, importing.instances)?;
        let mut warnings = given.warnings(&path, &imported);
        for lost in scene::leave_out(&mut imported.scene, &without) {
            warnings.push(format!("{}: {lost}", path.display()));
        }
        for warning in warnings {
            warn(py, &in_python(&warning))?;
        }
        let model = Model {
            scene: imported.scene,
            options,
            file: Some(path.clone()),
        };
        Self::compiled(py, model).map_err(|error| in_file(py, &path, error))
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
        let model = Model {
            scene: meshes::model(&meshes)?,
            options: Options {
                structures: structures(&accel)?,
                lattice_bits,
                flat_meshes: true,
                ..Options::default()
            },
            file: None,
        };
        Self::compiled(py, model)
    }

    /// Returns the arguments of [`from_meshes`](Self::from_meshes); `None` of other scenes.
    #[expect(clippy::type_complexity, reason = "arguments of a function")]
    fn given<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<Option<(Vec<GivenMesh<'py>>, Vec<&'static str>, u8)>> {
        let Some(model) = self.model.as_ref().filter(|model| model.file.is_none()) else {
            return Ok(None);
        };
        let options = &model.options;
        let structures = options.structures.iter().map(|it| it.name());
        Ok(Some((
            meshes::given(py, &model.scene)?,
            structures.collect(),
            options.lattice_bits,
        )))
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
        let (scene, rays) = (self.chosen(how)?, self.rays(&array)?);
        let form = Rows::new(
            self.has_all_triangles(),
            #[inline(always)]
            |hit: &Hit| self.load_ahead(hit),
            #[inline(always)]
            |ray: &SceneRay, hit: &Hit| Some(self.placed(ray, hit)),
            #[inline(always)]
            |hit: &Hit| (hit.t, hit.primitive),
        );
        let found = Cast::of(py, (&scene, rays, how), true, &form)?;
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
        let (scene, rays) = (self.chosen(how)?, self.rays(&array)?);
        let form = Rows::new(
            self.has_all_triangles(),
            #[inline(always)]
            |hit: &Hit| self.load_ahead(hit),
            // A ray whose t leaves single precision hits nothing there.
            #[inline(always)]
            |ray: &SceneRay, hit: &Hit| {
                Some(self.placed(ray, hit)).filter(|placed| (placed.t as f32).is_finite())
            },
            // Nor does one without a direction.
            #[inline(always)]
            |hit: &Hit| {
                let t = if hit.t.is_nan() {
                    f32::INFINITY
                } else {
                    hit.t as f32
                };
                let first = self.firsts.get(hit.object as usize).copied();
                (t, first.map_or(NONE, |first| hit.primitive - first))
            },
        );
        let found = Cast::of(py, (&scene, rays, how), false, &form)?;
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
        let arrays = TwoArrays::borrow(origins, directions)?;
        let rays = arrays.rays()?;
        let scene = self.chosen(how)?;
        let found = query::detach(py, how, rays.len(), || {
            query::ask::<FirstPrimitive>(&scene, rays, how)
        })?
        .map_err(too_large)?;
        Ok(found.into_pyarray(py))
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
        let arrays = TwoArrays::borrow(origins, directions)?;
        let rays = arrays.rays()?;
        let scene = self.chosen(how)?;
        let found = query::detach(py, how, rays.len(), || query::ask::<Any>(&scene, rays, how))?
            .map_err(too_large)?;
        Ok(found.into_pyarray(py))
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
        let (scene, rays) = (self.chosen(how)?, self.rays(&array)?);
        let found = query::detach(py, how, rays.len(), || {
            query::any(&scene, rays, how, &|ray, hit| self.place(ray, hit).t)
        })?
        .map_err(too_large)?;
        Ok(found.into_pyarray(py))
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
        let (scene, rays) = (self.chosen(how)?, self.rays(&array)?);
        let found = query::detach(py, how, rays.len(), || {
            query::count(&scene, rays, how, &|ray, hit| self.place(ray, hit).t)
        })?
        .map_err(too_large)?;
        Ok(found.into_pyarray(py))
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
        let (scene, rays) = (self.chosen(how)?, self.rays(&array)?);
        let (hits, uvs) = query::detach(py, how, rays.len(), || {
            let mut hits = query::all(&scene, rays, how, !self.has_all_triangles())?;
            let uvs = self.place_all(rays, &mut hits)?;
            Ok((hits, uvs))
        })?
        .map_err(too_large)?;
        let arrays = (
            column(py, &hits, |(_, hit)| hit.t)?,
            column(py, &hits, |(_, hit)| hit.object)?,
            column(py, &hits, |(_, hit)| hit.primitive)?,
            column(py, &hits, |(_, hit)| hit.instance)?,
            rows(py, collected(&hits, |(_, hit)| hit.normal)?)?,
            rows(py, uvs)?,
        );
        let leaves = column(py, &hits, |(_, hit)| hit.leaves)?;
        let numbers = column(py, &hits, |&(ray, _)| ray as i64)?;
        Ok((numbers, arrays, leaves))
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
        let arrays = TwoArrays::borrow(origins, directions)?;
        let rays = arrays.rays()?;
        let scene = self.chosen(how)?;
        let chunks = query::detach(py, how, rays.len(), || {
            query::locations(&scene, rays, how, multiple_hits, max_hits, |ray, hit| {
                let met = self.place(ray, hit);
                (met.t, met.place.to_array())
            })
        })?
        .map_err(too_large)?;
        let length = chunks.iter().map(|chunk| chunk.0.len()).sum();
        let places = zeros(py, 3 * length)?;
        let (numbers, triangles) = (zeros(py, length)?, zeros(py, length)?);
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

    /// Returns for each point true if it lies in a closed object, or by parity in any `"object"`, or in the `"scene"`
    /// as a whole.
    #[expect(clippy::too_many_arguments, reason = "keyword arguments of Python")]
    fn contains<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyUntypedArray>,
        within: &str,
        format: &str,
        accel: Option<&str>,
        threads: usize,
    ) -> PyResult<Arrays<'py, bool>> {
        let (how, array) = (
            self.how(format, accel, threads)?,
            Array::borrow(points, "points")?,
        );
        let (scene, points) = (self.chosen(how)?, Points::rows(array.rows("points")?)?);
        let inside = match within {
            "object" => Inside::Object,
            "scene" => Inside::Scene,
            _ => Inside::Closed(self.closed(py, &scene)?),
        };
        let found = query::detach(py, how, points.len(), || {
            query::contains(&scene, points, inside, how)
        })?
        .map_err(too_large)?;
        Ok(found.into_pyarray(py))
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
        let own = Settings::of(self.scene());
        let [width, height] = size.unwrap_or([own.width, own.height]);
        let model = self.model.as_ref();
        let framed = model.map(|model| model.framed(py, [width, height]));
        let framed = framed.transpose()?.flatten();
        let scene = match &framed {
            Some(blob) => &blob.scene().map_err(invalid)?,
            None => self.scene(),
        };
        let settings = Settings {
            width,
            height,
            samples: samples.unwrap_or(own.samples),
            depth: depth.unwrap_or(own.depth),
            ..own
        };
        // NumPy says when a picture is too large; then bands of it, so that signals are noticed between them.
        let pixels = zeros::<u8>(py, 3 * usize::from(width) * usize::from(height))?;
        let rays = u64::from(width).max(1) * u64::from(settings.samples).max(1);
        // Threads take whole rows.
        let least = ROWS_PER_THREAD * workers(threads) as u64;
        let band = (RAYS_PER_BAND / rays).max(least).min(u16::MAX.into()) as u16;
        let mut filled = pixels.readwrite();
        let mut rest = filled.as_slice_mut().map_err(invalid)?;
        let mut first = 0_u16;
        loop {
            let end = first.saturating_add(band).min(height);
            let job = Job {
                rows: first..end,
                ..Job::whole(how.format, how.structure, settings)
            };
            let picture = in_pool(py, threads, || render(scene, &job, &|| ()))?;
            rest = append(rest, &srgb(&picture.map_err(invalid)?, false));
            if end == height {
                break;
            }
            py.check_signals()?;
            first = end;
        }
        drop(filled);
        pixels.reshape([usize::from(height), usize::from(width), 3])
    }

    /// Returns the scene as a blob, compiled again where structures or bits are given.
    fn to_blob<'py>(
        &self,
        py: Python<'py>,
        accel: Option<Vec<String>>,
        lattice_bits: Option<u8>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        if accel.is_none() && lattice_bits.is_none() {
            return bytes(py, self.blob.bytes());
        }
        let Some(model) = &self.model else {
            return Err(invalid(
                "a scene that was read from a blob cannot be compiled anew; load the scene file",
            ));
        };
        let own = &model.options;
        let accel = accel.unwrap_or_else(|| self.accels());
        let options = Options {
            structures: structures(&accel)?,
            lattice_bits: lattice_bits.unwrap_or(own.lattice_bits),
            ..own.clone()
        };
        let compiled = in_pool(py, 0, || compile(&model.scene, &options))?;
        bytes(py, compiled.map_err(rejected)?.blob.bytes())
    }

    /// The names of the structures, the best first.
    #[getter]
    fn accels(&self) -> Vec<String> {
        let structures = self.scene().structures();
        structures.map(|it| it.name().to_owned()).collect()
    }

    /// Numbers of objects, primitives and instances.
    #[getter]
    fn counts(&self) -> (u32, u32, usize) {
        let scene = self.scene();
        let header = scene.header();
        (header.objects, header.primitives, scene.instances().len())
    }

    /// The farthest that rounding to the lattice moved a surface, NaN of a blob.
    #[getter]
    fn displacement(&self) -> f64 {
        self.displacement
    }

    /// The box of the scene, in scene units: lowest and highest corner.
    #[getter]
    fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        let [low, high] = self.corners_of_box().map(|it| it.to_array());
        (low, high)
    }
}
