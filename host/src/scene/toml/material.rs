//! The `[material.NAME]` tables, and looking materials up by name.

use super::shape::pair;
use super::source::{Name, Source, key, undefined};
use super::value::{Fields, Value};
use crate::scene::texture::{Images, texture_transform};
use crate::scene::{
    Alpha, CauseAndRemedy, Color, Diffuse, Image, Interpolation, Key, Material, NormalMap, Scene,
    SceneError, Texture, TrackTarget, Wrap,
};
use crate::table::shortened;
use glam::{DAffine2, DVec2, DVec3};
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

const KEYS: &[&str] = &[
    "diffuse",
    "checker",
    "highlight",
    "shininess",
    "mirror",
    "roughness",
    "transmit",
    "ior",
    "priority",
    "absorption",
    "texture",
    "normal_map",
    "normal_scale",
    "alpha",
    "cutoff",
    "emission",
    "lights",
];

/// The materials of a scene, each with a name of its own.
#[derive(Default)]
pub(super) struct Materials {
    materials: Vec<Material>,
    /// The motions of those with tracks of imports.
    motions: HashMap<usize, Vec<Motion>>,
    indices: BTreeMap<String, usize>,
}

/// A track of a material, apart from its place.
pub(super) type Motion = (TrackTarget, Interpolation, Vec<Key>);

/// The motions of those materials of an import that have tracks.
pub(super) fn motions(import: &Scene) -> HashMap<usize, Vec<Motion>> {
    let mut motions: HashMap<_, Vec<_>> = HashMap::new();
    let tracks = import.tracks.iter();
    for track in tracks.filter(|it| it.target.is_of_material()) {
        let motion = (track.target, track.interpolation, track.keys.clone());
        motions.entry(track.index).or_default().push(motion);
    }
    motions
}

impl Materials {
    /// Reads the tables inside `[material]`.
    pub(super) fn read(tables: Value<'_>, images: &mut Images<'_>) -> Result<Self, SceneError> {
        let mut materials = Self::default();
        for (name, table) in tables.entries()? {
            let material = Material {
                place: table.source.place(&name.span),
                name: name.text,
                ..material(table, images)?
            };
            materials.push(material);
        }
        Ok(materials)
    }

    /// Adds a material of an import. One whose name is taken is renamed after the import, unless it is identical apart
    /// from its place, and moves alike. The name of the [fallback](Self::fallback) is taken from the beginning.
    pub(super) fn adopt(
        &mut self,
        material: &Material,
        motions: Vec<Motion>,
        import: &str,
    ) -> usize {
        let mut material = material.clone();
        let fallback = Material::default();
        loop {
            let index = self.indices.get(&material.name).copied();
            let known = match index {
                Some(index) => &self.materials[index],
                None if material.name == fallback.name => &fallback,
                None => {
                    let index = self.push(material);
                    if !motions.is_empty() {
                        self.motions.insert(index, motions);
                    }
                    return index;
                }
            };
            let known_motions = index.and_then(|index| self.motions.get(&index));
            let moves_alike = known_motions.map_or(&[][..], Vec::as_slice) == motions;
            let place = std::mem::replace(&mut material.place, known.place.clone());
            if moves_alike && *known == material {
                return index.unwrap_or_else(|| self.push(material));
            }
            material.place = place;
            material.name = format!("{import}/{}", material.name);
        }
    }

    fn push(&mut self, material: Material) -> usize {
        let index = self.materials.len();
        self.indices.insert(material.name.clone(), index);
        self.materials.push(material);
        index
    }

    pub(super) fn find(&self, source: &Source, name: &Name) -> Result<usize, SceneError> {
        self.indices.get(&name.text).copied().ok_or_else(|| {
            let known = self.indices.keys().map(String::as_str);
            let table = format!("`[material.{}]`", key(&name.text));
            let remedy = undefined(&name.text, known, &table, || format!("define {table}"));
            source.error(
                &name.span,
                format!("there is no material {:?}", shortened(&name.text)),
                remedy,
            )
        })
    }

    pub(super) fn get(&self, index: usize) -> &Material {
        &self.materials[index]
    }

