//! Pictures.

use crate::camera::view_from;
use crate::load::{read, status};
use crate::memory::{elements, output, scene, workspace, workspace_bytes, zeroed};
use crate::{
    Accel, gridel_buffer, gridel_camera, gridel_picture, gridel_pixel_format, gridel_rectangle,
    gridel_scene, gridel_status,
};
use core::mem::MaybeUninit;
use gridel_core::render::Pixel;
use gridel_core::{
    BlobError, Effects, Fixed, NoCount, Number, Renderer, Rgb565, Rgb888, Scene, Settings,
};

/// The effects that this build has code for.
const EFFECTS: u32 = Effects::AVAILABLE.0;

/// Writes the settings of the scene file, without dithering, in RGB888.
///
/// # Safety
/// Each pointer is null, or points to what its type states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gridel_picture_of(
    loaded: *const gridel_scene,
    picture: *mut gridel_picture,
) -> gridel_status {
    let attempt = || {
        // SAFETY: the caller's promise.
        let (scene, picture) = unsafe { (scene(loaded)?, output(picture)?) };
        let settings = Settings::of(scene);
        picture.write(gridel_picture {
            width: settings.width,
            height: settings.height,
            samples: settings.samples,
            depth: settings.depth.into(),
            dither: 0,
            pixel_format: gridel_pixel_format::Rgb888 as u16,
        });
        Ok(())
    };
    status(attempt())
}

/// Writes the bytes of the workspace that a picture needs in `fixed`, which starts at a multiple of 8 bytes.
///
/// # Safety
/// Each pointer is null, or points to what its type states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gridel_workspace_bytes_fixed(
    loaded: *const gridel_scene,
    picture: *const gridel_picture,
    needed: *mut usize,
) -> gridel_status {
    // SAFETY: the caller's promise.
    status(unsafe { count::<Fixed>(loaded, picture, needed) })
}

/// Writes the bytes of the workspace that a picture needs in `f32`, which starts at a multiple of 8 bytes.
///
/// # Safety
/// Each pointer is null, or points to what its type states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gridel_workspace_bytes_f32(
    loaded: *const gridel_scene,
    picture: *const gridel_picture,
    needed: *mut usize,
) -> gridel_status {
    // SAFETY: the caller's promise.
    status(unsafe { count::<f32>(loaded, picture, needed) })
}

/// Writes the bytes of the workspace that a picture needs in `f64`, which starts at a multiple of 8 bytes.
///
/// # Safety
/// Each pointer is null, or points to what its type states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gridel_workspace_bytes_f64(
    loaded: *const gridel_scene,
    picture: *const gridel_picture,
    needed: *mut usize,
) -> gridel_status {
    // SAFETY: the caller's promise.
    status(unsafe { count::<f64>(loaded, picture, needed) })
}

/// Renders a rectangle of a picture, such as a row, in integers. `pixels` holds its rows one behind the other; `workspace`
/// is memory of `gridel_workspace_bytes_fixed` bytes. Pixels do not depend on each other: a picture is the same bytes
/// whatever its rectangles. Each row is black from when it is begun until its pixels are written. Where that would be
/// seen, render into other memory than that which is shown.
///
/// # Safety
/// Each pointer is null, or points to what its type states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gridel_render_fixed(
    loaded: *const gridel_scene,
    picture: *const gridel_picture,
    rectangle: *const gridel_rectangle,
    pixels: gridel_buffer,
    workspace: gridel_buffer,
) -> gridel_status {
    // SAFETY: the caller's promise.
    status(unsafe { render::<Fixed>(loaded, picture, rectangle, pixels, workspace) })
}

/// Renders a rectangle of a picture, such as a row, in single precision: see `gridel_render_fixed`.
///
/// # Safety
/// Each pointer is null, or points to what its type states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gridel_render_f32(
    loaded: *const gridel_scene,
    picture: *const gridel_picture,
    rectangle: *const gridel_rectangle,
    pixels: gridel_buffer,
    workspace: gridel_buffer,
) -> gridel_status {
    // SAFETY: the caller's promise.
    status(unsafe { render::<f32>(loaded, picture, rectangle, pixels, workspace) })
}

