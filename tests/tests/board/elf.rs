//! The content of a program.

use crate::stack::{CallGraph, Path};
use object::{File, Object, ObjectSection, ObjectSegment, ObjectSymbol, SectionKind, SymbolKind};
use std::collections::BTreeSet;

/// A linked program: its functions, and its bytes in flash and RAM.
pub struct Elf {
    data: Vec<u8>,
}

impl Elf {
    /// Reads an ELF.
    pub fn read(path: impl AsRef<std::path::Path>) -> Self {
        Self {
            data: std::fs::read(path).expect("the program was built"),
        }
    }

    fn file(&self) -> File<'_> {
        File::parse(&self.data[..]).expect("a linker writes a valid ELF")
    }

    /// Bytes in flash: vectors, code, constants, initial values.
    pub fn flash_bytes(&self) -> u64 {
        let file = self.file();
        file.segments().map(|segment| segment.file_range().1).sum()
    }

    /// Bytes of them that are the vector table.
    pub fn vector_bytes(&self) -> u64 {
        let file = self.file();
        let table = file.section_by_name(".vector_table");
        table.map_or(0, |section| section.size())
    }

    /// Returns the bytes in RAM besides the stack.
    pub fn static_bytes(&self) -> u64 {
        let file = self.file();
        let sections = file.sections().filter(|section| {
            // `.stack` and `.heap` are the rest.
            let rest = section
                .name()
                .is_ok_and(|name| [".stack", ".heap"].contains(&name));
            let data = [SectionKind::Data, SectionKind::UninitializedData];
            !rest && data.contains(&section.kind())
        });
        sections.map(|section| section.size()).sum()
    }

    /// The deepest call path from the program's start.
    pub fn deepest_path(&self) -> Result<Path, String> {
        CallGraph::read(&self.file())?.deepest()
    }

    /// The functions whose name is of some kind.
    pub fn functions(&self, kind: impl Fn(&str) -> bool) -> BTreeSet<String> {
        let file = self.file();
        let functions = file
            .symbols()
            .filter(|symbol| symbol.kind() == SymbolKind::Text && symbol.is_definition());
        let names = functions.filter_map(|symbol| symbol.name().ok().map(String::from));
        names.filter(|name| kind(name)).collect()
    }
}

/// Returns whether a panic calls a function.
pub fn panics(name: &str) -> bool {
    name.contains("panic")
}

/// Returns whether a function hands out memory.
pub fn allocates(name: &str) -> bool {
    name.contains("__rust_alloc") || name.contains("__rustc::__rdl")
}

/// Returns whether a function is a routine of soft floats. The names are those of the Arm run-time
/// ABI (4.1.2), and those of GCC's library and LLVM's.
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
