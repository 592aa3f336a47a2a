//! Instructions of Arm processors with a unit for `f32`.

use core::arch::asm;

/// The square root, correctly rounded: every bit is that of `libm::sqrtf`, but for the payload of NaN.
///
/// Registers of the unit cannot be operands on stable Rust, so one of them is lent and given back.
#[inline(always)]
pub fn sqrt(x: f32) -> f32 {
    let root: u32;
    // SAFETY: calling conventions named `eabihf` are for processors with the unit. The code changes no register but its
    // operands and flags, and no memory.
    unsafe {
        asm!(
            "vmov {lent}, s0",
            "vmov s0, {x}",
            "vsqrt.f32 s0, s0",
            "vmov {root}, s0",
            "vmov s0, {lent}",
            lent = out(reg) _,
            x = in(reg) x.to_bits(),
            root = lateout(reg) root,
            options(pure, nomem, nostack),
        );
    }
    f32::from_bits(root)
}
