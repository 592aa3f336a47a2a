//! The brightest single samples of lights that arrive at surfaces.

use crate::scene::{LightForm, LightShape, Object, Scene};
use crate::shape::Shape;
use glam::DVec3;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// A box, by its lowest and its highest corner.
type Bounds = [DVec3; 2];

/// Where surfaces of a material are.
pub(super) struct Surfaces {
    /// At most twice as many as `most`. One box around all would fill a room whose walls they are.
    boxes: Vec<Bounds>,
    most: usize,
    /// True if some of them are unbounded, or move.
    are_everywhere: bool,
}

impl Surfaces {
    /// Returns those of each wanted material, by its number, in about so many boxes.
    pub(super) fn of_all(scene: &Scene, is_wanted: &[bool], most: usize) -> BTreeMap<usize, Self> {
        let mut all = Self::of_objects(&scene.objects, is_wanted, most);
        let most_of_part = (most / scene.instances.len().max(1)).max(1);
        let parts = scene.parts.iter();
        let parts = parts.map(|part| Self::of_objects(&part.objects, is_wanted, most_of_part));
        let parts: Vec<_> = parts.collect();
        for instance in &scene.instances {
            for (&material, of_part) in &parts[instance.part] {
                let surfaces = all.entry(material).or_insert_with(|| Self::new(most));
                surfaces.are_everywhere |= of_part.are_everywhere || instance.joint.is_some();
                for [low, high] in &of_part.boxes {
                    let corners = (0..8).map(|corner| {
                        let axis = |k: usize| [low[k], high[k]][corner >> k & 1];
                        let corner = DVec3::new(axis(0), axis(1), axis(2));
                        instance.placement.point(corner)
                    });
                    surfaces.push(around(corners));
                }
            }
        }
        all
    }

    fn of_objects(objects: &[Object], is_wanted: &[bool], most: usize) -> BTreeMap<usize, Self> {
        let mut all = BTreeMap::new();
        for object in objects.iter().filter(|it| is_wanted[it.material]) {
            let surfaces = all
                .entry(object.material)
                .or_insert_with(|| Self::new(most));
            surfaces.are_everywhere |= !object.shape.is_bounded();
            match &object.shape {
                Shape::Mesh {
                    vertices,
                    triangles,
                } => {
                    for triangle in triangles {
                        let corners = triangle.iter().map(|&corner| vertices[corner as usize]);
                        surfaces.push(around(corners));
                    }
                }
                shape => surfaces.push(shape.bounds()),
            }
        }
        all
    }

    fn new(most: usize) -> Self {
        Self {
            boxes: Vec::new(),
            most,
            are_everywhere: false,
        }
    }

    fn push(&mut self, bounds: Bounds) {
        if self.boxes.len() >= 2 * self.most {
            // What stands side by side in a file is mostly near each other.
            let pairs = self.boxes.chunks(2);
            let joined = pairs.map(|pair| around(pair.iter().flatten().copied()));
            self.boxes = joined.collect();
        }
        self.boxes.push(bounds);
    }
}

/// Returns the box around points.
fn around(points: impl Iterator<Item = DVec3>) -> Bounds {
    let none = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    points.fold(none, |[low, high], it| [low.min(it), high.max(it)])
}

/// Returns the distance between boxes.
fn distance([low, high]: Bounds, [other_low, other_high]: Bounds) -> f64 {
    let apart = (low - other_high).max(other_low - high);
    apart.max(DVec3::ZERO).length()
}

/// Returns the largest `point.dot(direction)` of a box.
fn support([low, high]: Bounds, direction: DVec3) -> f64 {
    (low * direction).max(high * direction).element_sum()
}

/// Returns the brightest sample that arrives at surfaces of a light of this form, over the light's color. `position` is
/// `None` if it moves.
pub(super) fn arriving(form: &LightForm, position: Option<DVec3>, surfaces: &Surfaces) -> f64 {
    let Some(position) = position.filter(|_| !surfaces.are_everywhere) else {
        return at_distance(form, 0.0);
    };
    let [low, high] = extent(&form.shape);
    let light = [position + low, position + high];
    let normal = normal(&form.shape);
    let faces = |bounds: &&Bounds| {
        normal.is_none_or(|normal| support(**bounds, normal) > normal.dot(position))
    };
    let lit = surfaces.boxes.iter().filter(faces);
    let nearest = lit.map(|it| distance(*it, light)).reduce(f64::min);
    nearest.map_or(0.0, |nearest| at_distance(form, nearest))
}

