//! Counts the content of a scene before anything is placed. Groups in groups can exceed all memory in a few lines.

use super::item::{Content, Group, Item, PartItem};
use super::material::Materials;
use super::source::{Name, Source, Span, key, undefined};
use crate::scene::size::{Keys, MOST_PRIMITIVES, Size, primitives};
use crate::scene::{Scene, SceneError};
use crate::table::shortened;
use std::collections::{BTreeMap, HashMap};

/// Greatest depth of nested groups; reading and placing them takes stack.
pub(super) const MAX_NESTING: usize = 64;

/// The cost of placing some objects.
#[derive(Clone, Copy, Default)]
struct Cost {
    /// Primitives, or an equivalent of their memory.
    primitives: u64,
    size: Size,
    /// Keys of the tracks of joints, which each placement copies.
    keys: u64,
    /// The depth of nested groups.
    nesting: usize,
}

impl Cost {
    /// Returns the cost of an item's content, whose names begin with the item's.
    fn inside(self, item: &Item) -> Self {
        Self {
            size: self.size.with_longer_names(item.name.len() + 1),
            ..self
        }
    }
}

/// The result of the census.
pub(super) struct Usage {
    /// The number of objects in the scene's own list after expansion.
    pub(super) objects: usize,
    /// About groups that the scene does not use.
    pub(super) warnings: Vec<String>,
}

/// Proves that the objects and groups of a scene can be placed: names refer to something, no
/// group contains itself, and limits are kept.
pub(super) struct Census<'c> {
    source: &'c Source,
    groups: &'c BTreeMap<String, Group>,
    materials: &'c Materials,
    /// Groups whose cost is known.
    known: HashMap<&'c str, Cost>,
    /// Groups being counted, the outermost first.
    open: Vec<&'c str>,
}

impl<'c> Census<'c> {
    pub(super) fn new(
        source: &'c Source,
        groups: &'c BTreeMap<String, Group>,
        materials: &'c Materials,
    ) -> Self {
        Self {
            source,
            groups,
            materials,
            known: HashMap::new(),
            open: Vec::new(),
        }
    }

    /// Proves it for a scene and its parts.
    pub(super) fn take(
        mut self,
        items: &'c [Item],
        parts: &'c [PartItem],
    ) -> Result<Usage, SceneError> {
        let objects = self.items(items, 0)?.size.objects;
        for part in parts {
            self.items(&part.items, 1)?;
        }
        let used = |name: &String| self.known.contains_key(name.as_str());
        let unused: Vec<_> = self.groups.iter().filter(|(name, _)| !used(name)).collect();
        let mut warnings = Vec::new();
        for (name, group) in unused {
            let place = self.source.place(&group.span);
            warnings.push(format!(
                "{place}: the group {name:?} is placed nowhere",
                name = shortened(name)
            ));
            // Groups that are never placed must still be valid.
            self.open.push(name);
            self.items(&group.items, 1)?;
            self.open.pop();
        }
        Ok(Usage {
            objects: objects as usize,
            warnings,
        })
    }

    fn items(&mut self, items: &'c [Item], nesting: usize) -> Result<Cost, SceneError> {
        let mut total = Cost::default();
        for item in items {
            if let Some(material) = &item.material {
                self.materials.find(self.source, material)?;
            }
            let cost = match &item.content {
                Content::Shape(shape) => Cost {
                    primitives: primitives(shape),
                    size: Size::of(shape, item.name.len(), &item.attributes),
                    ..Cost::default()
                },
                // An import is weighed as at least 1, so that nothing can be repeated for free.
                Content::Import { scene, .. } => Cost {
                    primitives: imported(scene).max(1),
                    size: imported_size(scene).with_longer_names(item.name.len() + 1),
                    keys: joint_keys(scene),
                    nesting: 0,
                },
                Content::Group(items) => self.nested(items, nesting, item)?.inside(item),
                Content::Instance(name) => self.instance(name, nesting, item)?.inside(item),
            };
            total.size = total.size.plus(cost.size);
            total.primitives = total.primitives.saturating_add(cost.primitives);
            total.keys = total.keys.saturating_add(cost.keys);
            total.nesting = total.nesting.max(cost.nesting);
            if total.primitives > MOST_PRIMITIVES {
                return Err(too_many(self.source, item));
            }
            check_size(self.source, item, total.size)?;
            Keys::default().add(total.keys).map_err(|excess| {
                self.source.error(
                    &item.span,
                    format!("with this object the tracks of joints have {excess}"),
                    "use fewer instances, or import files with fewer keys",
                )
            })?;
        }
        Ok(total)
    }

