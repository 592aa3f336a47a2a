//! Places the objects of groups, instances and imports in the world, or in parts.

use super::census;
use super::imported_track::{lost, moved};
use super::item::{Content, Group, InstanceItem, Item, JointItem, PartItem};
use super::material::Materials;
use super::source::Source;
use crate::scene::size::{MOST_PRIMITIVES, Size, primitives};
use crate::scene::{
    Attributes, Instance, Joint, Normals, NormalsChoice, Object, Part, Placement, Scene,
    SceneError, Shape, Track,
};
use crate::shape::transform::OUT_OF_RANGE;
use crate::table::shortened;
use glam::DAffine3;
use std::collections::{BTreeMap, HashMap};

/// An import, its materials here, its smoothing angle, and its first morph target here.
type ImportKey = (*const Scene, Vec<usize>, Option<u64>, usize);

/// Flattens the tree of items, which must have passed the census, into objects.
pub(super) struct Placer<'p> {
    source: &'p Source,
    groups: &'p BTreeMap<String, Group>,
    materials: &'p mut Materials,
    placed: PlacedContent,
    /// True if the objects are those of a part, which holds no instances.
    in_part: bool,
    /// The first part of each import that has some.
    imported: HashMap<ImportKey, usize>,
    /// Counted again, because boxes that are turned become twelve triangles.
    primitives: u64,
    size: Size,
}

/// The placed content of a file's tables.
#[derive(Default)]
pub(super) struct PlacedContent {
    pub(super) objects: Vec<Object>,
    pub(super) parts: Vec<Part>,
    pub(super) instances: Vec<Instance>,
    /// The file's own, then those of imports.
    pub(super) joints: Vec<Joint>,
    /// The tracks of the joints of imports.
    pub(super) tracks: Vec<Track>,
    pub(super) warnings: Vec<String>,
}

/// The transform, material and so on with which the objects of a list are placed.
#[derive(Clone, Copy)]
struct Site<'s> {
    transform: DAffine3,
    /// The material of objects that name none.
    material: Option<usize>,
    /// Names of the groups around, each followed by a slash.
    path: &'s str,
}

const WORLD: Site<'_> = Site {
    transform: DAffine3::IDENTITY,
    material: None,
    path: "",
};

impl<'p> Placer<'p> {
    pub(super) fn new(
        source: &'p Source,
        groups: &'p BTreeMap<String, Group>,
        materials: &'p mut Materials,
        objects: usize,
    ) -> Self {
        let placed = PlacedContent {
            objects: Vec::with_capacity(objects),
            ..PlacedContent::default()
        };
        Self {
            source,
            groups,
            materials,
            placed,
            in_part: false,
            imported: HashMap::new(),
            primitives: 0,
            size: Size::default(),
        }
    }

    /// Returns the objects of a scene's own list, and its parts, as far as instances place them.
    pub(super) fn place(
        mut self,
        items: &[Item],
        parts: &[PartItem],
        instances: &[InstanceItem],
        joints: &[JointItem],
    ) -> Result<PlacedContent, SceneError> {
        let joint = |joint: &JointItem| Joint {
            name: joint.name.text.clone(),
            parent: joint.parent,
            pivot: joint.pivot,
            place: self.source.place(&joint.span),
        };
        self.placed.joints = joints.iter().map(joint).collect();
        self.items(items, WORLD)?;
        let own = std::mem::take(&mut self.placed.objects);
        self.in_part = true;
        let mut numbers = vec![None; parts.len()];
        instances.iter().for_each(|it| numbers[it.part] = Some(0));
        for (part, number) in parts.iter().zip(&mut numbers) {
            if let Some(number) = number {
                self.items(&part.items, WORLD)?;
                if self.placed.objects.is_empty() {
                    return Err(self.source.error(
                        &part.span,
                        format!(
                            "the part {:?} has no object: its imports are empty",
                            shortened(&part.name.text)
                        ),
                        "add objects to it, or remove it",
                    ));
                }
                *number = self.placed.parts.len();
                self.placed.parts.push(Part {
                    name: part.name.text.clone(),
                    objects: std::mem::take(&mut self.placed.objects),
                    place: self.source.place(&part.span),
                });
            }
        }
        for instance in instances {
            let Some(part) = numbers[instance.part] else {
                continue;
            };
            self.placed.instances.push(Instance {
                name: instance.name.clone(),
                part,
                placement: instance.placement,
                joint: instance.joint,
                place: self.source.place(&instance.span),
            });
        }
        self.placed.objects = own;
        Ok(self.placed)
    }

