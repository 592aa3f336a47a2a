use crate::accel::Number;
use crate::accel::clamp::accept_in_box;
use crate::accel::cull::{Cull, Culling};
use crate::format::record::{UnitBox, Vertex24};
use crate::geometry::cuboid::Cuboid;
use crate::geometry::primitive::Primitive;
use crate::geometry::triangle::Projection;
use crate::geometry::{Crossing, accept, sphere, triangle};
use crate::number::Fixed;
use crate::ray::Ray;
use proptest::prelude::*;

const WORLD: UnitBox = UnitBox([[-32_767, 32_767]; 3]);

/// A ray from an origin, in units, to a point, in 1/256 unit.
fn ray<N: Number>(origin: [f64; 3], point: [f64; 3]) -> Option<Ray<N>> {
    let way = |axis: usize| point[axis] / 256.0 - origin[axis];
    Ray::from_f64(&WORLD, origin, [way(0), way(1), way(2)], 0.0, 1e9).ok()
}

/// A crossing that is not clamped equals the clamped one.
fn is_in_its_box<N: Number>(ray: &Ray<N>, crossing: Crossing<N>, bounds: UnitBox) {
    let cull = <Cull as Culling<N>>::new(ray);
    let mut tmax = N::FAR;
    // The crossings behind the first hit, and those up to it only.
    for _ in 0..2 {
        let free = accept(ray, crossing, tmax);
        let clamped = accept_in_box(ray, &cull, crossing, bounds, tmax);
        assert_eq!(free, clamped, "{ray:?} {crossing:?} {bounds:?}");
        let Some((t, _)) = free else { return };
        tmax = t;
    }
}

fn sphere_is_in_its_box<N: Number>(center: [i32; 3], radius: i32, origin: [f64; 3], aim: [f64; 3]) {
    let Some(ray) = ray::<N>(origin, aim) else {
        return;
    };
    let recip_norm2 = N::recip_norm2(ray.slope);
    if let Some(crossing) = sphere::cross(&ray, recip_norm2, center, radius) {
        is_in_its_box(&ray, crossing, sphere::bounds(center, radius));
    }
}

fn box_is_in_its_box<N: Number>(cuboid: &Cuboid, origin: [f64; 3], aim: [f64; 3]) {
    let Some(ray) = ray::<N>(origin, aim) else {
        return;
    };
    if let Some(crossing) = cuboid.cross(&ray, N::ZERO) {
        is_in_its_box(&ray, crossing, cuboid.bounds());
    }
}

fn triangle_is_in_its_box<N: Number>(corners: [[i32; 3]; 3], origin: [f64; 3], aim: [f64; 3]) {
    let Some(ray) = ray::<N>(origin, aim) else {
        return;
    };
    let [a, b, c] = corners.map(Vertex24);
    let projection = Projection::of::<{ triangle::ANY }, Vertex24>(&ray);
    if !projection.meets::<{ triangle::ANY }, Vertex24>(&a, &b, &c) {
        return;
    }
    if let Some(crossing) = triangle::cross(&ray, corners).filter(|crossing| crossing.is_steep) {
        is_in_its_box(&ray, Crossing::flat(crossing.t), triangle::bounds(corners));
    }
}

/// A coordinate in 1/256 unit.
fn coordinate() -> impl Strategy<Value = i32> {
    -8_388_352..=8_388_352_i32
}

/// A place between two sides: on one of them, outside one, or anywhere.
fn share() -> impl Strategy<Value = f64> {
    prop_oneof![
        Just(0.0),
        Just(1.0),
        -0.000_001..0.000_001_f64,
        0.999_999..1.000_001_f64,
        0.0..1.0_f64,
    ]
}

