//! Fuzz targets: one function for each kind of input that comes from outside.
//!
//! Each function takes any bytes, and panics where a promise is broken. The fuzz targets of `tests/fuzz` call them
//! through libFuzzer. [`bounded`] calls them a fixed number of times with mutations of the committed corpus. So an
//! ordinary test run needs no instrumented build.

pub mod bounded;
mod forge;
mod import;
mod parts;

pub use forge::Forger;
pub use import::{import, npy, seeds, toml};
pub use parts::Base;

use crate::query::{HitBits, UnitRay, held, through};
use crate::{every_format, rays};
use gridel_core::format::record::Header;
use gridel_core::format::{BlobError, checksum};
use gridel_core::{Number, Scene, Structure, Tracks};
use gridel_host::blob::Blob;
use gridel_host::state::{State, StateError};
use std::mem::offset_of;

/// Rays that are traced through a loaded blob, in each number format.
const RAYS: usize = 15;

/// Seals bytes as a blob, loads it, and holds every structure to brute force.
pub fn blob(data: &[u8]) {
    let blob = sealed(data);
    if let Ok(scene) = blob.scene() {
        agree(&scene, &some_rays(&scene, 3));
        moves(&scene, &blob);
    }
}

/// Rays of every sort through a scene.
pub fn some_rays(scene: &Scene<'_>, seed: u64) -> Vec<UnitRay> {
    rays::rays(scene, seed).take(RAYS).collect()
}

/// Gives bytes a matching length and checksum, as far as they have room for them.
pub fn sealed(bytes: &[u8]) -> Blob {
    let mut bytes = bytes.to_vec();
    let length = bytes.len() as u32;
    put_word(&mut bytes, offset_of!(Header, blob_bytes), length);
    let sum = checksum(&bytes);
    put_word(&mut bytes, offset_of!(Header, checksum), sum);
    Blob::new(&bytes)
}

fn put_word(bytes: &mut [u8], place: usize, word: u32) {
    if let Some(place) = bytes.get_mut(place..place + 4) {
        place.copy_from_slice(&word.to_le_bytes());
    }
}

/// Holds every structure of a loaded scene to brute force, in every number format.
///
/// A structure whose answers loading does not prove (see [`Structure::is_proved`]) may lack
/// candidates where a blob was forged. It must not find what brute force does not find.
///
/// # Panics
/// If an answer differs.
pub fn agree(scene: &Scene<'_>, rays: &[UnitRay]) {
    every_format!(agree_in(scene, rays));
}

fn agree_in<N: Number>(scene: &Scene<'_>, rays: &[UnitRay]) {
    let structures: Vec<Structure> = held(scene).collect();
    for ray in rays {
        let Some(ready) = ray.ready::<N>(scene) else {
            continue;
        };
        let bits = |hit: Option<_>| hit.as_ref().map(HitBits::of::<N>);
        let (hit, any) = through(Structure::List, scene, &ready);
        let listed = bits(hit);
        let described = |structure: Structure| {
            let (format, structure) = (N::FORMAT.name(), structure.name());
            format!("{format}, {structure}: {ray:?}")
        };
        assert_eq!(listed.is_some(), any, "{}", described(Structure::List));
        for &structure in &structures {
            let (hit, any) = through(structure, scene, &ready);
            let found = bits(hit);
            if structure.is_proved() {
                assert_eq!(found, listed, "{}", described(structure));
                assert_eq!(any, listed.is_some(), "{}", described(structure));
            } else {
                let nearer = match (found, listed) {
                    (Some(found), Some(listed)) => {
                        f64::from_bits(found.t) < f64::from_bits(listed.t)
                    }
                    (found, listed) => found.is_some() && listed.is_none(),
                };
                assert!(
                    !nearer,
                    "{}: {found:?}, not {listed:?}",
                    described(structure)
                );
                assert!(!any || listed.is_some(), "{}", described(structure));
            }
        }
    }
}

/// Checks the tracks of a loaded scene's blob. Where they are accepted, the scene has a state at any time, or the
/// camera is invalid.
///
/// Returns whether they were accepted.
///
/// # Panics
/// If a state is rejected.
pub fn moves(scene: &Scene<'_>, blob: &Blob) -> bool {
    let tracks = match Tracks::from_bytes(blob.bytes()) {
        Ok(tracks) => tracks,
        Err(error) => {
            speaks(&error);
            return false;
        }
    };
    let [first, last] = tracks.span();
    let quarter = first.midpoint(first.midpoint(last));
    for time in [
        i32::MIN,
        first,
        quarter,
        first.midpoint(last),
        last,
        i32::MAX,
    ] {
        match State::at(blob, scene, &tracks, time) {
            Ok(state) => drop(state.apply(scene).expect("a state in range")),
            Err(
                StateError::Camera { .. } | StateError::Instances { .. } | StateError::Mesh { .. },
            ) => {}
            Err(StateError::Blob(error)) => panic!("{error}"),
        }
    }
    true
}

/// Holds an error to what errors promise: words that name the field or the record.
///
/// # Panics
/// If they do not.
pub fn speaks(error: &BlobError) {
    let text = error.to_string();
    let named = match error {
        BlobError::Stride { section, .. }
        | BlobError::Count { section, .. }
        | BlobError::TooMany { section, .. } => text.contains(section.name()),
        BlobError::OutOfRange {
            location, field, ..
        } => text.starts_with(&location.to_string()) && text.contains(field.text()),
        BlobError::Invalid { location, reason } => {
            text.starts_with(&location.to_string()) && text.contains(reason.text())
        }
        _ => text.len() > 20,
    };
    assert!(named, "{error:?}: {text}");
}
