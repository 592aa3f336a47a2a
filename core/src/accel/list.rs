//! The plain list: every primitive is tested. All structures are measured against it.

use crate::accel::cull::Cull;
use crate::accel::number::Number;
use crate::accel::records::Records;
use crate::accel::scene_geometry::SceneGeometry;
use crate::accel::stack::StackView;
use crate::accel::traverse::Traverse;
use crate::format::{BlobError, Kind, Leaf, SectionKind, Sections, Structure};
use crate::observe::count::Observer;
use crate::ray::Ray;
use crate::target::WIDE;

/// Tests every primitive; needs no stack.
#[derive(Clone, Copy, Debug)]
pub enum List {}

impl Traverse for List {
    const STRUCTURE: Structure = Structure::List;
    type Views<'a> = Views<'a>;
    const HAS_CLUSTERS: bool = WIDE;
    type Cull<N: Number> = Cull;

    fn walk<N: Number, C: Observer>(
        geometry: &SceneGeometry<'_>,
        _: &Self::Views<'_>,
        _: &Ray<N>,
        _: &Cull,
        _: &mut StackView,
        count: &mut C,
        mut leaf: impl FnMut(Leaf, &mut C) -> Option<N>,
    ) {
        for kind in Kind::ALL.into_iter().filter(|kind| kind.is_bounded()) {
            let mut first = 0;
            let end = geometry.shapes.records(kind) as u32;
            while first < end {
                let size = (end - first).min(Leaf::MAX_COUNT);
                let range = Leaf {
                    kind,
                    first,
                    count: size,
                };
                if leaf(range, count).is_none() {
                    return;
                }
                first += size;
            }
            for cluster in 0..geometry.shapes.sole_clusters(kind) as u32 {
                let cluster = Leaf {
                    kind,
                    first: cluster,
                    count: 0,
                };
                if leaf(cluster, count).is_none() {
                    return;
                }
            }
        }
    }
}

/// A list stores only the primitives.
#[derive(Clone, Copy, Debug)]
pub struct Views<'a>(core::marker::PhantomData<&'a ()>);

impl<'a> Records<'a> for Views<'a> {
    const SECTIONS: &'static [SectionKind] = &[];
    const USES_LEAVES: bool = false;

    fn read(_: &Sections<'a>) -> Result<Self, BlobError> {
        Ok(Self(core::marker::PhantomData))
    }

    fn check(&self, _: &SceneGeometry<'a>) -> Result<usize, BlobError> {
        Ok(0)
    }
}
