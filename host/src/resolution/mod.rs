//! Finds objects so small, for their position and their neighbors, that a number format can lose their contact shadows.
//!
//! A ray hits a second surface if it is at least [`FACTOR`] error bounds away (see
//! [`Hit::error`](gridel_core::Hit::error)). So an object whose smallest feature is smaller may not be distinguished
//! from the surface that it touches.
//!
//! Objects of parts are examined where instances place them. Their surfaces have the error bounds that apply there,
//! because the maps of instances round as well.

mod bound;
mod largest;
mod placed;

use crate::shape::{ExactMap, Solid};
use bound::{Extent, bound, placed_bound, spacing};
use gridel_core::{Format, Kind, Scene};
use largest::Largest;
use placed::Placed;
use serde::Serialize;

/// Distance, in error bounds, from which two surfaces are distinguished.
pub const FACTOR: f64 = 8.0;

/// Placed primitives that are examined: those of the farthest instances, whose bounds are the largest. The last of
/// these instances may exceed the number.
const MOST_PLACED: usize = 1 << 18;

/// An object that some formats do not resolve.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Unresolved {
    pub object: u32,
    /// The number, in scene-file order, of the instance that places it; `None` for one of the scene's own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub instance: Option<u32>,
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

/// The objects of a scene or of a part, in units of its own.
#[derive(Default)]
struct Content {
    objects: Vec<Object>,
    /// The number of its surfaces.
    surfaces: usize,
}

/// An object.
#[derive(Clone, Copy)]
struct Object {
    number: u32,
    instance: Option<u32>,
    extent: Extent,
    feature: f64,
}

/// The surfaces of a scene or of a part, in units of its own, and the number of each in scene-file order.
fn surfaces<'c>(content: &'c Scene<'_>) -> impl Iterator<Item = (u32, Solid)> + 'c {
    Kind::ALL.into_iter().flat_map(move |kind| {
        (0..content.count(kind)).filter_map(move |slot| {
            let solid = Solid::of(content.geometry(kind, slot)?);
            Some((content.primitive(kind, slot as u32), solid))
        })
    })
}

impl Content {
    /// The content of a scene or of one of its parts, whose first primitive is given. The numbers of objects are those
    /// of the whole scene.
    fn of(content: &Scene<'_>, whole: &Scene<'_>, first_primitive: u32) -> Self {
        let first_object = whole.object(first_primitive);
        let mut count = 0;
        let mut found: Vec<(Extent, Option<f64>)> = Vec::new();
        for (primitive, solid) in surfaces(content) {
            let object = whole.object(first_primitive.saturating_add(primitive));
            let object = object.saturating_sub(first_object) as usize;
            if found.len() <= object {
                found.resize(object + 1, (Extent::EMPTY, None));
            }
            let (around, smallest) = &mut found[object];
            *around = around.with(Extent::of(&solid));
            *smallest = match (*smallest, solid.feature().filter(|it| *it > 0.0)) {
                (Some(a), Some(b)) => Some(a.min(b)),
                (a, b) => a.or(b),
            };
            count += 1;
        }
        let objects = (first_object..).zip(found);
        let objects = objects.filter(|(_, (extent, _))| extent.lowest.x <= extent.highest.x);
        let object = |(number, (extent, feature)): (u32, (Extent, Option<f64>))| {
            // A mesh may be flat: then its other sides count.
            let mut sides = (extent.highest - extent.lowest).to_array();
            sides.sort_by(f64::total_cmp);
            Object {
                number,
                instance: None,
                extent,
                feature: feature.unwrap_or(sides[1]),
            }
        };
        Self {
            objects: objects.map(object).collect(),
            surfaces: count,
        }
    }
}

/// The largest error bounds of a surface in each format, without those of an instance.
fn bounds(solid: &Solid, extent: &Extent) -> [f64; Format::ALL.len()] {
    Format::ALL.map(|format| {
        let ends = [extent.lowest, extent.highest];
        let bounds = ends.map(|place| bound(format, solid, place));
        bounds[0].max(bounds[1])
    })
}

impl Object {
    /// The smallest error bound that counts where the object lies.
    fn least(&self, format: Format, map: Option<&ExactMap>) -> f64 {
        let magnitude = self.extent.magnitude();
        match map {
            None => spacing(format, magnitude),
            Some(map) => {
                let reach = self.extent.reach(map);
                let in_part = spacing(format, map.own_length(reach));
                placed_bound(format, map, in_part, [reach, magnitude])
            }
        }
    }

