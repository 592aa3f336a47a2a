//! A forger of blobs, which knows header, sections and records.
//!
//! Bits flipped at random are nearly always rejected. A useful forgery changes one field to a
//! meaningful value, or changes fields that belong together. It also changes the header to match.

use super::parts::{Base, Parts, Section};
use crate::random::Random;
use gridel_core::format::record::Header;
use gridel_core::format::{BlobError, Field, Location, SectionKind};
use gridel_core::{Scene, Structure};
use gridel_host::blob::Blob;
use std::mem::offset_of;

impl Parts {
    fn change(&mut self, random: &mut Random) {
        match random.below(100) {
            0..58 => self.change_field(random),
            58..66 => self.copy_field(random),
            66..71 => self.swap_records(random),
            71..75 => self.add_or_remove_record(random),
            75..91 => self.change_header(random),
            91..93 => self.remove_section(random),
            93..96 => self.loosen(),
            _ => self.narrow_widen(random),
        }
    }

    /// A section, those of structures more often than the others.
    fn section(&mut self, random: &mut Random) -> Option<&mut Section> {
        let shapes = SectionKind::Vertices as u16;
        for _ in 0..3 {
            let number = random.below(self.sections.len().max(1));
            let section = self.sections.get(number)?;
            if !section.bytes.is_empty() && (section.kind >= shapes || random.one_in(6)) {
                return self.sections.get_mut(number);
            }
        }
        self.sections.last_mut().filter(|it| !it.bytes.is_empty())
    }

    /// The place of a field in a record of a section.
    fn field(section: &Section, random: &mut Random) -> (usize, usize, usize) {
        let stride = section.stride();
        let record = random.below(section.records().max(1));
        let width = [1, 2, 2, 4, 4, 8][random.below(6)].min(stride);
        // Records of three-byte integers have fields of odd sizes.
        let width = if stride.is_multiple_of(width) {
            width
        } else {
            1
        };
        let offset = random.below(stride / width) * width;
        (record, offset, width)
    }

    fn change_field(&mut self, random: &mut Random) {
        let Some(section) = self.section(random) else {
            return;
        };
        let (record, offset, width) = Self::field(section, random);
        let start = record * section.stride() + offset;
        if let Some(field) = section.bytes.get_mut(start..start + width) {
            change_integer(field, random);
        }
    }

    /// Copies a field from another record.
    fn copy_field(&mut self, random: &mut Random) {
        let Some(section) = self.section(random) else {
            return;
        };
        let (record, offset, width) = Self::field(section, random);
        let stride = section.stride();
        let from = random.below(section.records().max(1)) * stride + offset;
        let to = record * stride + offset;
        if from + width <= section.bytes.len() && to + width <= section.bytes.len() {
            section.bytes.copy_within(from..from + width, to);
        }
    }

    fn swap_records(&mut self, random: &mut Random) {
        let Some(section) = self.section(random) else {
            return;
        };
        let (stride, records) = (section.stride(), section.records());
        let (a, b) = (random.below(records.max(1)), random.below(records.max(1)));
        let copies = random.one_in(3);
        for byte in 0..stride {
            let (from, to) = (a * stride + byte, b * stride + byte);
            if copies {
                section.bytes[to] = section.bytes[from];
            } else {
                section.bytes.swap(from, to);
            }
        }
    }

    fn add_or_remove_record(&mut self, random: &mut Random) {
        let Some(section) = self.section(random) else {
            return;
        };
        let (stride, records) = (section.stride(), section.records());
        let start = random.below(records.max(1)) * stride;
        if random.one_in(2) {
            section.bytes.drain(start..start + stride);
        } else {
            let record = section.bytes[start..start + stride].to_vec();
            let at = [start, section.bytes.len()][random.below(2)];
            section.bytes.splice(at..at, record);
        }
    }

    fn remove_section(&mut self, random: &mut Random) {
        if !self.sections.is_empty() {
            self.sections.remove(random.below(self.sections.len()));
        }
    }

    /// Stores an array of integers in a byte more or less each.
    fn narrow_widen(&mut self, random: &mut Random) {
        let Some(section) = self.section(random) else {
            return;
        };
        let stride = section.stride();
        let wanted = 1 + random.below(4);
        if stride <= 4 && wanted != stride {
            let records = section.bytes.chunks_exact(stride);
            let resized = records.flat_map(|record| {
                let mut word = [0; 4];
                word[..stride].copy_from_slice(record);
                word.into_iter().take(wanted)
            });
            section.bytes = resized.collect();
            section.stride = wanted as u16;
        }
    }