    /// The material of objects for which nothing names one: the one called `default`, which a
    /// scene may define.
    pub(super) fn fallback(&mut self) -> usize {
        let fallback = Material::default();
        match self.indices.get(&fallback.name) {
            Some(&index) => index,
            None => self.push(fallback),
        }
    }

    pub(super) fn into_vec(self) -> Vec<Material> {
        self.materials
    }
}

fn material(table: Value<'_>, images: &mut Images<'_>) -> Result<Material, SceneError> {
    let fields = table.fields("material", &[KEYS])?;
    let default = Material::default();
    let diffuse = match (fields.get("diffuse"), fields.get("checker")) {
        (Some(_), Some(checker)) => {
            return Err(checker.error(
                "a material has either a `diffuse` color or a `checker`",
                "remove one of the two",
            ));
        }
        (Some(diffuse), None) => Diffuse::Plain(diffuse.reflectance()?),
        (None, Some(table)) => checker(table)?,
        (None, None) => default.diffuse,
    };
    let texture = fields.or("texture", None, |value| {
        texture(value, images, DAffine2::IDENTITY).map(Some)
    })?;
    let transmit = fields.or("transmit", default.transmit, Value::reflectance)?;
    Ok(Material {
        diffuse,
        highlight: fields.or("highlight", default.highlight, Value::reflectance)?,
        shininess: fields.or("shininess", default.shininess, |value| {
            Ok(value.integer_in(1..=1024)? as u16)
        })?,
        mirror: fields.or("mirror", default.mirror, Value::reflectance)?,
        roughness: roughness(&fields)?,
        transmit,
        ior: fields.or("ior", default.ior, |value| value.number_in(1.0..=4.0))?,
        priority: priority(&fields)?,
        absorption: fields.or("absorption", default.absorption, Value::coefficients)?,
        normal_map: normal_map(&fields, texture.as_ref(), images)?,
        texture,
        alpha: alpha(&fields, transmit)?,
        emission: fields.or("emission", default.emission, Value::radiance)?,
        lights: fields.or("lights", default.lights, Value::boolean)?,
        ..default
    })
}

/// Reads the priority of glass where several overlap.
fn priority(fields: &Fields<'_>) -> Result<Option<u8>, SceneError> {
    let Some(value) = fields.get("priority") else {
        return Ok(None);
    };
    if fields.get("transmit").is_none() {
        return Err(value.error(
            "`priority` needs `transmit`: only glass has one",
            "add `transmit`, or remove it",
        ));
    }
    Ok(Some(value.integer_in(1..=100)? as u8))
}

/// Reads the roughness of a mirror or glass.
fn roughness(fields: &Fields<'_>) -> Result<f64, SceneError> {
    let Some(value) = fields.get("roughness") else {
        return Ok(Material::default().roughness);
    };
    if fields.get("mirror").is_none() && fields.get("transmit").is_none() {
        return Err(value.error(
            "`roughness` needs `mirror` or `transmit`",
            "add `mirror` or `transmit`, or remove it",
        ));
    }
    let roughness = value.number_in(0.0..=1.0)?;
    if roughness > 0.0 && roughness < Material::LEAST_ROUGHNESS {
        return Err(value.error(
            format!("the roughness is {roughness}; it must be 0, or 0.05 to 1"),
            "write 0 for a smooth surface, or 0.05",
        ));
    }
    Ok(roughness)
}

/// Reads the use of the texture's alpha, which glass ignores.
fn alpha(fields: &Fields<'_>, transmit: Color) -> Result<Option<Alpha>, SceneError> {
    let cutoff = fields.get("cutoff");
    let Some(value) = fields.get("alpha") else {
        return match cutoff {
            None => Ok(None),
            Some(cutoff) => Err(cutoff.error(
                "`cutoff` is for textures that are cut out",
                "write `alpha = \"cutout\"` beside it",
            )),
        };
    };
    if fields.get("texture").is_none() {
        let remedy = "add a `texture`, or write a pane as `transmit = 0.5` and `ior = 1`";
        return Err(value.error("`alpha` needs `texture`", remedy));
    }
    if transmit != [0.0; 3] {
        let remedy = "remove `alpha` or `transmit`";
        return Err(value.error("glass has no `alpha`: it lets light through", remedy));
    }
    let blends = value.word(&["blend", "cutout"])? == "blend";
    match cutoff {
        Some(cutoff) if blends => Err(cutoff.error(
            "`cutoff` is for textures that are cut out",
            "remove it, or write `alpha = \"cutout\"`",
        )),
        _ if blends => Ok(Some(Alpha::Blend(1.0))),
        None => Ok(Some(Alpha::CutOut(0.5))),
        Some(cutoff) => cutoff.number_in(0.002..=1.0).map(Alpha::CutOut).map(Some),
    }
}

