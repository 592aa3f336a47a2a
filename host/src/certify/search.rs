//! The search for crossings, and the surface at one of them.

use super::crossing::{Crossing, Ray};
use super::deep;
use super::hit::Hit;
use super::interval::Interval;
use super::number::*;
use super::reason::Reason;
use super::shapes;
use super::tree::Slabs;
use super::world::{Item, NONE, Space, World};
use gridel_core::Effects;
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
    /// In lattice units; [`explain`](super::explain) returns it in scene units.
    pub point: [f64; 3],
    /// The radius of the enclosure of the point, or of the ray that the comparison depends on: in lattice steps, and of
    /// directions per length.
    #[serde(skip)]
    pub radius: f64,
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
    /// The number of the light.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub light: Option<u32>,
    /// The numbers of the event, each with its bounds. Points and distances are in scene units.
    pub values: Vec<(&'static str, Vec<[f64; 2]>)>,
}

/// A crossing of a primitive somewhere in the scene.
#[derive(Clone, Copy)]
pub struct Candidate<N> {
    pub crossing: Crossing<N>,
    pub instance: u32,
    pub solid: u32,
    /// Planes that are crossed at exactly the same t, too.
    pub also: [u32; 2],
}

/// Follows the rays of one sample.
pub struct Tracer<'w, 's> {
    pub world: &'w World<'s>,
    pub depth: u8,
    /// The distance of rays of neighboring samples, where textures have levels.
    pub spread: i32,
    /// True if numbers are so slow that intervals are evaluated first.
    pub is_slow: bool,
    /// Number of outcomes that may still be followed.
    pub left: Cell<u32>,
    pub open: RefCell<Vec<Open>>,
    pub steps: Option<RefCell<Vec<Step>>>,
}

/// Most open comparisons that are recorded.
const RECORDED: usize = 16;

/// The end of a search that finds no more.
pub const ENDED: f64 = -1.0;

/// The largest radius of an enclosed vector's components.
fn radius<N: Enclosure>(vector: Three<N>) -> f64 {
    vector.iter().fold(0.0, |most, x| most.max(x.radius()))
}

/// The radius of a ray.
fn radius_of_ray<N: Enclosure>(ray: &Ray<N>) -> f64 {
    let length = ray.direction.iter().map(|x| x.middle().abs());
    let length = length.fold(f64::MIN_POSITIVE, f64::max);
    radius(ray.origin).max(radius(ray.direction) / length)
}

impl Tracer<'_, '_> {
    /// Records an open comparison that depends on a point.
    pub fn note<N: Enclosure>(&self, reason: Reason, depth: u8, primitive: u32, point: Three<N>) {
        self.record(reason, (depth, primitive), point, || radius(point));
    }

    /// Records an open comparison of what a ray meets, near a point.
    ///
    /// Where the ray touches a surface, the point is less exact than what is compared.
    pub fn note_near<N: Enclosure>(
        &self,
        reason: Reason,
        place: (u8, u32),
        point: Three<N>,
        ray: &Ray<N>,
    ) {
        self.record(reason, place, point, || radius_of_ray(ray));
    }

    /// Records an open comparison of what a ray meets, without a place along it.
    pub fn note_ray<N: Enclosure>(&self, reason: Reason, depth: u8, primitive: u32, ray: &Ray<N>) {
        self.note_near(reason, (depth, primitive), ray.origin, ray);
    }

    fn record<N: Enclosure>(
        &self,
        reason: Reason,
        (depth, primitive): (u8, u32),
        point: Three<N>,
        radius: impl FnOnce() -> f64,
    ) {
        let mut open = self.open.borrow_mut();
        if open.len() < RECORDED {
            open.push(Open {
                reason,
                depth,
                primitive,
                point: point.map(|x| x.middle() / 256.0),
                radius: radius(),
            });
        }
    }

    /// Returns what follows from a hit, if its bounds are narrow enough.
    ///
    /// # Errors
    /// If there is nothing.
    pub fn narrow<T, N: Enclosure>(
        &self,
        found: Option<T>,
        depth: u8,
        hit: &Hit<N>,
    ) -> Result<T, Stop> {
        self.known(found, Reason::Width, (depth, hit.primitive), hit.point)
    }

