//! The exact picture, enclosed: the rules of a blob evaluated with numbers that hold the exact ones.
//!
//! Where a comparison is open, both outcomes are followed and their results joined, as long as there are few; where
//! and why is recorded. The kernels of the core are not used: their answers depend on what their numbers round (where
//! a ray starts beside a surface, what is culled), and here nothing is rounded away.

use super::crossing::Ray;
use super::deep;
use super::hit::{Hit, Seen, radiance_of, ratio_of};
use super::number::*;
use super::paint;
use super::reason::Reason;
use super::search::{Candidate, Stop, Tracer};
use super::shade;
use gridel_core::Effects;
use gridel_core::format::record::Material;

impl Tracer<'_, '_> {
    /// What a ray brings, times its weight.
    pub fn radiance<N: Enclosure>(
        &self,
        ray: &Ray<N>,
        weight: Three<N>,
        depth: u8,
    ) -> Result<Three<N>, Stop> {
        let (found, may_miss) = self.nearest(ray, depth)?;
        let mut result: Option<Three<N>> = None;
        if found.len() + usize::from(may_miss) > 1 {
            let first = found[0];
            let point = along(ray.origin, first.crossing.t, ray.direction);
            let solid = &self.world.space(first.instance).solids[first.solid as usize];
            self.note(Reason::Hit, depth, solid.primitive, point);
        }
        for candidate in &found {
            if result.is_some() {
                self.branch()?;
            }
            let brought = self.surface(candidate, ray, weight, depth)?;
            result = Some(result.map_or(brought, |result| hull(result, brought)));
        }
        if may_miss {
            if result.is_some() {
                self.branch()?;
            }
            let background = self.world.scene.view().background;
            let brought = times(background.map(radiance_of), weight);
            self.step(depth, "background", None, [("added", &brought)]);
            result = Some(result.map_or(brought, |result| hull(result, brought)));
        }
        result.ok_or(Stop)
    }

    /// What a surface sends along a ray.
    fn surface<N: Enclosure>(
        &self,
        candidate: &Candidate<N>,
        ray: &Ray<N>,
        weight: Three<N>,
        depth: u8,
    ) -> Result<Three<N>, Stop> {
        let hit = self.hit(candidate, ray, depth)?;
        let scene = self.world.scene;
        let material = scene.material(hit.object).ok_or(Stop)?;
        let is_glass = material.transmit != [0; 3];
        let mut weight = weight;
        if is_glass && !hit.front && material.absorption != [0; 3] {
            let length = hit.t * norm2(ray.direction).sqrt();
            weight = times(weight, shade::absorbed(material, length));
        }
        let direction = unit(ray.direction).ok_or(Stop)?;
        let facing = hit.facing();
        let mut normal = facing;
        if self.has(Effects::SMOOTH)
            && let Some(smooth) = shade::smooth_normal(self.world, &hit).ok_or(Stop)?
        {
            normal = smooth;
            if is_glass || material.mirror != [0; 3] {
                normal = shade::turned_to_ray(normal, direction).ok_or(Stop)?;
            }
        }
        let mut diffuse = self.diffuse(&hit, material, depth);
        if self.has(Effects::VERTEX_COLORS) || self.has(Effects::TEXTURE) {
            let paint = paint::weight(self.world, &hit, material).ok_or(Stop)?;
            if paint.is_open {
                self.note(Reason::Texture, depth, hit.primitive, hit.point);
            }
            diffuse = times(diffuse, paint.color);
        }
        let named = Some((hit.primitive, hit.object));
        self.step(
            depth,
            "hit",
            named,
            [
                ("t", &[hit.t][..]),
                ("point", &hit.point.map(|x| x * N::scaled(1, 8))),
                ("normal", &normal),
                ("weight", &weight),
            ],
        );
        let mut local = times(scene.view().ambient.map(radiance_of), diffuse);
        let seen = Seen {
            hit: &hit,
            material,
            normal,
            direction,
            diffuse,
            depth,
        };
        for light in scene.lights() {
            let lit = self.lit(light, &seen)?;
            self.step(depth, "light", named, [("adds", &lit)]);
            local = plus(local, lit);
        }
        let mut brought = times(local, weight);
        self.step(depth, "surface", named, [("added", &brought)]);
        if depth < self.depth {
            brought = plus(brought, self.bounce(&seen, weight)?);
        }
        if deep::is_full() {
            self.note(Reason::Branches, depth, hit.primitive, hit.point);
            return Err(Stop);
        }
        Ok(brought)
    }

