//! The extent of a scene: its shapes where they are placed.

use crate::scene::{Placement, Scene, Shape};
use glam::DVec3;

/// A shape of the scene's own, or of an instance.
#[derive(Clone, Copy, Debug)]
pub struct PlacedShape<'s> {
    shape: &'s Shape,
    placement: Option<&'s Placement>,
}

impl PlacedShape<'_> {
    /// Returns whether it has a box.
    pub fn is_bounded(&self) -> bool {
        self.shape.is_bounded()
    }

    /// Returns the largest `point.dot(direction)` over all points.
    pub fn support(&self, direction: DVec3) -> f64 {
        match self.placement {
            None => self.shape.support(direction),
            Some(placement) => {
                let turned = placement.matrix().transpose() * direction;
                placement.translation.dot(direction) + self.shape.support(turned)
            }
        }
    }

    /// The normals of what is flat, as long as twice its area.
    pub fn faces(&self) -> Vec<DVec3> {
        let faces = self.shape.faces();
        match self.placement {
            None => faces,
            Some(placement) => {
                let turn = placement.matrix() * placement.scale;
                faces.into_iter().map(|face| turn * face).collect()
            }
        }
    }

    fn bounds(&self) -> [DVec3; 2] {
        if self.placement.is_none() {
            return self.shape.bounds();
        }
        let highest = DVec3::AXES.map(|axis| self.support(axis));
        let lowest = DVec3::AXES.map(|axis| -self.support(-axis));
        [lowest, highest].map(DVec3::from_array)
    }
}

/// Returns all shapes: the scene's own, and those of instances where they are placed.
pub fn shapes(scene: &Scene) -> impl Iterator<Item = PlacedShape<'_>> + Clone {
    let own = scene.objects.iter().map(|object| PlacedShape {
        shape: &object.shape,
        placement: None,
    });
    let placed = scene.instances.iter().flat_map(|instance| {
        let objects = scene.parts[instance.part].objects.iter();
        objects.map(|object| PlacedShape {
            shape: &object.shape,
            placement: Some(&instance.placement),
        })
    });
    own.chain(placed)
}

/// Returns the shapes that make up the extent of a scene: the bounded ones, or all if none is bounded.
pub fn in_extent(scene: &Scene) -> impl Iterator<Item = PlacedShape<'_>> + Clone {
    let none_bounded = !shapes(scene).any(|shape| shape.is_bounded());
    shapes(scene).filter(move |shape| none_bounded || shape.is_bounded())
}

/// The box of everything in a scene that has one, or else of points of what has none and of the camera; a point for an
/// empty one.
pub fn extent(scene: &Scene) -> (DVec3, DVec3) {
    let nowhere = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    let [mut lowest, mut highest] = in_extent(scene)
        .map(|shape| shape.bounds())
        .fold(nowhere, |[low, high], [lowest, highest]| {
            [low.min(lowest), high.max(highest)]
        });
    if lowest.x > highest.x {
        return (DVec3::ZERO, DVec3::ZERO);
    }
    let is_bounded = shapes(scene).any(|shape| shape.is_bounded());
    if let Some(camera) = scene.camera.filter(|_| !is_bounded) {
        for place in [camera.eye, camera.target] {
            (lowest, highest) = (lowest.min(place), highest.max(place));
        }
    }
    (lowest, highest)
}
