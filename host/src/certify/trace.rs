//! The exact picture, enclosed: the rules of a blob evaluated with numbers that hold the exact ones.
//!
//! Where a comparison is open, both outcomes are followed and their results joined, as long as there are few; where
//! and why is recorded. The kernels of the core are not used: their answers depend on what their numbers round (where
//! a ray starts beside a surface, what is culled), and here nothing is rounded away.

use super::crossing::{Crossing, Ray, Start, compare, exact};
use super::hit::{Hit, Seen, radiance_of, ratio_of};
use super::interval::Interval;
use super::number::*;
use super::reason::Reason;
use super::shade;
use super::shapes;
use super::world::{Form, Item, NONE, Slabs, Space, World};
use gridel_core::Effects;
use gridel_core::format::record::{Light, Material};
use serde::Serialize;
use std::cell::{Cell, RefCell};
use std::cmp::Ordering;

/// An open comparison: why, and where.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Open {
    pub reason: Reason,
    /// Reflections and refractions up to there.
    pub depth: u8,
    /// The primitive in scene-file order; [`NONE`] for none.
    pub primitive: u32,
    /// In scene units times the blob's scale: lattice units.
    pub point: [f64; 3],
}

/// An evaluation that ended without a result.
#[derive(Clone, Copy, Debug)]
pub struct Stop;

/// One ray of the tree behind a pixel, for `explain`.
#[derive(Clone, Debug, Serialize)]
pub struct Step {
    pub depth: u8,
    pub event: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub primitive: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub object: Option<u32>,
    /// What the event is about, each number between two.
    pub values: Vec<(&'static str, Vec<[f64; 2]>)>,
}

/// A crossing of a primitive somewhere in the scene.
#[derive(Clone, Copy)]
struct Candidate<N> {
    crossing: Crossing<N>,
    instance: u32,
    solid: u32,
}

/// Follows the rays of one sample.
pub struct Tracer<'w, 's> {
    pub world: &'w World<'s>,
    pub depth: u8,
    /// Whether numbers are so slow that intervals are asked first.
    pub is_slow: bool,
    /// How many outcomes may still be followed.
    pub left: Cell<u32>,
    pub open: RefCell<Vec<Open>>,
    pub steps: Option<RefCell<Vec<Step>>>,
}

/// Most open comparisons that are recorded.
const RECORDED: usize = 16;

impl Tracer<'_, '_> {
    pub fn note<N: Enclosure>(&self, reason: Reason, depth: u8, primitive: u32, point: Three<N>) {
        let mut open = self.open.borrow_mut();
        if open.len() < RECORDED {
            let point = point.map(|x| x.middle() / 256.0);
            open.push(Open {
                reason,
                depth,
                primitive,
                point,
            });
        }
    }

    /// Takes one more outcome into account.
    ///
    /// # Errors
    /// If there were too many.
    fn branch(&self) -> Result<(), Stop> {
        let left = self.left.get();
        if left == 0 {
            return Err(Stop);
        }
        self.left.set(left - 1);
        Ok(())
    }

