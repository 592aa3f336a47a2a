//! The lines of an OBJ file: vertices, and parts of faces that share a name and a material.

use super::lines::{MOST_WORDS, NUMBERS, WholeLines};
use crate::scene::size::{Size, lists_fit};
use crate::scene::text::{Source, Warnings};
use crate::scene::{Color, SceneError};
use crate::srgb::linear_of_srgb;
use crate::table::{grouped, shortened};
use glam::{DVec2, DVec3};

#[derive(Default)]
pub(super) struct Parsed<'a> {
    pub(super) vertices: Vec<DVec3>,
    /// Normals of any length.
    pub(super) normals: Vec<DVec3>,
    /// Linear; empty, or one for each vertex.
    pub(super) colors: Vec<Color>,
    /// Texture coordinates, v upwards.
    pub(super) coordinates: Vec<DVec2>,
    /// In file order; each has at least one face.
    pub(super) parts: Vec<Part<'a>>,
    /// The text behind each `mtllib`, with its line.
    pub(super) libraries: Vec<(usize, &'a str)>,
    /// The first few kinds of lines that may have been meant as faces and are not.
    pub(super) skipped: Vec<Skipped>,
}

/// Lines that are passed over.
pub(super) struct Skipped {
    pub(super) sentence: String,
    /// The first of them.
    pub(super) line: usize,
    /// The number of further ones.
    pub(super) more: usize,
}

/// Most kinds of lines that an error lists.
const MOST_SKIPPED: usize = 4;

/// Faces in a row that belong to one object and have one material.
pub(super) struct Part<'a> {
    /// The name from `o` or `g`; empty without either.
    pub(super) name: &'a str,
    pub(super) material: Option<&'a str>,
    /// The line of its first face.
    pub(super) line: usize,
    pub(super) faces: Vec<Face>,
    /// Vertex indices of all faces, one after the other.
    pub(super) corners: Vec<u32>,
    /// The normals of the corners, likewise; [`NO_INDEX`] where a corner has none. Empty where no face has any.
    pub(super) normals: Vec<u32>,
    /// The texture coordinates of the corners, likewise.
    pub(super) coordinates: Vec<u32>,
}

/// Stands for the normal, or the texture coordinates, of a corner that has none.
pub(super) const NO_INDEX: u32 = u32::MAX;
/// Stands for a normal, or texture coordinates, that the file cannot have.
const OUT_OF_RANGE: u32 = NO_INDEX - 1;

pub(super) struct Face {
    pub(super) line: usize,
    /// Number of corners, at least 3.
    pub(super) corners: usize,
}

/// Bytes of a vertex: its position, its color, and its number in a mesh.
const VERTEX: usize = size_of::<DVec3>() + size_of::<Color>() + size_of::<(usize, u32)>();

/// Statements about parts that are not drawn, or not needed to draw.
const PASSED_OVER: [&str; 7] = ["vp", "mg", "bevel", "c_interp", "d_interp", "lod", "maplib"];

/// Reads all lines; `continued` are the [continued](super::lines::continued) ones of the file.
///
/// # Errors
/// If a vertex is not finite, or a face names a vertex that does not exist.
pub(super) fn parse<'a>(
    source: &'a Source,
    continued: &'a [String],
    warnings: &mut Warnings,
) -> Result<Parsed<'a>, SceneError> {
    let mut parser = Parser {
        source,
        parsed: Parsed::default(),
        name: "",
        material: None,
        fresh: true,
        highest: None,
        smoothing: None,
        size: Size::default(),
    };
    let mut continued = continued.iter();
    let mut words: Vec<&str> = Vec::new();
    for (number, line, parts) in WholeLines(source.lines()) {
        words.clear();
        let all = parts.iter().flat_map(|part| part.split_whitespace());
        words.extend(all.take(MOST_WORDS + 1));
        if words.len() > MOST_WORDS || parts.len() > MOST_WORDS {
            let cause = format!("the line has more than {} words", grouped(MOST_WORDS));
            let remedy = "split it, or export a part of the scene";
            return Err(source.error(cause, remedy).at_line(number));
        }
        // A comment may follow numbers, also without a space; in names a number sign is common.
        let is_of_numbers = words.first().is_some_and(|word| NUMBERS.contains(word));
        if is_of_numbers && parts.iter().any(|part| part.contains('#')) {
            // `1.#IND` and the like are what old programs write in place of NaN.
            let is_comment = |word: &&str| {
                let parts = word.split_once('#');
                parts.is_some_and(|(number, _)| !number.ends_with('.'))
            };
            let end = words.iter().position(is_comment);
            let last = end.and_then(|end| words[end].split('#').next());
            words.truncate(end.unwrap_or(words.len()));
            words.extend(last.filter(|it| !it.is_empty()));
        }
        match words.first() {
            Some(&"v") => parser.vertex(number, line, &words[1..], warnings)?,
            Some(&"vt") => parser.texture_vertex(line, &words[1..])?,
            Some(&"vn") => parser.normal(number, line, &words[1..], warnings)?,
            Some(&"f") => parser.face(number, &words[1..], warnings)?,
            _ if parts.len() > 1 => {
                let whole = continued.next().map_or(line, |it| it.as_str());
                parser.statement(number, whole.trim(), warnings);
            }
            _ => parser.statement(number, line, warnings),
        }
    }
    parser.finish(warnings)
}

