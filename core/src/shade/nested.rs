//! Nested dielectrics: glass that overlaps other glass, such as a drink in a tumbler. The medium with the highest
//! priority fills the space that both occupy.
//!
//! Surfaces of the other media are ignored within it: a ray goes straight on, which counts as a bounce, and so does
//! light. At the remaining surfaces a ray is refracted from the medium on one side to that on the other. So a drink can
//! reach into the wall of its tumbler, without a gap between them and without a face that both claim. Source: Schmidt
//! and Budge, "Simple Nested Dielectrics in Ray Traced Images", 2002.
//!
//! Rays from the camera, and those of the caller's own, begin outside all media. If such a ray hits a face from within,
//! it was inside that medium. Glass without a priority behaves as elsewhere: relative to its surroundings.
//!
//! A waiting ray needs four more bytes: how often it is inside each medium. Functions are out of line, because copies
//! of them take more code than the calls.

use crate::accel::Number;
use crate::format::Effects;
use crate::format::limits::{MAX_MEDIA, NESTED};
use crate::format::record::Material;
use crate::observe::count::Observer;
use crate::observe::event::Event;
use crate::query::Hit;
use crate::ray::Ray;
use crate::scene::Scene;
use crate::shade::Color;
use crate::shade::effect::{Effect, Tracer};
use crate::shade::surface::{Arrival, Filter, Interface, Reach, Secondary, Surface};

pub(crate) struct Nested;

impl Effect for Nested {
    type State<N: Number> = Inside;

    const EFFECT: Effects = Effects::NESTED;
    const FILTERS: bool = true;
    const PASSES: bool = true;

    #[inline(always)]
    fn arrive<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        inside: &mut Inside,
        _: &Ray<N>,
        arrival: &mut Arrival<'s, '_, N>,
    ) {
        let scene = tracer.scene();
        if !scene.media().is_empty() {
            arrival.medium = passed(scene, *inside, arrival.hit.object, arrival.hit.front);
        }
    }

    #[inline(always)]
    fn surface<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        inside: &mut Inside,
        _: &Ray<N>,
        surface: &mut Surface<'_, N>,
    ) {
        let (scene, hit) = (tracer.scene(), surface.hit);
        if scene.media().is_empty() {
            return;
        }
        if X::Observer::ENABLED
            && let Some(boundary) = Boundary::at(scene, *inside, hit.object, hit.front)
        {
            let media = [boundary.from, boundary.to].map(|place| medium_number(scene, place));
            tracer.count().event(Event::Boundary { media });
        }
        match face_at(scene, *inside, hit.object, hit.front) {
            Face::Other => {}
            Face::There(interface) => surface.interface = Some(interface),
            Face::Hidden => {
                surface.material = &NOTHING;
                surface.required = Effects::NONE;
                surface.diffuse = Color::BLACK;
                surface.passing = surface.weight;
                surface.weight = Color::BLACK;
            }
        }
    }

    #[inline(always)]
    fn filter<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        inside: &mut Inside,
        _: &Ray<N>,
        filter: &mut Filter<'s, '_, N>,
    ) {
        let scene = tracer.scene();
        if !scene.media().is_empty() {
            pass(scene, inside, filter);
        }
    }

    #[inline(always)]
    fn reach<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        inside: &mut Inside,
        reach: &mut Reach<'s, N>,
    ) {
        let scene = tracer.scene();
        if !scene.media().is_empty() {
            reach.medium = medium(scene, inside.highest());
        }
    }

    #[inline(always)]
    fn leave<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        inside: &mut Inside,
        hit: &Hit<N>,
        secondary: &mut Secondary<N>,
    ) {
        let scene = tracer.scene();
        if secondary.outward != hit.front && !scene.media().is_empty() {
            *inside = beyond(scene, *inside, hit.object, hit.front);
        }
    }
}

/// The material of the medium that a ray passed on its way to a face.
#[inline(never)]
fn passed<'s>(
    scene: &'s Scene<'s>,
    inside: Inside,
    object: u32,
    enters: bool,
) -> Option<&'s Material> {
    let place = match Boundary::at(scene, inside, object, enters) {
        Some(boundary) => boundary.from,
        None => around(scene, inside, object, enters),
    };
    medium(scene, place)
}

