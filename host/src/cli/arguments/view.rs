//! Options for the camera of a scene.

use super::values::{first_given, number, numbers, vector};
use crate::cli::failure::Failure;
use clap::Args;
use glam::DVec3;
use gridel_core::Up;
use gridel_core::format::record::View;
use gridel_host::compile;
use gridel_host::scene::{BRIGHTEST, Camera, Color, Scene, TrackTarget};

/// Options for the view, in place of what a scene's file or blob states. Help lists these options last, in their order,
/// with `--target` behind `--eye`.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Options for camera and lights")]
pub struct ViewOptions {
    /// Place the camera here, in scene units. To render a blob, give `--target` and `--up`, too: it keeps no target and
    /// no tilted up [default: the file's, or where everything is seen]
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true,
        display_order = 100)]
    eye: Option<DVec3>,

    /// The point of `TargetPoint`, or of `--target` in a command that takes boards too.
    #[arg(skip)]
    pub target: Option<DVec3>,

    /// Size of the picture, which a camera that Gridel supplies shows the scene in.
    #[arg(skip)]
    pub size: Option<[u16; 2]>,

    /// Point this direction up. With a track `camera.orbit` the orbit of a scene file turns about it, that of a blob
    /// does not [default: the file's, or y; z for STL and NFF; to render a blob the picture's, or an axis that it is
    /// upright on]
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true,
        display_order = 102)]
    up: Option<DVec3>,

    /// See this vertical angle, in degrees between 0 and 180 [default: the file's, or 40]
    #[arg(long, value_name = "DEG", value_parser = degrees, allow_hyphen_values = true,
        display_order = 103)]
    fov: Option<f64>,

    /// Show this linear color where nothing is, 1 being display white [default: the file's, else black;
    /// light gray for a file without a camera]
    #[arg(long, value_name = "R,G,B", value_parser = color, allow_hyphen_values = true,
        display_order = 104)]
    background: Option<Color>,
}

impl ViewOptions {
    /// Returns for each option whether it was given, and its name.
    pub fn given(&self) -> [(bool, &'static str); 5] {
        [
            (self.eye.is_some(), "--eye"),
            (self.target.is_some(), "--target X,Y,Z"),
            (self.up.is_some(), "--up"),
            (self.fov.is_some(), "--fov"),
            (self.background.is_some(), "--background"),
        ]
    }

    /// Changes the scene's camera and background, and the size of its picture.
    ///
    /// # Errors
    /// If the camera would look nowhere, or along the direction that points up; or if an environment is shown in place
    /// of the background.
    pub fn apply(&self, scene: &mut Scene) -> Result<(), Failure> {
        self.check_background(
            scene.environment.is_some(),
            "leave the option out, or the environment with `--without environment`",
        )?;
        scene.background = self.background.or(scene.background);
        if let Some([width, height]) = self.size {
            (scene.render.width, scene.render.height) = (width.into(), height.into());
        }
        if !self.moves_camera() {
            return Ok(());
        }
        if scene.camera.is_none() {
            if scene.environment.is_none() {
                scene.background = scene.background.or(Some(compile::BACKGROUND));
            }
            // The direction up decides from where the whole scene is seen.
            for up in [Up::Y, Up::Z] {
                // Along the axis, however long.
                let is_along =
                    |it: DVec3| it[up.axis()] > 0.0 && it[up.axis()] == it.abs().element_sum();
                if self.up.is_some_and(is_along) {
                    scene.up = up;
                }
            }
        }
        let camera = match scene.camera {
            Some(camera) => camera,
            None => compile::framing(scene, self.fov),
        };
        scene.camera = Some(self.moved(camera)?);
        Ok(())
    }

    /// Returns the view of a blob with another camera and background.
    ///
    /// # Errors
    /// As [`apply`](Self::apply), and if the camera is out of the blob's reach.
    pub fn in_blob(&self, scene: &gridel_core::Scene<'_>) -> Result<View, Failure> {
        self.check_background(scene.environment().is_some(), "leave the option out")?;
        let mut view = *scene.view();
        if self.moves_camera() {
            let camera = self.moved(Camera::of_blob(scene))?;
            let placed = camera.in_blob(scene);
            view = placed.map_err(|error| Failure::Usage(miette::Report::new(error)))?;
        }
        if let Some(background) = self.background {
            view.background = compile::radiance(background);
        }
        Ok(view)
    }

    /// Returns whether an option replaces the property that a track moves.
    pub fn replaces(&self, target: TrackTarget) -> bool {
        let turns = self.eye.is_some() || self.target.is_some() || self.up.is_some();
        match target {
            TrackTarget::CameraEye | TrackTarget::CameraOrbit => self.eye.is_some(),
            TrackTarget::CameraTarget => self.target.is_some(),
            TrackTarget::CameraUp => self.up.is_some(),
            TrackTarget::CameraFieldOfView => self.fov.is_some(),
            TrackTarget::CameraRotation => turns,
            _ => false,
        }
    }

    /// Returns the name of an option for the camera, if one was given.
    pub fn given_for_camera(&self) -> Option<&'static str> {
        let [camera @ .., _] = self.given();
        first_given(camera)
    }

