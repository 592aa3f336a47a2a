//! What a material calls for, and its colour at a point.

use crate::accel::Number;
use crate::format::Effects;
use crate::format::record::Material;
use crate::query::Hit;
use crate::shade::Color;

impl Material {
    /// The effects that this material calls for.
    pub fn effects(&self) -> Effects {
        let mut effects = Effects::NONE;
        if self.highlight != [0; 3] {
            effects = effects.with(Effects::HIGHLIGHT);
        }
        if self.mirror != [0; 3] {
            effects = effects.with(Effects::MIRROR);
        }
        if self.transmit != [0; 3] {
            effects = effects.with(Effects::GLASS);
            if self.absorption != [0; 3] {
                effects = effects.with(Effects::ABSORPTION);
            }
        }
        if self.checker_size > 0 {
            effects = effects.with(Effects::CHECKER);
        }
        effects
    }

    /// The diffuse colour where a ray hit.
    ///
    /// A checkerboard is a solid texture. It is looked up beneath the surface by the hit's error
    /// bound, so that a face that lies exactly between two layers of cells has the colours of the
    /// layer inside, and no noise.
    #[inline(always)]
    pub(crate) fn diffuse_at<N: Number, const EFFECTS: u32>(&self, hit: &Hit<N>) -> Color<N> {
        if !Effects(EFFECTS).contains(Effects::CHECKER) || self.checker_size == 0 {
            return Color::ratios(self.diffuse);
        }
        let length = |q13: i32| N::narrow(N::far(q13.into()));
        let size = length(self.checker_size);
        let parity = (0..3).fold(0, |parity, axis| {
            let place = hit.point[axis] - length(self.checker_origin[axis]);
            // Far enough for the difference and the quotient to be other numbers.
            let step = N::step_beside(place);
            let depth = hit.error.max(step + step);
            parity ^ (place - depth * hit.normal[axis]).cell(size)
        });
        Color::ratios(if parity & 1 == 0 {
            self.diffuse
        } else {
            self.odd
        })
    }
}
