//! Contact shadows: what lies in the dark by `f64`, and what another format says of it.

use super::ask::ask;
use super::leave::depart;
use super::placed::PLACED;
use super::property::{Fault, Property, Tested};
use super::rounded::{HitId, RoundedRay};
use crate::random::Random;
use crate::shape::rounding::step;
use crate::shape::{ExactMap, Solid};
use crate::trace::UnitRay;
use glam::DVec3;
use gridel_core::format::instance::Instance;
use gridel_core::format::record::Light;
use gridel_core::{Effects, Format, Hit, Kind, List, Number, Ray, Scene, Structure};

/// Returns a ray at a place that an object keeps a light from: from somewhere above the place, in units. `None`
/// where what was chosen at random throws its shadow on nothing.
pub fn at_a_shadow(scene: &Scene<'_>, random: &mut Random) -> Option<UnitRay> {
    if !scene.effects().contains(Effects::SHADOW) || scene.lights().is_empty() {
        return None;
    }
    let (held_by, placed) = anywhere(scene, random)?;
    let count = |kind| held_by.count(kind);
    let mut slot = random.below(Kind::ALL.into_iter().map(count).sum::<usize>().max(1));
    let kind = Kind::ALL.into_iter().find(|&kind| {
        let is_here = slot < count(kind);
        if !is_here {
            slot -= count(kind);
        }
        is_here
    })?;
    let own = held_by.primitive(kind, slot as u32);
    let from = Solid::of(held_by.geometry(kind, slot)?)
        .point(DVec3::from_array(random.direction()), random);
    let (id, from) = match placed {
        None => (HitId::own(own), from),
        Some((instance, record)) => {
            let id = HitId {
                primitive: own + scene.first_primitive_of_part(record.part.into())?,
                instance: Some(instance),
            };
            let place = ExactMap::of(record).back(from.to_array());
            (id, DVec3::from_array(place))
        }
    };
    let light = &scene.lights()[random.below(scene.lights().len())];
    let travel = -to_light(scene, light, from)?;
    // A point behind the object as the light sees it.
    let mut ray = UnitRay::new(from.to_array(), travel.to_array());
    let hit = (0..8).find_map(|_| {
        let hit = ask::<f64, List>(scene, &ray.ready::<f64>(scene)?).hit?;
        if HitId::of(&hit) != id {
            return Some(Some(hit));
        }
        ray.tmin = hit.t + 4.0 * step(Format::F32, hit.t.max(1.0));
        None
    })??;
    let place = DVec3::from_array(hit.point);
    let normal = DVec3::from_array(hit.normal);
    let towards = if normal.dot(travel) > 0.0 {
        -normal
    } else {
        normal
    };
    let aside = DVec3::from_array(random.direction());
    let away = (place.distance(from) + 1.0 / 256.0) * random.magnitude(0.5, 8.0);
    let eye = place + away * (towards + 0.9 * aside);
    Some(UnitRay::new(eye.to_array(), (place - eye).to_array()))
}

