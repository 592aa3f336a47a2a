//! Rays and hits in scene coordinates, as range finders use them.

use glam::DVec3;
use gridel_core::{List, NoCount, Number, Position, Ray, RayError, Scene, Stack, closest_hit};
use gridel_host::compile::{Options, compile};
use gridel_host::shape::{Shape, Sphere};
use gridel_tests::every_format;
use gridel_tests::random::Random;
use gridel_tests::scenes;

/// A ball of some radius around a place, and the hit of a ray on it, in steps: all in double precision.
struct Ball {
    center: DVec3,
    radius: f64,
}

impl Ball {
    fn distance(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let direction = direction.normalize();
        let to = self.center - origin;
        let along = to.dot(direction);
        let across = to - along * direction;
        let half = self.radius * self.radius - across.length_squared();
        (half > 0.0 && along > 0.0).then(|| along - half.sqrt())
    }

    /// Returns the change of a distance per change of the surface's, at the hit: one over the cosine.
    fn slope(&self, origin: DVec3, direction: DVec3, distance: f64) -> f64 {
        let direction = direction.normalize();
        let normal = (origin + distance * direction - self.center) / self.radius;
        1.0 / normal.dot(direction).abs()
    }
}

fn first<N: Number>(scene: &Scene<'_>, ray: &gridel_core::Ray<N>) -> Option<u64> {
    let mut stack = Stack::<0>::new();
    let hit = closest_hit::<N, List, _>(scene, ray, stack.as_view(), &mut NoCount)?;
    Some(scene.distance(ray, &hit))
}

/// The exactness that the documentation states for limits, and for distances: relative to themselves.
fn relative<N: Number>() -> f64 {
    match N::FORMAT {
        gridel_core::Format::Fixed => f64::powi(2.0, -28),
        gridel_core::Format::F32 => f64::powi(2.0, -21),
        gridel_core::Format::F64 => f64::powi(2.0, -50),
    }
}

/// Numbers around halves, at which rounding goes wrong where a half is added: also where a number has no digit for it.
#[test]
fn far_numbers_are_rounded_to_the_nearest_integer() {
    fn check<N: Number>(value: f64) {
        let wide = N::far_from_f64(value / 8192.0);
        // Exact, as is the product.
        let value = N::far_to_f64(wide) * 8192.0;
        let expected = value.round() as i64;
        assert_eq!(N::far_to_q13(wide), expected, "{:?} {value}", N::FORMAT);
        assert_eq!(N::far_to_q13(-wide), -expected, "{:?} {value}", N::FORMAT);
    }
    let largest_below_a_half = [0.499_999_97, 0.5_f64.next_down()];
    let bits = (0..48).map(|bits| f64::powi(2.0, bits));
    let around = bits.flat_map(|power| [power - 1.0, power - 0.5, power + 0.5, power + 1.0]);
    for value in around.chain(largest_below_a_half) {
        check::<f32>(value);
        check::<f64>(value);
    }
}

/// Scenes of all scales, near to their origin and far away from it, and rays from inside and outside.
#[test]
fn distances_are_exact_within_the_stated_bounds() {
    every_format!(distances_of_a_ball());
}

