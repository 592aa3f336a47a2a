//! Boxes as the builder wants them: whose union is a maximum in eight lanes.

use gridel_core::format::cluster::LANES;
use gridel_core::format::record::UnitBox;

/// A box on the box lattice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hull {
    /// The complements of the lower planes, and the upper planes; the other two lanes are the same
    /// in all boxes.
    sides: [i16; LANES],
}

impl Hull {
    /// Returns the box around two.
    pub fn union(&self, other: &Hull) -> Hull {
        Hull {
            sides: std::array::from_fn(|lane| self.sides[lane].max(other.sides[lane])),
        }
    }

    /// Half the surface area in units.
    pub fn area(&self) -> i64 {
        let [low_x, low_y, low_z, _, x, y, z, _] = self.sides.map(i64::from);
        let (x, y, z) = (x + low_x + 1, y + low_y + 1, z + low_z + 1);
        x * (y + z) + y * z
    }

    /// Twice the middle along an axis.
    pub fn middle(&self, axis: usize) -> i32 {
        let [low, high] = UnitBox::from(*self).0[axis];
        i32::from(low) + i32::from(high)
    }
}

impl From<UnitBox> for Hull {
    fn from(bounds: UnitBox) -> Self {
        let [x, y, z] = bounds.0;
        let sides = [!x[0], !y[0], !z[0], 0, x[1], y[1], z[1], 0];
        Self { sides }
    }
}

impl From<Hull> for UnitBox {
    fn from(hull: Hull) -> Self {
        let [low_x, low_y, low_z, _, x, y, z, _] = hull.sides;
        UnitBox([[!low_x, x], [!low_y, y], [!low_z, z]])
    }
}
