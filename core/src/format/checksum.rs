//! The checksum of a blob, and its alignment.

use crate::format::record::Header;

/// Returns the checksum of a blob: FNV-1a over its 32-bit words. The word of the checksum itself counts as 0.
///
/// Every step is a bijection of the state, so the checksum detects a change of any single word.
///
/// ```
/// # static BLOB: &[u8] =
/// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
/// use gridel_core::format::checksum;
///
/// let scene = gridel_core::Scene::from_bytes(BLOB)?;
/// assert_eq!(checksum(BLOB), scene.header().checksum);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub const fn checksum(blob: &[u8]) -> u32 {
    const OWN_WORD: usize = core::mem::offset_of!(Header, checksum) / 4;
    const fn mix(state: u32, word: u32) -> u32 {
        (state ^ word).wrapping_mul(0x0100_0193)
    }
    let mut state: u32 = 0x811c_9dc5;
    let (mut words, mut rest) = blob.as_chunks();
    let mut before = 0;
    while let [word, after @ ..] = words {
        let own = before == OWN_WORD;
        state = mix(state, if own { 0 } else { u32::from_le_bytes(*word) });
        before = before.wrapping_add(1);
        words = after;
    }
    if !rest.is_empty() {
        // The last bytes, padded with zeros to a word.
        let mut word = 0;
        while let [before @ .., byte] = rest {
            word = word << 8 | *byte as u32;
            rest = before;
        }
        state = mix(state, word);
    }
    state
}

/// Bytes with the alignment of a blob. [`include_blob!`](crate::include_blob) returns them.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(4))]
pub struct Aligned<T: ?Sized>(pub T);

/// Embeds a blob file with the alignment that [`Scene::from_bytes`](crate::Scene::from_bytes) requires.
///
/// ```
/// # macro_rules! scene { () => { concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel") } }
/// static BLOB: &[u8] = gridel_core::include_blob!(scene!());
///
/// assert!(BLOB.as_ptr().addr().is_multiple_of(4));
/// ```
#[macro_export]
macro_rules! include_blob {
    ($path:expr) => {{
        const BYTES: &[u8] = include_bytes!($path);
        static ALIGNED: $crate::Aligned<[u8; BYTES.len()]> =
            $crate::Aligned(*include_bytes!($path));
        &ALIGNED.0 as &'static [u8]
    }};
}