/// The scene's own objects, or a part, and which instance it is of.
fn anywhere<'s>(
    scene: &'s Scene<'_>,
    random: &mut Random,
) -> Option<(&'s Scene<'s>, Option<(u32, &'s Instance)>)> {
    let instances = scene.instances();
    let own = usize::from(Kind::ALL.into_iter().any(|kind| scene.count(kind) > 0));
    let chosen = random.below((instances.len() + own).max(1));
    let Some(instance) = instances.get(chosen) else {
        return Some((scene, None));
    };
    let part = scene.parts().get(usize::from(instance.part))?;
    Some((part, Some((chosen as u32, instance))))
}

/// Returns whether a light is infinitely far.
fn is_far(light: &Light) -> bool {
    matches!(light.kind, Light::DIRECTIONAL | Light::SUN)
}

/// The way from a point to a light, or to the middle of the sun; `None` for the map of an environment, which is
/// everywhere.
fn to_light(scene: &Scene<'_>, light: &Light, from: DVec3) -> Option<DVec3> {
    let vector = DVec3::from_array(light.vector.map(|x| x as f64 / 8192.0));
    let way = match light.kind {
        Light::DIRECTIONAL => vector,
        Light::SUN => DVec3::from_array(scene.environment()?.sun_direction.map(f64::from)),
        Light::ENVIRONMENT => return None,
        _ => vector - from,
    };
    (way != DVec3::ZERO).then_some(way)
}

/// Returns the nearest opaque primitive between a hit and a light, seen from where a ray leaves the hit.
fn blocker<N: Number>(scene: &Scene<'_>, light: &Light, from: DVec3) -> Option<Hit<N>> {
    let way = to_light(scene, light, from)?;
    let reach = if is_far(light) {
        f64::INFINITY
    } else {
        way.abs().max_element()
    };
    let ray = Ray::<N>::from_f64(scene.bounds(), from.to_array(), way.to_array(), 0.0, reach);
    ask::<N, List>(scene, &ray.ok()?).hit
}

/// Roundings of a shadow ray on its way past the edge of the object that casts the shadow.
const ROUNDINGS: f64 = 4.0;

/// Returns the shadows that a format loses at a ray's hit. In `f64` the place and its surroundings are in the dark, and
/// in the format the place is lit. At the edge of a shadow formats may differ. So the surroundings reach as far as the
/// format's shadow ray may start from the place. Above it they reach at most a quarter of the way to the object that
/// casts the shadow.
///
/// Each light that is compared counts as a test.
pub fn lost<N: Number>(scene: &Scene<'_>, ray: &Ray<N>) -> Tested {
    let rounded = RoundedRay::of(ray);
    let (hit, right) = (
        ask::<N, List>(scene, ray).hit,
        rounded
            .in_f64(scene)
            .and_then(|ray| ask::<f64, List>(scene, &ray).hit),
    );
    let (Some(hit), Some(right)) = (hit, right) else {
        return Tested::default();
    };
    if HitId::of(&hit) != HitId::of(&right) || hit.front != right.front {
        return Tested::default();
    }
    let normal = DVec3::from_array(right.normal) * if right.front { 1.0 } else { -1.0 };
    let place = DVec3::from_array(depart(scene, &right, right.front));
    let from = DVec3::from_array(depart(scene, &hit, hit.front));
    let lattice_step = f64::powi(2.0, 16 - i32::from(scene.header().lattice_bits));
    let normal = normal.normalize();
    let (u, v) = normal.any_orthonormal_pair();
    let mut tests = 0;
    let found = scene
        .lights()
        .iter()
        .enumerate()
        .filter_map(|(number, light)| {
            if normal.dot(to_light(scene, light, place)?) <= 0.0 {
                return None;
            }
            let is_opaque = |other: &Hit<f64>| {
                let material = scene.material(other.object);
                material.is_some_and(|material| !material.is_glass())
            };
            let nearest = blocker::<f64>(scene, light, place).filter(is_opaque)?;
            let offset = from - place;
            let height = offset.dot(normal);
            let aside = offset - height * normal;
            let largest = place.abs().max(DVec3::from_array(nearest.point).abs());
            let maps = if nearest.instance().is_some() || right.instance().is_some() {
                PLACED
            } else {
                1.0
            };
            let rounded = maps * ROUNDINGS * step(N::FORMAT, largest.max_element());
            let beside = lattice_step.max(2.0 * aside.length() + rounded);
            for offset in [u, -u, v, -v].map(|it| beside * it) {
                blocker::<f64>(scene, light, place + offset).filter(is_opaque)?;
            }
            let distance = place.distance(DVec3::from_array(nearest.point));
            let above = lattice_step.max((2.0 * height.abs() + rounded).min(distance / 4.0));
            blocker::<f64>(scene, light, place + above * normal).filter(is_opaque)?;
            tests += 1;
            if blocker::<N>(scene, light, from).is_some() {
                return None;
            }
            let what = format!(
                "light {number} reaches {}, though {} blocks it {:?} units away",
                HitId::of(&hit).written(scene),
                HitId::of(&nearest).written(scene),
                nearest.t
            );
            Some(Fault::of::<N>(Property::Shadows, Structure::List, what))
        });
    let faults = found.collect();
    Tested { tests, faults }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::{Options, compile};

    const FILE: &str = "[environment]\nzenith = [0.2, 0.3, 0.8]\nhorizon = 0.5\nground = 0.1\n\
        sun = { direction = [-3, -1, 0.5], color = 2, angle = 1 }\n\
        [[object]]\nkind = 'sphere'\ncenter = [0, 1, 0]\nradius = 1\n\
        [[object]]\nkind = 'box'\nmin = [-5, -1, -5]\nmax = [5, 0, 5]\n";

    fn with_scene(test: impl FnOnce(&Scene<'_>)) {
        let imported = crate::scene::read("sun.toml".as_ref(), FILE.into(), &Default::default());
        let blob = compile(&imported.unwrap().scene, &Options::default());
        test(&blob.unwrap().blob.scene().unwrap());
    }

    #[test]
    fn sun_is_infinitely_far_and_its_sky_is_no_point() {
        with_scene(|scene| {
            let of = |kind: u32| {
                let mut lights = scene.lights().iter();
                lights.find(|it| it.kind == kind).unwrap()
            };
            let from = DVec3::new(3.0, 4.0, 5.0);
            assert_eq!(to_light(scene, of(Light::ENVIRONMENT), from), None);
            let way = to_light(scene, of(Light::SUN), from).unwrap().normalize();
            let sun = DVec3::new(3.0, 1.0, -0.5).normalize();
            assert!(way.distance(sun) < 1e-6 && is_far(of(Light::SUN)), "{way}");
        });
    }

    #[test]
    fn shadows_that_are_not_compared_do_not_count() {
        with_scene(|scene| {
            let away = UnitRay::new([0.0; 3], [0.0, 1e6, 0.0]);
            let ray = away.ready::<f32>(scene).unwrap();
            let to_surface = lost(scene, &ray);
            let beside = UnitRay::new([1e7; 3], [0.0, 1.0, 0.0]);
            let beside = beside
                .ready::<f32>(scene)
                .map(|ray| lost(scene, &ray).tests);
            assert!(to_surface.tests <= scene.lights().len() as u64);
            assert!(beside.is_none_or(|tests| tests == 0));
        });
    }
}
