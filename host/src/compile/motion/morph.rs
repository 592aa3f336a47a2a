//! Morph targets: how far they move vertices, and their sections.

use super::room::Swept;
use crate::compile::error::CompileError;
use crate::compile::section::{Section, indices, section};
use crate::scene::{
    Attributes, Displacements, LARGEST_WEIGHT, MorphTarget, Normals, Object, Scene, Shape,
    TrackTarget,
};
use crate::shape::Lattice;
use crate::table::printable;
use glam::DVec3;
use gridel_core::format::SectionKind;
use gridel_core::format::limits;
use gridel_core::{Structure, deform};
use std::borrow::Cow;
use std::collections::HashMap;

/// Fraction bits of weights.
const WEIGHT_BITS: u32 = 24;

/// Returns whether a scene can have morph targets through these structures.
pub fn can_move(structures: &[Structure]) -> bool {
    structures.iter().all(|it| deform::STRUCTURES.contains(it))
}

/// Returns the scene with all meshes as they are at rest, and without morph targets.
///
/// ```
/// # let file = "[morph.up]\n[[object]]\nkind = 'triangle'\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n\
/// #     morph = { up = [[0, 0, 0], [0, 0, 0], [0, 0, 1]] }";
/// # let imported = gridel_host::scene::read("flag.toml".as_ref(), file.into(), &Default::default())?;
/// let still = gridel_host::compile::at_rest(&imported.scene);
/// assert!(still.morph_targets.is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn at_rest(scene: &Scene) -> Cow<'_, Scene> {
    if scene.morph_targets.is_empty() {
        return Cow::Borrowed(scene);
    }
    let mut still = scene.clone();
    let in_parts = still.parts.iter_mut().flat_map(|it| &mut it.objects);
    for object in still.objects.iter_mut().chain(in_parts) {
        object.attributes.displacements.clear();
        object.normals.changes.clear();
    }
    still.morph_targets.clear();
    still
        .tracks
        .retain(|it| it.target != TrackTarget::MorphWeight);
    Cow::Owned(still)
}

/// Returns the morph targets of a scene, each with a range that holds all weights of its track as well.
pub fn with_tracks(scene: &Scene) -> Cow<'_, [MorphTarget]> {
    let tracks = scene.tracks.iter();
    let mut tracks = tracks
        .filter(|it| it.target == TrackTarget::MorphWeight)
        .peekable();
    if tracks.peek().is_none() {
        return Cow::Borrowed(&scene.morph_targets);
    }
    let mut targets = scene.morph_targets.clone();
    for track in tracks {
        let [low, high] = &mut targets[track.index].range;
        for point in track.control_points() {
            let weight = point.x.clamp(-LARGEST_WEIGHT, LARGEST_WEIGHT);
            (*low, *high) = (low.min(weight), high.max(weight));
        }
    }
    Cow::Owned(targets)
}

/// Returns the box that a scene's own meshes sweep by morph targets.
pub fn swept(scene: &Scene) -> Swept {
    let targets = with_tracks(scene);
    let ways: Vec<[f64; 2]> = targets.iter().map(way).collect();
    let largest = |[low, high]: &[f64; 2]| high.max(-low);
    let boxes = scene.objects.iter().filter_map(|it| around(it, &ways));
    let mut swept = Swept {
        // Half a step for each displacement and for the sum; a step is a unit at most.
        rounding: 1.0 + ways.iter().map(largest).sum::<f64>() / 2.0,
        ..Swept::default()
    };
    boxes.for_each(|corners| swept.add(corners));
    swept
}

/// The least and the greatest difference of a weight from that at rest.
fn way(target: &MorphTarget) -> [f64; 2] {
    let [low, high] = target.range.map(|it| it - target.weight);
    [low.min(high).min(0.0), high.max(low).max(0.0)]
}

