//! The deepest call path of a linked program, from its instructions: how much stack it can take.
//!
//! Every direct call and jump is decoded (Thumb and RV32). The frame of a function is what the compiler stated in
//! `.stack_sizes`. For libraries that come compiled, it is what the prologue takes. The bound holds because nothing is
//! called through a pointer that was passed on and nothing recurses; the test requires both. Relocations show whose
//! address is taken and where. Only code may take one, and counts as calling it. Small code loads the address of a
//! function that it calls more than twice, and calls the register. Code that calls a register without having taken an
//! address is rejected.

use object::elf::{
    R_ARM_ABS32, R_ARM_MOVT_ABS, R_ARM_MOVW_ABS_NC, R_ARM_THM_MOVT_ABS, R_ARM_THM_MOVW_ABS_NC,
    R_RISCV_32, R_RISCV_HI20, R_RISCV_PCREL_HI20,
};
use object::{
    Architecture, File, Object, ObjectSection, ObjectSymbol, RelocationFlags, RelocationTarget,
    SectionKind, SymbolKind,
};
use std::collections::BTreeMap;
use std::ops::Range;

/// A program's functions by address.
pub struct CallGraph {
    functions: BTreeMap<u64, Function>,
    entry: u64,
}

struct Function {
    name: String,
    frame: u64,
    calls: Vec<u64>,
}

/// A path through the call graph.
#[derive(Clone, Debug, Default)]
pub struct Path {
    /// Bytes of all its frames.
    pub bytes: u64,
    /// Its functions with their frames, the outermost first.
    pub functions: Vec<String>,
}

impl CallGraph {
    /// Reads a program that was linked with `--emit-relocs`.
    ///
    /// # Errors
    /// If a frame is unknown, or a function may be called through a pointer that was passed on.
    pub fn read(file: &File<'_>) -> Result<Self, String> {
        let decoder: Decoder = match file.architecture() {
            Architecture::Arm => thumb,
            Architecture::Riscv32 => riscv,
            other => return Err(format!("no decoder for {other:?}")),
        };
        let code = Code::of(file);
        let stated = stated_frames(file);
        let ranges = functions(file);
        let taken = taken_addresses(file, &ranges)?;
        let mut functions = BTreeMap::new();
        let entry = file.entry() & !1;
        let steps: Vec<u64> = ranges
            .iter()
            .filter(|(range, name)| STEPS.contains(&&name[..]) && range.start != entry)
            .map(|(range, _)| range.start)
            .collect();
        for (range, name) in ranges {
            let mut decoded = Decoded::default();
            code.decode(range.clone(), decoder, &mut decoded);
            let frame = match (stated.get(&range.start), decoded.frame) {
                // Code that functions of a small build share; the compiler states no frame of it.
                (Some(&stated), Some(found)) if name.starts_with("OUTLINED_FUNCTION_") => {
                    stated.max(found)
                }
                (Some(&stated), Some(found)) if found > stated => {
                    return Err(format!("{name}: {found} bytes of frame, {stated} stated"));
                }
                (Some(&stated), _) => stated,
                (None, Some(found)) => found,
                (None, None) => return Err(format!("{name}: its frame is not known")),
            };
            let outside = |target: &u64| !range.contains(target);
            let mut calls: Vec<u64> = decoded.targets.into_iter().filter(outside).collect();
            match taken.get(&range.start) {
                Some(taken) => calls.extend(taken),
                None if decoded.calls_register => {
                    return Err(format!("{name} calls through a pointer that it was handed"));
                }
                None => (),
            }
            if range.start == entry {
                calls.extend(&steps);
            }
            functions.insert(range.start, Function { name, frame, calls });
        }
        Ok(Self { functions, entry })
    }

    /// The deepest path from the program's entry.
    ///
    /// # Errors
    /// If a function calls itself, directly or through others, or the target of a call is unknown.
    pub fn deepest(&self) -> Result<Path, String> {
        let mut known = BTreeMap::new();
        self.deepest_from(self.entry, &mut Vec::new(), &mut known)
    }

