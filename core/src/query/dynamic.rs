//! Queries through the structure that is chosen at run time.

use crate::accel::{DynAccel, Number, StackView};
use crate::format::Structure;
use crate::observe::count::NoCount;
use crate::query::{self, Hit, HitList, Solid};
use crate::ray::{Ray, RayError};
use crate::scene::Scene;
use crate::target::AllStructuresOnly;

/// Queries through the [best](Structure::BEST_FIRST) structure of the blob, or the one that was [chosen](Scene::choose).
impl Scene<'_> {
    /// Returns the first hit of a ray in its interval, or `None`. `stack` needs
    /// [`stack_depth`](Scene::stack_depth) entries. [`closest_hit`](crate::closest_hit) is the form for one structure,
    /// and for counting.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{Ray, Scene, Stack};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let mut stack = Stack::<32>::new();
    /// let down = Ray::<f32>::from_f64(scene.bounds(), [0.0, 1e6, 0.0], [0.0, -1.0, 0.0], 0.0, 1e9)?;
    /// let hit = scene.closest_hit(&down, stack.as_view()).expect("a sphere");
    /// assert!(hit.front && hit.normal[1] > 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn closest_hit<N: Number>(&self, ray: &Ray<N>, stack: &mut StackView) -> Option<Hit<N>> {
        query::closest_hit::<N, DynAccel, _>(self, ray, stack, &mut NoCount)
    }

    /// Returns true if a ray hits anything in its interval. `stack` needs [`stack_depth`](Scene::stack_depth) entries.
    /// [`any_hit`](crate::any_hit) is the form for one structure, and for counting.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{Ray, Scene, Stack};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let mut stack = Stack::<32>::new();
    /// let up = Ray::<f32>::from_f64(scene.bounds(), [0.0, 1e6, 0.0], [0.0, 1.0, 0.0], 0.0, 1e9)?;
    /// assert!(!scene.any_hit(&up, stack.as_view()));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn any_hit<N: Number>(&self, ray: &Ray<N>, stack: &mut StackView) -> bool {
        query::any_hit::<N, DynAccel, _>(self, ray, stack, &mut NoCount)
    }

    /// Lists the next hits of a ray in its interval. Returns true if more hits are possible: see
    /// [`all_hits`](crate::all_hits). `stack` needs [`stack_depth`](Scene::stack_depth) entries.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::{HitList, Ray, Scene, Stack};
    ///
    /// let scene = Scene::from_bytes(BLOB)?;
    /// let mut stack = Stack::<32>::new();
    /// let down = Ray::<f32>::from_f64(scene.bounds(), [0.0, 1e6, 0.0], [0.0, -1.0, 0.0], 0.0, 1e9)?;
    /// // The nearest two hits: into a ball, and out of it.
    /// let mut nearest = HitList::<f32, 2>::new();
    /// scene.all_hits(&down, stack.as_view(), &mut nearest);
    /// let leaves: Vec<bool> = nearest.iter().map(|hit| hit.leaves()).collect();
    /// assert_eq!(leaves, [false, true]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn all_hits<N: Number, const SIZE: usize>(
        &self,
        ray: &Ray<N>,
        stack: &mut StackView,
        list: &mut HitList<N, SIZE>,
    ) -> bool {
        query::all_hits::<N, DynAccel, _, SIZE>(self, ray, stack, list, &mut NoCount)
    }

    /// Returns the number of hits of a ray in its interval: see [`count_hits`](crate::count_hits). `stack` needs
    /// [`stack_depth`](Scene::stack_depth) entries.
    pub fn count_hits<N: Number>(&self, ray: &Ray<N>, stack: &mut StackView) -> u32 {
        query::count_hits::<N, DynAccel, _>(self, ray, stack, &mut NoCount)
    }

    /// Returns true if an object contains a point, given in units: see [`contains`](crate::contains). `stack` needs
    /// [`stack_depth`](Scene::stack_depth) entries.
    ///
    /// # Errors
    /// If the point is not finite.
    pub fn contains<N: Number>(
        &self,
        solid: Solid,
        point: [N::Wide; 3],
        stack: &mut StackView,
    ) -> Result<bool, RayError> {
        query::contains::<N, DynAccel, _>(self, solid, point, stack, &mut NoCount)
    }

    /// Returns the scene with a structure chosen in place of the best one, for the queries here and for
    /// [`DynAccel`]. Returns `None` if the blob does not hold it.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// use gridel_core::Structure;
    ///
    /// let scene = gridel_core::Scene::from_bytes(BLOB)?;
    /// assert!(scene.choose(Structure::List).is_some());
    /// assert!(scene.choose(Structure::Grid).is_none());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn choose(&self, structure: Structure) -> Option<Self> {
        self.holds(structure).then(|| {
            let mut scene = *self;
            scene.geometry.chosen = AllStructuresOnly::new(|| structure);
            scene
        })
    }
}
