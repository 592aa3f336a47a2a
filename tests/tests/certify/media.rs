//! Glass: the media at its faces, the split of a ray there, and the medium that fills a place that several take.

use super::exact::Exact;
use super::numbers::{fraction, one, real};
use super::placed::Met;
use gridel_core::format::limits::MAX_MEDIA;
use gridel_core::format::record::Material;
use gridel_host::shape::exact::{Real, Vector, along, dot, scaled};

/// The glass that a ray is inside of.
#[derive(Clone, Copy, Default)]
pub struct Inside {
    /// Number of times that it is inside of each medium, the one with the highest priority first.
    counts: [u8; MAX_MEDIA],
    /// The material of the glass without a priority that it came into last.
    plain: Option<u32>,
}

impl Inside {
    /// The medium that fills the place.
    fn highest(self) -> Option<usize> {
        self.counts.iter().position(|&count| count > 0)
    }

    fn entered(mut self, medium: usize) -> Self {
        self.counts[medium] = (self.counts[medium] + 1).min(15);
        self
    }

    fn left(mut self, medium: usize) -> Self {
        self.counts[medium] = self.counts[medium].saturating_sub(1);
        self
    }
}

/// Two media that meet.
#[derive(Clone)]
pub struct Interface {
    /// The lower index of refraction over the higher one.
    pub k: Real,
    /// True if the ray goes to the higher one.
    pub to_denser: bool,
}

impl Interface {
    /// Returns the passage between the surroundings and glass.
    fn of(material: &Material, enters: bool) -> Self {
        Self {
            k: fraction(material.inverse_ior, 30),
            to_denser: enters,
        }
    }

    /// Returns the passage from one medium to another, `None` for the surroundings.
    fn between(from: Option<&Material>, to: Option<&Material>) -> Self {
        let inverse = |it: Option<&Material>| it.map_or(1 << 30, |it| it.inverse_ior);
        let (from, to) = (inverse(from), inverse(to));
        Self {
            k: fraction(from.min(to), 30) / fraction(from.max(to), 30),
            to_denser: to < from,
        }
    }

    /// Returns whether the media differ.
    pub fn is_bending(&self) -> bool {
        self.k != one()
    }

    /// The part of a ray that is reflected, and the direction of the rest, at a normal that has this cosine with the
    /// way back.
    pub fn split(&self, direction: &Vector, normal: &Vector, cos: &Real) -> (Real, Option<Vector>) {
        let k = &self.k;
        if *k == one() {
            return (real(0.0), Some(direction.clone()));
        }
        // From the side of the ray to the other one.
        let ratio = if self.to_denser { k.clone() } else { one() / k };
        let sine = &ratio * &ratio * (one() - cos * cos);
        if sine >= one() {
            return (one(), None);
        }
        let cos_out = (one() - &sine).sqrt();
        let lift = &ratio * cos - &cos_out;
        let refracted = along(&scaled(direction, &ratio), &lift, normal);
        // Lengths count where a triangle with normals lifts a direction: those of the rules.
        let length = if self.to_denser { one() } else { k.clone() };
        let reflected = reflected(&ratio, cos, &cos_out);
        (reflected, Some(scaled(&refracted, &length)))
    }

    /// The part of light that passes straight on: as if it came from the side with the lower index.
    pub fn straight_through(&self, cos: &Real) -> Real {
        let k = &self.k;
        if *k == one() {
            return one();
        }
        let cos_out = (one() - k * k * (one() - cos * cos)).sqrt();
        one() - reflected(k, cos, &cos_out)
    }
}

/// The mean of perpendicular and parallel polarization, with indices 1 and 1 / ratio.
fn reflected(ratio: &Real, cos: &Real, cos_out: &Real) -> Real {
    let perpendicular = (ratio * cos - cos_out) / (ratio * cos + cos_out);
    let parallel = (cos - ratio * cos_out) / (cos + ratio * cos_out);
    (&perpendicular * &perpendicular + &parallel * &parallel) * real(0.5)
}

/// A face, as a ray comes to it.
pub struct Face<'e> {
    /// The glass that lies before it, if any does.
    pub before: Option<&'e Material>,
    /// The two media that meet there, if it is glass.
    pub interface: Option<Interface>,
    /// True if it lies within a medium of a higher priority, and so is ignored.
    pub is_hidden: bool,
    /// The media that a ray is inside of behind it.
    pub beyond: Inside,
}

impl<'s> Exact<'s> {
    fn medium(&self, place: Option<usize>) -> Option<&'s Material> {
        let number = self.scene.media()[place?];
        Some(&self.scene.materials()[number as usize])
    }

    fn plain(&self, inside: Inside) -> Option<&'s Material> {
        Some(&self.scene.materials()[inside.plain? as usize])
    }

    /// The glass that fills a place.
    pub fn around(&self, inside: Inside) -> Option<&'s Material> {
        self.medium(inside.highest()).or(self.plain(inside))
    }

    pub fn face(&self, inside: Inside, met: &Met<'_>) -> Face<'s> {
        let material = self.material(met);
        let is_glass = material.transmit != [0; 3];
        let Some(place) = self.scene.place_among_media(met.object) else {
            let leaves_glass = is_glass && !met.front;
            let own = Some(self.scene.material_number(met.object));
            let mut beyond = inside;
            if is_glass && met.front {
                beyond.plain = own;
            } else if leaves_glass && inside.plain == own {
                beyond.plain = None;
            }
            return Face {
                before: match leaves_glass {
                    true => Some(material),
                    false => self.around(inside),
                },
                interface: is_glass.then(|| Interface::of(material, met.front)),
                is_hidden: false,
                beyond,
            };
        };
        let place = usize::from(place);
        let (near, beyond) = if met.front {
            (inside, inside.entered(place))
        } else {
            // A ray that leaves a medium that it never entered began within.
            let beyond = inside.left(place);
            (beyond.entered(place), beyond)
        };
        let (from, to) = (near.highest(), beyond.highest());
        let before = self.medium(from);
        Face {
            before: before.or(self.plain(inside)),
            interface: Some(Interface::between(before, self.medium(to))),
            is_hidden: from == to,
            beyond,
        }
    }
}

/// The cosine with the way back to where a ray came from.
pub fn cos_back(direction: &Vector, normal: &Vector) -> Real {
    -dot(direction, normal)
}
