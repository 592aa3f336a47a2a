//! What snapping does to surfaces, to closed meshes, and to grids over what is stretched.

mod closed;
mod displacement;
mod meshes;
mod tests_per_ray;
