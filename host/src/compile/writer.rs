//! Writes the sections of a blob, each in the narrowest form that its values allow.

use super::CompileError;
use super::geometry::primitives::Primitives;
use super::geometry::records::in_order;
use super::geometry::vertices::Corner;
use super::hierarchy::pairs::Flat;
use super::instances::Role;
use super::motion::morph;
use super::names::{KeptNames, Names};
use super::section::{Section, indices, section};
use super::structures::context::BuildContext;
use super::structures::layout::Layout;
use crate::blob::{Blob, Buffer};
use crate::shape::Lattice;
use bytemuck::Zeroable;
use gridel_core::accel::Entry;
use gridel_core::format::record::{
    ENDIANNESS, Header, MAGIC, SECTION_ALIGNMENT, SectionEntry, VERSION, Vertex16, Vertex24,
};
use gridel_core::format::{SectionKind, checksum};
use gridel_core::{Kind, Structure};

fn counts_up(values: &[u32]) -> bool {
    values
        .iter()
        .enumerate()
        .all(|(index, &value)| index as u32 == value)
}

/// All that goes into a blob, before it has places.
pub struct BlobContents {
    header: Header,
    sections: Vec<Section>,
}

impl BlobContents {
    /// Adds names, unless that makes the blob larger than `max_bytes`. Returns the kept names; `None` where nothing has
    /// a name.
    pub fn add_names(&mut self, names: &Names, max_bytes: Option<u64>) -> Option<KeptNames> {
        let lights = self.records(SectionKind::Lights);
        let (sections, mut kept) = names.sections(lights);
        if sections.is_empty() {
            return None;
        }
        let before = self.bytes();
        self.sections.extend(sections);
        self.sections.sort_by_key(|section| section.kind);
        kept.bytes = self.bytes() - before;
        if max_bytes.is_some_and(|most| self.bytes() as u64 > most) {
            let names = [SectionKind::NameStarts, SectionKind::NameText];
            self.sections
                .retain(|section| !names.contains(&section.kind));
            return Some(KeptNames {
                left_out: true,
                ..KeptNames::default()
            });
        }
        self.header.section_count = self.sections.len() as u16;
        Some(kept)
    }

    /// Number of records of a section.
    fn records(&self, kind: SectionKind) -> usize {
        let section = self.sections.iter().find(|section| section.kind == kind);
        section.map_or(0, |section| section.bytes.len() / section.stride)
    }

    /// Length of the blob.
    fn bytes(&self) -> usize {
        let table = size_of::<Header>() + self.sections.len() * size_of::<SectionEntry>();
        let sections = self.sections.iter();
        sections.fold(table, |end, section| {
            end.next_multiple_of(SECTION_ALIGNMENT) + section.bytes.len()
        })
    }
}

/// Makes the contents of a blob.
pub fn contents(context: &BuildContext<'_>, layouts: Vec<Layout>) -> BlobContents {
    let BuildContext {
        primitives, flat, ..
    } = *context;
    let uses_leaves = layouts.iter().any(|layout| layout.uses_leaves);
    let numbering = Numbering::of(context);
    let mut sections = context.shading.sections(numbering.objects);
    sections.extend(numbering.sections(context));
    sections.extend(geometry(context.lattice, primitives, flat));
    if uses_leaves {
        sections.push(section(SectionKind::Leaves, &flat.leaves));
    }
    let depths = layouts.iter().map(|layout| layout.stack_depth);
    let mut stack_depth = depths.max().unwrap_or(0) as u16;
    if let Role::Whole(parts) = context.role {
        sections.push(morph::weights(context.scene));
        if parts.primitives() > 0 {
            sections.extend(parts.sections(primitives.total));
            sections.extend(context.placed.sections());
            stack_depth = stack_depth.max(parts.stack_depth());
        }
    }
    let structures = layouts.iter().map(|layout| layout.structure);
    let structures = structures.chain([Structure::List]);
    let structures = structures.fold(0, |bits, structure| bits | structure.bit());
    sections.extend(layouts.into_iter().flat_map(|layout| layout.sections));
    sections.retain(|section| !section.bytes.is_empty());
    sections.sort_by_key(|section| section.kind);
    let header = Header {
        section_count: sections.len() as u16,
        structures,
        stack_depth,
        stack_bytes: u32::from(stack_depth) * size_of::<Entry>() as u32,
        longest_leaf: if uses_leaves {
            flat.longest_leaf as u16
        } else {
            0
        },
        ..header(context, &numbering)
    };
    BlobContents { header, sections }
}