    fn items(&mut self, items: &[Item], site: Site<'_>) -> Result<(), SceneError> {
        for item in items {
            let material = match &item.material {
                Some(name) => Some(self.materials.find(self.source, name)?),
                None => site.material,
            };
            let transform = site.transform * item.transform;
            let name = format!("{}{}", site.path, item.name);
            let path = format!("{name}/");
            let inside = Site {
                transform,
                material,
                path: &path,
            };
            match &item.content {
                Content::Shape(shape) => {
                    let shape = self.shape(item, &transform, &name, (shape, &item.attributes))?;
                    let material = material.unwrap_or_else(|| self.materials.fallback());
                    let place = self.source.place(&item.span);
                    let mut object = Object {
                        name,
                        material,
                        shape,
                        normals: Normals::default(),
                        attributes: item.attributes.transformed(&transform),
                        place,
                    };
                    if let Some(degrees) = item.smooth {
                        object.shade(NormalsChoice::Smooth(degrees));
                    }
                    self.placed.objects.push(object);
                }
                Content::Group(items) => self.items(items, inside)?,
                Content::Instance(name) => {
                    let group = census::find(self.groups, self.source, name)?;
                    self.items(&group.items, inside)?;
                }
                Content::Import {
                    scene, materials, ..
                } => {
                    // Only the import's own `material` overrides what its objects have.
                    let materials = match (&item.material, material) {
                        (Some(_), Some(material)) => vec![material; scene.materials.len()],
                        _ => materials.clone(),
                    };
                    for object in &scene.objects {
                        let object = self.object(item, inside, object, &materials)?;
                        self.placed.objects.push(object);
                    }
                    self.instances(item, inside, scene, materials)?;
                }
            }
        }
        Ok(())
    }

    /// The object of an import.
    fn object(
        &mut self,
        item: &Item,
        site: Site<'_>,
        object: &Object,
        materials: &[usize],
    ) -> Result<Object, SceneError> {
        let name = format!("{}{}", site.path, object.name);
        let mut placed = Object {
            shape: self.shape(
                item,
                &site.transform,
                &name,
                (&object.shape, &object.attributes),
            )?,
            name,
            material: materials[object.material],
            normals: Normals::default(),
            attributes: object.attributes.transformed(&site.transform),
            place: object.place.clone(),
        };
        match item.smooth {
            Some(degrees) => placed.shade(NormalsChoice::Smooth(degrees)),
            None => placed.normals = object.normals.transformed(&site.transform),
        }
        placed.count_targets_from(first_morph(item));
        Ok(placed)
    }

    /// Places the instances of an import. They become objects inside of parts, and where they are mirrored
    /// or scaled unevenly.
    fn instances(
        &mut self,
        item: &Item,
        site: Site<'_>,
        scene: &Scene,
        materials: Vec<usize>,
    ) -> Result<(), SceneError> {
        if scene.instances.is_empty() {
            return Ok(());
        }
        let outer = Placement::from_affine(site.transform.matrix3, site.transform.translation);
        let Some(outer) = outer.filter(|_| !self.in_part) else {
            return self.flattened(item, site, scene, &materials);
        };
        let smooth = item.smooth.map(f64::to_bits);
        let key = (
            std::ptr::from_ref(scene),
            materials,
            smooth,
            first_morph(item),
        );
        let first = match self.imported.get(&key) {
            Some(&first) => first,
            None => {
                let first = self.placed.parts.len();
                let bare = Site { path: "", ..WORLD };
                for part in &scene.parts {
                    let objects = part.objects.iter();
                    let objects = objects.map(|it| self.object(item, bare, it, &key.1));
                    let objects = objects.collect::<Result<_, _>>()?;
                    self.placed.parts.push(Part {
                        name: format!("{}{}", site.path, part.name),
                        objects,
                        place: part.place.clone(),
                    });
                }
                self.imported.insert(key, first);
                first
            }
        };
        let first_joint = self.placed.joints.len();
        self.joints(item, site, scene)?;
        for instance in &scene.instances {
            let placement = instance.placement.within(&outer);
            if !placement.is_valid() {
                let cause = format!(
                    "the instance {:?} {}",
                    shortened(&instance.name),
                    OUT_OF_RANGE.cause
                );
                return Err(self.source.error(&item.span, cause, OUT_OF_RANGE.remedy));
            }
            self.placed.instances.push(Instance {
                name: format!("{}{}", site.path, instance.name),
                part: first + instance.part,
                placement,
                joint: instance.joint.map(|joint| first_joint + joint),
                place: instance.place.clone(),
            });
        }
        Ok(())
    }

