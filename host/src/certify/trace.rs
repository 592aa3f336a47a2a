//! The exact picture, enclosed: the rules of a blob evaluated with numbers that hold the exact ones.
//!
//! Where a comparison is open, both outcomes are followed and their results joined, as long as there are few. The place
//! and the reason are recorded. The kernels of the core are not used. Their answers depend on their rounding (where a
//! ray starts off a surface, which nodes are culled), and here nothing is rounded away.

use super::crossing::Ray;
use super::directions;
use super::facets::{self, Facets};
use super::hit::Seen;
use super::number::*;
use super::path::Path;
use super::reason::Reason;
use super::search::{Candidate, Stop, Tracer};
use super::shade;
use super::sky;
use super::world::NONE;
use gridel_core::{Effects, RayKind};

/// The dimension of directions of indirect light.
const INDIRECT: u16 = 0x1030;

/// A ray that leaves a surface.
struct Leaving<N> {
    kind: RayKind,
    direction: Three<N>,
    /// True if it leaves on the side of the geometric normal.
    outward: bool,
    weight: Three<N>,
}

impl Tracer<'_, '_> {
    /// Returns the light of a ray, times its weight.
    pub fn radiance<N: Enclosure>(&self, path: &Path<N>) -> Result<Three<N>, Stop> {
        let Path { ray, depth, .. } = path;
        self.check_room(*depth, ray)?;
        let (found, may_miss) = self.nearest(ray, *depth)?;
        let mut result: Option<Three<N>> = None;
        if found.len() + usize::from(may_miss) > 1 {
            let first = found[0];
            let point = along(ray.origin, first.crossing.t, ray.direction);
            let solid = &self.world.space(first.instance).solids[first.solid as usize];
            self.note_near(Reason::Hit, (*depth, solid.primitive), point, ray);
        }
        for candidate in &found {
            if result.is_some() {
                self.branch()?;
            }
            let brought = self.surface(candidate, path)?;
            result = Some(result.map_or(brought, |result| hull(result, brought)));
        }
        if may_miss {
            if result.is_some() {
                self.branch()?;
            }
            let brought = times(self.background(path)?, path.weight);
            self.step(*depth, "background", None, [("added", &brought)]);
            result = Some(result.map_or(brought, |result| hull(result, brought)));
        }
        result.ok_or(Stop)
    }

    /// Returns the light of a ray that hits nothing.
    fn background<N: Enclosure>(&self, path: &Path<N>) -> Result<Three<N>, Stop> {
        let scene = self.world.scene;
        let Some(record) = scene.environment() else {
            return Ok(scene.view().background.map(radiance_of));
        };
        let sky = sky::seen(scene, record, path.ray.direction, path.kind);
        if sky.as_ref().is_none_or(|sky| sky.is_open) {
            self.note_ray(Reason::Texture, path.depth, NONE, &path.ray);
        }
        Ok(sky.ok_or(Stop)?.radiance)
    }

    /// Returns the light that a surface sends along a ray.
    fn surface<N: Enclosure>(
        &self,
        candidate: &Candidate<N>,
        path: &Path<N>,
    ) -> Result<Three<N>, Stop> {
        let hit = self.hit(candidate, &path.ray, path.depth)?;
        let seen = self.seen(&hit, path)?;
        let mut brought = [N::zero(); 3];
        if seen.is_there {
            brought = self.own(&seen)?;
        }
        if path.depth < self.depth {
            let straight = Leaving {
                kind: RayKind::Refracted,
                direction: seen.direction,
                outward: !hit.front,
                weight: seen.passing,
            };
            brought = plus(brought, self.send(&seen, straight)?);
            if seen.is_there {
                brought = plus(brought, self.bounce(&seen)?);
            }
        }
        Ok(brought)
    }

    /// The light that a surface sends out and reflects of lights, times its weight.
    fn own<N: Enclosure>(&self, seen: &Seen<'_, N>) -> Result<Three<N>, Stop> {
        let (scene, hit, depth) = (self.world.scene, seen.hit, seen.path.depth);
        let named = Some((hit.primitive, hit.object));
        if self.steps.is_some() {
            let direction = seen.path.ray.direction;
            let length = dot(direction, direction).sqrt();
            self.step(
                depth,
                "hit",
                named,
                [
                    ("distance", &[hit.t * length * N::scaled(1, 8)][..]),
                    ("point", &hit.point.map(|x| x * N::scaled(1, 8))),
                    ("normal", &seen.normal),
                    ("weight", &seen.weight),
                ],
            );
        }
        let mut local = times(scene.view().ambient.map(radiance_of), seen.diffuse);
        if let Some(emission) = scene.emission(hit.object).filter(|_| hit.front) {
            // The surface that sent such a ray has been lit by it, or has reflected it by the formula.
            let is_counted = matches!(seen.path.kind, RayKind::Diffuse | RayKind::Glossy);
            if emission.lights == 0 || !is_counted {
                local = plus(local, emission.radiance.map(radiance_of));
            }
        }
        for numbered in (0..).zip(scene.lights()) {
            let lit = self.lit(numbered, seen)?;
            self.step(depth, "light", named, [("adds", &lit)]);
            self.name_light(numbered.0);
            local = plus(local, lit);
        }
        let brought = times(local, seen.weight);
        self.step(depth, "surface", named, [("added", &brought)]);
        Ok(brought)
    }

