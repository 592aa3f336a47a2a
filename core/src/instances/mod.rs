//! Instances: parts that are placed in a scene by maps.
//!
//! A [map](crate::format::instance) leads from the scene's units to a part's. A ray is mapped once per instance that it
//! can hit, and traced through the part as through a scene of its own. So a part is exact and closed under every map.
//!
//! `map` maps rays, points and normals; `bounds` is the box of an instance; `top` finds the instances that a ray can
//! hit. `placed` is both with the parts; `check` proves the instances of a blob.
//!
//! **The answer is defined without the hierarchy**, as it is for primitives: each instance's first hit, by its t on the
//! scene's ray. Among hits at the same t the scene's own objects come first, then the instance with the lower number.
//! Then the one that comes first in the blob counts, because a forged blob can give two the same number.

pub(crate) mod bounds;
pub(crate) mod build;
pub(crate) mod check;
pub(crate) mod map;
pub(crate) mod placed;
pub(crate) mod top;
