//! Lights: what of them arrives at a surface.

use super::crossing::{Ray, Start, compare, exact};
use super::hit::{Seen, radiance_of};
use super::number::*;
use super::reason::Reason;
use super::search::{Candidate, Stop, Tracer};
use super::shade;
use super::world::NONE;
use gridel_core::Effects;
use gridel_core::format::record::Light;
use std::cmp::Ordering;

impl Tracer<'_, '_> {
    /// The radiance that a light adds.
    pub fn lit<N: Enclosure>(&self, light: &Light, seen: &Seen<'_, N>) -> Result<Three<N>, Stop> {
        let black = [N::zero(); 3];
        let (hit, depth) = (seen.hit, seen.depth);
        let (way, is_far) = way_to(light, hit.point);
        let Some(to_light) = unit(way) else {
            // The light lies in the surface.
            self.note(Reason::Terminator, depth, hit.primitive, hit.point);
            return Err(Stop);
        };
        let cos = dot(seen.normal, to_light);
        let faces = positive(cos);
        if faces == Some(false) {
            return Ok(black);
        }
        // The way may start elsewhere, and lights reached or not.
        let mut ways = vec![Some((hit.point, way, hit.start(hit.front)))];
        if self.has(Effects::SMOOTH.with(Effects::SHADOW)) {
            let geometric = dot(hit.facing(), to_light);
            let lifted = |ways: &mut Vec<_>| -> Result<(), Stop> {
                let (reached, step) = shade::lift(self.world, hit).ok_or(Stop)?;
                let from = plus(hit.point, step);
                if reached != Some(false) {
                    ways.push(Some((from, way_to(light, from).0, Start::Free)));
                }
                if reached != Some(true) {
                    ways.push(None);
                }
                if reached.is_none() {
                    self.note(Reason::Terminator, depth, hit.primitive, hit.point);
                }
                Ok(())
            };
            match positive(geometric) {
                Some(true) => {}
                Some(false) => {
                    ways.clear();
                    lifted(&mut ways)?;
                }
                None => {
                    self.note(Reason::Terminator, depth, hit.primitive, hit.point);
                    lifted(&mut ways)?;
                }
            }
        }
        let cos = cos.at_least(N::zero());
        let mut reflected = scale(seen.diffuse, cos);
        if seen.material.highlight != [0; 3] {
            reflected = shade::highlight(seen, to_light, reflected).ok_or(Stop)?;
        }
        let arriving = light.color.map(radiance_of);
        let mut result: Option<Three<N>> = None;
        if faces.is_none() {
            self.note(Reason::Terminator, depth, hit.primitive, hit.point);
            result = Some(black);
        }
        for way in ways {
            let brought = match way {
                None => black,
                Some((origin, direction, start)) if self.has(Effects::SHADOW) => {
                    let ray = Ray {
                        origin,
                        direction,
                        start,
                    };
                    let left = self.through(&ray, is_far, to_light, depth)?;
                    times(times(arriving, left), reflected)
                }
                Some(_) => times(arriving, reflected),
            };
            result = Some(result.map_or(brought, |result| hull(result, brought)));
        }
        result.ok_or(Stop)
    }

