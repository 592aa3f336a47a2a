//! Names of what tracks move, for messages.

use super::track::{Track, TrackTarget};
use super::{Diffuse, Material, Scene};
use crate::table::printable;

impl Scene {
    /// Returns what a track moves, as a scene file names it, such as `light.sun.color`. A light without a name of its
    /// own has its number.
    pub(crate) fn target_of(&self, track: &Track) -> String {
        let (target, index) = (track.target, track.index);
        let Some((owner, property)) = target.name().split_once('.') else {
            return target.name().to_owned();
        };
        let name = if target.is_of_camera() {
            return target.name().to_owned();
        } else if target.is_of_light() {
            self.light_names.get(index).filter(|own| {
                let same = self.light_names.iter().filter(|it| it == own);
                !own.is_empty() && same.count() == 1
            })
        } else if target.is_of_material() {
            self.materials.get(index).map(|it| &it.name)
        } else if target.is_of_joint() {
            self.joints.get(index).map(|it| &it.name)
        } else {
            self.morph_targets.get(index).map(|it| &it.name)
        };
        let name = name.map_or_else(|| index.to_string(), |name| printable(name));
        let is_checker = |material: &Material| matches!(material.diffuse, Diffuse::Checker { .. });
        match target {
            TrackTarget::MaterialDiffuse if self.materials.get(index).is_some_and(is_checker) => {
                format!("{owner}.{name}.checker.even")
            }
            _ => format!("{owner}.{name}.{property}"),
        }
    }
}
