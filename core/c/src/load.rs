//! Loading of blobs as scenes.

use crate::memory::{
    PartViews, bytes, clear, elements, input, output, scene, stack_bytes, store, zeroed,
};
use crate::{STRUCTURE, gridel_buffer, gridel_info, gridel_scene, gridel_status};
use core::ffi::{c_char, c_void};
use core::fmt::{self, Write};
use gridel_core::scene::part_blobs;
use gridel_core::{BlobError, Scene};

/// Checks a blob and fills in a scene. The blob starts at a multiple of 4 bytes and stays where it is, unchanged, for as
/// long as the scene is used. Takes time linear in its length, and about 2 KiB of stack. A scene with parts is loaded by
/// `gridel_load_with_parts`. If it fails, the scene stays as it was.
///
/// # Safety
/// Each pointer is null, or points to what its type states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gridel_load(
    to: *mut gridel_scene,
    blob: *const c_void,
    blob_bytes: usize,
) -> gridel_status {
    let load = || {
        // SAFETY: the caller's promise. Nothing is written before everything is known.
        unsafe { output(to) }?;
        // SAFETY: the caller's promise.
        let blob = unsafe { bytes(blob.cast(), blob_bytes) }?;
        let loaded = held(Scene::from_bytes(blob)?)?;
        // SAFETY: the caller's promise.
        unsafe { store(to, loaded) }
    };
    status(load())
}

/// Writes the bytes of memory that `gridel_load_with_parts` needs; 0 for a blob without parts.
///
/// # Safety
/// Each pointer is null, or points to what its type states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gridel_parts_bytes(
    blob: *const c_void,
    blob_bytes: usize,
    needed: *mut usize,
) -> gridel_status {
    let count = || {
        // SAFETY: the caller's promise.
        let needed = unsafe { output(needed) }?;
        // SAFETY: the caller's promise.
        let blob = unsafe { bytes(blob.cast(), blob_bytes) }?;
        let count = part_blobs(blob).map_err(|error| why(blob, error))?.count();
        needed.write(count.saturating_mul(size_of::<Scene<'_>>()));
        Ok(())
    };
    status(count())
}

/// Checks a blob that has parts and fills in a scene. The memory of the parts starts at a multiple of 8 bytes. It has
/// as many bytes as `gridel_parts_bytes` states, and belongs to the scene for as long as that is used. If it fails, the
/// scene is not loaded. Takes about 2.5 KiB of stack.
///
/// # Safety
/// Each pointer is null, or points to what its type states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gridel_load_with_parts(
    to: *mut gridel_scene,
    blob: *const c_void,
    blob_bytes: usize,
    parts: gridel_buffer,
) -> gridel_status {
    let load = || {
        // SAFETY: the caller's promise.
        unsafe { clear(to) }?;
        // SAFETY: the caller's promise.
        let blob = unsafe { bytes(blob.cast(), blob_bytes) }?;
        // SAFETY: the caller's promise.
        let mut views = unsafe { PartViews::new(parts) }?;
        for part in part_blobs(blob).map_err(|error| why(blob, error))? {
            views.push(Scene::from_bytes(part).map_err(|error| why(blob, error))?)?;
        }
        let loaded = held(Scene::with_parts(blob, views.finish())?)?;
        // SAFETY: the caller's promise.
        unsafe { store(to, loaded) }
    };
    status(load())
}

/// The reason why a blob is rejected, one of whose parts, or the list of them, was found to be invalid: what is wrong
/// with the whole, such as its checksum, is said first.
fn why(blob: &[u8], part: BlobError) -> gridel_status {
    match Scene::from_bytes(blob) {
        Ok(_) | Err(BlobError::Parts { .. }) => part.into(),
        Err(error) => error.into(),
    }
}

/// A scene that this library can trace.
fn held(scene: Scene<'static>) -> Result<Scene<'static>, gridel_status> {
    if scene.holds(STRUCTURE) {
        Ok(scene)
    } else {
        Err(gridel_status::BlobMissingStructure)
    }
}

/// Writes the reason why a blob is rejected as a sentence, with the section, the record and the expected value. The
/// sentence ends with 0 and is cut off where the buffer ends. Returns the code. For a blob with valid parts the code is
/// `GRIDEL_STATUS_BLOB_PARTS`, as from `gridel_load`. What places the parts is checked by `gridel_load_with_parts`
/// alone. Takes some KiB of code and of stack; a program that does not call it does not hold it.
///
/// # Safety
/// Each pointer is null, or points to what its type states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gridel_blob_error(
    blob: *const c_void,
    blob_bytes: usize,
    text: *mut c_char,
    text_bytes: usize,
) -> gridel_status {
    let explain = || {
        let buffer = gridel_buffer {
            memory: text.cast(),
            bytes: text_bytes,
        };
        // SAFETY: the caller's promise.
        let text = unsafe { elements::<u8>(buffer, text_bytes) }?;
        // SAFETY: a byte of 0 is a `u8`.
        let text = unsafe { zeroed(text) };
        // SAFETY: the caller's promise.
        let blob = unsafe { bytes(blob.cast(), blob_bytes) }?;
        let mut sentence = Sentence { text, used: 0 };
        let checked = match Scene::from_bytes(blob) {
            // It is rejected only because its parts are missing; they are checked one by one.
            Err(whole @ BlobError::Parts { .. }) => part_blobs(blob)
                .and_then(|mut parts| parts.try_for_each(|part| Scene::from_bytes(part).map(drop)))
                .and(Err(whole)),
            Ok(scene) if !scene.holds(STRUCTURE) => Err(BlobError::MissingPart {
                missing: STRUCTURE.name(),
            }),
            result => result.map(drop),
        };
        let Err(error) = checked else { return Ok(()) };
        let name = STRUCTURE.name();
        // What does not fit is cut off.
        let _ = match error {
            BlobError::Parts { .. } => sentence.write_str(
                "the blob has parts: load it by gridel_load_with_parts, with the memory that gridel_parts_bytes states",
            ),
            BlobError::Misaligned => sentence.write_str(
                "the blob does not start at a multiple of 4 bytes: align it, or copy it into aligned memory",
            ),
            // No Cargo feature of this library helps.
            BlobError::MissingPart { missing } if missing == name || missing == "wide" => write!(
                sentence,
                "the blob does not hold the structure {name}, for which this library was built: build it with \
                 `gridel build --accel {name}`"
            ),
            error => write!(sentence, "{error}"),
        };
        Err(error.into())
    };
    status(explain())
}

/// A text in the caller's memory, before the 0 at its end.
struct Sentence<'t> {
    text: &'t mut [u8],
    used: usize,
}

