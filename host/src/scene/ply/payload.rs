//! The elements of a PLY file. Those of a text file stand on a line each, as numbers that C's `strtod` reads.

use super::super::size::{MOST_PRIMITIVES, Size};
use super::super::text::Warnings;
use super::super::{SceneError, SourceSpan};
use crate::scene::error::{COPY_AGAIN, CauseAndRemedy};
use crate::table::{grouped, printable, shortened};
use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{
    ElementDef, Encoding, Header, Property, PropertyAccess, PropertyType, ScalarType,
};
use std::fmt;
use std::io::ErrorKind;
use std::ops::RangeInclusive;
use std::path::Path;
use std::str::SplitAsciiWhitespace;

/// An element that nothing is taken from.
pub(super) struct Skipped;

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Self
    }
}

/// The remedy of files that fit into no memory.
pub(super) const TOO_LARGE: &str = "export a part of the mesh, or one with fewer faces";
/// The number of binary elements that are read at once, before their size is checked.
const AT_ONCE: usize = 4096;
/// The most numbers of a list in a text file: of strips of a triangle each, as many as a scene holds.
const MOST_ENTRIES: usize = 4 * MOST_PRIMITIVES as usize;

/// The rest of a file behind what was read.
pub(super) struct Payload<'p> {
    path: &'p Path,
    /// The size of the scene up to what was read.
    pub(super) size: Size,
    encoding: Encoding,
    reader: Reader<&'p [u8]>,
    /// The next line of a text file, counted from 1.
    line: usize,
    /// The first line with numbers behind its last property, and how many such lines there are.
    surplus: Option<(usize, usize)>,
}

impl<'p> Payload<'p> {
    pub(super) fn new(path: &'p Path, encoding: Encoding, reader: Reader<&'p [u8]>) -> Self {
        Self {
            path,
            size: Size {
                objects: 1,
                ..Size::default()
            },
            encoding,
            line: reader.line(),
            reader,
            surplus: None,
        }
    }

    /// Reads all elements of a name, which come next. `triangles` returns how many one makes, or fewer.
    pub(super) fn read<E: PropertyAccess>(
        &mut self,
        element: &ElementDef,
        header: &Header,
        triangles: impl Fn(&E) -> usize,
    ) -> Result<Vec<E>, SceneError> {
        match self.encoding {
            Encoding::Ascii => self.text(element, triangles),
            _ => self.binary(element, header, triangles),
        }
    }

    /// Adds the triangles of elements, unless they are too many; the first has this number.
    fn weigh(
        &mut self,
        element: &ElementDef,
        triangles: impl Iterator<Item = usize>,
        first: usize,
    ) -> Result<(), SceneError> {
        for (triangles, number) in triangles.zip(first..) {
            self.size.triangles += triangles as u64;
            if let Some(excess) = self.size.excess() {
                let name = shortened(&element.name);
                let cause = format!("up to {name} {number} (from 0) the file takes {excess}");
                return Err(SceneError::new(self.path, cause, TOO_LARGE));
            }
        }
        Ok(())
    }

    /// Warns of the parts that were ignored.
    pub(super) fn warn(&self, warnings: &mut Warnings) {
        if let Some((line, count)) = self.surplus {
            let place = SourceSpan {
                line,
                ..SourceSpan::of(self.path)
            };
            let sentence = "numbers behind the last property of a line are ignored";
            warnings.add_times(place, count, sentence);
        }
        if !self.reader.get_ref().trim_ascii().is_empty() {
            let sentence = "data behind what the header announces is ignored";
            warnings.add_times(SourceSpan::of(self.path), 1, sentence);
        }
    }

    fn binary<E: PropertyAccess>(
        &mut self,
        element: &ElementDef,
        header: &Header,
        triangles: impl Fn(&E) -> usize,
    ) -> Result<Vec<E>, SceneError> {
        let mut elements = Vec::new();
        let mut few = element.clone();
        while elements.len() < element.count {
            let done = elements.len();
            few.count = AT_ONCE.min(element.count - done);
            let before = self.reader.line();
            let read = Parser::new().read_payload_for_element(&mut self.reader, &few, header);
            let read: Vec<E> = read.map_err(|error| {
                // The parser counts elements as lines.
                let number = error.line().map_or(0, |line| line.saturating_sub(before));
                self.broken(element, done + number, error.kind())
            })?;
            self.weigh(element, read.iter().map(&triangles), done)?;
            elements.extend(read);
        }
        Ok(elements)
    }

