//! NumPy's array files: rays, hits, and pictures.
//!
//! Rays are an array of shape (N, 8), float32 or float64: origin x y z, tmin, direction x y z,
//! tmax, in scene units. Either byte order and either memory order is read. Hits are a packed
//! structured array, little-endian, with the fields that
//! [`write_hits`] names.

use crate::render::Values;
use crate::trace::{SceneHit, SceneRay};
use glam::DVec3;
use std::io::{self, Write};

/// The reason why a file does not contain rays.
#[derive(Debug, PartialEq, thiserror::Error, miette::Diagnostic)]
pub enum RaysError {
    #[error("it is not a NumPy array file: it does not begin with \\x93NUMPY")]
    #[diagnostic(help("write the rays with `numpy.save`"))]
    Magic,
    #[error("its header is broken: {cause}")]
    #[diagnostic(help("write the rays again with `numpy.save`"))]
    Header { cause: String },
    #[error("its elements are of type {found}, not float32 or float64")]
    #[diagnostic(help("convert the array with `.astype('float64')` before saving it"))]
    Type { found: String },
    #[error("its shape is {found}, not (N, 8)")]
    #[diagnostic(help(
        "give each ray a row of 8: origin x y z, tmin, direction x y z, tmax, in scene units"
    ))]
    Shape { found: String },
    #[error("its shape is {found}, which is more than a file holds")]
    #[diagnostic(help("is its header damaged? Write the rays again with `numpy.save`"))]
    Overflow { found: String },
    #[error("it has {found} bytes of rays where its header promises {expected}")]
    #[diagnostic(help("was it cut off, or was something added to it? Write it again"))]
    Length { found: usize, expected: u64 },
}

/// Numbers of a ray.
const COLUMNS: usize = 8;

/// Reads the rays of a whole file.
///
/// # Errors
/// If it is no NumPy file of such an array, is cut off, or has anything behind the array.
///
/// ```
/// assert!(gridel_host::npy::read_rays(b"1 2 3").is_err());
/// ```
pub fn read_rays(file: &[u8]) -> Result<Vec<SceneRay>, RaysError> {
    let (header, data) = header(file)?;
    let (size, read): (usize, fn(&[u8]) -> f64) = match header.element {
        "<f4" => (4, |bytes| f32::from_le_bytes(array(bytes)).into()),
        ">f4" => (4, |bytes| f32::from_be_bytes(array(bytes)).into()),
        "<f8" => (8, |bytes| f64::from_le_bytes(array(bytes))),
        ">f8" => (8, |bytes| f64::from_be_bytes(array(bytes))),
        found => {
            let found = found.escape_debug().take(100).collect();
            return Err(RaysError::Type { found });
        }
    };
    let &[rays, 8] = &header.shape[..] else {
        let found = tuple(&header.shape);
        return Err(RaysError::Shape { found });
    };
    let Some(expected) = rays.checked_mul((COLUMNS * size) as u64) else {
        let found = tuple(&header.shape);
        return Err(RaysError::Overflow { found });
    };
    if expected != data.len() as u64 {
        let found = data.len();
        return Err(RaysError::Length { found, expected });
    }
    let rays = rays as usize;
    let number = |ray: usize, column: usize| {
        let index = match header.fortran_order {
            false => ray * COLUMNS + column,
            true => column * rays + ray,
        };
        read(&data[index * size..][..size])
    };
    let vector = |ray, first| DVec3::from_array([0, 1, 2].map(|k: usize| number(ray, first + k)));
    Ok((0..rays)
        .map(|ray| SceneRay {
            origin: vector(ray, 0),
            tmin: number(ray, 3),
            direction: vector(ray, 4),
            tmax: number(ray, 7),
        })
        .collect())
}

/// A shape as NumPy shows it.
fn tuple(shape: &[u64]) -> String {
    let extents: Vec<String> = shape.iter().map(u64::to_string).collect();
    match &extents[..] {
        [extent] => format!("({extent},)"),
        _ => format!("({})", extents.join(", ")),
    }
}

