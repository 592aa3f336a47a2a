//! Makes objects of instances.

use super::size::{MOST_PRIMITIVES, Size, primitives};
use super::{Instance, Object, Part, Scene, SceneError};
use crate::shape::transform::Misfit;
use crate::table::{grouped, shortened};
use std::borrow::Cow;

const KEEP: &str = "keep the instances with `--instances keep`, or place fewer of them";

impl Scene {
    /// Returns the scene with objects in place of parts and instances. Those of each instance follow the scene's own,
    /// and are named `INSTANCE/OBJECT`. They stand where the instances are at rest, and joints and their tracks are
    /// left out.
    ///
    /// # Errors
    /// If the scene would have more than 16,777,216 primitives or take too much memory. Also if a placement moves a
    /// shape out of the range of numbers.
    ///
    /// ```
    /// use gridel_host::scene::read;
    ///
    /// let file = "[[part]]\nname = 'wheel'\n\
    ///     [[part.object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'hub'\n\
    ///     [[instance]]\npart = 'wheel'\nname = 'left'\n\
    ///     [[instance]]\npart = 'wheel'\nname = 'right'\ntranslate = [4, 0, 0]\n";
    /// let imported = read("cart.toml".as_ref(), file.into(), &Default::default())?;
    /// let flat = imported.scene.flattened()?;
    /// assert_eq!(flat.objects[1].name, "right/hub");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn flattened(&self) -> Result<Cow<'_, Self>, SceneError> {
        if self.parts.is_empty() && self.instances.is_empty() {
            return Ok(Cow::Borrowed(self));
        }
        // Before anything is copied.
        self.check_flattened()?;
        let mut flat = Self {
            parts: Vec::new(),
            instances: Vec::new(),
            ..self.clone()
        };
        flat.without_joints();
        flat.place_all(&self.parts, &self.instances)?;
        Ok(Cow::Owned(flat))
    }

    /// Like [`Self::flattened`], without a copy of the unchanged parts.
    pub(super) fn into_flattened(mut self) -> Result<Self, SceneError> {
        if !self.instances.is_empty() {
            self.check_flattened()?;
        }
        let parts = std::mem::take(&mut self.parts);
        let instances = std::mem::take(&mut self.instances);
        self.without_joints();
        self.place_all(&parts, &instances)?;
        Ok(self)
    }

    fn without_joints(&mut self) {
        self.joints.clear();
        self.tracks.retain(|track| !track.target.is_of_joint());
    }

    fn place_all(&mut self, parts: &[Part], instances: &[Instance]) -> Result<(), SceneError> {
        // Counted again, because boxes that are turned become twelve triangles.
        let mut weight = Weight::of(&self.objects);
        for instance in instances {
            for object in &parts[instance.part].objects {
                let object = placed(instance, object)?;
                weight.add(&object);
                weight.check(instance)?;
                self.objects.push(object);
            }
        }
        Ok(())
    }

    /// Counts what flattening makes, before it is made.
    fn check_flattened(&self) -> Result<(), SceneError> {
        let parts: Vec<Weight> = self
            .parts
            .iter()
            .map(|it| Weight::of(&it.objects))
            .collect();
        let mut weight = Weight::of(&self.objects);
        for instance in &self.instances {
            let part = parts[instance.part];
            let size = part.size.with_longer_names(instance.name.len() + 1);
            weight.size = weight.size.plus(size);
            weight.primitives = weight.primitives.saturating_add(part.primitives);
        }
        self.instances
            .last()
            .map_or(Ok(()), |last| weight.check(last))
    }
}

/// An object of a part where an instance places it.
fn placed(instance: &Instance, object: &Object) -> Result<Object, SceneError> {
    let by = instance.placement.affine();
    let misfit = |Misfit { cause, remedy }| {
        let cause = format!(
            "the object {:?} of instance {:?} {cause}",
            shortened(&object.name),
            shortened(&instance.name)
        );
        error(instance, cause, remedy)
    };
    Ok(Object {
        name: format!("{}/{}", instance.name, object.name),
        material: object.material,
        shape: object.shape.transformed(&by).map_err(misfit)?,
        place: object.place.clone(),
        normals: object.normals.transformed(&by),
        attributes: object.attributes.transformed(&by),
    })
}

/// Primitives and memory.
#[derive(Clone, Copy, Default)]
struct Weight {
    primitives: u64,
    size: Size,
}

impl Weight {
    fn of(objects: &[Object]) -> Self {
        let mut weight = Self::default();
        objects.iter().for_each(|object| weight.add(object));
        weight
    }

    fn add(&mut self, object: &Object) {
        self.primitives = self.primitives.saturating_add(primitives(&object.shape));
        self.size = self.size.plus(Size::of(
            &object.shape,
            object.name.len(),
            &object.attributes,
        ));
    }

    fn check(&self, instance: &Instance) -> Result<(), SceneError> {
        if self.primitives > MOST_PRIMITIVES {
            let cause = format!(
                "the flattened instances come to {} primitives; a scene holds {}",
                grouped(self.primitives),
                grouped(MOST_PRIMITIVES)
            );
            return Err(error(instance, cause, KEEP));
        }
        match self.size.excess() {
            Some(excess) => {
                let cause = format!("the flattened instances take {excess}");
                Err(error(instance, cause, KEEP))
            }
            None => Ok(()),
        }
    }
}

fn error(instance: &Instance, cause: String, remedy: &str) -> SceneError {
    let error = SceneError::new(&instance.place.file, cause, remedy);
    match instance.place.line {
        0 => error,
        line => error.at_line(line),
    }
}

#[cfg(test)]
mod tests;
