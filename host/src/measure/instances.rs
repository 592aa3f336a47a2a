//! The treatment of a scene's instances, and the primitives that it has with and without them.

use crate::scene::Instances;
use crate::table::{counted, grouped};
use gridel_core::{Kind, Scene};
use serde::{Deserialize, Serialize};

/// The instances of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct InstanceCount {
    pub choice: Instances,
    pub instances: usize,
    /// Parts of the blob; `None` where instances were copied.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parts: Option<usize>,
    /// Primitives of the blob.
    pub stored_primitives: usize,
    /// Primitives of the scene, with those of a part once per instance.
    pub placed_primitives: usize,
}

/// The primitives of a scene, without those of its parts.
fn own(scene: &Scene<'_>) -> usize {
    Kind::ALL.iter().map(|&kind| scene.count(kind)).sum()
}

/// Primitives that a blob stores, and those that rays can meet, which are more where parts are placed several times.
///
/// Primitives that collapsed on the lattice do not count.
pub fn primitives(scene: &Scene<'_>) -> [usize; 2] {
    let parts: Vec<usize> = scene.parts().iter().map(|it| own(it)).collect();
    let places = scene.instances().iter();
    let placed = places.filter_map(|it| parts.get(usize::from(it.part)));
    let own = own(scene);
    [
        own + parts.iter().sum::<usize>(),
        own + placed.sum::<usize>(),
    ]
}

impl InstanceCount {
    /// Returns the instances of a scene, of which `copied` were copied; `None` where it has none.
    ///
    /// ```
    /// # use gridel_host::compile::{Options, compile};
    /// use gridel_host::measure::InstanceCount;
    /// use gridel_host::scene::Instances;
    ///
    /// let file = "[[part]]\nname = 'wheel'\n\
    ///     [[part.object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n\
    ///     [[instance]]\npart = 'wheel'\n\
    ///     [[instance]]\npart = 'wheel'\ntranslate = [4, 0, 0]\n";
    /// let imported = gridel_host::scene::read("cart.toml".as_ref(), file.into(), &Default::default())?;
    /// let blob = compile(&imported.scene, &Options::default())?.blob;
    /// let count = InstanceCount::of(&blob.scene()?, imported.copied).expect("two wheels");
    /// assert_eq!((count.choice, count.instances), (Instances::Keep, 2));
    /// assert_eq!((count.stored_primitives, count.placed_primitives), (1, 2));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of(scene: &Scene<'_>, copied: usize) -> Option<Self> {
        let [stored_primitives, placed_primitives] = primitives(scene);
        let (choice, instances, parts) = match (scene.instances().len(), copied) {
            (0, 0) => return None,
            (0, copied) => (Instances::Flatten, copied, None),
            (kept, _) => (Instances::Keep, kept, Some(scene.parts().len())),
        };
        Some(Self {
            choice,
            instances,
            parts,
            stored_primitives,
            placed_primitives,
        })
    }

    pub fn are_kept(&self) -> bool {
        self.choice == Instances::Keep
    }

    /// Returns a sentence about the treatment of instances.
    pub fn text(&self) -> String {
        let instances = counted(self.instances, "instance");
        let stored = counted(self.stored_primitives, "primitive");
        match self.parts {
            Some(parts) => format!(
                "{instances} of {} kept: {stored} stored, {} placed; `--instances flatten` copies them",
                counted(parts, "part"),
                grouped(self.placed_primitives),
            ),
            None => format!(
                "{instances} copied: {stored} stored; `--instances keep` stores each part once"
            ),
        }
    }
}
