//! Tables of `core/FORMAT.md` that the core's declarations generate.

use super::{FORMAT, holds_table, repository};
use glam::{DVec2, DVec3};
use gridel_core::format::record::{Header, SectionEntry};
use gridel_core::format::track::{Interpolation, TrackTarget};
use gridel_core::format::{Kind, SectionKind};
use gridel_core::{Effects, Structure};
use gridel_host::compile::{Options, compile};
use gridel_host::scene::{self, Shape};
use gridel_host::shape::{Plane, Torus};
use gridel_tests::scenes;
use std::collections::BTreeSet;
use std::fs;

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
    scene.lights.push(scene::Light::Point {
        position: DVec3::new(3.0, 4.0, 5.0),
        color: [9.0; 3],
    });
    scene.light_forms = vec![
        None,
        Some(scene::LightForm {
            shape: scene::LightShape::Sphere { radius: 0.5 },
            ..scene::LightForm::default()
        }),
    ];
    scene.environment = Some(scene::Environment::of(scene::Sky::Gradient {
        zenith: [1.0; 3],
        horizon: [0.5; 3],
        ground: [0.1; 3],
    }));
    scene.materials[0].emission = [2.0; 3];
    scene.materials[0].mirror = [0.5; 3];
    scene.materials[0].roughness = 0.5;
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
    let image = scene::Image::new("white", 1, 1, vec![[255; 4]]);
    let image = image.expect("as many pixels");
    let texture = scene::Texture {
        levels: true,
        ..scene::Texture::of(image.into())
    };
    scene.materials[0].normal_map = Some(scene::NormalMap {
        texture: texture.clone(),
        scale: 1.0,
    });
    scene.materials[0].texture = Some(texture);
    scene.materials[0].transmit = [0.5; 3];
    scene.materials[0].priority = Some(1);
    let compiled = compile(&scene, &options).expect("compiles");
    blobs.push(compiled.blob.bytes().to_vec());
    let placed = |x: f64| scene::Instance {
        name: String::from("copy"),
        part: 0,
        placement: scene::Placement {
            translation: DVec3::X * x,
            ..scene::Placement::IDENTITY
        },
        joint: None,
        place: scene::SourceSpan::default(),
    };
    scene.parts = vec![scene::Part {
        name: String::from("part"),
        objects: vec![scene.objects[0].clone()],
        place: scene::SourceSpan::default(),
    }];
    scene.instances = vec![placed(4.0), placed(8.0)];
    scene.instances[0].joint = Some(0);
    scene.joints = vec![scene::Joint {
        name: String::from("joint"),
        parent: None,
        pivot: DVec3::ZERO,
        place: scene::SourceSpan::default(),
    }];
    scene.objects.push(bent_sheet());
    scene.lens = Some(scene::Lens {
        radius: 0.1,
        focus: None,
    });
    scene.render.bounces = 1;
    let compiled = compile(&scene, &options).expect("compiles");
    blobs.push(compiled.blob.bytes().to_vec());
    blobs.push(bending_sheet());
    blobs
}

/// The sheet with a morph target, in the structure that can follow.
fn bending_sheet() -> Vec<u8> {
    let mut sheet = bent_sheet();
    sheet.attributes.displacements = vec![scene::Displacements {
        target: 0,
        vectors: vec![DVec3::ZERO, DVec3::Y, DVec3::X, DVec3::ZERO],
    }];
    sheet.shade(scene::NormalsChoice::Smooth(120.0));
    let scene = scene::Scene {
        materials: vec![scene::Material::default()],
        objects: vec![sheet],
        morph_targets: vec![scene::MorphTarget {
            name: String::from("bend"),
            weight: 0.0,
            range: [0.0, 1.0],
            place: scene::SourceSpan::default(),
        }],
        ..scene::Scene::default()
    };
    let options = Options {
        structures: vec![Structure::Bvh],
        ..Options::default()
    };
    let compiled = compile(&scene, &options).expect("compiles");
    compiled.blob.bytes().to_vec()
}

/// Two triangles with smooth normals.
fn bent_sheet() -> scene::Object {
    let vertices = vec![DVec3::Y, DVec3::Z, -DVec3::Z, DVec3::new(4.0, 1.0, 0.0)];
    let triangles = vec![[0, 1, 3], [0, 3, 2]];
    scene::Object {
        name: String::from("sheet"),
        material: 0,
        normals: scene::Normals::computed(&vertices, &triangles, 120.0),
        attributes: scene::Attributes {
            colors: vec![[0.5; 3]; 4],
            coordinates: vec![DVec2::ZERO, DVec2::X, DVec2::Y],
            triangles: vec![[0, 1, 2]; 2],
            displacements: Vec::new(),
        },
        shape: Shape::Mesh {
            vertices,
            triangles,
        },
        place: scene::SourceSpan::default(),
    }
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
            let kind = SectionKind::of_number(entry.kind).expect("a known kind");
            let stride = usize::from(entry.stride);
            let mut forms = kind.layout().records.iter();
            assert!(forms.any(|form| form.bytes == stride), "{kind:?} {stride}");
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
