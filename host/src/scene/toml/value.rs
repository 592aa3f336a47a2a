//! Typed reads of TOML values whose errors point at the value.

use super::source::{Name, Source, Span, nearest};
use crate::scene::{BRIGHTEST, Color, SceneError, SourceSpan};
use crate::srgb::linear_of_srgb;
use crate::table::shortened;
use glam::DVec3;
use std::ops::RangeInclusive;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A value, and the key under which it stands.
#[derive(Clone, Copy)]
pub(crate) struct Value<'a> {
    pub(crate) source: &'a Source,
    pub(crate) key: &'a str,
    node: &'a Spanned<DeValue<'a>>,
}

/// A table whose keys are known to be valid ones.
pub(crate) struct Fields<'a> {
    pub(crate) source: &'a Source,
    pub(crate) span: Span,
    /// The subject of the table, for messages.
    what: &'a str,
    table: &'a DeTable<'a>,
}

impl<'a> Value<'a> {
    pub(crate) fn span(self) -> Span {
        self.node.span()
    }

    pub(crate) fn place(self) -> SourceSpan {
        self.source.place(&self.span())
    }

    pub(crate) fn error(self, cause: impl Into<String>, remedy: impl Into<String>) -> SceneError {
        self.source.error(&self.span(), cause, remedy)
    }

    /// The error of a value of another type than `expected`, which reads like "three numbers".
    pub(crate) fn mistyped(self, expected: &str, example: &str) -> SceneError {
        let found = match self.node.get_ref() {
            DeValue::Array(items) => format!("an array of {}", items.len()),
            DeValue::Integer(_) => "an integer".into(),
            other => format!("a {}", other.type_str()),
        };
        let key = shortened(self.key);
        self.error(
            format!("`{key}` holds {found}; expected {expected}"),
            format!("write it like {example}"),
        )
    }

    /// A finite number; an integer will do.
    pub(crate) fn number(self) -> Result<f64, SceneError> {
        let number = match self.node.get_ref() {
            DeValue::Float(float) => float.as_str().parse().ok(),
            DeValue::Integer(integer) => i128::from_str_radix(integer.as_str(), integer.radix())
                .ok()
                .map(|integer| integer as f64),
            _ => return Err(self.mistyped("a number", &format!("`{} = 1.5`", self.key))),
        };
        number
            .filter(|number: &f64| number.is_finite())
            .ok_or_else(|| {
                let cause = format!("`{}` is not a finite number", self.key);
                self.error(
                    cause,
                    "write a number within the range of 64-bit floats, without `inf` or `nan`",
                )
            })
    }

    /// A number above 0.
    pub(crate) fn positive(self) -> Result<f64, SceneError> {
        let number = self.number()?;
        if number > 0.0 {
            return Ok(number);
        }
        Err(self.error(
            format!("`{}` is {number}; it must be above 0", self.key),
            "write a number above 0",
        ))
    }

    /// A number within `range`.
    pub(crate) fn number_in(self, range: RangeInclusive<f64>) -> Result<f64, SceneError> {
        let number = self.number()?;
        if range.contains(&number) {
            return Ok(number);
        }
        Err(self.out_of_range(number, range.start(), range.end()))
    }

    /// An integer within `range`.
    pub(crate) fn integer_in(self, range: RangeInclusive<u32>) -> Result<u32, SceneError> {
        let DeValue::Integer(integer) = self.node.get_ref() else {
            let example = format!("`{} = {}`", self.key, range.start());
            return Err(self.mistyped("an integer", &example));
        };
        match u32::from_str_radix(integer.as_str(), integer.radix()) {
            Ok(number) if range.contains(&number) => Ok(number),
            _ => Err(self.out_of_range(integer, range.start(), range.end())),
        }
    }

    /// A whole number at or above 0.
    pub(crate) fn count(self) -> Result<u64, SceneError> {
        let DeValue::Integer(integer) = self.node.get_ref() else {
            return Err(self.mistyped("a whole number", &format!("`{} = 1024`", self.key)));
        };
        u64::from_str_radix(integer.as_str(), integer.radix())
            .map_err(|_| self.out_of_range(integer, 0, i64::MAX))
    }

    fn out_of_range<T: std::fmt::Display>(
        self,
        found: impl std::fmt::Display,
        low: T,
        high: T,
    ) -> SceneError {
        self.error(
            format!("`{}` is {found}; it must be from {low} to {high}", self.key),
            format!("write a number from {low} to {high}"),
        )
    }

    /// Three numbers.
    pub(crate) fn vector(self) -> Result<DVec3, SceneError> {
        let example = format!("`{} = [0, 1, 0]`", self.key);
        let mistyped = |value: Self| value.mistyped("three numbers", &example);
        let DeValue::Array(items) = self.node.get_ref() else {
            return Err(mistyped(self));
        };
        let [x, y, z] = &items[..] else {
            return Err(mistyped(self));
        };
        let number = |node: &'a Spanned<DeValue<'a>>| {
            let value = Value { node, ..self };
            match node.get_ref() {
                DeValue::Float(_) | DeValue::Integer(_) => value.number(),
                _ => Err(mistyped(value)),
            }
        };
        Ok(DVec3::new(number(x)?, number(y)?, number(z)?))
    }