    /// The part of a light that arrives along a ray: up to a t of 1, or from infinitely far.
    fn through<N: Enclosure>(
        &self,
        ray: &Ray<N>,
        is_far: bool,
        to_light: Three<N>,
        depth: u8,
    ) -> Result<Three<N>, Stop> {
        let (black, white) = ([N::zero(); 3], [N::one(); 3]);
        let scene = self.world.scene;
        let mut surfaces: Vec<Candidate<N>> = Vec::new();
        let mut is_dark = false;
        let mut may_be_dark: Option<(u32, N)> = None;
        let end = if is_far { f64::INFINITY } else { 1.0 };
        self.search(ray, end, depth, &mut |candidate, end| {
            if is_dark {
                return -1.0;
            }
            let mut candidate = candidate;
            if !is_far {
                // The light itself, and what touches it, casts no shadow.
                match positive(N::one() - candidate.crossing.t) {
                    Some(true) => {}
                    Some(false) => return end,
                    None => candidate.crossing.sure = false,
                }
            }
            let space = self.world.space(candidate.instance);
            let solid = &space.solids[candidate.solid as usize];
            let material = scene.material(solid.object);
            if material.is_some_and(|it| it.transmit != [0; 3]) {
                surfaces.push(candidate);
            } else if candidate.crossing.sure {
                is_dark = true;
                return -1.0;
            } else {
                may_be_dark = Some((solid.primitive, candidate.crossing.t));
            }
            end
        })?;
        if is_dark {
            return Ok(black);
        }
        let mut left = white;
        let mut is_open = false;
        if let Some((primitive, t)) = may_be_dark {
            let point = along(ray.origin, t, ray.direction);
            self.note(Reason::Shadow, depth, primitive, point);
            is_open = true;
        }
        if surfaces.len() > shade::SURFACES {
            return Ok(black);
        }
        self.reject_coincident(&surfaces, ray, depth)?;
        for (index, candidate) in surfaces.iter().enumerate() {
            let hit = self.hit(candidate, ray, depth)?;
            let Some(material) = scene.material(hit.object) else {
                return Ok(black);
            };
            let mut part = shade::filtered(&hit, material, to_light).ok_or(Stop)?;
            if !hit.front && material.absorption != [0; 3] {
                let length = norm2(ray.direction).sqrt() * self.since(&surfaces, index)?;
                part = times(part, shade::absorbed(material, length));
            }
            let passed = times(left, part);
            left = if candidate.crossing.sure {
                passed
            } else {
                self.note(Reason::Shadow, depth, hit.primitive, hit.point);
                hull(left, passed)
            };
        }
        if !surfaces.is_empty() {
            let [red, green, blue] = left;
            let peak = red.at_least(green).at_least(blue);
            match positive(peak - N::scaled(scene.view().cutoff.into(), 20)) {
                Some(true) => {}
                Some(false) => return Ok(black),
                None => {
                    self.note(Reason::Cutoff, depth, NONE, ray.origin);
                    is_open = true;
                }
            }
        }
        Ok(if is_open { hull(black, left) } else { left })
    }

    /// Ends the evaluation where glass touches glass in one plane: light passes one of the surfaces then, not both.
    fn reject_coincident<N: Enclosure>(
        &self,
        all: &[Candidate<N>],
        ray: &Ray<N>,
        depth: u8,
    ) -> Result<(), Stop> {
        let solid = |it: &Candidate<N>| &self.world.space(it.instance).solids[it.solid as usize];
        let plane = |it: &Candidate<N>| solid(it).planes[usize::from(it.crossing.part)];
        for (index, a) in all.iter().enumerate() {
            for b in &all[..index] {
                let twins = solid(a).twin == solid(b).twin && a.solid != b.solid;
                let same_plane = plane(a) != NONE && plane(a) == plane(b);
                if a.instance == b.instance && (twins || same_plane) {
                    self.note(Reason::Shadow, depth, solid(a).primitive, ray.origin);
                    return Err(Stop);
                }
            }
        }
        Ok(())
    }

    /// The t from the surface before one of several to that one.
    fn since<N: Enclosure>(&self, all: &[Candidate<N>], index: usize) -> Result<N, Stop> {
        let t = all[index].crossing.t;
        // The latest that is certainly before, and what may be.
        let (mut before, mut open) = (N::zero(), Vec::new());
        for (other, it) in all.iter().enumerate() {
            if other == index {
                continue;
            }
            match compare(&it.crossing, &all[index].crossing) {
                Some(Ordering::Less) if it.crossing.sure => {
                    before = before.at_least(it.crossing.t);
                }
                Some(Ordering::Greater) => {}
                _ => open.push(it.crossing.t),
            }
        }
        for other in open {
            before = before.hull(other.at_most(t));
        }
        Ok((t - before).at_least(N::zero()))
    }
}

/// The way to a light, and whether it is infinitely far.
fn way_to<N: Enclosure>(light: &Light, point: Three<N>) -> (Three<N>, bool) {
    if light.directional == 1 {
        (exact(light.vector), true)
    } else {
        // 13 fraction bits of a unit are 5 of a step.
        (minus(light.vector.map(|x| N::scaled(x, 5)), point), false)
    }
}
