//! The `[[object]]` and `[group.NAME]` tables, read into a tree that is placed later.

use super::census::{MAX_NESTING, too_deep};
use super::import::{Done, Imports, Molecules};
use super::item::{Content, Group, Item};
use super::material::{self, Materials};
use super::morph::Morphs;
use super::source::Source;
use super::value::{Fields, Value};
use super::{shape, transform};
use crate::scene::importer::stem;
use crate::scene::{
    Attributes, MoleculeOptions, MoleculeStyle, Scene, SceneError, Shape, Track, TrackTarget,
};
use crate::table::shortened;
use std::collections::{BTreeMap, HashMap};
use std::path::Path;
use std::rc::Rc;

/// The keys of every object.
const KEYS: &[&str] = &["kind", "name", "material"];

/// The kinds of objects besides those that [`Shape`] has.
const KINDS: [&str; 5] = ["triangle", "mesh", "group", "instance", "import"];

/// The keys of imports that are for files of some kinds alone.
const FOR_SOME_FILES: [&str; 4] = ["style", "model", "altloc", "assembly"];

/// Reads objects, and the files that they import.
pub(super) struct Reader<'r> {
    pub(super) source: &'r Source,
    pub(super) imports: &'r mut Imports,
    /// Options for molecules, and the assembly, for imports that state none.
    pub(super) molecule: &'r MoleculeOptions,
    pub(super) assembly: Option<&'r str>,
    /// Takes in the materials of imports.
    pub(super) materials: &'r mut Materials,
    /// Takes in the morph targets of imports.
    pub(super) morphs: &'r mut Morphs,
    /// Number of groups and parts of this file that are open inside each other.
    pub(super) inside: usize,
}

impl Reader<'_> {
    pub(super) fn groups(
        &mut self,
        tables: Value<'_>,
    ) -> Result<BTreeMap<String, Group>, SceneError> {
        let mut groups = BTreeMap::new();
        for (name, table) in tables.entries()? {
            let fields = table.fields("group", &[&["object"]])?;
            let items = self.members(&fields, "group")?;
            groups.insert(
                name.text,
                Group {
                    span: name.span,
                    items,
                },
            );
        }
        Ok(groups)
    }

    /// Returns the objects of a group or part. At least one is required: empty groups could be nested without end at no
    /// cost in primitives.
    pub(super) fn members(
        &mut self,
        fields: &Fields<'_>,
        what: &str,
    ) -> Result<Vec<Item>, SceneError> {
        let list = fields.require("object")?;
        self.imports.nesting += 1;
        if self.imports.nesting > MAX_NESTING {
            return Err(too_deep(self.source, &fields.span));
        }
        self.inside += 1;
        let items = self.items(list)?;
        self.inside -= 1;
        self.imports.nesting -= 1;
        if items.is_empty() {
            return Err(list.error(
                format!("this {what} holds no object"),
                "add objects to it, or remove it",
            ));
        }
        Ok(items)
    }

    pub(super) fn items(&mut self, list: Value<'_>) -> Result<Vec<Item>, SceneError> {
        let example = "`[[object]]` above the keys of each, or `object = [{ kind = ... }, ...]`";
        let tables = list.items(example)?;
        tables
            .enumerate()
            .map(|(index, table)| self.item(table, index + 1))
            .collect()
    }

    fn item(&mut self, table: Value<'_>, number: usize) -> Result<Item, SceneError> {
        // The kind decides which keys there are, so it is read before they are checked.
        let kinds: Vec<_> = Shape::kinds().map(|(kind, _)| *kind).chain(KINDS).collect();
        let kind = table.member("object", "kind")?.word(&kinds)?;
        let keys: &[&str] = match kind {
            "group" => &["object"],
            "instance" => &["group"],
            "import" => &["file", "style", "model", "altloc", "assembly", "smooth"],
            _ => shape::keys(kind),
        };
        let fields = table.fields(kind, &[KEYS, keys, transform::KEYS])?;
        let material = fields.or("material", None, |value| value.name().map(Some))?;
        let name = match fields.get("name") {
            Some(name) => name.filled()?.to_owned(),
            None if kind == "import" => {
                let file = fields.require("file")?.filled()?.replace('\\', "/");
                stem(Path::new(&file))
            }
            None => format!("{kind} {number}"),
        };
        let mut content = match kind {
            "group" => Content::Group(self.members(&fields, "group")?),
            "instance" => Content::Instance(fields.require("group")?.name()?),
            "import" => self.imported(&fields, material.is_some(), &name)?,
            _ => Content::Shape(shape::read(kind, &fields)?),
        };
        let mut attributes = Attributes::default();
        if let Content::Shape(shape) = &mut content {
            attributes = shape::attributes(shape, &fields)?;
            if let Some(table) = fields.get("morph") {
                self.morphs.displace(table, shape, &mut attributes)?;
            }
        }
        let transform = transform::read(&fields)?;
        Ok(Item {
            name,
            material,
            smooth: smooth(&fields)?,
            attributes,
            transform,
            span: fields.span,
            content,
        })
    }

    /// Reads the content of an import. `has_other` if its objects get another material than their own.
    fn imported(
        &mut self,
        fields: &Fields<'_>,
        has_other: bool,
        name: &str,
    ) -> Result<Content, SceneError> {
        let mut scene = self.import(fields)?;
        let mut motions = HashMap::new();
        let place = self.source.place(&fields.span);
        if self.inside > 0 {
            let is_lost = |track: &Track| {
                !track.target.is_of_joint() && track.target != TrackTarget::MorphWeight
            };
            if scene.tracks.iter().any(is_lost) {
                self.imports.warnings.push(format!(
                    "{place}: the tracks of camera, lights and materials of an import inside of a group or part move \
                     nothing"
                ));
            }
            if let Some(lost) = besides_objects(&scene) {
                self.imports.warnings.push(format!(
                    "{place}: an import inside of a group or part brings its objects alone, and not its {lost}"
                ));
            }
            if let Some(lit) = scene.with_light_objects() {
                scene = Rc::new(lit);
            }
        } else {
            let lost = lost_tracks(&scene, has_other);
            let warnings = lost.map(|lost| format!("{place}: {lost}"));
            self.imports.warnings.extend(warnings);
            motions = material::motions(&scene);
        }
        // Objects that all get another material do not need their own.
        let adopt = |(number, own)| {
            let motions = motions.remove(&number).unwrap_or_default();
            self.materials.adopt(own, motions, name)
        };
        let materials = match has_other {
            true => Vec::new(),
            false => scene.materials.iter().enumerate().map(adopt).collect(),
        };
        let morphs = self.morphs.adopt(&scene);
        Ok(Content::Import {
            scene,
            materials,
            morphs,
        })
    }

    fn import(&mut self, fields: &Fields<'_>) -> Result<Rc<Scene>, SceneError> {
        let file = fields.require("file")?.name()?;
        let options = MoleculeOptions {
            style: fields.or("style", self.molecule.style, style)?,
            model: fields.or("model", self.molecule.model, |value| {
                Ok(value.integer_in(1..=u32::MAX)? as usize)
            })?,
            altloc: fields.or("altloc", self.molecule.altloc, altloc)?,
        };
        let assembly = fields.or("assembly", self.assembly, |value| value.filled().map(Some))?;
        let molecules = Molecules {
            options,
            assembly: assembly.map(str::to_owned),
        };
        let Done { scene, kinds } = self.imports.import(self.source, &file, molecules)?;
        for key in FOR_SOME_FILES {
            let Some(value) = fields.get(key) else {
                continue;
            };
            if let Some(why) = kinds.inapplicable(key, &shortened(&file.text)) {
                return Err(value.error(format!("`{key}` {why}"), "leave the key out"));
            }
        }
        Ok(scene)
    }
}

