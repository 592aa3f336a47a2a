//! Tables of `core/FORMAT.md` that the core's declarations generate.

use super::{holds_table, repository};
use glam::DVec3;
use gridel_core::format::cluster::{Pack16, Pack24, Strip16, Strip24};
use gridel_core::format::record::{
    ApexDirection, ApexPoint, ApexWindow, DualNode, FlaggedPair, GridShape, Gridels, Header, Light,
    Material, Pair, SectionEntry, Sphere16, Sphere24, SpherePair, Vertex16, Vertex24, View,
    WideNode,
};
use gridel_core::format::track::{Interpolation, Timeline, Track, TrackTarget};
use gridel_core::format::{Kind, SectionKind};
use gridel_core::geometry::{cone, cuboid, disc, plane, torus};
use gridel_core::shared::DIRECTION_COUNTS;
use gridel_core::{Effects, Structure};
use gridel_host::compile::{Options, compile};
use gridel_host::scene::{self, Shape};
use gridel_host::shape::{Plane, Torus};
use gridel_tests::scenes;
use std::collections::BTreeSet;
use std::fs;

const FORMAT: &str = "core/FORMAT.md";

/// The record of a section, its strides in bytes, and the property of a blob that decides between them.
fn record(kind: SectionKind) -> (&'static str, Vec<usize>, &'static str) {
    use SectionKind as S;
    /// Bytes of `T`.
    fn one<T>(record: &'static str) -> (&'static str, Vec<usize>, &'static str) {
        (record, vec![size_of::<T>()], "")
    }
    fn by_bits<A, B>(record: &'static str) -> (&'static str, Vec<usize>, &'static str) {
        let strides = vec![size_of::<A>(), size_of::<B>()];
        (record, strides, ", by storage bits")
    }
    let by_directions = |record, bytes: fn(usize) -> usize| {
        let strides = DIRECTION_COUNTS.map(bytes).to_vec();
        (record, strides, ", by directions")
    };
    let index = |record, least: usize| (record, (least..=4).collect(), "");
    match kind {
        S::View => one::<View>("view, exactly one"),
        S::Lights => one::<Light>("light"),
        S::Materials => one::<Material>("material"),
        S::ObjectFirst | S::Order => index("index", 2),
        S::ObjectMaterial => index("index", 1),
        S::Vertices => by_bits::<Vertex16, Vertex24>("vertex"),
        S::Triangles => ("triangle", vec![6, 12], ""),
        S::Spheres => by_bits::<Sphere16, Sphere24>("sphere"),
        S::Boxes => one::<cuboid::Cuboid>("cuboid"),
        S::Discs => one::<disc::Disc>("disc"),
        S::Cones => one::<cone::Cone>("cone"),
        S::Tori => one::<torus::Torus>("torus"),
        S::Planes => one::<plane::Plane>("plane"),
        S::Leaves => one::<u32>("leaf"),
        S::Pairs => one::<Pair>("pair"),
        S::FlaggedPairs => one::<FlaggedPair>("flagged pair"),
        S::DualNodes => one::<DualNode>("dual-split node"),
        S::CylinderGridels | S::TightGridels | S::EntryGridels => {
            one::<Gridels>("gridels, exactly one")
        }
        S::CylinderCells | S::TightCells | S::ApexCells | S::EntryCells | S::ClassCells => {
            index("number of a list", 1)
        }
        S::CylinderStarts | S::TightStarts | S::ApexStarts | S::EntryStarts | S::ClassStarts => {
            index("first entry of a list", 1)
        }
        S::CylinderEntries | S::TightEntries | S::ApexEntries | S::ClassEntries => index("slot", 1),
        S::EntryNodes => index("node of `bvh`", 1),
        S::TightKeys | S::EntryKeys => one::<u8>("two levels"),
        S::ApexKeys | S::ClassKeys => one::<u8>("level"),
        S::ApexPoints => one::<ApexPoint>("apex"),
        S::ApexWindows => one::<ApexWindow>("window"),
        S::ApexDirections => one::<ApexDirection>("direction"),
        S::ClassNodes => one::<u32>("class"),
        S::WideNodes => one::<WideNode>("wide node"),
        S::Strips => by_bits::<Strip16, Strip24>("strip"),
        S::Packs => by_bits::<Pack16, Pack24>("pack"),
        S::Members => index("index of a primitive or a slot", 2),
        S::SlotLocations => one::<u32>("location of a slot"),
        S::Radii => one::<i32>("radius in 1/256 unit"),
        S::SlabRoot | S::FlaggedSlabRoot => one::<[i16; 2]>("[2]i16 per direction"),
        S::SlabPairs => by_directions("slab pair", |directions| 8 * directions + 8),
        S::FlaggedSlabPairs => by_directions("flagged slab pair", |directions| 4 * directions + 8),
        S::SpherePairs => one::<SpherePair>("sphere pair"),
        S::GridShape => one::<GridShape>("grid shape, exactly one"),
        S::GridStarts | S::OctreeStarts => index("first entry of a list", 1),
        S::GridSlots | S::OctreeSlots => index("slot", 1),
        S::OctreeNodes => one::<u32>("octree node"),
        S::NameStarts => index("first byte of a name", 1),
        S::NameText => one::<u8>("u8"),
        S::Timeline => one::<Timeline>("timeline, exactly one"),
        S::Tracks => one::<Track>("track"),
        S::TrackTimes => one::<i32>("ticks"),
        S::TrackWords => one::<i32>("component of a value"),
    }
}

