//! Shading: one file for each effect, and the code that they share.
//!
//! An effect implements the trait of `effect.rs` at one or more places of the ray loop, and is named
//! in the table of `format/effects.rs`.
//!
//! | place | when | effects |
//! |---|---|---|
//! | `camera` | a ray leaves the camera | depth of field |
//! | `arrive` | a ray has come to a hit | nested, absorption |
//! | `surface` | a ray hits a surface | checker, smooth, texture levels, normal map, vertex colors, texture, alpha |
//! | `emit` | a surface sends out light of its own | emission |
//! | `aim` | a surface looks for a light | area light, environment |
//! | `face` | a surface faces a light | smooth, normal map, falloff |
//! | `reflect` | a surface reflects a light | highlight, glossy |
//! | `light` | light arrives at a surface | environment, shadow, falloff |
//! | `filter` | a surface is in the way of light | glass, nested, absorption, alpha |
//! | `reach` | nothing else is in the way of light | absorption |
//! | `miss` | a ray hits nothing | environment |
//! | `bounce` | a surface sends rays on | glossy, mirror, glass, alpha, indirect |
//! | `leave` | a ray leaves a hit | smooth, normal map, glossy, nested, absorption, indirect |
//! | `pixel` | all rays of a sample were traced | |
//! | `develop` | the mean of a pixel's samples is known | tone mapping |

mod basis;
mod color;
pub(crate) mod departure;
pub(crate) mod effect;
pub(crate) mod facets;
pub(crate) mod light;
mod material;
pub mod sampler;
mod solid_angle;
pub(crate) mod surface;

use crate::format::effects::{Effects, effects};
use effect::EffectList;

pub(crate) use color::Color;

/// Declares the module of every effect, and lists them.
macro_rules! list {
    ($(
        $(#[doc = $doc:literal])*
        $effect:ident = $bit:literal, $name:literal, $type:ident in $module:ident,
            casts $rays:literal, required by $required_by:literal;
    )*) => {
        $(mod $module;)*

        /// The effects of this crate, in the order in which they act, and others behind them.
        pub(crate) type EffectsThen<Others> = list!(@ $($module::$type,)*; Others);
    };
    (@ ; $others:ident) => { $others };
    (@ $first:path, $($rest:path,)*; $others:ident) => { ($first, list!(@ $($rest,)*; $others)) };
}

effects!(list);

impl Effects {
    /// The effects that act on light through surfaces. Without them a shadow ray stops at any hit.
    pub const FILTERING: Effects = Effects(<EffectsThen<()> as EffectList>::FILTERING);
}

/// The list that the ray loop calls.
#[cfg(not(test))]
pub(crate) type All = EffectsThen<()>;

#[cfg(test)]
mod tests;
#[cfg(test)]
pub(crate) use tests::All;
