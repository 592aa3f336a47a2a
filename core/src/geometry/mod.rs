//! Primitives: where a ray crosses them, and how their surface lies there.
//!
//! One file a primitive. Each kernel gives the *crossing*: where the line of the ray enters and
//! leaves the primitive, behind the origin too. What of that is a hit is decided once for
//! all of them, in `accept`.

#[cfg(feature = "wide")]
pub(crate) mod cluster;
pub(crate) mod cone;
mod crossing;
pub(crate) mod cuboid;
pub(crate) mod disc;
#[cfg(feature = "wide")]
pub(crate) mod pack;
pub(crate) mod plane;
mod primitive_id;
pub(crate) mod project;
mod shapes;
pub(crate) mod sphere;
#[cfg(feature = "wide")]
pub(crate) mod strip;
mod surface;
pub(crate) mod triangle;

#[cfg(feature = "wide")]
pub(crate) use cluster::{Clusters, Packs, Packs24, Strips};
pub(crate) use crossing::{Crossing, LEAVING, Part, accept, cross_plane};
pub(crate) use primitive_id::PrimitiveId;
pub use project::Project;
pub use shapes::Geometry;
pub(crate) use shapes::{Shapes, Spheres, Triangles, Vertices};
pub(crate) use surface::Surface;
