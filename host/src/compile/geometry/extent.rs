//! The extent of a scene: its shapes where they are placed.

use super::support::SupportTree;
use crate::scene::{Instance, Object, Part, Placement, Scene, Shape};
use glam::DVec3;

/// The shapes of a scene: its own, and those of instances where they are placed.
///
/// Parts are prepared once, so that each instance costs little however large its part is.
#[derive(Debug)]
pub struct Shapes<'s> {
    scene: &'s Scene,
    parts: Vec<PreparedPart<'s>>,
    /// True if any shape has a box. Then only these make up the extent.
    any_bounded: bool,
}

/// A part, as all its instances need it.
#[derive(Debug)]
struct PreparedPart<'s> {
    tree: SupportTree<'s>,
    faces: Vec<DVec3>,
    /// True if it has only flat faces.
    is_flat: bool,
}

/// Most faces of a part that are kept one by one.
const MOST_FACES: usize = 1024;

impl<'s> PreparedPart<'s> {
    fn of(part: &'s Part) -> Self {
        let shapes = || part.objects.iter().map(|object| &object.shape);
        let faces: Vec<Vec<DVec3>> = shapes().map(Shape::faces).collect();
        Self {
            tree: SupportTree::of(shapes().filter(|shape| shape.is_bounded())),
            is_flat: faces.iter().all(|faces| !faces.is_empty()),
            faces: joined(faces.concat()),
        }
    }

    /// The largest `point.dot(direction)` over all points of an instance.
    fn support(&self, placement: &Placement, direction: DVec3) -> f64 {
        let turned = placement.matrix().transpose() * direction;
        placement.translation.dot(direction) + self.tree.support(turned)
    }
}

/// Returns faces. If there are many, faces with nearly the same normal are joined.
fn joined(faces: Vec<DVec3>) -> Vec<DVec3> {
    const SIDE: usize = 16;
    if faces.len() <= MOST_FACES {
        return faces;
    }
    let mut joined = vec![DVec3::ZERO; 6 * SIDE * SIDE];
    for face in faces {
        let largest = face.abs().max_element();
        if largest == 0.0 || !largest.is_finite() {
            continue;
        }
        let slope = face / largest;
        let axis = slope.abs().max_position();
        let cell = |k: usize| {
            let along = (slope[(axis + k) % 3] + 1.0) / 2.0 * SIDE as f64;
            (along as usize).min(SIDE - 1)
        };
        let side = 2 * axis + usize::from(slope[axis] > 0.0);
        joined[(side * SIDE + cell(1)) * SIDE + cell(2)] += face;
    }
    joined.retain(|face| *face != DVec3::ZERO);
    joined
}

impl<'s> Shapes<'s> {
    /// Returns the shapes of a scene.
    pub fn of(scene: &'s Scene) -> Self {
        let bounded = |object: &Object| object.shape.is_bounded();
        let placed = |instance: &Instance| scene.parts[instance.part].objects.iter().any(bounded);
        Self {
            parts: scene.parts.iter().map(PreparedPart::of).collect(),
            any_bounded: scene.objects.iter().any(bounded) || scene.instances.iter().any(placed),
            scene,
        }
    }