fn distances_of_a_ball<N: Number>() {
    let mut random = Random(11);
    for (scale, moved) in [(1e-6, 0.0), (1.0, 0.0), (1.0, 3.0), (1e7, 0.0), (1.0, 1e7)] {
        let shape = Shape::Sphere(Sphere {
            center: DVec3::new(moved, 0.25 * scale, 0.0),
            radius: scale,
        });
        let compiled = compile(&scenes::of([shape]), &Options::default()).expect("a ball");
        let scene = compiled.blob.scene().expect("the compiler's own blob");
        let header = scene.header();
        let step = f64::powi(2.0, scene.coordinate_exponent());
        let counted_from = DVec3::from_array(header.coordinate_origin());
        let Some(gridel_core::geometry::Geometry::Sphere { center, radius }) =
            scene.geometry(gridel_core::Kind::Sphere, 0)
        else {
            panic!("a ball")
        };
        let unit = f64::powi(2.0, header.unit_exponent.into());
        let on_lattice = DVec3::from_array(center.map(|x| f64::from(x) / 256.0)) * unit;
        // In steps, like the rays.
        let ball = Ball {
            center: (on_lattice + DVec3::from_array(header.origin) - counted_from) / step,
            radius: f64::from(radius) / 256.0 * unit / step,
        };
        let sub_step = unit / 8192.0 / step;
        let mut hits = 0;
        for _ in 0..2000 {
            let way = DVec3::from_array([0; 3].map(|_| random.signed()));
            let origin = (ball.center - 3.5 * ball.radius * way.normalize_or(DVec3::X)).round();
            let aim = ball.center
                + ball.radius * DVec3::from_array([0; 3].map(|_| 0.7 * random.signed()));
            let direction = ((aim - origin) / ball.radius * 1000.0).round();
            let place = Position(origin.to_array().map(|x| x as i32));
            let components = direction.to_array().map(|x| x as i32);
            let ray = scene
                .ray_within::<N>(place, components, [0, u64::MAX])
                .expect("a ray");
            let found = first(&scene, &ray);
            let Some(exact) = ball.distance(origin, direction) else {
                continue;
            };
            // Grazing rays are another matter.
            let slope = ball.slope(origin, direction, exact);
            if slope > 3.0 {
                continue;
            }
            hits += 1;
            let found = found.unwrap_or_else(|| panic!("{:?} at {scale}: a miss", N::FORMAT));
            // The ray's start and slopes are rounded, which the surface's slope turns into distance.
            let largest = (3.5 + 1.0) * ball.radius;
            let rounding = 12.0 * slope * (sub_step + relative::<N>() * largest);
            let apart = (found as f64 - exact).abs();
            assert!(
                apart <= 0.5 + rounding,
                "{:?} at {scale}, {moved}: {found}, {exact}: {apart} apart, {rounding}",
                N::FORMAT
            );
            let around = 4.0 * sub_step + 2.0 * relative::<N>() * exact + 1.0;
            let limited = |limits| {
                first(
                    &scene,
                    &scene
                        .ray_within::<N>(place, components, limits)
                        .expect("a ray"),
                )
            };
            let [below, above] =
                [exact - rounding - around, exact + rounding + around].map(|x| x as u64);
            assert_eq!(
                limited([0, below]),
                None,
                "{:?} at {scale}: nearer",
                N::FORMAT
            );
            assert_eq!(
                limited([0, above]),
                Some(found),
                "{:?} at {scale}: within",
                N::FORMAT
            );
            assert_eq!(
                limited([below, above]),
                Some(found),
                "{:?} at {scale}: between",
                N::FORMAT
            );
            assert_ne!(
                limited([above, u64::MAX]),
                Some(found),
                "{:?} at {scale}: behind",
                N::FORMAT
            );
        }
        assert!(
            hits > 500,
            "{:?} at {scale}, {moved}: {hits} hits",
            N::FORMAT
        );
    }
}

/// Straight along an axis nothing is rounded but the surface.
#[test]
fn hit_along_an_axis_is_at_the_difference_of_the_coordinates() {
    every_format!(hit_along_an_axis());
}

fn hit_along_an_axis<N: Number>() {
    let shape = Shape::Box(gridel_host::shape::Cuboid {
        min: DVec3::splat(-1.0),
        max: DVec3::splat(1.0),
    });
    let compiled = compile(&scenes::of([shape]), &Options::default()).expect("a box");
    let scene = compiled.blob.scene().expect("the compiler's own blob");
    let unit = 1 << -scene.coordinate_exponent();
    for (axis, sign) in [(0, 1), (1, -1), (2, 1)] {
        let (mut place, mut direction) = ([unit / 8; 3], [0; 3]);
        place[axis] = -sign * 3 * unit;
        for length in [1, 7, i32::MAX, i32::MIN + 1] {
            direction[axis] = if length < 0 {
                sign * -length
            } else {
                sign * length
            };
            let ray = scene
                .ray_within::<N>(Position(place), direction, [0, u64::MAX])
                .expect("a ray");
            let mut stack = Stack::<0>::new();
            let hit = closest_hit::<N, List, _>(&scene, &ray, stack.as_view(), &mut NoCount)
                .expect("a hit");
            assert_eq!(scene.distance(&ray, &hit), 2 * unit as u64);
            let mut met = place;
            met[axis] = -sign * unit;
            assert_eq!(scene.hit_position(&ray, &hit).0, met);
        }
    }
}

