//! The animation that is read, and what of it is not shown.

use super::Importer;
use super::animation::Motion;
use crate::scene::{GltfOptions, SceneError};
use crate::table::{printable, shortened};
use gltf::{Animation, Document};
use std::path::Path;

/// The chosen animation: its name, and whether the user chose it.
struct ChosenAnimation<'d> {
    animation: Animation<'d>,
    by_name: bool,
}

/// The name that stands for no animation, unless one is called so.
const NONE: &str = "none";

/// Returns the requested animation, or the first; `None` if none is requested or there is none.
fn choose<'d>(
    path: &Path,
    document: &'d Document,
    options: &GltfOptions,
) -> Result<Option<ChosenAnimation<'d>>, SceneError> {
    let Some(wanted) = &options.animation else {
        let first = document.animations().next();
        return Ok(first.map(|animation| ChosenAnimation {
            animation,
            by_name: false,
        }));
    };
    let named = document.animations().find(|it| it.name() == Some(wanted));
    let number = wanted.parse().ok();
    let numbered = || document.animations().nth(number?);
    let found = named.or_else(numbered);
    if found.is_none() && wanted == NONE {
        return Ok(None);
    }
    let names = document.animations().map(|it| match it.name() {
        Some(name) => printable(name),
        None => it.index().to_string(),
    });
    let names: Vec<_> = names.collect();
    let remedy = match names.is_empty() {
        true => String::from("leave `--animation` out"),
        false => format!("choose one of {}, or `{NONE}`", names.join(", ")),
    };
    let error = || {
        SceneError::new(
            path,
            format!(
                "there is no animation {wanted:?}",
                wanted = shortened(wanted)
            ),
            remedy,
        )
    };
    found.ok_or_else(error).map(|animation| {
        Some(ChosenAnimation {
            animation,
            by_name: true,
        })
    })
}

impl Importer<'_> {
    /// Reads the animation, and warns of the parts that are not shown.
    pub(super) fn animation(
        &mut self,
        document: &Document,
        options: &GltfOptions,
    ) -> Result<(), SceneError> {
        let chosen = choose(self.path, document, options)?;
        let animation = chosen.as_ref().map(|chosen| &chosen.animation);
        self.motion = Motion::read(self.path, document, animation, &self.buffers)?;
        for sentence in std::mem::take(&mut self.motion.left_out) {
            self.warn(sentence);
        }
        let Some(chosen) = chosen.filter(|_| !self.motion.is_empty()) else {
            return Ok(());
        };
        if !chosen.by_name && document.animations().len() > 1 {
            self.warn("the file has several animations, of which the first is read; choose one with `--animation`");
        }
        // Once for each skin, which many nodes may share.
        let bends = |skin: gltf::Skin<'_>| {
            let mut joints = skin.joints().map(|joint| joint.index());
            joints.any(|joint| self.motion.moves(joint))
        };
        let bends: Vec<bool> = document.skins().map(bends).collect();
        let bent = document.nodes().filter(|node| {
            node.mesh().is_some() && node.skin().is_some_and(|skin| bends[skin.index()])
        });
        let bent: Vec<_> = bent.collect();
        if let Some(node) = bent.first().filter(|_| chosen.by_name) {
            let name = node.name().map_or(String::new(), |name| {
                format!(" {name:?}", name = shortened(name))
            });
            return Err(self.error(
                format!(
                    "the animation bends node {}{name} by a skin, which is not supported",
                    node.index()
                ),
                "choose another `--animation`, or `--animation none`, or bake the mesh without it",
            ));
        }
        self.warn_of(
            bent.len(),
            "a mesh that the animation bends keeps its shape at rest; skins do not move",
        );
        Ok(())
    }
}
