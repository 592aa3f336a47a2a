//! All arithmetic of a number format.

use crate::number::convert::Convert;
use crate::number::error_bounds::ErrorBounds;
use crate::number::powers::Powers;
use crate::number::vectors::Vectors;

/// The arithmetic of a number format. Kernels of rays require more: see [`Number`](crate::accel::Number).
pub trait Arithmetic: Convert + Vectors + ErrorBounds + Powers {}

impl<N: Convert + Vectors + ErrorBounds + Powers> Arithmetic for N {}
