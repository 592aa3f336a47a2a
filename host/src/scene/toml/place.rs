//! Places the objects of groups, instances and imports in the world.

use super::census;
use super::material::Palette;
use super::item::{Content, Group, Item};
use super::source::Source;
use crate::scene::size::{MOST_PRIMITIVES, Size, primitives};
use crate::scene::{Object, SceneError, Shape};
use glam::DAffine3;
use std::collections::BTreeMap;

/// Flattens the tree of items, which must have passed the census, into objects.
pub(super) struct Placer<'p> {
    source: &'p Source,
    groups: &'p BTreeMap<String, Group>,
    palette: &'p mut Palette,
    objects: Vec<Object>,
    /// Counted again, because boxes that are turned become twelve triangles.
    primitives: u64,
    size: Size,
}

/// Where the objects of a list go.
#[derive(Clone, Copy)]
struct Site<'s> {
    transform: DAffine3,
    /// For objects that name no material.
    material: Option<usize>,
    /// Names of the groups around, each followed by a slash.
    path: &'s str,
}

impl<'p> Placer<'p> {
    pub(super) fn new(
        source: &'p Source,
        groups: &'p BTreeMap<String, Group>,
        palette: &'p mut Palette,
        objects: usize,
    ) -> Self {
        Self {
            source,
            groups,
            palette,
            objects: Vec::with_capacity(objects),
            primitives: 0,
            size: Size::default(),
        }
    }

    /// The objects that a scene's own list comes to.
    pub(super) fn place(mut self, items: &[Item]) -> Result<Vec<Object>, SceneError> {
        let world = Site {
            transform: DAffine3::IDENTITY,
            material: None,
            path: "",
        };
        self.items(items, world)?;
        Ok(self.objects)
    }

    fn items(&mut self, items: &[Item], site: Site<'_>) -> Result<(), SceneError> {
        for item in items {
            let material = match &item.material {
                Some(name) => Some(self.palette.find(self.source, name)?),
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
                    let shape = self.shape(item, &transform, &name, shape)?;
                    let material = material.unwrap_or_else(|| self.palette.fallback());
                    let place = self.source.place(&item.span);
                    self.objects.push(Object {
                        name,
                        material,
                        shape,
                        place,
                    });
                }
                Content::Group(items) => self.items(items, inside)?,
                Content::Instance(name) => {
                    let group = census::find(self.groups, self.source, name)?;
                    self.items(&group.items, inside)?;
                }
                Content::Import { scene, materials } => {
                    for object in &scene.objects {
                        let name = format!("{path}{}", object.name);
                        let shape = self.shape(item, &transform, &name, &object.shape)?;
                        // Only the import's own `material` overrides what its objects have.
                        let material = match (&item.material, material) {
                            (Some(_), Some(material)) => material,
                            _ => materials[object.material],
                        };
                        let place = object.place.clone();
                        self.objects.push(Object {
                            name,
                            material,
                            shape,
                            place,
                        });
                    }
                }
            }
        }
        Ok(())
    }

    fn shape(
        &mut self,
        item: &Item,
        transform: &DAffine3,
        name: &str,
        shape: &Shape,
    ) -> Result<Shape, SceneError> {
        let shape = shape.transformed(transform).map_err(|misfit| {
            let cause = format!("the object {name:?} {}", misfit.cause);
            self.source.error(&item.span, cause, misfit.remedy)
        })?;
        self.primitives += primitives(&shape);
        if self.primitives > MOST_PRIMITIVES {
            return Err(census::too_many(self.source, item));
        }
        self.size = self.size.plus(Size::of(&shape, name.len()));
        census::check_size(self.source, item, self.size)?;
        Ok(shape)
    }
}
