//! Effects of snapping on surfaces, on closed meshes, and on grids over stretched objects.

mod closed;
mod displacement;
mod meshes;
mod tests_per_ray;
