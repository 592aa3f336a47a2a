//! The names of a blob's objects, materials and lights.

use super::section::{Section, indices, section};
use crate::scene::Scene;
use gridel_core::BlobError;
use gridel_core::format::SectionKind;
use gridel_core::format::limits::MAX_NAME_BYTES;
use serde::Serialize;

/// The names of objects, materials and lights, as a blob counts them: it has only materials that an object has. An item
/// without a name has an empty one, or is missing at the end.
///
/// ```
/// # use gridel_host::compile::{Options, compile};
/// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
/// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// # use gridel_host::compile::Names;
/// let options = Options {
///     names: true,
///     ..Options::default()
/// };
/// let blob = compile(&imported.scene, &options)?.blob;
/// let names = Names::of_blob(&blob.scene()?, blob.bytes())?;
/// assert_eq!(names.object(0), Some("ball"));
/// assert_eq!(names.light(0), None);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Names {
    pub objects: Vec<String>,
    pub materials: Vec<String>,
    pub lights: Vec<String>,
    /// Names of a scene file's instances, by their numbers; a blob has none.
    pub instances: Vec<String>,
    /// For each object, its number among the materials.
    pub object_material: Vec<u32>,
    /// Names of the scene that are longer than 255 bytes, and were cut.
    pub shortened: usize,
}

/// The names of a scene in its blob.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct KeptNames {
    /// Names in the blob.
    pub names: usize,
    /// Bytes of the blob that they take.
    pub bytes: usize,
    /// Names that were cut to 255 bytes.
    pub shortened: usize,
    /// True if the names do not fit the largest size of the blob.
    pub left_out: bool,
}

impl Names {
    /// Returns the names of a scene, each cut to 255 bytes.
    pub fn of_scene(scene: &Scene) -> Self {
        let mut names = Self::default();
        let mut shortened = 0;
        let mut cut = |name: &str| {
            let end = name.floor_char_boundary(MAX_NAME_BYTES);
            shortened += usize::from(end < name.len());
            name[..end].to_owned()
        };
        let mut numbers = vec![None; scene.materials.len()];
        for object in scene.all_objects() {
            let number = *numbers[object.material].get_or_insert_with(|| {
                let name = &scene.materials[object.material].name;
                names.materials.push(cut(name));
                names.materials.len() as u32 - 1
            });
            names.object_material.push(number);
        }
        names.objects = scene.all_objects().map(|it| cut(&it.name)).collect();
        names.lights = scene.light_names.iter().map(|it| cut(it)).collect();
        names.shortened = shortened;
        let placed = scene.instances.iter().filter(|it| scene.is_placed(it));
        names.instances = placed.map(|it| it.name.clone()).collect();
        names
    }

    /// Returns the names of a blob that `scene` is the checked view of.
    ///
    /// # Errors
    /// If they are invalid.
    pub fn of_blob(scene: &gridel_core::Scene<'_>, blob: &[u8]) -> Result<Self, BlobError> {
        let names = gridel_core::Names::from_bytes(blob)?;
        let objects = 0..scene.header().objects;
        let object_material = objects.clone().map(|it| scene.material_number(it));
        let object_material = object_material.collect();
        if names.is_empty() {
            return Ok(Self {
                object_material,
                ..Self::default()
            });
        }
        let materials = 0..scene.materials().len() as u32;
        let lights = 0..scene.lights().len() as u32;
        Ok(Self {
            objects: objects.map(|it| names.object(it).to_owned()).collect(),
            materials: materials.map(|it| names.material(it).to_owned()).collect(),
            lights: lights.map(|it| names.light(it).to_owned()).collect(),
            instances: Vec::new(),
            object_material,
            shortened: 0,
        })
    }

    /// Returns the name of an object.
    pub fn object(&self, object: u32) -> Option<&str> {
        given(&self.objects, object)
    }

    /// Returns the name of an object's material.
    pub fn material_of(&self, object: u32) -> Option<&str> {
        self.material(*self.object_material.get(object as usize)?)
    }

    /// Returns the name of a material.
    pub fn material(&self, material: u32) -> Option<&str> {
        given(&self.materials, material)
    }

    /// Returns the name of a light.
    pub fn light(&self, light: u32) -> Option<&str> {
        given(&self.lights, light)
    }

    /// Returns the name of an instance.
    pub fn instance(&self, number: u32) -> Option<&str> {
        given(&self.instances, number)
    }

    /// Returns the sections of a blob with this many lights, and their content. No section where nothing has a name.
    pub(super) fn sections(&self, lights: usize) -> (Vec<Section>, KeptNames) {
        let mut kept = KeptNames {
            shortened: self.shortened,
            ..KeptNames::default()
        };
        let mut text = String::new();
        let mut starts = Vec::new();
        let lights = (0..lights).map(|light| self.light(light as u32).unwrap_or_default());
        let named = self.objects.iter().chain(&self.materials);
        for name in named.map(String::as_str).chain(lights) {
            kept.names += usize::from(!name.is_empty());
            starts.push(text.len() as u32);
            text.push_str(name);
        }
        starts.push(text.len() as u32);
        if text.is_empty() || u32::try_from(text.len()).is_err() {
            return (Vec::new(), KeptNames::default());
        }
        let sections = vec![
            indices(SectionKind::NameStarts, &starts, 1),
            section(SectionKind::NameText, text.as_bytes()),
        ];
        (sections, kept)
    }
}

fn given(names: &[String], number: u32) -> Option<&str> {
    let name = names.get(number as usize)?;
    Some(name.as_str()).filter(|name| !name.is_empty())
}
