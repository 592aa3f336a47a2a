//! Rays and points as NumPy arrays hold them: read in place.

use glam::DVec3;
use gridel_core::format::limits::FARTHEST;
use gridel_core::{Kind, Number, Ray, RayError, Scene};
use gridel_host::trace::{DirectionScale, Frame, Rejection, SceneRay};
use numpy::{PyReadonlyArrayDyn, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use std::ops::Range;

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

/// Origins and directions of rays in two arrays.
pub struct TwoArrays<'py> {
    origins: Array<'py>,
    directions: Array<'py>,
}

impl<'py> TwoArrays<'py> {
    pub fn borrow(
        origins: &Bound<'py, PyUntypedArray>,
        directions: &Bound<'py, PyUntypedArray>,
    ) -> PyResult<Self> {
        Ok(Self {
            origins: Array::borrow(origins, "origins")?,
            directions: Array::borrow(directions, "directions")?,
        })
    }

    pub fn rays(&self) -> PyResult<Rays<'_>> {
        Rays::two(
            self.origins.rows("origins")?,
            self.directions.rows("directions")?,
        )
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
            Self::F32(values) => three(values, at),
            Self::F64(values) => three(values, at),
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
    Rows {
        values: Values<'a>,
        width: usize,
        slack: Slack,
    },
    Two {
        origins: Values<'a>,
        directions: Values<'a>,
    },
}

