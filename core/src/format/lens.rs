//! The record of a camera's lens.

use crate::format::layout::records;
use crate::format::limits::FARTHEST;
use bytemuck::{Pod, Zeroable};

records! {
    /// A thin lens around the eye, parallel to the picture.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C, packed(4))]
    #[bytes(16)]
    pub struct Lens {
        /// Its radius, in units with 13 fraction bits. The eye is no farther from the lattice's middle than 2^37 units less
        /// this, on each axis.
        #[valid(LensRadius: 1..=FARTHEST)]
        pub radius: i64,
        /// The distance of the plane on which the picture is sharp, along the camera's axis: units with 13 fraction bits.
        #[valid(Focus: 1..=FARTHEST)]
        pub focus: i64,
    }
}
