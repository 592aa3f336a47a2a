//! The meshes that become parts, and their triangles.

use crate::scene::Placement;
use glam::{DMat3, DMat4};
use gltf::mesh::Mode;
use gltf::{Node, Primitive, Semantic};
use std::collections::HashMap;

/// The triangles that a part must save. A part has a structure of its own, and an instance a record.
const LEAST_SAVED: u64 = 1024;

/// A node with a mesh, and its transform in the scene.
pub(super) type MeshNode<'d> = (Node<'d>, DMat4);

/// The meshes that become parts, by their number in the file.
#[derive(Default)]
pub(super) struct Shared {
    /// The part of each; `None` for a mesh without triangles.
    pub(super) parts: HashMap<usize, Option<usize>>,
    /// The placements of the nodes of these meshes, by the number of the node.
    pub(super) placements: HashMap<usize, Placement>,
}

impl Shared {
    /// Chooses the meshes that at least two nodes place by a rotation, a translation and one scale, and those of nodes
    /// that `moves`.
    pub(super) fn of(placed: &[MeshNode<'_>], moves: impl Fn(&Node<'_>) -> bool) -> Self {
        let mut uses: HashMap<usize, Vec<(usize, Placement)>> = HashMap::new();
        let mut saved: HashMap<usize, u64> = HashMap::new();
        // Summed once for each mesh, which many nodes may share.
        let mut triangles: HashMap<usize, u64> = HashMap::new();
        let mut moving = Vec::new();
        for (node, world) in placed {
            let Some(mesh) = node.mesh().filter(|_| node.skin().is_none()) else {
                continue;
            };
            let matrix = DMat3::from_mat4(*world);
            let placement = Placement::from_affine(matrix, world.w_axis.truncate());
            let Some(placement) = placement else {
                continue;
            };
            if moves(node) {
                moving.push((node.index(), placement));
                continue;
            }
            let uses = uses.entry(mesh.index()).or_default();
            if !uses.is_empty() {
                let triangles = triangles.entry(mesh.index());
                let triangles = triangles
                    .or_insert_with(|| mesh.primitives().map(|it| triangle_count(&it)).sum());
                let saved = saved.entry(mesh.index()).or_default();
                *saved = saved.saturating_add(*triangles);
            }
            uses.push((node.index(), placement));
        }
        uses.retain(|mesh, _| saved.get(mesh).is_some_and(|it| *it >= LEAST_SAVED));
        Self {
            parts: HashMap::new(),
            placements: uses.into_values().flatten().chain(moving).collect(),
        }
    }
}

/// Returns how many corners a part of a mesh has, as its accessors say.
pub(super) fn corner_count(part: &Primitive<'_>) -> usize {
    let vertices = part.get(&Semantic::Positions).map_or(0, |it| it.count());
    part.indices().map_or(vertices, |it| it.count())
}

/// Returns how many of the corners make whole triangles. Those of points and lines all count.
pub(super) fn corners_used(mode: Mode, corners: usize) -> usize {
    match mode {
        Mode::Triangles => corners - corners % 3,
        Mode::TriangleStrip | Mode::TriangleFan if corners < 3 => 0,
        _ => corners,
    }
}

/// Returns how many triangles a part of a mesh has, as its accessors say.
pub(super) fn triangle_count(part: &Primitive<'_>) -> u64 {
    let corners = corner_count(part);
    let count = match part.mode() {
        Mode::Triangles => corners / 3,
        Mode::TriangleStrip | Mode::TriangleFan => corners.saturating_sub(2),
        _ => 0,
    };
    count as u64
}

/// Returns the triangles of the corners, counter-clockwise in front.
pub(super) fn triangles(mode: Mode, corners: &[u32], mirrored: bool) -> Vec<[u32; 3]> {
    let turned = |[a, b, c]: [u32; 3], turn: bool| if turn { [a, c, b] } else { [a, b, c] };
    match (mode, corners) {
        (Mode::TriangleStrip, _) => corners
            .windows(3)
            .enumerate()
            .map(|(number, c)| turned([c[0], c[1], c[2]], mirrored != (number % 2 == 1)))
            .collect(),
        (Mode::TriangleFan, [hub, rim @ ..]) => rim
            .windows(2)
            .map(|c| turned([*hub, c[0], c[1]], mirrored))
            .collect(),
        _ => corners
            .chunks_exact(3)
            .map(|c| turned([c[0], c[1], c[2]], mirrored))
            .collect(),
    }
}