/// The normal map, which lies as the texture does.
fn normal_map(
    fields: &Fields<'_>,
    color: Option<&Texture>,
    images: &mut Images<'_>,
) -> Result<Option<NormalMap>, SceneError> {
    let scale = fields.get("normal_scale");
    let Some(value) = fields.get("normal_map") else {
        return match scale {
            None => Ok(None),
            Some(scale) => Err(scale.error(
                "`normal_scale` needs `normal_map`",
                "add `normal_map`, or remove it",
            )),
        };
    };
    let as_color = color.map_or(DAffine2::IDENTITY, |it| it.transform);
    let texture = texture(value, images, as_color)?;
    if color.is_some() && texture.transform != as_color {
        return Err(value.error(
            "the normal map does not lie as the texture does",
            "leave out its `scale`, `rotation` and `offset`, or write those of the texture",
        ));
    }
    let scale = match scale {
        Some(scale) => scale.number_in(0.0..=NormalMap::STEEPEST)?,
        None => 1.0,
    };
    Ok(Some(NormalMap { texture, scale }))
}

/// A file's name, or a table with it and options. Without options that say otherwise it lies so on texture coordinates.
fn texture(
    value: Value<'_>,
    images: &mut Images<'_>,
    lies: DAffine2,
) -> Result<Texture, SceneError> {
    let keys = [
        "file", "filter", "levels", "wrap", "scale", "offset", "rotation",
    ];
    if !value.is_table() {
        return Ok(Texture {
            transform: lies,
            ..Texture::of(image(value, images)?)
        });
    }
    let fields = value.fields("texture", &[&keys])?;
    let wrap = |value: Value<'_>| {
        Ok(match value.word(&["repeat", "mirror", "clamp"])? {
            "repeat" => Wrap::Repeat,
            "mirror" => Wrap::Mirror,
            _ => Wrap::Clamp,
        })
    };
    let scale = fields.or("scale", DVec2::ONE, |value| match value.items("numbers") {
        Ok(_) => pair(value),
        Err(_) => value.number().map(DVec2::splat),
    })?;
    let rotation = fields.or("rotation", 0.0, Value::number)?;
    let offset = fields.or("offset", DVec2::ZERO, pair)?;
    let keys = ["scale", "rotation", "offset"];
    let is_placed = keys.iter().any(|key| fields.get(key).is_some());
    Ok(Texture {
        image: image(fields.require("file")?, images)?,
        wrap: [fields.or("wrap", Wrap::Repeat, wrap)?; 2],
        bilinear: fields.or("filter", true, |value| {
            Ok(value.word(&["linear", "nearest"])? == "linear")
        })?,
        levels: fields.or("levels", false, Value::boolean)?,
        transform: match is_placed {
            true => texture_transform(scale, rotation.to_radians(), offset),
            false => lies,
        },
    })
}

fn image(file: Value<'_>, images: &mut Images<'_>) -> Result<Arc<Image>, SceneError> {
    let name = file.filled()?;
    images.file(&file.source.path, name).map_err(|error| {
        let CauseAndRemedy { cause, remedy } = error.into_error();
        file.error(format!("the texture {cause}"), remedy)
    })
}

fn checker(table: Value<'_>) -> Result<Diffuse, SceneError> {
    let fields = table.fields("checker", &[&["even", "odd", "size", "origin"]])?;
    Ok(Diffuse::Checker {
        even: fields.require("even")?.reflectance()?,
        odd: fields.require("odd")?.reflectance()?,
        size: fields.or("size", 1.0, Value::positive)?,
        origin: fields.or("origin", DVec3::ZERO, Value::vector)?,
    })
}
