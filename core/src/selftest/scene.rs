//! One shape of each kind with known answers, as a blob that is assembled here.

use crate::format::record::{
    ENDIANNESS, Header, Light, MAGIC, Material, SECTION_ALIGNMENT, SectionEntry, Sphere16, UnitBox,
    VERSION, Vertex16, View,
};
use crate::format::{Aligned, SectionKind, checksum};
use crate::geometry::{cone::Cone, cuboid::Cuboid, disc::Disc, torus::Torus};
use crate::{Effects, Structure};
use bytemuck::{NoUninit, Zeroable, bytes_of};
use core::mem::size_of;

/// The effects that the scene requires.
pub(crate) const REQUIRED: Effects = Effects::SHADOW
    .with(Effects::HIGHLIGHT)
    .with(Effects::MIRROR)
    .with(Effects::GLASS)
    .with(Effects::ABSORPTION)
    .with(Effects::CHECKER)
    .with(Effects::SMOOTH);

/// Sections of the blob.
const SECTIONS: usize = 12;
/// Memory for the blob.
const ROOM: usize = 1376;
/// The ratio 1.
const ONE: i32 = 1 << 30;

/// The normals of the triangle's vertices.
const NORMALS: [[i16; 2]; 3] = [[-8_000, -6_000], [8_000, -6_000], [0, 9_000]];

/// A blob with its length.
pub(crate) struct TinyBlob {
    room: Aligned<[u8; ROOM]>,
    length: usize,
    sections: usize,
}

impl TinyBlob {
    /// The size of the pictures.
    pub(super) const SIZE: [u16; 2] = [16, 12];

    /// Six objects, each one primitive: triangle, sphere, box, disc, cone and torus. Lengths in units:
    ///
    /// | object | where |
    /// |---|---|
    /// | 0 triangle | (-60, -20, -10), (-20, -20, -10), (-40, 30, -10), with normals that lean apart |
    /// | 1 sphere | center (30, 30, 0), radius 25 |
    /// | 2 box | (-90, -90, -50) to (90, -70, 50) |
    /// | 3 disc | center (-40, 60, 20), radius 20, facing up |
    /// | 4 cone | base (40, -60, 20) of radius 20, apex (40, -20, 20) |
    /// | 5 torus | center (0, -80, 0), axis upward, radii 30 and 5: within the box, where no picture shows it |
    pub(crate) fn new() -> Self {
        let fine = |units: i32| units << 8;
        let point = |p: [i32; 3]| p.map(fine);
        let vertices = [[-60, -20, -10], [-20, -20, -10], [-40, 30, -10]].map(Vertex16);
        let sphere = Sphere16 {
            center: Vertex16([30, 30, 0]),
            radius: 25,
        };
        let cuboid = Cuboid {
            lowest: point([-90, -90, -50]),
            highest: point([90, -70, 50]),
        };
        let disc = Disc {
            center: point([-40, 60, 20]),
            normal: [0, 4096, 0],
            radius: fine(20),
            bounds: UnitBox([[-60, -20], [60, 60], [0, 40]]),
        };
        let cone = Cone {
            base: point([40, -60, 20]),
            apex: point([40, -20, 20]),
            base_radius: fine(20),
            apex_radius: 0,
            bounds: UnitBox([[20, 60], [-60, -20], [0, 40]]),
        };
        let torus = Torus {
            center: point([0, -80, 0]),
            axis: [0, 1, 0],
            major_radius: fine(30),
            minor_radius: fine(5),
            bounds: UnitBox([[-35, 35], [-85, -75], [-35, 35]]),
        };

        let start = size_of::<Header>() + SECTIONS * size_of::<SectionEntry>();
        let mut blob = Self {
            room: Aligned([0; ROOM]),
            length: start,
            sections: 0,
        };
        blob.section(SectionKind::View, &[view()]);
        blob.section(SectionKind::Lights, &lights());
        blob.section(SectionKind::Materials, &materials());
        blob.section(SectionKind::ObjectMaterial, &[0_u8, 1, 0, 2, 0, 0]);
        blob.section(SectionKind::Vertices, &vertices);
        blob.section(SectionKind::Triangles, &[[0_u16, 1, 2]]);
        blob.section(SectionKind::Spheres, &[sphere]);
        blob.section(SectionKind::Boxes, &[cuboid]);
        blob.section(SectionKind::Discs, &[disc]);
        blob.section(SectionKind::Cones, &[cone]);
        blob.section(SectionKind::Tori, &[torus]);
        blob.section(SectionKind::Normals, &NORMALS);
        blob.seal(Header {
            magic: MAGIC,
            endianness: ENDIANNESS,
            version: VERSION,
            section_count: SECTIONS as u16,
            blob_bytes: blob.length as u32,
            structures: Structure::List.bit(),
            effects: REQUIRED.0,
            primitives: 6,
            objects: 6,
            lattice_bits: 16,
            storage_bits: 16,
            bounds: UnitBox([[-90, 90], [-90, 90], [-50, 50]]),
            ..Header::zeroed()
        });
        blob
    }

