//! The choice of a scene's integer coordinates: see [`gridel_core::Position`].

use crate::scene::Light;
use crate::shape::{Lattice, exp2};
use bytemuck::Zeroable;
use glam::DVec3;
use gridel_core::Position;
use gridel_core::format::limits::MAX_COORDINATE_SHIFT;
use gridel_core::format::record::Header;

/// Ratio of the reach of coordinates to that of the scene and its eye, so that both can move.
const ROOM: f64 = 4.0;

/// Greatest exponent of the power of two by which the step may be coarser for coordinates from the scene's own origin.
const COARSER: u8 = 4;

/// Scene coordinates as integers.
#[derive(Clone, Copy, Debug)]
pub struct Coordinates {
    /// The fields of a blob's header that state it; the others are 0.
    pub header: Header,
}

impl Coordinates {
    /// Chooses the finest step of which the scene's box, the eye, the lights and the positions on their paths are few
    /// enough multiples. They are counted from the scene's own origin where that costs little precision, otherwise from
    /// the lattice's.
    pub fn choose(
        lattice: &Lattice,
        bounds: [DVec3; 2],
        eye: DVec3,
        lights: &[Light],
        ways: &[DVec3],
    ) -> Self {
        let lights = lights.iter().filter_map(|light| match *light {
            Light::Point { position, .. } => Some(position),
            Light::Directional { .. } => None,
        });
        let ways = ways.iter().copied();
        let still = bounds.into_iter().chain([eye]).chain(lights);
        let places: Vec<DVec3> = still.chain(ways).collect();
        // Returns the smallest shift at which all places, counted from `origin`, are few enough multiples. The largest
        // shift leaves less room.
        let shift = |origin: DVec3| {
            let far = places
                .iter()
                .map(|&place| (place - origin).abs().max_element());
            let far = far.fold(0.0, f64::max) / lattice.unit();
            let reach = |shift: u8| exp2(31 - 13 + i32::from(shift));
            let roomy = (0..MAX_COORDINATE_SHIFT).find(|&shift| far * ROOM < reach(shift));
            let last = (far <= reach(MAX_COORDINATE_SHIFT)).then_some(MAX_COORDINATE_SHIFT);
            roomy.or(last)
        };
        let from_scene = shift(DVec3::ZERO);
        // The compiler rejects what lies farther from the lattice.
        let from_lattice = shift(lattice.origin).unwrap_or(MAX_COORDINATE_SHIFT);
        let own = from_scene.filter(|&shift| shift <= from_lattice + COARSER);
        Self {
            header: Header {
                unit_exponent: lattice.unit_exponent,
                origin: lattice.origin.to_array(),
                coordinate_shift: own.unwrap_or(from_lattice),
                counted_from: own.is_some().into(),
                ..Header::zeroed()
            },
        }
    }

    /// Returns the length of a coordinate step in scene units.
    pub fn step(&self) -> f64 {
        exp2(self.header.coordinate_exponent())
    }
}

/// Returns the nearest place in a scene's integer coordinates; `None` where they do not reach it.
pub fn position(header: &Header, place: DVec3) -> Option<Position> {
    let origin = DVec3::from_array(header.coordinate_origin());
    let steps = ((place - origin) / exp2(header.coordinate_exponent())).round();
    // The farthest place of all is one step beyond the last coordinate, which is used for it.
    let reach = -f64::from(i32::MIN);
    (steps.abs().max_element() <= reach).then(|| Position(steps.to_array().map(|x| x as i32)))
}
