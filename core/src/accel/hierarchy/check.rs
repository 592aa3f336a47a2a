//! The proof that a hierarchy of two children per node loses no hit, once for every kind of volume.

use crate::accel::space::Space;
use crate::format::limits::MAX_LEVELS;
use crate::format::link::Node;
use crate::format::{BlobError, Leaf, Location, Reason, SectionKind};
use heapless::Vec;

/// A way down from the root: a word per node, which is twice its number, and 1 more where the way goes
/// on with the second child.
pub(in crate::accel) type Path = [u32];

/// A hierarchy of two children per node, as [`check_tree`] sees it.
pub(in crate::accel) trait Tree: Copy {
    /// The section of its nodes.
    const SECTION: SectionKind;
    /// What is wrong where [`Self::holds`] is false.
    const OUTSIDE: Reason = Reason::PrimitiveOutside;
    /// What holds all that is below a node.
    type Volume: Copy;

    /// Proves that nodes lie in breadth-first order and reach so many leaves. Returns the number of
    /// levels of nodes that have children.
    fn order(self, leaves: usize) -> Result<usize, BlobError>;

    /// The first node.
    fn root(self) -> Node;

    /// The number of the leaf that a node is; `None` for a node with children.
    fn leaf(self, node: Node) -> Option<u32>;

    /// The first (0) or the second (1) child of a node that has children.
    fn child(self, number: u32, side: u32) -> Node;

    /// The volumes of the children, given their parent's.
    fn volumes(self, number: u32, parent: &Self::Volume) -> [Self::Volume; 2];

    /// Whether a child's volume lies in its parent's, where a walk relies on that.
    fn nests(self, _child: &Self::Volume, _parent: &Self::Volume) -> bool {
        true
    }

    /// Whether the volumes that lead to the leaf that a node is hold its primitives.
    fn holds(
        self,
        space: &Space<'_>,
        leaf: Leaf,
        node: Node,
        volume: &Self::Volume,
        path: &Path,
    ) -> bool;
}

/// Proves a hierarchy: nodes in breadth-first order, so that children come after their parents and
/// every node and every leaf is reached once; volumes inside their parents'; primitives inside the
/// volumes that lead to them. Returns the stack that a walk needs.
///
/// Costs the depth of each leaf, because volumes on the way are computed again, which takes less room
/// than to keep them: [`MAX_LEVELS`] words of stack.
#[inline(never)]
pub(in crate::accel) fn check_tree<T: Tree>(
    tree: T,
    space: &Space<'_>,
    root: &T::Volume,
) -> Result<usize, BlobError> {
    let depth = tree.order(space.leaves.len())?;
    if space.leaves.is_empty() {
        return Ok(depth);
    }
    let mut path: Vec<u32, MAX_LEVELS> = Vec::new();
    let (mut node, mut volume) = (tree.root(), *root);
    loop {
        let number = node.number();
        let Some(leaf) = tree.leaf(node) else {
            let children = tree.volumes(number, &volume);
            for (child, reason) in children
                .iter()
                .zip([Reason::LeftOutside, Reason::RightOutside])
            {
                if !tree.nests(child, &volume) {
                    return Err(Location::Record(T::SECTION, number as usize).invalid(reason));
                }
            }
            // The depth was proved to fit.
            let _ = path.push(number << 1);
            (node, volume) = (tree.child(number, 0), children[0]);
            continue;
        };
        let leaf = space.leaf(leaf);
        if !leaf.is_some_and(|leaf| tree.holds(space, leaf, node, &volume, &path)) {
            // Leaves of pairs have no record of their own.
            let parent = path.last().map(|step| step >> 1);
            let record = if node.is_leaf() { parent } else { Some(number) };
            let location = match record {
                Some(record) => Location::Record(T::SECTION, record as usize),
                None => Location::Section(T::SECTION),
            };
            return Err(location.invalid(T::OUTSIDE));
        }
        while path.last().is_some_and(|step| step & 1 == 1) {
            path.pop();
        }
        let Some(step) = path.last_mut() else {
            return Ok(depth);
        };
        *step |= 1;
        node = tree.child(*step >> 1, 1);
        volume = *root;
        for &step in &path {
            let [first, second] = tree.volumes(step >> 1, &volume);
            volume = if step & 1 == 0 { first } else { second };
        }
    }
}