    fn nested(
        &mut self,
        items: &'c [Item],
        nesting: usize,
        item: &Item,
    ) -> Result<Cost, SceneError> {
        self.check_nesting(nesting + 1, item)?;
        let cost = self.items(items, nesting + 1)?;
        Ok(Cost {
            nesting: cost.nesting + 1,
            ..cost
        })
    }

    fn instance(
        &mut self,
        name: &'c Name,
        nesting: usize,
        item: &Item,
    ) -> Result<Cost, SceneError> {
        let group = find(self.groups, self.source, name)?;
        let text = name.text.as_str();
        if let Some(&cost) = self.known.get(text) {
            self.check_nesting(nesting + cost.nesting, item)?;
            return Ok(cost);
        }
        if let Some(first) = self.open.iter().position(|open| *open == text) {
            let circle = [&self.open[first..], &[text]].concat().join(" -> ");
            return Err(self.source.error(
                &name.span,
                format!("these groups contain each other in a circle: {circle}"),
                "remove one of these instances",
            ));
        }
        self.open.push(text);
        let cost = self.nested(&group.items, nesting, item)?;
        self.open.pop();
        self.known.insert(text, cost);
        Ok(cost)
    }

    fn check_nesting(&self, nesting: usize, item: &Item) -> Result<(), SceneError> {
        if nesting <= MAX_NESTING {
            return Ok(());
        }
        Err(too_deep(self.source, &item.span))
    }
}

pub(super) fn too_deep(source: &Source, span: &Span) -> SceneError {
    source.error(
        span,
        format!("groups are nested deeper than {MAX_NESTING}"),
        "put the objects of some groups into the groups that contain these",
    )
}

pub(super) fn too_many(source: &Source, item: &Item) -> SceneError {
    source.error(
        &item.span,
        format!("with this object the scene holds more than {MOST_PRIMITIVES} primitives"),
        "use fewer instances, or simpler groups and meshes",
    )
}

pub(super) fn check_size(source: &Source, item: &Item, size: Size) -> Result<(), SceneError> {
    let Some(excess) = size.excess() else {
        return Ok(());
    };
    Err(source.error(
        &item.span,
        format!("with this object the scene takes {excess}"),
        "use fewer instances, or simpler groups and meshes",
    ))
}

/// The group that a name refers to.
pub(super) fn find<'g>(
    groups: &'g BTreeMap<String, Group>,
    source: &Source,
    name: &Name,
) -> Result<&'g Group, SceneError> {
    groups.get(&name.text).ok_or_else(|| {
        let known = groups.keys().map(String::as_str);
        let key = key(&name.text);
        let remedy = undefined(&name.text, known, &format!("`[group.{key}]`"), || {
            format!("define it: `[[group.{key}.object]]` above each of its objects")
        });
        source.error(
            &name.span,
            format!("there is no group {:?}", shortened(&name.text)),
            remedy,
        )
    })
}

fn imported_size(scene: &Scene) -> Size {
    let objects = scene.all_objects();
    let objects = objects.map(|it| Size::of(&it.shape, it.name.len(), &it.attributes));
    let instances = scene.instances.iter().map(|it| Size {
        objects: 1,
        names: it.name.len() as u64,
        triangles: 0,
    });
    objects.chain(instances).fold(Size::default(), Size::plus)
}

/// Returns the primitives of an import. Instances, joints and keys count as well, so that they do not multiply at no
/// cost.
fn imported(scene: &Scene) -> u64 {
    let objects = scene.all_objects().map(|object| primitives(&object.shape));
    let others = scene.instances.len() + scene.joints.len();
    objects.sum::<u64>() + others as u64 + joint_keys(scene)
}

/// Returns the keys of an import that each of its placements copies. Those of its other tracks are copied once for each
/// import, where they are counted.
fn joint_keys(scene: &Scene) -> u64 {
    let tracks = scene.tracks.iter().filter(|it| it.target.is_of_joint());
    tracks.map(|it| it.keys.len() as u64).sum()
}
