//! Radiance pictures (`.hdr`): red, green and blue with a shared exponent, flat or in runs.
//!
//! `EXPOSURE` and the other variables of the header are not applied, as in most programs.

use super::error::CauseAndRemedy;
use crate::table::shortened;

/// Width, height and linear pixels.
type Decoded = (usize, usize, Vec<[f32; 3]>);

const REMEDY: &str = "save the picture again as Radiance HDR (RGBE)";

/// The longest line of a header that is read.
const LONGEST_LINE: usize = 4096;

/// The rest of a file.
struct Bytes<'a>(&'a [u8]);

impl<'a> Bytes<'a> {
    fn take(&mut self, count: usize, row: usize) -> Result<&'a [u8], CauseAndRemedy> {
        let (taken, rest) = self.0.split_at_checked(count).ok_or_else(|| {
            CauseAndRemedy::new(format!("ends in row {row} of its pixels"), REMEDY)
        })?;
        self.0 = rest;
        Ok(taken)
    }

    fn byte(&mut self, row: usize) -> Result<u8, CauseAndRemedy> {
        self.take(1, row).map(|taken| taken[0])
    }

    /// A line of the header.
    fn line(&mut self) -> Result<String, CauseAndRemedy> {
        let end = self.0.iter().take(LONGEST_LINE);
        let end = end.copied().position(|byte| byte == b'\n');
        let end = end.ok_or_else(|| CauseAndRemedy::new("has a header without end", REMEDY))?;
        let line = String::from_utf8_lossy(&self.0[..end])
            .trim_end()
            .to_owned();
        self.0 = &self.0[end + 1..];
        Ok(line)
    }
}

/// Reads a picture of a size that `check` allows.
pub(super) fn decode(
    bytes: &[u8],
    check: impl Fn(usize, usize) -> Result<(), CauseAndRemedy>,
) -> Result<Decoded, CauseAndRemedy> {
    let mut bytes = Bytes(bytes);
    let magic = bytes.line()?;
    if !["#?RADIANCE", "#?RGBE"].contains(&magic.as_str()) {
        return Err(CauseAndRemedy::new(
            format!(
                "begins with {magic:?}, not with \"#?RADIANCE\"",
                magic = shortened(&magic)
            ),
            REMEDY,
        ));
    }
    loop {
        let line = bytes.line()?;
        if line.is_empty() {
            break;
        }
        if let Some(format) = line.strip_prefix("FORMAT=")
            && format.trim() != "32-bit_rle_rgbe"
        {
            return Err(CauseAndRemedy::new(
                format!(
                    "has the format {format:?}; expected \"32-bit_rle_rgbe\"",
                    format = shortened(format)
                ),
                REMEDY,
            ));
        }
    }
    let resolution = bytes.line()?;
    let (width, height) = size(&resolution).ok_or_else(|| {
        CauseAndRemedy::new(
            format!(
                "has the resolution {resolution:?}; expected one such as \"-Y 512 +X 1024\"",
                resolution = shortened(&resolution)
            ),
            order_remedy(&resolution),
        )
    })?;
    check(width, height)?;
    let mut pixels = Vec::new();
    let mut line = Vec::with_capacity(width);
    for row in 0..height {
        line.clear();
        scanline(&mut bytes, width, row, &mut line)?;
        pixels.extend(line.iter().map(linear));
    }
    Ok((width, height, pixels))
}

/// Returns what to do about a picture with this line of its size.
fn order_remedy(line: &str) -> &'static str {
    let mut axes = line.split_ascii_whitespace().step_by(2);
    match [axes.next(), axes.next()] {
        [Some("-Y"), Some("-X")] => "save the picture again with its left column first",
        [Some("+Y"), Some("+X")] => "save the picture again with its upper row first",
        [Some("+Y"), Some("-X")] => {
            "save the picture again with its upper row and its left column first"
        }
        _ => "save the picture again row by row, with its upper row first",
    }
}

