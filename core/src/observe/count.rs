//! Counters of work and events of rays. They cost nothing in programs that do not use them.

use crate::observe::event::{Event, RayKind};
use core::any::Any;

/// Receives counts and events; every method does nothing unless it is overridden.
///
/// ```
/// # static BLOB: &[u8] =
/// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
/// use gridel_core::{DualSplit, Event, Observer, Ray, Scene, Stack, any_hit};
///
/// #[derive(Default)]
/// struct Tested(Vec<u32>);
///
/// impl Observer for Tested {
///     const ENABLED: bool = true;
///
///     fn event(&mut self, event: Event) {
///         if let Event::Candidate { primitive, .. } = event {
///             self.0.push(primitive);
///         }
///     }
/// }
///
/// let scene = Scene::from_bytes(BLOB)?;
/// let (mut stack, mut tested) = (Stack::<32>::new(), Tested::default());
/// let down = Ray::<f32>::from_f64(scene.bounds(), [0.0, 1e6, 0.0], [0.0, -1.0, 0.0], 0.0, 1e9)?;
/// any_hit::<f32, DualSplit, _>(&scene, &down, stack.as_view(), &mut tested);
/// assert!(tested.0.contains(&9));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Observer {
    /// True if [`event`](Self::event) is called.
    const ENABLED: bool = false;
    /// False if no count is used. Queries then take the fastest steps of the processor. Their answers do not depend on
    /// that, but the numbers of steps do.
    const COUNTS: bool = true;

    /// Planes of boxes were tested.
    #[inline(always)]
    fn planes(&mut self, _: u32) {}
    /// Boxes were tested.
    #[inline(always)]
    fn boxes(&mut self, _: u32) {}
    /// Primitives were tested.
    #[inline(always)]
    fn primitives(&mut self, _: u32) {}
    /// Cells of a subdivision of space were entered.
    #[inline(always)]
    fn cells(&mut self, _: u32) {}
    /// Instances were entered.
    #[inline(always)]
    fn instances(&mut self, _: u32) {}
    /// A ray added radiance to its sample: red, green and blue, where 1 is display white. No conversion takes place if
    /// the observer does not override this method.
    #[inline(always)]
    fn radiance(&mut self, _: impl FnOnce() -> [f64; 3]) {}
    /// A ray was cast: a [`Ray`](crate::Ray) of some number format.
    #[inline(always)]
    fn ray<R: Any>(&mut self, _: RayKind, _: &R) {}
    /// Receives an event. Called only if [`ENABLED`](Self::ENABLED) is true; else the code of the call is not
    /// compiled.
    fn event(&mut self, _: Event) {}
}

/// Counts nothing, at no cost.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoCount;

impl Observer for NoCount {
    const COUNTS: bool = false;
}

/// Counts everything. Numbers beyond 64 bits wrap.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Counters {
    /// Planes of boxes that were tested.
    pub planes: u64,
    /// Boxes that were tested.
    pub boxes: u64,
    /// Primitives that were tested.
    pub primitives: u64,
    /// Cells of a subdivision of space that were entered.
    pub cells: u64,
    /// Instances that were entered.
    pub instances: u64,
    /// Rays from the camera.
    pub primary: u64,
    /// Rays towards lights.
    pub shadow: u64,
    /// Mirrored rays.
    pub reflected: u64,
    /// Refracted rays.
    pub refracted: u64,
    /// Diffuse rays, of indirect light.
    pub diffuse: u64,
}

impl Counters {
    /// Returns all rays.
    ///
    /// ```
    /// use gridel_core::Counters;
    ///
    /// let counters = Counters { primary: 2, shadow: 3, ..Counters::default() };
    /// assert_eq!([counters.rays(), counters.secondary()], [5, 3]);
    /// ```
    pub fn rays(&self) -> u64 {
        self.primary.wrapping_add(self.secondary())
    }

    /// Returns all rays but those from the camera.
    pub fn secondary(&self) -> u64 {
        let leaving = [self.shadow, self.reflected, self.refracted, self.diffuse];
        leaving.into_iter().fold(0, u64::wrapping_add)
    }

    /// Returns all tests of boxes, bounding spheres and primitives, and all cells that were entered.
    ///
    /// ```
    /// use gridel_core::Counters;
    ///
    /// let counters = Counters { planes: 9, boxes: 3, primitives: 2, cells: 1, ..Counters::default() };
    /// assert_eq!(counters.tests(), 6);
    /// ```
    pub fn tests(&self) -> u64 {
        self.boxes
            .wrapping_add(self.cells)
            .wrapping_add(self.primitives)
    }

    /// Returns the counts of two parts of the work.
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            planes: self.planes.wrapping_add(other.planes),
            boxes: self.boxes.wrapping_add(other.boxes),
            primitives: self.primitives.wrapping_add(other.primitives),
            cells: self.cells.wrapping_add(other.cells),
            instances: self.instances.wrapping_add(other.instances),
            primary: self.primary.wrapping_add(other.primary),
            shadow: self.shadow.wrapping_add(other.shadow),
            reflected: self.reflected.wrapping_add(other.reflected),
            refracted: self.refracted.wrapping_add(other.refracted),
            diffuse: self.diffuse.wrapping_add(other.diffuse),
        }
    }
}

impl Observer for Counters {
    fn planes(&mut self, number: u32) {
        self.planes = self.planes.wrapping_add(number.into());
    }

    fn boxes(&mut self, number: u32) {
        self.boxes = self.boxes.wrapping_add(number.into());
    }

    fn primitives(&mut self, number: u32) {
        self.primitives = self.primitives.wrapping_add(number.into());
    }

    fn cells(&mut self, number: u32) {
        self.cells = self.cells.wrapping_add(number.into());
    }

    fn instances(&mut self, number: u32) {
        self.instances = self.instances.wrapping_add(number.into());
    }

    fn ray<R: Any>(&mut self, kind: RayKind, _: &R) {
        let counter = match kind {
            RayKind::Primary => &mut self.primary,
            RayKind::Shadow => &mut self.shadow,
            RayKind::Reflected | RayKind::Glossy | RayKind::Polished => &mut self.reflected,
            RayKind::Refracted => &mut self.refracted,
            RayKind::Diffuse => &mut self.diffuse,
        };
        *counter = counter.wrapping_add(1);
    }
}
