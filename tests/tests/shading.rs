//! Light at surfaces (hard cases F): rays leave glass as often as they enter it, contact is kept,
//! lights do not shadow themselves. Laws of single surfaces are tested with `glass` in the core,
//! self-hits in `shapes`, pictures in `render`.

use glam::DVec3;
use gridel_core::{Flagged, Format, Hit, List, NoCount, Number, Scene, Settings, Structure};
use gridel_host::compile::{Options, compile};
use gridel_host::render::{Job, render};
use gridel_host::scene::{Camera, Diffuse, Light, Material, Shape};
use gridel_host::shape::Solid;
use gridel_host::shape::{Cone, Cuboid, Disc, Sphere, Torus};
use gridel_tests::cases::{SHAPES, cases};
use gridel_tests::effort::part_of;
use gridel_tests::judge::blob_of;
use gridel_tests::measured::{measured_color, read};
use gridel_tests::query::{UnitRay, closest, depart, point_of};
use gridel_tests::random::Random;
use gridel_tests::{every_format, scenes};
use rayon::prelude::*;

fn vector(v: [f64; 3]) -> DVec3 {
    DVec3::from_array(v)
}

/// The refracted direction by Snell's law in double precision, `None` where all is reflected.
fn refracted(eta: f64, way: DVec3, normal: DVec3) -> Option<DVec3> {
    let cos = -way.dot(normal);
    let rest = 1.0 - eta * eta * (1.0 - cos * cos);
    (rest >= 0.0).then(|| eta * way + (eta * cos - rest.sqrt()) * normal)
}

/// The outcome of a path through glass.
#[derive(Clone, Copy, Default)]
struct Path {
    surfaces: usize,
    /// True if it hit a surface from the wrong side, or none although it was inside.
    odd: bool,
}

/// Follows one path through a solid of glass.
fn path<N: Number>(
    scene: &Scene<'_>,
    random: &mut Random,
    (origin, way): ([f64; 3], DVec3),
) -> Path {
    const INVERSE_INDEX: f64 = 0.66;
    let (mut from, mut way, mut inside) = (origin, way.normalize(), false);
    let mut path = Path::default();
    for _ in 0..24 {
        let ray = UnitRay::new(from, way.to_array()).ready::<N>(scene);
        let hit = closest::<N, Flagged>(scene, &ray.expect("a ray"), &mut NoCount)
            .filter(|hit: &Hit<N>| hit.primitive == 0);
        let Some(hit) = hit else {
            // Out of the solid: right if the path was not inside.
            path.odd = inside;
            return path;
        };
        path.surfaces += 1;
        if hit.front == inside {
            path.odd = true;
            return path;
        }
        let outward = vector(hit.normal.map(N::ratio_to_f64));
        let normal = if hit.front { outward } else { -outward };
        let eta = if hit.front {
            INVERSE_INDEX
        } else {
            1.0 / INVERSE_INDEX
        };
        let through = refracted(eta, way, normal).filter(|_| !random.one_in(4));
        let side = match through {
            Some(through) => {
                way = through.normalize();
                inside = !inside;
                -1.0
            }
            None => {
                way = (way - 2.0 * way.dot(normal) * normal).normalize();
                1.0
            }
        };
        from = depart(scene, &hit, (side > 0.0) == hit.front);
    }
    path
}

/// A path enters and leaves glass in turn (F3), at edges, rims and tips, too: 10^6 paths a format in
/// the full run.
#[test]
fn glass_is_left_as_often_as_it_is_entered() {
    type Rays = Vec<([f64; 3], [f64; 3])>;
    fn judge<N: Number>(name: &str, solids: &[(Solid, Rays)]) {
        let tallies = solids
            .par_iter()
            .enumerate()
            .map(|(number, (solid, rays))| {
                let blob = blob_of([solid]);
                let scene = blob.scene().expect("a scene");
                let mut random = Random(number as u64);
                let (mut surfaces, mut odd) = (0, 0);
                for &(origin, way) in rays {
                    let path = path::<N>(&scene, &mut random, (origin, vector(way)));
                    if path.odd && odd == 0 {
                        eprintln!(
                            "odd: {name} {}: {solid:?} {origin:?} {way:?}",
                            N::FORMAT.name()
                        );
                    }
                    surfaces += path.surfaces;
                    odd += usize::from(path.odd);
                }
                [rays.len(), surfaces, odd]
            });
        let sum = |a: [usize; 3], b: [usize; 3]| [0, 1, 2].map(|k| a[k] + b[k]);
        let [paths, surfaces, odd] = tallies.reduce(|| [0; 3], sum);
        eprintln!(
            "{name:9} {:5}: {paths} paths, {surfaces} surfaces, {odd} from the wrong side",
            N::FORMAT.name()
        );
        assert_eq!(odd, 0);
        assert!(surfaces > paths / 4);
    }
    let solid_shapes = [0, 2, 4, 5, 6, 7];
    let paths = part_of(25_000, 1_000_000);
    for shape in solid_shapes {
        let count = paths / solid_shapes.len() / 100;
        // Glass thinner than the error bound is no glass: sizes from some units on.
        let all = cases(900 + shape as u64, shape, count * 2, 100);
        let thick = all.into_iter().filter(|case| thickness(&case.solid) > 1.0);
        let solids: Vec<_> = thick
            .map(|case| (case.solid, outside_only(case.rays)))
            .collect();
        every_format!(judge(SHAPES[shape], &solids));
    }
}

/// Rays that start far outside, so that the first surface is entered.
fn outside_only(rays: Vec<([f64; 3], [f64; 3])>) -> Vec<([f64; 3], [f64; 3])> {
    let back = |(origin, way): ([f64; 3], [f64; 3])| {
        ([0, 1, 2].map(|k| origin[k] - 131_072.0 * way[k]), way)
    };
    rays.into_iter().map(back).collect()
}

