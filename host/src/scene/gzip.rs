//! Gzipped files (RFC 1952), which are known by their first bytes, whatever their names are.

use super::SceneError;
use super::size::MOST_INPUT;
use crate::table::grouped;
use flate2::bufread::MultiGzDecoder;
use std::io::Read;
use std::path::Path;

/// Inflates a gzipped file; returns another as it is.
///
/// # Errors
/// If the file is damaged, or comes to more than [`MOST_INPUT`] bytes.
pub(super) fn inflate(path: &Path, bytes: Vec<u8>) -> Result<Vec<u8>, SceneError> {
    inflate_at_most(path, bytes, MOST_INPUT)
}

fn inflate_at_most(path: &Path, bytes: Vec<u8>, most: u64) -> Result<Vec<u8>, SceneError> {
    if !bytes.starts_with(&[0x1f, 0x8b]) {
        return Ok(bytes);
    }
    let mut inflated = Vec::new();
    // One byte more shows that a file is too long.
    let mut decoder = MultiGzDecoder::new(&bytes[..]).take(most + 1);
    decoder.read_to_end(&mut inflated).map_err(|error| {
        SceneError::new(
            path,
            format!("the gzipped file is damaged: {error}"),
            "copy the file again, as binary, or compress it again",
        )
    })?;
    if inflated.len() as u64 > most {
        return Err(SceneError::new(
            path,
            format!(
                "the gzipped file of {} bytes holds more than {} bytes",
                grouped(bytes.len()),
                grouped(most)
            ),
            "decompress it with `gunzip` if it is what it should be, and give that file",
        ));
    }
    Ok(inflated)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::test_scenes::gzipped;

    #[test]
    fn only_gzipped_bytes_change() {
        let path = Path::new("a.off");
        for bytes in [&b""[..], b"\x1f", b"OFF\n"] {
            assert_eq!(inflate(path, bytes.to_vec()).unwrap(), bytes);
            assert_eq!(inflate(path, gzipped(bytes)).unwrap(), bytes);
        }
        let two = [gzipped(b"one, "), gzipped(b"two")].concat();
        assert_eq!(inflate(path, two).unwrap(), b"one, two");
    }

    #[test]
    fn a_file_as_long_as_the_limit_passes_and_a_longer_one_is_rejected() {
        let path = Path::new("a.off.gz");
        let bytes = gzipped(&[b' '; 1000]);
        assert_eq!(
            inflate_at_most(path, bytes.clone(), 1000).unwrap().len(),
            1000
        );
        let error = inflate_at_most(path, bytes.clone(), 999).unwrap_err();
        assert_eq!(
            error.to_string(),
            format!(
                "a.off.gz: the gzipped file of {} bytes holds more than 999 bytes",
                bytes.len()
            )
        );
    }

    #[test]
    fn damaged_files_are_rejected_wherever_they_are_cut_or_changed() {
        let path = Path::new("a.off.gz");
        let whole = gzipped(b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
        for end in 2..whole.len() {
            let error = inflate(path, whole[..end].to_vec()).unwrap_err();
            assert!(
                error.cause.starts_with("the gzipped file is damaged: "),
                "{error}"
            );
        }
        // The checksum and the length stand at the end.
        for place in whole.len() - 8..whole.len() {
            let mut bytes = whole.clone();
            bytes[place] ^= 1;
            assert!(inflate(path, bytes).is_err(), "{place}");
        }
    }
}