    /// The error of a binary element.
    fn broken(&self, element: &ElementDef, number: usize, kind: ErrorKind) -> SceneError {
        if kind == ErrorKind::UnexpectedEof {
            return self.ends_early(element, number);
        }
        let cause = format!(
            "a list of {} {number} (from 0) has a length that is not a whole number at or above 0",
            element.name
        );
        SceneError::new(self.path, cause, COPY_AGAIN)
    }

    fn ends_early(&self, element: &ElementDef, number: usize) -> SceneError {
        let cause = format!(
            "the file ends behind {number} of {} elements {:?}",
            element.count,
            shortened(&element.name)
        );
        SceneError::new(self.path, cause, COPY_AGAIN)
    }

    fn text<E: PropertyAccess>(
        &mut self,
        element: &ElementDef,
        triangles: impl Fn(&E) -> usize,
    ) -> Result<Vec<E>, SceneError> {
        let mut elements = Vec::new();
        for number in 0..element.count {
            let Some(line) = self.next_line() else {
                return Err(self.ends_early(element, number));
            };
            let text = String::from_utf8_lossy(line);
            let mut words = Words {
                rest: text.split_ascii_whitespace(),
                element: &element.name,
                number,
            };
            let read = words.element::<E>(element);
            let read = read.and_then(|it| Ok((it, words.count_rest()?)));
            let (read, more) = read.map_err(|CauseAndRemedy { cause, remedy }| {
                SceneError::new(self.path, cause, remedy).at_line(self.line)
            })?;
            self.weigh(element, [triangles(&read)].into_iter(), number)?;
            elements.push(read);
            if more > 0 {
                let (_, count) = self.surplus.get_or_insert((self.line, 0));
                *count += 1;
            }
            self.line += 1;
        }
        Ok(elements)
    }

    /// The next line of a text file; `None` at its end.
    fn next_line(&mut self) -> Option<&'p [u8]> {
        let rest = self.reader.get_mut();
        let end = rest.iter().position(|&byte| byte == b'\n');
        let (line, behind) = match end {
            Some(end) => (&rest[..end], &rest[end + 1..]),
            None => (*rest, &rest[rest.len()..]),
        };
        let is_line = !rest.is_empty();
        *rest = behind;
        is_line.then_some(line)
    }
}

/// The words of the line of an element.
struct Words<'w> {
    rest: SplitAsciiWhitespace<'w>,
    /// Name and number of the element.
    element: &'w str,
    number: usize,
}

/// A word that an error names.
#[derive(Clone, Copy)]
enum Word {
    Number,
    Length,
    Entry(usize),
}

/// A word of a property, such as `entry 2 (from 0) of vertex_indices of face 0 (from 0)`.
struct Named<'w>(Word, &'w str, &'w Words<'w>);

impl fmt::Display for Named<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(word, property, words) = self;
        match word {
            Word::Number => {}
            Word::Length => write!(f, "the length of ")?,
            Word::Entry(entry) => write!(f, "entry {entry} (from 0) of ")?,
        }
        let (element, number) = (shortened(words.element), words.number);
        write!(
            f,
            "{property:?} of {element} {number} (from 0)",
            property = shortened(property)
        )
    }
}

impl<'w> Words<'w> {
    fn element<E: PropertyAccess>(&mut self, element: &ElementDef) -> Result<E, CauseAndRemedy> {
        let mut read = E::new();
        for property in element.properties.values() {
            let name = &*property.name;
            let value = match &property.data_type {
                PropertyType::Scalar(kind) => {
                    let number = self.number(kind, Word::Number, name)?;
                    // Each number is of its type, so that none changes here.
                    match kind {
                        ScalarType::Char => Property::Char(number as i8),
                        ScalarType::UChar => Property::UChar(number as u8),
                        ScalarType::Short => Property::Short(number as i16),
                        ScalarType::UShort => Property::UShort(number as u16),
                        ScalarType::Int => Property::Int(number as i32),
                        ScalarType::UInt => Property::UInt(number as u32),
                        ScalarType::Float | ScalarType::Double => Property::Double(number),
                    }
                }
                PropertyType::List(_, kind) => self.list(kind, name)?,
            };
            // Values that do not fit were rejected with the header.
            read.set_property(name, value);
        }
        Ok(read)
    }

