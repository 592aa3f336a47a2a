//! Rays of every sort that a structure can go wrong on, aimed at one scene.

use super::placed::PlacedPart;
use crate::random::Random;
use crate::trace::UnitRay;
use gridel_core::format::record::UnitBox;
use gridel_core::{Kind, Scene};

/// Places of a scene that rays are aimed at: some of its boxes, and some of its triangles.
pub struct Targets {
    bounds: UnitBox,
    boxes: Vec<UnitBox>,
    triangles: Vec<[[f64; 3]; 3]>,
    /// The camera's eye and the point lights.
    points: Vec<[f64; 3]>,
}

/// Sorts of rays, in turn.
const SORTS: [fn(&Targets, &mut Random) -> UnitRay; 15] = [
    primary,
    random_ray,
    along_an_axis,
    in_a_face,
    at_a_vertex,
    from_afar,
    from_inside,
    of_any_length,
    nearly_parallel,
    with_a_window,
    grazing,
    from_on_a_surface,
    in_a_cells_plane,
    from_a_point,
    to_a_point,
];

/// Endless rays through a scene, all sorts in turn; the same for the same seed.
pub fn rays(scene: &Scene<'_>, seed: u64) -> impl Iterator<Item = UnitRay> + use<> {
    let targets = Targets::of(scene);
    let mut random = Random(seed);
    (0..).map(move |number: usize| targets.ray(number, &mut random))
}

/// Returns endless rays that go through a scene and, except in rare cases, touch neither edges nor
/// the surface that they start from.
pub fn plain_rays(scene: &Scene<'_>, seed: u64) -> impl Iterator<Item = UnitRay> + use<> {
    let targets = Targets::of(scene);
    let mut random = Random(seed);
    (0..).map(move |number: usize| [primary, random_ray][number % 2](&targets, &mut random))
}

impl Targets {
    /// Endless rays, all sorts in turn; the same for the same seed.
    pub fn rays(&self, seed: u64) -> impl Iterator<Item = UnitRay> {
        let mut random = Random(seed);
        (0..).map(move |number: usize| self.ray(number, &mut random))
    }

    fn ray(&self, number: usize, random: &mut Random) -> UnitRay {
        SORTS[number % SORTS.len()](self, random)
    }

    /// Returns the targets of a scene: of many primitives of a kind, some thousands.
    pub fn of(scene: &Scene<'_>) -> Self {
        const MOST: usize = 4000;
        let chosen = |kind: Kind| {
            let count = scene.count(kind);
            let step = count.div_ceil(MOST).max(1);
            (0..count).step_by(step)
        };
        let boxes = Kind::ALL.iter().flat_map(|&kind| {
            chosen(kind).filter_map(move |slot| scene.primitive_bounds(kind, slot))
        });
        let triangles = chosen(Kind::Triangle).filter_map(|slot| scene.triangle(slot));
        let point_lights = scene.lights().iter().filter(|it| it.kind == 0);
        let units = |corners: [[i32; 3]; 3]| corners.map(|it| it.map(|x| f64::from(x) / 256.0));
        let mut targets = Self {
            bounds: *scene.bounds(),
            boxes: boxes.collect(),
            triangles: triangles.map(units).collect(),
            points: std::iter::once(scene.view().eye)
                .chain(point_lights.map(|light| light.vector))
                .map(|place| place.map(|x| x as f64 / 8192.0))
                .collect(),
        };
        let placed = PlacedPart::all(scene);
        let placed: Vec<_> = placed
            .iter()
            .flatten()
            .step_by(placed.len().div_ceil(MOST).max(1))
            .collect();
        // Others of each instance.
        let each = MOST / placed.len().max(1);
        for (number, placed) in placed.iter().enumerate() {
            targets.boxes.push(placed.bounds);
            let part = &scene.parts()[placed.part];
            let count = part.count(Kind::Triangle);
            let step = count.div_ceil(each).max(1);
            let slots = (number % step..count).step_by(step);
            let triangles = slots.filter_map(|slot| part.triangle(slot)).map(units);
            let map = &placed.map;
            let in_scene = triangles.map(|corners| corners.map(|corner| map.back(corner)));
            targets.triangles.extend(in_scene);
        }
        targets.boxes.push(targets.bounds);
        targets
    }

