//! Meshes that several nodes place: parts and instances, where that saves enough.

use super::check::MOST_ELEMENTS;
use super::place::{mesh_name, place_of, weights};
use super::shared::{MeshNode, triangle_count};
use super::{Importer, Named};
use crate::scene::size::Size;
use crate::scene::{Instance, Part, Placement, SceneError};
use glam::DMat4;
use gltf::mesh::Mode;
use gltf::{Mesh, Node, Semantic};
use std::collections::HashMap;

impl Importer<'_> {
    /// Places the mesh of a node as an instance, if it is a part. Returns whether it is.
    pub(super) fn instance(&mut self, node: &Node<'_>, world: &DMat4) -> Result<bool, SceneError> {
        let placement = self.shared.placements.get(&node.index()).copied();
        let Some(mesh) = node.mesh() else {
            return Ok(false);
        };
        let joint = self.joint_of.get(&node.index()).copied();
        let joint = joint.filter(|_| node.skin().is_none());
        let part = match (placement, joint) {
            (Some(_), _) if !self.has_own_shape(node) => self.shared_part(node, &mesh)?,
            // A shape of its own.
            (Some(_), _) => self.part(node, &mesh, &DMat4::IDENTITY)?,
            // Mirrored or scaled unevenly: a part that stands where it is.
            (None, Some(_)) => self.part(node, &mesh, world)?,
            (None, None) => return Ok(false),
        };
        if let Some(part) = part {
            let name = node.name().or(mesh.name());
            let name = name.map_or_else(|| format!("node {}", node.index()), str::to_owned);
            self.scene.instances.push(Instance {
                name,
                part,
                placement: placement.unwrap_or(Placement::IDENTITY),
                joint,
                place: self.place.clone(),
            });
        }
        Ok(true)
    }

    /// Returns whether a node gives its mesh a shape of its own.
    fn has_own_shape(&self, node: &Node<'_>) -> bool {
        node.weights().is_some() || self.motion.weights(node.index()).is_some()
    }

    /// The part of a node's mesh that several nodes can place; `None` for a mesh without triangles.
    fn shared_part(
        &mut self,
        node: &Node<'_>,
        mesh: &Mesh<'_>,
    ) -> Result<Option<usize>, SceneError> {
        if let Some(&part) = self.shared.parts.get(&mesh.index()) {
            return Ok(part);
        }
        let part = self.part(node, mesh, &DMat4::IDENTITY)?;
        self.shared.parts.insert(mesh.index(), part);
        Ok(part)
    }

    /// Makes a part of a node's mesh.
    fn part(
        &mut self,
        node: &Node<'_>,
        mesh: &Mesh<'_>,
        world: &DMat4,
    ) -> Result<Option<usize>, SceneError> {
        let name = mesh_name(mesh);
        let named = Named {
            mesh,
            weights: weights(node, mesh),
            moving: self.moving_targets(node, mesh),
            name: &name,
        };
        let objects = self.objects(&named, world)?;
        let part = (!objects.is_empty()).then_some(self.scene.parts.len());
        if part.is_some() {
            self.scene.parts.push(Part {
                name,
                objects,
                place: self.place.clone(),
            });
        }
        Ok(part)
    }

    /// Checks that nodes fit into memory, before anything is made of them.
    pub(super) fn weigh(&self, placed: &[MeshNode<'_>]) -> Result<(), SceneError> {
        let mut size = Size::default();
        let mut morphed = 0_usize;
        let mut listed = 0_usize;
        let mut parts = HashMap::new();
        for (node, _) in placed {
            let Some(mesh) = node.mesh() else {
                continue;
            };
            let name = node.name().or(mesh.name()).map_or(0, str::len);
            // Morph targets that move have the name, too.
            let moving = self.motion.weights(node.index()).map_or(0, <[_]>::len);
            size = size.plus(Size {
                names: (moving as u64).saturating_mul(name as u64),
                ..Size::default()
            });
            let is_instance =
                self.shared.placements.contains_key(&node.index()) && !self.has_own_shape(node);
            if is_instance && parts.insert(mesh.index(), ()).is_some() {
                size = size.plus(Size {
                    objects: 1,
                    names: name as u64,
                    triangles: 0,
                });
                self.check_size(size, node, || format!("mesh {}", mesh.index()))?;
                continue;
            }
            for part in mesh.primitives() {
                let vertices = part.get(&Semantic::Positions).map_or(0, |it| it.count());
                let triangles = triangle_count(&part);
                let is_drawn = matches!(
                    part.mode(),
                    Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan
                );
                // Points and lines take no memory. They count, because each takes time at each node.
                size = size.plus(match is_drawn {
                    true => Size {
                        objects: 1,
                        names: name as u64,
                        triangles: triangles.max((vertices / 3) as u64),
                    },
                    false => Size {
                        objects: 1,
                        ..Size::default()
                    },
                });
                self.check_size(size, node, || place_of(&mesh, &part))?;
                if !is_drawn {
                    continue;
                }
                // Targets may share one accessor, which may take no bytes.
                let weights = weights(node, &mesh);
                let targets = part.morph_targets().zip(weights);
                listed = listed.saturating_add(targets.len());
                let used = targets.filter(|(_, weight)| **weight != 0.0).count();
                morphed = morphed.saturating_add(vertices.saturating_mul(used));
                if morphed.max(listed) > MOST_ELEMENTS {
                    let what = match morphed > MOST_ELEMENTS {
                        true => format!("morph targets move more than {MOST_ELEMENTS} vertices"),
                        false => format!("nodes have more than {MOST_ELEMENTS} morph targets"),
                    };
                    return Err(self.error(
                        format!("up to {}, {what}", place_of(&mesh, &part)),
                        "export fewer morph targets, or coarser meshes",
                    ));
                }
            }
        }
        Ok(())
    }

    fn check_size(
        &self,
        size: Size,
        node: &Node<'_>,
        place: impl Fn() -> String,
    ) -> Result<(), SceneError> {
        match size.excess() {
            None => Ok(()),
            Some(excess) => Err(self.error(
                format!(
                    "up to node {}, {}, instances counted, the file takes {excess}",
                    node.index(),
                    place()
                ),
                "export a part of the scene, or coarser meshes",
            )),
        }
    }
}
