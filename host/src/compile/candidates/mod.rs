//! Builders of candidate lists: what the rays of a bundle can meet, found before any ray is cast.
//!
//! | file | what it holds |
//! |---|---|
//! | `shaft.rs` | a bundle of rays as a volume, and what it meets |
//! | `target.rs` | primitives as shafts see them, and the search through the hierarchy |
//! | `budget.rs` | what a table may take |
//! | `lists.rs` | tables of lists: counted first, equal ones once, in parallel |
//! | `cylinder_cube.rs` | lists for pairs of gridels |
//! | `census.rs` | what the paper's table takes, without building it |
//! | `entry.rs` | nodes of the hierarchy for pairs of gridels |
//! | `apex/` | lists for the rays of the eye and of lights |
//! | `bundle.rs` | these rays, and what they are sorted by |
//! | `ray_classes.rs` | lists for classes of rays by origin and direction |
//! | `own_rays.rs` | the rays of the scene's own picture, where classes are fine |

pub mod apex;
pub mod budget;
mod bundle;
pub mod census;
pub mod cylinder_cube;
pub mod entry;
pub mod lists;
pub mod own_rays;
pub mod ray_classes;
mod shaft;
pub mod target;
