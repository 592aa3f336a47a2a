//! Puts the frames of an animation in order.
//!
//! The file of a frame states its number and how it was made ([`FrameNote`]). So frames may come from several machines
//! and in any order.

use super::{PartError, difference, different_sizes, made_differently, open_png, pixels, text};
use crate::picture::{Frame, FrameNote};
use std::fmt;
use std::io::{BufRead, Seek};

/// The note of a file about its frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NumberedPicture {
    pub size: [u32; 2],
    pub note: FrameNote,
}

impl NumberedPicture {
    /// Reads the notes of a PNG, and none of its pixels.
    ///
    /// # Errors
    /// If the file is no PNG that says which frame of an animation it is.
    pub fn read(input: impl BufRead + Seek) -> Result<Self, PartError> {
        let reader = open_png(input)?;
        let info = reader.info();
        let note = text(info, FrameNote::KEYWORD).and_then(|note| note.parse().ok());
        Ok(Self {
            size: [info.width, info.height],
            note: note.ok_or(PartError::NoFrame)?,
        })
    }

    /// Reads the pixels of a PNG: sRGB, three bytes each.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn read_pixels(input: impl BufRead + Seek) -> Result<Vec<u8>, PartError> {
        pixels(&mut open_png(input)?)
    }
}

/// The reason why frames do not make an animation. They are numbered in the order in which they were given.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FramesError {
    /// Two are of different sizes.
    Sizes([usize; 2], [[u32; 2]; 2]),
    /// Two have different rates.
    Rates([usize; 2], [u16; 2]),
    /// Two were made differently: what differs, and how it is in each.
    Made([usize; 2], [String; 2]),
    /// Two are the same frame of the animation.
    Twice([usize; 2], u32),
    /// A frame between two others is missing.
    Missing(u32),
}

/// Returns the order of an animation's frames, as numbers of those given.
///
/// # Errors
/// If they are not all frames from one to another of one animation.
pub fn in_order(pictures: &[NumberedPicture]) -> Result<Vec<usize>, FramesError> {
    if let Some(first) = pictures.first() {
        for (index, other) in pictures.iter().enumerate() {
            let both = [0, index];
            if other.size != first.size {
                return Err(FramesError::Sizes(both, [first.size, other.size]));
            }
            let rates = [first, other].map(|it| it.note.frame.per_second);
            if rates[0] != rates[1] {
                return Err(FramesError::Rates(both, rates));
            }
            if let Some(made) = difference(&first.note.made, &other.note.made) {
                return Err(FramesError::Made(both, made));
            }
        }
    }
    let number = |&index: &usize| {
        let Frame { number, .. } = pictures[index].note.frame;
        number
    };
    let mut order: Vec<usize> = (0..pictures.len()).collect();
    order.sort_by_key(number);
    for pair in order.windows(2) {
        let (one, other) = (number(&pair[0]), number(&pair[1]));
        if one == other {
            return Err(FramesError::Twice([pair[0], pair[1]], one));
        }
        if one + 1 != other {
            return Err(FramesError::Missing(one + 1));
        }
    }
    Ok(order)
}

impl fmt::Display for FramesError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sizes(_, sizes) => f.write_str(&different_sizes(*sizes)),
            Self::Rates(_, [one, other]) => write!(
                f,
                "one is of an animation of {one} frames per second, the other of {other}"
            ),
            Self::Made(_, made) => f.write_str(&made_differently(made)),
            Self::Twice(_, number) => write!(f, "both are frame {number}"),
            Self::Missing(number) => write!(f, "frame {number} is missing"),
        }
    }
}

impl std::error::Error for FramesError {}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(number: u32) -> NumberedPicture {
        NumberedPicture {
            size: [4, 3],
            note: format!("{number} at 24 per second; blob 0a, depth 5")
                .parse()
                .unwrap(),
        }
    }

    #[test]
    fn pictures_come_in_any_order_from_any_number() {
        let order =
            |numbers: &[u32]| in_order(&numbers.iter().map(|it| picture(*it)).collect::<Vec<_>>());
        assert_eq!(order(&[2, 0, 1]), Ok(vec![1, 2, 0]));
        assert_eq!(order(&[25, 24]), Ok(vec![1, 0]));
        assert_eq!(order(&[7]), Ok(vec![0]));
        assert_eq!(order(&[]), Ok(vec![]));
        assert_eq!(order(&[3, 1]), Err(FramesError::Missing(2)));
        assert_eq!(order(&[1, 3, 2, 3]), Err(FramesError::Twice([1, 3], 3)));
    }

    #[test]
    fn pictures_of_different_animations_are_rejected() {
        let differs = |change: &dyn Fn(&mut NumberedPicture)| {
            let mut other = picture(1);
            change(&mut other);
            in_order(&[picture(0), other]).unwrap_err().to_string()
        };
        assert!(differs(&|it| it.size = [4, 4]).contains("4x4"));
        assert!(differs(&|it| it.note.frame.per_second = 25).contains("25"));
        assert!(differs(&|it| it.note.made[0].1 = String::from("0b")).contains("blob 0b"));
    }

    #[test]
    fn notes_are_read_as_they_are_written() {
        for text in [
            "0 at 1 per second; blob 12",
            "4294967294 at 65535 per second; a b, c d",
        ] {
            let note: FrameNote = text.parse().unwrap();
            assert_eq!(note.to_string(), text);
        }
        for wrong in [
            "",
            "1 at 24 per second",
            "1 at 0 per second; a b",
            "-1 at 2 per second; a b",
            "4294967295 at 2 per second; a b",
        ] {
            assert!(wrong.parse::<FrameNote>().is_err(), "{wrong}");
        }
    }
}
