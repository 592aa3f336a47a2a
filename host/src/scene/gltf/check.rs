//! Checks of a whole glTF file, whether its parts are drawn or not.

use super::Importer;
use super::buffers::MOST;
use super::place::place_of;
use super::shared::{corner_count, corners_used};
use crate::scene::SceneError;
use crate::table::counted;
use gltf::{Accessor, Document, Node, Semantic};
use std::collections::{HashMap, HashSet};

/// Most elements of all accessors together: some for each vertex and triangle.
pub(super) const MOST_ELEMENTS: usize = 16 * MOST;

/// Returns whether the elements of an accessor are in the file, and not all zero.
fn is_stored(accessor: &Accessor<'_>) -> bool {
    accessor.view().is_some() || accessor.sparse().is_some()
}

impl Importer<'_> {
    /// Validates the whole file, also the parts that are not drawn: nodes form trees, and meshes
    /// use vertices that they have.
    pub(super) fn check(&mut self, document: &Document) -> Result<(), SceneError> {
        self.check_trees(document)?;
        self.check_elements(document)?;
        self.check_corners(document)?;
        self.check_transforms(document);
        self.check_targets(document);
        self.check_triangles(document);
        self.check_numbers(document)
    }

    /// Checks that no node is inside of two others or of itself, and that scenes list nodes without a parent.
    fn check_trees(&self, document: &Document) -> Result<(), SceneError> {
        let count = document.nodes().len();
        let mut parent = vec![None; count];
        for node in document.nodes() {
            for child in node.children() {
                if parent[child.index()].replace(node.index()).is_some() {
                    return Err(self.error(
                        format!("node {} is inside of two nodes", child.index()),
                        "give every node one parent at most",
                    ));
                }
            }
        }
        // From those that are inside of none, every node is reached that is not inside of itself.
        let mut open: Vec<Node<'_>> = document
            .nodes()
            .filter(|node| parent[node.index()].is_none())
            .collect();
        let mut reached = vec![false; count];
        while let Some(node) = open.pop() {
            reached[node.index()] = true;
            open.extend(node.children());
        }
        if let Some(node) = reached.iter().position(|reached| !reached) {
            return Err(self.error(
                format!("node {node} is inside of itself"),
                "give every node one parent at most, and no circle",
            ));
        }
        for scene in document.scenes() {
            let above = |node: &Node<'_>| parent[node.index()];
            if let Some((node, above)) =
                scene.nodes().find_map(|it| Some((it.index(), above(&it)?)))
            {
                return Err(self.error(
                    format!(
                        "scene {} lists node {node}, which is inside of node {above}",
                        scene.index()
                    ),
                    "list only nodes that have no parent",
                ));
            }
        }
        Ok(())
    }

    /// Limits the elements of accessors. They may share their bytes, so that a short file can cause any amount of work.
    fn check_elements(&self, document: &Document) -> Result<(), SceneError> {
        let elements = document
            .accessors()
            .filter(is_stored)
            .map(|it| it.count().min(MOST));
        if elements.fold(0, usize::saturating_add) > MOST_ELEMENTS {
            return Err(self.error(
                format!("the accessors of the file have more than {MOST_ELEMENTS} elements"),
                "export a part of the scene",
            ));
        }
        Ok(())
    }

    /// Checks that meshes use vertices that they have.
    fn check_corners(&mut self, document: &Document) -> Result<(), SceneError> {
        let mut highest: HashMap<usize, Option<u32>> = HashMap::new();
        for mesh in document.meshes() {
            for part in mesh.primitives() {
                let (Some(positions), Some(indices)) =
                    (part.get(&Semantic::Positions), part.indices())
                else {
                    continue;
                };
                let highest = match highest.get(&indices.index()) {
                    Some(&known) => known,
                    None => {
                        let found = self.buffers.indices(&indices)?.into_iter().max();
                        highest.insert(indices.index(), found);
                        found
                    }
                };
                if let Some(highest) = highest {
                    self.check_corner(&place_of(&mesh, &part), highest, positions.count())?;
                }
            }
        }
        Ok(())
    }

    /// Warns of numbers that are not finite.
    fn check_numbers(&mut self, document: &Document) -> Result<(), SceneError> {
        let parts = document.meshes().flat_map(|mesh| mesh.primitives());
        let uses = parts.flat_map(|part| {
            let attributes = part.attributes();
            attributes
                .map(|(semantic, it)| (it.index(), semantic))
                .collect::<Vec<_>>()
        });
        let uses: HashMap<usize, Semantic> = uses.collect();
        let parts = document.meshes().flat_map(|mesh| mesh.primitives());
        let changes = parts.flat_map(|part| {
            let targets = part.morph_targets().filter_map(|it| it.normals());
            targets.map(|it| it.index()).collect::<Vec<_>>()
        });
        let changes: HashSet<usize> = changes.collect();
        for accessor in document.accessors().filter(is_stored) {
            if let Some(element) = self.buffers.first_not_finite(&accessor)? {
                let index = accessor.index();
                let follows = match changes.contains(&index) {
                    true => "such a change of a normal is left out",
                    false => without_number(uses.get(&index)),
                };
                self.warn(format!(
                    "element {element} of accessor {index} is not a finite number; {follows}"
                ));
            }
        }
        Ok(())
    }

    /// Warns of nodes with two transforms.
    fn check_transforms(&mut self, document: &Document) {
        let nodes = || document.as_json().nodes.iter();
        let has_two = |node: &&gltf::json::Node| {
            let other =
                node.translation.is_some() || node.rotation.is_some() || node.scale.is_some();
            node.matrix.is_some() && other
        };
        if let Some(first) = nodes().position(|node| has_two(&node)) {
            let sentence = format!(
                "node {first} has a matrix, and a translation, a rotation or a scale, too; the matrix is used"
            );
            self.warn_of(nodes().filter(has_two).count(), sentence);
        }
    }

    /// Warns of corners that do not make whole triangles, which glTF does not allow.
    fn check_triangles(&mut self, document: &Document) {
        let mut first = None;
        let mut count = 0;
        for mesh in document.meshes() {
            for part in mesh.primitives() {
                let corners = corner_count(&part);
                let whole = corners_used(part.mode(), corners);
                if whole < corners {
                    count += 1;
                    first.get_or_insert_with(|| {
                        let left = corners - whole;
                        format!(
                            "{} has {}, of which {left} make no whole triangle and are left out",
                            place_of(&mesh, &part),
                            counted(corners, "corner")
                        )
                    });
                }
            }
        }
        if let Some(sentence) = first {
            self.warn_of(count, sentence);
        }
    }

    /// Warns of morph targets and weights that do not belong together.
    fn check_targets(&mut self, document: &Document) {
        let mut targets = Vec::with_capacity(document.meshes().len());
        let mut weights = Vec::new();
        for mesh in document.meshes() {
            let counts = mesh.primitives().map(|it| it.morph_targets().len());
            let (least, most) = counts.fold((usize::MAX, 0), |(least, most), count| {
                (least.min(count), most.max(count))
            });
            let number = mesh.index();
            if least < most {
                self.warn(format!(
                    "the primitives of mesh {number} have {least} to {most} morph targets; some have fewer than others"
                ));
            }
            targets.push(most);
            let own = mesh
                .weights()
                .map(|it| (number, String::from("it"), it.len()));
            weights.extend(own);
        }
        for node in document.nodes() {
            if let (Some(mesh), Some(own)) = (node.mesh(), node.weights()) {
                let owner = format!("node {}", node.index());
                weights.push((mesh.index(), owner, own.len()));
            }
        }
        for (mesh, owner, found) in weights {
            let expected = targets[mesh];
            if found != expected {
                self.warn(format!(
                    "mesh {mesh} has {expected} morph targets, and {owner} has {found} weights; missing weights are 0, \
                     others are left out"
                ));
            }
        }
    }

    pub(super) fn check_corner(
        &self,
        place: &str,
        corner: u32,
        vertices: usize,
    ) -> Result<(), SceneError> {
        if (corner as usize) < vertices {
            return Ok(());
        }
        Err(self.error(
            format!("{place} uses vertex {corner}, and it has {vertices} vertices"),
            "export the file again; vertices count from 0",
        ))
    }
}

/// Returns the consequence of a number of an attribute that is not finite, as part of a sentence.
fn without_number(semantic: Option<&Semantic>) -> &'static str {
    match semantic {
        Some(Semantic::Normals) => "triangles with such a normal are shaded flat",
        Some(Semantic::Colors(0)) => "such a channel of a color is 0",
        Some(Semantic::TexCoords(_)) => "such a texture coordinate is 0",
        _ => "nothing that is drawn uses it",
    }
}
