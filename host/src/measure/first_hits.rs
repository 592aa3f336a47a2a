//! The first hits of the rays through the middles of pixels.

use crate::render::chosen;
use gridel_core::accel::DynAccel;
use gridel_core::format::limits::MAX_STACK_DEPTH;
use gridel_core::render::RenderError;
use gridel_core::{
    Effects, Fixed, Format, NoCount, Number, Renderer, Scene, Settings, Stack, Structure,
    closest_hit,
};
use serde::{Deserialize, Serialize};

/// What the ray through the middle of a pixel hits.
///
/// Serialized as `[object, distance]`, and as `[object, distance, instance]` in an instance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "Fields", into = "Fields")]
pub struct FirstHit {
    pub object: u32,
    /// The number of the instance that the object is in, in the order of the scene file.
    pub instance: Option<u32>,
    /// In scene units.
    pub distance: f64,
}

#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Fields {
    Placed(u32, f64, u32),
    Own(u32, f64),
}

impl From<Fields> for FirstHit {
    fn from(fields: Fields) -> Self {
        let (object, distance, instance) = match fields {
            Fields::Placed(object, distance, instance) => (object, distance, Some(instance)),
            Fields::Own(object, distance) => (object, distance, None),
        };
        Self {
            object,
            instance,
            distance,
        }
    }
}

impl From<FirstHit> for Fields {
    fn from(hit: FirstHit) -> Self {
        match hit.instance {
            Some(instance) => Self::Placed(hit.object, hit.distance, instance),
            None => Self::Own(hit.object, hit.distance),
        }
    }
}

impl FirstHit {
    /// Returns whether both hit the same object, of the same instance.
    pub fn is_on(&self, other: &Self) -> bool {
        (self.object, self.instance) == (other.object, other.instance)
    }
}

/// The first hit of each pixel; `None` on a miss.
///
/// # Errors
/// If the settings are out of their range, or the scene does not hold the structure.
pub fn first_hits(
    scene: &Scene<'_>,
    (structure, format): (Structure, Format),
    settings: Settings,
) -> Result<Vec<Option<FirstHit>>, RenderError> {
    let scene = &chosen(scene, structure)?;
    match format {
        Format::Fixed => first_hits_in::<Fixed>(scene, settings),
        Format::F32 => first_hits_in::<f32>(scene, settings),
        Format::F64 => first_hits_in::<f64>(scene, settings),
    }
}

fn first_hits_in<N: Number>(
    scene: &Scene<'_>,
    settings: Settings,
) -> Result<Vec<Option<FirstHit>>, RenderError> {
    let renderer = Renderer::<N, DynAccel, { Effects::ALL.0 }>::with_settings(scene, settings)?;
    let unit = f64::powi(2.0, scene.header().unit_exponent.into());
    let mut stack = Stack::<MAX_STACK_DEPTH>::new();
    let mut first = |x: u16, y: u16| {
        let ray = renderer.primary_ray(x, y).ok()?;
        let hit = closest_hit::<N, DynAccel, _>(scene, &ray, stack.as_view(), &mut NoCount)?;
        let slope = ray.slope().map(N::ratio_to_f64);
        let norm = slope.iter().map(|x| x * x).sum::<f64>().sqrt();
        // The place in the blob depends on the lattice, and the number does not.
        let index = hit.instance();
        let instance = index.and_then(|index| scene.instances().get(index as usize));
        Some(FirstHit {
            object: hit.object,
            instance: instance.map(|instance| instance.number),
            distance: N::far_to_f64(hit.t) * norm * unit,
        })
    };
    let places = (0..settings.height).flat_map(|y| (0..settings.width).map(move |x| (x, y)));
    Ok(places.map(|(x, y)| first(x, y)).collect())
}