impl Write for Sentence<'_> {
    fn write_str(&mut self, more: &str) -> fmt::Result {
        let last = self.text.len().saturating_sub(1);
        let room = self.text.get_mut(self.used..last).unwrap_or_default();
        for (to, from) in room.iter_mut().zip(more.bytes()) {
            *to = from;
            self.used = self.used.saturating_add(1);
        }
        Ok(())
    }
}

/// Writes the properties and requirements of a scene.
///
/// # Safety
/// Each pointer is null, or points to what its type states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gridel_info_of(
    loaded: *const gridel_scene,
    info: *mut gridel_info,
) -> gridel_status {
    let attempt = || {
        // SAFETY: the caller's promise.
        let (scene, info) = unsafe { (scene(loaded)?, output(info)?) };
        let header = scene.header();
        info.write(gridel_info {
            coordinate_origin: header.coordinate_origin(),
            coordinate_exponent: scene.coordinate_exponent(),
            stack_depth: header.stack_depth.into(),
            objects: header.objects,
            primitives: header.primitives,
        });
        Ok(())
    };
    status(attempt())
}

/// Writes the bytes of the stack that rays need, which starts at a multiple of 8 bytes.
///
/// # Safety
/// Each pointer is null, or points to what its type states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gridel_stack_bytes(
    loaded: *const gridel_scene,
    needed: *mut usize,
) -> gridel_status {
    let count = || {
        // SAFETY: the caller's promise.
        let (scene, needed) = unsafe { (scene(loaded)?, output(needed)?) };
        needed.write(stack_bytes(scene));
        Ok(())
    };
    status(count())
}

pub(crate) fn status(done: Result<(), gridel_status>) -> gridel_status {
    match done {
        Ok(()) => gridel_status::Ok,
        Err(why) => why,
    }
}

/// A value to read, for the other files.
///
/// # Safety
/// As [`input`].
pub(crate) unsafe fn read<T: Copy>(value: *const T) -> Result<T, gridel_status> {
    // SAFETY: the caller's promise.
    Ok(*unsafe { input(value) }?)
}
