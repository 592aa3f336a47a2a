//! What a program holds.

use object::{File, Object, ObjectSegment, ObjectSymbol, SymbolKind};
use std::path::Path;

/// A linked program: its functions, and what it takes in flash.
pub struct Elf {
    functions: Vec<String>,
    flash_bytes: u64,
}

impl Elf {
    /// Reads an ELF.
    pub fn read(path: impl AsRef<Path>) -> Self {
        let data = std::fs::read(path).expect("the program was built");
        let file = File::parse(&data[..]).expect("a linker writes a valid ELF");
        let functions = file
            .symbols()
            .filter(|symbol| symbol.kind() == SymbolKind::Text && symbol.is_definition())
            .filter_map(|symbol| symbol.name().ok().map(String::from))
            .collect();
        let flash_bytes = file.segments().map(|segment| segment.file_range().1).sum();
        Self {
            functions,
            flash_bytes,
        }
    }

    /// Bytes in flash: vectors, code, constants, initial values.
    pub fn flash_bytes(&self) -> u64 {
        self.flash_bytes
    }

    /// The functions whose name is of some kind.
    pub fn functions(&self, kind: impl Fn(&str) -> bool) -> Vec<&str> {
        let all = self.functions.iter().map(String::as_str);
        all.filter(|name| kind(name)).collect()
    }
}

/// Whether a function is what a panic calls.
pub fn panics(name: &str) -> bool {
    name.contains("panic")
}

/// Whether a function is a routine of soft floats: of the Arm run-time ABI (4.1.2), or by the name
/// that GCC's library and LLVM's give it.
pub fn computes_in_floating_point(name: &str) -> bool {
    const CONVERSIONS: [&str; 9] = [
        "__aeabi_i2f",
        "__aeabi_ui2f",
        "__aeabi_i2d",
        "__aeabi_ui2d",
        "__aeabi_l2f",
        "__aeabi_ul2f",
        "__aeabi_l2d",
        "__aeabi_ul2d",
        "__aeabi_h2f",
    ];
    const OPERANDS: [&str; 4] = ["sf2", "df2", "sf3", "df3"];
    name.starts_with("__aeabi_f")
        || name.starts_with("__aeabi_d")
        || name.starts_with("__aeabi_cf")
        || name.starts_with("__aeabi_cd")
        || CONVERSIONS.contains(&name)
        || name.starts_with("__") && OPERANDS.iter().any(|operand| name.ends_with(operand))
        || name.contains("libm")
}
