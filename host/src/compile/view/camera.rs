//! Places the camera of a scene file as a device places one of its own: by the core's integers.

use super::coordinates::position;
use crate::compile::CompileError;
use crate::scene::Camera;
use crate::shape::exp2;
use glam::DVec3;
use gridel_core::format::record::Header;
use gridel_core::render::CameraError;
use gridel_core::{Angle, Camera as Placed};

/// Returns the camera in the integer coordinates of a header.
///
/// Its direction is that of the scene file's numbers, which can be finer than coordinates are. Where they are multiples
/// of the step, it equals that of [`Placed::look_at`], bit for bit.
pub fn place(camera: &Camera, header: &Header) -> Result<Placed, CompileError> {
    let eye = position(header, camera.eye).ok_or(CameraError::EyeOutOfRange);
    let placed = eye.and_then(|eye| {
        let direction = integers(camera.direction());
        let up = integers(camera.up);
        Placed::look_along(eye, direction, up, angle(camera.fov_degrees))
    });
    placed.map_err(|source| match source {
        CameraError::EyeOutOfRange => CompileError::EyeOutOfReach {
            reach: exp2(31 + header.coordinate_exponent()),
            from: DVec3::from_array(header.coordinate_origin()),
        },
        source => CompileError::Camera { source },
    })
}

/// Returns a direction of 30 bits, scaled by a power of two, so that integers keep their ratios.
pub fn integers(direction: DVec3) -> [i32; 3] {
    let (_, exponent) = libm::frexp(direction.abs().max_element());
    let scaled = |x: f64| libm::ldexp(x, 30 - exponent).round() as i32;
    direction.to_array().map(scaled)
}

/// Returns the nearest angle at which a camera sees something.
pub fn angle(degrees: f64) -> Angle {
    let steps = (degrees / 360.0 * exp2(32)).round() as u32;
    Angle(steps.clamp(2, Angle::HALF.0 - 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use bytemuck::Zeroable;
    use gridel_core::Position;

    fn header() -> Header {
        Header {
            unit_exponent: -13,
            counted_from: 1,
            ..Header::zeroed()
        }
    }

    /// In steps of 2^-26.
    fn place_steps(steps: [i32; 3]) -> DVec3 {
        DVec3::from_array(steps.map(f64::from)) * exp2(-26)
    }

    #[test]
    fn a_camera_on_coordinate_steps_is_placed_as_a_device_places_it() {
        let [eye, target] = [[7, -9_000_001, 123_456_789], [-5, 8, 999]];
        let up = [1, 250, -3];
        for degrees in [1, 45, 90, 179] {
            let camera = Camera {
                eye: place_steps(eye),
                target: place_steps(target),
                up: DVec3::from_array(up.map(f64::from)),
                fov_degrees: f64::from(degrees),
            };
            let device =
                Placed::look_at(Position(eye), Position(target), up, Angle::degrees(degrees));
            assert_eq!(place(&camera, &header()).unwrap(), device.unwrap());
        }
    }

    #[test]
    fn cameras_that_do_not_look_along_up_are_placed() {
        let (mut placed, mut along) = (0, 0);
        for exponent in -20..=-12 {
            for step in 0..200 {
                let turn = DVec3::new(f64::from(step) * 0.7, f64::from(step) * 0.3, 1.0);
                let direction = DVec3::new(libm::sin(turn.x), libm::cos(turn.y), libm::cos(turn.x));
                let across = direction.any_orthogonal_vector().normalize();
                let camera = Camera {
                    eye: DVec3::ZERO,
                    target: direction,
                    up: direction.normalize() + across * exp2(exponent),
                    fov_degrees: 45.0,
                };
                if camera.is_along_up() {
                    along += 1;
                    assert!(exponent <= -15);
                } else {
                    placed += 1;
                    assert!(exponent >= -15);
                    place(&camera, &header()).unwrap();
                }
            }
        }
        assert!(placed > 500 && along > 500, "{placed}, {along}");
    }

    #[test]
    fn directions_of_every_length_and_angles_at_their_ends_are_placed() {
        let sane = Camera {
            eye: DVec3::ZERO,
            target: DVec3::NEG_Z,
            up: DVec3::Y,
            fov_degrees: 45.0,
        };
        for length in [5e-324, 1e-300, 1.0, 1e308, f64::MAX] {
            let far = Camera {
                target: DVec3::NEG_Z * length,
                up: DVec3::Y * length,
                ..sane
            };
            let placed = place(&far, &header()).unwrap();
            assert_eq!(placed, place(&sane, &header()).unwrap(), "{length}");
        }
        for fov_degrees in [1e-12, 1e-3, 179.999_999_999_999] {
            assert!(
                place(
                    &Camera {
                        fov_degrees,
                        ..sane
                    },
                    &header()
                )
                .is_ok()
            );
        }
        let eye = DVec3::X * 33.0;
        let error = place(&Camera { eye, ..sane }, &header()).unwrap_err();
        assert_eq!(
            error.to_string(),
            "the camera's eye is more than 3.200e1 scene units from (0, 0, 0) along an axis, where the \
             blob's coordinates end"
        );
    }
}
