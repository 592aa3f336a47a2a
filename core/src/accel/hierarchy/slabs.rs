//! Slabs: bounding volumes between parallel planes of fixed directions (Kay and Kajiya, "Ray Tracing
//! Complex Scenes", 1986), plain and flagged.
//!
//! A volume has two planes for each of 3, 7 or 13 directions: the axes, the diagonals of the cube, the diagonals of its
//! faces. Along a direction `n` a ray's coordinate is `y = n . x / 2^h`, where h keeps planes in 16 bits. It is a line
//! like that of an axis, with a slope and an origin of its own. So slabs are culled by the rule of boxes (see
//! `accel::cull`). The proof of that rule holds here, because the error of `y` is no larger than that of the
//! coordinates. Volumes must hold more than the primitives: see [`Reach`].
//!
//! Without flags, all planes of both children are tested, four per direction. With flags, planes that coincide with the
//! parent's are neither stored nor tested, exactly as with boxes: two per direction. See `flagged_slabs.rs`.

use crate::accel::cull::Cull;
use crate::accel::cull_axis::{CullAxis, Interval};
use crate::accel::hierarchy::check::{Path, check_tree};
use crate::accel::hierarchy::direction::{DIRECTION_COUNTS, DIRECTIONS, Direction};
use crate::accel::hierarchy::pairs::{PairArray, PairRecord, Walk};
use crate::accel::hierarchy::reach::Reach;
use crate::accel::number::Number;
use crate::accel::records::Records;
use crate::accel::scene_geometry::SceneGeometry;
use crate::accel::stack::StackView;
use crate::accel::traverse::Traverse;
use crate::format::link::{Link, Node};
use crate::format::{BlobError, Leaf, Location, Reason, SectionKind, Sections, Structure};
use crate::observe::count::Observer;
use crate::ray::Ray;
use heapless::Vec;

/// A volume: the lower and the upper plane of each of its directions.
pub type Volume = [[i16; 2]; DIRECTIONS.len()];

/// The hierarchy of slabs with all planes.
#[derive(Clone, Copy, Debug)]
pub enum Slabs {}

/// A ray's form along each direction.
pub(in crate::accel) type Forms = Vec<CullAxis, { DIRECTIONS.len() }>;

pub(in crate::accel) fn forms<N: Number>(ray: &Ray<N>, count: usize) -> Forms {
    let form = |direction: &Direction| {
        let (slope, origin) = (direction.along(ray.slope), direction.along(ray.origin));
        N::cull_axis(slope, origin)
    };
    DIRECTIONS.iter().take(count).map(form).collect()
}

/// Two planes of a direction, in one word.
#[inline(always)]
pub(in crate::accel) fn planes(word: u32) -> [i16; 2] {
    [word as i16, (word >> 16) as i16]
}

/// Returns the planes that a ray reaches first, and those that it reaches last.
#[inline(always)]
pub(in crate::accel) fn in_order<T>(form: &CullAxis, lower: T, upper: T) -> (T, T) {
    if form.descends() {
        (upper, lower)
    } else {
        (lower, upper)
    }
}

/// The root's interval, from the ray's start up to a limit.
pub(in crate::accel) fn root_interval(
    forms: &Forms,
    root: &[u32],
    start: i32,
    limit: i32,
) -> Interval {
    let mut interval = Interval {
        near: start,
        far: limit,
    };
    for (form, &word) in forms.iter().zip(root) {
        let [lower, upper] = planes(word);
        let (near, far) = in_order(form, lower, upper);
        interval.near = interval.near.max(form.entry(near));
        interval.far = interval.far.min(form.exit(far));
    }
    interval
}

/// The records of one hierarchy, each with this many words.
#[derive(Clone, Copy, Debug)]
pub struct SlabPairs<'a, const FLAGGED: bool> {
    /// The root's volume, a word per direction.
    pub(in crate::accel) root: &'a [u32],
    words: &'a [u32],
}

/// A record of a pair.
#[derive(Clone, Copy, Debug)]
pub(in crate::accel) struct SlabPair<'a, const FLAGGED: bool>(&'a [u32]);

impl<'a, const FLAGGED: bool> SlabPairs<'a, FLAGGED> {
    /// Words of a record. Each direction has a word of lower planes and a word of upper planes. In flagged pairs it has
    /// one word, of the inner lower and the inner upper plane. Two words follow.
    fn width(&self) -> usize {
        let directions = self.root.len();
        2 + if FLAGGED { directions } else { 2 * directions }
    }
}

impl<'a, const FLAGGED: bool> PairArray for SlabPairs<'a, FLAGGED> {
    type Pair = SlabPair<'a, FLAGGED>;
    type Volume = Volume;

    fn len(self) -> usize {
        self.words.len() / self.width()
    }

    #[inline(always)]
    fn pair(self, number: usize) -> Option<Self::Pair> {
        let width = self.width();
        let first = number.checked_mul(width)?;
        let words = self.words.get(first..)?.get(..width)?;
        Some(SlabPair(words))
    }

    fn volumes(self, pair: Self::Pair, parent: &Volume) -> [Volume; 2] {
        pair.volumes(parent)
    }

    fn child_inside(self, child: &Volume, parent: &Volume) -> bool {
        let mut slabs = parent.iter().zip(child).take(self.root.len());
        slabs.all(|(outer, inner)| {
            outer[0] <= inner[0] && inner[0] <= inner[1] && inner[1] <= outer[1]
        })
    }

