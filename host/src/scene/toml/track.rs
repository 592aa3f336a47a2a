//! The `[[track]]` tables: values of the camera, of lights, materials, joints and morph targets at some times.

use super::hinge;
use super::joint::Joints;
use super::material::Materials;
use super::morph::{self, Morphs};
use super::source::{Name, Source, Span, nearest};
use super::transform;
use super::value::{Fields, Value};
use super::view::field_of_view;
use crate::scene::size::Keys;
use crate::scene::{
    Diffuse, Interpolation, Key, LARGEST_SCALE, LEAST_SCALE, Light, LightForm, SceneError, Track,
    TrackTarget,
};
use crate::table::{counted, shortened};
use glam::{DQuat, DVec3};
use gridel_core::format::track::ValueKind;
use std::collections::HashMap;

const KEYS: &[&str] = &[
    "target",
    "times",
    "values",
    "interpolation",
    "tangents",
    "axis",
];

const CAMERA: [(&str, TrackTarget); 5] = [
    ("eye", TrackTarget::CameraEye),
    ("target", TrackTarget::CameraTarget),
    ("up", TrackTarget::CameraUp),
    ("fov", TrackTarget::CameraFieldOfView),
    ("orbit", TrackTarget::CameraOrbit),
];

const LIGHT: [(&str, TrackTarget); 3] = [
    ("position", TrackTarget::LightPosition),
    ("direction", TrackTarget::LightDirection),
    ("color", TrackTarget::LightColor),
];

const EVEN: &str = "checker.even";
const MATERIAL: [(&str, TrackTarget); 6] = [
    ("diffuse", TrackTarget::MaterialDiffuse),
    (EVEN, TrackTarget::MaterialDiffuse),
    ("checker.odd", TrackTarget::MaterialOdd),
    ("highlight", TrackTarget::MaterialHighlight),
    ("mirror", TrackTarget::MaterialMirror),
    ("transmit", TrackTarget::MaterialTransmit),
];

const JOINT: [(&str, TrackTarget); 3] = [
    ("rotation", TrackTarget::JointRotation),
    ("shift", TrackTarget::JointShift),
    ("scale", TrackTarget::JointScale),
];

const MORPH: [(&str, TrackTarget); 1] = [("weight", TrackTarget::MorphWeight)];

/// A track whose light, material, joint or morph target is not looked up yet.
pub(super) struct Unresolved {
    owner: Owner,
    /// The target's text and place.
    target: Name,
    property: &'static str,
    track: Track,
}

enum Owner {
    Camera,
    Light(String),
    Material(String),
    Joint(String),
    Morph(String),
}

/// Reads the tables, and counts their keys. A track of angles has more of them than the file.
pub(super) fn read(tables: Value<'_>, keys: &mut Keys) -> Result<Vec<Unresolved>, SceneError> {
    let mut tracks = Vec::new();
    for table in tables.items("`[[track]]` above the keys of each")? {
        let track = track(table)?;
        keys.add(track.track.keys.len() as u64).map_err(|excess| {
            let cause = format!("with this track, tracks have {excess}");
            table.error(cause, "write fewer keys, or fewer turns")
        })?;
        tracks.push(track);
    }
    Ok(tracks)
}

fn track(table: Value<'_>) -> Result<Unresolved, SceneError> {
    let fields = table.fields("track", &[KEYS])?;
    let target = fields.require("target")?;
    let (owner, property, moved) = parse(target)?;
    let interpolation = fields.or("interpolation", Interpolation::Linear, |value| {
        value.one_of(Interpolation::ALL, Interpolation::name)
    })?;
    let axis = fields.get("axis");
    if let Some(axis) = axis.filter(|_| moved != TrackTarget::JointRotation) {
        return Err(axis.error(
            "a track has an `axis` only where its target is the rotation of a joint",
            "remove the key",
        ));
    }
    let mut keys = keys(&fields, moved)?;
    let tangents = fields.get("tangents");
    let rotations = moved.kind() == ValueKind::Rotation && axis.is_none();
    if let Some(tangents) = tangents.filter(|_| rotations) {
        return Err(tangents.error(
            "rotations without an `axis` have no `tangents`",
            "remove the key, or give the track an `axis` and angles",
        ));
    }
    if rotations {
        hinge::on_one_side(&mut keys);
    }
    if interpolation == Interpolation::Cubic {
        match tangents {
            Some(tangents) => {
                let one = axis.is_some() || moved.kind().components() == 1;
                given_tangents(tangents, one, &mut keys)?;
            }
            None => smooth_tangents(&mut keys),
        }
    } else if let Some(tangents) = tangents {
        return Err(tangents.error(
            format!(
                "a track with {} interpolation has no `tangents`",
                interpolation.name()
            ),
            "remove the key, or write `interpolation = \"cubic\"`",
        ));
    }
    if let Some(axis) = axis {
        let axis = axis.direction()?;
        keys = hinge::rotations(axis, interpolation, &keys)
            .map_err(|(cause, remedy)| fields_error(&fields, cause, remedy))?;
    }
    Ok(Unresolved {
        owner,
        target: target.name()?,
        property,
        track: Track {
            target: moved,
            index: 0,
            interpolation,
            keys,
            place: table.source.place(&fields.span),
        },
    })
}

