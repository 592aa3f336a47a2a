//! Lights: where they are from a point, and what of them arrives.

use crate::accel::Number;
use crate::format::record::Light;

impl Light {
    /// The way from a point to this light, of any length, and how far along its largest component
    /// the light is; `None` for infinitely far.
    #[inline(always)]
    pub(crate) fn seen_from<N: Number>(&self, point: [N; 3]) -> ([N::Wide; 3], Option<N::Wide>) {
        if self.directional == 1 {
            return (self.vector.map(N::far), None);
        }
        let axis = |k: usize| N::far(self.vector[k]) - point[k].widen();
        let way = [axis(0), axis(1), axis(2)];
        let zero = N::Wide::default();
        let distance = way.iter().fold(zero, |largest, &component| {
            let magnitude = if component < zero {
                -component
            } else {
                component
            };
            if magnitude > largest {
                magnitude
            } else {
                largest
            }
        });
        (way, Some(distance))
    }
}
