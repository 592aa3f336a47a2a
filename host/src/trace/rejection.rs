//! Rays that are not answered, and why.

use super::SceneHit;
use gridel_core::RayError;
use miette::Diagnostic;
use std::fmt::Display;

/// The reason why a ray is not answered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Rejection {
    #[error(transparent)]
    Ray(#[from] RayError),
    #[error(
        "the ray's t, in multiples of its direction, is not a number of double precision: the direction \
         is too short for this scene"
    )]
    TooShort,
    #[error(
        "the ray's t, in multiples of its direction, is not a number of double precision: the direction \
         is too long for this scene"
    )]
    TooLong,
}

impl Rejection {
    /// Returns advice on how to fix it.
    pub fn remedy(&self) -> &'static str {
        match self {
            Self::Ray(RayError::Direction) => "give a finite direction that is not 0 0 0",
            Self::Ray(RayError::Origin) => "give an origin of three finite numbers",
            Self::Ray(RayError::Distance) => {
                "give an origin nearer to the scene; another point of the ray meets the same surfaces"
            }
            Self::Ray(RayError::Interval) => "give a tmin that is at most tmax",
            Self::TooShort => "give a longer direction",
            Self::TooLong => "give a shorter direction",
        }
    }
}

impl Diagnostic for Rejection {
    fn help(&self) -> Option<Box<dyn Display + '_>> {
        Some(Box::new(self.remedy()))
    }
}

/// The rays that were rejected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rejections {
    pub count: usize,
    /// The first, by its place among the rays, and why.
    pub first: Option<(usize, Rejection)>,
}

impl Rejections {
    /// Adds a ray, and returns its hit.
    #[cold]
    pub(super) fn add(&mut self, place: usize, why: Rejection) -> SceneHit {
        self.count += 1;
        self.first.get_or_insert((place, why));
        SceneHit::REJECTED
    }

    /// Returns the rejections of two runs of rays; the second begins at `place`.
    pub fn followed_by(self, place: usize, next: Self) -> Self {
        let next_first = next.first.map(|(at, why)| (place + at, why));
        Self {
            count: self.count + next.count,
            first: self.first.or(next_first),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn remedies_are_those_of_the_reason() {
        for (why, remedy) in [
            (Rejection::Ray(RayError::Direction), "not 0 0 0"),
            (Rejection::Ray(RayError::Origin), "three finite numbers"),
            (Rejection::Ray(RayError::Distance), "nearer to the scene"),
            (Rejection::Ray(RayError::Interval), "at most tmax"),
            (Rejection::TooShort, "a longer direction"),
            (Rejection::TooLong, "a shorter direction"),
        ] {
            let explained = crate::explained(&why);
            assert!(explained.contains(remedy), "{explained}");
        }
    }
}