/// An origin in units: near, or so far that it is moved.
fn origin() -> impl Strategy<Value = [f64; 3]> {
    let length = || prop_oneof![-4e4..4e4_f64, -9.8e4..9.8e4_f64, -1e7..1e7_f64];
    [length(), length(), length()]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100_000))]

    /// Mostly grazing rays: they aim at the outline of a sphere.
    #[test]
    fn spheres_are_met_in_their_boxes(
        center in [coordinate(), coordinate(), coordinate()],
        shrink in 0..24_u32,
        origin in origin(),
        turn in [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0],
        beside in prop_oneof![Just(1.0), 0.999_999..1.000_001_f64, 0.99..1.01_f64, 0.0..1.0_f64],
    ) {
        // As large as the world allows, or smaller.
        let room = center.map(|x| 8_388_352 - x.abs()).into_iter().min().unwrap_or(0);
        prop_assume!(room > 0);
        let radius = (room >> shrink).max(1);
        // At right angles to the way to the center.
        let way = [0, 1, 2].map(|axis| f64::from(center[axis]) / 256.0 - origin[axis]);
        let along = way.iter().zip(turn).map(|(w, t)| w * t).sum::<f64>();
        let square = way.iter().map(|w| w * w).sum::<f64>();
        prop_assume!(square > 0.0);
        let across = [0, 1, 2].map(|axis| turn[axis] - way[axis] * along / square);
        let length = across.iter().map(|x| x * x).sum::<f64>().sqrt();
        prop_assume!(length > 1e-9);
        let reach = f64::from(radius) * beside / length;
        let aim = [0, 1, 2].map(|axis| f64::from(center[axis]) + across[axis] * reach);
        sphere_is_in_its_box::<Fixed>(center, radius, origin, aim);
        sphere_is_in_its_box::<f32>(center, radius, origin, aim);
        sphere_is_in_its_box::<f64>(center, radius, origin, aim);
    }

    /// Mostly edges and corners, and faces seen from the side.
    #[test]
    fn boxes_are_met_in_their_boxes(
        corners in [[coordinate(), coordinate()], [coordinate(), coordinate()], [coordinate(), coordinate()]],
        shrink in [0..24_u32, 0..24, 0..24],
        origin in origin(),
        place in [share(), share(), share()],
        level in 0..4_usize,
    ) {
        let sides: [[i32; 2]; 3] = core::array::from_fn(|axis| {
            let [a, b] = corners[axis];
            let b = a + ((b - a) >> shrink[axis]);
            [a.min(b), a.max(b)]
        });
        let cuboid = Cuboid {
            lowest: sides.map(|side| side[0]),
            highest: sides.map(|side| side[1]),
        };
        let aim = [0, 1, 2].map(|axis| {
            let [low, high] = sides[axis].map(f64::from);
            low + (high - low) * place[axis]
        });
        let mut origin = origin;
        if let Some(x) = origin.get_mut(level) {
            *x = aim[level] / 256.0 + *x / 1e4;
        }
        box_is_in_its_box::<Fixed>(&cuboid, origin, aim);
        box_is_in_its_box::<f32>(&cuboid, origin, aim);
        box_is_in_its_box::<f64>(&cuboid, origin, aim);
    }

    /// Thin triangles, and triangles that are seen from the side.
    #[test]
    fn triangles_that_are_met_steeply_are_met_in_their_boxes(
        first in [coordinate(), coordinate(), coordinate()],
        edges in [[coordinate(), coordinate(), coordinate()], [coordinate(), coordinate(), coordinate()]],
        shrink in [0..24_u32, 0..24],
        origin in origin(),
        weights in [0.0..1.0_f64, 0.0..1.0],
        level in 0..4_usize,
    ) {
        let corner = |edge: usize| {
            [0, 1, 2].map(|axis| {
                let step = edges[edge][axis] >> shrink[edge];
                // Flat on an axis, as is an origin level with it.
                let step = if level == axis { step >> 12 } else { step };
                (first[axis] + step).clamp(-8_388_352, 8_388_352)
            })
        };
        let corners = [first, corner(0), corner(1)];
        let [u, v] = weights;
        let [u, v] = if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] };
        let aim = [0, 1, 2].map(|axis| {
            let [a, b, c] = corners.map(|corner| f64::from(corner[axis]));
            a + (b - a) * u + (c - a) * v
        });
        let mut origin = origin;
        if let Some(x) = origin.get_mut(level) {
            *x = aim[level] / 256.0 + *x / 1e4;
        }
        triangle_is_in_its_box::<Fixed>(corners, origin, aim);
    }
}
