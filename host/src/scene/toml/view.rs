//! The tables of the camera and the picture: `[camera]` and `[render]`.

use super::value::{Fields, Value};
use crate::scene::{Camera, Lens, RenderSettings, SceneError, ToneMapping};
use glam::DVec3;
use gridel_core::format::limits::{MAX_BOUNCES, MAX_RAY_DEPTH, MAX_SAMPLES};

/// The largest width and height of a picture.
const MAX_SIDE: u32 = 65_535;

/// Reads the camera and its lens.
pub(super) fn camera(table: Value<'_>) -> Result<(Camera, Option<Lens>), SceneError> {
    let keys = ["eye", "target", "up", "fov", "aperture", "focus"];
    let fields = table.fields("camera", &[&keys])?;
    let camera = Camera {
        eye: fields.require("eye")?.vector()?,
        target: fields.require("target")?.vector()?,
        up: fields.or("up", DVec3::Y, Value::direction)?,
        fov_degrees: fields.or("fov", 45.0, field_of_view)?,
    };
    let target = fields.require("target")?;
    let view = camera.target - camera.eye;
    if view == DVec3::ZERO {
        return Err(target.error(
            "the camera's `eye` and `target` are the same point",
            "move one of them; the camera looks from `eye` to `target`",
        ));
    }
    if !view.is_finite() {
        return Err(target.error(
            "the camera's `eye` and `target` are too far apart for 64-bit floats",
            "move them nearer to each other",
        ));
    }
    if camera.is_along_up() {
        let cause = "the camera looks along `up`, so the picture could be turned any way";
        let remedy =
            "set `up` to a direction across the view, such as [0, 0, 1] for a view from above";
        return Err(fields.get("up").unwrap_or(target).error(cause, remedy));
    }
    Ok((camera, lens(&fields)?))
}

fn lens(fields: &Fields<'_>) -> Result<Option<Lens>, SceneError> {
    let aperture = fields.or("aperture", 0.0, aperture)?;
    let focus = fields.or("focus", None, |value| value.positive().map(Some))?;
    if let Some(value) = fields.get("focus").filter(|_| aperture == 0.0) {
        return Err(value.error(
            "a camera without an `aperture` is a pinhole, and has no `focus`: its picture is sharp everywhere",
            "write the lens's diameter in scene units, such as `aperture = 0.1`, or remove `focus`",
        ));
    }
    let radius = 0.5 * aperture;
    Ok((radius > 0.0).then_some(Lens { radius, focus }))
}

fn aperture(value: Value<'_>) -> Result<f64, SceneError> {
    let aperture = value.number()?;
    if aperture >= 0.0 {
        return Ok(aperture);
    }
    Err(value.error(
        format!("`{}` is {aperture}; it must be 0 or more", value.key),
        "write the diameter of the lens in scene units, or 0 for a pinhole",
    ))
}

pub(super) fn field_of_view(value: Value<'_>) -> Result<f64, SceneError> {
    let degrees = value.number()?;
    if degrees > 0.0 && degrees < 180.0 {
        return Ok(degrees);
    }
    Err(value.error(
        format!(
            "`{}` is {degrees} degrees; it must be above 0 and below 180",
            value.key
        ),
        "write the full vertical angle of view in degrees, such as 45",
    ))
}

pub(super) fn render(table: Value<'_>) -> Result<RenderSettings, SceneError> {
    let keys = [
        "width",
        "height",
        "samples",
        "depth",
        "bounces",
        "cutoff",
        "shadows",
        "exposure",
        "tone_mapping",
    ];
    let fields = table.fields("render table", &[&keys])?;
    let default = RenderSettings::default();
    let side = |value: Value<'_>| value.integer_in(1..=MAX_SIDE);
    let width = fields.or("width", default.width, side)?;
    let height = fields.or("height", default.height, side)?;
    if width > RenderSettings::MAX_ASPECT * height {
        return Err(table.error(
            format!(
                "a picture of {width} by {height} is more than {} times as wide as high",
                RenderSettings::MAX_ASPECT
            ),
            "write a smaller `width` or a larger `height`",
        ));
    }
    Ok(RenderSettings {
        width,
        height,
        samples: fields.or("samples", default.samples, |value| {
            Ok(value.integer_in(1..=MAX_SAMPLES.into())? as u16)
        })?,
        depth: fields.or("depth", default.depth, |value| {
            Ok(value.integer_in(0..=MAX_RAY_DEPTH as u32)? as u8)
        })?,
        bounces: fields.or("bounces", default.bounces, |value| {
            Ok(value.integer_in(0..=MAX_BOUNCES as u32)? as u8)
        })?,
        cutoff: fields.or("cutoff", default.cutoff, |value| value.number_in(0.0..=1.0))?,
        shadows: fields.or("shadows", default.shadows, Value::boolean)?,
        exposure: fields.or("exposure", 0.0, |value| value.number_in(-32.0..=32.0))?,
        tone_mapping: fields.or("tone_mapping", ToneMapping::None, |value| {
            value.one_of(ToneMapping::ALL, ToneMapping::name)
        })?,
    })
}
