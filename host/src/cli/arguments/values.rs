//! Names, sizes, ranges and vectors, as they are written on a command line.

use clap::builder::{PossibleValuesParser, TypedValueParser};
use glam::DVec3;
use gridel_core::{Format, Structure};
use gridel_host::compile::{Builder, LATTICE_BITS};
use gridel_host::render::Aov;
use gridel_host::scene::RenderSettings;
use std::fmt::Display;
use std::ops::Range;
use std::str::FromStr;

/// The name of the first option that was given.
pub fn first_given<const N: usize>(options: [(bool, &'static str); N]) -> Option<&'static str> {
    let mut given = options.into_iter().filter(|(given, _)| *given);
    given.next().map(|(_, name)| name)
}

/// A word as shells take it for one.
pub fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "/._-+,:=@%".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

/// Reads a number. For all that is not a valid one the error is the advice.
pub fn number(text: &str, is_valid: impl Fn(f64) -> bool, advice: &str) -> Result<f64, String> {
    let value = text.parse().ok();
    value
        .filter(|&it| is_valid(it))
        .ok_or_else(|| advice.to_owned())
}

/// Reads a cutoff.
pub fn cutoff(text: &str) -> Result<f64, String> {
    let is_valid = |it| (0.0..=1.0).contains(&it);
    number(text, is_valid, "write a number from 0 to 1, such as 0.002")
}

/// Reads an exposure.
pub fn exposure(text: &str) -> Result<f64, String> {
    let is_valid = |it| (-32.0..=32.0).contains(&it);
    number(text, is_valid, "write a number from -32 to 32, such as 1.5")
}

/// Reads numbers with commas between them.
pub fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    let numbers: [f64; N] = numbers.ok()?.try_into().ok()?;
    numbers.iter().all(|it| it.is_finite()).then_some(numbers)
}

/// Reads a vector, such as `0,1.5,-2`.
pub fn vector(text: &str) -> Result<DVec3, String> {
    let numbers = numbers(text).map(DVec3::from_array);
    numbers.ok_or_else(|| String::from("write three numbers with commas, such as 0,1.5,-2"))
}

/// Names without repetition, in the order in which they come first.
pub fn distinct<T: Copy + PartialEq>(names: &[T]) -> Vec<T> {
    let mut distinct = Vec::new();
    for &name in names {
        if !distinct.contains(&name) {
            distinct.push(name);
        }
    }
    distinct
}

/// Names without repetition; all where none is given.
pub fn distinct_or<T: Copy + PartialEq>(names: &[T], all: &[T]) -> Vec<T> {
    match names {
        [] => all.to_vec(),
        names => distinct(names),
    }
}

/// The name of a builder of hierarchies.
pub fn builder() -> impl TypedValueParser<Value = Builder> {
    PossibleValuesParser::new(Builder::ALL.map(Builder::name)).try_map(|name| {
        let mut all = Builder::ALL.into_iter();
        all.find(|builder| builder.name() == name)
            .ok_or("no such builder")
    })
}

/// The name of an acceleration structure.
pub fn structure() -> impl TypedValueParser<Value = Structure> {
    PossibleValuesParser::new(Structure::ALL.map(Structure::name))
        .try_map(|name| Structure::from_name(&name).ok_or("no such structure"))
}

/// The name of a number format.
pub fn format() -> impl TypedValueParser<Value = Format> {
    PossibleValuesParser::new(Format::ALL.map(Format::name))
        .try_map(|name| Format::from_name(&name).ok_or("no such number format"))
}

/// The name of an AOV.
pub fn aov() -> impl TypedValueParser<Value = Aov> {
    PossibleValuesParser::new(Aov::ALL.map(Aov::name)).try_map(|name| {
        let mut all = Aov::ALL.into_iter();
        all.find(|aov| aov.name() == name).ok_or("no such AOV")
    })
}

/// A number of threads: beyond some hundreds none helps, and far beyond they cannot be started.
pub fn threads() -> impl TypedValueParser<Value = usize> {
    clap::value_parser!(u16).range(1..=1024).map(usize::from)
}

/// Reads a number of bytes, such as `65536`, `64K` or `1M`.
pub fn bytes(text: &str) -> Result<u64, String> {
    let (digits, unit) = match text.char_indices().last() {
        Some((end, 'k' | 'K')) => (&text[..end], 1 << 10),
        Some((end, 'm' | 'M')) => (&text[..end], 1 << 20),
        Some((end, 'g' | 'G')) => (&text[..end], 1 << 30),
        _ => (text, 1),
    };
    digits
        .parse::<u64>()
        .ok()
        .filter(|_| digits.bytes().all(|byte| byte.is_ascii_digit()))
        .and_then(|number| number.checked_mul(unit))
        .ok_or_else(|| String::from("write a number of bytes, such as 65536, 64K or 1M"))
}

/// Reads the size of a picture, such as `640x480`.
pub fn size(text: &str) -> Result<[u16; 2], String> {
    let sides = text
        .split_once(['x', 'X'])
        .map(|(width, height)| [width, height].map(|side| side.parse::<u32>()));
    let Some([Ok(width), Ok(height)]) = sides else {
        return Err(String::from("write width and height, such as 640x480"));
    };
    if width == 0 || height == 0 {
        return Err(String::from("a picture has at least one pixel each way"));
    }
    let (Ok(width), Ok(height)) = (u16::try_from(width), u16::try_from(height)) else {
        return Err(String::from(
            "neither width nor height can be more than 65535",
        ));
    };
    let most = RenderSettings::MAX_ASPECT;
    if u32::from(width) > most * u32::from(height) {
        return Err(format!("the width can be at most {most} times the height"));
    }
    Ok([width, height])
}

/// Reads how far vertices can move.
pub fn room(text: &str) -> Result<f64, String> {
    let is_valid = |it: f64| it.is_finite() && it >= 0.0;
    number(
        text,
        is_valid,
        "write a length in scene units, such as 0.25",
    )
}

/// Reads a time in seconds.
pub fn seconds(text: &str) -> Result<f64, String> {
    let is_valid = |it: f64| it.is_finite();
    number(text, is_valid, "write a time in seconds, such as 1.5")
}

/// Reads for how many seconds a shutter is open.
pub fn open_seconds(text: &str) -> Result<f64, String> {
    let is_valid = |it: f64| it.is_finite() && it > 0.0;
    number(
        text,
        is_valid,
        "write a number of seconds above 0, such as 0.02",
    )
}

/// Reads a range such as `100..200`, whose end is not part of it. For all that is not a range the error is the advice.
fn range<T>(text: &str, advice: &str) -> Result<Range<T>, String>
where
    T: FromStr + PartialOrd + Display,
{
    let ends = text
        .split_once("..")
        .map(|(first, end)| [first, end].map(str::parse));
    match ends {
        Some([Ok(first), Ok(end)]) if first < end => Ok(first..end),
        Some([Ok(first), Ok(end)]) => Err(format!(
            "the range from {first} to {end} (not included) is empty"
        )),
        _ => Err(advice.to_owned()),
    }
}

/// Reads a range of rows.
pub fn rows(text: &str) -> Result<Range<u16>, String> {
    range(
        text,
        "write the first row and the one behind the last, such as 100..200; rows count from 0",
    )
}

/// Reads a range of frames.
pub fn frames(text: &str) -> Result<Range<u32>, String> {
    range(
        text,
        "write the first frame and the one behind the last, such as 0..48",
    )
}

/// A number of bits for the lattice.
pub fn lattice_bits() -> impl TypedValueParser<Value = u8> {
    let [fewest, most] = [LATTICE_BITS.start(), LATTICE_BITS.end()].map(|&it| i64::from(it));
    clap::value_parser!(u8).range(fewest..=most)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_have_units_of_1024() {
        assert_eq!(bytes("0"), Ok(0));
        assert_eq!(bytes("1000"), Ok(1000));
        assert_eq!(bytes("64K"), Ok(65536));
        assert_eq!(bytes("2m"), Ok(2 << 20));
        assert_eq!(bytes("3G"), Ok(3 << 30));
        for wrong in ["", "K", "-1", "+1", "1.5M", "64KB", "20000000000G", "1é"] {
            assert!(bytes(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn sizes_have_two_sides() {
        assert_eq!(size("640x480"), Ok([640, 480]));
        assert_eq!(size("64X1"), Ok([64, 1]));
        let wrongs = [
            "",
            "x",
            "640",
            "0x0",
            "1x0",
            "0x1",
            "65x1",
            "65536x1",
            "70000x70000",
            "-1x5",
            "99999999999x1",
        ];
        for wrong in wrongs {
            assert!(size(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn times_are_finite() {
        assert_eq!((seconds("1.5"), seconds("-2")), (Ok(1.5), Ok(-2.0)));
        for wrong in ["", "x", "nan", "inf"] {
            assert!(seconds(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn rows_are_a_range() {
        assert_eq!(rows("0..1"), Ok(0..1));
        assert_eq!(rows("5..480"), Ok(5..480));
        for wrong in ["", "5..3", "5..5", "5", "..", "5..", "-1..2", "0..70000"] {
            assert!(rows(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn frames_are_a_range() {
        assert_eq!(frames("0..48"), Ok(0..48));
        for wrong in ["", "3..3", "5..1", "..2", "2..", "-1..2", "0..4294967296"] {
            assert!(frames(wrong).is_err(), "{wrong}");
        }
    }
}
