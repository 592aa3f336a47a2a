//! Observers: counters of work, and the story of a ray.

pub mod count;
pub mod event;
