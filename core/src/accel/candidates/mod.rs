//! Candidate lists: a table gives, for a ray, all primitives that it can hit.
//!
//! | structure | a list for each |
//! |---|---|
//! | [`cylinder_cube`] | pair of gridels on the faces of the scene's box (Stuerzlinger and Tobler 1993) |
//! | [`cylinder_cube_tight`] | the same, sorted along the way between the gridels |
//! | [`cylinder_cube_entry`] | the same, of nodes of `bvh` at which a ray enters |
//! | [`apex`] | cell of the directions from the eye or from a light |
//! | [`ray_classes`] | class of rays by origin and direction (Arvo and Kirk 1987) |
//!
//! A look-up takes constant time, then every candidate of the list is tested. Tables take far more memory than
//! hierarchies, so the compiler limits them to a budget. Loading cannot prove in linear time that a list is complete:
//! see [`Structure::is_proved`](crate::Structure::is_proved). Use them for scenes of few primitives and many similar
//! rays.

pub mod apex;
pub mod cylinder_cube;
pub mod cylinder_cube_entry;
pub mod cylinder_cube_tight;
mod gridel_table;
pub(crate) mod gridels;
mod line;
pub(crate) mod lists;
pub mod ray_classes;
