//! The Cargo features of this crate that a scene requires.

use crate::format::record::View;
use crate::format::{Effects, Kind};
use crate::geometry::triangle::Triangles;
use crate::scene::Scene;

impl Scene<'_> {
    /// Returns the Cargo features of this crate that the scene and its parts require, without that of its structure.
    /// They are the kinds of its primitives, their stored forms, display values as colors, and its effects.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// let scene = gridel_core::Scene::from_bytes(BLOB)?;
    /// let features: Vec<&str> = scene.features().collect();
    /// assert!(features.contains(&"sphere") && features.contains(&"shadow"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn features(&self) -> impl Iterator<Item = &'static str> {
        let any = |has: fn(&Self, Kind) -> bool, kind| {
            has(self, kind) || self.parts().iter().any(|part| has(part, kind))
        };
        let kinds = Kind::ALL.map(|kind| (any(|it, kind| it.count(kind) > 0, kind), kind.name()));
        let wide_lattice = |it: &Self, _| it.geometry.header.storage_bits > 16;
        let wide_indices = |it: &Self, _| matches!(it.geometry.shapes.triangles, Triangles::U32(_));
        let others = [
            (any(wide_lattice, Kind::Triangle), "wide-lattice"),
            (any(wide_indices, Kind::Triangle), "wide-indices"),
            (!self.parts().is_empty(), "instances"),
            (
                any(
                    |it, _| it.view.encoding == View::DISPLAY_VALUES,
                    Kind::Triangle,
                ),
                "display-values",
            ),
        ];
        let required = kinds.into_iter().chain(others);
        let names = required.filter_map(|(required, name)| required.then_some(name));
        names.chain(self.effects_with_parts().names())
    }

    /// Returns the effects that the scene requires, and those that its parts require at loading.
    pub fn effects_with_parts(&self) -> Effects {
        let parts = self.parts().iter();
        parts.fold(self.effects(), |all, part| all.with(part.effects()))
    }
}