    /// Returns without an error if there is room for more numbers.
    ///
    /// # Errors
    /// If it is used up.
    pub fn check_room<N: Enclosure>(&self, depth: u8, ray: &Ray<N>) -> Result<(), Stop> {
        if self.is_slow && deep::is_full() {
            self.note_ray(Reason::Branches, depth, NONE, ray);
            return Err(Stop);
        }
        Ok(())
    }

    /// Returns the result if it is known.
    ///
    /// # Errors
    /// If it is open, with the reason and the place.
    pub fn known<T, N: Enclosure>(
        &self,
        found: Option<T>,
        reason: Reason,
        (depth, primitive): (u8, u32),
        point: Three<N>,
    ) -> Result<T, Stop> {
        if found.is_none() {
            self.note(reason, depth, primitive, point);
        }
        found.ok_or(Stop)
    }

    /// Takes one more outcome into account.
    ///
    /// # Errors
    /// If there were too many.
    pub fn branch(&self) -> Result<(), Stop> {
        let left = self.left.get();
        if left == 0 {
            return Err(Stop);
        }
        self.left.set(left - 1);
        Ok(())
    }

    pub fn step<const COUNT: usize, N: Enclosure>(
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
                light: None,
                values: values
                    .into_iter()
                    .map(|(name, numbers)| (name, numbers.iter().map(|x| x.bounds()).collect()))
                    .collect(),
            });
        }
    }

    /// States the light of the last step.
    pub fn name_light(&self, number: u32) {
        let Some(steps) = &self.steps else {
            return;
        };
        if let Some(step) = steps.borrow_mut().last_mut() {
            step.light = Some(number);
        }
    }

    pub fn has(&self, effects: Effects) -> bool {
        self.world.scene.effects().contains(effects)
    }

    /// Calls a function with every crossing before an end. The function may move the end nearer.
    pub fn search<N: Enclosure>(
        &self,
        ray: &Ray<N>,
        end: f64,
        depth: u8,
        visit: &mut dyn FnMut(Candidate<N>, f64) -> f64,
    ) -> Result<(), Stop> {
        let own = &self.world.own;
        let mut end = end;
        let mut instances = Vec::new();
        self.search_space((own, NONE), (ray, depth), &mut end, visit, &mut instances)?;
        for instance in instances {
            let placed = &self.world.placed[instance as usize];
            let space = &self.world.parts[placed.part];
            let ray = placed.ray(ray);
            self.search_space(
                (space, instance),
                (&ray, depth),
                &mut end,
                visit,
                &mut Vec::new(),
            )?;
        }
        Ok(())
    }

    fn search_space<N: Enclosure>(
        &self,
        (space, instance): (&Space, u32),
        (ray, depth): (&Ray<N>, u8),
        end: &mut f64,
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
        // Where the search has ended without a result, an end before all boxes leaves out the others.
        let mut test = |number: u32, end: f64| -> f64 {
            if stopped || self.check_room(depth, ray).is_err() {
                stopped = true;
                return ENDED;
            }
            let solid = &space.solids[number as usize];
            let named = (solid, instance);
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
                self.note_ray(Reason::Grazing, depth, solid.primitive, ray);
                stopped = true;
                return ENDED;
            }
            let mut end = end;
            for &crossing in &crossings {
                if crossing.t.bounds()[0] <= end {
                    let candidate = Candidate {
                        crossing,
                        instance,
                        solid: number,
                        also: [NONE; 2],
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

    /// Returns the surface where a ray crosses it.
    pub fn hit<N: Enclosure>(
        &self,
        candidate: &Candidate<N>,
        ray: &Ray<N>,
        depth: u8,
    ) -> Result<Hit<N>, Stop> {
        let Candidate {
            crossing,
            instance,
            solid: number,
            also,
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
            twin: solid.twin,
            part,
            surface: solid.surfaces[usize::from(part)],
            also,
        })
    }
}