    /// Counts the numbers behind the last property.
    fn count_rest(&mut self) -> Result<usize, CauseAndRemedy> {
        let mut count = 0;
        for word in self.rest.by_ref() {
            if word.parse::<f64>().is_err() {
                let cause = format!("`{}` stands behind the last property", printable(word));
                let remedy = "write nothing but the numbers of the properties";
                return Err(CauseAndRemedy::new(cause, remedy));
            }
            count += 1;
        }
        Ok(count)
    }

    fn next(&mut self, word: Word, property: &str) -> Result<&'w str, CauseAndRemedy> {
        self.rest.next().ok_or_else(|| {
            CauseAndRemedy::new(
                format!("the line ends before {}", Named(word, property, self)),
                String::from("write all properties of an element on its line"),
            )
        })
    }

    /// The cause of a word that is wrong.
    fn wrong(&self, what: (Word, &str), found: &str, why: impl fmt::Display) -> String {
        let (word, property) = what;
        let what = Named(word, property, self);
        format!("{what} is `{}`{why}", printable(found))
    }

    fn number(
        &mut self,
        kind: &ScalarType,
        word: Word,
        property: &str,
    ) -> Result<f64, CauseAndRemedy> {
        let text = self.next(word, property)?;
        if let Some(range) = range(kind) {
            let value = text.parse::<i64>().ok().filter(|it| range.contains(it));
            return value.map(|it| it as f64).ok_or_else(|| {
                let (low, high) = range.into_inner();
                let why = format!("; the header announces a whole number from {low} to {high}");
                CauseAndRemedy::new(
                    self.wrong((word, property), text, why),
                    String::from("write such a number, or announce a type that holds it"),
                )
            });
        }
        let value = match kind {
            ScalarType::Float => text.parse::<f32>().ok().map(f64::from),
            _ => text.parse::<f64>().ok(),
        };
        let is_position = self.element == "vertex" && ["x", "y", "z"].contains(&property);
        let why = match value {
            Some(value) if value.is_finite() || !is_position => return Ok(value),
            Some(_) => ", which is not a finite number of the announced type",
            None => ", which is not a number",
        };
        Err(CauseAndRemedy::new(
            self.wrong((word, property), text, why),
            String::from("write a decimal number, such as 1.5 or -2e3"),
        ))
    }

    /// Reads a list: its length, and that many numbers of a type.
    fn list(&mut self, kind: &ScalarType, property: &str) -> Result<Property, CauseAndRemedy> {
        let text = self.next(Word::Length, property)?;
        let length = text.parse::<usize>().map_err(|_| {
            let why = ", which is not a whole number at or above 0";
            CauseAndRemedy::new(
                self.wrong((Word::Length, property), text, why),
                String::from("write how many numbers follow, and then these"),
            )
        })?;
        let entry = |entry| {
            if entry >= MOST_ENTRIES {
                let most = grouped(MOST_ENTRIES);
                let cause = format!("; at most {most} numbers are read");
                let cause = self.wrong((Word::Length, property), text, cause);
                return Err(CauseAndRemedy::new(cause, TOO_LARGE));
            }
            self.number(kind, Word::Entry(entry), property)
        };
        let entries = (0..length).map(entry);
        let is_signed = range(kind).map(|range| *range.start() < 0);
        // Each number is of its type, so that none changes here.
        Ok(match is_signed {
            Some(true) => {
                let entries = entries.map(|it| it.map(|it| it as i32));
                Property::ListInt(entries.collect::<Result<_, _>>()?)
            }
            Some(false) => {
                let entries = entries.map(|it| it.map(|it| it as u32));
                Property::ListUInt(entries.collect::<Result<_, _>>()?)
            }
            None => Property::ListDouble(entries.collect::<Result<_, _>>()?),
        })
    }
}

/// The whole numbers of a type; `None` for types of other numbers.
pub(super) fn range(kind: &ScalarType) -> Option<RangeInclusive<i64>> {
    let (low, high) = match kind {
        ScalarType::Char => (i8::MIN.into(), i8::MAX.into()),
        ScalarType::UChar => (0, u8::MAX.into()),
        ScalarType::Short => (i16::MIN.into(), i16::MAX.into()),
        ScalarType::UShort => (0, u16::MAX.into()),
        ScalarType::Int => (i32::MIN.into(), i32::MAX.into()),
        ScalarType::UInt => (0, u32::MAX.into()),
        ScalarType::Float | ScalarType::Double => return None,
    };
    Some(low..=high)
}
