//! Records to which tables of candidate lists belong: gridels, apexes, directions and windows.

use crate::format::layout::records;
use bytemuck::{Pod, Zeroable};

records! {
    /// The partition of the scene's box, made larger by 64 units on all sides, into `count` by `count` gridels on each
    /// face.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(40)]
    pub struct Gridels {
        /// Gridels along a side of a face: 1 to 64.
        pub count: u32,
        /// The lowest corner of the partitioned box, lengths with 13 fraction bits: (lowest unit of the header's
        /// bounds - 64) * 2^13.
        pub low: [i32; 3],
        /// The highest corner: (highest unit of the bounds + 64) * 2^13.
        pub high: [i32; 3],
        /// Gridels per length along each axis, with 44 fraction bits more than the length's:
        /// floor(`count` * 2^44 / (`high` - `low`)).
        pub scale: [u32; 3],
    }

    /// A point whose rays have lists of candidates in [`apex`](crate::accel::candidates::apex).
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(24)]
    pub struct ApexPoint {
        /// The point, in 1/256 unit.
        #[valid(Coordinate: -(1 << 29)..=1 << 29)]
        pub at: [i32; 3],
        /// For each face of the cube of directions the number of its window, or 0xffff for none: face 2 *k* is down
        /// axis *k*, 2 *k* + 1 up it. The window exists.
        pub windows: [u16; 6],
    }

    /// A direction whose rays have lists, such as that of a directional light: an apex that is infinitely far away.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(20)]
    pub struct ApexDirection {
        /// The slopes of rays that run that way, ratios with 30 fraction bits.
        pub slope: [i32; 3],
        /// The plane across the major axis that they run to, in 1/256 unit.
        #[valid(Plane: -(1 << 24)..=1 << 24)]
        pub plane: i32,
        /// The axis along which they run most.
        #[valid(MajorAxis: 0..=2)]
        pub major: u16,
        /// The number of their window, which exists.
        pub window: u16,
    }

    /// A rectangle of the values that distinguish the rays of an apex, on the two axes that follow the major one in
    /// turn. The values are slopes, with 30 fraction bits. Where the apex is infinitely far away, they are places in
    /// the plane that the rays run to, in 1/256 unit.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(32)]
    pub struct ApexWindow {
        /// The least slopes or places.
        pub low: [i32; 2],
        /// Cells for a slope of 2^-30 or 1/256 unit, with 32 fraction bits: a slope or place `s` lies in cell
        /// `((s - low) * scale) >> 32` of its side.
        pub scale: [u32; 2],
        /// Cells along each side.
        #[valid(SideCells: 1..=ApexWindow::MOST_CELLS as i64)]
        pub cells: [u16; 2],
        /// The first cell of the window in the table: the sum of the cells of all windows before this one. The
        /// cells of the second side run faster.
        pub first_cell: u32,
        /// Start of the levels of keys: culling steps (half units) along the major axis from the apex or the plane.
        pub start: i32,
        /// Levels per culling step, with 24 fraction bits.
        pub levels_per_step: u32,
    }
}

impl ApexWindow {
    /// Maximum number of cells along a side.
    pub const MOST_CELLS: u16 = 1024;
}