    /// The rays that a surface mirrors, refracts and scatters.
    fn bounce<N: Enclosure>(&self, seen: &Seen<'_, N>) -> Result<Three<N>, Stop> {
        let Seen {
            path,
            hit,
            material,
            normal,
            direction,
            weight,
            ..
        } = *seen;
        let scene = self.world.scene;
        let mut brought = [N::zero(); 3];
        if path.reflections < scene.bounces() {
            let scattered = directions::around(normal, path.point(INDIRECT));
            let scattered = Leaving {
                kind: RayKind::Diffuse,
                direction: self.drawn(scattered, seen)?,
                outward: hit.front,
                weight: times(weight, seen.diffuse),
            };
            brought = plus(brought, self.send(seen, scattered)?);
        }
        let mut cos_in = -dot(direction, normal);
        let (mut normal, mut facets) = (normal, None);
        if let Some(alpha) = scene.roughness(hit.object) {
            let all = Facets::new(alpha, normal, cos_in);
            let facet = all.draw(direction, path.point(facets::DIMENSION));
            normal = self.drawn(facet, seen)?;
            cos_in = -dot(direction, normal);
            cos_in = cos_in.at_least(N::zero()).at_most(N::one());
            facets = Some(all);
        }
        let mut mirrored = material.mirror.map(ratio_of);
        if material.is_glass() {
            let transmit = material.transmit.map(ratio_of);
            let split = shade::split(&seen.interface, direction, normal, cos_in);
            let split = self.narrow(split, path.depth, hit)?;
            if split.is_open {
                self.note(Reason::CriticalAngle, path.depth, hit.primitive, hit.point);
            }
            let part = shade::mirrored(material, split.reflected);
            mirrored = mirrored.map(|x: N| (x + part).at_most(N::one()));
            let rest = N::one() - split.reflected;
            if let Some(refracted) = split.refracted {
                let through = Leaving {
                    kind: RayKind::Refracted,
                    direction: refracted,
                    outward: !hit.front,
                    weight: times(weight, scale(transmit, rest)),
                };
                // Facets do not hide what they do not bend.
                let facets = facets.as_ref().filter(|_| seen.interface.is_bending());
                let sent = self.send(seen, self.unmasked(seen, facets, through)?)?;
                brought = if split.is_open {
                    self.branch()?;
                    plus(brought, hull([N::zero(); 3], sent))
                } else {
                    plus(brought, sent)
                };
            }
        }
        let axis = |k: usize| direction[k].half() + cos_in * normal[k];
        let reflected = Leaving {
            kind: RayKind::Reflected,
            direction: [axis(0), axis(1), axis(2)],
            outward: hit.front,
            weight: times(weight, mirrored),
        };
        let sent = self.send(seen, self.unmasked(seen, facets.as_ref(), reflected)?)?;
        Ok(plus(brought, sent))
    }

    /// A direction that was drawn at a surface.
    ///
    /// # Errors
    /// If it is open which one it is.
    fn drawn<N: Enclosure>(
        &self,
        direction: Option<Three<N>>,
        seen: &Seen<'_, N>,
    ) -> Result<Three<N>, Stop> {
        let hit = seen.hit;
        let place = (seen.path.depth, hit.primitive);
        self.known(direction, Reason::Sampling, place, hit.point)
    }

    /// A ray without what facets keep of it.
    fn unmasked<N: Enclosure>(
        &self,
        seen: &Seen<'_, N>,
        facets: Option<&Facets<N>>,
        leaving: Leaving<N>,
    ) -> Result<Leaving<N>, Stop> {
        let is_sent = leaving.weight.iter().any(|it| it.bounds() != [0.0; 2]);
        let Some(facets) = facets.filter(|_| is_sent) else {
            return Ok(leaving);
        };
        let hit = seen.hit;
        let left = facets.unmasked(hit, leaving.direction, leaving.outward);
        if left.as_ref().is_none_or(|it| it.is_open) {
            self.note(Reason::Facet, seen.path.depth, hit.primitive, hit.point);
        }
        Ok(Leaving {
            weight: scale(leaving.weight, left.ok_or(Stop)?.part),
            ..leaving
        })
    }

    /// Returns the light of a ray that leaves a surface, unless its weight is too small.
    fn send<N: Enclosure>(
        &self,
        seen: &Seen<'_, N>,
        leaving: Leaving<N>,
    ) -> Result<Three<N>, Stop> {
        let black = [N::zero(); 3];
        let (hit, depth) = (seen.hit, seen.path.depth);
        let Leaving {
            mut kind,
            direction,
            outward,
            weight,
        } = leaving;
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
        if self.has(Effects::SMOOTH) || self.has(Effects::NORMAL_MAP) {
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
        let reflections = seen.path.reflections + u8::from(kind == RayKind::Diffuse);
        let scene = self.world.scene;
        match (kind, seen.path.kind) {
            (RayKind::Reflected, _) => {
                let alpha = scene.roughness(hit.object);
                kind = alpha.map_or(kind, |alpha| facets::reflected_kind(scene, alpha));
            }
            // Lights shine through glass and ignored surfaces, too.
            (RayKind::Refracted, RayKind::Glossy | RayKind::Polished | RayKind::Diffuse) => {
                kind = seen.path.kind;
            }
            _ => {}
        }
        let mut result: Option<Three<N>> = is_open.then_some(black);
        for direction in ways {
            let path = Path {
                ray: Ray {
                    origin: hit.point,
                    direction,
                    start: hit.start(outward),
                },
                weight,
                depth: depth + 1,
                kind,
                points: seen.path.points,
                reflections,
                length: seen.length,
                inside: if outward == hit.front {
                    seen.path.inside
                } else {
                    seen.beyond
                },
            };
            let brought = self.radiance(&path)?;
            result = Some(result.map_or(brought, |result| hull(result, brought)));
        }
        Ok(result.unwrap_or(black))
    }
}