/// Renders a rectangle of a picture, such as a row, in double precision: see `gridel_render_fixed`.
///
/// # Safety
/// Each pointer is null, or points to what its type states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gridel_render_f64(
    loaded: *const gridel_scene,
    picture: *const gridel_picture,
    rectangle: *const gridel_rectangle,
    pixels: gridel_buffer,
    workspace: gridel_buffer,
) -> gridel_status {
    // SAFETY: the caller's promise.
    status(unsafe { render::<f64>(loaded, picture, rectangle, pixels, workspace) })
}

/// Renders a rectangle of a picture as seen by a camera that was made for this scene, in integers: see
/// `gridel_render_fixed`.
///
/// # Safety
/// Each pointer is null, or points to what its type states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gridel_render_from_fixed(
    loaded: *const gridel_scene,
    camera: *const gridel_camera,
    picture: *const gridel_picture,
    rectangle: *const gridel_rectangle,
    pixels: gridel_buffer,
    workspace: gridel_buffer,
) -> gridel_status {
    // SAFETY: the caller's promise.
    status(unsafe { render_from::<Fixed>(loaded, camera, picture, rectangle, pixels, workspace) })
}

/// Renders a rectangle of a picture as seen by a camera that was made for this scene, in single precision: see
/// `gridel_render_fixed`.
///
/// # Safety
/// Each pointer is null, or points to what its type states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gridel_render_from_f32(
    loaded: *const gridel_scene,
    camera: *const gridel_camera,
    picture: *const gridel_picture,
    rectangle: *const gridel_rectangle,
    pixels: gridel_buffer,
    workspace: gridel_buffer,
) -> gridel_status {
    // SAFETY: the caller's promise.
    status(unsafe { render_from::<f32>(loaded, camera, picture, rectangle, pixels, workspace) })
}

/// Renders a rectangle of a picture as seen by a camera that was made for this scene, in double precision: see
/// `gridel_render_fixed`.
///
/// # Safety
/// Each pointer is null, or points to what its type states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gridel_render_from_f64(
    loaded: *const gridel_scene,
    camera: *const gridel_camera,
    picture: *const gridel_picture,
    rectangle: *const gridel_rectangle,
    pixels: gridel_buffer,
    workspace: gridel_buffer,
) -> gridel_status {
    // SAFETY: the caller's promise.
    status(unsafe { render_from::<f64>(loaded, camera, picture, rectangle, pixels, workspace) })
}

/// Entries of the stack, and places for waiting rays. Effects without code in a build take no place.
fn depths(scene: &Scene<'_>, depth: u8) -> [usize; 2] {
    [scene.stack_depth(), scene.effects().work_depth(depth)]
}

/// # Safety
/// Each pointer is null, or points to what its type states.
unsafe fn count<N: Number>(
    loaded: *const gridel_scene,
    picture: *const gridel_picture,
    needed: *mut usize,
) -> Result<(), gridel_status> {
    // SAFETY: the caller's promise.
    let (scene, picture, needed) = unsafe { (scene(loaded)?, read(picture)?, output(needed)?) };
    let settings = settings(&picture)?;
    Renderer::<N, Accel, EFFECTS>::with_settings(scene, settings)?;
    needed.write(workspace_bytes::<N>(depths(scene, settings.depth)));
    Ok(())
}

fn settings(picture: &gridel_picture) -> Result<Settings, gridel_status> {
    Ok(Settings {
        width: picture.width,
        height: picture.height,
        samples: picture.samples,
        depth: u8::try_from(picture.depth).map_err(|_| gridel_status::PictureDepth)?,
        dither: picture.dither != 0,
    })
}

/// # Safety
/// Each pointer is null, or points to what its type states.
unsafe fn render<N: Number>(
    loaded: *const gridel_scene,
    picture: *const gridel_picture,
    rectangle: *const gridel_rectangle,
    pixels: gridel_buffer,
    memory: gridel_buffer,
) -> Result<(), gridel_status> {
    // SAFETY: the caller's promise.
    let (scene, picture, rectangle) = unsafe { (scene(loaded)?, read(picture)?, read(rectangle)?) };
    // SAFETY: the caller's promise.
    unsafe { render_scene::<N>(scene, (picture, rectangle), pixels, memory) }
}

