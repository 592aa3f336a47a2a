//! The `[morph.NAME]` tables, and the displacements that meshes have by them.

use super::source::{key, undefined};
use super::value::Value;
use crate::scene::{
    Attributes, Displacements, LARGEST_WEIGHT, MorphTarget, Scene, SceneError, Shape, Track,
    TrackTarget,
};
use crate::table::shortened;
use glam::DVec3;
use std::collections::{HashMap, HashSet};

const KEYS: &[&str] = &["weight", "range"];

/// The morph targets of a file, and of its imports.
#[derive(Default)]
pub(super) struct Morphs {
    pub(super) targets: Vec<MorphTarget>,
    /// The file's own, by their names.
    numbers: HashMap<String, usize>,
    /// The tracks of imports.
    pub(super) tracks: Vec<Track>,
}

/// Reads the tables.
pub(super) fn read(tables: Value<'_>) -> Result<Morphs, SceneError> {
    let mut morphs = Morphs::default();
    for (name, table) in tables.entries()? {
        let fields = table.fields("morph target", &[KEYS])?;
        let range = fields.or("range", [0.0, 1.0], |value| {
            let ends = super::shape::pair(value)?;
            let is_valid = ends.abs().max_element() <= LARGEST_WEIGHT && ends.x <= ends.y;
            if !is_valid {
                return Err(value.error(
                    format!(
                        "`range` goes from {} to {}; it must rise, between -{LARGEST_WEIGHT} and {LARGEST_WEIGHT}",
                        ends.x, ends.y
                    ),
                    "write the least and the greatest weight, such as `range = [-1, 1]`",
                ));
            }
            Ok(ends.to_array())
        })?;
        if name.text.is_empty() {
            let cause = "the name of this morph target is empty";
            return Err(table.source.error(
                &name.span,
                cause,
                "give it a name, such as `[morph.smile]`",
            ));
        }
        let target = MorphTarget {
            weight: fields.or("weight", 0.0, weight)?,
            range,
            place: table.source.place(&name.span),
            name: name.text,
        };
        let number = morphs.targets.len();
        morphs.numbers.insert(target.name.clone(), number);
        morphs.targets.push(target);
    }
    Ok(morphs)
}

/// Reads the weight of a morph target.
pub(super) fn weight(value: Value<'_>) -> Result<f64, SceneError> {
    let weight = value.number()?;
    if weight.abs() > LARGEST_WEIGHT {
        return Err(value.error(
            format!("the weight {weight} is beyond ±{LARGEST_WEIGHT}"),
            "use smaller weights, and larger displacements",
        ));
    }
    Ok(weight)
}

/// Warnings about morph targets that no mesh has.
pub(super) fn unused(scene: &Scene) -> Vec<String> {
    let objects = scene.all_objects();
    let used: HashSet<usize> = objects
        .flat_map(|object| {
            let displaced = object.attributes.displacements.iter().map(|it| it.target);
            displaced.chain(object.normals.changes.iter().map(|it| it.target))
        })
        .collect();
    let all = scene.morph_targets.iter().enumerate();
    all.filter(|(number, _)| !used.contains(number))
        .map(|(_, target)| {
            let name = shortened(&target.name);
            format!(
                "{}: no mesh has the morph target {name:?}, so it moves nothing",
                target.place
            )
        })
        .collect()
}

impl Morphs {
    /// Returns the number of a morph target, or what to do where none has the name.
    pub(super) fn number(&self, name: &str) -> Result<usize, String> {
        let found = self.numbers.get(name).copied();
        found.ok_or_else(|| {
            let known = self.numbers.keys().map(String::as_str);
            undefined(name, known, "`[morph.NAME]` of this name", || {
                format!("define it: `[morph.{}]`", key(name))
            })
        })
    }

    /// Reads the displacements of a mesh, and moves its vertices to where they are at rest.
    pub(super) fn displace(
        &self,
        table: Value<'_>,
        shape: &mut Shape,
        attributes: &mut Attributes,
    ) -> Result<(), SceneError> {
        let Shape::Mesh { vertices, .. } = shape else {
            return Ok(());
        };
        let mut rest = vertices.clone();
        for (name, list) in table.entries()? {
            let target = self.number(&name.text).map_err(|remedy| {
                let cause = format!("there is no morph target {:?}", shortened(&name.text));
                list.error(cause, remedy)
            })?;
            let vectors = list.items("`[[0, 0, 0], [0, 0.5, 0], [0, 0, 0]]`")?;
            let vectors: Vec<DVec3> = vectors.map(Value::vector).collect::<Result<_, _>>()?;
            if vectors.len() != vertices.len() {
                return Err(list.error(
                    format!(
                        "there are {} displacements and {} vertices",
                        vectors.len(),
                        vertices.len()
                    ),
                    "write one for each vertex, in the same order",
                ));
            }
            let weight = self.targets[target].weight;
            for (vertex, vector) in rest.iter_mut().zip(&vectors) {
                *vertex += weight * *vector;
            }
            attributes
                .displacements
                .push(Displacements { target, vectors });
        }
        *vertices = rest;
        Ok(())
    }

    /// Takes over the morph targets of an import, with their tracks. Returns the number of the first, or 0 if there is
    /// none.
    pub(super) fn adopt(&mut self, import: &Scene) -> usize {
        if import.morph_targets.is_empty() {
            return 0;
        }
        let first = self.targets.len();
        self.targets.extend(import.morph_targets.iter().cloned());
        let tracks = import.tracks.iter();
        let tracks = tracks.filter(|it| it.target == TrackTarget::MorphWeight);
        self.tracks.extend(tracks.map(|track| Track {
            index: first + track.index,
            ..track.clone()
        }));
        first
    }
}
