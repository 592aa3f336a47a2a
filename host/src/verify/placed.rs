//! Instances by the integers of their maps, for exact arithmetic that shares no code with the kernels.

use super::rounded::{HitId, RoundedRay, step};
use crate::shape::Solid;
use crate::shape::exact::{Line, Real, Vector, dot, minus};
use gridel_core::format::instance::{Instance, MATRIX_BITS};
use gridel_core::format::record::UnitBox;
use gridel_core::{Format, Hit, Number, Scene};

/// How many times a step counts at an instance: the maps of a ray into the part and of its hit out of it round as well.
pub const PLACED: f64 = 4.0;

impl HitId {
    /// The primitive and the instance of a hit.
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

    /// A primitive of the scene's own objects.
    pub fn own(primitive: u32) -> Self {
        Self {
            primitive,
            instance: None,
        }
    }
}

/// The map of an instance.
#[derive(Clone, Debug)]
pub struct ExactMap {
    rows: [Vector; 3],
    center: Vector,
    /// The same in double precision, in which single entries are exact.
    linear: [[f64; 3]; 3],
    middle: [f64; 3],
    /// Units of the part in one of the scene.
    scale: f64,
}

impl ExactMap {
    pub fn of(instance: &Instance) -> Self {
        let power = f64::powi(2.0, i32::from(instance.exponent) - MATRIX_BITS as i32);
        let linear = instance.matrix.map(|row| row.map(|x| f64::from(x) * power));
        let middle = instance.center.map(|x| f64::from(x) / 256.0);
        let [x, y, z] = linear[0];
        Self {
            rows: linear.map(|row| row.map(Real::of)),
            center: middle.map(Real::of),
            linear,
            middle,
            scale: (x * x + y * y + z * z).sqrt(),
        }
    }

    /// A line in the part; its t stays.
    pub fn line(&self, line: &Line) -> Line {
        let from_center = minus(&line.origin, &self.center);
        Line {
            origin: [0, 1, 2].map(|k| dot(&self.rows[k], &from_center)),
            slope: [0, 1, 2].map(|k| dot(&self.rows[k], &line.slope)),
        }
    }

    /// A place of the scene in the part, in double precision.
    pub fn point(&self, place: [f64; 3]) -> [f64; 3] {
        self.direction([0, 1, 2].map(|k| place[k] - self.middle[k]))
    }

    /// A direction of the scene in the part, with the part's length.
    pub fn direction(&self, way: [f64; 3]) -> [f64; 3] {
        self.linear
            .map(|row| (0..3).map(|k| row[k] * way[k]).sum::<f64>())
    }

    /// A place of the part in the scene, in double precision.
    pub fn back(&self, place: [f64; 3]) -> [f64; 3] {
        let square = self.scale * self.scale;
        [0, 1, 2].map(|k| {
            let sum: f64 = (0..3).map(|row| self.linear[row][k] * place[row]).sum();
            self.middle[k] + sum / square
        })
    }

    /// A length of the part in the scene.
    pub fn length(&self, length: f64) -> f64 {
        length / self.scale
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
    /// All instances of a scene, in the order of its blob.
    pub fn all(scene: &Scene<'_>) -> Vec<Self> {
        let instances = scene.instances().iter();
        let placed = instances.filter_map(|instance| {
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
    /// How far the surface would have to grow to hold a point, in units of the scene.
    pub fn excess(&self, point: [f64; 3]) -> f64 {
        match self.map {
            None => self.solid.excess(point),
            Some(map) => map.length(self.solid.excess(map.point(point))),
        }
    }

    /// A ray's line in the shape's coordinates.
    pub fn line(&self, line: &Line) -> Line {
        self.map.map_or_else(|| line.clone(), |map| map.line(line))
    }

    /// A length of the scene in the shape's coordinates.
    pub fn own_length(&self, length: f64) -> f64 {
        self.map.map_or(length, |map| length * map.scale)
    }

    /// The step of a format where a ray meets the shape, in units of the scene.
    pub fn step(&self, format: Format, ray: &RoundedRay, t: f64) -> f64 {
        let Some(map) = self.map else {
            return ray.step(format, t, self.solid);
        };
        let from_center = [0, 1, 2].map(|k| (ray.start[k] - map.middle[k]).abs());
        let reach = from_center.into_iter().fold(0.0, f64::max);
        let in_scene = step(format, ray.magnitude(t).max(reach + t.abs()));
        let in_part = map.length(step(format, self.solid.extent()));
        PLACED * in_scene.max(in_part)
    }
}
