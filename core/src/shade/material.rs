//! The effects that materials, lights and views require.

use crate::format::Effects;
use crate::format::record::{Light, Material, View};
use crate::shade::All;
use crate::shade::effect::EffectList;
use crate::target::SMALL;

impl Material {
    /// Returns the effects that this material requires.
    pub fn effects(&self) -> Effects {
        All::required_by_material(self)
    }

    /// Returns true if light comes through the material.
    #[inline(always)]
    pub fn is_glass(&self) -> bool {
        is_any(&self.transmit)
    }

    /// Returns the exponent of the highlight.
    pub const fn exponent(&self) -> u16 {
        self.shininess & 0xfff
    }

    /// Returns the power of two that multiplies the coefficients of [`absorption`](Self::absorption), at most 15.
    pub const fn absorption_shift(&self) -> u32 {
        (self.shininess >> 12) as u32
    }
}

/// Returns true if a number is not 0. Builds for size would compare with `[0; 3]` by a function that compares memory.
#[cfg_attr(feature = "small", inline(never))]
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn is_any(numbers: &[i32; 3]) -> bool {
    match SMALL {
        true => numbers[0] | numbers[1] | numbers[2] != 0,
        false => *numbers != [0; 3],
    }
}

impl Light {
    /// Returns the effects that this light requires in a scene with objects, unless the scene turns them off.
    pub fn effects(&self) -> Effects {
        All::required_by_light(self)
    }
}

impl View {
    /// Returns the effects that this view requires.
    pub fn effects(&self) -> Effects {
        All::required_by_view(self)
    }
}