    fn a_box(&self, random: &mut Random) -> UnitBox {
        self.boxes[random.below(self.boxes.len())]
    }

    /// A point in one of the scene's boxes; on its faces and corners, too.
    fn target(&self, random: &mut Random) -> [f64; 3] {
        self.a_box(random).0.map(|[low, high]| {
            let (low, high) = (f64::from(low), f64::from(high));
            match random.below(8) {
                0 => low,
                1 => high,
                _ => low + random.unit() * (high - low),
            }
        })
    }

    /// A point in the scene's box made larger by a factor.
    fn around(&self, random: &mut Random, factor: f64) -> [f64; 3] {
        self.bounds.0.map(|[low, high]| {
            let (low, high) = (f64::from(low), f64::from(high));
            0.5 * (low + high) + random.signed() * factor * (0.5 * (high - low)).max(1.0)
        })
    }
}

fn between(from: [f64; 3], to: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| to[axis] - from[axis])
}

/// A ray at a point; one of length 0 is turned along an axis.
fn at(origin: [f64; 3], target: [f64; 3]) -> UnitRay {
    let direction = between(origin, target);
    let zero = direction == [0.0; 3];
    UnitRay::new(origin, if zero { [0.0, 0.0, 1.0] } else { direction })
}

fn primary(targets: &Targets, random: &mut Random) -> UnitRay {
    // A fixed eye and a film of 1024 by 1024 places.
    let size = |axis: usize| {
        let [low, high] = targets.bounds.0[axis].map(f64::from);
        (0.5 * (low + high), 0.5 * (high - low).max(1.0))
    };
    let ((x, w), (y, h), (z, d)) = (size(0), size(1), size(2));
    let mut film = |half: f64| half * (random.below(1024) as f64 / 512.0 - 1.0);
    let across = film(1.2 * w.max(d));
    at(
        [x + 1.7 * w, y + 1.1 * h, z + 3.1 * d],
        [x + across, y + film(1.2 * h), z - across],
    )
}

fn random_ray(targets: &Targets, random: &mut Random) -> UnitRay {
    UnitRay::new(targets.around(random, 1.2), random.direction())
}

fn along_an_axis(targets: &Targets, random: &mut Random) -> UnitRay {
    let zero = |random: &mut Random| if random.one_in(2) { 0.0 } else { -0.0 };
    let mut direction = [zero(random), zero(random), zero(random)];
    let axis = random.below(3);
    direction[axis] = if random.one_in(2) { 1.0 } else { -1.0 };
    let mut origin = targets.target(random);
    origin[axis] -= direction[axis] * random.unit() * 1e5;
    UnitRay::new(origin, direction)
}

fn in_a_face(targets: &Targets, random: &mut Random) -> UnitRay {
    let bounds = targets.a_box(random);
    let axis = random.below(3);
    let plane = f64::from(bounds.0[axis][random.below(2)]);
    let mut origin = targets.around(random, 1.1);
    let mut target = bounds.0.map(|sides| f64::from(sides[random.below(2)]));
    origin[axis] = plane;
    target[axis] = plane;
    let mut ray = at(origin, target);
    if random.one_in(2) {
        // Along an edge of the box.
        let other = (axis + 1) % 3;
        ray.origin[other] = f64::from(bounds.0[other][random.below(2)]);
        ray.direction = [0.0; 3];
        ray.direction[(axis + 2) % 3] = random.signed();
    }
    ray
}

