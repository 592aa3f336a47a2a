//! The view of an NFF file: the camera and the size of the picture.

use super::Importer;
use super::reader::{Line, Lines};
use crate::scene::{Camera, RenderSettings, SceneError};
use glam::DVec3;

/// The largest width or height; PNG viewers and 16-bit coordinates end here.
const MAX_RESOLUTION: f64 = 65_535.0;

impl<'a> Importer<'a> {
    /// Reads what follows the line `v`, in any order.
    pub(super) fn view(
        &mut self,
        start: &Line<'a>,
        lines: &mut Lines<'a>,
    ) -> Result<(), SceneError> {
        let (mut from, mut at, mut up, mut angle) = (None, None, None, None);
        while let Some(line) = lines.next_if(&["from", "at", "up", "angle", "hither", "resolution"])
        {
            match line.word(0) {
                "from" => from = Some(self.point(&line, "from x y z")?),
                "at" => at = Some(self.point(&line, "at x y z")?),
                "up" => up = Some(self.point(&line, "up x y z")?),
                "angle" => angle = Some(self.angle(&line)?),
                "resolution" => self.resolution(&line)?,
                // The hither plane serves algorithms that cannot see behind the eye.
                _ => {}
            }
        }
        let missing = |name: &str| {
            self.source.error_at(
                start.text,
                format!("the view has no line `{name}`"),
                "write from, at, up, angle, hither and resolution, a line each, after `v`",
            )
        };
        let eye = from.ok_or_else(|| missing("from"))?;
        let target = at.ok_or_else(|| missing("at"))?;
        let up = up.ok_or_else(|| missing("up"))?;
        let fov_degrees = angle.ok_or_else(|| missing("angle"))?;
        if eye == target {
            let cause = "the view looks from a point at the same point";
            return Err(self
                .source
                .error_at(start.text, cause, "move `from` away from `at`"));
        }
        let camera = Camera {
            eye,
            target,
            up,
            fov_degrees,
        };
        if camera.is_along_up() {
            let cause = "the up vector of the view is zero or parallel to the direction of view";
            return Err(self.source.error_at(
                start.text,
                cause,
                "write another `up`, such as `up 0 0 1`",
            ));
        }
        if self.scene.camera.is_some() {
            self.warnings.add(
                self.source,
                start.number,
                "a second view replaces the first",
            );
        }
        self.scene.camera = Some(camera);
        Ok(())
    }

    fn point(&mut self, line: &Line<'a>, format: &str) -> Result<DVec3, SceneError> {
        Ok(DVec3::from_array(line.numbers(
            self.source,
            &mut self.warnings,
            1,
            format,
        )?))
    }

    fn angle(&mut self, line: &Line<'a>) -> Result<f64, SceneError> {
        let [angle] = line.numbers(self.source, &mut self.warnings, 1, "angle degrees")?;
        if angle <= 0.0 || angle >= 180.0 {
            let cause = format!("the angle of view is {angle} degrees");
            return Err(self.source.error_at(
                line.text,
                cause,
                "write an angle above 0 and below 180",
            ));
        }
        Ok(angle)
    }

    fn resolution(&mut self, line: &Line<'a>) -> Result<(), SceneError> {
        let size: [f64; 2] = line.numbers(self.source, &mut self.warnings, 1, "resolution x y")?;
        for side in size {
            if side.fract() != 0.0 || !(1.0..=MAX_RESOLUTION).contains(&side) {
                return Err(self.source.error_at(
                    line.text,
                    format!("the resolution {side} is no number of pixels"),
                    format!("write two whole numbers from 1 to {MAX_RESOLUTION}"),
                ));
            }
        }
        let [width, height] = size.map(|side| side as u32);
        if width > RenderSettings::MAX_ASPECT * height {
            let most = RenderSettings::MAX_ASPECT;
            return Err(self.source.error_at(
                line.text,
                format!("the picture is more than {most} times as wide as high"),
                "write a smaller width or a larger height",
            ));
        }
        [self.scene.render.width, self.scene.render.height] = [width, height];
        Ok(())
    }
}