/// Width and height from a line like `-Y 512 +X 1024`.
fn size(line: &str) -> Option<(usize, usize)> {
    let mut words = line.split_ascii_whitespace();
    let height = words.next().filter(|&it| it == "-Y").and(words.next())?;
    let width = words.next().filter(|&it| it == "+X").and(words.next())?;
    let positive = |text: &str| text.parse().ok().filter(|&number: &usize| number > 0);
    let size = (positive(width)?, positive(height)?);
    words.next().is_none().then_some(size)
}

fn linear([red, green, blue, exponent]: &[u8; 4]) -> [f32; 3] {
    if *exponent == 0 {
        return [0.0; 3];
    }
    let scale = libm::ldexp(1.0, i32::from(*exponent) - 136);
    [red, green, blue].map(|channel| (f64::from(*channel) * scale) as f32)
}

/// Reads a row: in runs per channel where it begins with 2, 2 and its width, else pixel by pixel.
fn scanline(
    bytes: &mut Bytes<'_>,
    width: usize,
    row: usize,
    line: &mut Vec<[u8; 4]>,
) -> Result<(), CauseAndRemedy> {
    let can_run = (8..1 << 15).contains(&width);
    match bytes.0 {
        [2, 2, high, low, ..] if can_run && *high < 128 => {
            let found = usize::from(*high) << 8 | usize::from(*low);
            if found != width {
                let cause = format!("has {found} pixels in row {row}, and the others {width}");
                return Err(CauseAndRemedy::new(cause, REMEDY));
            }
            bytes.take(4, row)?;
            line.resize(width, [0; 4]);
            (0..4).try_for_each(|channel| runs(bytes, channel, row, line))
        }
        _ => flat(bytes, width, row, line),
    }
}

/// Reads a channel of a row.
fn runs(
    bytes: &mut Bytes<'_>,
    channel: usize,
    row: usize,
    line: &mut [[u8; 4]],
) -> Result<(), CauseAndRemedy> {
    let too_long = || CauseAndRemedy::new(format!("has a run beyond the end of row {row}"), REMEDY);
    let mut rest = line;
    while !rest.is_empty() {
        let count = bytes.byte(row)?;
        let (length, same) = match count {
            0 => {
                return Err(CauseAndRemedy::new(
                    format!("has a run of length 0 in row {row}"),
                    REMEDY,
                ));
            }
            1..=128 => (count, None),
            _ => (count - 128, Some(bytes.byte(row)?)),
        };
        let (run, behind) = rest
            .split_at_mut_checked(length.into())
            .ok_or_else(too_long)?;
        for pixel in run {
            pixel[channel] = match same {
                Some(value) => value,
                None => bytes.byte(row)?,
            };
        }
        rest = behind;
    }
    Ok(())
}

