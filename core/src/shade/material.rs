//! The effects that materials, lights and views require.

use crate::format::Effects;
use crate::format::record::{Light, Material, View};
use crate::shade::All;
use crate::shade::effect::EffectList;

impl Material {
    /// The effects that this material requires.
    pub fn effects(&self) -> Effects {
        All::required_by_material(self)
    }
}

impl Light {
    /// The effects that this light requires in a scene with objects, unless the scene turns them off.
    pub fn effects(&self) -> Effects {
        All::required_by_light(self)
    }
}

impl View {
    /// The effects that this view requires.
    pub fn effects(&self) -> Effects {
        All::required_by_view(self)
    }
}
