//! The codes that functions return, and their texts.

use crate::STRUCTURE;
use core::ffi::{CStr, c_char};
use gridel_core::render::{CameraError, RenderError};
use gridel_core::{BlobError, RayError};

/// The result of a function: 0, or the reason why it did nothing. `gridel_text` returns the
/// sentence.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum gridel_status {
    /// Done.
    Ok = 0,
    /// A pointer is null.
    NullPointer = 1,
    /// A pointer is not aligned for its type; memory for stacks, workspaces and parts needs 8 bytes.
    Misaligned = 2,
    /// A buffer has fewer bytes than are needed.
    BufferTooSmall = 3,
    /// The scene was not loaded. If `gridel_load` fails, a scene that was loaded before stays loaded; if
    /// `gridel_load_with_parts` fails, it does not.
    NotLoaded = 4,
    /// The blob does not start at a multiple of 4 bytes.
    BlobMisaligned = 10,
    /// The blob is shorter or longer than its header states.
    BlobTruncated = 11,
    /// The bytes are not a blob's.
    BlobMagic = 12,
    /// Blob and machine differ in byte order.
    BlobEndianness = 13,
    /// The blob has another version of the format.
    BlobVersion = 14,
    /// The bytes were changed after the blob was written.
    BlobChecksum = 15,
    /// The library was built without an effect that the scene requires.
    BlobMissingEffects = 16,
    /// The library was built without a shape, or a form of storage, that the scene requires.
    BlobMissingPart = 17,
    /// The blob does not hold the structure that the library was built for.
    BlobMissingStructure = 18,
    /// The blob has parts, which `gridel_load` does not load.
    BlobParts = 19,
    /// A record of the blob is invalid.
    BlobInvalid = 20,
    /// The ray's direction is zero, infinite or NaN, or so short or long that t is no number of the hit's type.
    RayDirection = 30,
    /// The ray's origin is infinite or NaN.
    RayOrigin = 31,
    /// The ray's origin is too far from the scene, or the point of its hit from 0 for the hit's type.
    RayDistance = 32,
    /// The ray's interval ends before it begins, or is NaN.
    RayInterval = 33,
    /// The picture has no pixels, or is more than 64 times as wide as high.
    PictureSize = 40,
    /// The samples per pixel are not 1 to 4096.
    PictureSamples = 41,
    /// The ray depth is above 32.
    PictureDepth = 42,
    /// The format of the pixels is unknown.
    PictureFormat = 43,
    /// The pixels are too narrow for the number format.
    PictureResolution = 44,
    /// A row or a rectangle leaves the picture.
    PictureRectangle = 45,
    /// The field of view is below 2^-31 turn, or half a turn or more.
    CameraFieldOfView = 50,
    /// Eye and target of a camera are the same place.
    CameraDirection = 51,
    /// The camera looks along the direction that points up, or that direction is 0.
    CameraAlongUp = 52,
    /// The camera's eye is beyond the range of coordinates.
    CameraEye = 53,
    /// A camera's numbers are out of range: it was not made by this library.
    CameraInvalid = 54,
    /// The axis that points up is neither 1 nor 2.
    CameraUpAxis = 55,
}

impl From<BlobError> for gridel_status {
    fn from(error: BlobError) -> Self {
        match error {
            BlobError::Misaligned => Self::BlobMisaligned,
            BlobError::Truncated { .. } => Self::BlobTruncated,
            BlobError::Magic => Self::BlobMagic,
            BlobError::Endianness { .. } => Self::BlobEndianness,
            BlobError::Version { .. } => Self::BlobVersion,
            BlobError::Checksum { .. } => Self::BlobChecksum,
            BlobError::MissingEffects { .. } => Self::BlobMissingEffects,
            // No Cargo feature of this library adds to its structure, or adds `wide`, which is for hosts.
            BlobError::MissingPart { missing }
                if missing == STRUCTURE.name() || missing == "wide" =>
            {
                Self::BlobMissingStructure
            }
            BlobError::MissingPart { .. } => Self::BlobMissingPart,
            BlobError::MissingStructure { .. } => Self::BlobMissingStructure,
            BlobError::Parts { .. } => Self::BlobParts,
            BlobError::Memory { .. } => Self::BufferTooSmall,
            _ => Self::BlobInvalid,
        }
    }
}