    fn change_header(&mut self, random: &mut Random) {
        let header = &mut self.header;
        match random.below(12) {
            0..3 => {
                let all = Structure::ALL[random.below(Structure::ALL.len())];
                header.structures ^= all.bit();
            }
            3 => header.effects ^= 1 << random.below(7),
            4 => {
                let depth = header
                    .stack_depth
                    .wrapping_add([1, u16::MAX, 160][random.below(3)]);
                header.stack_depth = depth;
                header.stack_bytes = 12 * u32::from(depth);
            }
            5 => header.longest_leaf = random.below(34) as u16,
            6 => {
                let bits = [9, 10, 15, 16, 17, 20, 24, 25][random.below(8)];
                header.lattice_bits = bits;
                if random.one_in(2) {
                    header.storage_bits = if bits <= 16 { 16 } else { 24 };
                }
            }
            7..10 => {
                let side = &mut header.bounds.0[random.below(3)][random.below(2)];
                let mut bytes = side.to_le_bytes();
                change_integer(&mut bytes, random);
                *side = i16::from_le_bytes(bytes);
            }
            _ => {
                // Any other word of it but what says that it is a blob.
                let words = bytemuck::bytes_of_mut(header);
                let start = offset_of!(Header, structures) & !3;
                let place = start + 4 * random.below((words.len() - start) / 4);
                change_integer(&mut words[place..place + 4], random);
            }
        }
    }
}

/// Changes a little-endian integer to one that may mean something.
fn change_integer(field: &mut [u8], random: &mut Random) {
    let bits = 8 * field.len() as u32;
    let mut bytes = [0; 8];
    bytes[..field.len()].copy_from_slice(field);
    let old = u64::from_le_bytes(bytes);
    let top = 1_u64 << (bits - 1);
    let new = match random.below(16) {
        0 => 0,
        1 => 1,
        2 => u64::MAX,
        3 => top,
        4 => top - 1,
        5 => top + 1,
        6 => 0_u64.wrapping_sub(old),
        7 => old.wrapping_add(1),
        8 => old.wrapping_sub(1),
        9 => old.wrapping_add(random.below(64) as u64).wrapping_sub(32),
        10 => old.wrapping_mul(2),
        11 => old >> 1,
        12 => old ^ top,
        13 => old.rotate_left(16) ^ old >> bits.saturating_sub(16),
        14 => random.bits(),
        _ => old ^ 1 << random.below(bits as usize),
    };
    field.copy_from_slice(&new.to_le_bytes()[..field.len()]);
}

/// Makes forgeries of some blobs, and counts the outcomes.
#[derive(Clone, Debug)]
pub struct Forger {
    bases: Vec<Base>,
    random: Random,
    /// Forgeries made.
    pub made: u64,
    /// Number of blobs that loaded.
    pub loaded: u64,
}

impl Forger {
    /// Returns a forger of some blobs; the forgeries of a seed are always the same.
    pub fn new(bases: Vec<Base>, seed: u64) -> Self {
        Self {
            bases,
            random: Random(seed),
            made: 0,
            loaded: 0,
        }
    }

    /// Makes a forgery, and passes it on if it loads. The header's limits are corrected if they
    /// alone were wrong.
    pub fn forge(&mut self, use_scene: impl FnOnce(&Scene<'_>, &Blob)) {
        let random = &mut self.random;
        let mut parts = self.bases[random.below(self.bases.len())].parts.clone();
        for _ in 0..=[0, 0, 0, 1, 1, 2, 4][random.below(7)] {
            parts.change(random);
        }
        self.made += 1;
        for _ in 0..3 {
            let blob = parts.put_together();
            match blob.scene() {
                Ok(scene) => {
                    self.loaded += 1;
                    use_scene(&scene, &blob);
                    return;
                }
                Err(BlobError::OutOfRange {
                    location: Location::Header,
                    field: Field::StackDepth,
                    range: [expected, _],
                    ..
                }) => {
                    parts.header.stack_depth = expected as u16;
                    parts.header.stack_bytes = 12 * expected as u32;
                }
                Err(BlobError::OutOfRange {
                    location: Location::Header,
                    field: Field::LongestLeaf,
                    range: [expected, _],
                    ..
                }) => {
                    parts.header.longest_leaf = expected as u16;
                }
                Err(_) => return,
            }
        }
    }
}