    fn contains_leaf(
        self,
        geometry: &SceneGeometry<'_>,
        leaf: Leaf,
        volume: &Volume,
        _: &Path,
    ) -> bool {
        leaf.slots().into_iter().all(|index| {
            Reach::of(&geometry.shapes, leaf.kind, index).is_some_and(|reach| {
                let mut slabs = DIRECTIONS.iter().zip(volume).take(self.root.len());
                slabs.all(|(&direction, &[low, high])| {
                    let [lowest, highest] = reach.slab(direction);
                    low <= lowest && highest <= high
                })
            })
        })
    }
}

impl<'a, const FLAGGED: bool> SlabPair<'a, FLAGGED> {
    /// The planes, and the two words behind them.
    #[inline(always)]
    pub(in crate::accel) fn parts(&self) -> (&'a [u32], [u32; 2]) {
        match self.0 {
            [planes @ .., a, b] => (planes, [*a, *b]),
            _ => (&[], [0; 2]),
        }
    }

    /// The children's volumes, given their parent's.
    fn volumes(&self, parent: &Volume) -> [Volume; 2] {
        let (words, [owners, _]) = self.parts();
        let mut children = [*parent; 2];
        if FLAGGED {
            for (number, &word) in words.iter().enumerate().take(DIRECTIONS.len()) {
                let [lower, upper] = planes(word);
                children[(owners >> (2 * number) & 1) as usize][number][0] = lower;
                children[(owners >> (2 * number + 1) & 1) as usize][number][1] = upper;
            }
        } else {
            for (number, both) in words.chunks_exact(2).enumerate().take(DIRECTIONS.len()) {
                let (lower, upper) = (planes(both[0]), planes(both[1]));
                for (child, volume) in children.iter_mut().enumerate() {
                    volume[number] = [lower[child], upper[child]];
                }
            }
        }
        children
    }
}

impl<const FLAGGED: bool> PairRecord for SlabPair<'_, FLAGGED> {
    const SECTION: SectionKind = if FLAGGED {
        SectionKind::FlaggedSlabPairs
    } else {
        SectionKind::SlabPairs
    };

    #[inline(always)]
    fn planes(&self) -> u32 {
        2 * (self.0.len() as u32).saturating_sub(2)
    }

    #[inline(always)]
    fn child(&self, number: u32, side: u32) -> Node {
        let (_, [first, second]) = self.parts();
        if FLAGGED {
            Link(second).child(number, side)
        } else {
            Node(if side == 0 { first } else { second })
        }
    }
}

/// The intervals of children that have all planes, from the ray's start up to a limit.
#[inline(always)]
fn plain(pair: SlabPair<'_, false>, forms: &Forms, start: i32, limit: i32) -> [Interval; 2] {
    let mut children = [Interval {
        near: start,
        far: limit,
    }; 2];
    for (form, both) in forms.iter().zip(pair.parts().0.chunks_exact(2)) {
        let (near, far) = in_order(form, planes(both[0]), planes(both[1]));
        for (child, interval) in children.iter_mut().enumerate() {
            interval.near = interval.near.max(form.entry(near[child]));
            interval.far = interval.far.min(form.exit(far[child]));
        }
    }
    children
}

/// The records of a scene.
pub type Views<'a> = SlabPairs<'a, false>;

impl Traverse for Slabs {
    const STRUCTURE: Structure = Structure::Slabs;
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
        let pairs = *views;
        let (forms, start) = (forms(ray, pairs.root.len()), cull.start());
        let walk = Walk {
            geometry,
            pairs,
            root: |limit| root_interval(&forms, pairs.root, start, limit),
            root_planes: 2 * pairs.root.len() as u32,
            narrow: |pair, _, limit| plain(pair, &forms, start, limit),
        };
        walk.run::<N, Cull, C>(ray.tmax, stack, count, leaf);
    }
}

impl<'a, const FLAGGED: bool> Records<'a> for SlabPairs<'a, FLAGGED> {
    const SECTIONS: &'static [SectionKind] = if FLAGGED {
        &[SectionKind::FlaggedSlabRoot, SectionKind::FlaggedSlabPairs]
    } else {
        &[SectionKind::SlabRoot, SectionKind::SlabPairs]
    };
    const USES_LEAVES: bool = true;

    fn read(sections: &Sections<'a>) -> Result<Self, BlobError> {
        let section = Self::SECTIONS[1];
        let mut pairs = Self {
            root: sections.records(Self::SECTIONS[0])?,
            words: &[],
        };
        pairs.words = sections.words(section, pairs.width())?;
        Ok(pairs)
    }

    fn check(&self, geometry: &SceneGeometry<'a>) -> Result<usize, BlobError> {
        let pairs = *self;
        let directions = pairs.root.len();
        let section = Self::SECTIONS[0];
        if !DIRECTION_COUNTS.contains(&directions) && !geometry.leaves.is_empty() {
            return Err(Location::Section(section).invalid(Reason::DirectionCount));
        }
        let mut root: Volume = [[0; 2]; DIRECTIONS.len()];
        for (volume, &word) in root.iter_mut().zip(pairs.root) {
            *volume = planes(word);
        }
        check_tree(pairs, geometry, &root)
    }
}