    /// Takes over the joints of an import, and their tracks.
    fn joints(&mut self, item: &Item, site: Site<'_>, scene: &Scene) -> Result<(), SceneError> {
        let first = self.placed.joints.len();
        for joint in &scene.joints {
            let pivot = site.transform.transform_point3(joint.pivot);
            if !pivot.is_finite() {
                let cause = format!(
                    "the joint {:?} {}",
                    shortened(&joint.name),
                    OUT_OF_RANGE.cause
                );
                return Err(self.source.error(&item.span, cause, OUT_OF_RANGE.remedy));
            }
            self.placed.joints.push(Joint {
                name: format!("{}{}", site.path, joint.name),
                parent: joint.parent.map(|parent| first + parent),
                pivot,
                place: joint.place.clone(),
            });
        }
        for track in scene.tracks.iter().filter(|it| it.target.is_of_joint()) {
            let moved = moved(track, &site.transform);
            let moved = moved.ok_or_else(|| lost(self.source, item, "joint"))?;
            self.placed.tracks.push(Track {
                index: first + track.index,
                ..moved
            });
        }
        Ok(())
    }

    fn flattened(
        &mut self,
        item: &Item,
        site: Site<'_>,
        scene: &Scene,
        materials: &[usize],
    ) -> Result<(), SceneError> {
        if scene.instances.iter().any(|it| it.joint.is_some()) {
            let place = self.source.place(&item.span);
            let warning = format!(
                "{place}: the moving instances of this import are copied as they are at rest, because it is in a part, \
                 mirrored or scaled unevenly"
            );
            // Once for an import that stands often.
            if !self.placed.warnings.contains(&warning) {
                self.placed.warnings.push(warning);
            }
        }
        for instance in &scene.instances {
            let path = format!("{}{}/", site.path, instance.name);
            let inside = Site {
                transform: site.transform * instance.placement.affine(),
                path: &path,
                ..site
            };
            for object in &scene.parts[instance.part].objects {
                let object = self.object(item, inside, object, materials)?;
                self.placed.objects.push(object);
            }
        }
        Ok(())
    }

    fn shape(
        &mut self,
        item: &Item,
        transform: &DAffine3,
        name: &str,
        (shape, attributes): (&Shape, &Attributes),
    ) -> Result<Shape, SceneError> {
        if self.in_part && !shape.is_bounded() {
            return Err(self.source.error(
                &item.span,
                format!(
                    "the object {name:?} has no end, and a part has a box",
                    name = shortened(name)
                ),
                "move it out of the part, to the scene's own objects",
            ));
        }
        let shape = shape.transformed(transform).map_err(|misfit| {
            let cause = format!(
                "the object {name:?} {}",
                misfit.cause,
                name = shortened(name)
            );
            self.source.error(&item.span, cause, misfit.remedy)
        })?;
        self.primitives += primitives(&shape);
        if self.primitives > MOST_PRIMITIVES {
            return Err(census::too_many(self.source, item));
        }
        let size = Size::of(&shape, name.len(), attributes);
        self.size = self.size.plus(size);
        census::check_size(self.source, item, self.size)?;
        Ok(shape)
    }
}

/// The number here of the first morph target of an import.
fn first_morph(item: &Item) -> usize {
    match item.content {
        Content::Import { morphs, .. } => morphs,
        _ => 0,
    }
}
