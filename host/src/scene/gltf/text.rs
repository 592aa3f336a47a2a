//! The JSON text of a glTF file before it is parsed: its memory, and the extensions that it uses.

use crate::scene::SceneError;
use crate::scene::size::MOST_BYTES;
use crate::table::grouped;
use std::collections::BTreeSet;
use std::path::Path;

/// Bytes that an object of JSON takes at most while it is parsed: a material, while the list of them grows.
const OBJECT: u64 = 2600;
/// Bytes of a list, and of a value, when they are parsed twice.
const LIST: u64 = 600;
const VALUE: u64 = 200;
/// Copies of the text: the file, its strings, and what they hold as base64.
const TEXT: u64 = 3;

/// The counts of a text's elements, and the names of their extensions.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Counts<'t> {
    objects: u64,
    lists: u64,
    values: u64,
    bytes: u64,
    /// The names of extensions that elements have.
    pub(super) extensions: BTreeSet<&'t [u8]>,
}

/// The most names of extensions that are kept.
const MOST_NAMES: usize = 100;

impl<'t> Counts<'t> {
    /// Counts in one pass, whether the text is valid or not.
    pub(super) fn of(text: &'t [u8]) -> Self {
        let mut counts = Self {
            bytes: text.len() as u64,
            ..Self::default()
        };
        // For each object or list that is open, whether it holds extensions. Deeper ones are not valid.
        let mut open: Vec<bool> = Vec::new();
        let (mut string, mut key): (&[u8], &[u8]) = (b"", b"");
        let mut at = 0;
        while let Some(&byte) = text.get(at) {
            at += 1;
            match byte {
                b'"' => {
                    let rest = &text[at..];
                    let length = length_of_string(rest);
                    string = &rest[..length];
                    at += length + 1;
                }
                b':' => {
                    key = string;
                    let is_new = open.last() == Some(&true) && !counts.extensions.contains(key);
                    if is_new && counts.extensions.len() < MOST_NAMES {
                        counts.extensions.insert(key);
                    }
                }
                b'{' => {
                    counts.objects += 1;
                    if open.len() < 1000 {
                        open.push(key == b"extensions");
                    }
                    key = b"";
                }
                b'[' => {
                    counts.lists += 1;
                    if open.len() < 1000 {
                        open.push(false);
                    }
                    key = b"";
                }
                b'}' | b']' => {
                    open.pop();
                }
                b',' => counts.values += 1,
                _ => {}
            }
        }
        counts
    }

    /// Rejects a text that takes too much memory.
    pub(super) fn check(&self, path: &Path) -> Result<(), SceneError> {
        let of = [
            (self.objects, OBJECT),
            (self.lists, LIST),
            (self.values, VALUE),
            (self.bytes, TEXT),
        ];
        let bytes: u64 = of
            .iter()
            .map(|(count, each)| count.saturating_mul(*each))
            .sum();
        if bytes <= MOST_BYTES {
            return Ok(());
        }
        let cause = format!(
            "the JSON of {} bytes takes too much memory: it has {} objects, {} lists and {} values behind a comma",
            grouped(self.bytes),
            grouped(self.objects),
            grouped(self.lists),
            grouped(self.values)
        );
        let remedy = "export a part of the scene, or move buffers into files of their own";
        Err(SceneError::new(path, cause, remedy))
    }
}

/// The length of a string up to its closing quote, or the end.
fn length_of_string(text: &[u8]) -> usize {
    let mut at = 0;
    while let Some(&byte) = text.get(at) {
        match byte {
            b'"' => return at,
            b'\\' => at += 2,
            _ => at += 1,
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_extensions_are_keys_of_their_objects_alone() {
        let text = br#"{"a": ["extensions", {"extensions": {"KHR_a": {"x": {"y": 1}, "extensions": {"KHR_b": {}}}, "KHR_c": [1, {"z": 2}]}, "w": 3}], "extensions": 4, "q": "\"extensions\": {\"no\": 1}"}"#;
        let counts = Counts::of(text);
        let names: Vec<_> = counts
            .extensions
            .iter()
            .map(|it| str::from_utf8(it).unwrap())
            .collect();
        assert_eq!(names, ["KHR_a", "KHR_b", "KHR_c"]);
        assert_eq!((counts.objects, counts.lists), (8, 2));
    }

    #[test]
    fn texts_of_too_many_values_are_rejected_before_they_are_parsed() {
        let path = Path::new("a.gltf");
        let check = |part: &[u8], times: usize| Counts::of(&part.repeat(times)).check(path);
        assert!(check(b"{},", 1_000_000).is_ok());
        assert!(check(b"{},", 2_000_000).is_err());
        assert!(check(b"[],", 4_000_000).is_ok());
        assert!(check(b"[],", 7_000_000).is_err());
        assert!(check(b"0,", 20_000_000).is_err());
        // A buffer of 300 MB as base64.
        let buffer = [&b"{\"uri\": \""[..], &b"A".repeat(400_000_000), b"\"}"].concat();
        assert!(Counts::of(&buffer).check(path).is_ok());
    }

    #[test]
    fn the_largest_elements_take_what_is_counted() {
        use gltf::json;
        let sizes = [
            size_of::<json::Material>(),
            size_of::<json::Node>(),
            size_of::<json::Accessor>(),
            size_of::<json::mesh::Primitive>(),
            size_of::<json::Animation>(),
            size_of::<json::Camera>(),
            size_of::<json::Image>(),
        ];
        // While a list grows, it takes its bytes three times.
        assert!(
            sizes.iter().all(|size| 3 * *size as u64 <= OBJECT),
            "{sizes:?}"
        );
    }
}
