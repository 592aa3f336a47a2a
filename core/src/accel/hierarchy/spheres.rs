//! Bounding spheres.
//!
//! The interval of a bounding sphere begins and ends a radius from the point of the ray that is nearest to its center.
//! That is a little longer than the chord, and needs no square root. It is empty where the ray passes the center
//! farther away than the radius.
//!
//! A child's sphere need not lie in its parent's, because a tight sphere around primitives does not contain the tight
//! spheres around parts of them. So loading proves that the sphere of each node holds every primitive below it, with a
//! margin (see [`Reach`]). Then a hit's point lies in all of these spheres, at most a radius from the ray's nearest
//! point. So no node above it is skipped.

use crate::accel::cull::{Cull, PairCulling};
use crate::accel::cull_axis::Interval;
use crate::accel::hierarchy::check::{Path, check_tree};
use crate::accel::hierarchy::pairs::{PairArray, PairRecord, Walk};
use crate::accel::hierarchy::reach::Reach;
use crate::accel::number::Number;
use crate::accel::records::Records;
use crate::accel::scene_geometry::SceneGeometry;
use crate::accel::stack::StackView;
use crate::accel::traverse::Traverse;
use crate::format::link::Node;
use crate::format::record::{BoundingSphere, SpherePair};
use crate::format::{BlobError, Leaf, SectionKind, Sections, Structure};
use crate::observe::count::Observer;
use crate::ray::Ray;

/// The hierarchy of bounding spheres. Below the root no plane is tested, but two spheres per pair.
#[derive(Clone, Copy, Debug)]
pub enum Spheres {}

impl Traverse for Spheres {
    const STRUCTURE: Structure = Structure::Spheres;
    type Views<'a> = Views<'a>;
    type Cull<N: Number> = Cull;

    fn walk<N: Number, C: Observer>(
        geometry: &SceneGeometry<'_>,
        views: &Self::Views<'_>,
        ray: &Ray<N>,
        cull: &Cull,
        stack: &mut StackView,
        count: &mut C,
        leaf: impl FnMut(Leaf, &mut C) -> Option<N>,
    ) {
        let recip_norm2 = N::recip_norm2(ray.slope);
        let start = cull.start();
        let meet = |sphere: BoundingSphere, limit: i32| {
            let whole = interval(ray, recip_norm2, sphere);
            Interval {
                near: whole.near.max(start),
                far: whole.far.min(limit),
            }
        };
        let walk = Walk {
            geometry,
            pairs: views.0,
            root: |limit| PairCulling::<N>::root(cull, geometry.bounds(), limit),
            root_planes: 6,
            narrow: |pair: &SpherePair, _, limit| pair.spheres.map(|sphere| meet(sphere, limit)),
        };
        walk.run::<N, Cull, C>(ray.tmax, stack, count, leaf);
    }
}

/// The interval of a bounding sphere; empty where the ray misses it.
#[inline(always)]
fn interval<N: Number>(ray: &Ray<N>, recip_norm2: N, sphere: BoundingSphere) -> Interval {
    const NOWHERE: Interval = Interval { near: 1, far: 0 };
    let axis = |k: usize| N::from_unit(sphere.center[k]) - ray.origin[k];
    let relative = [axis(0), axis(1), axis(2)];
    let closest = N::from_wide(N::wide_scale(N::dot(relative, ray.slope), recip_norm2));
    let axis = |k: usize| relative[k] - closest * ray.slope[k];
    let apart = [axis(0), axis(1), axis(2)];
    let radius = N::from_lattice(i32::from(sphere.radius) << 8);
    // The box is tested first, so that squares stay in range.
    if !(apart[0].abs() <= radius && apart[1].abs() <= radius && apart[2].abs() <= radius) {
        return NOWHERE;
    }
    if radius.wide(radius) < N::dot(apart, apart) {
        return NOWHERE;
    }
    // Steps are half units; one covers the rounding of each conversion.
    let (middle, reach) = (closest.to_cull(), 2 * i32::from(sphere.radius) + 1);
    Interval {
        near: middle - reach,
        far: middle + reach + 1,
    }
}

/// The hierarchy of a scene.
#[derive(Clone, Copy, Debug)]
pub struct Views<'a>(pub(in crate::accel) &'a [SpherePair]);

impl PairRecord for &SpherePair {
    const SECTION: SectionKind = SectionKind::SpherePairs;

    #[inline(always)]
    fn planes(&self) -> u32 {
        0
    }

    #[inline(always)]
    fn child(&self, _: u32, side: u32) -> Node {
        Node(self.children[(side & 1) as usize])
    }
}

impl<'a> Records<'a> for Views<'a> {
    const SECTIONS: &'static [SectionKind] = &[SectionKind::SpherePairs];
    const USES_LEAVES: bool = true;

    fn read(sections: &Sections<'a>) -> Result<Self, BlobError> {
        Ok(Self(sections.records(SectionKind::SpherePairs)?))
    }

    fn check(&self, geometry: &SceneGeometry<'a>) -> Result<usize, BlobError> {
        check_tree(self.0, geometry, &())
    }
}

impl<'a> PairArray for &'a [SpherePair] {
    type Pair = &'a SpherePair;
    /// Spheres do not lie in each other.
    type Volume = ();

    fn len(self) -> usize {
        <[SpherePair]>::len(self)
    }

    #[inline(always)]
    fn pair(self, number: usize) -> Option<Self::Pair> {
        self.get(number)
    }

    fn volumes(self, _: &SpherePair, (): &()) -> [(); 2] {
        [(); 2]
    }

    /// At most [`MAX_LEVELS`](crate::format::limits::MAX_LEVELS) spheres are tested per primitive; for the root the
    /// scene's box is tested.
    fn contains_leaf(self, geometry: &SceneGeometry<'_>, leaf: Leaf, (): &(), path: &Path) -> bool {
        leaf.slots().into_iter().all(|index| {
            Reach::of(&geometry.shapes, leaf.kind, index).is_some_and(|reach| {
                path.iter().all(|&step| {
                    let pair = self.get((step >> 1) as usize);
                    pair.is_some_and(|pair| {
                        let sphere = pair.spheres[(step & 1) as usize];
                        reach.in_sphere(sphere.center, sphere.radius)
                    })
                })
            })
        })
    }
}