/// Reads a row pixel by pixel; (1, 1, 1, n) repeats the one before, each further such one 256 times as often.
fn flat(
    bytes: &mut Bytes<'_>,
    width: usize,
    row: usize,
    line: &mut Vec<[u8; 4]>,
) -> Result<(), CauseAndRemedy> {
    let mut shift = 0;
    while line.len() < width {
        let taken = bytes.take(4, row)?;
        let pixel = [taken[0], taken[1], taken[2], taken[3]];
        let [1, 1, 1, count] = pixel else {
            line.push(pixel);
            shift = 0;
            continue;
        };
        let count = usize::from(count) << shift;
        let last = line.last().copied();
        let last = last.filter(|_| shift <= 16 && count <= width - line.len());
        let last = last.ok_or_else(|| {
            CauseAndRemedy::new(format!("has a run beyond the end of row {row}"), REMEDY)
        })?;
        line.resize(line.len() + count, last);
        shift += 8;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(_: usize, _: usize) -> Result<(), CauseAndRemedy> {
        Ok(())
    }

    fn file(size: &str, pixels: &[u8]) -> Vec<u8> {
        let header = format!("#?RADIANCE\n# a comment\nFORMAT=32-bit_rle_rgbe\n\n{size}\n");
        [header.as_bytes(), pixels].concat()
    }

    /// 8 pixels of red 1, green 0.5 to 1 and blue 0.
    const RUNS: [u8; 23] = [
        2, 2, 0, 8, 136, 128, 2, 64, 65, 6, 66, 67, 68, 69, 70, 71, 130, 0, 134, 0, 136, 129, 0,
    ];

    #[test]
    fn flat_pixels_and_runs_are_read() {
        let flat = file("-Y 2 +X 1", &[128, 64, 0, 129, 1, 2, 3, 0]);
        let expected = (1, 2, vec![[1.0, 0.5, 0.0], [0.0; 3]]);
        assert_eq!(decode(&flat, check), Ok(expected));
        let runs = file("-Y 1 +X 8", &RUNS[..22]);
        let (width, height, pixels) = decode(&runs, check).unwrap();
        assert_eq!((width, height, pixels.len()), (8, 1, 8));
        for (number, pixel) in pixels.iter().enumerate() {
            assert_eq!(pixel[0], 1.0);
            assert_eq!(pixel[1], (64 + number) as f32 / 128.0);
            assert_eq!(pixel[2], 0.0);
        }
        let old = file("-Y 1 +X 4", &[128, 64, 0, 129, 1, 1, 1, 3]);
        assert_eq!(decode(&old, check).unwrap().2, [[1.0, 0.5, 0.0]; 4]);
    }

    #[test]
    fn pictures_in_another_order_are_rejected_with_what_to_save_first() {
        for (line, words) in [
            ("-Y 1 -X 8", "its left column first"),
            ("+Y 1 +X 8", "its upper row first"),
            ("+Y 1 -X 8", "its upper row and its left column first"),
            ("+X 8 -Y 1", "row by row, with its upper row first"),
        ] {
            let CauseAndRemedy { cause, remedy } = decode(&file(line, &RUNS), check).unwrap_err();
            assert!(cause.contains(line) && remedy.ends_with(words), "{remedy}");
        }
    }

    #[test]
    fn damaged_pictures_are_rejected_with_their_causes() {
        let whole = file("-Y 1 +X 8", &RUNS[..22]);
        for end in 0..whole.len() {
            assert!(decode(&whole[..end], check).is_err(), "{end}");
        }
        for (bytes, words) in [
            (b"#?PICTURE\n\n".to_vec(), "begins with"),
            (
                b"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n".to_vec(),
                "the format",
            ),
            (file("+Y 1 +X 8", &RUNS), "the resolution"),
            (file("-Y 0 +X 8", &RUNS), "the resolution"),
            (file("-Y 1 +X 8 9", &RUNS), "the resolution"),
            (file("-Y 1 +X 9", &RUNS), "pixels in row 0"),
            (file("-Y 1 +X 8", &[2, 2, 0, 8, 0]), "length 0"),
            (file("-Y 1 +X 8", &[2, 2, 0, 8, 137, 1]), "beyond the end"),
            (file("-Y 1 +X 8", &[2, 2, 0, 8, 9, 1]), "beyond the end"),
            (file("-Y 1 +X 2", &[1, 1, 1, 1]), "beyond the end"),
            (
                file("-Y 1 +X 2", &[9, 9, 9, 9, 1, 1, 1, 2]),
                "beyond the end",
            ),
            (file("-Y 2 +X 2", &[9; 12]), "ends in row 1"),
        ] {
            let CauseAndRemedy { cause, remedy } = decode(&bytes, check).unwrap_err();
            assert!(cause.contains(words), "{cause}");
            assert!(!remedy.is_empty());
        }
        let large = |_, _| Err(CauseAndRemedy::new("is large", "make it smaller"));
        assert!(decode(&file("-Y 9999999 +X 9999999", &[]), large).is_err());
    }

    #[test]
    fn bytes_of_any_kind_are_no_panic() {
        let mut state = 1_u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            state >> 24
        };
        for _ in 0..2000 {
            let pixels: Vec<u8> = (0..64)
                .map(|_| {
                    if next() < 60 {
                        next() as u8 & 3
                    } else {
                        next() as u8
                    }
                })
                .collect();
            let _ = decode(&file("-Y 3 +X 9", &pixels), check);
        }
    }
}
