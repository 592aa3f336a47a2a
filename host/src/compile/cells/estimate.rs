//! Estimates how many primitives rays test in the cells of a grid or an octree.
//!
//! Rays are assumed to run through the scene's box in its own proportions, as they run through a cube if each axis is
//! scaled. So they run along a needle as well as across it. A long triangle counts in every cell of a row that it lies
//! in.

use gridel_core::format::record::UnitBox;

/// Tests per ray and cube root of the number of primitives below which the number of cells is kept. A grid of ordinary
/// scenes has about 2 for each, as rays pass through so many cells.
const ORDINARY: f64 = 16.0;

/// Returns a number of tests per ray that ordinary scenes with this many primitives stay below.
pub fn ordinary_tests(primitives: usize) -> f64 {
    ORDINARY * libm::cbrt(primitives as f64)
}

/// Rays through a scene whose box is divided.
#[derive(Clone, Copy, Debug)]
pub struct Rays {
    /// For each axis, how far the scene extends and the box that is divided, in units.
    extents: [[f64; 2]; 3],
    /// The distance beyond a cell at which rays still visit it, in units.
    margin: f64,
}

impl Rays {
    /// Rays through the primitives with the given boxes, in a box that holds them all.
    pub fn new(boxes: &[UnitBox], divided: &UnitBox, margin: f64) -> Self {
        let scene = boxes.iter().copied().reduce(|a, b| a.union(&b));
        let scene = scene.unwrap_or(*divided);
        let extent = |[low, high]: [i16; 2]| f64::from(i32::from(high) - i32::from(low));
        Self {
            extents: [0, 1, 2].map(|k: usize| [extent(scene.0[k]), extent(divided.0[k])]),
            margin,
        }
    }

    /// Returns the share of them that visit one cell of the box divided so often along each axis.
    pub fn share(&self, divisions: [u32; 3]) -> f64 {
        let width = |k: usize| {
            let [scene, divided] = self.extents[k];
            if scene == 0.0 {
                return 1.0;
            }
            let cell = (divided / f64::from(divisions[k])).min(scene);
            (cell + self.margin) / (scene + self.margin)
        };
        let [x, y, z] = [width(0), width(1), width(2)];
        (x * y + y * z + z * x) / 3.0
    }
}