    fn deepest_from(
        &self,
        address: u64,
        callers: &mut Vec<u64>,
        known: &mut BTreeMap<u64, Path>,
    ) -> Result<Path, String> {
        if let Some(path) = known.get(&address) {
            return Ok(path.clone());
        }
        // A jump may lead into a routine of assembly, not to its start.
        let function = self.functions.range(..=address).next_back();
        let Some((_, function)) = function else {
            return Err(format!("a call to {address:#x}, where no function is"));
        };
        if callers.contains(&address) {
            return Err(format!("{} calls itself", function.name));
        }
        callers.push(address);
        let mut deepest = Path::default();
        for &call in &function.calls {
            let path = self.deepest_from(call, callers, known)?;
            if path.bytes > deepest.bytes {
                deepest = path;
            }
        }
        callers.pop();
        deepest.bytes += function.frame;
        let line = format!("{:>6}  {}", function.frame, function.name);
        deepest.functions.insert(0, line);
        known.insert(address, deepest.clone());
        Ok(deepest)
    }
}

/// All functions, and the code up to the next symbol for those of assembly that state no size.
fn functions(file: &File<'_>) -> Vec<(Range<u64>, String)> {
    let mut starts: BTreeMap<u64, (u64, String)> = BTreeMap::new();
    let symbols = file.symbols().filter(|symbol| {
        let name = symbol.name().unwrap_or_default();
        // Labels that begin with two underscores are the linker's own, for the ends of sections.
        let kind = match symbol.kind() {
            SymbolKind::Text => true,
            SymbolKind::Unknown | SymbolKind::Label => !name.starts_with("__"),
            _ => false,
        };
        let ours = !name.starts_with(['$', '.']) && !name.is_empty();
        kind && ours && in_code(file, symbol.section_index())
    });
    for symbol in symbols {
        let entry = starts.entry(symbol.address() & !1).or_default();
        entry.0 = entry.0.max(symbol.size());
        if entry.1.is_empty() || symbol.kind() == SymbolKind::Text {
            entry.1 = symbol.name().unwrap_or_default().into();
        }
    }
    let ends: Vec<u64> = starts.keys().copied().skip(1).collect();
    let section_end = |start: u64| {
        let holding = file.sections().find(|section| {
            (section.address()..section.address() + section.size()).contains(&start)
        });
        holding.map_or(start, |section| section.address() + section.size())
    };
    let ends = ends.into_iter().map(Some).chain([None]);
    let sized = starts
        .iter()
        .zip(ends)
        .map(|((&start, (size, name)), next)| {
            let end = section_end(start);
            let rest = next.map_or(end, |next| next.min(end)) - start;
            let size = if *size == 0 { rest } else { *size };
            (start..start + size, name.clone())
        });
    sized.filter(|(range, _)| !range.is_empty()).collect()
}

fn in_code(file: &File<'_>, section: Option<object::SectionIndex>) -> bool {
    let section = section.and_then(|index| file.section_by_index(index).ok());
    section.is_some_and(|section| section.kind() == SectionKind::Text)
}

/// Frames by function, as the compiler states them: an address and a ULEB128 number each.
fn stated_frames(file: &File<'_>) -> BTreeMap<u64, u64> {
    let mut frames = BTreeMap::new();
    for section in file.sections().filter(|s| s.name() == Ok(".stack_sizes")) {
        let data = section.data().unwrap_or_default();
        let mut rest = data;
        while let Some((address, after)) = rest.split_first_chunk::<4>() {
            let (mut value, mut shift, mut used) = (0_u64, 0, 0);
            for byte in after {
                value |= u64::from(byte & 0x7f) << shift;
                shift += 7;
                used += 1;
                if byte & 0x80 == 0 {
                    break;
                }
            }
            frames.insert(u64::from(u32::from_le_bytes(*address)) & !1, value);
            rest = &after[used..];
        }
    }
    frames
}

