//! A ray tracer that reads a scene blob in place. It has no allocation, no panic, no recursion and no `unsafe`, is
//! `no_std`, and gives the same bits on every machine.
//!
//! A host compiles a scene file into one binary blob (`gridel build`). [`Scene::from_bytes`] checks the blob once;
//! after that nothing can fail. The compiler can do most of that for firmware: see [`Prevalidated`]. A scene answers
//! two kinds of requests:
//!
//! - **rays**: [`Scene::closest_hit`] and [`Scene::any_hit`] with a [`Ray`] of your own, or [`closest_hit`],
//!   [`closest_primitive`] and [`any_hit`] for one structure and for counting. [`all_hits`] lists every crossing in
//!   order, [`count_hits`] counts them, and [`contains`] tests whether a point lies in an object;
//! - **pictures**: a [`Renderer`] returns pixels row by row or for any rectangle. A [`Cursor`](render::Cursor) returns
//!   them a bounded number of rays at a time, row by row or from coarse to fine.
//!
//! ```
//! # static BLOB: &[u8] =
//! #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
//! use gridel_core::{NoCount, Renderer, Rgb888, Scene, Workspace};
//!
//! let scene = Scene::from_bytes(BLOB)?;
//! let mut space = Workspace::for_any_scene();
//! let mut space = space.as_view();
//!
//! let renderer = Renderer::new(&scene)?;
//! let mut row = [Rgb888([0; 3]); 64];
//! renderer.row(0, 120, &mut row, &mut space, &mut NoCount);
//!
//! let ray = renderer.primary_ray(160, 120)?;
//! let mut stack = gridel_core::Stack::for_any_scene();
//! if let Some(hit) = scene.closest_hit(&ray, stack.as_view()) {
//!     println!("object {} at {:?}", hit.object, hit.point);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Both are generic over the number format (see [`Number`]): [`Fixed`] for cores without a floating-point unit, `f32`,
//! `f64`. They are also generic over the acceleration structure ([`List`], [`Bvh`], [`Flagged`], [`DualSplit`] and
//! others in [`accel`]). The structure never changes a bit of an answer.
//!
//! The page [`boards`] leads from a scene file to a picture on your own board.
//!
//! # Features
//! By default every shape, effect and structure is compiled in. [`Scene::closest_hit`], [`Renderer::new`] and all else
//! that chooses a structure at run time need the feature `all-structures`. Firmware takes `default-features = false`
//! and the features that its scene requires, which `gridel inspect` lists. Its code can then be a fifth as long.
//!
//! # Memory
//! The blob stays where it is. Only two things are written to, and the caller owns both. One is a [`Stack`] of 12 bytes
//! per entry, whose depth the blob's header states and `from_bytes` proves. The other, for pictures, is a list of
//! waiting rays (see [`Workspace`]).
//!
//! # Units
//! The length unit of the core is the *unit*, one step of the 16-bit box lattice; see
//! [`format::record::Header`] for how units relate to scene coordinates.
#![cfg_attr(not(any(test, feature = "std")), no_std)]
#![forbid(unsafe_code)]
#![deny(missing_docs)]
// In a build without some structures, the tools that they share can be unused.
#![cfg_attr(not(feature = "all-structures"), allow(dead_code))]

#[doc = include_str!("../BOARDS.md")]
pub mod boards {}

pub mod accel;
mod axis;
#[cfg(all(feature = "bvh", feature = "triangle"))]
pub mod deform;
pub mod format;
pub mod geometry;
mod instances;
pub mod number;
pub mod observe;
mod query;
pub mod ray;
pub mod render;
pub mod scene;
#[cfg(any(test, feature = "selftest"))]
pub mod selftest;
pub mod shade;
#[doc(hidden)]
pub mod shared;
mod simd;
mod target;
pub mod tracks;

pub use accel::types::*;
pub use accel::{Accel, Number, Stack, StackView, StructureVisitor};
#[cfg(all(feature = "bvh", feature = "triangle"))]
pub use deform::{DeformError, Deformation};
pub use format::{Aligned, BlobError, Effects, Kind, Requirements, Structure};
pub use number::{Angle, Fixed, Format};
pub use observe::count::{Counters, NoCount, Observer};
pub use observe::event::{Event, RayKind};
#[cfg(all(feature = "avx2", target_arch = "x86_64"))]
#[doc(hidden)]
pub use query::{FourReadyRays, HitNormals, ReadyRay};
pub use query::{
    Hit, HitList, PrimitiveHit, Solid, all_hits, any_hit, closest_hit, closest_primitive,
    containment_ray, contains, count_hits,
};
#[cfg(feature = "std")]
pub use query::{OrderedHit, every_hit};
#[cfg(all(feature = "avx2", target_arch = "x86_64"))]
#[doc(hidden)]
pub use ray::FourGivenRays;
pub use ray::{Pencil, Ray, RayError};
pub use render::{Camera, Renderer, Rgb565, Rgb888, Settings, Up, Workspace};
pub use scene::{Motion, Names, Parts, Poses, PosesView, Position, Prevalidated, Scene};
pub use simd::SimdLevel;
pub use tracks::Tracks;
