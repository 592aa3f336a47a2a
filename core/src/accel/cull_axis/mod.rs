//! The culling form of one axis of a ray.

mod fixed;
mod float;

use crate::number::Arithmetic;
use crate::target::{NARROW_PRODUCTS, inline_unless_small};

/// Arithmetic of culling.
pub trait CullArithmetic: Arithmetic {
    /// A length from culling steps, which are half units (see [`crate::accel::cull`]); exact.
    fn from_cull(steps: i32) -> Self;
    /// A length in culling steps, rounded towards zero or down; saturates.
    fn to_cull(self) -> i32;
    /// Returns the culling form of one axis (see [`cull`](crate::accel)), for a slope and the origin's coordinate, of
    /// at most 2^17 units. The form holds the inverse slope in culling steps per unit with 16 fraction bits, limited to
    /// 2^29, with the sign of the slope. It also holds the offsets from its product with a plane to the step of entry
    /// and to that of exit, with the margins.
    fn cull_axis(slope: Self, origin: Self) -> CullAxis;
}

/// The culling form of one axis: see [`CullArithmetic::cull_axis`](crate::accel::cull_axis::CullArithmetic::cull_axis).
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct CullAxis {
    /// Steps per unit with 16 fraction bits, with the slope's sign.
    pub(crate) inverse: i32,
    /// The offset from a near plane's product to the step of entry.
    pub(crate) near: i32,
    /// The offset from a far plane's product to the step of exit.
    pub(crate) far: i32,
    /// 16 where the ray runs down the axis and the planes of a word swap roles, else 0.
    pub(crate) rotation: u32,
}

impl CullAxis {
    #[inline(always)]
    pub(in crate::accel) fn new(inverse: i32, near: i32, far: i32) -> Self {
        Self {
            inverse,
            near,
            far,
            rotation: (inverse >> 31) as u32 & 16,
        }
    }
}

/// True where the upper half of a product is free, and no instruction returns the upper 32 of 48 bits. The DSP
/// extension has such an instruction. So this is true on small cores without floats.
const UPPER_HALF: bool = cfg!(any(
    all(target_arch = "arm", not(target_abi = "eabihf")),
    target_arch = "riscv32"
));

/// True if there is a rotate instruction.
const ROTATES: bool = !cfg!(target_arch = "riscv32");

impl CullAxis {
    /// The step at which the ray enters through a plane.
    #[inline(always)]
    pub(crate) fn entry(&self, plane: i16) -> i32 {
        self.step(plane).wrapping_add(self.near)
    }

    /// The step at which the ray leaves through a plane.
    #[inline(always)]
    pub(crate) fn exit(&self, plane: i16) -> i32 {
        self.step(plane).wrapping_add(self.far)
    }

    /// Returns true if the ray runs down the axis.
    #[inline(always)]
    pub(crate) fn descends(&self) -> bool {
        self.rotation != 0
    }

    /// Returns the upper half of a plane's product; the plane is the upper half of a word.
    #[inline(always)]
    fn upper_half(&self, word: u32) -> i32 {
        ((self.inverse as i64 * word as i32 as i64) >> 32) as i32
    }

    /// Returns a plane's product: the upper bits of 48.
    #[inline(always)]
    fn step(&self, plane: i16) -> i32 {
        if NARROW_PRODUCTS {
            // Both products fit 32 bits.
            let (high, low) = (self.inverse >> 16, self.inverse & 0xffff);
            let plane = plane as i32;
            high.wrapping_mul(plane)
                .wrapping_add(low.wrapping_mul(plane) >> 16)
        } else if UPPER_HALF {
            self.upper_half((plane as u32) << 16)
        } else {
            ((self.inverse as i64 * plane as i64) >> 16) as i32
        }
    }

    /// Returns the two planes of a word in the order in which the ray reaches them.
    #[inline(always)]
    pub(crate) fn ordered(&self, planes: u32) -> [i16; 2] {
        let ordered = planes.rotate_right(self.rotation);
        [ordered as i16, (ordered >> 16) as i16]
    }

    inline_unless_small!(
        /// Returns the steps at which the ray enters and leaves between the two planes of a word.
        pub(in crate::accel) fn between(&self, planes: u32) -> Interval {
            let [near, far] = self.ordered(planes);
            Interval {
                near: self.entry(near),
                far: self.exit(far),
            }
        }
    );

    /// [`between`](Self::between) or an interval up to a unit wider, whichever is cheaper: for culling.
    #[inline(always)]
    pub(crate) fn around(&self, planes: u32) -> Interval {
        if ROTATES {
            self.between(planes)
        } else {
            self.around_by_shifts(planes)
        }
    }

    inline_unless_small!(
        /// Each plane is shifted into the upper half of a word. The lower half holds the other plane or zero, so the
        /// plane counts as up to a unit higher. Only the upper plane of the given word has another plane below it. The
        /// ray leaves at the upper plane if it runs up the axis, and enters there if it runs down. Either way the
        /// interval grows.
        pub(in crate::accel) fn around_by_shifts(&self, planes: u32) -> Interval {
            let near = planes.wrapping_shl(self.rotation ^ 16);
            let far = planes.wrapping_shl(self.rotation);
            Interval {
                near: self.upper_half(near).wrapping_add(self.near),
                far: self.upper_half(far).wrapping_add(self.far),
            }
        }
    );
}

/// The steps at which a ray enters and leaves something; it misses where `near > far`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Interval {
    /// The first step.
    pub near: i32,
    /// The last step.
    pub far: i32,
}

impl Interval {
    /// The intersection.
    #[inline(always)]
    pub(crate) fn and(self, other: Self) -> Self {
        Self {
            near: self.near.max(other.near),
            far: self.far.min(other.far),
        }
    }
}
