//! Lights: what of them arrives at a surface.

use super::aim::{self, Aim};
use super::crossing::{Ray, Start, compare};
use super::facets;
use super::hit::{Hit, Seen};
use super::media::{self, Boundary, Interface};
use super::number::*;
use super::paint;
use super::path::Path;
use super::reason::Reason;
use super::search::{Candidate, ENDED, Stop, Tracer};
use super::shade;
use super::world::{NONE, passes};
use gridel_core::Effects;
use gridel_core::format::limits::MAX_SHADOW_SURFACES;
use gridel_core::format::record::{Light, Material};
use std::cmp::Ordering;

/// The surfaces between a point and a light.
struct Passed<N> {
    /// The surfaces that the light may pass, and surfaces that may coincide with them.
    surfaces: Vec<Candidate<N>>,
    /// True if something else may block the light.
    is_open: bool,
}

impl Tracer<'_, '_> {
    /// Returns the radiance that a light of the scene, given with its number, adds.
    pub fn lit<N: Enclosure>(
        &self,
        (number, light): (u32, &Light),
        seen: &Seen<'_, N>,
    ) -> Result<Three<N>, Stop> {
        let black = [N::zero(); 3];
        let (hit, depth) = (seen.hit, seen.path.depth);
        self.check_room(depth, &seen.path.ray)?;
        let Some(aim) = self.aim((number, light), hit.point, seen.path)? else {
            return Ok(black);
        };
        let Some(to_light) = unit(aim.way) else {
            // The light lies in the surface.
            self.note(Reason::Terminator, depth, hit.primitive, hit.point);
            return Err(Stop);
        };
        let cos = dot(seen.normal, to_light);
        let faces = positive(cos);
        if faces == Some(false) {
            return Ok(black);
        }
        let Some(rays) = self.shadow_rays(seen, light, &aim, to_light)? else {
            return Ok(black);
        };
        // A point light is as bright as from where its ray starts.
        let arriving = |ray: &Option<Ray<N>>| match (ray, self.world.scene.light_form(light)) {
            (None, _) => Some(black),
            (Some(_), None) => Some(aim.color),
            (Some(ray), Some(form)) => aim::arriving(form, &aim.along(ray.direction), to_light),
        };
        let arriving: Option<Vec<_>> = rays.iter().map(arriving).collect();
        let arriving = self.narrow(arriving, depth, hit)?;
        if arriving.iter().all(|&it| is_nothing(it)) {
            return Ok(black);
        }
        let cos = cos.at_least(N::zero());
        let mut reflected = scale(seen.diffuse, cos);
        if seen.material.highlight != [0; 3] {
            let highlight = shade::highlight(seen, to_light, reflected);
            reflected = self.narrow(highlight, depth, hit)?;
        }
        let scene = self.world.scene;
        if let Some(alpha) = scene.roughness(hit.object)
            && facets::reflects(scene, alpha, light)
        {
            let mirrored = facets::mirrored(alpha, seen, to_light, cos);
            reflected = plus(reflected, self.narrow(mirrored, depth, hit)?);
        }
        if is_nothing(reflected) {
            return Ok(black);
        }
        let mut result: Option<Three<N>> = None;
        if faces.is_none() {
            self.note(Reason::Terminator, depth, hit.primitive, hit.point);
            result = Some(black);
        }
        for (ray, arriving) in rays.iter().zip(arriving) {
            let brought = match ray {
                None => black,
                Some(ray) if self.has(Effects::SHADOW) => {
                    let left = self.through(ray, aim.is_far, to_light, seen.path)?;
                    times(times(arriving, left), reflected)
                }
                Some(_) => times(arriving, reflected),
            };
            result = Some(result.map_or(brought, |result| hull(result, brought)));
        }
        result.ok_or(Stop)
    }