/// Returns the box of a light about its position: of a sphere, that of its middle.
fn extent(shape: &LightShape) -> Bounds {
    match *shape {
        LightShape::Point | LightShape::Facet { .. } | LightShape::Sphere { .. } => {
            [DVec3::ZERO; 2]
        }
        LightShape::Rectangle { edges: [a, b] } => around([DVec3::ZERO, a, b, a + b].into_iter()),
        LightShape::Triangle { edges: [a, b] } => around([DVec3::ZERO, a, b].into_iter()),
        LightShape::Disc { normal, radius } => {
            let normal = normal.normalize_or_zero();
            let axis = |along: f64| radius * (1.0 - along * along).max(0.0).sqrt();
            let half = DVec3::new(axis(normal.x), axis(normal.y), axis(normal.z));
            [-half, half]
        }
    }
}

/// Returns the side to which a flat light shines.
fn normal(shape: &LightShape) -> Option<DVec3> {
    match *shape {
        LightShape::Point | LightShape::Sphere { .. } => None,
        LightShape::Rectangle { edges: [a, b] } | LightShape::Triangle { edges: [a, b] } => {
            Some(a.cross(b))
        }
        LightShape::Disc { normal, .. } | LightShape::Facet { normal } => Some(normal),
    }
}

/// Returns the brightest sample at a distance from a light, over its color.
fn at_distance(form: &LightForm, distance: f64) -> f64 {
    if form.range.is_some_and(|range| distance >= range) {
        return 0.0;
    }
    // Flat lights are drawn within a parallelogram, by an angle of at most 8: see `solid_angle` of `gridel-core`.
    let flat = |area: f64| (area / (distance * distance)).min(8.0) / PI;
    match form.shape {
        LightShape::Point | LightShape::Facet { .. } if form.falls_off => {
            1.0 / (distance * distance)
        }
        LightShape::Point | LightShape::Facet { .. } => 1.0,
        LightShape::Sphere { radius } => {
            let sine = radius / distance.max(radius);
            2.0 * (1.0 - (1.0 - sine * sine).sqrt())
        }
        LightShape::Rectangle { edges: [a, b] } | LightShape::Triangle { edges: [a, b] } => {
            flat(a.cross(b).length())
        }
        LightShape::Disc { radius, .. } => flat(4.0 * radius * radius),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_meshes_and_many_instances_take_few_boxes() {
        let strip: Vec<_> = (0..60).map(|x| format!("[{x}, {}, 0]", x % 2)).collect();
        let faces: Vec<_> = (0..58)
            .map(|x| format!("[{x}, {}, {}]", x + 1, x + 2))
            .collect();
        let mesh = format!(
            "kind = 'mesh'\nvertices = [{}]\nfaces = [{}]",
            strip.join(","),
            faces.join(",")
        );
        let mut file =
            format!("[[object]]\n{mesh}\n[[part]]\nname = 'p'\n[[part.object]]\n{mesh}\n");
        for x in 1..10 {
            file += &format!(
                "[[instance]]\npart = 'p'\ntranslate = [{}, 0, 0]\n",
                100 * x
            );
        }
        let imported = crate::scene::read("a.toml".as_ref(), file.into(), &Default::default());
        let scene = imported.unwrap().scene;
        for most in [1, 2, 7, 4096] {
            let all = Surfaces::of_all(&scene, &[true], most);
            let [surfaces] = &all.values().collect::<Vec<_>>()[..] else {
                panic!("{} materials", all.len())
            };
            let count = surfaces.boxes.len();
            assert!(count <= 2 * most, "{count} boxes");
            let corners = surfaces.boxes.iter().flatten().copied();
            let whole = [DVec3::ZERO, DVec3::new(959.0, 1.0, 0.0)];
            assert_eq!(around(corners), whole);
            // Meshes far apart stay apart where there are boxes for them.
            let between = [DVec3::new(70.0, 0.0, 0.0), DVec3::new(90.0, 1.0, 0.0)];
            let is_apart = surfaces.boxes.iter().all(|it| distance(*it, between) > 0.0);
            assert_eq!(is_apart, most == 4096);
        }
        assert!(Surfaces::of_all(&scene, &[false], 7).is_empty());
    }
}