fn at_a_vertex(targets: &Targets, random: &mut Random) -> UnitRay {
    if targets.triangles.is_empty() {
        return at(targets.around(random, 1.3), targets.target(random));
    }
    let corners = targets.triangles[random.below(targets.triangles.len())];
    let first = random.below(3);
    let (a, b, c) = (
        corners[first],
        corners[(first + 1) % 3],
        corners[(first + 2) % 3],
    );
    let mix = |a: [f64; 3], b: [f64; 3], part: f64| {
        [0, 1, 2].map(|axis| a[axis] + part * (b[axis] - a[axis]))
    };
    match random.below(4) {
        0 => at(targets.around(random, 1.3), a),
        1 => at(
            targets.around(random, 1.3),
            mix(a, b, 0.25 * random.below(5) as f64),
        ),
        // Along the edge, from before it or from its end.
        2 => at(mix(a, b, -(random.below(3) as f64)), b),
        // In the triangle's plane.
        _ => at(mix(a, b, -2.0), mix(b, c, 0.5)),
    }
}

fn from_afar(targets: &Targets, random: &mut Random) -> UnitRay {
    let target = targets.target(random);
    let (distance, direction) = (random.magnitude(1e5, 1e11), random.direction());
    let origin = [0, 1, 2].map(|axis| target[axis] - distance * direction[axis]);
    UnitRay::new(origin, direction)
}

fn from_inside(targets: &Targets, random: &mut Random) -> UnitRay {
    let middle = targets
        .a_box(random)
        .0
        .map(|[low, high]| 0.5 * (f64::from(low) + f64::from(high)));
    UnitRay::new(middle, random.direction())
}

fn of_any_length(targets: &Targets, random: &mut Random) -> UnitRay {
    let mut ray = at(targets.around(random, 1.5), targets.target(random));
    let largest = ray
        .direction
        .iter()
        .fold(0.0_f64, |most, x| most.max(x.abs()));
    let scale = random.magnitude(1e-300, 1e300) / largest;
    ray.direction = ray.direction.map(|x| x * scale);
    ray
}

/// Slopes about 2^-12, where culling changes its rule, and far below.
fn nearly_parallel(targets: &Targets, random: &mut Random) -> UnitRay {
    let target = targets.target(random);
    let major = random.below(3);
    let slope = |random: &mut Random| match random.below(4) {
        0 => 1.0 / 4096.0,
        1 => random.magnitude(0.9, 1.1) / 4096.0,
        2 => random.magnitude(1e-40, 1e-4),
        _ => 0.0,
    };
    let sign = |random: &mut Random| if random.one_in(2) { 1.0 } else { -1.0 };
    let mut direction = [0; 3].map(|_| slope(random) * sign(random));
    direction[major] = sign(random);
    let back = random.unit() * 7e4;
    let origin = [0, 1, 2].map(|axis| target[axis] - back * direction[axis]);
    UnitRay::new(origin, direction)
}

fn with_a_window(targets: &Targets, random: &mut Random) -> UnitRay {
    let mut ray = at(targets.around(random, 2.0), targets.target(random));
    let largest = ray
        .direction
        .iter()
        .fold(0.0_f64, |most, x| most.max(x.abs()));
    // 1 is the target, which is often a side of a box.
    let place = |random: &mut Random| match random.below(5) {
        0 => largest,
        1 => 0.0,
        2 => -largest * random.unit(),
        _ => 2.0 * largest * random.signed(),
    };
    let (a, b) = (place(random), place(random));
    (ray.tmin, ray.tmax) = (a.min(b), a.max(b));
    match random.below(4) {
        0 => ray.tmax = f64::INFINITY,
        1 => ray.tmin = f64::NEG_INFINITY,
        _ => {}
    }
    ray
}