/// Words joined by commas, the last by "or".
fn either(strides: &[usize]) -> String {
    let words: Vec<_> = strides.iter().map(usize::to_string).collect();
    match words.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, rest)) => format!("{} or {last}", rest.join(", ")),
        None => String::new(),
    }
}

#[test]
fn format_lists_every_section() {
    let mut table = String::from("| kind | name | record | stride |\n|---|---|---|---|\n");
    for kind in SectionKind::ALL {
        let (record, strides, by) = record(kind);
        let (number, name) = (kind as u16, kind.name());
        table += &format!(
            "| {number} | {name} | {record} | {}{by} |\n",
            either(&strides)
        );
    }
    holds_table(FORMAT, "sections", &table);
}

/// The committed blobs, and one with the sections that they lack.
fn blobs() -> Vec<Vec<u8>> {
    let folder = fs::read_dir(repository().join("fixtures/blobs")).expect("the folder of blobs");
    let paths = folder.map(|file| file.expect("a file").path());
    let paths = paths.filter(|path| path.extension().is_some_and(|end| end == "gridel"));
    let readable = paths.filter(|path| !path.ends_with("version-2.gridel"));
    let mut blobs: Vec<_> = readable
        .map(|path| fs::read(path).expect("a blob"))
        .collect();
    let torus = Shape::Torus(Torus {
        center: DVec3::ZERO,
        axis: DVec3::Y,
        major_radius: 1.0,
        minor_radius: 0.5,
    });
    let plane = Shape::Plane(Plane {
        point: DVec3::NEG_Y,
        normal: DVec3::Y,
    });
    let mut scene = scenes::of([torus, plane]);
    scene.lights = vec![scene::Light::Directional {
        direction: DVec3::new(-1.0, -2.0, -0.5),
        color: [0.8; 3],
    }];
    scene.tracks = vec![scene::Track {
        target: TrackTarget::CameraOrbit,
        index: 0,
        interpolation: Interpolation::Linear,
        keys: vec![scene::Key::default()],
        place: scene::SourceSpan::default(),
    }];
    let options = Options {
        names: true,
        ..scenes::compact_options(16)
    };
    let compiled = compile(&scene, &options).expect("compiles");
    blobs.push(compiled.blob.bytes().to_vec());
    blobs
}

/// Every section has a stride that the table allows.
#[test]
fn sections_of_blobs_have_the_strides_of_the_format() {
    let mut seen = BTreeSet::new();
    for blob in blobs() {
        let (header, rest) = blob.split_at(size_of::<Header>());
        let header: Header = bytemuck::pod_read_unaligned(header);
        let entries = rest.chunks_exact(size_of::<SectionEntry>());
        for entry in entries.take(header.section_count.into()) {
            let entry: SectionEntry = bytemuck::pod_read_unaligned(entry);
            let kind = SectionKind::ALL[usize::from(entry.kind) - 1];
            let (_, strides, _) = record(kind);
            let stride = usize::from(entry.stride);
            assert!(strides.contains(&stride), "{kind:?} {stride}");
            seen.insert(kind);
        }
    }
    let unseen: Vec<_> = SectionKind::ALL
        .iter()
        .filter(|kind| !seen.contains(kind))
        .collect();
    assert!(unseen.is_empty(), "in no blob: {unseen:?}");
}

#[test]
fn format_lists_every_structure() {
    let mut table = String::from("| bit | structure | sections of its own |\n|---|---|---|\n");
    for structure in Structure::ALL {
        let own = SectionKind::ALL.into_iter();
        let own = own.filter(|kind| kind.record_name().1 == structure.name());
        let own: Vec<_> = own.map(|kind| format!("`{}`", kind.name())).collect();
        let own = if own.is_empty() {
            String::from("none")
        } else {
            own.join(", ")
        };
        let bit = structure.bit().trailing_zeros();
        table += &format!("| {bit} | `{}` | {own} |\n", structure.name());
    }
    holds_table(FORMAT, "structures", &table);
}

#[test]
fn format_lists_every_kind_of_primitive() {
    let mut table = String::from("| kind | primitive |\n|---|---|\n");
    for kind in Kind::ALL {
        table += &format!("| {} | {} |\n", kind as u32, kind.name());
    }
    holds_table(FORMAT, "kinds", &table);
}

#[test]
fn format_lists_every_effect() {
    let mut table = String::from("| bit | effect | required by |\n|---|---|---|\n");
    for ((effect, name), required_by) in Effects::NAMED.into_iter().zip(Effects::REQUIRED_BY) {
        let bit = effect.0.trailing_zeros();
        table += &format!("| {bit} | {name} | {required_by} |\n");
    }
    holds_table(FORMAT, "effects", &table);
}
