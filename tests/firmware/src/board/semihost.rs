//! Services of QEMU for the program, by Arm's semihosting. The leanest way, without formatting or
//! buffers: the program shares 8 KiB with it.

use core::arch::asm;
use core::ffi::CStr;

/// Operations (Arm, *Semihosting for AArch32 and AArch64*, 6).
const OPEN: usize = 0x01;
const WRITE_CHARACTER: usize = 0x03;
const WRITE: usize = 0x05;
const EXIT_EXTENDED: usize = 0x20;
/// Mode of opening a file: for writing, empty, as bytes.
const WRITE_BINARY: usize = 5;
/// Reason of an exit: the application ends.
const APPLICATION_EXIT: usize = 0x2_0026;

/// Asks the host for an operation.
///
/// # Safety
/// The parameter is what the operation wants, mostly the address of its arguments.
unsafe fn call(operation: usize, parameter: usize) -> usize {
    let result;
    // SAFETY: the host reads only memory that is valid by the caller's contract, and writes only the result.
    unsafe {
        #[cfg(target_arch = "arm")]
        asm!("bkpt #0xab", inout("r0") operation => result, in("r1") parameter, options(nostack));
        // This sequence, uncompressed and in one page, is the call.
        #[cfg(target_arch = "riscv32")]
        asm!(
            ".balign 16", ".option push", ".option norvc",
            "slli x0, x0, 0x1f", "ebreak", "srai x0, x0, 7",
            ".option pop",
            inout("a0") operation => result, in("a1") parameter, options(nostack)
        );
    }
    result
}

/// Prints text on the host, letter by letter.
pub fn print(text: &str) {
    for letter in text.as_bytes() {
        // SAFETY: the address of one letter.
        unsafe { call(WRITE_CHARACTER, &raw const *letter as usize) };
    }
}

/// A file of the host.
pub struct File(usize);

impl File {
    /// Creates a file, or empties it.
    pub fn create(name: &CStr) -> Option<Self> {
        let arguments = [name.as_ptr() as usize, WRITE_BINARY, name.count_bytes()];
        // SAFETY: the name and its length.
        let handle = unsafe { call(OPEN, arguments.as_ptr() as usize) };
        (handle != usize::MAX).then_some(Self(handle))
    }

    /// Writes bytes, all or none. Returns whether it did.
    pub fn write(&self, bytes: &[u8]) -> bool {
        let arguments = [self.0, bytes.as_ptr() as usize, bytes.len()];
        // SAFETY: an open file, and the bytes. What comes back is how many were not written.
        unsafe { call(WRITE, arguments.as_ptr() as usize) == 0 }
    }
}

/// Ends the program and the emulator.
pub fn exit(code: u8) -> ! {
    let arguments = [APPLICATION_EXIT, code.into()];
    // SAFETY: the reason and the code.
    unsafe { call(EXIT_EXTENDED, arguments.as_ptr() as usize) };
    loop {
        core::hint::spin_loop();
    }
}
