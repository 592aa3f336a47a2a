//! Instructions of processors that gridel uses and safe Rust does not reach, as safe functions. So `gridel-core` needs no
//! `unsafe`.
//!
//! | target | what |
//! |---|---|
//! | x86-64 | AVX2 where the processor has it (`Avx2`, `F32x8`, `F64x4`), and prefetching |
//! | Arm with `f32` in its registers (`eabihf`) | the square root of an `f32` (`sqrt`) |
#![cfg_attr(not(target_arch = "x86_64"), no_std)]

#[cfg(all(target_arch = "arm", target_abi = "eabihf"))]
mod arm;
#[cfg(target_arch = "x86_64")]
mod x86;

#[cfg(all(target_arch = "arm", target_abi = "eabihf"))]
pub use arm::sqrt;
#[cfg(target_arch = "x86_64")]
pub use x86::*;
