//! Names of objects, materials and lights: an optional part of a blob that no query reads.

use crate::format::limits::MAX_NAME_BYTES;
use crate::format::range::At;
use crate::format::{BlobError, Field, Indices, Reason, SectionKind, Sections};
use crate::scene::read::header;

/// Names of the objects, materials and lights of a blob, read in place.
///
/// [`Scene::from_bytes`](crate::Scene::from_bytes) ignores them, so a program that does not use names costs only the
/// bytes of their sections. Names need not differ, and hold any characters. Code that prints them must escape control
/// characters.
///
/// ```
/// # fn print_hit(blob: &[u8], object: u32) -> Result<(), gridel_core::BlobError> {
/// let names = gridel_core::Names::from_bytes(blob)?;
/// match names.object(object) {
///     "" => println!("hit object {object}"),
///     name => println!("hit {}", name.escape_debug()),
/// }
/// # Ok(())
/// # }
/// # print_hit(&[], 0).unwrap_err();
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Names<'a> {
    /// The start of each name, then the end of the last one.
    starts: Indices<'a>,
    text: &'a str,
    objects: usize,
    materials: usize,
}

impl<'a> Names<'a> {
    /// Returns the names of a blob. Without names in the blob, all of them are empty.
    ///
    /// Cost: linear in the length of the names.
    ///
    /// # Errors
    /// If the header or the section table is invalid, or there are too few or too many names. Also if a name is longer
    /// than 255 bytes, or one is not UTF-8.
    pub fn from_bytes(blob: &'a [u8]) -> Result<Self, BlobError> {
        let header = header(blob)?;
        let sections = Sections::read(blob, header.section_count)?;
        let starts = Indices::read(&sections, SectionKind::NameStarts)?;
        let bytes: &[u8] = sections.records(SectionKind::NameText)?;
        let objects = header.objects as usize;
        let materials = sections.len(SectionKind::Materials);
        if !(starts.is_empty() && bytes.is_empty()) {
            let others = materials.saturating_add(sections.len(SectionKind::Lights));
            let expected = objects.saturating_add(others).saturating_add(1);
            if starts.len() != expected {
                return Err(BlobError::Count {
                    section: SectionKind::NameStarts,
                    found: starts.len(),
                    expected,
                });
            }
        }
        let text = text(bytes)?;
        check(&starts, text)?;
        Ok(Self {
            starts,
            text,
            objects,
            materials,
        })
    }

    /// Returns true if the blob has no names.
    pub fn is_empty(&self) -> bool {
        self.starts.is_empty()
    }

    /// Returns the name of an object; empty for one without a name, and beyond the last object.
    pub fn object(&self, object: u32) -> &'a str {
        let inside = Some(object as usize).filter(|&object| object < self.objects);
        inside.map_or("", |object| self.name(object))
    }

    /// Returns the name of a material, by its number in the blob; empty for one without a name, and beyond the
    /// last material.
    pub fn material(&self, material: u32) -> &'a str {
        let inside = Some(material as usize).filter(|&material| material < self.materials);
        inside.map_or("", |material| {
            self.name(self.objects.saturating_add(material))
        })
    }

    /// Returns the name of a light; empty for one without a name, and beyond the last light.
    pub fn light(&self, light: u32) -> &'a str {
        let before = self.objects.saturating_add(self.materials);
        self.name(before.saturating_add(light as usize))
    }

    fn name(&self, index: usize) -> &'a str {
        let start = |index| self.starts.get(index).map(|start| start as usize);
        let range = start(index).zip(start(index.saturating_add(1)));
        let name = range.and_then(|(start, end)| self.text.get(start..end));
        name.unwrap_or_default()
    }
}

/// The text of all names.
fn text(bytes: &[u8]) -> Result<&str, BlobError> {
    core::str::from_utf8(bytes).or_else(|error| {
        let at = At {
            section: SectionKind::NameText,
            index: error.valid_up_to(),
        };
        at.ensure(false, Reason::NotUtf8)?;
        Ok("")
    })
}

/// Proves that names follow each other, fill the whole text, and are not too long.
fn check(starts: &Indices<'_>, text: &str) -> Result<(), BlobError> {
    let mut last = 0;
    for index in 0..starts.len() {
        let section = SectionKind::NameStarts;
        let at = At { section, index };
        let start = i64::from(starts.get(index).unwrap_or_default());
        let is_last = starts.len() == index.saturating_add(1);
        let length = text.len() as i64;
        // The start of the first name must be 0, and the end of the last one the length of the text.
        let low = if is_last { length } else { last };
        let longest = if index == 0 { 0 } else { MAX_NAME_BYTES as i64 };
        let high = length.min(last.saturating_add(longest));
        at.within(Field::NameStart, start, low, high)?;
        at.ensure(
            text.is_char_boundary(start as usize),
            Reason::InsideCharacter,
        )?;
        last = start;
    }
    Ok(())
}