impl<'a> Rays<'a> {
    /// Rays in rows of six or eight numbers.
    pub fn rows((values, width): (Values<'a>, usize), slack: Slack) -> PyResult<Self> {
        match width {
            6 | 8 => Ok(Self::Rows {
                values,
                width,
                slack,
            }),
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
            Self::Rows { values, width, .. } => values.len() / width,
            Self::Two { origins, .. } => origins.len() / 3,
        }
    }

    /// Makes rays ready for the core, by their numbers.
    pub fn fill<N: Number>(
        &self,
        (scene, frame): (&Scene<'_>, &Frame),
        numbers: Range<usize>,
        ready: &mut Vec<Ready<N>>,
    ) {
        ready.clear();
        let places = (scene, frame, numbers);
        // A loop for each layout, so that no ray waits to learn its own.
        match *self {
            Self::Rows { values, width, .. } => match (values, width) {
                (Values::F32(values), 6) => fill(places, ready, |number| six(values, number)),
                (Values::F64(values), 6) => fill(places, ready, |number| six(values, number)),
                _ => fill(places, ready, |number| self.searched(number)),
            },
            Self::Two {
                origins,
                directions,
            } => match (origins, directions) {
                (Values::F64(origins), Values::F64(directions)) => fill(places, ready, |number| {
                    endless(three(origins, 3 * number), three(directions, 3 * number))
                }),
                _ => fill(places, ready, |number| self.searched(number)),
            },
        }
    }

    /// True if rays may end anywhere.
    pub fn have_limits(&self) -> bool {
        matches!(self, Self::Rows { width: 8, .. })
    }

    /// Returns whether a ray has no limits but its origin.
    pub fn is_endless(&self, number: usize) -> bool {
        match self {
            Self::Rows {
                values, width: 8, ..
            } => values.one(8 * number + 3) == 0.0 && values.one(8 * number + 7) == f64::INFINITY,
            _ => true,
        }
    }

    /// Returns whether a t is within the limits of a ray. One of a ray that is searched no farther is.
    #[inline(always)]
    pub fn holds(&self, number: usize, t: f64) -> bool {
        match self {
            Self::Rows {
                values, width: 8, ..
            } => values.one(8 * number + 3) <= t && t <= values.one(8 * number + 7),
            _ => true,
        }
    }

    /// A ray as it is searched, by its number: a little beyond its limits, if it has any.
    #[inline(always)]
    pub fn searched(&self, number: usize) -> SceneRay {
        match *self {
            Self::Rows {
                values, width: 6, ..
            } => endless(values.three(6 * number), values.three(6 * number + 3)),
            Self::Rows { values, slack, .. } => {
                let given = SceneRay {
                    origin: values.three(8 * number),
                    tmin: values.one(8 * number + 3),
                    direction: values.three(8 * number + 4),
                    tmax: values.one(8 * number + 7),
                };
                widened(given, slack)
            }
            Self::Two {
                origins,
                directions,
            } => endless(origins.three(3 * number), directions.three(3 * number)),
        }
    }
}

/// How far beyond its limits a ray is searched.
#[derive(Clone, Copy)]
pub struct Slack {
    /// In scene units.
    pub length: f64,
    /// True where all t are computed anew from triangles. A ray that is searched from behind its origin has other t than
    /// one from there: their rounding depends on where it enters the scene's box.
    pub from_behind: bool,
}

/// A ray with limits farther apart. Its own origin, at 0, is no limit: a ray that is searched from before it takes longer.
fn widened(ray: SceneRay, slack: Slack) -> SceneRay {
    let least = slack.length / ray.direction.length();
    if !least.is_finite() || ray.tmin.is_nan() || ray.tmin > ray.tmax {
        return ray;
    }
    let by = |limit: f64| {
        if limit.is_infinite() {
            0.0
        } else {
            least + 4.0 * f64::EPSILON * limit.abs()
        }
    };
    let tmin = match ray.tmin {
        0.0 => 0.0,
        tmin if tmin > 0.0 && !slack.from_behind => (tmin - by(tmin)).max(0.0),
        tmin => tmin - by(tmin),
    };
    SceneRay {
        tmin,
        tmax: ray.tmax + by(ray.tmax),
        ..ray
    }
}

/// A ray in the core's form, or the reason why it is invalid.
pub type Ready<N> = Result<(Ray<N>, DirectionScale), Rejection>;

/// How far from where a ray comes to a scene's box it can meet what has a box, in units, and how near.
const REACH: [f64; 2] = [1.0 / (1_u64 << 32) as f64, (1_u64 << 17) as f64];

/// The largest error of a t that counts as exact, in units: at most 2^-12 of the lattice's step, to which the scene was
/// rounded.
pub const EXACT: f64 = 1.0 / (1_u64 << 20) as f64;

/// Makes a ray ready for the core, from however far away. Its t are numbers of double precision, or it is none.
#[inline(always)]
pub fn prepare<N: Number>(scene: &Scene<'_>, frame: &Frame, ray: &SceneRay) -> Ready<N> {
    let mut ready = frame.ray(scene, ray);
    complete(&mut ready, (scene, frame), || *ray);
    ready
}

/// Completes what the frame made of a ray, in place: hardly ever is there anything to do.
#[inline(always)]
fn complete<N: Number>(
    ready: &mut Ready<N>,
    (scene, frame): (&Scene<'_>, &Frame),
    ray: impl FnOnce() -> SceneRay,
) {
    match ready {
        Ok(found) => {
            if let Err(why) = check_multiples(found) {
                *ready = Err(why);
            }
        }
        Err(Rejection::Ray(RayError::Distance)) => {
            *ready = prepare_from_afar(scene, frame, ray());
        }
        Err(_) => (),
    }
}

/// Checks that the t of the scene are numbers of double precision, which they are unless the direction is of an extreme
/// length.
#[inline(always)]
fn check_multiples<N: Number>((ray, scale): &(Ray<N>, DirectionScale)) -> Result<(), Rejection> {
    let [least, most] = REACH;
    scale.multiple(N::far_to_f64(ray.start_t()) + most, || EXACT)?;
    scale.multiple(least, || EXACT)?;
    Ok(())
}

/// A ray from farther away than the core takes it.
#[cold]
#[inline(never)]
fn prepare_from_afar<N: Number>(scene: &Scene<'_>, frame: &Frame, ray: SceneRay) -> Ready<N> {
    let middle = Middle::of(scene);
    let (mut near, t) = middle.nearer(&ray);
    if !t.is_finite() {
        return Err(Rejection::TooShort);
    }
    // A ray that passes by so far away is brought nearer, where it misses all the same; planes it would not.
    if Kind::ALL
        .iter()
        .all(|&kind| kind.is_bounded() || scene.count(kind) == 0)
    {
        let aside = middle.far / 2.0;
        near.origin = near
            .origin
            .clamp(middle.place - aside, middle.place + aside);
    }
    let (ray, mut scale) = frame.ray(scene, &near)?;
    scale.count_from(t);
    let found = (ray, scale);
    check_multiples(&found)?;
    Ok(found)
}

/// The middle of a scene.
#[derive(Clone, Copy)]
pub struct Middle {
    place: DVec3,
    /// From here on the core does not take the origin of a ray.
    pub far: f64,
}

impl Middle {
    pub fn of(scene: &Scene<'_>) -> Self {
        let frame = Frame::of(scene);
        let sides = scene.bounds().0;
        Self {
            place: frame.place(sides.map(|[low, high]| f64::from(low).midpoint(high.into()))),
            far: frame.length((FARTHEST >> 13) as f64),
        }
    }

    /// Moves the origin of a ray close to the scene: along its largest component, it is a few times the scene's size
    /// before it. Returns also the t of this place on the given ray.
    pub fn nearer(&self, ray: &SceneRay) -> (SceneRay, f64) {
        let axis = ray.direction.abs().max_position();
        let before = (self.far / f64::from(1 << 20)).copysign(ray.direction[axis]);
        let t = (self.place[axis] - before - ray.origin[axis]) / ray.direction[axis];
        // Rounded once, it is a point of the ray, however large t is.
        let along = |axis: usize| ray.direction[axis].mul_add(t, ray.origin[axis]);
        let near = SceneRay {
            origin: DVec3::new(along(0), along(1), along(2)),
            direction: ray.direction,
            tmin: ray.tmin - t,
            tmax: ray.tmax - t,
        };
        (near, t)
    }
}

#[inline(never)]
fn fill<N: Number>(
    (scene, frame, numbers): (&Scene<'_>, &Frame, Range<usize>),
    ready: &mut Vec<Ready<N>>,
    ray: impl Fn(usize) -> SceneRay,
) {
    ready.extend(numbers.clone().map(
        #[inline(always)]
        |number| frame.ray(scene, &ray(number)),
    ));
    for (number, ready) in numbers.zip(ready) {
        complete(ready, (scene, frame), || ray(number));
    }
}

/// A ray from its origin on.
#[inline(always)]
fn endless(origin: DVec3, direction: DVec3) -> SceneRay {
    SceneRay {
        origin,
        direction,
        tmin: 0.0,
        tmax: f64::INFINITY,
    }
}

/// A ray of a row of six numbers.
#[inline(always)]
fn six<T: Copy + Into<f64>>(values: &[T], number: usize) -> SceneRay {
    endless(three(values, 6 * number), three(values, 6 * number + 3))
}

#[inline(always)]
fn three<T: Copy + Into<f64>>(values: &[T], at: usize) -> DVec3 {
    let values = &values[at..at + 3];
    DVec3::new(values[0].into(), values[1].into(), values[2].into())
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
