//! Exposure. The compiler multiplies all light of a scene, so that pictures cost no more.

use crate::compile::CompileError;
use crate::scene::{BRIGHTEST, Color, Light, Scene, Track};
use gridel_core::format::track::TrackTarget;

/// The factor of all light.
pub struct Exposure {
    pub factor: f64,
}

/// Returns the factor of all light of a scene.
pub fn exposure_factor(scene: &Scene) -> f64 {
    libm::exp2(scene.render.exposure)
}

impl Exposure {
    pub fn of(scene: &Scene) -> Self {
        Self {
            factor: exposure_factor(scene),
        }
    }

    /// Converts a color to that of records.
    pub fn of_color(
        &self,
        color: Color,
        what: impl FnOnce() -> String,
    ) -> Result<Color, CompileError> {
        let exposed = color.map(|channel| channel * self.factor);
        // Importers keep to what a record holds; only a factor can lead beyond it.
        if self.factor != 1.0 {
            check(exposed, what)?;
        }
        Ok(exposed)
    }

    /// Converts the color of a light whose brightness is stated by its color alone.
    pub fn of_light(&self, light: &Light, number: usize) -> Result<Light, CompileError> {
        let mut light = *light;
        let (Light::Point { color, .. } | Light::Directional { color, .. }) = &mut light;
        *color = self.of_color(*color, || format!("light {number}"))?;
        Ok(light)
    }

    /// Changes the colors that tracks give to lights.
    pub fn change_tracks(&self, tracks: &mut [Track]) -> Result<(), CompileError> {
        let of_lights = tracks.iter_mut();
        for track in of_lights.filter(|it| it.target == TrackTarget::LightColor) {
            for key in &mut track.keys {
                let [red, green, blue, _] = key.value.map(|value| value * self.factor);
                check([red, green, blue], || {
                    let Track { index, place, .. } = track;
                    format!("light {index} at {} s ({place})", key.seconds)
                })?;
                *key = key.weighted([self.factor; 4]);
            }
        }
        Ok(())
    }
}

/// Rejects a color that records cannot hold.
fn check(color: Color, what: impl FnOnce() -> String) -> Result<(), CompileError> {
    let largest = color.into_iter().fold(0.0, f64::max);
    match largest > BRIGHTEST {
        true => Err(CompileError::TooBright {
            what: what(),
            value: largest,
            most: BRIGHTEST,
        }),
        false => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use crate::compile::{CompileError, Options, compile};
    use crate::scene::read;

    const FILE: &str = "render.exposure = 1\n\
        [[light]]\nkind = 'point'\nposition = [0, 4, 0]\ncolor = 1\n\
        [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n\
        [[track]]\ntarget = 'light.0.color'\ntimes = [0, 1]\n";

    fn compiled(values: &str) -> Result<(), CompileError> {
        let file = format!("{FILE}values = {values}");
        let imported = read("lamp.toml".as_ref(), file.into(), &Default::default()).unwrap();
        compile(&imported.scene, &Options::default()).map(|_| ())
    }

    #[test]
    fn colors_of_tracks_that_exposure_makes_too_bright_are_rejected() {
        compiled("[[1, 1, 1], [1000, 1, 1]]").unwrap();
        let error = compiled("[[1, 1, 1], [1, 1030, 1]]").unwrap_err();
        assert!(matches!(
            error,
            CompileError::TooBright { value: 2060.0, .. }
        ));
        assert!(error.to_string().contains("light 0 at 1 s"), "{error}");
    }

    #[test]
    fn visible_lights_that_exposure_makes_too_bright_are_named_as_lights() {
        for (name, expected) in [
            ("", "the light 0 has"),
            ("name = 'bulb'", "the light 0 (bulb) has"),
        ] {
            let file = format!(
                "render.exposure = 12\n[[light]]\nkind = 'sphere'\ncenter = [0, 4, 0]\nradius = 1\nradiance = 1\n\
                 visible = true\n{name}\n[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n"
            );
            let imported = read("lamp.toml".as_ref(), file.into(), &Default::default()).unwrap();
            let error = compile(&imported.scene, &Options::default()).unwrap_err();
            assert!(error.to_string().starts_with(expected), "{error}");
        }
    }

    /// An import that is scaled multiplies the colors of its light.
    #[test]
    fn colors_of_imported_tracks_that_are_too_bright_are_rejected() {
        let folder = tempfile::tempdir().unwrap();
        let lamp = FILE
            .replace("render.exposure = 1", "")
            .replace("color = 1", "color = 0.1\nfalloff = 'square'");
        let lamp = format!("{lamp}values = [[0.1, 0.1, 0.1], [1, 1, 1]]");
        std::fs::write(folder.path().join("lamp.toml"), lamp).unwrap();
        let compiled = |scale: f64| {
            let outer = format!("[[object]]\nkind = 'import'\nfile = 'lamp.toml'\nscale = {scale}");
            let path = folder.path().join("outer.toml");
            let scene = read(&path, outer.into(), &Default::default())
                .unwrap()
                .scene;
            compile(&scene, &Options::default())
        };
        compiled(40.0).unwrap();
        let error = compiled(100.0).unwrap_err().to_string();
        assert!(error.contains("light 0 at 1 s"), "{error}");
        assert!(error.contains("1.0000e4"), "{error}");
    }
}
