//! A blob taken apart into header and sections, and put together again.

use super::sealed;
use gridel_core::format::record::{
    DualNode, FlaggedPair, Header, Pair, SectionEntry, SpherePair, UnitBox, WideNode, plane_word,
};
use gridel_core::format::{Child, SectionKind};
use gridel_host::blob::Blob;

/// A blob taken apart.
#[derive(Clone, Debug)]
pub(super) struct Parts {
    pub(super) header: Header,
    pub(super) sections: Vec<Section>,
}

#[derive(Clone, Debug)]
pub(super) struct Section {
    pub(super) kind: u16,
    pub(super) stride: u16,
    pub(super) bytes: Vec<u8>,
}

impl Section {
    pub(super) fn stride(&self) -> usize {
        self.stride.max(1).into()
    }

    pub(super) fn records(&self) -> usize {
        self.bytes.len() / self.stride()
    }

    /// Rewrites all words of every record but the last two, by number.
    fn planes(&mut self, word: impl Fn(usize) -> u32) {
        let stride = self.stride();
        for record in self.bytes.chunks_exact_mut(stride) {
            let planes = (stride / 4).saturating_sub(2);
            for (number, plane) in record.chunks_exact_mut(4).take(planes).enumerate() {
                plane.copy_from_slice(&word(number).to_le_bytes());
            }
        }
    }

    /// Rewrites every record.
    fn each<T: bytemuck::Pod>(&mut self, rewrite: impl Fn(&mut T)) {
        for bytes in self.bytes.chunks_exact_mut(size_of::<T>()) {
            let mut record = bytemuck::pod_read_unaligned(bytes);
            rewrite(&mut record);
            bytes.copy_from_slice(bytemuck::bytes_of(&record));
        }
    }
}

impl Parts {
    fn of(blob: &[u8]) -> Self {
        let header: Header = bytemuck::pod_read_unaligned(&blob[..size_of::<Header>()]);
        let section = |number: usize| {
            let entry = &blob[size_of::<Header>() + number * size_of::<SectionEntry>()..];
            let entry: SectionEntry =
                bytemuck::pod_read_unaligned(&entry[..size_of::<SectionEntry>()]);
            let length = entry.count as usize * usize::from(entry.stride);
            Section {
                kind: entry.kind,
                stride: entry.stride,
                bytes: blob[entry.offset as usize..][..length].to_vec(),
            }
        };
        Self {
            header,
            sections: (0..header.section_count.into()).map(section).collect(),
        }
    }

    pub(super) fn put_together(&self) -> Blob {
        let mut header = self.header;
        header.section_count = self.sections.len() as u16;
        let mut bytes = bytemuck::bytes_of(&header).to_vec();
        let table = size_of::<SectionEntry>() * self.sections.len();
        let mut offset = bytes.len() + table;
        for section in &self.sections {
            offset = offset.next_multiple_of(16);
            bytes.extend_from_slice(bytemuck::bytes_of(&SectionEntry {
                kind: section.kind,
                stride: section.stride,
                count: section.records() as u32,
                offset: offset as u32,
                spare: 0,
            }));
            offset += section.bytes.len();
        }
        for section in &self.sections {
            bytes.resize(bytes.len().next_multiple_of(16), 0);
            bytes.extend_from_slice(&section.bytes);
        }
        sealed(&bytes)
    }

    /// Makes boxes, planes and spheres of hierarchies as large as possible. Then any changed primitive stays inside of
    /// its bounds.
    pub(super) fn loosen(&mut self) {
        const LOW: i16 = -i16::MAX;
        const HIGH: i16 = i16::MAX;
        self.header.bounds = UnitBox([[LOW, HIGH]; 3]);
        for section in &mut self.sections {
            match section.kind {
                kind if kind == SectionKind::Pairs as u16 => {
                    section.each(|pair: &mut Pair| pair.planes = [[[LOW; 2], [HIGH; 2]]; 3]);
                }
                kind if kind == SectionKind::FlaggedPairs as u16 => {
                    let planes = plane_word([LOW, HIGH]);
                    section.each(|pair: &mut FlaggedPair| pair.planes = [planes; 3]);
                }
                kind if kind == SectionKind::DualNodes as u16 => {
                    section.each(|node: &mut DualNode| {
                        let planes = plane_word([LOW, HIGH]);
                        for word in node.carves.iter_mut().chain([&mut node.split]) {
                            *word = if *word == 0 { 0 } else { planes };
                        }
                    })
                }
                kind if kind == SectionKind::WideNodes as u16 => {
                    section.each(|node: &mut WideNode| {
                        let children = node.children.into_iter().enumerate();
                        for (lane, _) in children.filter(|&(_, child)| child != Child::NONE.0) {
                            for [low, high] in &mut node.planes {
                                (low[lane], high[lane]) = (LOW, HIGH);
                            }
                        }
                    })
                }
                kind if kind == SectionKind::SpherePairs as u16 => {
                    section.each(|pair: &mut SpherePair| {
                        for sphere in &mut pair.spheres {
                            (sphere.center, sphere.radius) = ([0; 3], u16::MAX);
                        }
                    })
                }
                kind if kind == SectionKind::SlabRoot as u16
                    || kind == SectionKind::FlaggedSlabRoot as u16 =>
                {
                    section.each(|word: &mut u32| *word = plane_word([i16::MIN, i16::MAX]));
                }
                kind if kind == SectionKind::SlabPairs as u16 => {
                    section.planes(|plane| match plane % 2 {
                        0 => plane_word([i16::MIN; 2]),
                        _ => plane_word([i16::MAX; 2]),
                    });
                }
                kind if kind == SectionKind::FlaggedSlabPairs as u16 => {
                    section.planes(|_| plane_word([i16::MIN, i16::MAX]));
                }
                _ => {}
            }
        }
    }
}

