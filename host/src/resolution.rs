//! Which objects are so small, for where they lie and what they touch, that a number format can lose
//! their contact shadows.
//!
//! A second surface at [`FACTOR`] error bounds' distance is met (see
//! [`Hit::error`](gridel_core::Hit::error)); so an object whose smallest feature is less than that may not
//! be distinguished from the surface that it touches.

use crate::shape::{Solid, Surface};
use glam::DVec3;
use gridel_core::{Format, Kind, Scene};
use serde::Serialize;

/// Distance, in error bounds, from which two surfaces are distinguished.
pub const FACTOR: f64 = 8.0;

/// Surfaces with the largest bounds that objects are held against.
const MOST_SURFACES: usize = 4096;

/// An object that some formats do not resolve.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Unresolved {
    pub object: u32,
    /// Its smallest feature, in scene units.
    pub feature: f64,
    pub formats: Vec<Coarse>,
    /// The formats that resolve it.
    pub resolved_by: Vec<&'static str>,
}

/// A format that does not resolve an object.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Coarse {
    pub format: &'static str,
    /// The largest error bound where the object lies, in scene units.
    pub bound: f64,
}

/// A box in units.
#[derive(Clone, Copy, Debug)]
struct Extent {
    lowest: DVec3,
    highest: DVec3,
}

impl Extent {
    const EMPTY: Self = Self {
        lowest: DVec3::INFINITY,
        highest: DVec3::NEG_INFINITY,
    };

    fn of(solid: &Solid) -> Self {
        if !solid.is_bounded() {
            // It is near whatever lies in the box of a scene.
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

    fn with(self, other: Self) -> Self {
        Self {
            lowest: self.lowest.min(other.lowest),
            highest: self.highest.max(other.highest),
        }
    }

    /// Returns whether two boxes are no farther apart than a length.
    fn is_near(&self, other: &Self, length: f64) -> bool {
        (self.lowest - length).cmple(other.highest).all()
            && (other.lowest - length).cmple(self.highest).all()
    }

    fn magnitude(&self) -> f64 {
        self.lowest.abs().max(self.highest.abs()).max_element()
    }
}

/// Returns the distance of a format's neighboring numbers at a place, in units.
fn step(format: Format, magnitude: f64) -> f64 {
    match format {
        Format::Fixed => f64::powi(2.0, -13),
        Format::F32 => f64::powi(2.0, -23) * magnitude,
        Format::F64 => f64::powi(2.0, -52) * magnitude,
    }
}

/// The error bound of a primitive's surface next to a place, as the table of `Hit::error` has it.
fn bound(format: Format, solid: &Solid, place: DVec3) -> f64 {
    let u = 0.5 * step(format, 1.0);
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

/// The objects that `fixed` or `f32` does not resolve, in scene-file order.
///
/// Takes time for every primitive, and more only where features are some 2^-16 of the scene.
///
/// ```
/// # use gridel_host::compile::{Options, compile};
/// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
/// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// # let blob = compile(&imported.scene, &Options::default())?.blob;
/// # let scene = blob.scene()?;
/// assert!(gridel_host::resolution::unresolved(&scene).is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn unresolved(scene: &Scene<'_>) -> Vec<Unresolved> {
    let mut objects: Vec<(Extent, Option<f64>)> = Vec::new();
    let mut surfaces = Vec::new();
    for kind in Kind::ALL {
        for slot in 0..scene.count(kind) {
            let Some(geometry) = scene.geometry(kind, slot) else {
                continue;
            };
            let solid = Solid::of(geometry);
            let extent = Extent::of(&solid);
            let object = scene.object(scene.primitive(kind, slot as u32)) as usize;
            if objects.len() <= object {
                objects.resize(object + 1, (Extent::EMPTY, None));
            }
            let (whole, smallest) = &mut objects[object];
            *whole = whole.with(extent);
            *smallest = match (*smallest, solid.feature()) {
                (Some(a), Some(b)) => Some(a.min(b)),
                (a, b) => a.or(b),
            };
            let most = Format::ALL
                .into_iter()
                .flat_map(|format| {
                    let ends = [extent.lowest, extent.highest];
                    ends.map(|place| bound(format, &solid, place))
                })
                .fold(0.0, f64::max);
            if most > 0.0 {
                surfaces.push((most, extent, solid));
            }
        }
    }
    surfaces.sort_by(|a, b| b.0.total_cmp(&a.0));
    surfaces.truncate(MOST_SURFACES);
    let unit = f64::powi(2.0, scene.header().unit_exponent.into());
    let found = objects
        .iter()
        .enumerate()
        .filter_map(|(object, (whole, feature))| {
            if whole.lowest.x > whole.highest.x {
                return None;
            }
            // A mesh may be flat: then its other sides count.
            let mut sides = (whole.highest - whole.lowest).to_array();
            sides.sort_by(f64::total_cmp);
            let feature = feature.unwrap_or(sides[1]);
            let near = surfaces
                .iter()
                .take_while(|(most, ..)| FACTOR * most > feature)
                .filter(|(_, extent, _)| extent.is_near(whole, feature));
            let near: Vec<_> = near.collect();
            let place = 0.5 * (whole.lowest + whole.highest);
            let worst = |format| {
                near.iter()
                    .map(|(_, extent, solid)| {
                        bound(format, solid, place.clamp(extent.lowest, extent.highest))
                    })
                    .fold(step(format, whole.magnitude()), f64::max)
            };
            let (coarse, fine): (Vec<_>, Vec<_>) = Format::ALL
                .into_iter()
                .map(|format| (format, worst(format)))
                .partition(|(_, bound)| FACTOR * bound > feature);
            (!coarse.is_empty()).then(|| Unresolved {
                object: object as u32,
                feature: feature * unit,
                formats: coarse
                    .into_iter()
                    .map(|(format, bound)| Coarse {
                        format: format.name(),
                        bound: bound * unit,
                    })
                    .collect(),
                resolved_by: fine.into_iter().map(|(format, _)| format.name()).collect(),
            })
        });
    found.collect()
}
