//! Instances in RAM, which a program places.

use crate::format::instance::Instance;
use crate::format::range::Ranges;
use crate::format::record::Pair;
use crate::format::{BlobError, Location, SectionKind};
use crate::instances::bounds::{around, check_rotation};
use crate::instances::build::build;
use crate::instances::placed::Placed;
use crate::instances::top::Top;
use crate::scene::parts::check_instances;
use crate::scene::{Motion, Scene};
use crate::target::InstancesOnly;

/// Memory for the instances of a scene, of at most `MOST`, where a program moves them: 92 bytes each.
///
/// ```
/// # static BLOB: &[u8] =
/// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
/// use gridel_core::{Angle, BlobError, Motion, Parts, Poses, Position, Scene};
///
/// /// Turns the first instance of a scene about the origin.
/// fn turned(blob: &[u8]) -> Result<(), BlobError> {
///     let mut parts = Parts::<4>::new();
///     parts.load(blob)?;
///     let scene = Scene::with_parts(blob, &parts)?;
///     let mut memory = Poses::<6>::new();
///     for dial in 0..24 {
///         let mut poses = memory.at_rest(&scene)?;
///         let turn = Motion::turn(Position([0; 3]), [0, 1, 0], Angle::of_turn(dial, 24));
///         if let Some(turn) = turn {
///             poses.place(&scene, 0, &turn)?;
///         }
///         let posed = scene.with_poses(poses)?;
///         assert_eq!(posed.instances().len(), scene.instances().len());
///     }
///     Ok(())
/// }
/// # // A blob without instances has none to be turned.
/// # assert!(turned(BLOB).is_err());
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Poses<const MOST: usize> {
    instances: [Instance; MOST],
    pairs: [Pair; MOST],
    order: [u32; MOST],
}

impl<const MOST: usize> Poses<MOST> {
    /// Memory that holds nothing yet.
    pub const fn new() -> Self {
        const INSTANCE: Instance = Instance {
            matrix: [[0; 3]; 3],
            center: [0; 3],
            exponent: 0,
            part: 0,
            number: 0,
        };
        const PAIR: Pair = Pair {
            planes: [[[0; 2]; 2]; 3],
            children: [0; 2],
        };
        Self {
            instances: [INSTANCE; MOST],
            pairs: [PAIR; MOST],
            order: [0; MOST],
        }
    }

    /// Returns the instances of a scene at its own places.
    ///
    /// # Errors
    /// If the scene has more than `MOST`.
    pub fn at_rest(&mut self, scene: &Scene<'_>) -> Result<PosesView<'_>, BlobError> {
        PosesView::at_rest(scene, &mut self.instances, &mut self.pairs, &mut self.order)
    }
}

impl<const MOST: usize> Default for Poses<MOST> {
    fn default() -> Self {
        Self::new()
    }
}

/// The instances of a scene while a program moves them, in the program's memory: see [`Poses`].
///
/// Built directly from slices where the number of instances is not known at compile time.
#[derive(Debug)]
pub struct PosesView<'p> {
    instances: &'p mut [Instance],
    pairs: &'p mut [Pair],
    order: &'p mut [u32],
}

impl<'p> PosesView<'p> {
    /// Returns the instances of a scene at its own places, in slices of at least as many records.
    ///
    /// # Errors
    /// If a slice is too short.
    pub fn at_rest(
        scene: &Scene<'_>,
        instances: &'p mut [Instance],
        pairs: &'p mut [Pair],
        order: &'p mut [u32],
    ) -> Result<Self, BlobError> {
        let rest = scene.instances();
        let needed = rest.len();
        let found = instances.len().min(pairs.len()).min(order.len());
        let too_few = BlobError::Memory {
            section: SectionKind::Instances,
            found,
            needed,
        };
        let instances = instances.get_mut(..needed).ok_or(too_few)?;
        let pairs = pairs.get_mut(..needed.saturating_sub(1));
        let order = order.get_mut(..needed);
        for (to, from) in instances.iter_mut().zip(rest) {
            *to = *from;
        }
        Ok(Self {
            instances,
            pairs: pairs.ok_or(too_few)?,
            order: order.ok_or(too_few)?,
        })
    }