    /// Returns the shadow rays of which one is cast; one of them is `None` if the light may not reach the point at all.
    /// `None` if it certainly does not.
    fn shadow_rays<N: Enclosure>(
        &self,
        seen: &Seen<'_, N>,
        light: &Light,
        aim: &Aim<N>,
        to_light: Three<N>,
    ) -> Result<Option<Vec<Option<Ray<N>>>>, Stop> {
        let (hit, depth) = (seen.hit, seen.path.depth);
        let straight = Some(Ray {
            origin: hit.point,
            direction: aim.way,
            start: hit.start(hit.front),
        });
        let is_lifted = self.has(Effects::SMOOTH.with(Effects::SHADOW));
        let is_bumped = seen.material.maps & Material::MAPS_NORMAL != 0;
        if !is_lifted && !is_bumped {
            return Ok(Some(vec![straight]));
        }
        let faces = positive(dot(hit.facing(), to_light));
        if faces.is_none() {
            self.note(Reason::Terminator, depth, hit.primitive, hit.point);
        }
        let mut rays = match faces {
            Some(true) => return Ok(Some(vec![straight])),
            // Light from behind does not reach a front, as it would be lifted to no surface.
            Some(false) if !is_lifted => return Ok(None),
            None if !is_lifted => return Ok(Some(vec![straight, None])),
            Some(false) => Vec::new(),
            None => vec![straight],
        };
        let (reached, step) = self.narrow(shade::lift(self.world, hit), depth, hit)?;
        if reached != Some(false) {
            // For lights other than points the direction stays as it is.
            let direction = match light.is_point() {
                true => minus(aim.way, step),
                false => aim.way,
            };
            rays.push(Some(Ray {
                origin: plus(hit.point, step),
                direction,
                start: Start::Free,
            }));
        }
        if reached != Some(true) {
            rays.push(None);
        }
        if reached.is_none() {
            self.note(Reason::Terminator, depth, hit.primitive, hit.point);
        }
        Ok(Some(rays))
    }

    /// The part of a light that arrives along a ray: up to a t of 1, or from infinitely far.
    fn through<N: Enclosure>(
        &self,
        ray: &Ray<N>,
        is_far: bool,
        to_light: Three<N>,
        path: &Path<N>,
    ) -> Result<Three<N>, Stop> {
        let depth = path.depth;
        let (black, white) = ([N::zero(); 3], [N::one(); 3]);
        let scene = self.world.scene;
        let Some(Passed {
            surfaces,
            mut is_open,
        }) = self.passed(ray, is_far, depth)?
        else {
            return Ok(black);
        };
        let mut left = white;
        let mut surfaces = self.one_each(&surfaces, ray, depth)?;
        if surfaces.len() > MAX_SHADOW_SURFACES {
            let certain = surfaces.iter().filter(|it| it.crossing.sure).count();
            if certain > MAX_SHADOW_SURFACES {
                return Ok(black);
            }
            is_open = true;
        }
        if !scene.media().is_empty() || self.has(Effects::ABSORPTION) {
            self.sort(&mut surfaces, ray, depth)?;
        }
        let mut inside = path.inside;
        for (index, candidate) in surfaces.iter().enumerate() {
            let hit = self.hit(candidate, ray, depth)?;
            let Some(material) = scene.material(hit.object) else {
                return Ok(black);
            };
            let boundary = Boundary::at(scene, inside, hit.object, hit.front);
            if !passes(material) {
                if candidate.crossing.sure {
                    return Ok(black);
                }
                self.note_near(Reason::Shadow, (depth, hit.primitive), hit.point, ray);
                is_open = true;
                continue;
            }
            let mut part = match boundary.is_none_or(|it| it.is_there()) {
                true => self.part_through(&hit, material, boundary.as_ref(), to_light, depth)?,
                false => white,
            };
            let medium = media::passed(scene, boundary.as_ref(), inside, hit.object, hit.front);
            if let Some(medium) = medium.filter(|it| it.absorption != [0; 3]) {
                let length = norm2(ray.direction).sqrt() * self.since(&surfaces, index)?;
                part = times(part, shade::absorbed(medium, length));
            }
            inside = inside.beyond(scene, boundary.as_ref(), hit.crossed());
            let passed = times(left, part);
            left = if candidate.crossing.sure {
                passed
            } else {
                self.note_near(Reason::Shadow, (depth, hit.primitive), hit.point, ray);
                hull(left, passed)
            };
        }
        // The cutoff is compared where light has passed a surface, before the last stretch absorbs more.
        if !surfaces.is_empty() {
            let is_certain = surfaces.iter().any(|it| it.crossing.sure);
            match self.exceeds_cutoff(left) {
                Some(true) => {}
                Some(false) if is_certain => return Ok(black),
                _ => {
                    self.note_ray(Reason::Cutoff, depth, NONE, ray);
                    is_open = true;
                }
            }
        }
        if !is_far && let Some(medium) = inside.material(scene).filter(|it| it.absorption != [0; 3])
        {
            let before = surfaces.iter().map(|it| it.crossing.t);
            let before = before.fold(N::zero(), |a, b| a.at_least(b));
            let length = norm2(ray.direction).sqrt() * (N::one() - before).at_least(N::zero());
            left = times(left, shade::absorbed(medium, length));
        }
        Ok(if is_open { hull(black, left) } else { left })
    }

