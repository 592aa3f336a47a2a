//! The brightest single samples of lights that arrive at surfaces.

use crate::scene::{Light, LightForm, LightShape, Object, Scene};
use crate::shape::Shape;
use glam::DVec3;
use gridel_core::format::track::TrackTarget;
use std::f64::consts::PI;

/// A box, by its lowest and its highest corner.
type Bounds = [DVec3; 2];

/// The most boxes of a mesh.
const MOST_BOXES: usize = 4096;

/// Where surfaces of a material are.
#[derive(Default)]
pub(super) struct Surfaces {
    boxes: Vec<Bounds>,
    /// True if some of them are unbounded, or move.
    are_everywhere: bool,
}

impl Surfaces {
    /// Returns those of a material.
    pub(super) fn of(scene: &Scene, material: usize) -> Self {
        let mut surfaces = Self::default();
        let of_material = |object: &&Object| object.material == material;
        for object in scene.objects.iter().filter(of_material) {
            surfaces.add(object);
        }
        for instance in &scene.instances {
            let part = &scene.parts[instance.part];
            let mut of_part = Self::default();
            part.objects
                .iter()
                .filter(of_material)
                .for_each(|object| of_part.add(object));
            surfaces.are_everywhere |= of_part.are_everywhere;
            surfaces.are_everywhere |= instance.joint.is_some() && !of_part.boxes.is_empty();
            let placed = of_part.boxes.iter().map(|[low, high]| {
                let corners = (0..8).map(|corner| {
                    let axis = |k: usize| [low[k], high[k]][corner >> k & 1];
                    instance
                        .placement
                        .point(DVec3::new(axis(0), axis(1), axis(2)))
                });
                around(corners)
            });
            surfaces.boxes.extend(placed);
        }
        surfaces
    }

    fn add(&mut self, object: &Object) {
        self.are_everywhere |= !object.shape.is_bounded();
        match &object.shape {
            // One box around all would fill a room whose walls they are.
            Shape::Mesh {
                vertices,
                triangles,
            } => {
                let groups = triangles.chunks(triangles.len().div_ceil(MOST_BOXES).max(1));
                self.boxes.extend(groups.map(|group| {
                    let corners = group.iter().flatten();
                    around(corners.map(|&corner| vertices[corner as usize]))
                }));
            }
            shape => self.boxes.push(shape.bounds()),
        }
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

/// Returns the brightest sample of a light that arrives at surfaces, over the light's color.
pub(super) fn arriving(scene: &Scene, number: usize, surfaces: &Surfaces) -> f64 {
    let form = scene.light_forms.get(number).and_then(Option::as_ref);
    let (Some(form), Light::Point { position, .. }) = (form, scene.lights[number]) else {
        return 1.0;
    };
    let mut tracks = scene.tracks.iter();
    let moves =
        tracks.any(|track| (track.target, track.index) == (TrackTarget::LightPosition, number));
    if moves || surfaces.are_everywhere {
        return at_distance(form, 0.0);
    }
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
