//! Nested dielectrics: which of several media that overlap is there.

use super::number::*;
use gridel_core::Scene;
use gridel_core::format::limits::MAX_MEDIA;
use gridel_core::format::record::Material;
use std::cmp::Ordering;

/// Two media that meet at a surface.
#[derive(Clone, Copy, Debug)]
pub struct Interface<N> {
    /// The lower index of refraction over the higher one.
    pub k: N,
    /// True if the ray goes to the one with the higher index.
    pub to_denser: bool,
}

impl<N: Enclosure> Interface<N> {
    /// Returns whether the media differ.
    pub fn is_bending(&self) -> bool {
        (self.k - N::one()).sign() != Some(Ordering::Equal)
    }

    /// Returns the passage between the surroundings and glass. `front` is true if the ray hits the front.
    pub fn of(front: bool, material: &Material) -> Self {
        Self {
            k: ratio_of(material.inverse_ior),
            to_denser: front,
        }
    }
}

/// The glass that a ray is inside of.
#[derive(Clone, Copy, Debug, Default)]
pub struct Inside {
    /// Number of times that it is inside of each medium, from the highest priority on.
    counts: [u8; MAX_MEDIA],
    /// The number of the material of glass without a priority: the last that the ray entered and did not leave.
    plain: Option<u32>,
}

impl Inside {
    /// The most that is counted.
    const MOST: u8 = 15;

    fn highest(self) -> Option<u8> {
        let place = self.counts.iter().position(|&count| count > 0)?;
        Some(place as u8)
    }

    fn with(mut self, place: u8, change: impl Fn(u8) -> u8) -> Self {
        let count = &mut self.counts[usize::from(place)];
        *count = change(*count);
        self
    }

    fn entered(self, place: u8) -> Self {
        self.with(place, |count| (count + 1).min(Self::MOST))
    }

    fn left(self, place: u8) -> Self {
        self.with(place, |count| count.saturating_sub(1))
    }

    /// Returns the glass behind a face that a ray crosses.
    pub fn beyond(self, scene: &Scene<'_>, boundary: Option<&Boundary>, hit: Crossed) -> Self {
        if let Some(boundary) = boundary {
            return boundary.beyond;
        }
        let Crossed { object, enters } = hit;
        let is_glass = scene.material(object).is_some_and(Material::is_glass);
        let own = Some(scene.material_number(object));
        let plain = match enters {
            _ if !is_glass => self.plain,
            true => own,
            false if self.plain == own => None,
            false => self.plain,
        };
        Self { plain, ..self }
    }

    /// Returns the material that fills a place, where no face says otherwise.
    pub fn material<'s>(self, scene: &Scene<'s>) -> Option<&'s Material> {
        let plain = self
            .plain
            .and_then(|number| scene.materials().get(number as usize));
        medium(scene, self.highest()).or(plain)
    }
}

/// A face that a ray crosses.
#[derive(Clone, Copy, Debug)]
pub struct Crossed {
    /// The object.
    pub object: u32,
    /// True if the ray enters it.
    pub enters: bool,
}

/// A face of a medium that a ray crosses.
#[derive(Clone, Copy, Debug)]
pub struct Boundary {
    from: Option<u8>,
    to: Option<u8>,
    /// The media that a ray on the far side is inside of.
    pub beyond: Inside,
}

impl Boundary {
    /// Returns the boundary of an object; `None` if it is not a medium.
    pub fn at(scene: &Scene<'_>, inside: Inside, object: u32, enters: bool) -> Option<Self> {
        let place = scene.place_among_media(object)?;
        let (near, beyond) = if enters {
            (inside, inside.entered(place))
        } else {
            // A ray that is not inside has begun there.
            let beyond = inside.left(place);
            (beyond.entered(place), beyond)
        };
        Some(Self {
            from: near.highest(),
            to: beyond.highest(),
            beyond,
        })
    }

    /// Returns whether different media fill the two sides.
    pub fn is_there(&self) -> bool {
        self.from != self.to
    }

    /// Returns the two media that meet there.
    pub fn interface<N: Enclosure>(&self, scene: &Scene<'_>) -> Option<Interface<N>> {
        let [from, to] = [self.from, self.to]
            .map(|place| medium(scene, place).map_or(1 << 30, |it| it.inverse_ior));
        let to_denser = to < from;
        let (less, more) = (from.min(to), from.max(to));
        let k = if less == more {
            N::one()
        } else {
            ratio_of::<N>(less).div(ratio_of(more))?
        };
        Some(Interface { k, to_denser })
    }
}

/// Returns the material that a ray or light came through to a face.
pub fn passed<'s>(
    scene: &Scene<'s>,
    boundary: Option<&Boundary>,
    inside: Inside,
    object: u32,
    enters: bool,
) -> Option<&'s Material> {
    let own = scene.material(object)?;
    let is_behind = own.is_glass() && !enters;
    let known = match boundary {
        Some(boundary) => medium(scene, boundary.from),
        None if is_behind => None,
        None => medium(scene, inside.highest()),
    };
    let plain = match is_behind {
        true => Some(own),
        false => inside
            .plain
            .and_then(|number| scene.materials().get(number as usize)),
    };
    known.or(plain)
}

fn medium<'s>(scene: &Scene<'s>, place: Option<u8>) -> Option<&'s Material> {
    let number = *scene.media().get(usize::from(place?))?;
    scene.materials().get(number as usize)
}
