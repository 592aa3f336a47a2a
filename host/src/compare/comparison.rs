//! Comparisons of contenders.

use super::judge::Mismatch;
use crate::measure::InstanceCount;
use crate::measure::rays::Works;
use serde::Serialize;

/// A comparison of the contenders on one scene.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    pub format: &'static str,
    /// Width and height of the picture.
    pub size: [u16; 2],
    /// Number of times that everything was timed.
    pub repeats: usize,
    /// Primitives of the blobs.
    pub primitives: usize,
    /// `None` where the scene file has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub instances: Option<InstanceCount>,
    pub rays: RayCounts,
    /// Rays that brute force traced, too. On the others the structures were compared with each other, and brute force
    /// decided where they differed.
    pub listed: usize,
    pub rows: Vec<Row>,
    /// Structures whose tables do not fit their budget.
    pub rejected: Vec<Rejected>,
    /// Warnings of the compiler.
    #[serde(skip)]
    pub warnings: Vec<String>,
}

impl Comparison {
    /// Returns whether the scene has instances, and the blobs have them as well.
    pub fn keeps_instances(&self) -> bool {
        self.instances.is_some_and(|it| it.are_kept())
    }
}

/// A structure that was not built.
#[derive(Clone, Debug, Serialize)]
pub struct Rejected {
    pub structure: &'static str,
    /// The reason, with the bytes that it would take.
    pub why: String,
}

/// The rays of the picture.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct RayCounts {
    pub primary: usize,
    pub shadow: usize,
    /// Rays that surfaces send on: mirrored, refracted and diffusely reflected ones.
    pub bounced: usize,
}

/// One contender.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The structure, and the builder where there are several.
    pub name: String,
    pub structure: &'static str,
    /// `None` where there is no hierarchy.
    pub builder: Option<&'static str>,
    /// Cost of the hierarchy's boxes by the surface area heuristic; `None` without one, and where a scene and its parts
    /// have one each.
    pub sah_cost: Option<f64>,
    /// Time to build the structure on one thread, from primitives on the lattice to records: the median of the repeats.
    /// A structure that has taken a second is not built again.
    pub setup_seconds: f64,
    /// The most memory at any time while the scene was compiled on one thread, beyond the scene itself.
    pub peak_bytes: Option<usize>,
    /// Bytes by which the blob is larger than one of the list alone.
    pub own_bytes: usize,
    pub blob_bytes: usize,
    /// Primitives of the longest list that a ray can be led to.
    pub longest_list: usize,
    /// The traversal stack on a 32-bit board.
    pub stack_bytes: usize,
    /// The first difference from brute force; `None` if all answers are equal.
    pub wrong: Option<Mismatch>,
    /// `None` where the answers are wrong.
    pub work: Option<Works>,
}
