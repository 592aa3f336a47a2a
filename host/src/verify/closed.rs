//! Finds the closed meshes of a scene, whose inside no ray can leave unseen.

use super::rounded::HitId;
use crate::shape::ExactMap;
use gridel_core::{Hit, Kind, Number, Scene};
use std::collections::HashMap;
use std::fmt;
use std::sync::Arc;

/// A mesh whose every edge belongs to two triangles with opposite directions along it.
#[derive(Clone, Debug)]
pub struct ClosedMesh {
    pub object: u32,
    /// Its instance, if it is placed by one.
    instance: Option<MeshInstance>,
    /// In units of the blob or the part that holds it.
    triangles: Arc<Vec<[[f64; 3]; 3]>>,
}

/// The instance of a closed mesh.
#[derive(Clone, Debug)]
struct MeshInstance {
    index: u32,
    /// The instance's number in scene-file order.
    number: u32,
    map: ExactMap,
}

/// Most meshes that rays are aimed from, of the scene's own and of placed ones each; where there are more, every few of
/// them. Brute force looks for a point inside of each, so its time grows with the square of their number.
const MOST: usize = 64;

impl ClosedMesh {
    /// Returns closed meshes of a scene, as they lie on its lattice: some of the scene's own, and some of instances.
    /// Returns the number of all, too.
    pub fn all(scene: &Scene<'_>) -> (Vec<Self>, usize) {
        let own = of_objects(scene, |primitive| scene.object(primitive));
        let of_parts: Vec<Vec<Self>> = (0..)
            .zip(scene.parts())
            .map(|(number, part)| {
                let first = scene.first_primitive_of_part(number).unwrap_or(0);
                of_objects(part, |primitive| scene.object(first + primitive))
            })
            .collect();
        let placed = (0..).zip(scene.instances()).flat_map(|(index, instance)| {
            let meshes = of_parts.get(usize::from(instance.part));
            let meshes = meshes.into_iter().flatten();
            meshes.map(move |mesh| (index, instance, mesh))
        });
        let of_instances = placed.clone().count();
        let step = |count: usize| count.div_ceil(MOST).max(1);
        let count = own.len() + of_instances;
        let own_step = step(own.len());
        let mut all: Vec<Self> = own.into_iter().step_by(own_step).collect();
        let placed = placed
            .step_by(step(of_instances))
            .map(|(index, instance, mesh)| Self {
                instance: Some(MeshInstance {
                    index,
                    number: instance.number,
                    map: ExactMap::of(instance),
                }),
                ..mesh.clone()
            });
        all.extend(placed);
        (all, count)
    }

    /// Number of its triangles.
    pub fn count(&self) -> usize {
        self.triangles.len()
    }

    /// Returns the corners of a triangle, in units of the scene.
    pub fn triangle(&self, index: usize) -> [[f64; 3]; 3] {
        let corners = self.triangles[index];
        match &self.instance {
            None => corners,
            Some(placed) => corners.map(|corner| placed.map.back(corner)),
        }
    }

    /// Returns whether a hit is one of the mesh.
    pub fn holds<N: Number>(&self, hit: &Hit<N>) -> bool {
        hit.object == self.object && hit.instance() == self.index()
    }

    fn index(&self) -> Option<u32> {
        self.instance.as_ref().map(|placed| placed.index)
    }

    /// Returns its primitives, as hits name them.
    pub fn hits<'a>(&'a self, scene: &'a Scene<'_>) -> impl Iterator<Item = HitId> + 'a {
        let instances = scene.instances();
        let part = self.index().and_then(|it| instances.get(it as usize));
        let part = part.map(|instance| usize::from(instance.part));
        let first = part.and_then(|part| scene.first_primitive_of_part(part));
        let held_by = part
            .and_then(|part| scene.parts().get(part))
            .unwrap_or(scene);
        (0..held_by.count(Kind::Triangle)).filter_map(move |slot| {
            let own = held_by.primitive(Kind::Triangle, slot as u32);
            let primitive = own + first.unwrap_or(0);
            (scene.object(primitive) == self.object).then_some(HitId {
                primitive,
                instance: self.index(),
            })
        })
    }
}

impl fmt::Display for ClosedMesh {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "object {}", self.object)?;
        match &self.instance {
            Some(placed) => write!(f, " of instance {}", placed.number),
            None => Ok(()),
        }
    }
}

/// The closed meshes of a blob without its parts, by their objects.
fn of_objects(scene: &Scene<'_>, object: impl Fn(u32) -> u32) -> Vec<ClosedMesh> {
    let mut objects: HashMap<u32, Vec<[[i32; 3]; 3]>> = HashMap::new();
    for slot in 0..scene.count(Kind::Triangle) {
        let object = object(scene.primitive(Kind::Triangle, slot as u32));
        objects
            .entry(object)
            .or_default()
            .extend(scene.triangle(slot));
    }
    let units = |corners: &[[i32; 3]; 3]| corners.map(|it| it.map(|x| f64::from(x) / 256.0));
    let closed = objects
        .into_iter()
        .filter(|(_, it)| is_oriented_manifold(it));
    let mut closed: Vec<_> = closed
        .map(|(object, triangles)| ClosedMesh {
            object,
            instance: None,
            triangles: Arc::new(triangles.iter().map(units).collect()),
        })
        .collect();
    closed.sort_by_key(|mesh| mesh.object);
    closed
}

/// Returns true if every edge of some triangles belongs to two of them, with opposite directions along it.
fn is_oriented_manifold(triangles: &[[[i32; 3]; 3]]) -> bool {
    // How often triangles use each edge in one direction, and in the other.
    let mut edges: HashMap<[[i32; 3]; 2], [u32; 2]> = HashMap::new();
    for &[a, b, c] in triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let forward = from < to;
            let edge = if forward { [from, to] } else { [to, from] };
            edges.entry(edge).or_default()[usize::from(forward)] += 1;
        }
    }
    triangles.len() >= 4 && edges.values().all(|&ways| ways == [1, 1])
}