/// The medium before a face that belongs to no medium: within other glass it is that glass.
#[inline(always)]
fn around(scene: &Scene<'_>, inside: Inside, object: u32, enters: bool) -> Option<u8> {
    let material = scene.material(object);
    let is_glass = material.is_some_and(Material::is_glass);
    if is_glass && !enters {
        return None;
    }
    inside.highest()
}

/// The media that a ray is inside of behind a face that it crosses.
#[inline(never)]
fn beyond(scene: &Scene<'_>, inside: Inside, object: u32, enters: bool) -> Inside {
    let boundary = Boundary::at(scene, inside, object, enters);
    boundary.map_or(inside, |boundary| boundary.beyond)
}

/// A face that a ray hits.
enum Face<N> {
    /// A face that belongs to no medium.
    Other,
    There(Interface<N>),
    /// A face within a medium with a higher priority.
    Hidden,
}

/// Returns the face at which a ray enters an object or leaves it.
#[inline(never)]
fn face_at<N: Number>(scene: &Scene<'_>, inside: Inside, object: u32, enters: bool) -> Face<N> {
    match Boundary::at(scene, inside, object, enters) {
        None => Face::Other,
        Some(boundary) if boundary.is_there() => Face::There(boundary.interface(scene)),
        Some(_) => Face::Hidden,
    }
}

/// Passes light through a surface.
#[inline(never)]
fn pass<'s, N: Number>(scene: &'s Scene<'s>, inside: &mut Inside, filter: &mut Filter<'s, '_, N>) {
    let (object, enters) = (filter.hit.object, filter.hit.front);
    let Some(boundary) = Boundary::at(scene, *inside, object, enters) else {
        filter.medium = medium(scene, around(scene, *inside, object, enters));
        return;
    };
    filter.medium = medium(scene, boundary.from);
    if boundary.is_there() {
        filter.interface = Some(boundary.interface(scene));
    } else {
        filter.material = &NOTHING;
        filter.passes = true;
    }
    *inside = boundary.beyond;
}

/// The surface that replaces one within a medium of a higher priority.
static NOTHING: Material = Material {
    diffuse: [0; 3],
    odd: [0; 3],
    checker_size: 0,
    checker_origin: [0; 3],
    highlight: [0; 3],
    mirror: [0; 3],
    transmit: [0; 3],
    inverse_ior: 1 << 30,
    absorption: [0; 3],
    shininess: 1,
    maps: 0,
};

/// Number of times that a ray is inside each medium, at most 15: four bits each, from the highest priority on. It is
/// stored as bytes to fill gaps next to other states.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Inside([u8; 4 * NESTED as usize]);

const _: () = assert!(MAX_MEDIA * 4 <= u32::BITS as usize);

impl Inside {
    #[inline(always)]
    fn counts(self) -> u32 {
        let mut bytes = [0; 4];
        for (byte, own) in bytes.iter_mut().zip(self.0) {
            *byte = own;
        }
        u32::from_le_bytes(bytes)
    }

    /// The medium that fills the place: the one with the highest priority among those that the ray is inside of.
    #[inline(always)]
    fn highest(self) -> Option<u8> {
        let counts = self.counts();
        (counts != 0).then(|| (counts.trailing_zeros() / 4) as u8)
    }

    /// Counts an entry into a medium, up to the maximum.
    fn entered(self, place: u8) -> Self {
        self.with(place, |count| {
            if count < 15 {
                count.wrapping_add(1)
            } else {
                15
            }
        })
    }

    /// Counts an exit from a medium. A ray that was not inside it has begun in it.
    fn left(self, place: u8) -> Self {
        self.with(place, |count| count.saturating_sub(1))
    }