/// Returns the fields of a header that do not depend on structures; the others are 0.
fn header(context: &BuildContext<'_>, numbering: &Numbering) -> Header {
    let BuildContext {
        lattice, shading, ..
    } = *context;
    Header {
        magic: MAGIC,
        endianness: ENDIANNESS,
        version: VERSION,
        effects: shading.requirements.effects().0,
        primitives: numbering.primitives,
        objects: numbering.objects,
        lattice_bits: lattice.bits,
        storage_bits: if lattice.bits <= 16 { 16 } else { 24 },
        unit_exponent: lattice.unit_exponent,
        origin: lattice.origin.to_array(),
        bounds: context.bounds,
        coordinate_shift: shading.coordinates.header.coordinate_shift,
        counted_from: shading.coordinates.header.counted_from,
        ..Header::zeroed()
    }
}

/// The numbers of a blob's primitives and objects, with those of its parts.
struct Numbering {
    primitives: u32,
    objects: u32,
    /// For each object, its first primitive.
    object_first: Vec<u32>,
}

impl Numbering {
    fn of(context: &BuildContext<'_>) -> Self {
        let own = context.primitives.total;
        let mut numbering = Self {
            primitives: own,
            objects: context.scene.all_objects().count() as u32,
            object_first: context.primitives.object_first.clone(),
        };
        match context.role {
            // The scene that places a part knows its objects.
            Role::Part { .. } if numbering.objects != own => {
                numbering.objects = numbering.objects.min(1);
                numbering.object_first.clear();
            }
            Role::Part { .. } => (),
            Role::Whole(parts) => {
                numbering.primitives = own.saturating_add(parts.primitives());
                let of_parts = parts.object_first.iter();
                let of_parts = of_parts.map(|first| own.saturating_add(*first));
                numbering.object_first.extend(of_parts);
            }
        }
        numbering
    }

    /// Returns the numbers that slots and objects do not have by their order.
    fn sections(&self, context: &BuildContext<'_>) -> Vec<Section> {
        let mut sections = Vec::new();
        if self.objects != self.primitives && self.objects > 1 {
            sections.push(indices(SectionKind::ObjectFirst, &self.object_first, 2));
        }
        let primitives = context.primitives;
        let kinds = Kind::ALL.iter().map(|&kind| kind as usize);
        let order: Vec<u32> = kinds
            .flat_map(|kind| {
                let (slots, numbers) = (&context.flat.slots[kind], &primitives.numbers[kind]);
                slots.iter().map(|&index| numbers[index as usize])
            })
            .collect();
        if !counts_up(&order) || order.len() as u32 != primitives.total {
            sections.push(indices(SectionKind::Order, &order, 2));
        }
        sections
    }
}

/// The geometry, every kind in the order of its slots.
fn geometry(lattice: &Lattice, primitives: &Primitives, flat: &Flat) -> Vec<Section> {
    let slots = &flat.slots[Kind::Triangle as usize];
    let triangles = in_order(&primitives.triangles, slots);
    // Vertices in the order in which the leaves need them, those that carry the most first.
    let mut number = vec![u32::MAX; primitives.vertices.len()];
    let mut vertices = Vec::with_capacity(primitives.vertices.len());
    let mut corners = Vec::new();
    let corner = |vertex: u32| primitives.corners.get(vertex as usize).copied();
    let mut has_rank = [false; Corner::RANKS];
    for corner in &primitives.corners {
        has_rank[corner.rank()] = true;
    }
    for rank in (0..Corner::RANKS - 1).filter(|&rank| has_rank[rank]) {
        for &vertex in triangles.iter().flatten() {
            let found = corner(vertex).filter(|it| it.rank() == rank);
            if let Some(corner) = found.filter(|_| number[vertex as usize] == u32::MAX) {
                number[vertex as usize] = vertices.len() as u32;
                vertices.push(primitives.vertices[vertex as usize]);
                corners.push(corner);
            }
        }
    }
    let triangles: Vec<[u32; 3]> = triangles
        .iter()
        .map(|corners| {
            corners.map(|vertex| {
                let number = &mut number[vertex as usize];
                if *number == u32::MAX {
                    *number = vertices.len() as u32;
                    vertices.push(primitives.vertices[vertex as usize]);
                }
                *number
            })
        })
        .collect();
    let vertex_section = if lattice.bits <= 16 {
        let unit = |x: i32| (x >> 8) as i16;
        let vertices: Vec<_> = vertices.iter().map(|v| Vertex16(v.map(unit))).collect();
        section(SectionKind::Vertices, &vertices)
    } else {
        let vertices: Vec<_> = vertices.iter().map(|&v| Vertex24(v)).collect();
        section(SectionKind::Vertices, &vertices)
    };
    let triangle_section = if vertices.len() <= usize::from(u16::MAX) + 1 {
        let narrow: Vec<_> = triangles
            .iter()
            .map(|t| t.map(|vertex| vertex as u16))
            .collect();
        section(SectionKind::Triangles, &narrow)
    } else {
        section(SectionKind::Triangles, &triangles)
    };
    let mut motions = vec![0; vertices.len()];
    for (&number, corner) in number.iter().zip(&primitives.corners) {
        if number != u32::MAX {
            motions[number as usize] = corner.motion;
        }
    }
    let mut sections = vec![vertex_section, triangle_section];
    sections.extend(primitives.motions.sections(&motions));
    sections.extend(carried(&corners));
    sections.extend(primitives.records.sections(lattice.bits, &flat.slots));
    sections
}

