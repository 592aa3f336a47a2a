//! The proof that a hierarchy of two children per node loses no hit, once for every kind of volume.

use crate::accel::scene_geometry::SceneGeometry;
use crate::format::limits::MAX_LEVELS;
use crate::format::link::Node;
use crate::format::{BlobError, Leaf, Location, Reason, SectionKind};
use heapless::Vec;

/// A way down from the root: a word per node. The word is twice the node's number, plus 1 if the way continues with the
/// second child.
pub(in crate::accel) type Path = [u32];

/// A hierarchy of two children per node, in the form that [`check_tree`] reads.
pub(in crate::accel) trait Tree: Copy {
    /// The section of its nodes.
    const SECTION: SectionKind;
    /// The error where [`Self::contains_leaf`] is false.
    const OUTSIDE: Reason = Reason::PrimitiveOutside;
    /// The volume around everything below a node.
    type Volume: Copy;

    /// Proves that nodes lie in breadth-first order and reach this many leaves. Returns the number of levels of nodes
    /// that have children.
    fn order(self, leaves: usize) -> Result<usize, BlobError>;

    /// The first node.
    fn root(self) -> Node;

    /// Returns the number of the leaf if a node is a leaf; `None` for a node with children.
    fn leaf(self, node: Node) -> Option<u32>;

    /// The first (0) or the second (1) child of a node that has children.
    fn child(self, number: u32, side: u32) -> Node;

    /// Turns the volume of a node that has children into that of one of them, in place, because boards copy volumes by
    /// a call.
    fn enter_child(self, number: u32, side: u32, volume: &mut Self::Volume);

    /// Proves that the volumes of both children lie in their parent's, where a walk relies on that.
    #[inline(always)]
    fn children_inside(self, _number: u32, _parent: &Self::Volume) -> Result<(), Reason> {
        Ok(())
    }

    /// Returns true if the volumes above a leaf hold its primitives.
    fn contains_leaf(
        self,
        geometry: &SceneGeometry<'_>,
        leaf: Leaf,
        node: Node,
        volume: &Self::Volume,
        path: &Path,
    ) -> bool;
}

/// Proves a hierarchy, and returns the stack that a walk needs. Nodes lie in breadth-first order, so children come
/// after their parents, and every node and every leaf is reached once. Volumes lie inside their parents', and
/// primitives inside all volumes above them.
///
/// The cost grows with the depth of each leaf, because volumes on the way are computed again. That uses less memory
/// than to store them: [`MAX_LEVELS`] words of stack.
#[inline(never)]
pub(in crate::accel) fn check_tree<T: Tree>(
    tree: T,
    geometry: &SceneGeometry<'_>,
    root: &T::Volume,
) -> Result<usize, BlobError> {
    let depth = tree.order(geometry.leaves.len())?;
    if geometry.leaves.is_empty() {
        return Ok(depth);
    }
    let mut path: Vec<u32, MAX_LEVELS> = Vec::new();
    let (mut node, mut volume) = (tree.root(), *root);
    loop {
        match tree.leaf(node) {
            None => {
                let number = node.number();
                if let Err(reason) = tree.children_inside(number, &volume) {
                    return Err(Location::Record(T::SECTION, number as usize).invalid(reason));
                }
                // The depth was proved to be in range.
                let _ = path.push(number << 1);
            }
            Some(leaf) => {
                let leaf = geometry.leaf(leaf);
                if !leaf
                    .is_some_and(|leaf| tree.contains_leaf(geometry, leaf, node, &volume, &path))
                {
                    return Err(outside::<T>(node, &path));
                }
                while path.last().is_some_and(|step| step & 1 == 1) {
                    path.pop();
                }
                let Some((step, above)) = path.split_last_mut() else {
                    return Ok(depth);
                };
                *step |= 1;
                volume = *root;
                for &mut step in above {
                    tree.enter_child(step >> 1, step & 1, &mut volume);
                }
            }
        }
        // Down to the child on the way.
        let Some(&step) = path.last() else {
            return Ok(depth);
        };
        let (number, side) = (step >> 1, step & 1);
        tree.enter_child(number, side, &mut volume);
        node = tree.child(number, side);
    }
}

/// The error of a leaf with a primitive outside of its volume.
#[cold]
#[inline(never)]
fn outside<T: Tree>(node: Node, path: &Path) -> BlobError {
    // Leaves of pairs have no record of their own.
    let parent = path.last().map(|step| step >> 1);
    let record = if node.is_leaf() {
        parent
    } else {
        Some(node.number())
    };
    let location = match record {
        Some(record) => Location::Record(T::SECTION, record as usize),
        None => Location::Section(T::SECTION),
    };
    location.invalid(T::OUTSIDE)
}
