//! Observers: counters of work, and events of rays.

pub mod count;
pub mod event;
