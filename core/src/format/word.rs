//! Words of a blob, read at compile time.

use crate::format::error::BlobError;
use crate::format::record::{Header, MAGIC};
use core::mem::offset_of;

/// `?`, which constant functions lack.
macro_rules! proved {
    ($result:expr) => {
        match $result {
            Ok(value) => value,
            Err(error) => return Err(error),
        }
    };
}

pub(crate) use proved;

/// Returns an error if the bytes are not a blob, or not one of the length that its header states.
pub(crate) const fn complete(blob: &[u8]) -> Result<(), BlobError> {
    let [a, b, c, d, ..] = MAGIC;
    if proved!(word(blob, 0)) != u32::from_le_bytes([a, b, c, d]) {
        return Err(BlobError::Magic);
    }
    let needed = proved!(word(blob, offset_of!(Header, blob_bytes))) as usize;
    let found = blob.len();
    if needed != found {
        return Err(BlobError::Truncated { needed, found });
    }
    Ok(())
}

/// The word at a place of a blob.
pub(crate) const fn word(blob: &[u8], place: usize) -> Result<u32, BlobError> {
    if let Some((_, rest)) = blob.split_at_checked(place)
        && let Some(bytes) = rest.first_chunk()
    {
        return Ok(u32::from_le_bytes(*bytes));
    }
    Err(BlobError::Truncated {
        needed: place.saturating_add(4),
        found: blob.len(),
    })
}

/// The half word at a place of a blob, which another half follows.
pub(crate) const fn half(blob: &[u8], place: usize) -> Result<u16, BlobError> {
    Ok(proved!(word(blob, place)) as u16)
}
