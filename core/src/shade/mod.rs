//! What a surface makes of light: colours, materials, lights, glass.

mod color;
pub(crate) mod glass;
pub(crate) mod light;
mod material;

pub(crate) use color::Color;