/// The least of a solid's extents.
fn thickness(solid: &Solid) -> f64 {
    match solid {
        Solid::Sphere(Sphere { radius, .. }) => *radius,
        Solid::Box(Cuboid {
            min: lowest,
            max: highest,
        }) => (*highest - *lowest).min_element(),
        Solid::Cone(Cone {
            base,
            apex,
            base_radius,
            apex_radius,
        }) => base.distance(*apex).min(base_radius.max(*apex_radius)),
        Solid::Torus(Torus { minor_radius, .. }) => *minor_radius,
        _ => 0.0,
    }
}

/// Beneath a ball that rests on a floor it is dark right up to the point of contact (F2).
#[test]
fn shadows_reach_up_to_the_contact() {
    fn judge<N: Number>() {
        let mut random = Random(61);
        let mut rays = 0;
        for _ in 0..part_of(100, 1000) {
            let radius = (random.magnitude(1.0, 9000.0) * 256.0).round() / 256.0;
            let floor = (random.signed() * 10_000.0).round();
            let place = DVec3::new(random.signed() * 9000.0, floor, random.signed() * 9000.0);
            let place = place.round();
            let ball = Solid::Sphere(Sphere {
                center: (place + DVec3::Y * radius),
                radius,
            });
            let floor = Solid::Disc(Disc {
                center: place,
                normal: DVec3::Y,
                radius: radius * 2.0,
            });
            let blob = blob_of([&ball, &floor]);
            let scene = blob.scene().expect("a scene");
            for _ in 0..100 {
                // A ray at the floor from the side, so that it is the floor that it meets.
                let away = random.magnitude(1e-9, 0.9) * radius;
                let angle = std::f64::consts::TAU * random.unit();
                let side = DVec3::new(angle.cos(), 0.0, angle.sin());
                let target = place + side * away;
                let origin = target + side * radius + DVec3::Y * radius * 1e-4;
                let Some(ray) = UnitRay::new(origin.to_array(), (target - origin).to_array())
                    .ready::<N>(&scene)
                else {
                    continue;
                };
                let hit = closest::<N, List>(&scene, &ray, &mut NoCount);
                let Some(hit) = hit.filter(|hit| hit.primitive == 1) else {
                    continue;
                };
                // Where a grazing ray strikes is not where it was aimed at.
                let point = vector(point_of(&hit));
                if point.distance(place) > 0.95 * radius {
                    continue;
                }
                let up = UnitRay::new(depart(&scene, &hit, true), DVec3::Y.to_array());
                let up = up.ready::<N>(&scene).expect("a ray");
                let dark = closest::<N, List>(&scene, &up, &mut NoCount);
                assert!(
                    dark.is_some_and(|hit| hit.primitive == 0),
                    "{ball:?} {target:?}"
                );
                rays += 1;
            }
        }
        assert!(rays > 100);
        eprintln!(
            "{:5}: {rays} places below balls, all dark",
            N::FORMAT.name()
        );
    }
    every_format!(judge());
}

/// A light as near to a floor as its error bound, or far away, is not in the floor's shadow. The
/// floor is not in its own (F4).
#[test]
fn lights_near_a_surface_shine_on_it() {
    for format in Format::ALL {
        for height in [0.02, 0.1, 1.0, 1e3, 1e6] {
            let floor = Shape::Disc(Disc {
                center: DVec3::ZERO,
                normal: DVec3::Y,
                radius: 100.0,
            });
            let mut file = scenes::of([floor]);
            file.materials = vec![Material {
                diffuse: Diffuse::Plain([0.8; 3]),
                ..Material::default()
            }];
            file.ambient = [0.0; 3];
            file.background = Some([0.0; 3]);
            file.lights = vec![Light::Point {
                position: DVec3::new(0.0, height, 0.0),
                color: [1.0; 3],
            }];
            let reach = 1.5 * f64::min(height, 30.0);
            file.camera = Some(Camera {
                eye: DVec3::new(0.0, reach * 3.0, 0.0),
                target: DVec3::ZERO,
                up: DVec3::Z,
                fov_degrees: 30.0,
            });
            let blob = scenes::blob(&file, 24);
            let scene = blob.scene().expect("a scene");
            let settings = Settings {
                width: 33,
                height: 33,
                samples: 1,
                ..Settings::of(&scene)
            };
            let job = Job::whole(format, Structure::Flagged, settings);
            let picture = render(&scene, &job, &|| ()).expect("a picture");
            let dark = picture
                .pixels
                .iter()
                .filter(|pixel| **pixel == [0; 3])
                .count();
            assert_eq!(dark, 0, "{} at {height}", format.name());
        }
    }
}

/// Light that glass reflects has no color. Its weight is the largest of those that the glass lets through.
#[test]
fn tinted_glass_reflects_without_a_tint() {
    // Refracted rays end in the glass.
    let text = "background = 1\nambient = 1\n\
        [camera]\neye = [0, 0, 40]\ntarget = [0, 0, 0]\nfov = 0.02\n\
        [render]\nwidth = 4\nheight = 4\ndepth = 1\n\
        [material.glass]\ndiffuse = 0\ntransmit = [0.75, 0.5, 0]\nior = 1.5\n\
        [[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'glass'\n";
    let blob = compile(&read(text), &Options::default())
        .expect("compiles")
        .blob;
    for format in Format::ALL {
        let (color, _) = measured_color(&blob, format, 1);
        for channel in color {
            assert!(
                (channel - 0.75 * 0.04).abs() < 1e-4,
                "{format:?}: {color:?}"
            );
        }
    }
}
