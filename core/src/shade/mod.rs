//! Shading: one file for each effect, and the code that they share.
//!
//! An effect implements the trait of `effect.rs` at one or more places of the ray loop, and is named
//! in the table of `format/effects.rs`. `CONTRIBUTING.md` lists the effects at each place.
//!
//! | place | when |
//! |---|---|
//! | `camera` | a ray leaves the camera |
//! | `arrive` | a ray has come to a hit |
//! | `surface` | a ray hits a surface |
//! | `emit` | a surface sends out light of its own |
//! | `aim` | a surface looks for a light |
//! | `face` | a surface faces a light |
//! | `reflect` | a surface reflects a light |
//! | `light` | light arrives at a surface |
//! | `filter` | a surface is in the way of light |
//! | `reach` | nothing else is in the way of light |
//! | `miss` | a ray hits nothing |
//! | `bounce` | a surface sends rays on |
//! | `leave` | a ray leaves a hit |
//! | `pixel` | all rays of a sample were traced |
//! | `develop` | the mean of a pixel's samples is known |

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
