//! The middle and the size of a scene, from its vertices where instances place them.

use crate::scene::{Object, Part, Scene, Shape};
use glam::{DAffine3, DVec3};
use std::collections::HashMap;

/// Margin of a range relative to its size, before it counts as one that cannot matter.
const SLACK: f64 = 1e-9;

/// The middle of the box around all meshes, and the length of its diagonal.
pub(super) fn middle(scene: &Scene) -> (DVec3, f64) {
    let [low, high] = Meshes::of(scene).bounds();
    ((low + high) * 0.5, low.distance(high))
}

const NOWHERE: [DVec3; 2] = [DVec3::INFINITY, DVec3::NEG_INFINITY];

fn joined([low, high]: [DVec3; 2], vertex: DVec3) -> [DVec3; 2] {
    [low.min(vertex), high.max(vertex)]
}

fn vertices(objects: &[Object]) -> impl Iterator<Item = DVec3> + Clone {
    let meshes = objects.iter().filter_map(|object| match &object.shape {
        Shape::Mesh { vertices, .. } => Some(vertices),
        _ => None,
    });
    meshes.flatten().copied()
}

/// The meshes of a scene.
///
/// One coordinate of a placed vertex is a row of the placement times the vertex, plus a number. So the range of each
/// row over a part's vertices is computed once, and only where the part's box reaches beyond what is known.
struct Meshes<'s> {
    scene: &'s Scene,
    /// The box of each part.
    boxes: Vec<[DVec3; 2]>,
    /// The range of the vertices of a part along a row.
    ranges: HashMap<(usize, [u64; 3]), [f64; 2]>,
    #[cfg(test)]
    passes: usize,
}

impl<'s> Meshes<'s> {
    fn of(scene: &'s Scene) -> Self {
        let of_part = |part: &Part| vertices(&part.objects).fold(NOWHERE, joined);
        Self {
            scene,
            boxes: scene.parts.iter().map(of_part).collect(),
            ranges: HashMap::new(),
            #[cfg(test)]
            passes: 0,
        }
    }

    /// The box around all vertices.
    fn bounds(&mut self) -> [DVec3; 2] {
        let scene = self.scene;
        let mut bounds = vertices(&scene.objects).fold(NOWHERE, joined);
        let instances = scene.instances.iter();
        let placed = instances.map(|it| (it.part, it.placement.affine()));
        let placed: Vec<_> = placed
            .filter(|&(part, _)| self.boxes[part][0].x <= self.boxes[part][1].x)
            .collect();
        // Those that lead farthest come first; few others reach beyond them.
        for axis in 0..3 {
            let ends = |it: &&(usize, DAffine3)| self.outer(it.0, &it.1, axis);
            let lowest = placed
                .iter()
                .min_by(|a, b| ends(a)[0].total_cmp(&ends(b)[0]));
            let highest = placed
                .iter()
                .max_by(|a, b| ends(a)[1].total_cmp(&ends(b)[1]));
            for (part, affine) in [lowest, highest].into_iter().flatten() {
                self.widen(&mut bounds, *part, affine);
            }
        }
        for (part, affine) in &placed {
            self.widen(&mut bounds, *part, affine);
        }
        bounds
    }

    /// A range that holds a coordinate of a placed part.
    fn outer(&self, part: usize, affine: &DAffine3, axis: usize) -> [f64; 2] {
        let [low, high] = self.boxes[part];
        let row = affine.matrix3.row(axis);
        let middle = row.dot(low.midpoint(high)) + affine.translation[axis];
        let reach = row.abs().dot((high - low) * 0.5);
        let slack =
            SLACK * (row.abs().dot(low.abs().max(high.abs())) + affine.translation[axis].abs());
        [middle - reach - slack, middle + reach + slack]
    }

    /// Widens a box by a placed part.
    fn widen(&mut self, [low, high]: &mut [DVec3; 2], part: usize, affine: &DAffine3) {
        for axis in 0..3 {
            let [from, to] = self.outer(part, affine, axis);
            if low[axis] <= from && to <= high[axis] {
                continue;
            }
            let [from, to] = self.range(part, affine.matrix3.row(axis));
            let shift = affine.translation[axis];
            low[axis] = low[axis].min(from + shift);
            high[axis] = high[axis].max(to + shift);
        }
    }

    /// The range of the vertices of a part along a row.
    fn range(&mut self, part: usize, row: DVec3) -> [f64; 2] {
        let key = (part, row.to_array().map(f64::to_bits));
        if let Some(known) = self.ranges.get(&key) {
            return *known;
        }
        #[cfg(test)]
        {
            self.passes += 1;
        }
        let along = vertices(&self.scene.parts[part].objects)
            .map(|it| row.x * it.x + row.y * it.y + row.z * it.z);
        let range = along.fold([f64::INFINITY, f64::NEG_INFINITY], |[from, to], it| {
            [from.min(it), to.max(it)]
        });
        self.ranges.insert(key, range);
        range
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::tests::chains::{Random, chain};
    use crate::scene::{Instance, Placement};
    use glam::DQuat;

    /// Instances of a mesh on a square, turned as `turn` says.
    fn square(turn: impl Fn(&mut Random) -> DQuat) -> Scene {
        let mut random = Random(5);
        let mut scene = chain(&mut random, false);
        scene.parts[0].objects[0].shape = Shape::Mesh {
            vertices: (0..200).map(|_| random.vector()).collect(),
            triangles: vec![[0, 1, 2]],
        };
        let first = scene.instances.remove(0);
        scene.instances = (0..900)
            .map(|number| Instance {
                placement: Placement {
                    rotation: turn(&mut random),
                    translation: DVec3::new(f64::from(number % 30), f64::from(number / 30), 0.0)
                        * 2.5,
                    scale: 0.75,
                },
                ..first.clone()
            })
            .collect();
        scene
    }

    fn check(scene: &Scene, most_passes: usize) {
        let mut meshes = Meshes::of(scene);
        let found = meshes.bounds();
        let placed = scene.instances.iter().flat_map(|instance| {
            let affine = instance.placement.affine();
            vertices(&scene.parts[0].objects).map(move |it| affine.transform_point3(it))
        });
        assert_eq!(found, placed.fold(NOWHERE, joined));
        assert!(meshes.passes <= most_passes, "{}", meshes.passes);
    }

    #[test]
    fn bounds_of_meshes_are_those_of_all_vertices_in_few_passes() {
        check(&square(|_| DQuat::IDENTITY), 3);
        let about_z = |random: &mut Random| DQuat::from_rotation_z(random.number());
        check(&square(about_z), 250);
        let any = |random: &mut Random| DQuat::from_vec4(random.vector().extend(0.5)).normalize();
        check(&square(any), 1200);
    }
}