    /// Places an instance, given by its number in scene-file order. A motion moves it away from its place in the scene
    /// as it was loaded. Searches for the number among all instances.
    ///
    /// # Errors
    /// If there is no such instance, or it is too far away, too large or too small for the scene's lattice: a scene
    /// file's `room` makes that larger. Errors of a place name this number.
    pub fn place(
        &mut self,
        scene: &Scene<'_>,
        number: u32,
        motion: &Motion,
    ) -> Result<(), BlobError> {
        let numbered = |it: &Instance| it.number == number;
        let index = self.instances.iter().position(numbered);
        let beyond = (number as usize).max(self.instances.len());
        self.place_at(scene, index.unwrap_or(beyond), motion)
    }

    /// Places an instance as [`place`](Self::place) does, given by its index among [`Scene::instances`]: in constant
    /// time.
    ///
    /// # Errors
    /// The errors of [`place`](Self::place).
    pub fn place_at(
        &mut self,
        scene: &Scene<'_>,
        index: usize,
        motion: &Motion,
    ) -> Result<(), BlobError> {
        let rest = scene.instances();
        let (Some(rest), Some(pose)) = (rest.get(index), self.instances.get_mut(index)) else {
            let (number, count) = (index, rest.len());
            return Err(BlobError::NoInstance { number, count });
        };
        let location = Location::Record(SectionKind::Instances, rest.number as usize);
        let header = scene.header();
        let mut placed = motion.place(header, rest);
        if check(&placed, location).is_err() {
            placed = motion.place_rounded(header, rest);
            check(&placed, location)?;
        }
        *pose = placed;
        Ok(())
    }
}

/// Proves that all numbers of an instance are in range, and that its matrix is a rotation times a factor.
#[inline(never)]
fn check(instance: &Instance, location: Location) -> Result<(), BlobError> {
    instance.check_ranges(location)?;
    check_rotation(&instance.matrix).map_err(|reason| location.invalid(reason))
}

impl<'a> Scene<'a> {
    /// Returns the scene with its instances at the program's places; builds the hierarchy above them, in place.
    ///
    /// For `n` instances it takes at most `24 n` steps on each of `log2 n` levels. The blob's box limits motion: a
    /// scene file's `room` widens it.
    ///
    /// # Errors
    /// If the number of instances is not the scene's, or one leaves the scene's box. The error names its number in
    /// scene-file order.
    pub fn with_poses(&self, poses: PosesView<'a>) -> Result<Self, BlobError> {
        let PosesView {
            instances,
            pairs,
            order,
        } = poses;
        let placed = self.placed_as_many(instances.len())?;
        build(instances, order, pairs, self.bounds(), |instance| {
            let (part, _) = placed.part(instance)?;
            around(instance, part.bounds())
        })?;
        let top = Top { instances, pairs };
        Ok(self.with_placed(Placed { top, ..*placed }))
    }

    /// Returns the scene with these instances and the hierarchy above them. They lie as in a blob: instances in the
    /// order of their leaves. Use it for poses that are built once and shared; see [`with_poses`](Self::with_poses) for
    /// others.
    ///
    /// Proves all that loading proves about instances, in time linear in their number.
    ///
    /// # Errors
    /// If their number is not the scene's, one is not in its box, or the hierarchy does not lead to all of them.
    pub fn with_instances(
        &self,
        instances: &'a [Instance],
        pairs: &'a [Pair],
    ) -> Result<Self, BlobError> {
        let placed = self.placed_as_many(instances.len())?;
        let top = Top { instances, pairs };
        let placed = Placed { top, ..*placed };
        check_instances(&placed, self.bounds())?;
        Ok(self.with_placed(placed))
    }

    /// The parts and instances, if the number of instances is right.
    fn placed_as_many(&self, found: usize) -> Result<&Placed<'a, Self>, BlobError> {
        let needed = self.instances().len();
        let placed = self.placed.get().filter(|_| found == needed);
        placed.ok_or(BlobError::Memory {
            section: SectionKind::Instances,
            found,
            needed,
        })
    }

    fn with_placed(&self, placed: Placed<'a, Self>) -> Self {
        Self {
            placed: InstancesOnly::new(|| placed),
            ..*self
        }
    }
}
