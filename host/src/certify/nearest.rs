//! The nearest hits: the crossings that may be the first along a ray.

use super::crossing::{Crossing, Ray, compare};
use super::number::Enclosure;
use super::search::{Candidate, Stop, Tracer};
use super::world::{Form, NONE, Solid, World};
use std::cmp::Ordering;

impl Tracer<'_, '_> {
    /// Returns every crossing that may be the nearest, and whether the ray may hit nothing.
    pub fn nearest<N: Enclosure>(
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
        let mut left: Vec<Candidate<N>> = Vec::new();
        for &(mut candidate) in &found {
            // Each candidate is compared with all others, so many of them fill the room for numbers.
            self.check_room(depth, ray)?;
            if found.iter().any(|other| beats(world, other, &candidate)) {
                continue;
            }
            add_planes(world, &mut candidate, &found);
            if !left.iter().any(|before| alike(world, before, &candidate)) {
                left.push(candidate);
            }
        }
        let may_miss = !found.iter().any(|it| it.crossing.sure);
        Ok((left, may_miss))
    }
}

fn solid<'w, N>(world: &'w World<'_>, it: &Candidate<N>) -> &'w Solid {
    &world.space(it.instance).solids[it.solid as usize]
}

/// The surface that a crossing lies in, if primitives may share it, and its instance.
fn surface<N>(world: &World<'_>, it: &Candidate<N>) -> Option<(u32, u32)> {
    let surface = solid(world, it).surfaces[usize::from(it.crossing.part)];
    (surface != NONE).then_some((it.instance, surface))
}

/// The order of hits at one t, of which the lowest counts: the scene's own primitives, then those of instances, which
/// are ordered by the scene file; within one of these the primitives as the scene file orders them.
fn rank<N>(world: &World<'_>, it: &Candidate<N>) -> (Option<[u32; 2]>, u32, u32) {
    let placed = world.placed.get(it.instance as usize);
    let instance = placed.map(|placed| [placed.number, it.instance]);
    (instance, solid(world, it).primitive, it.solid)
}

/// Compares the t of crossings. Those in one surface have one t.
fn order<N: Enclosure>(world: &World<'_>, a: &Candidate<N>, b: &Candidate<N>) -> Option<Ordering> {
    let is_one = a.instance == b.instance
        && solid(world, a).meets_at_one_t(solid(world, b), [&a.crossing, &b.crossing]);
    if is_one {
        Some(Ordering::Equal)
    } else {
        compare(&a.crossing, &b.crossing)
    }
}

/// Returns whether the first of two crossings certainly comes before the second.
fn beats<N: Enclosure>(world: &World<'_>, a: &Candidate<N>, b: &Candidate<N>) -> bool {
    if (a.instance, a.solid) == (b.instance, b.solid) {
        let (first, second) = (&a.crossing, &b.crossing);
        // A solid is entered before it is left. Those of tori are numbered along the ray.
        if matches!(solid(world, a).form, Form::Torus(_)) {
            let number = |it: &Crossing<N>| (it.part, it.leaves);
            return first.sure && number(first) < number(second);
        }
        if second.leaves && !first.leaves {
            return first.sure;
        }
    }
    a.crossing.sure
        && match order(world, a, b) {
            Some(Ordering::Less) => true,
            Some(Ordering::Equal) => rank(world, a) < rank(world, b),
            _ => false,
        }
}

/// Adds the other planes that are crossed at the same t: what starts there starts on all of them.
fn add_planes<N: Enclosure>(
    world: &World<'_>,
    candidate: &mut Candidate<N>,
    found: &[Candidate<N>],
) {
    for other in found {
        let Some((instance, plane)) = surface(world, other) else {
            continue;
        };
        let is_known = instance != candidate.instance
            || surface(world, candidate) == surface(world, other)
            || candidate.also.contains(&plane);
        if is_known || compare(&candidate.crossing, &other.crossing) != Some(Ordering::Equal) {
            continue;
        }
        if let Some(free) = candidate.also.iter_mut().find(|it| **it == NONE) {
            *free = plane;
        }
    }
}

/// Returns whether two crossings look the same, as those at the common edge of faces of one object in one plane that
/// face the same way.
fn alike<N: Enclosure>(world: &World<'_>, a: &Candidate<N>, b: &Candidate<N>) -> bool {
    let is_plain = |it: &Candidate<N>| {
        let solid = solid(world, it);
        let is_even = !matches!(
            solid.form,
            Form::Triangle {
                smooth: Some(_),
                ..
            } | Form::Cuboid { .. }
                | Form::Cone(_)
        );
        is_even && solid.paint.is_plain()
    };
    // Emission, glass and media depend on the side.
    let side = |it: &Candidate<N>| {
        it.crossing
            .fraction
            .and_then(|[_, approach]| approach.sign())
    };
    surface(world, a).is_some()
        && surface(world, a) == surface(world, b)
        && solid(world, a).object == solid(world, b).object
        && is_plain(a)
        && is_plain(b)
        && side(a).is_some()
        && side(a) == side(b)
}