    /// Returns the part of a light that a surface lets through.
    fn part_through<N: Enclosure>(
        &self,
        hit: &Hit<N>,
        material: &Material,
        boundary: Option<&Boundary>,
        to_light: Three<N>,
        depth: u8,
    ) -> Result<Three<N>, Stop> {
        if !material.is_glass() {
            let alpha = paint::alpha(self.world, hit, material, None);
            let alpha = self.narrow(alpha, depth, hit)?;
            let passing = N::one() - alpha.part;
            if alpha.is_open {
                self.note(Reason::Texture, depth, hit.primitive, hit.point);
            }
            return Ok([passing.at_least(N::zero()); 3]);
        }
        let interface = boundary.and_then(|it| it.interface(self.world.scene));
        let interface = interface.unwrap_or_else(|| Interface::of(hit.front, material));
        let filtered = shade::filtered(hit, material, interface.k, to_light);
        self.narrow(filtered, depth, hit)
    }

    /// Returns whether light is above the cutoff; `None` if that is not certain.
    fn exceeds_cutoff<N: Enclosure>(&self, [red, green, blue]: Three<N>) -> Option<bool> {
        let peak = red.at_least(green).at_least(blue);
        positive(peak - N::scaled(self.world.scene.view().cutoff.into(), 20))
    }

    /// Returns what is between a point and a light; `None` if light certainly does not pass it.
    fn passed<N: Enclosure>(
        &self,
        ray: &Ray<N>,
        is_far: bool,
        depth: u8,
    ) -> Result<Option<Passed<N>>, Stop> {
        let mut surfaces: Vec<Candidate<N>> = Vec::new();
        let mut is_dark = false;
        let mut may_be_dark: Option<(u32, N)> = None;
        let end = if is_far { f64::INFINITY } else { 1.0 };
        self.search(ray, end, depth, &mut |candidate, end| {
            if is_dark {
                return ENDED;
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
            let material = self.world.scene.material(solid.object);
            if material.is_some_and(passes) || space.may_be_hidden(solid, &candidate.crossing) {
                surfaces.push(candidate);
            } else if candidate.crossing.sure {
                is_dark = true;
                return ENDED;
            } else {
                may_be_dark = Some((solid.primitive, candidate.crossing.t));
            }
            end
        })?;
        if is_dark {
            return Ok(None);
        }
        if let Some((primitive, t)) = may_be_dark {
            let point = along(ray.origin, t, ray.direction);
            self.note_near(Reason::Shadow, (depth, primitive), point, ray);
        }
        Ok(Some(Passed {
            surfaces,
            is_open: may_be_dark.is_some(),
        }))
    }

    /// Sorts surfaces by their places along a ray.
    fn sort<N: Enclosure>(
        &self,
        surfaces: &mut [Candidate<N>],
        ray: &Ray<N>,
        depth: u8,
    ) -> Result<(), Stop> {
        let mut is_open = surfaces.iter().any(|it| !it.crossing.sure);
        surfaces.sort_by(|a, b| {
            let order = compare(&a.crossing, &b.crossing);
            let is_same = a.instance == b.instance && a.solid == b.solid;
            is_open |= !is_same && order.is_none_or(Ordering::is_eq);
            order.unwrap_or(Ordering::Equal)
        });
        if is_open {
            self.note_ray(Reason::Shadow, depth, NONE, ray);
            return Err(Stop);
        }
        Ok(())
    }

    /// Leaves out surfaces where others of a lower number are, too: light passes one of them.
    fn one_each<N: Enclosure>(
        &self,
        all: &[Candidate<N>],
        ray: &Ray<N>,
        depth: u8,
    ) -> Result<Vec<Candidate<N>>, Stop> {
        let solid = |it: &Candidate<N>| &self.world.space(it.instance).solids[it.solid as usize];
        let number = |it: &Candidate<N>| (solid(it).primitive, it.solid);
        let mut left = Vec::with_capacity(all.len());
        for a in all {
            let mut others = all.iter().filter(|b| {
                a.instance == b.instance
                    && number(b) < number(a)
                    && solid(a).meets_at_one_t(solid(b), [&a.crossing, &b.crossing])
            });
            match others.next() {
                None => left.push(*a),
                Some(first) if first.crossing.sure => {}
                Some(_) => {
                    self.note_ray(Reason::Shadow, depth, solid(a).primitive, ray);
                    return Err(Stop);
                }
            }
        }
        Ok(left)
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

/// Returns whether a color is black for certain.
fn is_nothing<N: Enclosure>(color: Three<N>) -> bool {
    color.iter().all(|channel| channel.bounds() == [0.0; 2])
}
