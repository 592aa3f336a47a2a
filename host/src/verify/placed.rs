//! Instances by the integers of their maps, for exact arithmetic that shares no code with the kernels.

use super::rounded::{HitId, RoundedRay};
use crate::shape::exact::Line;
use crate::shape::rounding::step;
use crate::shape::{ExactMap, Solid};
use gridel_core::format::record::UnitBox;
use gridel_core::{Format, Hit, Number, Scene};

/// Factor of a step at an instance. The maps of a ray into the part and of its hit out of it round as well.
pub const PLACED: f64 = 4.0;

impl HitId {
    /// Returns the primitive and the instance of a hit.
    pub fn of<N: Number>(hit: &Hit<N>) -> Self {
        Self {
            primitive: hit.primitive,
            instance: hit.instance(),
        }
    }

    /// Returns the primitive in words; of an instance with its object and the instance's number in scene-file order.
    pub fn written(self, scene: &Scene<'_>) -> String {
        let Self {
            primitive,
            instance,
        } = self;
        let instance = instance.and_then(|it| scene.instances().get(it as usize));
        match instance {
            Some(instance) => format!(
                "primitive {primitive} of object {} in instance {}",
                scene.object(primitive),
                instance.number
            ),
            None => format!("primitive {primitive}"),
        }
    }

    /// Returns a primitive of the scene's own objects.
    pub fn own(primitive: u32) -> Self {
        Self {
            primitive,
            instance: None,
        }
    }
}

/// A part's instance, as the judge has it.
#[derive(Clone, Debug)]
pub struct PlacedPart {
    pub map: ExactMap,
    pub part: usize,
    pub first_primitive: u32,
    /// The box of the whole in the scene.
    pub bounds: UnitBox,
}

impl PlacedPart {
    /// Returns all instances of a scene, in the order of its blob. A slot is `None` for one without a part or a box, so
    /// that a number always leads to its instance.
    pub fn all(scene: &Scene<'_>) -> Vec<Option<Self>> {
        let instances = scene.instances().iter();
        let placed = instances.map(|instance| {
            let part = usize::from(instance.part);
            Some(Self {
                map: ExactMap::of(instance),
                part,
                first_primitive: scene.first_primitive_of_part(part)?,
                bounds: instance.around(scene.parts().get(part)?.bounds())?,
            })
        });
        placed.collect()
    }
}

/// A primitive as an exact shape, where it is placed.
#[derive(Clone, Copy, Debug)]
pub struct PlacedSolid<'j> {
    pub solid: &'j Solid,
    /// `None` for one of the scene's own.
    pub map: Option<&'j ExactMap>,
}

impl PlacedSolid<'_> {
    /// Returns the distance by which the surface would have to grow to contain a point, in units of the scene.
    pub fn excess(&self, point: [f64; 3]) -> f64 {
        match self.map {
            None => self.solid.excess(point),
            Some(map) => map.length(self.solid.excess(map.point(point))),
        }
    }

    /// Converts a ray's line to the shape's coordinates.
    pub fn line(&self, line: &Line) -> Line {
        self.map.map_or_else(|| line.clone(), |map| map.line(line))
    }

    /// Converts a length of the scene to the shape's coordinates.
    pub fn own_length(&self, length: f64) -> f64 {
        self.map.map_or(length, |map| map.own_length(length))
    }

    /// Returns the step of a format where a ray meets the shape, in units of the scene.
    pub fn step(&self, format: Format, ray: &RoundedRay, t: f64) -> f64 {
        let Some(map) = self.map else {
            return ray.step(format, t, self.solid);
        };
        let reach = map.reach(ray.start);
        let in_scene = step(format, ray.magnitude(t).max(reach + t.abs()));
        let in_part = map.length(step(format, self.solid.extent()));
        PLACED * in_scene.max(in_part)
    }
}
