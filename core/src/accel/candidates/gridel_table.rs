//! The table of the cylinder cubes: a list for each pair of gridels, and the walk along a sorted list.

use crate::accel::candidates::gridels::{Levels, Passage};
use crate::accel::candidates::lists::{Candidates, ListSections};
use crate::accel::number::Number;
use crate::accel::scene_geometry::SceneGeometry;
use crate::format::record::Gridels;
use crate::format::{BlobError, Location, Reason, SectionKind, Sections};
use crate::ray::Ray;

/// The records of a cylinder cube: a partition, and a list for every pair of gridels.
#[derive(Clone, Copy, Debug)]
pub(in crate::accel) struct Table<'a> {
    pub(in crate::accel) gridels: Option<&'a Gridels>,
    pub(in crate::accel) lists: Candidates<'a>,
}

impl<'a> Table<'a> {
    pub(in crate::accel) fn read(
        sections: &Sections<'a>,
        gridels: SectionKind,
        kinds: &ListSections,
    ) -> Result<Self, BlobError> {
        let records: &[Gridels] = sections.records(gridels)?;
        if records.len() > 1 {
            return Err(BlobError::Count {
                section: gridels,
                found: records.len(),
                expected: 1,
            });
        }
        Ok(Self {
            gridels: records.first(),
            lists: Candidates::read(sections, kinds)?,
        })
    }

    /// Proves that the partition is that of the scene's box, and that the lists are valid. The builder is responsible
    /// for complete lists.
    pub(in crate::accel) fn check(
        &self,
        geometry: &SceneGeometry<'a>,
        section: SectionKind,
        kinds: &ListSections,
        end: usize,
    ) -> Result<(), BlobError> {
        let Some(gridels) = self.gridels else {
            return Err(BlobError::Count {
                section,
                found: 0,
                expected: 1,
            });
        };
        let is_scenes = *gridels == Gridels::new(geometry.bounds(), gridels.count);
        Location::Section(section).ensure(is_scenes, Reason::WrongPartition)?;
        let ascend = |before: u8, after: u8| before >> 4 <= after >> 4 && before & 15 <= after & 15;
        self.lists
            .check(kinds, Gridels::pairs(gridels.count), end, ascend)
    }
}

/// Visits the entries of a sorted list in the order of a ray. `visit` returns the t beyond which hits are ignored, or
/// `None` to end the walk.
#[inline(always)]
pub(in crate::accel) fn along<N: Number>(
    lists: &Candidates<'_>,
    passage: &Passage,
    ray: &Ray<N>,
    mut visit: impl FnMut(u32) -> Option<N>,
) {
    let range = lists.list(passage.cell);
    if range.is_empty() {
        return;
    }
    let levels = passage.levels();
    let start = levels.at_least(ray.tmin.to_cull());
    let mut tmax = ray.tmax;
    let mut end = levels.at_most(tmax.to_cull());
    for place in 0..range.len() {
        let index = if passage.backward {
            range.end - 1 - place
        } else {
            range.start + place
        };
        let key = u32::from(lists.key(index));
        let (near, far) = if passage.backward {
            (
                Levels::COUNT - 1 - (key & 15),
                Levels::COUNT - 1 - (key >> 4),
            )
        } else {
            (key >> 4, key & 15)
        };
        if near > end {
            return;
        }
        if far < start {
            continue;
        }
        let Some(limit) = lists.entry(index).and_then(&mut visit) else {
            return;
        };
        if limit < tmax {
            tmax = limit;
            end = levels.at_most(tmax.to_cull());
        }
    }
}