/// Returns whether this many vertices, normals and texture coordinates fit into memory.
pub(super) fn fit([vertices, normals, coordinates]: [usize; 3]) -> bool {
    lists_fit(&[
        (vertices, VERTEX),
        (normals, size_of::<DVec3>()),
        (coordinates, size_of::<DVec2>()),
    ])
}

struct Parser<'a> {
    source: &'a Source,
    parsed: Parsed<'a>,
    name: &'a str,
    material: Option<&'a str>,
    /// True if the next face starts a part.
    fresh: bool,
    /// The highest index of a face and its word; it may point ahead to vertices not yet read.
    highest: Option<(u64, &'a str)>,
    /// The first smoothing group.
    smoothing: Option<usize>,
    /// The size of the scene up to the last face.
    size: Size,
}

impl<'a> Parser<'a> {
    fn vertex(
        &mut self,
        number: usize,
        line: &'a str,
        words: &[&'a str],
        warnings: &mut Warnings,
    ) -> Result<(), SceneError> {
        if words.len() < 3 {
            return Err(self.source.error_at(
                line,
                format!("a vertex has {} of 3 coordinates", words.len()),
                "write `v x y z`",
            ));
        }
        let mut position = [0.0; 3];
        for (axis, value) in position.iter_mut().enumerate() {
            *value = self.source.number(
                words[axis],
                &format!("the {} coordinate of a vertex", ["x", "y", "z"][axis]),
            )?;
        }
        // The rest can be a weight, which only curved surfaces use, or a color.
        let mut rest = Vec::with_capacity(words.len() - 3);
        for word in &words[3..] {
            rest.push(
                self.source
                    .number(word, "what follows the coordinates of a vertex")?,
            );
        }
        if !matches!(rest.len(), 0 | 1 | 3) {
            let sentence = match rest.len() {
                2 => "2 numbers behind the coordinates of a vertex are ignored; a color has 3",
                _ => {
                    "of more than 3 numbers behind the coordinates of a vertex, the last 3 are taken as its color"
                }
            };
            warnings.add(self.source, number, sentence);
        }
        let count = self.parsed.vertices.len();
        if let [.., red, green, blue] = rest[..] {
            if count > 0 && self.parsed.colors.is_empty() {
                let sentence = "vertices before the first with a color are white";
                warnings.add(self.source, number, sentence);
            }
            if [red, green, blue]
                .iter()
                .any(|it| !(0.0..=1.0).contains(it))
            {
                let sentence = "a color of a vertex is limited to 0 to 1, its range";
                warnings.add(self.source, number, sentence);
            }
            let linear = |channel: f64| linear_of_srgb(channel.clamp(0.0, 1.0));
            self.parsed.colors.resize(count, [1.0; 3]);
            self.parsed.colors.push([red, green, blue].map(linear));
        } else if !self.parsed.colors.is_empty() {
            let sentence = "a vertex without a color, behind others with one, is white";
            warnings.add(self.source, number, sentence);
            self.parsed.colors.push([1.0; 3]);
        }
        self.parsed.vertices.push(DVec3::from_array(position));
        self.check_lists(line)
    }

    /// Rejects more vertices, normals and texture coordinates than fit into memory. Faces may use none of them.
    fn check_lists(&self, line: &str) -> Result<(), SceneError> {
        let Parsed {
            vertices,
            normals,
            coordinates,
            ..
        } = &self.parsed;
        let counts = [vertices.len(), normals.len(), coordinates.len()];
        if fit(counts) {
            return Ok(());
        }
        let [vertices, normals, coordinates] = counts.map(grouped);
        let cause = format!(
            "up to this line there are {vertices} vertices, {normals} normals and {coordinates} texture coordinates, \
             more than fit into memory"
        );
        let remedy = "export a part of the scene, or leave normals or texture coordinates out";
        Err(self.source.error_at(line, cause, remedy))
    }

    fn texture_vertex(&mut self, line: &'a str, words: &[&'a str]) -> Result<(), SceneError> {
        let &[u, ..] = words else {
            return Err(self.source.error_at(
                line,
                "texture coordinates are missing",
                "write `vt u v`",
            ));
        };
        let mut coordinates = [0.0; 2];
        for (value, word) in coordinates.iter_mut().zip([Some(&u), words.get(1)]) {
            let number = word.map(|word| self.source.number(word, "a texture coordinate"));
            *value = number.transpose()?.unwrap_or(0.0);
        }
        self.parsed.coordinates.push(DVec2::from_array(coordinates));
        self.check_lists(line)
    }