    /// Returns the scene.
    pub fn scene(&self) -> &'s Scene {
        self.scene
    }

    /// The scene's own shapes that make up its extent: the bounded ones, or all if none is bounded.
    fn own(&self) -> impl Iterator<Item = &'s Shape> {
        let any_bounded = self.any_bounded;
        let shapes = self.scene.objects.iter().map(|object| &object.shape);
        shapes.filter(move |shape| !any_bounded || shape.is_bounded())
    }

    fn placed(&self) -> impl Iterator<Item = (&PreparedPart<'s>, &'s Placement)> {
        let instances = self.scene.instances.iter();
        instances.map(|instance| (&self.parts[instance.part], &instance.placement))
    }

    /// Returns the largest `point.dot(direction)` over all points; negative infinity without points.
    pub fn support(&self, direction: DVec3) -> f64 {
        let own = self.own().map(|shape| shape.support(direction));
        let placed = self
            .placed()
            .map(|(part, placement)| part.support(placement, direction));
        own.chain(placed).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Calls `visit` with the normals of all flat faces, twice as long as the face's area.
    pub fn each_face(&self, mut visit: impl FnMut(DVec3)) {
        for object in &self.scene.objects {
            object.shape.faces().into_iter().for_each(&mut visit);
        }
        for (part, placement) in self.placed() {
            let turn = placement.matrix() * placement.scale;
            part.faces.iter().for_each(|face| visit(turn * *face));
        }
    }

    /// Returns whether every bounded shape has flat faces and nothing else.
    pub fn are_flat(&self) -> bool {
        let mut own = self.own().filter(|shape| shape.is_bounded());
        own.all(|shape| !shape.faces().is_empty()) && self.placed().all(|(part, _)| part.is_flat)
    }

    /// Returns the box of all shapes that have one, or else of points of the other shapes and of the camera. It is a
    /// point for an empty scene.
    pub fn extent(&self) -> (DVec3, DVec3) {
        let mut lowest = DVec3::INFINITY;
        let mut highest = DVec3::NEG_INFINITY;
        for [low, high] in self.own().map(Shape::bounds) {
            (lowest, highest) = (lowest.min(low), highest.max(high));
        }
        for (part, placement) in self.placed() {
            let along = |axis: DVec3| part.support(placement, axis);
            highest = highest.max(DVec3::from_array(DVec3::AXES.map(along)));
            lowest = lowest.min(-DVec3::from_array(DVec3::AXES.map(|axis| along(-axis))));
        }
        if lowest.x > highest.x {
            return (DVec3::ZERO, DVec3::ZERO);
        }
        if let Some(camera) = self.scene.camera.filter(|_| !self.any_bounded) {
            for place in [camera.eye, camera.target] {
                (lowest, highest) = (lowest.min(place), highest.max(place));
            }
        }
        (lowest, highest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::scene::{Attributes, Material, Normals, SourceSpan};
    use glam::DQuat;

    fn random_point(random: &mut Random, size: f64) -> DVec3 {
        size * DVec3::from_array([(); 3].map(|()| random.signed()))
    }

    fn random_scene(random: &mut Random) -> Scene {
        let vertices: Vec<DVec3> = (0..500).map(|_| random_point(random, 2.0)).collect();
        let triangles = (0..300).map(|_| [(); 3].map(|()| random.below(400) as u32));
        let mesh = Shape::Mesh {
            vertices,
            triangles: triangles.collect(),
        };
        let ball = |random: &mut Random| {
            Shape::Sphere(crate::shape::Sphere {
                center: random_point(random, 3.0),
                radius: random.unit(),
            })
        };
        let mut shapes = vec![mesh];
        shapes.extend((0..40).map(|_| ball(random)));
        let object = |shape| Object {
            normals: Normals::default(),
            attributes: Attributes::default(),
            name: String::new(),
            material: 0,
            shape,
            place: SourceSpan::default(),
        };
        let instance = |random: &mut Random| Instance {
            name: String::new(),
            part: 0,
            joint: None,
            placement: Placement {
                rotation: DQuat::from_scaled_axis(random_point(random, 2.0)),
                translation: random_point(random, 50.0),
                scale: random.magnitude(0.1, 3.0),
            },
            place: SourceSpan::default(),
        };
        Scene {
            materials: vec![Material::default()],
            parts: vec![Part {
                name: String::new(),
                objects: shapes.into_iter().map(object).collect(),
                place: SourceSpan::default(),
            }],
            instances: (0..6).map(|_| instance(random)).collect(),
            ..Scene::default()
        }
    }

    /// The support equals its definition to the last bit.
    #[test]
    fn support_of_instances_is_the_largest_over_all_vertices() {
        let random = &mut Random(5);
        for _ in 0..10 {
            let scene = random_scene(random);
            let shapes = Shapes::of(&scene);
            for _ in 0..50 {
                let mut direction = random_point(random, 1.0);
                if random.one_in(3) {
                    direction = DVec3::AXES[random.below(3)] * random.signed().signum();
                }
                let mut expected = f64::NEG_INFINITY;
                for Instance { placement, .. } in &scene.instances {
                    let turned = placement.matrix().transpose() * direction;
                    for object in &scene.parts[0].objects {
                        let support = object.shape.support(turned);
                        expected = expected.max(placement.translation.dot(direction) + support);
                    }
                }
                assert_eq!(shapes.support(direction), expected);
            }
        }
    }

    #[test]
    fn joined_faces_are_as_large_as_the_faces() {
        let random = &mut Random(6);
        let faces: Vec<_> = (0..20_000).map(|_| random_point(random, 1.0)).collect();
        let whole: f64 = faces.iter().map(|face| face.length()).sum();
        let few = joined(faces);
        assert!(few.len() <= 1536);
        let area: f64 = few.iter().map(|face| face.length()).sum();
        assert!(
            area > 0.99 * whole && area <= 1.000_001 * whole,
            "{area} of {whole}"
        );
    }
}