/// The box of all places of an object's vertices; `None` if they do not move.
fn around(object: &Object, ways: &[[f64; 2]]) -> Option<[DVec3; 2]> {
    let Shape::Mesh { vertices, .. } = &object.shape else {
        return None;
    };
    let displacements = &object.attributes.displacements;
    if displacements.is_empty() {
        return None;
    }
    let mut corners = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    for (number, &vertex) in vertices.iter().enumerate() {
        let (mut low, mut high) = (vertex, vertex);
        for Displacements { target, vectors } in displacements {
            let [least, greatest] = ways[*target].map(|way| vectors[number] * way);
            low += least.min(greatest);
            high += least.max(greatest);
        }
        corners = [corners[0].min(low), corners[1].max(high)];
    }
    (corners[0].x <= corners[1].x).then_some(corners)
}

/// The effect of a morph target on a vertex: the target's number, the displacement in steps of the storage, and the
/// change of the normal on its octahedron, halved.
type Step = (u32, [i32; 3], [i16; 3]);

/// The different motions of vertices.
#[derive(Debug)]
pub struct Motions {
    numbers: HashMap<Vec<Step>, u32>,
    /// The first is that of vertices that stay.
    all: Vec<Vec<Step>>,
}

impl Default for Motions {
    fn default() -> Self {
        Self {
            numbers: HashMap::from([(Vec::new(), 0)]),
            all: vec![Vec::new()],
        }
    }
}

impl Motions {
    /// Returns the motions of the corners of a mesh's triangles; none where nothing moves.
    pub fn of(
        &mut self,
        object: &Object,
        triangles: &[[u32; 3]],
        lattice: &Lattice,
        targets: &[MorphTarget],
    ) -> Result<Vec<[u32; 3]>, CompileError> {
        let Attributes { displacements, .. } = &object.attributes;
        let normals = &object.normals;
        if displacements.is_empty() && normals.changes.is_empty() {
            return Ok(Vec::new());
        }
        // By vertex and normal.
        let mut known: HashMap<[u32; 2], u32> = HashMap::new();
        let mut motions = Vec::with_capacity(triangles.len());
        for (number, triangle) in triangles.iter().enumerate() {
            let corners = normals.triangles.get(number).unwrap_or(&Normals::FLAT);
            let mut motion = [0; 3];
            for (place, motion) in motion.iter_mut().enumerate() {
                let [vertex, normal] = [triangle[place], corners[place]];
                *motion = match known.get(&[vertex, normal]) {
                    Some(motion) => *motion,
                    None => {
                        let mut steps = displaced(displacements, vertex, lattice, targets)?;
                        for (target, change) in changed(normals, normal) {
                            step_of(&mut steps, target).2 = change;
                        }
                        let motion = self.number(steps);
                        known.insert([vertex, normal], motion);
                        motion
                    }
                };
            }
            motions.push(motion);
        }
        Ok(motions)
    }

    /// Returns whether two vertices that are at one place at rest stay together.
    pub fn stay_together(&self, one: u32, other: u32) -> bool {
        let [one, other] = [one, other].map(|motion| {
            let steps = self.all[motion as usize].iter();
            // Others change normals alone.
            steps
                .filter(|step| step.1 != [0; 3])
                .map(|step| (step.0, step.1))
        });
        one.eq(other)
    }

    /// Returns for each morph target how a weight of 1 moves the second and the third of three vertices more than the
    /// first, in steps of the storage.
    pub fn differences(&self, motions: [u32; 3]) -> impl Iterator<Item = [DVec3; 2]> {
        let steps = motions.map(|motion| &self.all[motion as usize]);
        let mut targets: Vec<u32> = steps
            .iter()
            .flat_map(|it| it.iter().map(|step| step.0))
            .collect();
        targets.sort_unstable();
        targets.dedup();
        targets.into_iter().map(move |target| {
            let [first, second, third] = steps.map(|steps| {
                let step = steps.iter().find(|step| step.0 == target);
                step.map_or(DVec3::ZERO, |step| step.1.map(f64::from).into())
            });
            [second - first, third - first]
        })
    }

