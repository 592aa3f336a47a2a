//! The tables `[[light]]`.

use super::value::{Fields, Value};
use crate::scene::{Light, LightForm, LightShape, SceneError, SourceSpan, Spot};
use glam::DVec3;

/// A light, its name, form and place.
pub(super) type Lit = (Light, (String, (Option<LightForm>, SourceSpan)));

const KINDS: [&str; 6] = [
    "point",
    "directional",
    "spot",
    "sphere",
    "rectangle",
    "disc",
];

/// The keys that belong to some kinds only, with these.
const OWN: [(&str, &[&str]); 14] = [
    ("position", &["point", "spot"]),
    ("direction", &["directional", "spot"]),
    ("color", &["point", "directional", "spot"]),
    ("falloff", &["point", "spot"]),
    ("range", &["point", "spot"]),
    ("inner", &["spot"]),
    ("outer", &["spot"]),
    ("center", &["sphere", "disc"]),
    ("radius", &["sphere", "disc"]),
    ("normal", &["disc"]),
    ("corner", &["rectangle"]),
    ("edges", &["rectangle"]),
    ("radiance", &["sphere", "rectangle", "disc"]),
    ("visible", &["sphere", "rectangle", "disc"]),
];

/// Reads lights.
pub(super) fn lights(tables: Value<'_>) -> Result<Vec<Lit>, SceneError> {
    tables
        .items("`[[light]]` above the keys of each")?
        .map(light)
        .collect()
}

fn light(table: Value<'_>) -> Result<Lit, SceneError> {
    let own: Vec<&str> = OWN.iter().map(|(key, _)| *key).collect();
    let fields = table.fields("light", &[&["kind", "name"], &own])?;
    let name = fields.or("name", String::new(), |value| {
        value.filled().map(str::to_owned)
    })?;
    let kind = fields.require("kind")?.word(&KINDS)?;
    for (key, kinds) in OWN {
        if let Some(value) = fields.get(key).filter(|_| !kinds.contains(&kind)) {
            return Err(value.error(
                format!("a light of this kind has no `{key}`"),
                "remove the key, or change the light's `kind`",
            ));
        }
    }
    let (light, form) = match kind {
        "directional" => {
            let direction = fields.require("direction")?.direction()?;
            let color = fields.or("color", [1.0; 3], Value::radiance)?;
            (Light::Directional { direction, color }, None)
        }
        "point" | "spot" => {
            let position = fields.require("position")?.vector()?;
            let form = of_point(kind, &fields)?;
            // Light that falls off has an exponent of its own in the blob.
            let read = match form.is_some_and(|form| form.falls_off) {
                true => Value::bright_radiance,
                false => Value::radiance_of_points,
            };
            let color = fields.or("color", [1.0; 3], read)?;
            (Light::Point { position, color }, form)
        }
        _ => {
            let (position, shape) = area(kind, &fields)?;
            let form = LightForm {
                shape,
                is_visible: fields.or("visible", false, Value::boolean)?,
                ..LightForm::default()
            };
            let radiance = fields.require("radiance")?;
            // Surfaces that are seen hold less.
            let color = match form.is_visible {
                true => radiance.radiance_of_visible()?,
                false => radiance.bright_radiance()?,
            };
            (Light::Point { position, color }, Some(form))
        }
    };
    Ok((light, (name, (form, table.place()))))
}