    #[inline(always)]
    fn with(mut self, place: u8, change: impl Fn(u32) -> u32) -> Self {
        let (counts, shift) = (self.counts(), 4 * u32::from(place));
        let count = counts.wrapping_shr(shift) & 15;
        let flipped = (count ^ change(count)).wrapping_shl(shift);
        for (own, byte) in self.0.iter_mut().zip((counts ^ flipped).to_le_bytes()) {
            *own = byte;
        }
        self
    }
}

/// A surface of a medium that a ray crosses.
struct Boundary {
    /// The medium that fills the near side; `None` for the surroundings.
    from: Option<u8>,
    /// The medium that fills the far side; `None` for the surroundings.
    to: Option<u8>,
    /// The media that a ray on the far side is inside of.
    beyond: Inside,
}

impl Boundary {
    /// The medium of an object; `None` if it is no medium.
    #[inline(always)]
    fn at(scene: &Scene<'_>, inside: Inside, object: u32, enters: bool) -> Option<Self> {
        let place = scene.place_among_media(object)?;
        Some(Self::of(place, enters, inside))
    }

    fn of(place: u8, enters: bool, inside: Inside) -> Self {
        let (near, beyond) = if enters {
            (inside, inside.entered(place))
        } else {
            let beyond = inside.left(place);
            (beyond.entered(place), beyond)
        };
        Self {
            from: near.highest(),
            to: beyond.highest(),
            beyond,
        }
    }

    /// Returns true if the media differ.
    #[inline(always)]
    fn is_there(&self) -> bool {
        self.from != self.to
    }

    #[inline(always)]
    fn interface<N: Number>(&self, scene: &Scene<'_>) -> Interface<N> {
        let [from, to] = [self.from, self.to].map(|place| {
            // Limited to the range for blobs that are not proved.
            let inverse = medium(scene, place).map_or(1 << 30, |medium| medium.inverse_ior);
            inverse.clamp(1 << 28, 1 << 30)
        });
        let to_denser = to < from;
        let [less, more] = if to_denser { [to, from] } else { [from, to] };
        let k = if less == more {
            N::ONE
        } else {
            N::ratio(less).div(N::ratio(more))
        };
        Interface { k, to_denser }
    }
}

/// The material of a medium, given by its place.
#[inline(always)]
fn medium<'s>(scene: &'s Scene<'s>, place: Option<u8>) -> Option<&'s Material> {
    let number = medium_number(scene, place)?;
    scene.materials().get(number as usize)
}

#[inline(always)]
fn medium_number(scene: &Scene<'_>, place: Option<u8>) -> Option<u32> {
    scene.media().get(usize::from(place?)).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_end_where_they_can_and_do_not_touch_others() {
        for place in 0..MAX_MEDIA as u8 {
            let mut inside = (0..MAX_MEDIA as u8).fold(Inside::default(), Inside::entered);
            for _ in 0..20 {
                inside = inside.entered(place);
            }
            assert_eq!(inside.counts().count_ones(), MAX_MEDIA as u32 + 3);
            for _ in 0..20 {
                inside = inside.left(place);
            }
            assert_eq!(inside.counts().count_ones(), MAX_MEDIA as u32 - 1);
            assert_eq!(inside.highest(), Some(u8::from(place == 0)));
        }
        assert_eq!(Inside::default().highest(), None);
    }

    #[test]
    fn faces_are_there_where_media_differ() {
        let outside = Inside::default();
        let enter = Boundary::of(3, true, outside);
        assert_eq!((enter.from, enter.to), (None, Some(3)));
        // Of a lower priority within.
        let hidden = Boundary::of(5, true, enter.beyond);
        assert!(!hidden.is_there());
        // The upper one ends, and the lower one appears.
        let appears = Boundary::of(3, false, hidden.beyond);
        assert_eq!((appears.from, appears.to), (Some(3), Some(5)));
        let out = Boundary::of(5, false, appears.beyond);
        assert_eq!((out.from, out.to), (Some(5), None));
        assert_eq!(out.beyond.counts(), 0);
        // A ray that began within.
        let began = Boundary::of(3, false, outside);
        assert_eq!((began.from, began.to), (Some(3), None));
    }
}