/// `bytes` must have `N` bytes.
fn array<const N: usize>(bytes: &[u8]) -> [u8; N] {
    let mut array = [0; N];
    array.copy_from_slice(bytes);
    array
}

/// The header of an array of plain numbers.
struct Header<'a> {
    element: &'a str,
    fortran_order: bool,
    shape: Vec<u64>,
}

/// Reads the header, and returns it with the bytes behind it.
fn header(file: &[u8]) -> Result<(Header<'_>, &[u8]), RaysError> {
    let broken = |cause: String| RaysError::Header { cause };
    let Some(rest) = file.strip_prefix(b"\x93NUMPY") else {
        return Err(RaysError::Magic);
    };
    let split = match *rest {
        [1, 0, a, b, ref rest @ ..] => rest.split_at_checked(u16::from_le_bytes([a, b]).into()),
        [2 | 3, 0, a, b, c, d, ref rest @ ..] => {
            rest.split_at_checked(u32::from_le_bytes([a, b, c, d]) as usize)
        }
        [1..=3, 0, ..] => None,
        [major, minor, ..] => {
            let cause = format!("version {major}.{minor} of the format is unknown");
            return Err(broken(cause));
        }
        _ => None,
    };
    let Some((text, data)) = split else {
        return Err(broken(String::from("it is cut off")));
    };
    let header = std::str::from_utf8(text).ok().and_then(dictionary);
    let header = header.ok_or_else(|| {
        let start = &text[..text.len().min(400)];
        let start = String::from_utf8_lossy(start);
        let start: String = start.trim_end().chars().take(100).collect();
        broken(format!(
            "it describes no array of plain numbers, but {start:?}"
        ))
    })?;
    Ok((header, data))
}

/// Parses the header's text: a Python dictionary of exactly three entries.
fn dictionary(text: &str) -> Option<Header<'_>> {
    let mut rest = token(text, "{")?;
    let (mut element, mut fortran_order, mut shape) = (None, None, None);
    while token(rest, "}").is_none() {
        let (key, value) = string(rest)?;
        let value = token(value, ":")?;
        let is_new;
        (is_new, rest) = match key {
            "descr" => {
                let (value, rest) = string(value)?;
                (element.replace(value).is_none(), rest)
            }
            "fortran_order" => {
                let is_true = token(value, "True").map(|rest| (true, rest));
                let (value, rest) =
                    is_true.or_else(|| token(value, "False").map(|rest| (false, rest)))?;
                (fortran_order.replace(value).is_none(), rest)
            }
            "shape" => {
                let (value, rest) = integers(value)?;
                (shape.replace(value).is_none(), rest)
            }
            _ => return None,
        };
        if !is_new {
            return None;
        }
        match token(rest, ",") {
            Some(next) => rest = next,
            None => break,
        }
    }
    let end = token(rest, "}")?;
    end.trim().is_empty().then_some(())?;
    Some(Header {
        element: element?,
        fortran_order: fortran_order?,
        shape: shape?,
    })
}

/// Returns the text behind `token` and the space before it, if `text` begins with them.
fn token<'a>(text: &'a str, token: &str) -> Option<&'a str> {
    text.trim_start().strip_prefix(token)
}

/// A string without escapes, and what follows it.
fn string(text: &str) -> Option<(&str, &str)> {
    let text = text.trim_start();
    let quote = text.chars().next().filter(|quote| "'\"".contains(*quote))?;
    let (string, rest) = text[1..].split_once(quote)?;
    (!string.contains('\\')).then_some((string, rest))
}

/// A tuple or list of integers, and what follows it.
fn integers(text: &str) -> Option<(Vec<u64>, &str)> {
    let (inside, rest) = match token(text, "(") {
        Some(tuple) => tuple.split_once(')')?,
        None => token(text, "[")?.split_once(']')?,
    };
    let inside = inside.trim();
    // A comma may follow the last one.
    let inside = inside.strip_suffix(',').unwrap_or(inside);
    if inside.trim().is_empty() {
        return Some((Vec::new(), rest));
    }
    let integer = |text: &str| {
        let text = text.trim();
        let is_integer = text.bytes().all(|byte| byte.is_ascii_digit());
        is_integer.then(|| text.parse().ok()).flatten()
    };
    let integers: Option<_> = inside.split(',').map(integer).collect();
    Some((integers?, rest))
}

