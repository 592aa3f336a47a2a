//! The `[material.NAME]` tables, and looking materials up by name.

use super::source::{Name, Source, nearest};
use super::value::Value;
use crate::scene::{Diffuse, Material, SceneError};
use glam::DVec3;
use std::collections::BTreeMap;

const KEYS: &[&str] = &[
    "diffuse",
    "checker",
    "highlight",
    "shininess",
    "mirror",
    "transmit",
    "ior",
    "absorption",
    "emission",
    "lights",
];

/// The materials of a scene, each with a name of its own.
#[derive(Default)]
pub(super) struct Palette {
    materials: Vec<Material>,
    indices: BTreeMap<String, usize>,
}

impl Palette {
    /// Reads the tables inside `[material]`.
    pub(super) fn read(tables: Value<'_>) -> Result<Self, SceneError> {
        let mut palette = Self::default();
        for (name, table) in tables.entries()? {
            let material = Material {
                name: name.text,
                ..material(table)?
            };
            palette.push(material);
        }
        Ok(palette)
    }

    /// Adds a material of an import; one whose name is taken is renamed after the import, unless
    /// it is the very same.
    pub(super) fn adopt(&mut self, material: &Material, import: &str) -> usize {
        let mut material = material.clone();
        while let Some(&index) = self.indices.get(&material.name) {
            if self.materials[index] == material {
                return index;
            }
            material.name = format!("{import}/{}", material.name);
        }
        self.push(material)
    }

    fn push(&mut self, material: Material) -> usize {
        let index = self.materials.len();
        self.indices.insert(material.name.clone(), index);
        self.materials.push(material);
        index
    }

    pub(super) fn find(&self, source: &Source, name: &Name) -> Result<usize, SceneError> {
        let known = || self.indices.keys().map(String::as_str);
        self.indices.get(&name.text).copied().ok_or_else(|| {
            let remedy = match nearest(&name.text, known()) {
                Some(near) => format!(
                    "did you mean {near:?}? Or define `[material.{}]`",
                    name.text
                ),
                None => format!("define `[material.{}]`", name.text),
            };
            source.error(
                &name.span,
                format!("there is no material {:?}", name.text),
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

    pub(super) fn into_materials(self) -> Vec<Material> {
        self.materials
    }
}

fn material(table: Value<'_>) -> Result<Material, SceneError> {
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
    Ok(Material {
        diffuse,
        highlight: fields.or("highlight", default.highlight, Value::reflectance)?,
        shininess: fields.or("shininess", default.shininess, |value| {
            Ok(value.integer_in(1..=1024)? as u16)
        })?,
        mirror: fields.or("mirror", default.mirror, Value::reflectance)?,
        transmit: fields.or("transmit", default.transmit, Value::reflectance)?,
        ior: fields.or("ior", default.ior, |value| value.number_in(1.0..=4.0))?,
        absorption: fields.or("absorption", default.absorption, Value::coefficients)?,
        emission: fields.or("emission", default.emission, Value::radiance)?,
        lights: fields.or("lights", default.lights, Value::boolean)?,
        ..default
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