/// Says which tracks of an import do not come along. Its objects may all have another material.
fn lost_tracks(scene: &Scene, has_other: bool) -> impl Iterator<Item = &'static str> {
    let any = |is_such: fn(TrackTarget) -> bool| scene.tracks.iter().any(|it| is_such(it.target));
    let all = [
        (
            has_other && any(TrackTarget::is_of_material),
            "the tracks of this import's materials move nothing, because its objects have another material",
        ),
        (
            scene.camera.is_none() && any(TrackTarget::is_of_camera),
            "the tracks of this import's camera do not come along, because it has none; write them in this file",
        ),
    ];
    all.into_iter().filter(|it| it.0).map(|it| it.1)
}

/// Names the parts of a scene besides objects and lights that are visible as such.
fn besides_objects(scene: &Scene) -> Option<String> {
    let forms = scene.light_forms.iter().flatten();
    let visible = forms.filter(|it| it.is_visible).count();
    let all = [
        (scene.camera.is_some(), "camera"),
        (scene.lights.len() > visible, "lights"),
        (scene.background.is_some(), "background"),
        (scene.ambient != [0.0; 3], "ambient light"),
        (scene.environment.is_some(), "environment"),
    ];
    let found: Vec<_> = all.iter().filter(|it| it.0).map(|it| it.1).collect();
    (!found.is_empty()).then(|| found.join(", "))
}

/// The angle of `smooth` in degrees.
fn smooth(fields: &Fields<'_>) -> Result<Option<f64>, SceneError> {
    fields.or("smooth", None, |value| {
        let degrees = value.number()?;
        if !(0.0..=180.0).contains(&degrees) {
            return Err(value.error(
                format!("`smooth` is {degrees}; it must be from 0 to 180 degrees"),
                "write the angle between two faces below which their edge is smooth, such as 40",
            ));
        }
        Ok(Some(degrees))
    })
}

fn style(value: Value<'_>) -> Result<MoleculeStyle, SceneError> {
    value.one_of(MoleculeStyle::ALL, MoleculeStyle::name)
}

fn altloc(value: Value<'_>) -> Result<Option<char>, SceneError> {
    let mut characters = value.text()?.chars();
    match (characters.next(), characters.next()) {
        (Some(character), None) => Ok(Some(character)),
        _ => Err(value.error(
            "`altloc` is not one character",
            "write the letter of the alternate location, such as \"A\"",
        )),
    }
}
