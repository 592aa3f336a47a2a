//! Orbits, pans and zooms of a camera, in scene units.

use crate::scene::{Camera, Lens};
use glam::{DQuat, DVec3};

/// Smallest angle between a camera's direction and the up direction, in radians.
const NEAREST_TO_POLE: f64 = 0.017;

impl Camera {
    /// Returns this camera turned around its target, in radians: to the right of the scene, and upwards. It stays
    /// upright, and stops a degree before it looks straight up or down.
    pub fn orbited(&self, right: f64, up: f64) -> Self {
        let pole = self.up.normalize();
        let away = self.eye - self.target;
        let from_pole = away.angle_between(pole);
        // A camera beyond the limit may come back, and goes no further.
        let [near, far] = [NEAREST_TO_POLE, std::f64::consts::PI - NEAREST_TO_POLE];
        let turned = (from_pole - up).clamp(near.min(from_pole), far.max(from_pole));
        // Towards the pole, around the axis to the camera's right.
        let side = pole.cross(away).normalize();
        let raised = DQuat::from_axis_angle(side, turned - from_pole) * away;
        let away = DQuat::from_axis_angle(pole, right) * raised;
        Self {
            eye: self.target + away,
            ..*self
        }
    }

    /// Returns this camera moved across its view, with eye and target, in heights of the picture: to the right and up.
    pub fn panned(&self, right: f64, up: f64) -> Self {
        let [across, upwards] = self.picture_axes();
        let step = right * across + up * upwards;
        Self {
            eye: self.eye + step,
            target: self.target + step,
            ..*self
        }
    }

    /// Returns this camera at a multiple of its distance from the target.
    pub fn zoomed(&self, factor: f64) -> Self {
        Self {
            eye: self.target + factor * (self.eye - self.target),
            ..*self
        }
    }

    /// Returns this camera with its target in focus: a scene file that states no focus has it there.
    pub fn focused(&self, lens: Option<Lens>) -> Self {
        let target = match lens.and_then(|lens| lens.focus) {
            Some(focus) => self.eye + (self.target - self.eye).normalize() * focus,
            None => self.target,
        };
        Self { target, ..*self }
    }

    /// The picture's height at the target, to the right and upwards.
    fn picture_axes(&self) -> [DVec3; 2] {
        let forward = self.target - self.eye;
        let half = (self.fov_degrees / 2.0).to_radians();
        let height = 2.0 * forward.length() * libm::tan(half);
        let right = forward.cross(self.up).normalize();
        let up = right.cross(forward).normalize();
        [right, up].map(|axis| height * axis)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    const CAMERA: Camera = Camera {
        eye: DVec3::new(1.0, 2.0, 13.0),
        target: DVec3::new(1.0, 2.0, 3.0),
        up: DVec3::Y,
        fov_degrees: 90.0,
    };

    fn assert_at(camera: &Camera, eye: [f64; 3]) {
        let eye = DVec3::from_array(eye);
        assert!(
            camera.eye.distance(eye) < 1e-9,
            "{} is not {eye}",
            camera.eye
        );
    }

    #[test]
    fn orbit_turns_around_the_target_and_stops_before_the_pole() {
        assert_at(&CAMERA.orbited(FRAC_PI_2, 0.0), [11.0, 2.0, 3.0]);
        assert_at(&CAMERA.orbited(-FRAC_PI_2, 0.0), [-9.0, 2.0, 3.0]);
        let [sine, cosine] = [0.5, 3_f64.sqrt() / 2.0].map(|x| 10.0 * x);
        let raised = CAMERA.orbited(0.0, 30_f64.to_radians());
        assert_at(&raised, [1.0, 2.0 + sine, 3.0 + cosine]);
        for up in [2.0, -2.0] {
            let end = CAMERA.orbited(0.0, up);
            assert!(!end.is_along_up());
            let height = 10.0 * libm::cos(NEAREST_TO_POLE) * up.signum();
            assert!((end.eye.y - (2.0 + height)).abs() < 1e-9, "{}", end.eye);
            // It is still there, and turns.
            assert!(end.orbited(0.0, up).eye.distance(end.eye) < 1e-9);
            let around = end.orbited(1.0, 0.0);
            assert!((around.eye.y - end.eye.y).abs() < 1e-9);
            assert!(around.eye.distance(end.eye) > 0.1);
            assert_at(
                &end.orbited(0.0, -up),
                CAMERA.orbited(0.0, end_angle(up) - up).eye.into(),
            );
        }
    }

    /// Returns the angle at which an orbit upwards or downwards ends.
    fn end_angle(up: f64) -> f64 {
        (FRAC_PI_2 - NEAREST_TO_POLE) * up.signum()
    }

    #[test]
    fn orbit_from_beyond_its_limit_comes_back_only() {
        let steep = Camera {
            eye: CAMERA.target + DVec3::new(0.0, 10.0, 0.01),
            ..CAMERA
        };
        assert!(steep.orbited(0.0, 0.5).eye.distance(steep.eye) < 1e-9);
        assert!(steep.orbited(0.0, -0.5).eye.y < 11.0);
    }

    #[test]
    fn pan_moves_by_heights_of_the_picture() {
        // 20 units high, 10 away.
        let panned = CAMERA.panned(0.5, -0.25);
        assert_at(&panned, [11.0, -3.0, 13.0]);
        assert_eq!(panned.target - panned.eye, CAMERA.target - CAMERA.eye);
    }

    #[test]
    fn zoom_keeps_the_target() {
        let near = CAMERA.zoomed(0.5);
        assert_at(&near, [1.0, 2.0, 8.0]);
        assert_eq!(near.target, CAMERA.target);
    }
}
