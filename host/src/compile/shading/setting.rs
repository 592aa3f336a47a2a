//! Camera, background and lights of a scene. The compiler supplies those that the scene does not state.

use crate::compile::extent::Shapes;
use crate::compile::framing::{BACKGROUND, framing_of};
use crate::scene::{Camera, Color, Light};
use crate::shape::unit;
use glam::DVec3;

/// The ambient light that is supplied with a light, so that shadows are not black.
const AMBIENT: f64 = 0.15;

/// What a picture needs beside objects.
pub struct Setting {
    pub camera: Camera,
    pub background: Color,
    pub lights: Vec<Light>,
    pub ambient: Color,
    /// What the compiler supplied.
    pub supplied: Vec<String>,
}

impl Setting {
    pub fn of(shapes: &Shapes<'_>) -> Self {
        let scene = shapes.scene();
        let mut supplied = Vec::new();
        let camera = scene.camera.unwrap_or_else(|| {
            supplied.push(String::from("a camera that shows the whole scene"));
            framing_of(shapes, None)
        });
        let background = scene.background.unwrap_or(match scene.camera {
            Some(_) => [0.0; 3],
            None => BACKGROUND,
        });
        let (mut lights, mut ambient) = (scene.lights.clone(), scene.ambient);
        if !scene.is_lit() && !scene.is_dark {
            let (direction, shoulder) = over_a_shoulder(shapes, &camera);
            supplied.push(format!(
                "a directional light from above the camera's {shoulder} shoulder, and some light from \
                 everywhere"
            ));
            lights.push(Light::Directional {
                direction,
                // With what comes from everywhere, white stays white and is not cut off.
                color: [1.0 - AMBIENT; 3],
            });
            ambient = [AMBIENT; 3];
        }
        if scene.camera.is_none() && scene.background.is_none() && scene.environment.is_none() {
            supplied.push(String::from("a light background"));
        }
        Self {
            camera,
            background,
            lights,
            ambient,
            supplied,
        }
    }
}

/// Returns the direction of a light from above the camera's left shoulder, and the shoulder's name. The light comes
/// from the right one where flat surfaces that face the camera would otherwise be dark.
fn over_a_shoulder(shapes: &Shapes<'_>, camera: &Camera) -> (DVec3, &'static str) {
    /// By how many times more the right one must light.
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
        (right, "right")
    } else {
        (left, "left")
    }
}