/// Functions that only the hardware calls, by an address that the start-up code sets.
const TRAPS: [&str; 3] = ["_start_trap", "_default_start_trap", "_default_abort"];
/// The steps of riscv-rt's start-up code, which jumps through registers from one to the next.
const STEPS: [&str; 2] = ["_abs_start", "_start_rust"];

/// Returns, for each function, the functions whose address it takes: it might call them through a register.
///
/// # Errors
/// If data holds the address of a function.
fn taken_addresses(
    file: &File<'_>,
    functions: &[(Range<u64>, String)],
) -> Result<BTreeMap<u64, Vec<u64>>, String> {
    let mut taken: BTreeMap<u64, Vec<u64>> = BTreeMap::new();
    for section in file.sections() {
        let section_name = section.name().unwrap_or_default();
        let kinds = [
            SectionKind::Text,
            SectionKind::ReadOnlyData,
            SectionKind::Data,
        ];
        let allocated = kinds.contains(&section.kind());
        // The hardware calls the functions of the vector table; nothing unwinds.
        if !allocated || [".vector_table", ".ARM.exidx"].contains(&section_name) {
            continue;
        }
        for (place, relocation) in section.relocations() {
            let RelocationFlags::Elf { r_type } = relocation.flags() else {
                continue;
            };
            let RelocationTarget::Symbol(symbol) = relocation.target() else {
                continue;
            };
            let symbol = file.symbol_by_index(symbol);
            let symbol = symbol.map_or(0, |symbol| symbol.address());
            let value = match r_type {
                R_ARM_ABS32 | R_RISCV_32 => word(&section, place),
                R_ARM_THM_MOVW_ABS_NC
                | R_ARM_THM_MOVT_ABS
                | R_ARM_MOVW_ABS_NC
                | R_ARM_MOVT_ABS
                | R_RISCV_HI20
                | R_RISCV_PCREL_HI20 => symbol.wrapping_add_signed(relocation.addend()),
                _ => continue,
            };
            let harmless = |name: &str| TRAPS.contains(&name) || STEPS.contains(&name);
            let Some((target, name)) = functions
                .iter()
                .find(|(range, name)| range.start == value & !1 && !harmless(name))
            else {
                continue;
            };
            let taker = functions.iter().find(|(range, _)| range.contains(&place));
            let Some((taker, _)) = taker else {
                return Err(format!("{section_name} holds a pointer to {name}"));
            };
            taken.entry(taker.start).or_default().push(target.start);
        }
    }
    Ok(taken)
}

fn word<'d>(section: &impl ObjectSection<'d>, address: u64) -> u64 {
    let data = section.data_range(address, 4).ok().flatten();
    let bytes = data.and_then(|data| data.try_into().ok());
    bytes.map_or(0, |bytes| u32::from_le_bytes(bytes).into())
}

/// The bytes of the code, and which of them are data: `$t`, `$x` and `$d` symbols say so.
struct Code<'d> {
    sections: Vec<(u64, &'d [u8])>,
    data_from: BTreeMap<u64, bool>,
}

/// The result of decoding a function.
#[derive(Default)]
struct Decoded {
    /// Bytes by which the stack pointer falls; `None` if that is unknown.
    frame: Option<u64>,
    targets: Vec<u64>,
    /// True if it calls an address in a register.
    calls_register: bool,
    /// A register and an upper part that was put into it (RV32).
    upper: Option<(u32, u32)>,
}

type Decoder = fn(address: u32, first: u16, second: u16, decoded: &mut Decoded) -> u64;

impl<'d> Code<'d> {
    fn of(file: &File<'d>) -> Self {
        let code = file.sections().filter(|s| s.kind() == SectionKind::Text);
        let marks = file.symbols().filter_map(|symbol| {
            let name = symbol.name().ok()?;
            name.starts_with('$')
                .then(|| (symbol.address() & !1, name.starts_with("$d")))
        });
        Self {
            sections: code
                .filter_map(|s| Some((s.address(), s.data().ok()?)))
                .collect(),
            data_from: marks.collect(),
        }
    }