/// A step of 2 sub-steps: what a place of 0.26 steps away is rounded to must not be rounded again.
#[test]
fn distances_in_floats_are_rounded_once() {
    let file = "[[object]]\nkind = 'box'\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\n[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]";
    let imported = gridel_host::scene::read("box.toml".as_ref(), file.into(), &Default::default());
    let compiled = compile(&imported.expect("a box").scene, &Options::default()).expect("a box");
    let scene = compiled.blob.scene().expect("the compiler's own blob");
    let shift = scene.header().coordinate_shift;
    assert!(shift > 0);
    let ray =
        Ray::<f64>::from_f64(scene.bounds(), [0.0; 3], [0.0, 0.0, -1.0], 0.0, 1e9).expect("a ray");
    let step = f64::powi(2.0, i32::from(shift) - 13);
    for (steps, rounded) in [(0.26, 0), (0.49, 0), (0.51, 1), (2.26, 2), (7.49, 7)] {
        assert_eq!(scene.distance_at(&ray, steps * step), rounded, "{steps}");
    }
}

#[test]
fn rays_without_direction_or_interval_are_rejected() {
    every_format!(rejected());
}

fn rejected<N: Number>() {
    let shape = Shape::Sphere(Sphere {
        center: DVec3::ZERO,
        radius: 1.0,
    });
    let compiled = compile(&scenes::of([shape]), &Options::default()).expect("a ball");
    let scene = compiled.blob.scene().expect("the compiler's own blob");
    let ray = |direction, limits| {
        scene
            .ray_within::<N>(Position([0; 3]), direction, limits)
            .err()
    };
    assert_eq!(ray([0; 3], [0, 1]), Some(RayError::Direction));
    assert_eq!(ray([0, 1, 0], [2, 1]), Some(RayError::Interval));
    assert_eq!(ray([0, 1, 0], [u64::MAX, u64::MAX]), None);
    assert_eq!(ray([i32::MIN; 3], [0, u64::MAX - 1]), None);
}

/// Planes go on beyond the places that a length in units holds.
#[test]
fn places_on_a_plane_are_where_the_ray_meets_it() {
    every_format!(places_on_a_plane());
}

fn places_on_a_plane<N: Number>() {
    let ball = Sphere {
        center: DVec3::ZERO,
        radius: 1.0,
    };
    let ground = gridel_host::shape::Plane {
        point: DVec3::NEG_Y,
        normal: DVec3::Y,
    };
    let shapes = [Shape::Sphere(ball), Shape::Plane(ground)];
    let compiled = compile(&scenes::of(shapes), &Options::default()).expect("a ball on a plane");
    let scene = compiled.blob.scene().expect("the compiler's own blob");
    let unit = f64::powi(2.0, -scene.coordinate_exponent());
    let height = 2.0;
    for run in [1, 4, 5, 6, 7, 9, 10, 15, 40, -5, -10] {
        // 3 down for each `run` along x.
        let ray = scene
            .ray_within::<N>(
                Position([0, (height * unit) as i32, 0]),
                [run, -1, 0],
                [0, u64::MAX],
            )
            .expect("a ray");
        let mut stack = Stack::<0>::new();
        let hit = closest_hit::<N, List, _>(&scene, &ray, stack.as_view(), &mut NoCount)
            .expect("the plane");
        let place = scene
            .hit_position(&ray, &hit)
            .0
            .map(|x| f64::from(x) / unit);
        let farthest = 2_147_483_647.0 / unit;
        let x = (3.0 * f64::from(run)).clamp(-farthest - 1.0 / unit, farthest);
        let near = |found: f64, expected: f64| (found - expected).abs() < 1e-4 * (1.0 + x.abs());
        assert!(
            near(place[0], x) && near(place[1], -1.0) && near(place[2], 0.0),
            "{run}: {place:?}"
        );
    }
}