    pub(crate) fn bytes(&self) -> &[u8] {
        &self.room.0[..self.length]
    }

    pub(super) fn bytes_mut(&mut self) -> &mut [u8] {
        &mut self.room.0[..self.length]
    }

    /// Appends a section and its line in the table.
    fn section<T: NoUninit>(&mut self, kind: SectionKind, records: &[T]) {
        let entry = SectionEntry {
            kind: kind as u16,
            stride: size_of::<T>() as u16,
            count: records.len() as u32,
            offset: self.length.next_multiple_of(SECTION_ALIGNMENT) as u32,
            spare: 0,
        };
        let line = size_of::<Header>() + self.sections * size_of::<SectionEntry>();
        self.put(line, bytes_of(&entry));
        self.put(entry.offset as usize, bytemuck::cast_slice(records));
        self.sections += 1;
        self.length = entry.offset as usize + size_of_val(records);
    }

    /// Writes the header and the checksum.
    fn seal(&mut self, mut header: Header) {
        self.put(0, bytes_of(&header));
        header.checksum = checksum(self.bytes());
        self.put(0, bytes_of(&header));
    }

    fn put(&mut self, offset: usize, bytes: &[u8]) {
        self.room.0[offset..offset + bytes.len()].copy_from_slice(bytes);
    }
}

/// A camera before the scene, 300 units from its middle, where it sees 240 units of height.
fn view() -> View {
    let half = 2 * (ONE / 20);
    View {
        eye: [0, 0, 300 << 13],
        forward: [0, 0, -(1 << 28)],
        right: [half, 0, 0],
        up: [0, half, 0],
        background: [300_000, 400_000, 600_000],
        ambient: [150_000; 3],
        cutoff: 2048,
        width: TinyBlob::SIZE[0],
        height: TinyBlob::SIZE[1],
        samples: 2,
        depth: 4,
        encoding: 0,
    }
}

fn lights() -> [Light; 2] {
    let near = [-120, 180, 160].map(|units: i64| units << 13);
    // Two thirds, two thirds, one third: of length 1.
    let far = [715_827_883, 715_827_883, 357_913_941];
    [(near, 0), (far, 1)].map(|(vector, kind)| Light {
        vector,
        color: [700_000, 650_000, 600_000],
        kind,
    })
}

fn materials() -> [Material; 3] {
    let plain = Material {
        diffuse: [ONE / 2, ONE / 3, ONE / 4],
        odd: [ONE / 8; 3],
        checker_size: 30 << 13,
        highlight: [ONE / 2; 3],
        inverse_ior: ONE,
        shininess: 20,
        ..Material::zeroed()
    };
    let glass = Material {
        transmit: [ONE / 10 * 9; 3],
        inverse_ior: ONE / 3 * 2,
        // 0.1, 0.02 and 0.01 per unit.
        absorption: [429_496_729, 85_899_345, 42_949_672],
        checker_size: 0,
        ..plain
    };
    let mirror = Material {
        mirror: [ONE / 5 * 4; 3],
        checker_size: 0,
        ..plain
    };
    [plain, glass, mirror]
}
