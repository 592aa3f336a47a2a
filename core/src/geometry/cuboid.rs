//! Axis-aligned boxes as objects, by the slabs of Kay and Kajiya.
//!
//! Closed: a ray that lies in a face hits it. An axis along which the ray does not move is a containment test, so
//! nothing is divided by zero.
//!
//! Crossings need no clamping to the box on the box lattice, which holds this one. A t is where the ray crosses one
//! face, and lies between the crossings of the others. So the point lies outside the box by at most the rounding of a
//! coordinate and of a t of less than 2^18 units. That is 2^-5 unit in `f32`, and culling widens boxes by more (see
//! [`cull`](crate::accel)).

use crate::axis::pick;
use crate::format::layout::records;
use crate::format::record::UnitBox;
use crate::format::{BlobError, Field, Reason};
use crate::geometry::primitive::{InScene, Primitive};
use crate::geometry::{Crossing, LEAVING, Part, Surface, flat};
use crate::number::Arithmetic;
use crate::ray::Ray;
use bytemuck::{Pod, Zeroable};

records! {
    /// An axis-aligned box.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(24)]
    pub struct Cuboid {
        /// Smallest coordinates in 1/256 unit.
        pub lowest: [i32; 3],
        /// Largest coordinates in 1/256 unit, none below `lowest`.
        pub highest: [i32; 3],
    }
}

impl Primitive for Cuboid {
    const CLAMPS: bool = false;

    #[inline(always)]
    fn bounds(&self) -> UnitBox {
        UnitBox::around(self.lowest, self.highest)
    }

    /// The crossing with the box. Part `2 k` is the lower face of axis `k`, and `2 k + 1` the upper one.
    ///
    /// Cost: six divisions in floats. In integers, two if the ray hits the box, else none.
    #[inline(always)]
    fn cross<N: Arithmetic>(&self, ray: &Ray<N>, _: N) -> Option<Crossing<N>> {
        let mut enter = ((-N::FAR).quotient(N::ONE), 0);
        let mut leave = (N::FAR.quotient(N::ONE), 0);
        for axis in 0..3 {
            let below = N::from_lattice(self.lowest[axis]) - ray.origin[axis];
            let above = N::from_lattice(self.highest[axis]) - ray.origin[axis];
            let slope = ray.slope[axis];
            if slope == N::ZERO {
                if below > N::ZERO || above < N::ZERO {
                    return None;
                }
                continue;
            }
            let lower: Part = 2 * axis as Part;
            let below = (below.quotient(slope), lower);
            let above = (above.quotient(slope), lower + 1);
            let (near, far) = if slope > N::ZERO {
                (below, above)
            } else {
                (above, below)
            };
            if near.0 > enter.0 {
                enter = near;
            }
            if far.0 < leave.0 {
                leave = far;
            }
        }
        let end = |(t, part)| (N::rounded(t), part);
        (enter.0 <= leave.0).then(|| Crossing {
            enter: end(enter),
            leave: end(leave),
        })
    }

    /// The normal points outward. At an edge the point stays on the face, at the distance from the other faces at which
    /// rays start.
    fn surface<N: Arithmetic>(&self, _: &Ray<N>, part: Part, point: [N; 3]) -> Surface<N> {
        let part = part & !LEAVING;
        let (axis, is_upper) = (usize::from(part / 2), part & 1 != 0);
        let side = if is_upper { self.highest } else { self.lowest };
        let coordinate = N::from_lattice(pick(side, axis));
        flat::face(
            axis,
            is_upper,
            coordinate,
            self.beneath_faces(point, N::step_beside),
        )
    }

    fn inside<N: Arithmetic>(&self, [point, _]: [[N; 3]; 2], depth: N) -> [N; 3] {
        self.beneath_faces(point, |side| N::step_beside(side).max(depth))
    }

    fn validate(&self, scene: InScene<'_>) -> Result<(), BlobError> {
        scene.point(Field::LowestCoordinate, self.lowest)?;
        scene.point(Field::HighestCoordinate, self.highest)?;
        let mut sides = self.lowest.iter().zip(&self.highest);
        let at = scene.at;
        at.ensure(sides.all(|(low, high)| low <= high), Reason::InvertedBox)
    }
}

impl Cuboid {
    /// Returns the point beneath all faces that is nearest to a point, given their coordinates. It lies a step inside
    /// the faces, or halfway between them where the box is no thicker than that.
    #[inline(always)]
    fn beneath_faces<N: Arithmetic>(&self, point: [N; 3], step: impl Fn(N) -> N) -> [N; 3] {
        let axis = |k: usize| {
            let low = N::from_lattice(self.lowest[k]);
            let high = N::from_lattice(self.highest[k]);
            let (first, last) = (low + step(low), high - step(high));
            if first > last {
                low.half() + high.half()
            } else {
                point[k].max(first).min(last)
            }
        };
        [axis(0), axis(1), axis(2)]
    }
}