    /// Three numbers that are not all 0.
    pub(crate) fn direction(self) -> Result<DVec3, SceneError> {
        let vector = self.vector()?;
        if vector == DVec3::ZERO {
            let cause = format!("`{}` is [0, 0, 0], which points nowhere", self.key);
            return Err(self.error(cause, "write a vector of any length above 0"));
        }
        Ok(vector)
    }

    /// A linear color: three numbers, one number for gray, or an sRGB string.
    pub(crate) fn color(self) -> Result<Color, SceneError> {
        match self.node.get_ref() {
            DeValue::String(text) => srgb(text).ok_or_else(|| {
                self.error(
                    format!("`{}` is {text:?}, which is no color", self.key, text = shortened(text)),
                    "write \"#rrggbb\" with six hexadecimal digits, or three linear numbers like [0.8, 0.1, 0.1]",
                )
            }),
            _ => self.coefficients(),
        }
    }

    /// Reads a color with no channel above 1: a surface reflects no more than arrives.
    pub(crate) fn reflectance(self) -> Result<Color, SceneError> {
        self.color_up_to(
            1.0,
            "write numbers from 0 to 1; make the lights brighter instead",
        )
    }

    /// A color of light.
    pub(crate) fn radiance(self) -> Result<Color, SceneError> {
        self.color_up_to(
            BRIGHTEST,
            "write numbers from 0 to 2047; 1 is display white",
        )
    }

    /// A color of a point or a spot without a falloff.
    pub(crate) fn radiance_of_points(self) -> Result<Color, SceneError> {
        self.color_up_to(
            BRIGHTEST,
            "write numbers from 0 to 2047; with `falloff = \"square\"` a light may be brighter",
        )
    }

    /// The radiance of a light that is seen.
    pub(crate) fn radiance_of_visible(self) -> Result<Color, SceneError> {
        self.color_up_to(
            BRIGHTEST,
            "write numbers from 0 to 2047; with `visible = false` a light may be brighter",
        )
    }

    /// A color of a light that falls off or has an area. The compiler knows how bright it may be in its scene.
    pub(crate) fn bright_radiance(self) -> Result<Color, SceneError> {
        self.color_up_to(1e15, "write numbers from 0 to 1e15; 1 is display white")
    }

    fn color_up_to(self, most: f64, remedy: &str) -> Result<Color, SceneError> {
        let color = self.color()?;
        if let Some(channel) = color.iter().find(|&&channel| channel > most) {
            let cause = format!("`{}` is {channel}; it must be at most {most}", self.key);
            return Err(self.error(cause, remedy));
        }
        Ok(color)
    }

    /// Three numbers at or above 0, or one for all three channels.
    pub(crate) fn coefficients(self) -> Result<Color, SceneError> {
        let color = match self.node.get_ref() {
            DeValue::Array(items) if items.len() == 3 => self.vector()?.to_array(),
            DeValue::Float(_) | DeValue::Integer(_) => [self.number()?; 3],
            _ => {
                let example = format!("`{0} = [0.8, 0.1, 0.1]` or `{0} = 0.5`", self.key);
                return Err(self.mistyped("three numbers or one", &example));
            }
        };
        if let Some(channel) = color.iter().find(|&&channel| channel < 0.0) {
            return Err(self.error(
                format!("`{}` has the negative channel {channel}", self.key),
                "write numbers at or above 0",
            ));
        }
        Ok(color)
    }

    pub(crate) fn boolean(self) -> Result<bool, SceneError> {
        match self.node.get_ref() {
            DeValue::Boolean(value) => Ok(*value),
            _ => Err(self.mistyped("true or false", &format!("`{} = true`", self.key))),
        }
    }

