//! Transforms of objects, as a file states them.

use super::value::{Fields, Value};
use crate::scene::{Placement, SceneError};
use crate::shape::unit;
use glam::{DAffine3, DMat3, DQuat, DVec3};

/// The keys that state a transform.
pub(super) const KEYS: &[&str] = &["translate", "rotate", "scale"];

/// Reads `scale`, `rotate` and `translate`, which apply in this order.
pub(super) fn read(fields: &Fields<'_>) -> Result<DAffine3, SceneError> {
    let scale = fields.or("scale", DVec3::ONE, scale)?;
    let rotation = fields.or("rotate", DMat3::IDENTITY, rotation)?;
    let translation = fields.or("translate", DVec3::ZERO, Value::vector)?;
    Ok(DAffine3 {
        matrix3: rotation * DMat3::from_diagonal(scale),
        translation,
    })
}

/// Reads the keys of an instance, which is scaled by one number.
pub(super) fn placement(fields: &Fields<'_>) -> Result<Placement, SceneError> {
    let scale = fields.or("scale", 1.0, |value| {
        if value.is_array() {
            return Err(value.error(
                "`scale` holds several numbers; an instance is scaled by one, the same on every axis",
                "write one number above 0, or use a group for objects that are scaled unevenly",
            ));
        }
        value.positive()
    })?;
    let rotation = fields.or("rotate", DMat3::IDENTITY, rotation)?;
    Ok(Placement {
        rotation: DQuat::from_mat3(&rotation).normalize(),
        translation: fields.or("translate", DVec3::ZERO, Value::vector)?,
        scale,
    })
}

fn scale(value: Value<'_>) -> Result<DVec3, SceneError> {
    let scale = if value.is_array() {
        value.vector()?
    } else {
        DVec3::splat(value.number()?)
    };
    if scale.cmpeq(DVec3::ZERO).any() {
        return Err(value.error(
            "a scale of 0 flattens the object to nothing",
            "scale by numbers other than 0; negative ones mirror",
        ));
    }
    Ok(scale)
}

/// `[x, y, z]`: degrees about these axes, in this order; or `{ axis, degrees }`.
pub(super) fn rotation(value: Value<'_>) -> Result<DMat3, SceneError> {
    if value.is_table() {
        let fields = value.fields("rotation", &[&["axis", "degrees"]])?;
        let axis = fields.require("axis")?.direction()?;
        let degrees = fields.require("degrees")?.number()?;
        return Ok(about(unit(axis), degrees));
    }
    if !value.is_array() {
        return Err(value.mistyped(
            "angles about x, y and z, or a table with an axis and degrees",
            "`rotate = [0, 90, 0]` or `rotate = { axis = [1, 1, 0], degrees = 90 }`",
        ));
    }
    let angles = value.vector()?;
    Ok(about(DVec3::Z, angles.z) * about(DVec3::Y, angles.y) * about(DVec3::X, angles.x))
}

/// Rodrigues' rotation; exact for multiples of 90 degrees about x, y and z.
fn about(axis: DVec3, degrees: f64) -> DMat3 {
    let (sine, cosine) = match degrees.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        // libm, because the standard library's sines differ from one machine to another.
        other => libm::sincos(other.to_radians()),
    };
    let cross = DMat3::from_cols(
        DVec3::new(0.0, axis.z, -axis.y),
        DVec3::new(-axis.z, 0.0, axis.x),
        DVec3::new(axis.y, -axis.x, 0.0),
    );
    let outer = DMat3::from_cols(axis * axis.x, axis * axis.y, axis * axis.z);
    DMat3::IDENTITY * cosine + cross * sine + outer * (1.0 - cosine)
}
