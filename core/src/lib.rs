//! Ray traces straight out of a scene blob: `no_std`, no allocation, no panic, no recursion, no
//! `unsafe`, and the same bits on every machine.
//!
//! A host compiles a scene file into one binary blob (`gridel build`). [`Scene::from_bytes`] checks
//! the blob once; after that nothing can fail. Firmware can have most of that done by the compiler:
//! see [`Prevalidated`]. Two things can be asked of a scene:
//!
//! - **rays**: [`closest_hit`], [`closest_primitive`] and [`any_hit`], with a [`Ray`] of your own;
//! - **pictures**: a [`Renderer`] gives pixels row by row or for any rectangle, and a
//!   [`Cursor`](render::Cursor) gives them a bounded number of rays at a time.
//!
//! Both are generic over the number format (see [`Number`]): [`Fixed`] for cores without a
//! floating-point unit, `f32`, `f64`; and over the acceleration structure ([`List`], [`Bvh`],
//! [`Flagged`], [`DualSplit`] and others in [`accel`]). The structure never changes a bit of an answer.
//!
//! The page [`boards`] leads from a scene file to a picture on your own board.
//!
//! # Memory
//! The blob stays where it is. The caller owns the two things that are written to: a [`Stack`] of
//! 12 bytes an entry, whose depth the blob's header states and `from_bytes` proves, and, for
//! pictures, a list of rays that wait (see [`Workspace`]).
//!
//! # Units
//! The length unit of the core is the *unit*, one step of the 16-bit box lattice; see
//! [`format::record::Header`] for how units relate to scene coordinates.
#![cfg_attr(not(any(test, feature = "std")), no_std)]
#![forbid(unsafe_code)]
#![deny(missing_docs)]
// A build without some structures leaves tools unused that they share.
#![cfg_attr(not(feature = "all-structures"), allow(dead_code))]

#[doc = include_str!("../BOARDS.md")]
pub mod boards {}

pub mod accel;
mod axis;
pub mod format;
pub mod geometry;
pub mod number;
pub mod observe;
mod query;
pub mod ray;
pub mod render;
pub mod scene;
#[cfg(any(test, feature = "selftest"))]
pub mod selftest;
pub mod shade;
#[cfg(feature = "wide")]
mod simd;
mod target;

#[cfg(feature = "apex")]
pub use accel::Apex;
#[cfg(feature = "bvh")]
pub use accel::Bvh;
#[cfg(feature = "cylinder-cube")]
pub use accel::CylinderCube;
#[cfg(feature = "cylinder-cube-entry")]
pub use accel::CylinderCubeEntry;
#[cfg(feature = "cylinder-cube-tight")]
pub use accel::CylinderCubeTight;
#[cfg(feature = "dual-split")]
pub use accel::DualSplit;
#[cfg(feature = "flagged")]
pub use accel::Flagged;
#[cfg(feature = "flagged-slabs")]
pub use accel::FlaggedSlabs;
#[cfg(feature = "grid")]
pub use accel::Grid;
#[cfg(feature = "octree")]
pub use accel::Octree;
#[cfg(feature = "ray-classes")]
pub use accel::RayClasses;
#[cfg(feature = "slabs")]
pub use accel::Slabs;
#[cfg(feature = "spheres")]
pub use accel::Spheres;
#[cfg(feature = "wide")]
pub use accel::Wide;
pub use accel::{Accel, List, Number, Stack, StackView, StructureVisitor};
pub use format::{Aligned, BlobError, Effects, Kind, Requirements, Structure};
pub use number::{Fixed, Format};
pub use observe::count::{Counters, NoCount, Observer};
pub use observe::event::{Event, RayKind};
pub use query::{Found, Hit, any_hit, closest_hit, closest_primitive};
pub use ray::{Pencil, Ray, RayError};
pub use render::{Renderer, Rgb565, Rgb888, Settings, Workspace};
pub use scene::{Names, Prevalidated, Scene};
#[cfg(feature = "wide")]
pub use simd::SimdLevel;