/// The form of a point light or a spot.
fn of_point(kind: &str, fields: &Fields<'_>) -> Result<Option<LightForm>, SceneError> {
    let falls_off = fields.or("falloff", false, |value| {
        Ok(value.word(&["none", "square"])? == "square")
    })?;
    let range = fields.or("range", None, |value| value.positive().map(Some))?;
    let spot = if kind == "spot" {
        let angle = |value: Value<'_>| value.number_in(0.0..=90.0);
        let outer = fields.or("outer", 45.0, angle)?;
        let inner = fields.or("inner", 0.0, angle)?;
        if inner > outer || outer == 0.0 {
            let value = fields.get("outer").or(fields.get("inner"));
            let cause = format!(
                "the spot's `inner` angle, {inner} degrees, must be at most its `outer` one, {outer}, and that above 0"
            );
            let value = value.unwrap_or(fields.require("kind")?);
            return Err(value.error(
                cause,
                "write half the angle of the cone, such as `outer = 30`",
            ));
        }
        let least = Spot::LEAST_OUTER;
        if let Some(value) = fields.get("outer").filter(|_| outer < least) {
            let cause = format!(
                "the spot's `outer` angle is {outer} degrees; it must be at least {least}, so that `f32` holds its light"
            );
            return Err(value.error(cause, "write at least 0.3, or use a directional light"));
        }
        let direction = fields.require("direction")?.direction()?;
        Some(Spot {
            direction,
            inner,
            outer,
        })
    } else {
        None
    };
    let plain = !falls_off && range.is_none() && spot.is_none();
    Ok((!plain).then_some(LightForm {
        shape: LightShape::Point,
        falls_off,
        range,
        spot,
        ..LightForm::default()
    }))
}

/// The position and the shape of an area.
fn area(kind: &str, fields: &Fields<'_>) -> Result<(DVec3, LightShape), SceneError> {
    if kind == "rectangle" {
        let value = fields.require("edges")?;
        let edges: Vec<DVec3> = value
            .items("two vectors, such as `[[1, 0, 0], [0, 0, 1]]`")?
            .map(Value::vector)
            .collect::<Result<_, _>>()?;
        let remedy = "write two perpendicular vectors that lead from `corner` along its sides";
        let &[first, second] = &edges[..] else {
            let cause = format!("`edges` has {} vectors; a rectangle has two", edges.len());
            return Err(value.error(cause, remedy));
        };
        let lengths = first.length() * second.length();
        if !(lengths > 0.0 && lengths.is_finite() && first.dot(second).abs() <= 1e-6 * lengths) {
            let cause = "the edges of a rectangle must be perpendicular and have lengths";
            return Err(value.error(cause, remedy));
        }
        let corner = fields.require("corner")?.vector()?;
        return Ok((
            corner,
            LightShape::Rectangle {
                edges: [first, second],
            },
        ));
    }
    let center = fields.require("center")?.vector()?;
    let radius = fields.require("radius")?.positive()?;
    let shape = if kind == "sphere" {
        LightShape::Sphere { radius }
    } else {
        let normal = fields.require("normal")?.direction()?;
        LightShape::Disc { normal, radius }
    };
    Ok((center, shape))
}

#[cfg(test)]
mod tests {
    use crate::scene::{Imported, SceneError};

    fn light(text: &str) -> Result<Imported, SceneError> {
        let file = format!("[[light]]\n{text}");
        crate::scene::read("light.toml".as_ref(), file.into(), &Default::default())
    }

    #[test]
    fn spots_that_are_too_narrow_for_f32_are_rejected() {
        let spot = "kind = 'spot'\nposition = [0, 9, 0]\ndirection = [0, -1, 0]\nouter = ";
        light(&format!("{spot}0.3")).unwrap();
        for outer in ["0.29", "0.05", "1e-9"] {
            let error = light(&format!("{spot}{outer}")).unwrap_err();
            assert!(error.cause.contains("at least 0.3"), "{error}");
            assert_eq!(error.line, Some(5));
        }
    }

    #[test]
    fn lights_that_fall_off_or_have_an_area_may_be_bright() {
        let point = "kind = 'point'\nposition = [0, 9, 0]\ncolor = 1e6\n";
        light(&format!("{point}falloff = 'square'")).unwrap();
        let error = light(point).unwrap_err();
        assert!(error.remedy.contains("falloff"), "{}", error.remedy);
        let sphere = "kind = 'sphere'\ncenter = [0, 9, 0]\nradius = 1\nradiance = 1e6\n";
        light(sphere).unwrap();
        let error = light(&format!("{sphere}visible = true")).unwrap_err();
        assert!(error.remedy.contains("visible"), "{}", error.remedy);
    }
}
