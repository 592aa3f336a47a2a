//! The caller's own cameras, in integers.

use crate::load::{read, status};
use crate::memory::{output, scene};
use crate::{gridel_camera, gridel_circle, gridel_look, gridel_scene, gridel_status};
use gridel_core::format::record::View;
use gridel_core::{Angle, Camera, Position, Scene, Up};

/// Writes the camera of the scene file.
///
/// # Safety
/// Each pointer is null, or points to what its type states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gridel_camera_of(
    loaded: *const gridel_scene,
    camera: *mut gridel_camera,
) -> gridel_status {
    let attempt = || {
        // SAFETY: the caller's promise.
        let (scene, camera) = unsafe { (scene(loaded)?, output(camera)?) };
        camera.write(of_view(scene.view()));
        Ok(())
    };
    status(attempt())
}

/// Makes a camera at one place that looks at another.
///
/// # Safety
/// Each pointer is null, or points to what its type states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gridel_look_at(
    loaded: *const gridel_scene,
    look: *const gridel_look,
    camera: *mut gridel_camera,
) -> gridel_status {
    let make = || {
        // SAFETY: the caller's promise.
        let (scene, look, camera) = unsafe { (scene(loaded)?, read(look)?, output(camera)?) };
        let [eye, target] = [look.eye, look.target].map(Position);
        let made = Camera::look_at(eye, target, look.up, Angle(look.field_of_view))?;
        camera.write(of_view(&made.view(scene)));
        Ok(())
    };
    status(make())
}

/// Makes a camera on a circle around a place.
///
/// # Safety
/// Each pointer is null, or points to what its type states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gridel_orbit(
    loaded: *const gridel_scene,
    circle: *const gridel_circle,
    camera: *mut gridel_camera,
) -> gridel_status {
    let make = || {
        // SAFETY: the caller's promise.
        let (scene, circle, camera) = unsafe { (scene(loaded)?, read(circle)?, output(camera)?) };
        let [azimuth, elevation, field_of_view] =
            [circle.azimuth, circle.elevation, circle.field_of_view].map(Angle);
        let up = match circle.up_axis {
            1 => Up::Y,
            2 => Up::Z,
            _ => return Err(gridel_status::CameraUpAxis),
        };
        let target = Position(circle.target);
        let made = Camera::orbit(
            up,
            target,
            circle.distance,
            azimuth,
            elevation,
            field_of_view,
        )?;
        camera.write(of_view(&made.view(scene)));
        Ok(())
    };
    status(make())
}

fn of_view(view: &View) -> gridel_camera {
    gridel_camera {
        eye: view.eye,
        forward: view.forward,
        right: view.right,
        up: view.up,
        reserved: 0,
    }
}

/// A scene's view with another camera; the sizes of numbers are checked where it is used.
pub(crate) fn view_from(scene: &Scene<'_>, camera: &gridel_camera) -> Result<View, gridel_status> {
    // An uninitialized camera is all zeros; one that sees very little, or half of everything, has some zeros.
    let axes = [camera.forward, camera.right, camera.up];
    if camera.reserved != 0 || axes == [[0; 3]; 3] {
        return Err(gridel_status::CameraInvalid);
    }
    Ok(View {
        eye: camera.eye,
        forward: camera.forward,
        right: camera.right,
        up: camera.up,
        ..*scene.view()
    })
}
