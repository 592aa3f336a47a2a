//! Camera, background and lights of a scene. The compiler supplies those that the scene does not state.

use crate::compile::geometry::extent::Shapes;
use crate::compile::view::framing::{BACKGROUND, framing_of};
use crate::scene::{Camera, Color, Light, Scene};
use crate::shape::unit;
use glam::DVec3;
use serde::{Serialize, Serializer};
use std::fmt;

/// The ambient light that is supplied with a light, so that shadows are not black.
const AMBIENT: f64 = 0.15;

/// A part that the compiler supplies because the scene has none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Supplied {
    /// A camera.
    Camera,
    /// A directional light, and ambient light.
    Light(Shoulder),
    /// A background.
    Background,
}

/// A shoulder of the camera, above which a light is supplied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shoulder {
    Left,
    Right,
}

impl fmt::Display for Supplied {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let shoulder = match self {
            Self::Camera => return f.write_str("a camera that shows the whole scene"),
            Self::Background => return f.write_str("a light background"),
            Self::Light(Shoulder::Left) => "left",
            Self::Light(Shoulder::Right) => "right",
        };
        write!(
            f,
            "a directional light from above the camera's {shoulder} shoulder, and some light from everywhere"
        )
    }
}

impl Serialize for Supplied {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// The data that a picture needs besides objects.
pub struct Setting {
    pub camera: Camera,
    pub background: Color,
    pub lights: Vec<Light>,
    pub ambient: Color,
    /// Parts that the compiler supplied.
    pub supplied: Vec<Supplied>,
}

impl Setting {
    pub fn of(shapes: &Shapes<'_>) -> Self {
        let scene = shapes.scene();
        let mut supplied = Vec::new();
        let camera = scene.camera.unwrap_or_else(|| {
            supplied.push(Supplied::Camera);
            framing_of(shapes, None)
        });
        let background = scene.background.unwrap_or(match scene.camera {
            Some(_) => [0.0; 3],
            None => BACKGROUND,
        });
        let (mut lights, mut ambient) = (scene.lights.clone(), scene.ambient);
        if !scene.is_lit() && !scene.is_dark {
            let (direction, shoulder) = over_a_shoulder(shapes, &camera);
            supplied.push(Supplied::Light(shoulder));
            lights.push(Light::Directional {
                direction,
                // With what comes from everywhere, white stays white and is not cut off.
                color: [1.0 - AMBIENT; 3],
            });
            ambient = [AMBIENT; 3];
        }
        if scene.camera.is_none() && scene.background.is_none() && scene.environment.is_none() {
            supplied.push(Supplied::Background);
        }
        Self {
            camera,
            background,
            lights,
            ambient,
            supplied,
        }
    }

    /// Returns what the compiler supplies for a scene with this setting.
    pub fn unstated(&self, scene: &Scene) -> Unstated {
        let mut supplied = self.supplied.iter();
        let has_light = supplied.any(|it| matches!(it, Supplied::Light(_)));
        let light = self.lights.last().filter(|_| has_light);
        let background = Some(self.background);
        Unstated {
            light: light.map(|light| (*light, self.ambient)),
            background: background.filter(|it| *it == BACKGROUND && scene.environment.is_none()),
        }
    }
}

/// Values that a scene does not state, and the compiler supplies for its pictures. A scene with another camera gets
/// other values.
///
/// ```
/// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
/// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// use gridel_host::compile::{BACKGROUND, Options, compile};
///
/// let unstated = compile(&imported.scene, &Options::default())?.report.unstated;
/// assert!(unstated.light.is_some() && unstated.background == Some(BACKGROUND));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Unstated {
    /// A light, and the ambient light that comes with it.
    pub light: Option<(Light, Color)>,
    /// The background, if it is that of scenes without a camera.
    pub background: Option<Color>,
}

/// Returns the direction of a light from above the camera's left shoulder, and the shoulder. The light comes from
/// the right one where flat surfaces that face the camera would otherwise be dark.
fn over_a_shoulder(shapes: &Shapes<'_>, camera: &Camera) -> (DVec3, Shoulder) {
    /// Least ratio of the right one's light to that of the left one.
    const CLEARLY: f64 = 2.0;
    let view = unit(camera.target - camera.eye);
    let up = unit(camera.up);
    let aside = 0.5 * unit(view.cross(up));
    let [left, right] = [aside, -aside].map(|aside| view + aside - 0.7 * up);
    let lit = |direction: DVec3| -> f64 {
        let towards = |normal: DVec3| normal * -normal.dot(view).signum();
        let mut sum = 0.0;
        shapes.each_face(|normal| sum += (-towards(normal).dot(direction)).max(0.0));
        sum
    };
    if lit(right) > CLEARLY * lit(left) {
        (right, Shoulder::Right)
    } else {
        (left, Shoulder::Left)
    }
}
