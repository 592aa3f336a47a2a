//! The option `--light`, which changes a light of a scene file or of a blob.

use super::values::{numbers, vector};
use crate::cli::failure::Failure;
use glam::DVec3;
use gridel_host::scene::{BRIGHTEST, Color, Light, Scene, TrackTarget};
use gridel_host::table::counted;

/// One number or vector of a light, and its new value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightChange {
    number: usize,
    to: Property,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Property {
    Position(DVec3),
    Direction(DVec3),
    Color(Color),
}

impl LightChange {
    /// Changes one of the lights of a scene; `is_spot` says which of them are spots.
    ///
    /// # Errors
    /// If there is no such light, or it has no such property.
    pub fn apply(
        &self,
        lights: &mut [Light],
        is_spot: impl Fn(usize) -> bool,
    ) -> Result<(), Failure> {
        let count = lights.len();
        let Some(light) = lights.get_mut(self.number) else {
            let remedy = match count {
                0 => String::from("add a light to the scene file"),
                1 => String::from("lights count from 0; change light 0"),
                _ => format!("lights count from 0; change one of 0 to {}", count - 1),
            };
            return Err(Failure::usage(
                format!(
                    "there is no light {}: the scene states {}",
                    self.number,
                    counted(count, "light")
                ),
                remedy,
            ));
        };
        match (light, self.to) {
            (Light::Point { position, .. }, Property::Position(to)) => *position = to,
            (Light::Directional { direction, .. }, Property::Direction(to)) => *direction = to,
            (
                Light::Point { color, .. } | Light::Directional { color, .. },
                Property::Color(to),
            ) => {
                *color = to;
            }
            (Light::Directional { .. }, Property::Position(_)) => {
                return Err(self.misfit("shines from far away and has no position", "direction"));
            }
            (Light::Point { .. }, Property::Direction(_)) if is_spot(self.number) => {
                return Err(self.misfit(
                    "is a spot, whose direction cannot be changed yet",
                    "position",
                ));
            }
            (Light::Point { .. }, Property::Direction(_)) => {
                return Err(self.misfit("has a position and no direction to change", "position"));
            }
        }
        Ok(())
    }

    /// Changes one of the lights of a scene file, and the object that shows it.
    ///
    /// # Errors
    /// As [`apply`](Self::apply), and if the light is a face of an object that stays.
    pub fn apply_to_scene(&self, scene: &mut Scene) -> Result<(), Failure> {
        let mut lights = scene.lights.clone();
        let form = |number: usize| scene.light_forms.get(number).copied().flatten();
        self.apply(&mut lights, |number| {
            form(number).is_some_and(|form| form.spot.is_some())
        })?;
        let changed = scene.replace_light(self.number, lights[self.number]);
        changed.map_err(|cause| Failure::usage(cause, "change the object in the scene file"))
    }

    /// Returns the light's number.
    pub fn number(&self) -> usize {
        self.number
    }

    /// Returns whether this replaces the property that a track moves.
    pub fn replaces(&self, target: TrackTarget, index: usize) -> bool {
        let moved = match self.to {
            Property::Position(_) => TrackTarget::LightPosition,
            Property::Direction(_) => TrackTarget::LightDirection,
            Property::Color(_) => TrackTarget::LightColor,
        };
        (moved, self.number) == (target, index)
    }

    fn misfit(&self, cause: &str, instead: &str) -> Failure {
        let number = self.number;
        Failure::usage(
            format!("light {number} {cause}"),
            format!("change its {instead} with `--light {number}.{instead}=X,Y,Z`"),
        )
    }
}

/// Reads a change, such as `0.position=1,2,3`.
pub fn light(text: &str) -> Result<LightChange, String> {
    let change = || {
        let (place, value) = text.split_once('=')?;
        let (number, property) = place.split_once('.')?;
        let number = number.trim().parse().ok()?;
        let vector = vector(value);
        let to = match property.trim() {
            "position" => Property::Position(vector.ok()?),
            "direction" => Property::Direction(vector.ok().filter(|it| *it != DVec3::ZERO)?),
            "color" => {
                let color: Color = numbers(value)?;
                let is_light = color
                    .iter()
                    .all(|channel| (0.0..=BRIGHTEST).contains(channel));
                is_light.then_some(Property::Color(color))?
            }
            _ => return None,
        };
        Some(LightChange { number, to })
    };
    change().ok_or_else(|| {
        String::from(
            "write a light's number and its position, direction or color, such as \
             0.position=1,2.5,-3 or 1.color=0.5,0.5,1; colors are numbers from 0 to 2047",
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const POINT: Light = Light::Point {
        position: DVec3::ZERO,
        color: [1.0; 3],
    };
    const DIRECTIONAL: Light = Light::Directional {
        direction: DVec3::NEG_Y,
        color: [1.0; 3],
    };

    #[test]
    fn changes_are_read_and_applied() {
        let mut lights = [POINT, DIRECTIONAL];
        for change in [
            "0.position=1,2.5,-3",
            "1.direction=0,0,-1",
            "1.color=0,.5,2",
        ] {
            let change = light(change).unwrap();
            change.apply(&mut lights, |_| false).unwrap();
        }
        let position = DVec3::new(1.0, 2.5, -3.0);
        let color = [1.0; 3];
        assert_eq!(lights[0], Light::Point { position, color });
        let (direction, color) = (DVec3::NEG_Z, [0.0, 0.5, 2.0]);
        assert_eq!(lights[1], Light::Directional { direction, color });
    }

    #[test]
    fn malformed_changes_are_rejected() {
        for wrong in [
            "",
            "0",
            "0.position",
            "0.position=1,2",
            "position=1,2,3",
            "-1.position=1,2,3",
            "0.radius=1,2,3",
            "0.direction=0,0,0",
            "0.color=-1,0,0",
            "0.color=nan,0,0",
        ] {
            assert!(light(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn changes_that_do_not_fit_the_lights_are_rejected() {
        let mut lights = [POINT, DIRECTIONAL];
        for wrong in ["2.color=1,1,1", "0.direction=1,0,0", "1.position=0,0,0"] {
            let change = light(wrong).unwrap();
            assert!(change.apply(&mut lights, |_| false).is_err(), "{wrong}");
        }
        assert_eq!(lights, [POINT, DIRECTIONAL]);
        let change = light("0.color=1,1,1").unwrap();
        assert!(change.apply(&mut [], |_| false).is_err());
    }

    #[test]
    fn directions_of_spots_are_rejected_as_such() {
        let change = light("0.direction=1,0,0").unwrap();
        let said = |is_spot: bool| {
            let error = change.apply(&mut [POINT], |_| is_spot).unwrap_err();
            format!("{error:?}")
        };
        assert!(said(true).contains("spot") && !said(false).contains("spot"));
    }
}
