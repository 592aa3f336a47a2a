//! Errors of deforming meshes.

use core::fmt;

/// The reason why a mesh cannot deform, or why a pose of it is rejected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DeformError {
    /// The blob holds a structure that cannot be refitted.
    Structures,
    /// The vertices of the blob have another type.
    Storage,
    /// The blob has more vertices than the deformation can hold.
    Vertices {
        /// Vertices of the blob.
        found: usize,
        /// Vertices that the deformation can hold.
        most: usize,
    },
    /// The blob has more pairs than the deformation can hold.
    Pairs {
        /// Pairs of the blob.
        found: usize,
        /// Pairs that the deformation can hold.
        most: usize,
    },
    /// The deformation was made of another scene.
    OtherScene,
    /// There is no vertex of this number.
    NoVertex {
        /// The number.
        vertex: usize,
    },
    /// A vertex lies beyond the room of the scene.
    OutsideRoom {
        /// Its number.
        vertex: usize,
    },
    /// The corners of a triangle are three places on a line: rays could pass on either side of the middle one.
    Collapsed {
        /// Its number in the order of the scene file.
        primitive: u32,
    },
    /// The blob has more normals that morph targets change than the deformation can hold.
    Normals {
        /// Normals of the blob.
        found: usize,
        /// Normals that the deformation can hold.
        most: usize,
    },
    /// There are more or fewer weights than morph targets.
    Weights {
        /// Weights that were given.
        found: usize,
        /// Morph targets of the scene.
        expected: usize,
    },
    /// The weight of a morph target is beyond ±64.
    Weight {
        /// The number of the morph target.
        number: usize,
    },
    /// Vertices moved since the boxes were computed.
    NotRefitted,
}

impl fmt::Display for DeformError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Structures => f.write_str(
                "the blob holds a structure that cannot be refitted: build it with `--accel bvh` alone",
            ),
            Self::Storage => f.write_str(
                "the blob's vertices have another type: use `Vertex16` up to 16 lattice bits, and \
                 `Vertex24` beyond",
            ),
            Self::Vertices { found, most } => write!(
                f,
                "the blob has {found} vertices, and the deformation has room for {most}"
            ),
            Self::Pairs { found, most } => write!(
                f,
                "the blob has {found} pairs, and the deformation has room for {most}"
            ),
            Self::OtherScene => {
                f.write_str("the deformation was made of another scene: reset it for this one")
            }
            Self::NoVertex { vertex } => write!(f, "there is no vertex {vertex}"),
            Self::OutsideRoom { vertex } => write!(
                f,
                "vertex {vertex} lies outside of the scene's box: build the blob with a larger `--room`"
            ),
            Self::Collapsed { primitive } => write!(
                f,
                "the corners of triangle {primitive} lie on a line: move one of them aside"
            ),
            Self::Normals { found, most } => write!(
                f,
                "morph targets change {found} normals, and the deformation has room for {most}: give it as many as \
                 `Requirements` states"
            ),
            Self::Weights { found, expected } => write!(
                f,
                "there are {found} weights, and the scene has {expected} morph targets: give one for each"
            ),
            Self::Weight { number } => write!(
                f,
                "the weight of morph target {number} is beyond ±64, which are 2^30: give it 24 fraction bits"
            ),
            Self::NotRefitted => {
                f.write_str("vertices moved since the boxes were computed: call `refit`")
            }
        }
    }
}

impl core::error::Error for DeformError {}