/// Returns a ray along the side of the primitive in a box, at the distance of its round or flat
/// side.
fn grazing(targets: &Targets, random: &mut Random) -> UnitRay {
    let bounds = targets.a_box(random).0.map(|side| side.map(f64::from));
    let axis = random.below(3);
    let mut target = bounds.map(|[low, high]| 0.5 * (low + high));
    target[axis] = bounds[axis][random.below(2)];
    let off = [0.0, 0.0, 1.0, -1.0][random.below(4)] * random.magnitude(1e-12, 1e-2);
    let [low, high] = bounds[axis];
    target[axis] += off * (high - low).max(1.0);
    let mut direction = random.direction();
    // In the side's plane, or nearly.
    direction[axis] = if random.one_in(2) {
        0.0
    } else {
        random.magnitude(1e-15, 1e-3)
    };
    let back = random.unit() * 1e5;
    let origin = [0, 1, 2].map(|k| target[k] - back * direction[k]);
    UnitRay::new(origin, direction)
}

/// Returns a ray from a vertex, an edge or a face of a triangle, or else of a box, in any direction.
fn from_on_a_surface(targets: &Targets, random: &mut Random) -> UnitRay {
    let origin = if targets.triangles.is_empty() {
        let mut place = targets.target(random);
        let bounds = targets.a_box(random);
        let axis = random.below(3);
        place[axis] = f64::from(bounds.0[axis][random.below(2)]);
        place
    } else {
        let [a, b, c] = targets.triangles[random.below(targets.triangles.len())];
        let (mut u, mut v) = (random.unit(), random.unit());
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        let (u, v) = [(0.0, 0.0), (0.5, 0.0), (u, v)][random.below(3)];
        [0, 1, 2].map(|k| a[k] + u * (b[k] - a[k]) + v * (c[k] - a[k]))
    };
    UnitRay::new(origin, random.direction())
}

/// Returns a ray in a plane between two cells of the scene's box cut evenly. It runs along the
/// plane, across an edge of cells, or from corner to corner.
fn in_a_cells_plane(targets: &Targets, random: &mut Random) -> UnitRay {
    let cells = [2, 3, 4, 8, 16, 64][random.below(6)];
    let corner = |random: &mut Random| {
        targets.bounds.0.map(|[low, high]| {
            let (low, high) = (f64::from(low), f64::from(high));
            low + (high - low) * random.below(cells + 1) as f64 / cells as f64
        })
    };
    let (mut origin, target) = (corner(random), corner(random));
    let axis = random.below(3);
    match random.below(3) {
        0 => origin[axis] = target[axis],
        1 => {
            origin[axis] = target[axis];
            origin[(axis + 1) % 3] = target[(axis + 1) % 3];
        }
        _ => {}
    }
    at(origin, target)
}

/// Returns a ray from the eye or a light, or from close by.
fn from_a_point(targets: &Targets, random: &mut Random) -> UnitRay {
    let point = targets.points[random.below(targets.points.len())];
    let aside = [0.0, 0.0, 1e-3, 3.0, 5.0, 100.0][random.below(6)];
    let origin = point.map(|x| x + random.signed() * aside);
    if random.one_in(6) {
        return UnitRay::new(origin, random.direction());
    }
    let mut ray = at(origin, targets.target(random));
    if random.one_in(4) {
        // Beginning on either side of the point.
        let whole = ray
            .direction
            .iter()
            .fold(0.0_f64, |most, x| most.max(x.abs()));
        ray.tmin = whole * random.signed();
        ray.tmax = ray.tmin + 2.0 * whole * random.unit();
    }
    ray
}

/// Returns a ray to the eye or a light, and seldom beyond.
fn to_a_point(targets: &Targets, random: &mut Random) -> UnitRay {
    let point = targets.points[random.below(targets.points.len())];
    let aside = [0.0, 0.0, 1e-3, 3.0, 5.0, 100.0][random.below(6)];
    let target = point.map(|x| x + random.signed() * aside);
    let mut ray = at(targets.target(random), target);
    let whole = (0..3)
        .map(|k| (target[k] - ray.origin[k]).abs())
        .fold(0.0, f64::max);
    ray.tmax = whole * [1.0, 1.0, 0.999, 1.0001, 3.0, f64::INFINITY][random.below(6)];
    ray
}
