//! The test whether an object contains a point.

use crate::accel::{Accel, Number, StackView};
use crate::number::is_finite;
use crate::observe::count::Observer;
use crate::query::all_hits::{COUNTED, HitList, all_hits};
use crate::query::hit::PrimitiveHit;
use crate::ray::{Ray, RayError};
use crate::scene::Scene;

/// An object that can contain points: one of the scene's own, or one of an instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Solid {
    /// The object, counted in scene-file order.
    pub object: u32,
    /// The place of its instance among the scene's [instances](Scene::instances); `None` for one of the scene's own.
    pub instance: Option<u32>,
}

impl Solid {
    /// One of the scene's own objects.
    pub const fn own(object: u32) -> Self {
        Self {
            object,
            instance: None,
        }
    }

    /// Returns the object that a hit belongs to.
    pub fn of_hit<N: Number>(scene: &Scene<'_>, hit: &PrimitiveHit<N>) -> Self {
        Self {
            object: scene.object(hit.primitive),
            instance: hit.instance(),
        }
    }
}

/// Returns the ray that decides what contains a point, in units: along an axis to the nearest side of the scene's box.
/// `None` for a point outside the box.
///
/// # Errors
/// If the point is not finite.
pub fn containment_ray<N: Number>(
    scene: &Scene<'_>,
    point: [N::Wide; 3],
) -> Result<Option<Ray<N>>, RayError> {
    if !point.into_iter().all(is_finite::<N>) {
        return Err(RayError::Origin);
    }
    let mut nearest: Option<(N::Wide, usize, i64)> = None;
    for (axis, (&x, &[first, last])) in point.iter().zip(&scene.bounds().0).enumerate() {
        let [first, last] = [first, last].map(|side| N::from_unit(side).widen());
        if x < first || x > last {
            return Ok(None);
        }
        for (way, sign) in [(N::difference(x, first), -1), (N::difference(last, x), 1)] {
            if nearest.is_none_or(|(least, ..)| way < least) {
                nearest = Some((way, axis, sign));
            }
        }
    }
    let (_, axis, sign) = nearest.ok_or(RayError::Origin)?;
    let component = |k: usize| N::far(if k == axis { sign } else { 0 });
    let direction = [component(0), component(1), component(2)];
    let [start, end] = [N::far(0), N::far(i64::MAX)];
    Ray::new(scene.bounds(), point, direction, start, end).map(Some)
}

/// Returns true if an object contains a point, given in units. The test counts how often a ray from the point crosses
/// the object's surface, by the half-open rule of [`all_hits`]: inside, the count is odd. That is right for every
/// closed mesh and every solid, and for a closed mesh whose surface is inside out as well. Where closed shells of one
/// mesh overlap, an even number of them counts as outside, as a cavity does.
///
/// A point very near the surface can be on either side; the answer is the same each time, in every structure. Very near
/// means below the rounding of the format: 2^-13 unit in `fixed`, and the [error bound](crate::Hit::error) of a hit
/// there in all formats. For an open mesh the answer only says how often one ray crosses it. Discs and planes contain
/// nothing.
///
/// `stack` needs [`stack_depth`](Scene::stack_depth) entries. The cost is that of a ray without end to the nearest side
/// of the scene's box, for every 16 hits. A list of as many lies on the call stack, which takes up to 1.8 KiB more in
/// `fixed` and `f32` than for a closest hit, and 2.3 KiB in a build with all features.
///
/// ```
/// # static BLOB: &[u8] =
/// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
/// use gridel_core::{DualSplit, NoCount, Ray, Scene, Solid, Stack, closest_hit, contains};
///
/// let scene = Scene::from_bytes(BLOB)?;
/// let mut stack = Stack::<32>::new();
/// let down = Ray::<f64>::from_f64(scene.bounds(), [0.0, 1e6, 0.0], [0.0, -1.0, 0.0], 0.0, 1e9)?;
/// let hit = closest_hit::<f64, DualSplit, _>(&scene, &down, stack.as_view(), &mut NoCount).expect("a ball");
/// let ball = Solid::own(hit.object);
/// let [above, below] = [1.0, -1.0].map(|step| [hit.point[0], hit.point[1] + step, hit.point[2]]);
/// let stack = stack.as_view();
/// assert!(contains::<f64, DualSplit, _>(&scene, ball, below, stack, &mut NoCount)?);
/// assert!(!contains::<f64, DualSplit, _>(&scene, ball, above, stack, &mut NoCount)?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If the point is not finite.
pub fn contains<N: Number, A: Accel, C: Observer>(
    scene: &Scene<'_>,
    solid: Solid,
    point: [N::Wide; 3],
    stack: &mut StackView,
    count: &mut C,
) -> Result<bool, RayError> {
    let Some(ray) = containment_ray::<N>(scene, point)? else {
        return Ok(false);
    };
    let mut list = HitList::<N, COUNTED>::new();
    let mut inside = false;
    loop {
        let more = all_hits::<N, A, C, COUNTED>(scene, &ray, stack, &mut list, count);
        let own = list.iter().filter(|hit| hit.is_of_closed(scene, solid));
        inside ^= own.count() % 2 == 1;
        if !more {
            return Ok(inside);
        }
    }
}

impl<N: Number> PrimitiveHit<N> {
    /// Returns true if it is a hit of an object, and not of a disc or a plane, which enclose nothing.
    fn is_of_closed(&self, scene: &Scene<'_>, solid: Solid) -> bool {
        self.encloses() && Solid::of_hit(scene, self) == solid
    }
}
