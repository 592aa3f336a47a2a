//! The room of what moves: boxes are wider by it.

use crate::compile::hierarchy::node::{Primitive, bounds};
use crate::shape::Lattice;
use glam::DVec3;
use gridel_core::Kind;
use gridel_core::format::record::UnitBox;

/// Returns an extent that is wider by `room` on all sides.
pub fn widened((lowest, highest): (DVec3, DVec3), room: f64) -> (DVec3, DVec3) {
    (lowest - room, highest + room)
}

/// Returns the box around all primitives, and around all places to which vertices can move by
/// `room` units.
pub fn around(primitives: &[Primitive], room: f64) -> Option<UnitBox> {
    let own = bounds(primitives)?;
    let meshes = primitives.iter().filter(|it| it.kind == Kind::Triangle);
    let meshes = meshes.map(|it| it.bounds).reduce(|a, b| a.union(&b));
    let Some(UnitBox(sides)) = meshes.filter(|_| room > 0.0) else {
        return Some(own);
    };
    // The lattice holds this; -32768 is reserved.
    let room = room.ceil().min(f64::from(u16::MAX)) as i32;
    let within = |plane: i32| plane.clamp(-i32::from(i16::MAX), i16::MAX.into()) as i16;
    let wider = sides.map(|[low, high]| {
        [
            within(i32::from(low) - room),
            within(i32::from(high) + room),
        ]
    });
    Some(own.union(&UnitBox(wider)))
}

/// Margin of a swept box relative to its size: for small rotations and the rounding of boxes.
pub const MARGIN: f64 = 1.0 / 4096.0;

/// Least margin of a swept box in units: boxes of instances are up to five units larger than their contents.
const MARGIN_UNITS: f64 = 8.0;

/// The box that something sweeps while it moves.
#[derive(Clone, Copy, Debug, Default)]
pub struct Swept {
    /// Without a margin; `None` if nothing moves.
    pub corners: Option<[DVec3; 2]>,
    /// Number of units by which it is widened further, for the rounding of motion.
    pub rounding: f64,
    /// How far the coordinates of programs take it off, in scene units.
    pub off: f64,
}

impl Swept {
    /// Adds a box, given its lowest and its highest corner.
    pub fn add(&mut self, [low, high]: [DVec3; 2]) {
        let [lowest, highest] = self.corners.unwrap_or([low, high]);
        self.corners = Some([lowest.min(low), highest.max(high)]);
    }

    /// Returns the box around an extent and this, for a lattice with this number of bits.
    pub fn extent(&self, extent: (DVec3, DVec3), bits: u8) -> (DVec3, DVec3) {
        let Some([low, high]) = self.corners else {
            return extent;
        };
        let whole = [low.min(extent.0), high.max(extent.1)];
        // An extent without a lattice is reported later.
        let unit = Lattice::around(whole, bits, 0).map_or(0.0, |it| it.unit());
        let [low, high] = self.with_margin(unit).unwrap_or(whole);
        (low.min(extent.0), high.max(extent.1))
    }

    /// Returns the box on a lattice with such units.
    pub fn with_margin(&self, unit: f64) -> Option<[DVec3; 2]> {
        self.corners.map(|[low, high]| {
            let part = (high - low).max_element() * MARGIN;
            // Less than a unit fits in the margin.
            let off = if self.off > unit { self.off } else { 0.0 };
            let margin = DVec3::splat(part.max((MARGIN_UNITS + self.rounding) * unit) + off);
            [low - margin, high + margin]
        })
    }

    /// Returns this box on a lattice; `None` if nothing moves.
    pub fn on_lattice(&self, lattice: &Lattice) -> Option<UnitBox> {
        let [low, high] = self.with_margin(lattice.unit())?;
        let units = |place: DVec3| (place - lattice.origin) / lattice.unit();
        // The casts saturate; -32768 is reserved.
        let (low, high) = (units(low).floor().to_array(), units(high).ceil().to_array());
        let side = |axis: usize| [(low[axis] as i16).max(-i16::MAX), high[axis] as i16];
        Some(UnitBox([side(0), side(1), side(2)]))
    }
}