    pub(crate) fn text(self) -> Result<&'a str, SceneError> {
        match self.node.get_ref() {
            DeValue::String(text) => Ok(text),
            _ => Err(self.mistyped("text", &format!("`{} = \"...\"`", self.key))),
        }
    }

    /// Text that is not empty.
    pub(crate) fn filled(self) -> Result<&'a str, SceneError> {
        match self.text()? {
            "" => Err(self.error(
                format!("`{}` is empty", self.key),
                "write something between the quotes",
            )),
            text => Ok(text),
        }
    }

    pub(crate) fn name(self) -> Result<Name, SceneError> {
        Ok(Name {
            text: self.filled()?.to_owned(),
            span: self.span(),
        })
    }

    /// Returns the value as one of a few words.
    pub(crate) fn word(self, words: &[&'static str]) -> Result<&'static str, SceneError> {
        Ok(words[self.place_among(words)?])
    }

    /// Returns the one of some things that the value names.
    pub(crate) fn one_of<T: Copy, const N: usize>(
        self,
        all: [T; N],
        name: impl Fn(T) -> &'static str,
    ) -> Result<T, SceneError> {
        Ok(all[self.place_among(&all.map(name))?])
    }

    fn place_among(self, words: &[&'static str]) -> Result<usize, SceneError> {
        let text = self.text()?;
        words.iter().position(|&word| word == text).ok_or_else(|| {
            let near = nearest(text, words.iter().copied()).unwrap_or_default();
            self.error(
                format!(
                    "`{}` is {text:?}, which means nothing here",
                    self.key,
                    text = shortened(text)
                ),
                format!(
                    "did you mean {near:?}? It may be {}",
                    words.join(", "),
                    near = shortened(near)
                ),
            )
        })
    }

    /// The values of an array; `example` shows one.
    pub(crate) fn items(
        self,
        example: &str,
    ) -> Result<impl ExactSizeIterator<Item = Value<'a>>, SceneError> {
        match self.node.get_ref() {
            DeValue::Array(items) => Ok(items.iter().map(move |node| Value { node, ..self })),
            _ => Err(self.mistyped("an array", example)),
        }
    }

    pub(crate) fn is_array(self) -> bool {
        self.node.get_ref().is_array()
    }

    pub(crate) fn is_table(self) -> bool {
        self.node.get_ref().is_table()
    }

    fn table(self) -> Result<&'a DeTable<'a>, SceneError> {
        match self.node.get_ref() {
            DeValue::Table(table) => Ok(table),
            _ => Err(self.mistyped(
                "a table with keys",
                "`{ key = value }` or below its own heading",
            )),
        }
    }

    /// The table's fields, all of whose keys must be in one of the lists in `keys`.
    pub(crate) fn fields(self, what: &'a str, keys: &[&[&str]]) -> Result<Fields<'a>, SceneError> {
        Fields::new(self.source, self.span(), self.table()?, what, keys)
    }

    /// Returns the value of one key of a table, and ignores its other keys.
    pub(crate) fn member(self, what: &'a str, key: &str) -> Result<Value<'a>, SceneError> {
        let (source, span, table) = (self.source, self.span(), self.table()?);
        Fields {
            source,
            span,
            what,
            table,
        }
        .require(key)
    }

    /// The named tables inside this one, in the order of the file.
    pub(crate) fn entries(self) -> Result<Vec<(Name, Value<'a>)>, SceneError> {
        let entries = self.table()?.iter().map(|(key, node)| {
            let name = Name {
                text: key.get_ref().to_string(),
                span: key.span(),
            };
            (
                name,
                Value {
                    key: key.get_ref(),
                    node,
                    ..self
                },
            )
        });
        let mut entries: Vec<_> = entries.collect();
        entries.sort_by_key(|(name, _)| name.span.start);
        Ok(entries)
    }
}

impl<'a> Fields<'a> {
    pub(crate) fn new(
        source: &'a Source,
        span: Span,
        table: &'a DeTable<'a>,
        what: &'a str,
        keys: &[&[&str]],
    ) -> Result<Self, SceneError> {
        let valid = || keys.iter().copied().flatten().copied();
        let unknown = table
            .keys()
            .filter(|key| !valid().any(|valid| valid == key.get_ref()));
        // The first in the file, not in the alphabet.
        if let Some(key) = unknown.min_by_key(|key| key.span().start) {
            let near = nearest(key.get_ref(), valid()).unwrap_or_default();
            let valid: Vec<_> = valid().collect();
            return Err(source.error(
                &key.span(),
                format!("this {what} has no key `{}`", shortened(key.get_ref())),
                format!("did you mean `{near}`? The keys are {}", valid.join(", ")),
            ));
        }
        Ok(Self {
            source,
            span,
            what,
            table,
        })
    }

    pub(crate) fn get(&self, key: &str) -> Option<Value<'a>> {
        let (key, node) = self.table.get_key_value(key)?;
        Some(Value {
            source: self.source,
            key: key.get_ref(),
            node,
        })
    }

    /// Returns the place of a key of a table in this one, and the default one without it.
    pub(crate) fn place_of(&self, table: &str, key: &str) -> SourceSpan {
        let value = self.get(table).and_then(|it| it.member("", key).ok());
        value.map(Value::place).unwrap_or_default()
    }

    pub(crate) fn require(&self, key: &str) -> Result<Value<'a>, SceneError> {
        self.get(key).ok_or_else(|| {
            self.source.error(
                &self.span,
                format!("this {} has no `{key}`", self.what),
                format!("add a line `{key} = ...` to it"),
            )
        })
    }

    /// Returns the key's value as `read` converts it, or `default` without one.
    pub(crate) fn or<T>(
        &self,
        key: &str,
        default: T,
        read: impl FnOnce(Value<'a>) -> Result<T, SceneError>,
    ) -> Result<T, SceneError> {
        self.get(key).map_or(Ok(default), read)
    }
}

/// The linear color of "#rrggbb" (IEC 61966-2-1).
fn srgb(text: &str) -> Option<Color> {
    let digits = text.strip_prefix('#')?;
    if digits.len() != 6 || !digits.bytes().all(|digit| digit.is_ascii_hexdigit()) {
        return None;
    }
    let code = u32::from_str_radix(digits, 16).ok()?;
    let [_, channels @ ..] = code.to_be_bytes();
    Some(channels.map(|channel| linear_of_srgb(f64::from(channel) / 255.0)))
}
