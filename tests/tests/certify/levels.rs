//! The area of an image that a sample covers, by logarithms of integers with 8 fraction bits.

use super::exact::Exact;
use super::numbers::{floor, one, real};
use super::placed::Met;
use gridel_core::Effects;
use gridel_core::format::instance::{Instance, MATRIX_BITS};
use gridel_core::format::record::Material;
use gridel_core::number::log2::{log2, log2_of_length, log2_of_power, log2_of_sum};
use gridel_core::scene::Footprint;
use gridel_host::shape::Solid;
use gridel_host::shape::exact::{Real, Vector, dot};

/// Returns the logarithm of a ratio, of which 30 fraction bits count.
fn of_ratio(ratio: &Real) -> i32 {
    log2(floor(&(ratio * real(f64::powi(2.0, 30)))).unsigned_abs()) - log2_of_power(30)
}

/// Returns the logarithm of the ratio of lengths in a part to lengths in its surroundings.
pub fn stretch(instance: &Instance) -> i32 {
    let row = log2_of_length(instance.matrix[0].map(i64::from));
    row + log2_of_power(i32::from(instance.exponent) - MATRIX_BITS as i32)
}

/// Returns the slopes of a direction, the largest being 1, and the direction's largest component.
fn slopes(direction: &Vector) -> (Vector, Real) {
    let [x, y, z] = direction.each_ref().map(|it| it.abs());
    let largest = x.max(y).max(z);
    (direction.each_ref().map(|it| it / &largest), largest)
}

impl Exact<'_> {
    /// Returns the length of the rays that led to a hit, in 2^-13 units, including that of one of this direction.
    /// `None` where no texture has levels.
    pub fn length(&self, before: Option<i32>, met: &Met<'_>, direction: &Vector) -> Option<i32> {
        if !self.scene.effects().contains(Effects::TEXTURE_LEVELS) {
            return None;
        }
        let (slopes, largest) = slopes(direction);
        let steps = floor(&(&met.t * largest * real(8192.0) + real(0.5)));
        let norm = -of_ratio(&(one() / dot(&slopes, &slopes))) >> 1;
        let own = log2(steps.unsigned_abs()) + norm;
        Some(before.map_or(own, |before| log2_of_sum(before, own)).max(0))
    }

    /// Returns the footprint of a sample on the image of a material.
    pub fn footprint(
        &self,
        (met, material): (&Met<'_>, &Material),
        length: Option<i32>,
        direction: &Vector,
    ) -> Footprint {
        let has_levels = material.maps & Material::MAPS_LEVELS != 0;
        let found = || {
            let (density, length) = (Self::density(met)?, length.filter(|_| has_levels)?);
            let (slopes, _) = slopes(direction);
            let norm = -of_ratio(&(one() / dot(&slopes, &slopes))) >> 1;
            let cosine = dot(&slopes, &met.normal).abs();
            let stretched = (norm - of_ratio(&cosine)) >> 1;
            let width = length - log2_of_power(13) + self.spread();
            Some(Footprint::of_log2(width + stretched + density))
        };
        found().unwrap_or(Footprint::point())
    }

    /// Returns the distance of pixels per distance from the eye, at one sample per pixel.
    fn spread(&self) -> i32 {
        let view = self.scene.view();
        let of = |axis: [i32; 3]| log2_of_length(axis.map(i64::from));
        let height = log2(self.settings.height.into());
        of(view.up) + log2_of_power(1) - of(view.forward) - height
    }

    /// The distance of texture coordinates per unit.
    fn density(met: &Met<'_>) -> Option<i32> {
        let [a, b, c] = met.placed.coordinates?.map(|at| at.map(i64::from));
        let Solid::Triangle(corners) = &met.placed.solid else {
            return None;
        };
        let [p, q, r] = corners.map(|corner| (corner * 256.0).to_array().map(|x| x as i64));
        let (b, c) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        let mapped = (b[0] * c[1]).saturating_sub(b[1] * c[0]);
        if mapped == 0 {
            return None;
        }
        let edge = |to: [i64; 3]| [0, 1, 2].map(|k: usize| to[k] - p[k]);
        let (q, r) = (edge(q), edge(r));
        let area = [(1, 2), (2, 0), (0, 1)].map(|(i, j): (usize, usize)| q[i] * r[j] - q[j] * r[i]);
        let own = (log2(mapped.unsigned_abs()) - log2_of_length(area)) >> 1;
        let stretch = met.placed.map.as_ref().map_or(0, |map| map.stretch);
        // 20 fraction bits of coordinates, and 8 of places.
        Some(own - log2_of_power(12) + stretch)
    }
}