    /// Names the formats that do not distinguish the object from these surfaces, the largest bounds first.
    fn unresolved(
        &self,
        map: Option<&ExactMap>,
        surfaces: &[Placed<'_>],
        unit: f64,
    ) -> Option<Unresolved> {
        let (feature, extent) = (self.feature, &self.extent);
        let near = surfaces
            .iter()
            .take_while(|it| FACTOR * it.most > feature)
            .filter(|it| it.extent.is_near(extent, feature));
        let near: Vec<_> = near.collect();
        let worst = |format| {
            let bounds = near.iter().map(|it| it.bound(format, extent));
            bounds.fold(self.least(format, map), f64::max)
        };
        let (coarse, fine): (Vec<_>, Vec<_>) = Format::ALL
            .into_iter()
            .map(|format| (format, worst(format)))
            .partition(|(_, bound)| FACTOR * bound > feature);
        (!coarse.is_empty()).then(|| Unresolved {
            object: self.number,
            instance: self.instance,
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
    }
}

/// An instance, its map, and where it lies.
struct InstanceExtent {
    number: u32,
    part: usize,
    map: ExactMap,
    extent: Extent,
}

/// The instances of a scene that have something in them, the farthest first, until they hold `most` primitives.
fn farthest(scene: &Scene<'_>, parts: &[Content], most: usize) -> Vec<InstanceExtent> {
    let instances = scene.instances().iter().filter_map(|instance| {
        let part = usize::from(instance.part);
        let objects = parts.get(part)?.objects.iter();
        let whole = objects.map(|it| it.extent).reduce(Extent::with)?;
        let map = ExactMap::of(instance);
        Some(InstanceExtent {
            number: instance.number,
            part,
            extent: whole.placed(&map),
            map,
        })
    });
    let mut instances: Vec<_> = instances.collect();
    instances.sort_by(|a, b| {
        let by_distance = b.extent.magnitude().total_cmp(&a.extent.magnitude());
        by_distance.then(a.number.cmp(&b.number))
    });
    let mut placed = 0;
    let looked_at = instances.iter().take_while(|it| {
        let is_in = placed < most;
        placed += parts[it.part].surfaces;
        is_in
    });
    let count = looked_at.count();
    instances.truncate(count);
    instances
}

/// Returns the objects that `fixed` or `f32` does not distinguish, in scene-file order: the scene's own ones, then
/// those of each instance.
///
/// Takes time for every primitive, and more only where features are some 2^-16 of the scene. Takes memory for every
/// object, and for no more than 2^13 surfaces. Instances are examined from the farthest on, until they hold 2^18
/// primitives. Objects and surfaces of nearer ones are skipped.
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
    let own = Content::of(scene, scene, 0);
    let parts = scene.parts().iter().enumerate();
    let parts = parts.map(|(number, part)| {
        let first = scene.first_primitive_of_part(number);
        first.map_or_else(Content::default, |first| Content::of(part, scene, first))
    });
    let parts: Vec<_> = parts.collect();
    let instances = farthest(scene, &parts, MOST_PLACED);
    let surfaces = largest(scene, &instances);
    let unit = f64::powi(2.0, scene.header().unit_exponent.into());
    let own = own.objects.iter();
    let mut found: Vec<_> = own
        .filter_map(|object| object.unresolved(None, &surfaces, unit))
        .collect();
    let own = found.len();
    for InstanceExtent {
        number, part, map, ..
    } in &instances
    {
        let objects = parts[*part].objects.iter().map(|object| Object {
            instance: Some(*number),
            extent: object.extent.placed(map),
            feature: map.length(object.feature),
            ..*object
        });
        found.extend(objects.filter_map(|it| it.unresolved(Some(map), &surfaces, unit)));
    }
    found[own..].sort_by_key(|it| (it.instance, it.object));
    found
}

/// The surfaces with the largest bounds, these first.
fn largest<'c>(scene: &Scene<'_>, instances: &'c [InstanceExtent]) -> Vec<Placed<'c>> {
    let mut largest = Largest::default();
    for (number, (_, solid)) in surfaces(scene).enumerate() {
        let extent = Extent::of(&solid);
        let most = bounds(&solid, &extent).into_iter().fold(0.0, f64::max);
        if most > 0.0 {
            let placed = Placed {
                most,
                extent,
                solid,
                map: None,
            };
            largest.add((0, number), placed);
        }
    }
    let mut placements = vec![Vec::new(); scene.parts().len()];
    for (rank, instance) in (1..).zip(instances) {
        placements[instance.part].push((rank, &instance.map));
    }
    for (content, placements) in scene.parts().iter().zip(placements) {
        if placements.is_empty() {
            continue;
        }
        for (number, (_, solid)) in surfaces(content).enumerate() {
            let own = Extent::of(&solid);
            let bounds = bounds(&solid, &own);
            for &(rank, map) in &placements {
                let extent = own.placed(map);
                let place = [extent.reach(map), extent.magnitude()];
                let bounds = Format::ALL.into_iter().zip(bounds).map(|(format, bound)| {
                    let in_part = bound.max(spacing(format, own.magnitude()));
                    placed_bound(format, map, in_part, place)
                });
                let placed = Placed {
                    most: bounds.fold(0.0, f64::max),
                    extent,
                    solid: solid.clone(),
                    map: Some(map),
                };
                largest.add((rank, number), placed);
            }
        }
    }
    largest.sorted()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::{Options, compile};
    use crate::scene::{ImportOptions, read};

    #[test]
    fn farthest_instances_come_first_and_are_bounded() {
        let mut file = String::from("[[part]]\nname = 'p'\nobject = [\n");
        for x in 0..3 {
            file += &format!("{{ kind = 'sphere', center = [{x}, 0, 0], radius = 0.5 }},\n");
        }
        file += "]\n";
        for x in [20, -90, 5, 60] {
            file += &format!("[[instance]]\npart = 'p'\ntranslate = [{x}, 0, 0]\n");
        }
        // The middle of the lattice is that of the scene's box, here the origin.
        file += "[[object]]\nkind = 'box'\nmin = [-100, -1, -1]\nmax = [100, 1, 1]\n";
        let imported = read("a.toml".as_ref(), file.into(), &ImportOptions::default()).unwrap();
        let blob = compile(&imported.scene, &Options::default()).unwrap().blob;
        let scene = blob.scene().unwrap();
        let parts = [Content::of(
            &scene.parts()[0],
            &scene,
            scene.first_primitive_of_part(0).unwrap(),
        )];
        assert_eq!(parts[0].objects.len(), 3);
        for (most, expected) in [
            (0, &[][..]),
            (1, &[1]),
            (3, &[1]),
            (4, &[1, 3]),
            (9, &[1, 3, 0]),
            (100, &[1, 3, 0, 2]),
        ] {
            let found = farthest(&scene, &parts, most);
            let numbers: Vec<u32> = found.iter().map(|it| it.number).collect();
            assert_eq!(numbers, expected, "{most}");
        }
    }
}