    /// Rejects a background that an environment hides.
    fn check_background(&self, has_environment: bool, remedy: &str) -> Result<(), Failure> {
        match self.background.filter(|_| has_environment) {
            None => Ok(()),
            Some(_) => Err(Failure::usage(
                "--background has no effect: the scene's environment is shown in its place",
                remedy,
            )),
        }
    }

    fn moves_camera(&self) -> bool {
        self.given_for_camera().is_some()
    }

    /// Returns a camera with the given values in place of its own.
    fn moved(&self, camera: Camera) -> Result<Camera, Failure> {
        let camera = Camera {
            eye: self.eye.unwrap_or(camera.eye),
            target: self.target.unwrap_or(camera.target),
            up: self.up.unwrap_or(camera.up),
            fov_degrees: self.fov.unwrap_or(camera.fov_degrees),
        };
        if camera.eye == camera.target {
            return Err(Failure::usage(
                "the camera's eye and target are the same point",
                "give another `--eye` or `--target`; the camera looks from eye to target",
            ));
        }
        if camera.is_along_up() {
            return Err(Failure::usage(
                "the camera looks along `--up`, so the picture could be turned any way",
                "give an `--up` across the view, such as 0,0,1 for a view from above",
            ));
        }
        Ok(camera)
    }
}

fn degrees(text: &str) -> Result<f64, String> {
    let is_valid = |it| it > 0.0 && it < 180.0;
    number(
        text,
        is_valid,
        "write an angle above 0 and below 180 degrees, such as 45",
    )
}

fn color(text: &str) -> Result<Color, String> {
    let is_radiance = |channel: &f64| (0.0..=BRIGHTEST).contains(channel);
    let color = numbers(text).filter(|color| color.iter().all(is_radiance));
    color.ok_or_else(|| {
        String::from("write three numbers from 0 to 2047 with commas, such as 0.2,0.4,1")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_colors_and_angles_are_finite_and_in_range() {
        assert_eq!(vector("1, -2,3e2"), Ok(DVec3::new(1.0, -2.0, 300.0)));
        for wrong in ["", "1,2", "1,2,3,4", "1,2,a", "1,2,nan", "inf,0,0", "1 2 3"] {
            assert!(vector(wrong).is_err(), "{wrong}");
        }
        assert_eq!(color("0,0.5,2"), Ok([0.0, 0.5, 2.0]));
        for wrong in ["-1,0,0", "0,0", "#ffffff", "inf,0,0"] {
            assert!(color(wrong).is_err(), "{wrong}");
        }
        assert_eq!((degrees("0.5"), degrees("179.9")), (Ok(0.5), Ok(179.9)));
        for wrong in ["0", "180", "-1", "nan", "x"] {
            assert!(degrees(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn options_that_are_not_given_keep_the_scenes_view() {
        let mut scene = Scene::default();
        ViewOptions::default().apply(&mut scene).unwrap();
        assert_eq!(scene, Scene::default());
        let view = ViewOptions {
            up: Some(DVec3::new(0.0, 0.0, 2.0)),
            fov: Some(10.0),
            ..ViewOptions::default()
        };
        view.apply(&mut scene).unwrap();
        let camera = scene.camera.unwrap();
        assert_eq!(scene.background, Some(compile::BACKGROUND));
        let view = (camera.target - camera.eye).normalize();
        assert!(view.distance(DVec3::Y) < 1e-12);
        assert_eq!(camera.fov_degrees, 10.0);
        // Now the scene has a camera, and its other values stay.
        let view = ViewOptions {
            eye: Some(DVec3::new(7.0, 8.0, 9.0)),
            background: Some([0.0; 3]),
            ..ViewOptions::default()
        };
        view.apply(&mut scene).unwrap();
        let moved = scene.camera.unwrap();
        assert_eq!(
            (moved.target, moved.up, moved.fov_degrees),
            (camera.target, camera.up, 10.0)
        );
        assert_eq!(moved.eye, DVec3::new(7.0, 8.0, 9.0));
        assert_eq!(scene.background, Some([0.0; 3]));
    }

    #[test]
    fn cameras_that_look_nowhere_are_rejected() {
        for (eye, target, up) in [
            ([1.0; 3], [1.0; 3], [0.0, 1.0, 0.0]),
            ([0.0; 3], [0.0, 5.0, 0.0], [0.0, -2.0, 0.0]),
            ([0.0; 3], [0.0, 0.0, 1.0], [0.0; 3]),
        ] {
            let [eye, target, up] = [eye, target, up].map(|it| Some(DVec3::from_array(it)));
            let view = ViewOptions {
                eye,
                target,
                up,
                ..ViewOptions::default()
            };
            assert!(view.apply(&mut Scene::default()).is_err());
        }
    }
}
