//! Four rays at once in the form in which strips are tested.

use super::{Projection, StripRay};
use crate::format::record::{Vertex16, Vertex24};
use crate::format::width::Vertex;
use crate::geometry::Strips;
use crate::geometry::project::AxisProjection;
use crate::ray::FourRays;
use glam::Vec4;

impl StripRay<f32> {
    /// Writes four rays for the strips of a scene: the operations of [`StripRay::new`], without branches on their axes.
    #[inline(always)]
    pub(crate) fn write_four(rays: &FourRays, strips: &Strips<'_>, four: [&mut Self; 4]) {
        let step_bits = match strips {
            Strips::S16(_) => Vertex16::STEP_BITS,
            Strips::S24(_) => Vertex24::STEP_BITS,
        };
        let steps = (1_u32 << (step_bits & 31)) as f32;
        let offset = |role: usize| (-(Vec4::from(rays.role_origin[role]) * steps)).to_array();
        let slope = |role: usize| Vec4::from(rays.role_slope[role]);
        let shear = |role: usize| (-(slope(role) * slope(2))).to_array();
        let below = |role: usize| slope(role).cmplt(Vec4::ZERO).bitmask();
        let offset = [offset(0), offset(1), offset(2)];
        let shear = [shear(0), shear(1)];
        let below = [below(0), below(1), below(2)];
        for (lane, ray) in four.into_iter().enumerate() {
            let major = rays.major(lane);
            let Projection { axes, .. } = &mut ray.projection;
            axes[0].offset = offset[0][lane];
            axes[1].offset = offset[1][lane];
            axes[2].offset = offset[2][lane];
            ray.projection.shear = [shear[0][lane], shear[1][lane]];
            ray.projection.major = major;
            ray.axes = Self::AXES[major];
            let below = |role: usize| (below[role] >> lane & 1) << role;
            ray.descends = below(0) | below(1) | below(2);
        }
    }

    /// A ray that is to be written.
    pub(crate) fn unwritten() -> Self {
        let axis = || AxisProjection {
            offset: 0.0,
            scale: 1,
        };
        Self {
            projection: Projection {
                axes: [axis(), axis(), axis()],
                shear: [0.0; 2],
                major: 0,
            },
            axes: 0,
            descends: 0,
        }
    }
}