/// Writes hits, as an array of shape (N,) with the fields t (f8), object and primitive (u4), and normal (3 f4). Hits of
/// scenes with instances have a field more: instance (u4), behind primitive.
///
/// # Errors
/// If `out` has one.
///
/// ```
/// use gridel_host::npy::write_hits;
/// use gridel_host::trace::SceneHit;
///
/// let mut file = Vec::new();
/// write_hits(&mut file, &[SceneHit::MISS; 3], false)?;
/// assert!(file.starts_with(b"\x93NUMPY"));
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn write_hits(out: &mut dyn Write, hits: &[SceneHit], with_instances: bool) -> io::Result<()> {
    let instance = if with_instances {
        "('instance', '<u4'), "
    } else {
        ""
    };
    let fields = format!(
        "[('t', '<f8'), ('object', '<u4'), ('primitive', '<u4'), {instance}('normal', '<f4', (3,)), ]"
    );
    write_header(out, &fields, &[hits.len()])?;
    for hit in hits {
        out.write_all(&hit.t.to_le_bytes())?;
        out.write_all(&hit.object.to_le_bytes())?;
        out.write_all(&hit.primitive.to_le_bytes())?;
        if with_instances {
            out.write_all(&hit.instance.to_le_bytes())?;
        }
        for x in hit.normal {
            out.write_all(&x.to_le_bytes())?;
        }
    }
    Ok(())
}

/// Writes the values of a picture's pixels, little-endian: an array of shape (height, width, 3) for vectors,
/// (height, width, 2) for texture coordinates, and (height, width) for numbers.
///
/// # Errors
/// If `out` has one.
///
/// ```
/// use gridel_host::render::Values;
///
/// let mut file = Vec::new();
/// let numbers = Values::Numbers(vec![1, 2, 3, 4, 5, 6]);
/// gridel_host::npy::write_pixels(&mut file, [3, 2], &numbers)?;
/// assert!(file.ends_with(&6_u32.to_le_bytes()));
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn write_pixels(
    out: &mut dyn Write,
    [width, height]: [usize; 2],
    values: &Values,
) -> io::Result<()> {
    let floats = |out: &mut dyn Write, floats: &[f32]| {
        let mut floats = floats.iter();
        floats.try_for_each(|x| out.write_all(&x.to_le_bytes()))
    };
    match values {
        Values::Lengths(lengths) => {
            write_header(out, "'<f4'", &[height, width])?;
            floats(out, lengths)
        }
        Values::Coordinates(pairs) => {
            write_header(out, "'<f4'", &[height, width, 2])?;
            floats(out, pairs.as_flattened())
        }
        Values::Vectors(vectors) => {
            write_header(out, "'<f4'", &[height, width, 3])?;
            floats(out, vectors.as_flattened())
        }
        Values::Numbers(numbers) => {
            write_header(out, "'<u4'", &[height, width])?;
            let mut numbers = numbers.iter();
            numbers.try_for_each(|x| out.write_all(&x.to_le_bytes()))
        }
    }
}

/// Writes what stands before the data of an array.
fn write_header(out: &mut dyn Write, element: &str, shape: &[usize]) -> io::Result<()> {
    let shape: String = shape.iter().map(|extent| format!("{extent}, ")).collect();
    let mut header =
        format!("{{'descr': {element}, 'fortran_order': False, 'shape': ({shape}), }}");
    // The data begin at a multiple of 64 bytes.
    let before = 10 + header.len() + 1;
    header += &" ".repeat(before.next_multiple_of(64) - before);
    header.push('\n');
    out.write_all(b"\x93NUMPY\x01\x00")?;
    out.write_all(&(header.len() as u16).to_le_bytes())?;
    out.write_all(header.as_bytes())
}

#[cfg(test)]
mod tests;
