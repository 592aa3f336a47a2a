//! Words of a blob, read at compile time.

use crate::format::error::BlobError;

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