    /// The diffuse color; of both kinds of cells where it is open which one it is.
    fn diffuse<N: Enclosure>(&self, hit: &Hit<N>, material: &Material, depth: u8) -> Three<N> {
        let even = material.diffuse.map(ratio_of);
        if material.checker_size <= 0 {
            return even;
        }
        let odd = material.odd.map(ratio_of);
        match shade::is_odd(hit, material) {
            Some(false) => even,
            Some(true) => odd,
            None => {
                self.note(Reason::Checker, depth, hit.primitive, hit.point);
                hull(even, odd)
            }
        }
    }

    /// The mirrored and the refracted ray.
    fn bounce<N: Enclosure>(&self, seen: &Seen<'_, N>, weight: Three<N>) -> Result<Three<N>, Stop> {
        let Seen {
            hit,
            material,
            normal,
            direction,
            depth,
            ..
        } = *seen;
        let mut brought = [N::zero(); 3];
        let cos_in = -dot(direction, normal);
        let mut mirrored = material.mirror.map(ratio_of);
        if material.transmit != [0; 3] {
            let transmit = material.transmit.map(ratio_of);
            let k = ratio_of(material.inverse_ior);
            let split = shade::split(k, hit.front, direction, normal, cos_in).ok_or(Stop)?;
            if split.is_open {
                self.note(Reason::CriticalAngle, depth, hit.primitive, hit.point);
            }
            mirrored = plus(mirrored, scale(transmit, split.reflected));
            mirrored = mirrored.map(|x| x.at_most(N::one()));
            let passing = N::one() - split.reflected;
            let through = times(weight, scale(transmit, passing));
            if let Some(refracted) = split.refracted {
                let sent = self.send(seen, refracted, !hit.front, through)?;
                brought = if split.is_open {
                    self.branch()?;
                    plus(brought, hull([N::zero(); 3], sent))
                } else {
                    plus(brought, sent)
                };
            }
        }
        let axis = |k: usize| direction[k].half() + cos_in * normal[k];
        let reflected = [axis(0), axis(1), axis(2)];
        let sent = self.send(seen, reflected, hit.front, times(weight, mirrored))?;
        Ok(plus(brought, sent))
    }

    /// What a ray brings that leaves a surface, unless it would bring too little.
    fn send<N: Enclosure>(
        &self,
        seen: &Seen<'_, N>,
        direction: Three<N>,
        outward: bool,
        weight: Three<N>,
    ) -> Result<Three<N>, Stop> {
        let black = [N::zero(); 3];
        let (hit, depth) = (seen.hit, seen.depth);
        let [red, green, blue] = weight;
        let peak = red.at_least(green).at_least(blue);
        let cutoff = N::scaled(self.world.scene.view().cutoff.into(), 20);
        let is_open = match positive(peak - cutoff) {
            Some(false) => return Ok(black),
            Some(true) => false,
            // Nothing at all is below every cutoff.
            None if peak.bounds() == [0.0, 0.0] => return Ok(black),
            None => true,
        };
        if is_open {
            self.note(Reason::Cutoff, depth, hit.primitive, hit.point);
            self.branch()?;
        }
        let mut ways = vec![direction];
        if self.has(Effects::SMOOTH) {
            let normal = if outward {
                hit.normal
            } else {
                opposite(hit.normal)
            };
            let rise = dot(direction, normal);
            let lifted = along(direction, N::scaled(1, 12) - rise, normal);
            match positive(rise) {
                Some(true) => {}
                Some(false) => ways = vec![lifted],
                None => {
                    self.note(Reason::Smooth, depth, hit.primitive, hit.point);
                    self.branch()?;
                    ways.push(lifted);
                }
            }
        }
        let mut result: Option<Three<N>> = is_open.then_some(black);
        for direction in ways {
            let ray = Ray {
                origin: hit.point,
                direction,
                start: hit.start(outward),
            };
            let brought = self.radiance(&ray, weight, depth + 1)?;
            result = Some(result.map_or(brought, |result| hull(result, brought)));
        }
        Ok(result.unwrap_or(black))
    }
}
