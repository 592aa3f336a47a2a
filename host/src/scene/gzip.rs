//! Gzipped files (RFC 1952), recognized by their first bytes, not by their names.

use super::SceneError;
use super::size::MOST_INPUT;
use crate::table::grouped;
use flate2::bufread::GzDecoder;
use std::io::{Error, Read};
use std::path::Path;

/// The first bytes of a member; a file is one member or several, one behind the other.
const MAGIC: [u8; 2] = [0x1f, 0x8b];

/// Inflates a gzipped file; returns another as it is.
///
/// Zeros may follow the last member: media with blocks of one size pad files so.
///
/// # Errors
/// If the file is damaged, comes to more than [`MOST_INPUT`] bytes, or has other bytes than zeros
/// behind the last member. Also if it is gzipped twice.
pub(super) fn inflate(path: &Path, bytes: Vec<u8>) -> Result<Vec<u8>, SceneError> {
    inflate_at_most(path, bytes, MOST_INPUT)
}

fn inflate_at_most(path: &Path, bytes: Vec<u8>, most: u64) -> Result<Vec<u8>, SceneError> {
    if !bytes.starts_with(&MAGIC) {
        return Ok(bytes);
    }
    let damaged = |error: Error| {
        SceneError::new(
            path,
            format!("the gzipped file is damaged: {error}"),
            "copy the file again, as binary, or compress it again",
        )
    };
    let mut inflated = Vec::new();
    let mut rest = &bytes[..];
    while rest.starts_with(&MAGIC) {
        // One byte more shows that a file is too long.
        let left = most + 1 - inflated.len() as u64;
        let mut member = GzDecoder::new(rest).take(left);
        member.read_to_end(&mut inflated).map_err(damaged)?;
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
        rest = member.into_inner().into_inner();
    }
    if rest.iter().any(|&byte| byte != 0) {
        return Err(SceneError::new(
            path,
            format!(
                "the gzipped content ends at byte {} of {}, and other data follows it",
                grouped(bytes.len() - rest.len()),
                grouped(bytes.len())
            ),
            "compress the file again, or cut it off there; only zeros may follow",
        ));
    }
    if inflated.starts_with(&MAGIC) {
        return Err(SceneError::new(
            path,
            "the gzipped file holds another gzipped file",
            "decompress it once with `gunzip`, and give that file",
        ));
    }
    Ok(inflated)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::tests::samples::gzipped;

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
    fn zeros_may_follow_the_last_member_and_other_bytes_may_not() {
        let path = Path::new("a.off.gz");
        for members in [
            vec![gzipped(b"one")],
            vec![gzipped(b"o"), gzipped(b""), gzipped(b"ne")],
        ] {
            let whole = members.concat();
            for zeros in [1, 2, 9, 10, 600] {
                let padded = [&whole[..], &vec![0; zeros]].concat();
                assert_eq!(inflate(path, padded).unwrap(), b"one", "{zeros}");
            }
            let behind_zeros = [&[0; 9][..], &gzipped(b"two")].concat();
            for behind in [
                &b"x"[..],
                b"\x1f",
                b"\x1f\0",
                b"\0\x1f",
                b"OFF\n0 0 0\n",
                &behind_zeros,
            ] {
                let bytes = [&whole[..], behind].concat();
                let (end, length) = (whole.len(), bytes.len());
                let error = inflate(path, bytes).unwrap_err();
                assert_eq!(
                    error.to_string(),
                    format!(
                        "a.off.gz: the gzipped content ends at byte {end} of {length}, and other \
                         data follows it"
                    )
                );
                assert!(error.remedy.contains("only zeros"), "{}", error.remedy);
            }
            // Data that begins as a member must be one.
            let error = inflate(path, [&whole[..], b"\x1f\x8b\x08"].concat()).unwrap_err();
            assert!(error.cause.contains("is damaged"), "{error}");
        }
    }

    #[test]
    fn files_that_are_gzipped_twice_are_named() {
        let path = Path::new("a.off.gz");
        let error = inflate(path, gzipped(&gzipped(b"OFF\n"))).unwrap_err();
        assert!(error.cause.contains("another gzipped file"), "{error}");
        assert!(error.remedy.contains("gunzip"), "{}", error.remedy);
    }

    #[test]
    fn limit_counts_all_members() {
        let path = Path::new("a.off.gz");
        let two = [gzipped(&[b' '; 600]), gzipped(&[b' '; 400])].concat();
        assert_eq!(
            inflate_at_most(path, two.clone(), 1000).unwrap().len(),
            1000
        );
        assert!(inflate_at_most(path, two.clone(), 999).is_err());
        assert!(inflate_at_most(path, two, 599).is_err());
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