    fn half(&self, address: u64) -> Option<u16> {
        self.sections.iter().find_map(|&(start, data)| {
            let offset = usize::try_from(address.checked_sub(start)?).ok()?;
            let bytes = data.get(offset..offset + 2)?;
            Some(u16::from_le_bytes([bytes[0], bytes[1]]))
        })
    }

    fn decode(&self, range: Range<u64>, decoder: Decoder, decoded: &mut Decoded) {
        decoded.frame = Some(0);
        let mut address = range.start;
        while address < range.end {
            let mark = self.data_from.range(..=address).next_back();
            if mark.is_some_and(|(_, &data)| data) {
                address += 2;
                continue;
            }
            let (first, second) = (self.half(address), self.half(address + 2));
            let (first, second) = (first.unwrap_or(0), second.unwrap_or(0));
            address += decoder(address as u32, first, second, decoded);
        }
    }
}

impl Decoded {
    fn takes(&mut self, bytes: u32) {
        self.frame = self.frame.map(|frame| frame + u64::from(bytes));
    }

    fn reaches(&mut self, address: u32) {
        self.targets.push(address.into());
    }
}

/// A number of `bits` bits with a sign.
fn signed(value: u32, bits: u32) -> u32 {
    ((value << (32 - bits)) as i32 >> (32 - bits)) as u32
}

/// Decodes an instruction (Arm Architecture Reference Manual, A7.7) and returns its length.
fn thumb(address: u32, first: u16, second: u16, decoded: &mut Decoded) -> u64 {
    let (first, second) = (u32::from(first), u32::from(second));
    let from = address.wrapping_add(4);
    if first >> 11 < 0b11101 {
        match first {
            // PUSH; SUB SP, #n; ADD SP, Rm.
            _ if first >> 9 == 0b1011010 => decoded.takes(4 * (first & 0x1ff).count_ones()),
            _ if first >> 7 == 0b101100001 => decoded.takes(4 * (first & 0x7f)),
            _ if first & 0xff87 == 0x4485 => decoded.frame = None,
            // BLX Rm.
            _ if first & 0xff87 == 0x4780 => decoded.calls_register = true,
            // B, with and without a condition.
            _ if first >> 11 == 0b11100 => {
                decoded.reaches(from.wrapping_add(signed((first & 0x7ff) << 1, 12)));
            }
            _ if first >> 12 == 0b1101 && first >> 9 != 0b1101111 => {
                decoded.reaches(from.wrapping_add(signed((first & 0xff) << 1, 9)));
            }
            _ => (),
        }
        return 2;
    }
    let sign = first >> 10 & 1;
    let bit = |k: u32| second >> k & 1;
    match first {
        // PUSH of many, of one.
        0xe92d => decoded.takes(4 * second.count_ones()),
        0xf84d if second & 0xfff == 0xd04 => decoded.takes(4),
        // VPUSH.
        _ if first & 0xffbf == 0xed2d => decoded.takes(4 * (second & 0xff)),
        // SUB SP, SP, with a constant of 12 bits, or a shifted one.
        _ if first & 0xfbff == 0xf2ad && second & 0x8f00 == 0x0d00 => {
            decoded.takes(sign << 11 | (second >> 12 & 7) << 8 | second & 0xff);
        }
        _ if first & 0xfbef == 0xf1ad && second & 0x8f00 == 0x0d00 => {
            let (pattern, low) = (
                sign << 4 | (second >> 12 & 7) << 1 | second >> 7 & 1,
                second & 0xff,
            );
            match pattern {
                0 | 1 => decoded.takes(low),
                2..8 => decoded.frame = None,
                _ => decoded.takes((low | 0x80).rotate_right(pattern)),
            }
        }
        // BL and B.
        _ if first >> 11 == 0b11110 && second & 0x9000 == 0x9000 => {
            let flip = |k: u32| (bit(k) ^ sign) ^ 1;
            let offset = sign << 24 | flip(13) << 23 | flip(11) << 22 | (first & 0x3ff) << 12;
            decoded.reaches(from.wrapping_add(signed(offset | (second & 0x7ff) << 1, 25)));
        }
        // B with a condition.
        _ if first >> 11 == 0b11110 && second & 0xd000 == 0x8000 && first >> 7 & 7 != 7 => {
            let offset = sign << 20 | bit(11) << 19 | bit(13) << 18 | (first & 0x3f) << 12;
            decoded.reaches(from.wrapping_add(signed(offset | (second & 0x7ff) << 1, 21)));
        }
        _ => (),
    }
    4
}

