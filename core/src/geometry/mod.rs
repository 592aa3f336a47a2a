//! Primitives: the crossings of rays with them, and their surfaces.
//!
//! One file per shape. Each kernel returns the *crossing*: where the line of the ray enters and
//! leaves the primitive, behind the origin too. `accept` decides for all shapes which part of a
//! crossing is a hit.

pub mod attributes;
pub(crate) mod cluster;
mod crossing;
pub(crate) mod flat;
mod half_open;
mod layouts;
pub(crate) mod pack;
pub(crate) mod primitive;
mod primitive_id;
pub(crate) mod project;
mod shapes;
pub mod smooth;
pub(crate) mod sphere;
pub(crate) mod strip;
mod surface;
pub(crate) mod triangle;

pub(crate) use cluster::{Clusters, Packs, Packs24, Strips};
pub(crate) use crossing::{Crossing, LATER, LEAVING, Part, accept, cross_plane};
pub(crate) use primitive_id::PrimitiveId;
pub use project::Project;
pub use shapes::Geometry;
pub(crate) use shapes::{Shapes, is_flat};
pub(crate) use surface::Surface;

use crate::format::kind::shapes;

/// Declares the modules of shapes that have one record.
macro_rules! modules {
    (
        forms { $($form:tt)* }
        records { $(
            $(#[doc = $doc:literal])* $kind:ident = $number:literal, $name:literal,
            [$field:ident: $module:ident::$record:ident], $section:tt;
        )* }
    ) => {
        $(pub mod $module;)*
    };
}

shapes!(modules);