#[cfg(test)]
mod tests {
    use super::super::crossing::Start;
    use super::super::deep::{Ball, with_bits, with_room};
    use super::super::interval::Interval;
    use super::super::reason::Reason;
    use super::*;
    use crate::compile::{Options, compile};
    use std::cell::{Cell, RefCell};

    /// Calls a function with a tracer of a scene, for numbers of few bits or of many.
    fn with_tracer(file: &str, is_slow: bool, test: impl FnOnce(&Tracer<'_, '_>)) {
        let imported = crate::scene::read("mesh.toml".as_ref(), file.into(), &Default::default());
        let blob = compile(&imported.unwrap().scene, &Options::default());
        let blob = blob.unwrap().blob;
        let scene = blob.scene().unwrap();
        let world = World::of(&scene).unwrap_or_else(|unknown| panic!("{unknown}"));
        test(&Tracer {
            world: &world,
            depth: 0,
            spread: 0,
            is_slow,
            left: Cell::new(12),
            open: RefCell::default(),
            steps: None,
        });
    }

    /// The middle between the first two corners of the scene's first triangle, in lattice steps.
    fn middle(world: &World<'_>) -> [f64; 3] {
        let Form::Triangle {
            corners: [a, b, _], ..
        } = world.own.solids[0].form
        else {
            panic!("no triangle");
        };
        [0, 1, 2].map(|k| 0.5 * (a[k] + b[k]) as f64)
    }

    #[test]
    fn faces_of_one_plane_that_face_opposite_ways_do_not_look_alike() {
        let found = |faces: &str| {
            let file = format!(
                "[[object]]\nkind = 'mesh'\nfaces = {faces}\n\
                 vertices = [[-1, -1, 0], [1, 1, 0], [-1, 1, 0], [1, -1, 0]]\n"
            );
            let mut count = 0;
            with_tracer(&file, false, |tracer| {
                let near = |x: f64| Interval::new(x - 1.0, x + 1.0);
                let [x, y, z] = middle(tracer.world);
                let ray = Ray {
                    origin: [near(x), near(y), Interval::float(z + 4096.0)],
                    direction: [0.0, 0.0, -1.0].map(Interval::float),
                    start: Start::Free,
                };
                count = tracer.nearest(&ray, 0).unwrap().0.len();
            });
            count
        };
        assert_eq!(found("[[0, 1, 2], [1, 0, 3]]"), 1);
        assert_eq!(found("[[0, 1, 2], [0, 1, 3]]"), 2);
    }

    #[test]
    fn search_ends_where_the_room_for_numbers_is_used_up() {
        let mut file = String::new();
        for x in 0..400 {
            file += &format!(
                "[[object]]\nkind = 'triangle'\nvertices = [[{x}, 0, 0], [{x}, 1, 0], [{x}.5, 0, 0.5]]\n"
            );
        }
        with_tracer(&file, true, |tracer| {
            with_bits(128, || {
                const MOST: usize = 10_000;
                let ((), taken) = with_room(MOST, || {
                    let [x, y, z] = middle(tracer.world).map(Ball::float);
                    let wide = Ball::float(-0.5).hull(Ball::float(0.5));
                    let ray = Ray {
                        origin: [x, y, z + Ball::int(1 << 26)],
                        direction: [Ball::float(0.5) + wide, wide, -Ball::one()],
                        start: Start::Free,
                    };
                    assert!(tracer.nearest(&ray, 0).is_err());
                });
                // The test that exceeds it comes to its end.
                assert!((MOST..MOST + 1_000).contains(&taken), "{taken}");
            });
            let open = tracer.open.borrow();
            assert_eq!(open[0].reason, Reason::Branches);
        });
    }

    #[test]
    fn search_ends_where_a_ray_grazes() {
        let mut file = String::new();
        for x in 0..400 {
            file += &format!("[[object]]\nkind = 'sphere'\ncenter = [{x}, 0, 0]\nradius = 0.25\n");
        }
        with_tracer(&file, true, |tracer| {
            with_bits(128, || {
                let any = Ball::float(-1.0).hull(Ball::one());
                let ray = Ray {
                    origin: [Ball::zero(); 3],
                    direction: [any; 3],
                    start: Start::Free,
                };
                let (found, taken) = with_room(1 << 20, || tracer.nearest(&ray, 0).is_err());
                assert!(found && taken < 1_000, "{taken}");
            });
            assert_eq!(tracer.open.borrow().len(), 1);
        });
    }
}