    /// The number of a motion.
    fn number(&mut self, steps: Vec<Step>) -> u32 {
        let next = self.all.len() as u32;
        *self.numbers.entry(steps).or_insert_with_key(|steps| {
            self.all.push(steps.clone());
            next
        })
    }

    /// Returns the sections of vertices, given the motion of each.
    pub fn sections(&self, motions: &[u32]) -> Vec<Section> {
        let (mut vertices, mut targets) = (Vec::new(), Vec::new());
        let (mut long, mut normals) = (Vec::new(), Vec::new());
        for (&motion, vertex) in motions.iter().zip(0..) {
            for &(target, step, normal) in &self.all[motion as usize] {
                vertices.push(vertex);
                targets.push(target);
                long.push(step);
                normals.push(normal);
            }
        }
        if vertices.is_empty() {
            return Vec::new();
        }
        let short = |step: &[i32; 3]| {
            let [x, y, z] = step.map(i16::try_from);
            Some([x.ok()?, y.ok()?, z.ok()?])
        };
        let narrow: Option<Vec<[i16; 3]>> = long.iter().map(short).collect();
        let mut sections = vec![
            indices(SectionKind::MorphVertices, &vertices, 1),
            indices(SectionKind::MorphNumbers, &targets, 1),
            match narrow {
                Some(narrow) => section(SectionKind::Displacements, &narrow),
                None => section(SectionKind::Displacements, &long),
            },
        ];
        if normals.iter().any(|it| *it != [0; 3]) {
            sections.push(section(SectionKind::NormalChanges, &normals));
        }
        sections
    }
}

/// Returns the step of a morph target, which is inserted if it is missing. Steps are in the order of morph targets.
fn step_of(steps: &mut Vec<Step>, target: u32) -> &mut Step {
    let place = steps.partition_point(|it| it.0 < target);
    if steps.get(place).is_none_or(|it| it.0 != target) {
        steps.insert(place, (target, [0; 3], [0; 3]));
    }
    &mut steps[place]
}

/// Returns the displacements of a vertex by morph targets.
fn displaced(
    displacements: &[Displacements],
    vertex: u32,
    lattice: &Lattice,
    targets: &[MorphTarget],
) -> Result<Vec<Step>, CompileError> {
    let steps_of_unit = if lattice.bits <= 16 { 1.0 } else { 256.0 };
    let factor = steps_of_unit / lattice.unit();
    let most = f64::from(limits::LARGEST_DISPLACEMENT);
    let mut steps = Vec::new();
    for Displacements { target, vectors } in displacements {
        let step = (vectors[vertex as usize] * factor).round();
        if step.is_nan() || step.abs().max_element() > most {
            return Err(CompileError::Displacement {
                target: printable(&targets[*target].name),
                most: most / factor,
            });
        }
        if step != DVec3::ZERO {
            let step = step.to_array().map(|it| it as i32);
            step_of(&mut steps, *target as u32).1 = step;
        }
    }
    Ok(steps)
}

/// Returns the changes of a normal by morph targets on its octahedron, halved. A change that would leave the range is
/// shortened.
fn changed(normals: &Normals, number: u32) -> impl Iterator<Item = (u32, [i16; 3])> {
    let most = f64::from(i16::MAX);
    let normal = normals.vectors.get(number as usize);
    normal.into_iter().flat_map(move |normal| {
        let factor = most / 2.0 / normal.abs().element_sum();
        normals.changes.iter().filter_map(move |it| {
            let change = it.vectors[number as usize] * factor;
            let beyond = (change.abs().max_element() / most).max(1.0);
            let change = (change / beyond).round().to_array().map(|it| it as i16);
            (change != [0; 3]).then_some((it.target as u32, change))
        })
    })
}

/// Returns the section of the weights at rest.
pub fn weights(scene: &Scene) -> Section {
    let weights = scene.morph_targets.iter();
    let weights: Vec<i32> = weights
        .map(|it| (it.weight * f64::from(1 << WEIGHT_BITS)).round() as i32)
        .collect();
    section(SectionKind::MorphWeights, &weights)
}
