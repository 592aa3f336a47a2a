//! The number formats of queries and renderers.

use crate::accel::cull::{Cull, PairCulling};
use crate::accel::cull_axis::CullArithmetic;
use crate::accel::wide::cull::{WideCulling, WideLanes};
use crate::geometry::Project;
use crate::number::Fixed;

/// A number format of queries and renderers: `fixed`, `f32` or `f64`.
///
/// All arithmetic, projection and culling in one bound. See [`number`](crate::number) for the quantities that a number
/// represents.
pub trait Number: Project + CullArithmetic {
    /// The form in which rays of this format cull boxes on this machine.
    type Cull: PairCulling<Self>;
    /// The form in which rays of this format cull eight boxes at once.
    type WideCull: WideCulling<Self>;
}

impl Number for Fixed {
    type Cull = Cull;
    type WideCull = Cull;
}

impl Number for f32 {
    type Cull = FloatCulling;
    type WideCull = WideLanes;
}

impl Number for f64 {
    type Cull = FloatCulling;
    type WideCull = WideLanes;
}

/// The form in which rays of a float format cull on this machine.
///
/// Cores with SIMD registers test four planes at a time; the others use integers. Neither can change an answer. Only
/// the number of boxes that are visited in vain can differ, by the width of a margin.
type FloatCulling = cfg_select! {
    any(
        target_arch = "x86_64",
        target_arch = "aarch64",
        all(target_arch = "wasm32", target_feature = "simd128")
    ) => crate::accel::lanes::Lanes,
    _ => Cull,
};