/// Returns the attributes of vertices other than positions. Nothing is stored after the last vertex that has some.
fn carried(corners: &[Corner]) -> Vec<Section> {
    let until = |has: fn(&Corner) -> bool| {
        let count = corners.iter().rposition(has).map_or(0, |last| last + 1);
        &corners[..count]
    };
    let normals = until(|it| it.normal.is_some());
    let normals: Vec<_> = normals.iter().filter_map(|it| it.normal).collect();
    let colors = until(|it| it.color.is_some()).iter();
    let colors: Vec<_> = colors.map(|it| it.color.unwrap_or([255; 4])).collect();
    let coordinates = until(|it| it.coordinates.is_some()).iter();
    let coordinates: Vec<_> = coordinates
        .map(|it| it.coordinates.unwrap_or([i32::MIN; 2]))
        .collect();
    // With 14 fraction bits; the lowest number means no coordinates.
    let short = |it: i32| {
        let rounded = i16::try_from((i64::from(it) + (1 << 5)) >> 6).ok();
        rounded.filter(|it| *it != i16::MIN)
    };
    let narrow = coordinates.iter().map(|&[u, v]| match u {
        i32::MIN => Some([i16::MIN; 2]),
        _ => Some([short(u)?, short(v)?]),
    });
    let coordinates = match narrow.collect::<Option<Vec<_>>>() {
        Some(narrow) => section(SectionKind::TextureCoordinates, &narrow),
        None => section(SectionKind::TextureCoordinates, &coordinates),
    };
    vec![
        section(SectionKind::Normals, &normals),
        section(SectionKind::VertexColors, &colors),
        coordinates,
    ]
}

/// Puts header, table and sections together. Large sections are in memory twice meanwhile.
pub fn write(contents: BlobContents) -> Result<Blob, CompileError> {
    let BlobContents {
        mut header,
        sections,
    } = contents;
    let mut offset = size_of::<Header>() + sections.len() * size_of::<SectionEntry>();
    let mut entries = Vec::with_capacity(sections.len());
    for section in &sections {
        offset = offset.next_multiple_of(SECTION_ALIGNMENT);
        let mut forms = section.kind.layout().records.iter();
        debug_assert!(
            forms.any(|form| form.bytes == section.stride),
            "{:?}",
            section.kind
        );
        entries.push(SectionEntry {
            kind: section.kind as u16,
            stride: section.stride as u16,
            count: (section.bytes.len() / section.stride) as u32,
            offset: offset as u32,
            spare: 0,
        });
        offset += section.bytes.len();
    }
    let most = u32::MAX as usize;
    if offset > most {
        return Err(CompileError::TooMany {
            what: "bytes",
            count: offset,
            most,
        });
    }
    header.blob_bytes = offset as u32;
    let table = size_of::<Header>()..size_of::<Header>() + size_of_val(&entries[..]);
    let mut buffer = Buffer::zeros(offset);
    let bytes = buffer.bytes_mut();
    bytes[table].copy_from_slice(bytemuck::cast_slice(&entries));
    for (section, entry) in sections.into_iter().zip(&entries) {
        let start = entry.offset as usize;
        bytes[start..start + section.bytes.len()].copy_from_slice(&section.bytes);
    }
    bytes[..size_of::<Header>()].copy_from_slice(bytemuck::bytes_of(&header));
    header.checksum = checksum(bytes);
    bytes[..size_of::<Header>()].copy_from_slice(bytemuck::bytes_of(&header));
    Ok(buffer.into_blob())
}
