//! The memory of rendering, without the pixels: a traversal stack, and the rays that wait.

use crate::accel::Number;
use crate::accel::stack::{Stack, StackView};
use crate::format::Effects;
use crate::observe::event::RayKind;
use crate::query::Hit;
use crate::scene::Scene;
use crate::shade::departure::FarPlace;
use crate::shade::effect::EffectList;
use crate::shade::{All, Color};
use heapless::{Vec, VecView};

/// The state that effects add to a ray.
pub(super) type State<N> = <All as EffectList>::State<N>;

/// A waiting ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pending<N: Number> {
    pub(super) origin: [N; 3],
    pub(super) direction: [N; 3],
    pub(super) weight: Color<N>,
    pub(super) depth: u8,
    pub(super) kind: RayKind,
    pub(super) state: State<N>,
}

/// Bytes of a waiting ray, in a build with these effects.
pub fn bytes_per_ray<N: Number>(effects: Effects) -> usize {
    let numbers = size_of::<([N; 3], [N; 3], Color<N>)>();
    let bytes = size_of::<(u8, RayKind)>().wrapping_add(All::state_bytes::<N>(effects));
    numbers
        .wrapping_add(bytes)
        .next_multiple_of(align_of::<N>())
}

/// All memory to which rendering writes. The caller owns it, and it is used again for every pixel.
///
/// `STACK` must be at least the blob's [stack depth](crate::Scene::stack_depth), `WORK` at least
/// [`Effects::work_depth`](crate::Effects::work_depth) of the scene's effects at the ray depth. The workspace takes 12
/// bytes per entry of the stack. In `f32` and `fixed` it takes 40 bytes per place for a ray, up to 48 in builds with
/// the effects `nested`, `texture-levels` and `indirect`.
#[derive(Debug)]
pub struct Workspace<N: Number, const STACK: usize, const WORK: usize> {
    stack: Stack<STACK>,
    work: Vec<Pending<N>, WORK>,
}

impl<N: Number, const STACK: usize, const WORK: usize> Workspace<N, STACK, WORK> {
    /// Returns an empty workspace.
    ///
    /// ```
    /// use gridel_core::{Fixed, Workspace};
    ///
    /// // A traversal stack of 24 entries, and room for 5 rays that wait.
    /// static mut SPACE: Workspace<Fixed, 24, 5> = Workspace::new();
    /// assert!(size_of::<Workspace<Fixed, 24, 5>>() < 600);
    /// ```
    pub const fn new() -> Self {
        Self {
            stack: Stack::new(),
            work: Vec::new(),
        }
    }

    /// Returns the workspace in the form that renderers use.
    pub fn as_view(&mut self) -> WorkspaceView<'_, N> {
        WorkspaceView {
            stack: self.stack.as_view(),
            work: &mut self.work,
        }
    }
}

impl<N: Number, const STACK: usize, const WORK: usize> Default for Workspace<N, STACK, WORK> {
    fn default() -> Self {
        Self::new()
    }
}

/// A [`Workspace`] whose sizes are not part of its type.
#[derive(Debug)]
pub struct WorkspaceView<'w, N: Number> {
    pub(super) stack: &'w mut StackView,
    pub(super) work: &'w mut VecView<Pending<N>>,
}

/// Starts the rays that a hit beyond lengths sent, those behind others that wait, where they come to the scene.
///
/// At once for all, because a call for each took a kilobyte of small code.
#[cold]
#[inline(never)]
pub(super) fn leave_far<N: Number>(
    scene: &Scene<'_>,
    far: &FarPlace<N>,
    hit: &Hit<N>,
    work: &mut VecView<Pending<N>>,
    others: usize,
) {
    for sent in work.get_mut(others..).unwrap_or_default() {
        far.depart(scene, hit, sent.direction, &mut sent.origin);
    }
}