/// Decodes an instruction (RISC-V ISA Manual, RV32I and C) and returns its length.
fn riscv(address: u32, first: u16, second: u16, decoded: &mut Decoded) -> u64 {
    const SP: u32 = 2;
    let upper = decoded.upper.take();
    let half = u32::from(first);
    if half & 3 != 3 {
        let bit = |from: u32, to: u32| (half >> from & 1) << to;
        match (half >> 13, half & 3) {
            // C.J and C.JAL.
            (0b101 | 0b001, 1) => {
                let offset = bit(12, 11) | bit(11, 4) | (half >> 9 & 3) << 8 | bit(8, 10);
                let offset = offset | bit(7, 6) | bit(6, 7) | (half >> 3 & 7) << 1 | bit(2, 5);
                decoded.reaches(address.wrapping_add(signed(offset, 12)));
            }
            // C.JALR.
            (0b100, 2) if half & 0x107c == 0x1000 => decoded.calls_register |= half >> 7 & 31 != 0,
            // C.ADDI and C.ADDI16SP on the stack pointer.
            (0b000, 1) if half >> 7 & 31 == SP => {
                let add = signed(bit(12, 5) | half >> 2 & 31, 6) as i32;
                decoded.takes(if add < 0 { add.unsigned_abs() } else { 0 });
            }
            (0b011, 1) if half >> 7 & 31 == SP => {
                let add = bit(12, 9) | bit(6, 4) | bit(5, 6) | (half >> 3 & 3) << 7 | bit(2, 5);
                let add = signed(add, 10) as i32;
                decoded.takes(if add < 0 { add.unsigned_abs() } else { 0 });
            }
            _ => (),
        }
        return 2;
    }
    let word = half | u32::from(second) << 16;
    let (to, from) = (word >> 7 & 31, word >> 15 & 31);
    let immediate = signed(word >> 20, 12);
    match word & 0x7f {
        // JAL.
        0x6f => {
            let offset = (word >> 31) << 20 | (word >> 12 & 0xff) << 12 | (word >> 20 & 1) << 11;
            let offset = signed(offset | (word >> 21 & 0x3ff) << 1, 21);
            decoded.reaches(address.wrapping_add(offset));
        }
        // AUIPC, then JALR.
        0x17 => decoded.upper = Some((to, address.wrapping_add(word & 0xffff_f000))),
        0x67 => {
            match upper.filter(|&(register, _)| register == from) {
                Some((_, upper)) => decoded.reaches(upper.wrapping_add(immediate)),
                // Without a place to return to it is a return, or the start-up code's next step.
                None => decoded.calls_register |= to != 0,
            }
        }
        // ADDI SP, SP, n.
        0x13 if to == SP && from == SP && word >> 12 & 7 == 0 => {
            let add = immediate as i32;
            decoded.takes(if add < 0 { add.unsigned_abs() } else { 0 });
        }
        // The stack pointer moved by a register: a frame that is not a constant here.
        0x33 if to == SP => decoded.frame = None,
        _ => (),
    }
    4
}