impl From<RayError> for gridel_status {
    fn from(error: RayError) -> Self {
        match error {
            RayError::Direction => Self::RayDirection,
            RayError::Origin => Self::RayOrigin,
            RayError::Distance => Self::RayDistance,
            RayError::Interval => Self::RayInterval,
        }
    }
}

impl From<CameraError> for gridel_status {
    fn from(error: CameraError) -> Self {
        match error {
            CameraError::FieldOfView(_) => Self::CameraFieldOfView,
            CameraError::NoDirection => Self::CameraDirection,
            CameraError::AlongUp => Self::CameraAlongUp,
            CameraError::EyeOutOfRange => Self::CameraEye,
        }
    }
}

impl From<RenderError> for gridel_status {
    fn from(error: RenderError) -> Self {
        match error {
            RenderError::Size { .. } => Self::PictureSize,
            RenderError::Samples(_)
            | RenderError::NoMoments
            | RenderError::Moments { .. }
            | RenderError::MomentSettings => Self::PictureSamples,
            RenderError::Depth(_) => Self::PictureDepth,
            RenderError::Structure(_) => Self::BlobMissingStructure,
            RenderError::Effects(_) => Self::BlobMissingEffects,
            RenderError::Resolution(_) => Self::PictureResolution,
            RenderError::Workspace { .. } => Self::BufferTooSmall,
        }
    }
}

/// Returns the sentence for a code, which says what to do; it lives forever.
#[unsafe(no_mangle)]
pub extern "C" fn gridel_text(status: u32) -> *const c_char {
    text(status).as_ptr()
}

fn text(status: u32) -> &'static CStr {
    match status {
        0 => c"done",
        1 => c"a pointer is null",
        2 => c"a pointer is not aligned: memory for stacks, workspaces and parts starts at a multiple of 8 bytes, pixels of RGB565 at one of 2",
        3 => c"a buffer is too small: gridel_stack_bytes, gridel_workspace_bytes_* and gridel_parts_bytes state the bytes of memory, and pixels take 3 bytes each, or 2 in RGB565",
        4 => c"the scene was not loaded: call gridel_load, and look at what it returns",
        10 => c"the blob does not start at a multiple of 4 bytes: align it, or copy it into aligned memory",
        11 => c"the blob is shorter or longer than it says: was it cut off, or was something added to it?",
        12 => c"these bytes are not a Gridel blob: compile the scene with `gridel build`",
        13 => c"the blob is little-endian, and this machine must be too",
        14 => c"the blob has another version of the format: compile the scene with the matching `gridel build`",
        15 => c"the blob's checksum differs: its bytes were changed after it was written",
        16 => c"the scene requires an effect that this library was built without: enable its Cargo feature",
        17 => c"the scene requires a shape or storage that this library was built without: enable its Cargo feature",
        18 => c"the blob does not hold the structure of this library: build it with `gridel build --accel`",
        19 => c"the scene has parts: load it by gridel_load_with_parts, with the memory that gridel_parts_bytes states",
        20 => c"a record of the blob is invalid: gridel_blob_error says which",
        30 => c"the ray's direction is zero, infinite or NaN, or so short or long that t is no number of the hit's type",
        31 => c"the ray's origin is infinite or NaN",
        32 => c"the ray's origin is too far from the scene, or its hit from 0 for the hit's type: move the origin closer along the ray, or use gridel_cast_f64",
        33 => c"the ray's interval ends before it begins, or is NaN",
        40 => c"the picture has no pixels, or is more than 64 times as wide as high",
        41 => c"the samples per pixel must be 1 to 4096",
        42 => c"the ray depth must be 0 to 32",
        43 => c"the format of the pixels is unknown: use one of gridel_pixel_format",
        44 => c"the pixels are too narrow for the number format: use fewer pixels, or gridel_render_f64",
        45 => c"the rectangle leaves the picture",
        50 => c"the camera's field of view must be at least 2 and below half a turn",
        51 => c"the camera looks nowhere: move its eye or its target",
        52 => c"the camera looks along the direction that points up, or that is 0: give one across the view",
        53 => c"the camera's eye is beyond the range of scene coordinates",
        54 => c"the camera's numbers are out of range: make it by gridel_look_at or gridel_orbit",
        55 => c"the axis that points up must be 1 for y or 2 for z",
        _ => c"unknown status",
    }
}