    fn normal(
        &mut self,
        number: usize,
        line: &'a str,
        words: &[&'a str],
        warnings: &mut Warnings,
    ) -> Result<(), SceneError> {
        let &[x, y, z, ..] = words else {
            return Err(self.source.error_at(
                line,
                format!("a normal has {} of 3 components", words.len()),
                "write `vn x y z`",
            ));
        };
        let mut normal = [0.0; 3];
        for (value, word) in normal.iter_mut().zip([x, y, z]) {
            *value = self.source.number(word, "a component of a normal")?;
        }
        if normal == [0.0; 3] {
            let sentence = "a normal is 0 0 0; faces that have it are shaded flat";
            warnings.add(self.source, number, sentence);
        }
        self.parsed.normals.push(DVec3::from_array(normal));
        self.check_lists(line)
    }

    fn face(
        &mut self,
        line: usize,
        words: &[&'a str],
        warnings: &mut Warnings,
    ) -> Result<(), SceneError> {
        let mut corners = Vec::with_capacity(words.len());
        let mut normals = Vec::new();
        let mut coordinates = Vec::new();
        for word in words {
            let mut indices = word.split('/');
            corners.push(self.corner(word, indices.next().unwrap_or(""))?);
            let mut next = |count: usize, what: &str| match indices.next() {
                None | Some("") => Ok(NO_INDEX),
                Some(index) => self.number_of([word, index], count, what),
            };
            coordinates.push(next(self.parsed.coordinates.len(), "texture coordinate")?);
            normals.push(next(self.parsed.normals.len(), "normal")?);
            if indices.next().is_some() {
                return Err(self.source.error_at(
                    word,
                    format!(
                        "a face has the vertex {quoted:?}, which has more than three indices",
                        quoted = shortened(word)
                    ),
                    "write `f` and vertices as `position/texture/normal`",
                ));
            }
        }
        if corners.len() < 3 {
            let sentence = format!(
                "a face of {} vertices has no surface and is skipped",
                corners.len()
            );
            self.skip(line, &sentence, warnings);
            return Ok(());
        }
        self.weigh(line, corners.len() - 2)?;
        if self.fresh {
            self.parsed.parts.push(Part {
                name: self.name,
                material: self.material,
                line,
                faces: Vec::new(),
                corners: Vec::new(),
                normals: Vec::new(),
                coordinates: Vec::new(),
            });
            self.fresh = false;
        }
        if let Some(part) = self.parsed.parts.last_mut() {
            part.faces.push(Face {
                line,
                corners: corners.len(),
            });
            if !part.normals.is_empty() || normals.iter().any(|it| *it != NO_INDEX) {
                part.normals.resize(part.corners.len(), NO_INDEX);
                part.normals.extend(normals);
            }
            if !part.coordinates.is_empty() || coordinates.iter().any(|it| *it != NO_INDEX) {
                part.coordinates.resize(part.corners.len(), NO_INDEX);
                part.coordinates.extend(coordinates);
            }
            part.corners.extend(corners);
        }
        Ok(())
    }

    /// Rejects a face at which the scene no longer fits into memory, or parts that repeat a long name until it does not.
    fn weigh(&mut self, line: usize, triangles: usize) -> Result<(), SceneError> {
        if self.fresh {
            self.size.objects += 1;
            self.size.names += self.name.len() as u64;
        }
        self.size.triangles += triangles as u64;
        let Some(excess) = self.size.excess() else {
            return Ok(());
        };
        let cause = format!("up to this face the file takes {excess}");
        let remedy = "give objects and groups shorter names, or export a part of the scene";
        Err(self.source.error(cause, remedy).at_line(line))
    }

    /// Warns of a line that is passed over.
    fn skip(&mut self, line: usize, sentence: &str, warnings: &mut Warnings) {
        warnings.add(self.source, line, sentence);
        let skipped = &mut self.parsed.skipped;
        if let Some(same) = skipped.iter_mut().find(|it| it.sentence == sentence) {
            same.more += 1;
        } else if skipped.len() < MOST_SKIPPED {
            skipped.push(Skipped {
                sentence: sentence.to_owned(),
                line,
                more: 0,
            });
        }
    }

    /// Reads the position of `position/texture/normal` as an index counted from 0.
    fn corner(&mut self, word: &'a str, index: &str) -> Result<u32, SceneError> {
        let remedy = "vertices are counted from 1, or backwards from -1";
        let count = self.parsed.vertices.len();
        let fault = |cause: String| Err(self.source.error_at(word, cause, remedy));
        match index.parse::<i64>() {
            Err(_) => fault(format!(
                "a face has the vertex {word:?}, which is not an index",
                word = shortened(word)
            )),
            Ok(0) => fault("a face has the vertex index 0".to_owned()),
            Ok(index) if index < 0 && index.unsigned_abs() > count as u64 => fault(format!(
                "a face has the vertex index {index}, but only {count} vertices come before it"
            )),
            Ok(index) if index < 0 => Ok((count as u64 - index.unsigned_abs()) as u32),
            Ok(index) => {
                let index = index.unsigned_abs();
                if self.highest.is_none_or(|(highest, _)| index > highest) {
                    self.highest = Some((index, word));
                }
                // Where this wraps, the highest index is an error.
                Ok((index - 1) as u32)
            }
        }
    }

    /// Reads the index of a normal or of texture coordinates, `what`, of a corner. Returns it counted from 0; `count` is
    /// how many the file has so far. Returns [`OUT_OF_RANGE`] for an index that is out of range.
    fn number_of(
        &self,
        [word, index]: [&str; 2],
        count: usize,
        what: &str,
    ) -> Result<u32, SceneError> {
        let index = index.parse::<i64>().map_err(|_| {
            let cause = format!(
                "a face has the vertex {quoted:?}, whose {what} is not an index",
                quoted = shortened(word)
            );
            let remedy = "normals and texture coordinates are counted from 1, or backwards from -1";
            self.source.error_at(word, cause, remedy)
        })?;
        let index = match index {
            0 => None,
            index if index < 0 => Some(count as i64 + index),
            index => Some(index - 1),
        };
        let index = index.and_then(|it| u32::try_from(it).ok());
        Ok(index.map_or(OUT_OF_RANGE, |it| it.min(OUT_OF_RANGE)))
    }

    fn statement(&mut self, number: usize, line: &'a str, warnings: &mut Warnings) {
        let (keyword, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        let rest = rest.trim();
        match keyword {
            "o" | "g" => {
                self.name = rest;
                self.fresh = true;
            }
            "usemtl" => {
                let material = (!rest.is_empty()).then_some(rest);
                self.fresh |= material != self.material;
                self.material = material;
            }
            "mtllib" => self.parsed.libraries.push((number, rest)),
            "l" | "p" => {
                let sentence = "points and lines have no surface and are skipped";
                self.skip(number, sentence, warnings);
            }
            "s" if !["", "0", "off"].contains(&rest) => {
                self.smoothing.get_or_insert(number);
            }
            "usemap" if !["", "off"].contains(&rest) => warnings.add(
                self.source,
                number,
                "the texture of `usemap` is not drawn; name its image in the MTL file, by `map_Kd`",
            ),
            "" | "s" | "usemap" => {}
            "call" | "csh" => {
                let sentence =
                    format!("what `{keyword}` brings, from a file or a program, is not read");
                self.skip(number, &sentence, warnings);
            }
            _ if keyword.starts_with('#') || PASSED_OVER.contains(&keyword) => {}
            _ => {
                let sentence = format!(
                    "the statement {keyword:?} is unknown or about curves, and ignored",
                    keyword = shortened(keyword)
                );
                self.skip(number, &sentence, warnings);
            }
        }
    }

    fn finish(self, warnings: &mut Warnings) -> Result<Parsed<'a>, SceneError> {
        let count = self.parsed.vertices.len();
        if let Some((index, word)) = self.highest.filter(|(index, _)| *index > count as u64) {
            return Err(self.source.error_at(
                word,
                format!("a face has the vertex index {index}, but the file has {count} vertices"),
                "correct the index, or check that the file is complete",
            ));
        }
        if let Some(line) = self.smoothing
            && self.parsed.parts.iter().all(|part| part.normals.is_empty())
        {
            let sentence =
                "smoothing groups are ignored; for smooth normals use `--normals smooth=40`";
            warnings.add(self.source, line, sentence);
        }
        Ok(self.parsed)
    }
}
