//! Blobs of every version of the format. This build reads them and answers as recorded, or rejects them and names the
//! supported versions.
//!
//! `fixtures/blobs` holds one of each structure, built from `scene.toml` there with `gridel build` as it
//! was when the format had that version. These files stay as they are: when the format changes, its
//! version rises, and the files of the new version are added.

use gridel_core::format::BlobError;
use gridel_core::format::record::{Header, VERSION};
use gridel_core::{Number, Scene, Structure};
use gridel_host::blob::Blob;
use gridel_tests::query::{UnitRay, held, through};
use gridel_tests::{every_format, scenes};
use std::mem::offset_of;
use std::path::PathBuf;

/// A ray in scene units, and its hit.
struct Recorded {
    origin: [f64; 3],
    direction: [f64; 3],
    /// The primitive, and t in multiples of the direction.
    hit: Option<(u32, f64)>,
}

/// Largest difference of t: the 16-bit lattice moves surfaces by at most this.
const TOLERANCE: f64 = 1e-3;

fn folder() -> PathBuf {
    scenes::fixture_folder().join("blobs")
}

fn blobs() -> Vec<(String, Vec<u8>)> {
    let entries = std::fs::read_dir(folder()).expect("the folder of blobs");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let mut blobs: Vec<_> = paths
        .filter(|path| path.extension().is_some_and(|it| it == "gridel"))
        .map(|path| {
            let bytes = std::fs::read(&path).expect("a blob");
            (
                path.file_stem().unwrap_or_default().display().to_string(),
                bytes,
            )
        })
        .collect();
    blobs.sort();
    blobs
}

/// The rays that were recorded.
fn answers() -> Vec<Recorded> {
    let text = std::fs::read_to_string(folder().join("answers.toml")).expect("the answers");
    let table: toml::Table = text.parse().expect("the answers");
    let number = |value: &toml::Value| match value {
        toml::Value::Integer(number) => *number as f64,
        value => value.as_float().expect("a number"),
    };
    let vector = |ray: &toml::Value, name: &str| {
        let array = ray[name].as_array().expect("an array");
        [0, 1, 2].map(|k: usize| number(&array[k]))
    };
    let rays = table["ray"].as_array().expect("rays");
    let recorded = rays.iter().map(|ray| Recorded {
        origin: vector(ray, "origin"),
        direction: vector(ray, "direction"),
        hit: ray
            .get("primitive")
            .map(|it| (number(it) as u32, number(&ray["t"]))),
    });
    recorded.collect()
}

fn version(bytes: &[u8]) -> u16 {
    let place = offset_of!(Header, version);
    u16::from_le_bytes([bytes[place], bytes[place + 1]])
}

fn answers_as_recorded<N: Number>(name: &str, scene: &Scene<'_>, answers: &[Recorded]) {
    let header = scene.header();
    let unit = 2_f64.powi(header.unit_exponent.into());
    for (number, recorded) in answers.iter().enumerate() {
        let origin = [0, 1, 2].map(|k| (recorded.origin[k] - header.origin[k]) / unit);
        let direction = recorded.direction.map(|x| x / unit);
        let ray = UnitRay::new(origin, direction).ready::<N>(scene);
        let ray = ray.expect("a ray");
        for structure in [Structure::List].into_iter().chain(held(scene)) {
            let described = || {
                let (format, structure) = (N::FORMAT.name(), structure.name());
                format!("{name}, {format}, {structure}, ray {number}")
            };
            let (hit, any) = through(structure, scene, &ray);
            let found = hit.as_ref().map(|hit| hit.primitive);
            let primitive = recorded.hit.map(|(primitive, _)| primitive);
            assert_eq!(found, primitive, "{}", described());
            assert_eq!(any, primitive.is_some(), "{}", described());
            if let (Some(hit), Some((_, t))) = (hit, recorded.hit) {
                // The hit's t is along the major axis; the recorded one counts multiples of the direction.
                let longest = direction.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
                let found = N::far_to_f64(hit.t) / longest;
                assert!(
                    (found - t).abs() <= TOLERANCE,
                    "{}: {found}, not {t}",
                    described()
                );
            }
        }
    }
}

#[test]
fn old_blobs_load_and_answer_as_recorded_or_are_rejected_by_version() {
    let answers = answers();
    assert!(answers.len() >= 20);
    let mut loaded = Vec::new();
    for (name, bytes) in blobs() {
        let blob = Blob::new(&bytes);
        if version(&bytes) == VERSION {
            let scene = blob.scene().unwrap_or_else(|error| {
                panic!("{name}: {error}; a change of the format needs a new version")
            });
            every_format!(answers_as_recorded(&name, &scene, &answers));
            loaded.push(name);
        } else {
            let error = blob.scene().expect_err(&name);
            assert!(
                matches!(error, BlobError::Version { .. }),
                "{name}: {error}"
            );
            let text = error.to_string();
            for version in [version(&bytes), VERSION] {
                assert!(
                    text.contains(&format!("version {version}")),
                    "{name}: {text}"
                );
            }
        }
    }
    // Files of this version, of every structure.
    for structure in Structure::ALL {
        let name = structure.name();
        assert!(loaded.iter().any(|it| it == name), "no blob of {name}");
    }
}

#[test]
fn unknown_versions_are_rejected_with_both_versions() {
    for (name, bytes) in blobs() {
        for unknown in [0, VERSION + 1, u16::MAX] {
            let mut bytes = bytes.clone();
            let place = offset_of!(Header, version);
            bytes[place..place + 2].copy_from_slice(&unknown.to_le_bytes());
            let blob = Blob::new(&bytes);
            let error = blob.scene().expect_err(&name);
            assert_eq!(error, BlobError::Version { found: unknown }, "{name}");
            let text = error.to_string();
            let both = [unknown, VERSION].map(|it| format!("version {it}"));
            assert!(both.iter().all(|it| text.contains(it)), "{text}");
        }
    }
}