/// A valid blob that forgeries are made of.
#[derive(Clone, Debug)]
pub struct Base {
    pub(super) parts: Parts,
}

impl Base {
    /// Takes a valid blob apart.
    pub fn of(blob: &[u8]) -> Self {
        let parts = Parts::of(blob);
        Self { parts }
    }

    /// With boxes, planes and bounding spheres as large as can be; `None` where the structure depends
    /// on the scene's box.
    pub fn loose(blob: &[u8]) -> Option<Self> {
        let mut parts = Parts::of(blob);
        parts.loosen();
        parts
            .put_together()
            .scene()
            .is_ok()
            .then_some(Self { parts })
    }

    /// The header, to be forged by hand.
    pub fn header(&mut self) -> &mut Header {
        &mut self.parts.header
    }

    /// Removes sections.
    pub fn remove(&mut self, kinds: &[SectionKind]) {
        let stays = |section: &Section| kinds.iter().all(|&kind| kind as u16 != section.kind);
        self.parts.sections.retain(stays);
    }

    /// The bytes of a section, to be forged by hand; none of one that is not there.
    pub fn section(&mut self, kind: SectionKind) -> &mut [u8] {
        let mut sections = self.parts.sections.iter_mut();
        let section = sections.find(|it| it.kind == kind as u16);
        section.map_or(&mut [], |it| &mut it.bytes)
    }

    /// All bytes of a section, to be replaced or added to.
    ///
    /// # Panics
    /// If it is not there.
    pub fn bytes(&mut self, kind: SectionKind) -> &mut Vec<u8> {
        let mut sections = self.parts.sections.iter_mut();
        let section = sections.find(|it| it.kind == kind as u16);
        &mut section.expect("the section").bytes
    }

    /// Number of records of a section.
    pub fn records(&self, kind: SectionKind) -> usize {
        let mut sections = self.parts.sections.iter();
        let section = sections.find(|it| it.kind == kind as u16);
        section.map_or(0, Section::records)
    }

    /// A record of a section.
    pub fn record<T: bytemuck::Pod>(&mut self, kind: SectionKind, index: usize) -> T {
        let start = index * size_of::<T>();
        bytemuck::pod_read_unaligned(&self.bytes(kind)[start..start + size_of::<T>()])
    }

    /// Changes a record of a section.
    pub fn change<T: bytemuck::Pod>(
        &mut self,
        kind: SectionKind,
        index: usize,
        change: impl FnOnce(&mut T),
    ) {
        let mut record = self.record(kind, index);
        change(&mut record);
        let start = index * size_of::<T>();
        self.bytes(kind)[start..start + size_of::<T>()]
            .copy_from_slice(bytemuck::bytes_of(&record));
    }

    /// Changes a record that is an integer of one to four bytes.
    pub fn set(&mut self, kind: SectionKind, index: usize, value: u32) {
        let stride = self.bytes(kind).len() / self.records(kind);
        let start = index * stride;
        self.bytes(kind)[start..start + stride].copy_from_slice(&value.to_le_bytes()[..stride]);
    }

    /// Removes the first records of a section.
    pub fn drop_first(&mut self, kind: SectionKind, records: usize) {
        let mut sections = self.parts.sections.iter_mut();
        if let Some(section) = sections.find(|it| it.kind == kind as u16) {
            let bytes = records * section.stride();
            section.bytes.drain(..bytes);
        }
    }

    /// Returns the sealed blob.
    pub fn sealed(&self) -> Blob {
        self.parts.put_together()
    }
}
