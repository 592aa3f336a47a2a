//! Boxes of surfaces, and the error bounds of these.

use crate::shape::rounding::step;
use crate::shape::{ExactMap, Solid, Surface};
use glam::DVec3;
use gridel_core::Format;

/// A box in units.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    pub(super) lowest: DVec3,
    pub(super) highest: DVec3,
}

impl Extent {
    pub(super) const EMPTY: Self = Self {
        lowest: DVec3::INFINITY,
        highest: DVec3::NEG_INFINITY,
    };

    pub(super) fn of(solid: &Solid) -> Self {
        if !solid.is_bounded() {
            // It is near everything in the box of a scene.
            return Self {
                lowest: DVec3::splat(f64::from(i16::MIN)),
                highest: DVec3::splat(f64::from(i16::MAX)),
            };
        }
        let around = |(center, radius): (DVec3, f64)| Self {
            lowest: center - radius,
            highest: center + radius,
        };
        let [first, last] = solid.ends().map(around);
        first.with(last)
    }

    pub(super) fn with(self, other: Self) -> Self {
        Self {
            lowest: self.lowest.min(other.lowest),
            highest: self.highest.max(other.highest),
        }
    }

    /// Returns whether two boxes are no farther apart than a length.
    pub(super) fn is_near(&self, other: &Self, length: f64) -> bool {
        (self.lowest - length).cmple(other.highest).all()
            && (other.lowest - length).cmple(self.highest).all()
    }

    /// The box of an instance's content, which lies in this box of the part.
    pub(super) fn placed(self, map: &ExactMap) -> Self {
        let ends = [self.lowest, self.highest];
        let corner = |number: usize| {
            let bits = [number & 1, number >> 1 & 1, number >> 2];
            DVec3::from_array(map.back([0, 1, 2].map(|k| ends[bits[k]][k])))
        };
        let corners = (0..8).map(corner);
        let whole = corners.fold(Self::EMPTY, |whole, corner| {
            whole.with(Self {
                lowest: corner,
                highest: corner,
            })
        });
        // The rows of a map are rounded, so that its transpose is nearly its inverse.
        let off = f64::powi(2.0, -20) * whole.reach(map);
        Self {
            lowest: whole.lowest - off,
            highest: whole.highest + off,
        }
    }

    /// The largest coordinate as seen from the center of an instance.
    pub(super) fn reach(&self, map: &ExactMap) -> f64 {
        let ends = [self.lowest, self.highest];
        ends.map(|place| map.reach(place.to_array()))
            .into_iter()
            .fold(0.0, f64::max)
    }

    pub(super) fn magnitude(&self) -> f64 {
        self.lowest.abs().max(self.highest.abs()).max_element()
    }
}

/// Returns the distance of a format's neighboring numbers at a place, in units.
pub(super) fn spacing(format: Format, magnitude: f64) -> f64 {
    let step = step(format, magnitude);
    match format {
        Format::Fixed => step,
        Format::F32 | Format::F64 => 2.0 * step,
    }
}

/// The error bound of a primitive's surface next to a place, as the table of `Hit::error` has it.
pub(super) fn bound(format: Format, solid: &Solid, place: DVec3) -> f64 {
    let u = step(format, 1.0);
    let plane = |normal: DVec3, through: DVec3| {
        let normal = normal.normalize_or_zero();
        if normal.abs().max_element() == 1.0 {
            return 0.0;
        }
        let relative = (through - place).abs();
        match format {
            Format::Fixed => {
                let sub_step = step(format, 1.0);
                4.0 * sub_step + relative.element_sum() * f64::powi(2.0, -28)
            }
            _ => u * (16.0 * relative + 4.0 * place.abs()).dot(normal.abs()),
        }
    };
    let curved = |size: f64| match format {
        Format::Fixed => 8.0 * step(format, 1.0),
        _ => u * (20.0 * size + 4.0 * place.abs().max_element()),
    };
    match solid.surface() {
        Surface::Box => 0.0,
        Surface::Plane { normal, point } => plane(normal, point),
        Surface::Sphere { radius, .. } => curved(radius),
        Surface::Curved => match format {
            Format::Fixed => 8.0 * step(format, 1.0),
            _ => 16.0 * u * Extent::of(solid).magnitude(),
        },
    }
}

/// Returns the error bound of an instance's surface, in units of the scene, by the table of `Hit::error`. It depends on
/// the bound in the part, and on the largest coordinates of the position. These are relative to the instance's center
/// and to the scene's middle.
pub(super) fn placed_bound(
    format: Format,
    map: &ExactMap,
    in_part: f64,
    [reach, magnitude]: [f64; 2],
) -> f64 {
    let (sub_step, u) = (step(Format::Fixed, 1.0), step(format, 1.0));
    match format {
        Format::Fixed => map.length(in_part + 8.0 * sub_step) + 20.0 * sub_step,
        _ => map.length(in_part) + u * (32.0 * reach + 4.0 * magnitude),
    }
}
