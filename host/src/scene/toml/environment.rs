//! The table `[environment]`.

use super::value::{Fields, Value};
use crate::scene::access::Access;
use crate::scene::{BRIGHTEST, CauseAndRemedy, Environment, Panorama, SceneError, Sky, Sun};

/// The numbers of rows that a map can have.
const SIZES: [u32; 5] = [16, 32, 64, 128, 256];

/// The keys of a gradient.
const GRADIENT: [&str; 3] = ["zenith", "horizon", "ground"];

pub(super) fn read(table: Value<'_>, access: &Access) -> Result<Environment, SceneError> {
    let own = ["image", "intensity", "rotation", "size", "sun"];
    let fields = table.fields("environment", &[&own, &GRADIENT])?;
    let of_gradient = GRADIENT.iter().find_map(|key| fields.get(key));
    let sky = match (fields.get("image"), of_gradient) {
        (Some(image), None) => picture(image, access)?,
        (Some(_), Some(value)) => {
            return Err(value.error(
                format!("an environment has an `image` or `{}`, not both", value.key),
                "remove one of them",
            ));
        }
        (None, Some(_)) => gradient(&fields)?,
        (None, None) => {
            return Err(table.error(
                "the environment has neither an `image` nor the colors of a gradient",
                "add `image = \"sky.hdr\"`, or `zenith`, `horizon` and `ground`",
            ));
        }
    };
    let is_picture = matches!(sky, Sky::Picture(_));
    if let Some(rotation) = fields.get("rotation").filter(|_| !is_picture) {
        let cause = "a gradient is the same on all sides, so `rotation` does nothing";
        return Err(rotation.error(cause, "remove the key, or give an `image`"));
    }
    let default = Environment::of(sky);
    Ok(Environment {
        intensity: fields.or("intensity", default.intensity, |it| it.number_in(0.0..=1e9))?,
        // What remains of whole turns is exact.
        rotation: fields.or("rotation", default.rotation, |it| Ok(it.number()? % 360.0))?,
        size: fields.or("size", default.size, size)?,
        sun: fields.or("sun", None, |it| sun(it).map(Some))?,
        ..default
    })
}

fn picture(image: Value<'_>, access: &Access) -> Result<Sky, SceneError> {
    let name = image.filled()?;
    let panorama = Panorama::file(access, &image.source.path, name);
    panorama
        .map(Sky::Picture)
        .map_err(|CauseAndRemedy { cause, remedy }| {
            image.error(format!("the picture of the environment {cause}"), remedy)
        })
}

fn gradient(fields: &Fields<'_>) -> Result<Sky, SceneError> {
    let color = |key| fields.require(key)?.radiance();
    Ok(Sky::Gradient {
        zenith: color("zenith")?,
        horizon: color("horizon")?,
        ground: color("ground")?,
    })
}

fn size(value: Value<'_>) -> Result<u32, SceneError> {
    let size = value.integer_in(16..=256)?;
    if SIZES.contains(&size) {
        return Ok(size);
    }
    Err(value.error(
        format!("`size` is {size}; it must be a power of two"),
        "write 16, 32, 64, 128 or 256",
    ))
}

fn sun(table: Value<'_>) -> Result<Sun, SceneError> {
    let fields = table.fields("sun", &[&["direction", "color", "radiance", "angle"]])?;
    let angle = fields.or("angle", 0.53, |value| {
        let angle = value.number()?;
        if (0.05..=90.0).contains(&angle) {
            return Ok(angle);
        }
        Err(value.error(
            format!("`angle` is {angle} degrees; it must be from 0.05 to 90"),
            "write the angle from edge to edge; the sun of the earth has 0.53",
        ))
    })?;
    let sun = Sun {
        direction: fields.require("direction")?.direction()?,
        color: [1.0; 3],
        angle,
    };
    let (value, color) = match (fields.get("color"), fields.get("radiance")) {
        (Some(_), Some(radiance)) => {
            let cause = "a sun has a `color` or a `radiance`, not both";
            return Err(radiance.error(cause, "remove one of them"));
        }
        (Some(color), None) => (color, color.radiance()?),
        (None, None) => return Ok(sun),
        (None, Some(radiance)) => {
            let part = sun.color_over_radiance();
            (radiance, radiance.color()?.map(|channel| channel * part))
        }
    };
    let sun = Sun { color, ..sun };
    if let Some(brightest) = sun.light().into_iter().find(|&it| it > BRIGHTEST) {
        return Err(value.error(
            format!(
                "a sun as bright and as large needs a light of {brightest}; it must be at most {BRIGHTEST}"
            ),
            "lower its brightness or its `angle`",
        ));
    }
    Ok(sun)
}