/// # Safety
/// Each pointer is null, or points to what its type states.
unsafe fn render_from<N: Number>(
    loaded: *const gridel_scene,
    camera: *const gridel_camera,
    picture: *const gridel_picture,
    rectangle: *const gridel_rectangle,
    pixels: gridel_buffer,
    memory: gridel_buffer,
) -> Result<(), gridel_status> {
    // SAFETY: the caller's promise.
    let (scene, picture, rectangle) = unsafe { (scene(loaded)?, read(picture)?, read(rectangle)?) };
    // SAFETY: the caller's promise.
    let view = view_from(scene, &unsafe { read(camera) }?)?;
    let seen = scene.with_view(&view);
    let seen = seen.map_err(|error| match error {
        BlobError::MissingEffects { .. } => error.into(),
        _ => gridel_status::CameraInvalid,
    })?;
    // SAFETY: the caller's promise.
    unsafe { render_scene::<N>(&seen, (picture, rectangle), pixels, memory) }
}

/// # Safety
/// Each pointer is null, or points to what its type states.
unsafe fn render_scene<N: Number>(
    scene: &Scene<'_>,
    (picture, rectangle): (gridel_picture, gridel_rectangle),
    pixels: gridel_buffer,
    memory: gridel_buffer,
) -> Result<(), gridel_status> {
    let settings = settings(&picture)?;
    let renderer = Renderer::<N, Accel, EFFECTS>::with_settings(scene, settings)?;
    let end = |first: u16, count: u16| u32::from(first).saturating_add(count.into());
    if end(rectangle.x, rectangle.width) > picture.width.into()
        || end(rectangle.y, rectangle.height) > picture.height.into()
    {
        return Err(gridel_status::PictureRectangle);
    }
    // SAFETY: the caller's promise.
    let mut space = unsafe { workspace::<N>(depths(scene, settings.depth), memory) }?;
    renderer.check_workspace(&space)?;
    let [width, height] = [rectangle.width, rectangle.height].map(usize::from);
    let count = width.saturating_mul(height);
    let target = match picture.pixel_format {
        // SAFETY: the caller's promise.
        0 => Target::Rgb888(unsafe { elements(pixels, count) }?),
        // SAFETY: the caller's promise.
        1 => Target::Rgb565(unsafe { elements(pixels, count) }?),
        _ => return Err(gridel_status::PictureFormat),
    };
    let rows = Rows {
        renderer,
        rectangle,
    };
    match target {
        // SAFETY: bytes of 0 are pixels.
        Target::Rgb888(pixels) => unsafe { rows.fill::<Rgb888>(pixels, &mut space) },
        // SAFETY: bytes of 0 are pixels.
        Target::Rgb565(pixels) => unsafe { rows.fill::<Rgb565>(pixels, &mut space) },
    }
    Ok(())
}

/// The caller's pixels.
enum Target<'p> {
    Rgb888(&'p mut [MaybeUninit<Rgb888>]),
    Rgb565(&'p mut [MaybeUninit<Rgb565>]),
}

/// A rectangle of a picture.
struct Rows<'s, 'a, N: Number> {
    renderer: Renderer<'s, 'a, N, Accel, EFFECTS>,
    rectangle: gridel_rectangle,
}

impl<N: Number> Rows<'_, '_, N> {
    /// Renders the rows. Each is set to 0 on its own: a whole picture would turn black while it may be shown.
    ///
    /// # Safety
    /// Bytes of 0 are a pixel.
    unsafe fn fill<P: Pixel>(
        &self,
        pixels: &mut [MaybeUninit<P>],
        space: &mut gridel_core::render::WorkspaceView<'_, N>,
    ) {
        let gridel_rectangle { x, y, width, .. } = self.rectangle;
        // `chunks_mut` of no columns would panic.
        let rows = pixels.chunks_mut(usize::from(width).max(1));
        for (row, y) in rows.zip(y..) {
            // SAFETY: the caller's promise.
            let row = unsafe { zeroed(row) };
            self.renderer.row(x, y, row, space, &mut NoCount);
        }
    }
}
