//! The traversal stack.

use crate::format::limits::MAX_STACK_DEPTH;
use crate::observe::count::Observer;
use crate::observe::event::{Event, NodeId};
use heapless::{Vec, VecView};

/// A child that waits to be visited: 12 bytes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Entry {
    pub(in crate::accel) node: u32,
    pub(in crate::accel) near: i32,
    pub(in crate::accel) far: i32,
}

/// The traversal stack, owned by the caller: 12 bytes per entry and one word.
///
/// `DEPTH` must be at least the blob's [`stack_depth`](crate::Scene::stack_depth), which
/// [`Scene::from_bytes`](crate::Scene::from_bytes) proves. A smaller stack is never overrun,
/// but queries on it miss what they find no room for: compare [`capacity`](StackView) with the depth, or let
/// [`Renderer::check_workspace`](crate::Renderer::check_workspace) reject it.
#[derive(Debug, Default)]
pub struct Stack<const DEPTH: usize>(Vec<Entry, DEPTH>);

impl Stack<MAX_STACK_DEPTH> {
    /// Returns an empty stack that is deep enough for every scene: 1.9 KB.
    ///
    /// ```
    /// use gridel_core::Stack;
    ///
    /// assert_eq!(Stack::for_any_scene().as_view().capacity(), 160);
    /// ```
    pub const fn for_any_scene() -> Self {
        Self::new()
    }
}

/// A [`Stack`] whose depth is not part of its type.
pub type StackView = VecView<Entry>;

impl<const DEPTH: usize> Stack<DEPTH> {
    /// Returns an empty stack.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// let scene = gridel_core::Scene::from_bytes(BLOB)?;
    /// let mut stack = gridel_core::Stack::<32>::new();
    /// assert!(stack.as_view().capacity() >= scene.stack_depth());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub const fn new() -> Self {
        Self(Vec::new())
    }

    /// Returns the stack in the form that queries use.
    pub fn as_view(&mut self) -> &mut StackView {
        &mut self.0
    }
}

/// Returns the next waiting child that the ray enters before the limit. Children that are skipped are reported:
/// `report` gets a child's name, and where the ray enters it, in units.
#[inline(always)]
pub(in crate::accel) fn pop<C: Observer>(
    stack: &mut StackView,
    limit: i32,
    count: &mut C,
    report: impl Fn(&Entry) -> (NodeId, f64),
) -> Option<Entry> {
    loop {
        let entry = stack.pop()?;
        if entry.near <= limit {
            return Some(entry);
        }
        if C::ENABLED {
            let (node, enters) = report(&entry);
            count.event(Event::NodeSkipped { node, enters });
        }
    }
}