/// The error of the values of a track.
fn fields_error(fields: &Fields<'_>, cause: String, remedy: &str) -> SceneError {
    match fields.get("values") {
        Some(values) => values.error(cause, remedy),
        None => fields.source.error(&fields.span, cause, remedy),
    }
}

/// Parses a target: its owner, its name, and the property.
fn parse(target: Value<'_>) -> Result<(Owner, &'static str, TrackTarget), SceneError> {
    const EXAMPLES: &str = "write a property of the camera, a light, a material, a joint or a morph target, such as \"camera.eye\", \
         \"light.0.color\", \"material.glass.transmit\", \"joint.elbow.rotation\" or \"morph.smile.weight\"";
    let text = target.filled()?;
    let Some((owner, rest)) = text.split_once('.') else {
        return Err(target.error(
            format!(
                "`target` is {text:?}, which names no property",
                text = shortened(text)
            ),
            EXAMPLES,
        ));
    };
    let unknown = |properties: &[(&'static str, TrackTarget)]| {
        let names: Vec<_> = properties.iter().map(|(name, _)| *name).collect();
        let last = rest.rsplit('.').next().unwrap_or(rest);
        let near = nearest(last, names.iter().copied()).unwrap_or_default();
        target.error(
            format!(
                "`target` is {text:?}, and a {owner} has no such property that moves",
                text = shortened(text)
            ),
            format!(
                "did you mean `{near}`? The properties are {}",
                names.join(", ")
            ),
        )
    };
    let named = |properties: &[(&'static str, TrackTarget)]| {
        let mut all = properties.iter();
        let found = all.find_map(|&(name, moved)| {
            let owner = rest.strip_suffix(name)?.strip_suffix('.')?;
            (!owner.is_empty()).then(|| (owner.to_owned(), name, moved))
        });
        found.ok_or_else(|| unknown(properties))
    };
    match owner {
        "camera" => {
            let found = CAMERA.iter().find(|(name, _)| *name == rest);
            let &(name, moved) = found.ok_or_else(|| unknown(&CAMERA))?;
            Ok((Owner::Camera, name, moved))
        }
        "light" => named(&LIGHT).map(|(owner, name, moved)| (Owner::Light(owner), name, moved)),
        "material" => {
            named(&MATERIAL).map(|(owner, name, moved)| (Owner::Material(owner), name, moved))
        }
        "joint" => named(&JOINT).map(|(owner, name, moved)| (Owner::Joint(owner), name, moved)),
        "morph" => named(&MORPH).map(|(owner, name, moved)| (Owner::Morph(owner), name, moved)),
        _ => Err(target.error(
            format!(
                "`target` is {text:?}, and nothing called {owner:?} moves",
                text = shortened(text),
                owner = shortened(owner)
            ),
            EXAMPLES,
        )),
    }
}

fn keys(fields: &Fields<'_>, target: TrackTarget) -> Result<Vec<Key>, SceneError> {
    let (times, values) = (fields.require("times")?, fields.require("values")?);
    let mut keys: Vec<Key> = Vec::new();
    for time in times.items("`times = [0, 1.5]`, in seconds")? {
        let seconds = time.number()?;
        if let Some(before) = keys
            .last()
            .map(|key| key.seconds)
            .filter(|it| *it >= seconds)
        {
            return Err(time.error(
                format!("`times` has {seconds} behind {before}; each time must be later than the one before"),
                "order the times, and give each one value",
            ));
        }
        keys.push(Key {
            seconds,
            ..Key::default()
        });
    }
    if keys.is_empty() {
        return Err(times.error("`times` is empty", "write at least one time, in seconds"));
    }
    let kind = target.kind();
    let hinge = fields.get("axis").is_some();
    let example = match (kind, kind.components()) {
        (ValueKind::Rotation, _) if !hinge => {
            "`values = [[0, 0, 0], [0, 90, 0]]`, one for each time"
        }
        (ValueKind::Weight, _) => "`values = [0, 1]`, one for each time",
        (ValueKind::Scale, _) => "`values = [1, 1.5]`, one for each time",
        (ValueKind::Rotation, _) | (_, 1) => "`values = [0, 360]`, one for each time",
        _ => "`values = [[0, 3, 8], [4, 3, 4]]`, one for each time",
    };
    let values_of = values.items(example)?;
    check_count(values, values_of.len(), keys.len())?;
    for (key, value) in keys.iter_mut().zip(values_of) {
        if kind == ValueKind::Rotation && !hinge {
            if !value.is_array() && !value.is_table() {
                return Err(value.error(
                    "`values` holds a number, and a rotation without an `axis` has three angles",
                    "write `[0, 90, 0]`, or add the axis: `axis = [0, 1, 0]`",
                ));
            }
            let turn = DQuat::from_mat3(&transform::rotation(value)?).normalize();
            key.value = turn.to_array();
            continue;
        }
        let vector = match kind {
            ValueKind::Direction | ValueKind::UnitDirection => value.direction()?,
            ValueKind::FieldOfView => DVec3::X * field_of_view(value)?,
            ValueKind::Turns | ValueKind::Rotation => DVec3::X * value.number()?,
            ValueKind::Scale => DVec3::X * scale(value)?,
            ValueKind::Weight => DVec3::X * morph::weight(value)?,
            ValueKind::Radiance => DVec3::from_array(value.radiance()?),
            ValueKind::Ratios => DVec3::from_array(value.reflectance()?),
            ValueKind::Position | ValueKind::Shift => value.vector()?,
        };
        *key = Key::of_vector(key.seconds, vector);
    }
    Ok(keys)
}

fn scale(value: Value<'_>) -> Result<f64, SceneError> {
    let scale = value.positive()?;
    if scale > LARGEST_SCALE {
        return Err(value.error(
            format!(
                "`{}` is {scale}; it must be at most {LARGEST_SCALE}",
                value.key
            ),
            format!(
                "write a scale above 0 and at most {LARGEST_SCALE}, or place the instance larger"
            ),
        ));
    }
    Ok(scale.max(LEAST_SCALE))
}

fn check_count(values: Value<'_>, found: usize, times: usize) -> Result<(), SceneError> {
    if found == times {
        return Ok(());
    }
    Err(values.error(
        format!(
            "`{}` has {}, and `times` has {times}",
            values.key,
            counted(found, "value")
        ),
        "write one for each time",
    ))
}

/// Changes per second, one for each key; `one` says that values are one number each.
fn given_tangents(tangents: Value<'_>, one: bool, keys: &mut [Key]) -> Result<(), SceneError> {
    let all = tangents.items(match one {
        true => "`tangents = [0, 1]`, one for each time",
        false => "`tangents = [[0, 0, 0], [1, 0, 0]]`, one for each time",
    })?;
    check_count(tangents, all.len(), keys.len())?;
    for (key, tangent) in keys.iter_mut().zip(all) {
        let change = match tangent.is_array() && !one {
            true => tangent.vector()?,
            false => DVec3::splat(tangent.number()?),
        };
        let [x, y, z] = change.to_array();
        (key.entering, key.leaving) = ([x, y, z, 0.0], [x, y, z, 0.0]);
    }
    Ok(())
}

/// At each key the change from the key before to the one behind; none at the first and last.
fn smooth_tangents(keys: &mut [Key]) {
    let slopes: Vec<[f64; 4]> = keys
        .windows(3)
        .map(|keys| {
            let seconds = keys[2].seconds - keys[0].seconds;
            std::array::from_fn(|k| (keys[2].value[k] - keys[0].value[k]) / seconds)
        })
        .collect();
    for (key, slope) in keys.iter_mut().skip(1).zip(slopes) {
        (key.entering, key.leaving) = (slope, slope);
    }
}

/// The lights, materials, joints and morph targets of a scene, to look tracks' targets up.
pub(super) struct Targets<'t> {
    pub(super) source: &'t Source,
    pub(super) lights: &'t [Light],
    pub(super) light_names: &'t [String],
    pub(super) light_forms: &'t [Option<LightForm>],
    pub(super) materials: &'t Materials,
    pub(super) joints: &'t Joints,
    pub(super) morphs: &'t Morphs,
}

impl Targets<'_> {
    /// Looks up lights, materials, joints and morph targets.
    pub(super) fn resolve(&self, tracks: Vec<Unresolved>) -> Result<Vec<Track>, SceneError> {
        let mut resolved: Vec<Track> = Vec::new();
        let mut known = HashMap::new();
        for unresolved in tracks {
            let index = self.index(&unresolved)?;
            let Unresolved {
                target, mut track, ..
            } = unresolved;
            track.index = index;
            if let Some(first) = known.insert((track.target, index), resolved.len()) {
                let first = &resolved[first];
                return Err(self.source.error(
                    &target.span,
                    format!(
                        "{:?} moves already by the track at {}",
                        shortened(&target.text),
                        first.place
                    ),
                    "put the keys of both into one track",
                ));
            }
            resolved.push(track);
        }
        Ok(resolved)
    }

    fn index(&self, unresolved: &Unresolved) -> Result<usize, SceneError> {
        let Unresolved {
            owner,
            target,
            property,
            track,
        } = unresolved;
        match owner {
            Owner::Camera => Ok(0),
            Owner::Light(name) => {
                let index = self.light(name, &target.span)?;
                let form = self.light_forms.get(index).copied().flatten();
                let is_spot = form.is_some_and(|form| form.spot.is_some());
                if is_spot && track.target == TrackTarget::LightDirection {
                    return Err(self.source.error(
                        &target.span,
                        format!(
                            "light {} is a spot, whose `direction` cannot move yet",
                            shortened(name)
                        ),
                        "move its `position` or `color`, or write several scene files",
                    ));
                }
                let instead = match (track.target, self.lights[index]) {
                    (TrackTarget::LightPosition, Light::Directional { .. }) => "direction",
                    (TrackTarget::LightDirection, Light::Point { .. }) => "position",
                    _ => return Ok(index),
                };
                Err(self.source.error(
                    &target.span,
                    format!("light {} has no `{property}`", shortened(name)),
                    format!("move its `{instead}`, or change the light's `kind`"),
                ))
            }
            Owner::Joint(name) => self.joints.number(name).map_err(|remedy| {
                let cause = format!("there is no joint {name:?}", name = shortened(name));
                self.source.error(&target.span, cause, remedy)
            }),
            Owner::Morph(name) => self.morphs.number(name).map_err(|remedy| {
                let cause = format!("there is no morph target {name:?}", name = shortened(name));
                self.source.error(&target.span, cause, remedy)
            }),
            Owner::Material(name) => {
                let name = Name {
                    text: name.clone(),
                    span: target.span.clone(),
                };
                let index = self.materials.find(self.source, &name)?;
                let plain = matches!(self.materials.get(index).diffuse, Diffuse::Plain(_));
                let wrong = |cause: &str, remedy: &str| {
                    let cause = format!("material {:?} {cause}", shortened(&name.text));
                    Err(self.source.error(&target.span, cause, remedy))
                };
                match (plain, *property) {
                    (true, EVEN | "checker.odd") => wrong(
                        "has no `checker`",
                        "move its `diffuse`, or give it a `checker`",
                    ),
                    (false, "diffuse") => wrong(
                        "has a `checker` in place of a `diffuse` color",
                        "move its `checker.even` and `checker.odd`",
                    ),
                    _ => Ok(index),
                }
            }
        }
    }

    /// A light by its name, or else by its number.
    fn light(&self, name: &str, span: &Span) -> Result<usize, SceneError> {
        let count = self.lights.len();
        let known = || {
            self.light_names
                .iter()
                .map(String::as_str)
                .filter(|it| !it.is_empty())
        };
        let error = |cause: String, remedy: String| self.source.error(span, cause, remedy);
        let mut named = self
            .light_names
            .iter()
            .enumerate()
            .filter(|(_, it)| *it == name);
        match (named.next(), named.next(), name.parse::<usize>()) {
            (Some((index, _)), None, _) => Ok(index),
            (Some(_), Some(_), _) => Err(error(
                format!("several lights are called {name:?}", name = shortened(name)),
                String::from("give them different names, or write the light's number"),
            )),
            (None, _, Ok(number)) if number < count => Ok(number),
            (None, _, Ok(number)) => Err(error(
                format!(
                    "there is no light {number}: the scene has {}",
                    counted(count, "light")
                ),
                String::from("lights count from 0, in the order of the file"),
            )),
            (None, _, Err(_)) => Err(error(
                format!("there is no light {name:?}", name = shortened(name)),
                match nearest(name, known()) {
                    Some(near) => format!("did you mean {near:?}?", near = shortened(near)),
                    None => String::from("write the light's number, or give the light a `name`"),
                },
            )),
        }
    }
}
