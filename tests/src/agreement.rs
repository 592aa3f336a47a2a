//! Every structure gives the list's answer, and the flagged hierarchy does half of the work.

use crate::query::{HitBits, UnitRay, any, closest, depart, held, through};
use crate::random::Random;
use gridel_core::accel::{SceneGeometry, StructureViews, Traverse};
use gridel_core::format::Leaf;
use gridel_core::format::limits::FARTHEST;
use gridel_core::shared::Cull;
use gridel_core::shared::walk_bvh;
use gridel_core::{
    Accel, Bvh, Counters, Flagged, List, NoCount, Number, Observer, Ray, Scene, StackView,
    Structure,
};

/// The plain hierarchy, culled in integers as the flagged one is in every format. Floats in SIMD registers have other
/// margins, so planes could not be compared one by one.
enum Plain {}

impl Accel for Plain {
    fn views<'s, 'a>(views: &'s StructureViews<'a>) -> &'s Self::Views<'a> {
        Bvh::views(views)
    }
}

impl Traverse for Plain {
    const STRUCTURE: Structure = Structure::Bvh;
    type Views<'a> = <Bvh as Traverse>::Views<'a>;
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
        walk_bvh(geometry, views, ray, cull, stack, count, leaf);
    }
}

/// The compared rays.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    pub rays: u64,
    pub hits: u64,
    /// Rays that were compared with the list, too.
    pub listed: u64,
    /// Planes tested, without the root's.
    pub plain_planes: u64,
    pub flagged_planes: u64,
}

/// Compares all structures on rays, and on a ray from every tenth surface that they meet.
///
/// Brute force traces as many rays as fit `list_tests` tests of primitives.
pub fn compare<N: Number>(
    name: &str,
    scene: &Scene<'_>,
    rays: impl Iterator<Item = UnitRay>,
    list_tests: u64,
) -> Tally {
    let whole = std::iter::once(scene).chain(scene.parts());
    let counts = whole.flat_map(|it| gridel_core::Kind::ALL.map(|kind| it.count(kind)));
    let primitives: usize = counts.sum();
    let list_rays = list_tests / primitives.max(1) as u64;
    let mut tally = Tally::default();
    let mut random = Random(0xa9ee);
    for ray in rays {
        let Some(from) = compare_one::<N>(name, scene, &ray, list_rays, &mut tally) else {
            continue;
        };
        if random.one_in(10) {
            let direction = random.direction();
            let secondary = UnitRay::new(from, direction);
            // On a shape without bounds, farther away than rays may begin.
            if from.iter().any(|x| x.abs() > (FARTHEST >> 13) as f64) {
                continue;
            }
            compare_one::<N>(name, scene, &secondary, list_rays, &mut tally);
        }
    }
    tally
}

/// Compares on one ray; returns where a ray leaves the surface that was hit.
fn compare_one<N: Number>(
    name: &str,
    scene: &Scene<'_>,
    ray: &UnitRay,
    list_rays: u64,
    tally: &mut Tally,
) -> Option<[f64; 3]> {
    let Some(ready) = ray.ready::<N>(scene) else {
        panic!("{name}: {ray:?} is rejected");
    };
    tally.rays += 1;
    let (mut plain_work, mut flagged_work) = (Counters::default(), Counters::default());
    let plain = closest::<N, Plain>(scene, &ready, &mut plain_work);
    let flagged = closest::<N, Flagged>(scene, &ready, &mut flagged_work);
    let bits = plain.as_ref().map(HitBits::of);
    let about = || format!("{name}, {}: {ray:?}", N::FORMAT.name());
    assert_eq!(bits, flagged.as_ref().map(HitBits::of), "{}", about());
    for structure in held(scene) {
        let (hit, any) = through::<N>(structure, scene, &ready);
        let name = structure.name();
        assert_eq!(bits, hit.as_ref().map(HitBits::of), "{name}: {}", about());
        assert_eq!(bits.is_some(), any, "{name}: {}", about());
    }
    // With instances the scene's box is larger than that of its own objects, and so are boxes of flagged nodes that
    // share its sides.
    if scene.instances().is_empty() {
        let work = |counters: &Counters| (counters.boxes, counters.primitives);
        assert_eq!(work(&plain_work), work(&flagged_work), "{}", about());
        let planes = |counters: &Counters| counters.planes - 6;
        let (plain_planes, flagged_planes) = (planes(&plain_work), planes(&flagged_work));
        assert!(2 * flagged_planes <= plain_planes, "{}", about());
        tally.plain_planes += plain_planes;
        tally.flagged_planes += flagged_planes;
    }
    if tally.listed < list_rays {
        tally.listed += 1;
        let listed = closest::<N, List>(scene, &ready, &mut NoCount);
        assert_eq!(listed.as_ref().map(HitBits::of), bits, "{}", about());
        assert_eq!(any::<N, List>(scene, &ready), bits.is_some(), "{}", about());
    }
    let hit = plain?;
    tally.hits += 1;
    Some(depart(scene, &hit, hit.front))
}

impl Tally {
    /// Both together.
    pub fn plus(self, other: Self) -> Self {
        Self {
            rays: self.rays + other.rays,
            hits: self.hits + other.hits,
            listed: self.listed + other.listed,
            plain_planes: self.plain_planes + other.plain_planes,
            flagged_planes: self.flagged_planes + other.flagged_planes,
        }
    }

    /// Prints what was compared, and holds the flagged hierarchy to half of the planes.
    pub fn report<N: Number>(&self, name: &str) {
        assert!(2 * self.flagged_planes <= self.plain_planes, "{name}");
        let percent = 100.0 * self.flagged_planes as f64 / self.plain_planes.max(1) as f64;
        eprintln!(
            "{name:24} {:5}: {:8} rays, {:8} hits, {:8} against the list; flagged {percent:.2} % of \
             the planes",
            N::FORMAT.name(),
            self.rays,
            self.hits,
            self.listed
        );
    }
}
