//! Materials that send rays on at some time: as they are at rest, or as tracks raise them.

use super::Scene;
use super::model::Material;
use super::track::{Track, TrackTarget};

/// The rays that a material sends on at some time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Sends {
    pub(crate) mirrors: bool,
    pub(crate) transmits: bool,
}

impl Sends {
    fn at_rest(material: &Material) -> Self {
        Self {
            mirrors: material.mirror != [0.0; 3],
            transmits: material.transmit != [0.0; 3],
        }
    }

    /// Returns whether it sends rays on at all.
    pub(crate) fn any(self) -> bool {
        self.mirrors || self.transmits
    }
}

impl Track {
    /// Returns whether it raises a color above black at some time.
    pub(crate) fn raises(&self) -> bool {
        self.control_points().any(|it| it.max_element() > 0.0)
    }
}

impl Scene {
    /// Returns for each material the rays that it sends on, at rest or at a time of its tracks.
    pub(crate) fn sends(&self) -> Vec<Sends> {
        let mut all: Vec<Sends> = self.materials.iter().map(Sends::at_rest).collect();
        for track in &self.tracks {
            let Some(sends) = all.get_mut(track.index) else {
                continue;
            };
            match track.target {
                TrackTarget::MaterialMirror => sends.mirrors |= track.raises(),
                TrackTarget::MaterialTransmit => sends.transmits |= track.raises(),
                _ => {}
            }
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::read;

    #[test]
    fn tracks_that_stay_black_raise_nothing() {
        for (target, keys, expected) in [
            ("mirror", "values = [0, 0]", [false, false]),
            ("mirror", "values = [0, [0, 0, 0.1]]", [true, false]),
            ("transmit", "values = [0.5, 0]", [false, true]),
            (
                "transmit",
                "values = [0, 0]\ninterpolation = 'cubic'\ntangents = [1, 0]",
                [false, true],
            ),
            ("diffuse", "values = [1, 1]", [false, false]),
        ] {
            let text = format!(
                "[material.m]\n[[track]]\ntarget = 'material.m.{target}'\ntimes = [0, 1]\n{keys}"
            );
            let scene = read("m.toml".as_ref(), text.into(), &Default::default())
                .unwrap_or_else(|error| panic!("{error}"))
                .scene;
            let [mirrors, transmits] = expected;
            assert_eq!(
                scene.sends()[scene.tracks[0].index],
                Sends { mirrors, transmits },
                "{target} {keys}"
            );
        }
    }
}