    fn step<const COUNT: usize, N: Enclosure>(
        &self,
        depth: u8,
        event: &'static str,
        hit: Option<(u32, u32)>,
        values: [(&'static str, &[N]); COUNT],
    ) {
        if let Some(steps) = &self.steps {
            steps.borrow_mut().push(Step {
                depth,
                event,
                primitive: hit.map(|it| it.0),
                object: hit.map(|it| it.1),
                values: values
                    .into_iter()
                    .map(|(name, numbers)| (name, numbers.iter().map(|x| x.bounds()).collect()))
                    .collect(),
            });
        }
    }

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

    /// Every crossing that may be the nearest, and whether the ray may hit nothing.
    fn nearest<N: Enclosure>(
        &self,
        ray: &Ray<N>,
        depth: u8,
    ) -> Result<(Vec<Candidate<N>>, bool), Stop> {
        let mut found: Vec<Candidate<N>> = Vec::new();
        self.search(ray, f64::INFINITY, depth, &mut |candidate, end| {
            found.push(candidate);
            let [_, high] = candidate.crossing.t.bounds();
            if candidate.crossing.sure {
                end.min(high)
            } else {
                end
            }
        })?;
        let world = self.world;
        let solid = |it: &Candidate<N>| &world.space(it.instance).solids[it.solid as usize];
        let plane = |it: &Candidate<N>| {
            let plane = solid(it).planes[usize::from(it.crossing.part)];
            (plane != NONE).then_some((it.instance, plane))
        };
        let primitive = |it: &Candidate<N>| (solid(it).primitive, it.solid);
        // What lies in one plane is met at one t, and the first in the scene file counts.
        let order = |a: &Candidate<N>, b: &Candidate<N>| {
            let twins = a.instance == b.instance
                && solid(a).twin == solid(b).twin
                && a.crossing.part == b.crossing.part
                && a.crossing.leaves == b.crossing.leaves;
            if twins || plane(a).is_some() && plane(a) == plane(b) {
                Some(Ordering::Equal)
            } else {
                compare(&a.crossing, &b.crossing)
            }
        };
        let beats = |a: &Candidate<N>, b: &Candidate<N>| {
            if (a.instance, a.solid) == (b.instance, b.solid) && b.crossing.leaves && !a.crossing.leaves {
                // A solid is entered before it is left.
                return a.crossing.sure;
            }
            a.crossing.sure
                && match order(a, b) {
                    Some(Ordering::Less) => true,
                    Some(Ordering::Equal) => primitive(a) < primitive(b),
                    _ => false,
                }
        };
        let is_left = |index: usize| !found.iter().any(|other| beats(other, &found[index]));
        let mut left: Vec<Candidate<N>> = (0..found.len())
            .filter(|&index| is_left(index))
            .map(|index| found[index])
            .collect();
        let may_miss = !found.iter().any(|it| it.crossing.sure);
        // Faces of one object in one plane look alike at their common edge.
        let alike = |a: &Candidate<N>, b: &Candidate<N>| {
            let is_plain = |it: &Candidate<N>| {
                !matches!(solid(it).form, Form::Triangle { smooth: Some(_), .. } | Form::Cuboid { .. } | Form::Cone { .. })
            };
            plane(a).is_some()
                && plane(a) == plane(b)
                && solid(a).object == solid(b).object
                && is_plain(a)
                && is_plain(b)
        };
        let mut index = 0;
        while index < left.len() {
            if (0..index).any(|before| alike(&left[before], &left[index])) {
                left.remove(index);
            } else {
                index += 1;
            }
        }
        Ok((left, may_miss))
    }

    /// Calls a function with every crossing up to an end, which the function may bring nearer.
    fn search<N: Enclosure>(
        &self,
        ray: &Ray<N>,
        end: f64,
        depth: u8,
        visit: &mut dyn FnMut(Candidate<N>, f64) -> f64,
    ) -> Result<(), Stop> {
        let own = &self.world.own;
        let mut end = end;
        let mut instances = Vec::new();
        self.search_space((own, NONE), ray, &mut end, depth, visit, &mut instances)?;
        for instance in instances {
            let placed = &self.world.placed[instance as usize];
            let space = &self.world.parts[placed.part];
            let ray = placed.ray(ray);
            self.search_space((space, instance), &ray, &mut end, depth, visit, &mut Vec::new())?;
        }
        Ok(())
    }

    fn search_space<N: Enclosure>(
        &self,
        (space, instance): (&Space, u32),
        ray: &Ray<N>,
        end: &mut f64,
        depth: u8,
        visit: &mut dyn FnMut(Candidate<N>, f64) -> f64,
        instances: &mut Vec<u32>,
    ) -> Result<(), Stop> {
        let outer = self.is_slow.then(|| {
            let enclose = |v: Three<N>| {
                v.map(|x| {
                    let [low, high] = x.bounds();
                    Interval::new(low, high)
                })
            };
            Ray {
                origin: enclose(ray.origin),
                direction: enclose(ray.direction),
                start: ray.start,
            }
        });
        let mut crossings: Vec<Crossing<N>> = Vec::with_capacity(4);
        let mut quick: Vec<Crossing<Interval>> = Vec::with_capacity(4);
        let mut stopped = false;
        let mut test = |number: u32, end: f64| -> f64 {
            let solid = &space.solids[number as usize];
            let named = (solid, number, instance);
            if let Some(outer) = &outer {
                quick.clear();
                let missed = shapes::crossings(named, outer, &mut quick).is_ok()
                    && quick.iter().all(|it| it.t.low > end);
                if missed {
                    return end;
                }
            }
            crossings.clear();
            if shapes::crossings(named, ray, &mut crossings).is_err() {
                if !stopped {
                    self.note(Reason::Grazing, depth, solid.primitive, ray.origin);
                }
                stopped = true;
                return end;
            }
            let mut end = end;
            for &crossing in &crossings {
                if crossing.t.bounds()[0] <= end {
                    let candidate = Candidate {
                        crossing,
                        instance,
                        solid: number,
                    };
                    end = visit(candidate, end);
                }
            }
            end
        };
        for &number in &space.unbounded {
            *end = test(number, *end);
        }
        let mut last = *end;
        let slabs = Slabs::of(ray.origin, ray.direction);
        space.tree.walk(&slabs, *end, |item, end| {
            last = match item {
                Item::Solid(number) => test(number, end),
                Item::Instance(number) => {
                    instances.push(number);
                    end
                }
            };
            last
        });
        *end = last;
        if stopped { Err(Stop) } else { Ok(()) }
    }

    /// The surface where a ray crosses it.
    fn hit<N: Enclosure>(
        &self,
        candidate: &Candidate<N>,
        ray: &Ray<N>,
        depth: u8,
    ) -> Result<Hit<N>, Stop> {
        let Candidate {
            crossing,
            instance,
            solid: number,
        } = *candidate;
        let solid = &self.world.space(instance).solids[number as usize];
        let part = crossing.part;
        let mut point = along(ray.origin, crossing.t, ray.direction);
        let placed = self.world.placed.get(instance as usize);
        let stop = || {
            self.note(Reason::Grazing, depth, solid.primitive, point);
            Stop
        };
        let normal = match placed {
            None => shapes::normal(&solid.form, part, point).ok_or_else(stop)?,
            Some(placed) => {
                let there = placed.point(point);
                let normal = shapes::normal(&solid.form, part, there).ok_or_else(stop)?;
                unit(placed.normal(normal)).ok_or_else(stop)?
            }
        };
        let front = if solid.form.is_flat() {
            let towards = match crossing.fraction {
                // The sign without what the length rounds.
                Some([_, approach]) => approach,
                None => dot(normal, ray.direction),
            };
            towards.sign().ok_or_else(stop)? == Ordering::Less
        } else {
            !crossing.leaves
        };
        if placed.is_none()
            && let Some((axis, coordinate)) = shapes::face(&solid.form, part)
        {
            point[axis] = N::int(coordinate);
        }
        Ok(Hit {
            t: crossing.t,
            point,
            normal,
            front,
            object: solid.object,
            primitive: solid.primitive,
            instance,
            solid: number,
            part,
            plane: solid.planes[usize::from(part)],
        })
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
        if self.has(Effects::SMOOTH) && let Some(smooth) = shade::smooth_normal(self.world, &hit).ok_or(Stop)? {
            normal = smooth;
            if is_glass || material.mirror != [0; 3] {
                normal = shade::turned_to_ray(normal, direction).ok_or(Stop)?;
            }
        }
        let diffuse = self.diffuse(&hit, material, depth);
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
        if super::deep::is_full() {
            self.note(Reason::Branches, depth, hit.primitive, hit.point);
            return Err(Stop);
        }
        Ok(brought)
    }

    pub fn has(&self, effects: Effects) -> bool {
        self.world.scene.effects().contains(effects)
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

    /// The radiance that a light adds.
    fn lit<N: Enclosure>(&self, light: &Light, seen: &Seen<'_, N>) -> Result<Three<N>, Stop> {
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
