//! obvhs, as its documentation uses it.

use crate::contender::{Contender, Trace};
use crate::workload::{Answer, Geometry, Query};
use ::obvhs::bvh2::builder::{build_bvh2, build_bvh2_from_tris};
use ::obvhs::cwbvh::builder::{build_cwbvh, build_cwbvh_from_tris};
use ::obvhs::ray::{Ray, RayHit};
use ::obvhs::triangle::Triangle;
use ::obvhs::{Boundable, BvhBuildParams};
use glam::{Vec3, Vec3A};
use std::time::{Duration, Instant};

/// Its two structures, built.
pub fn contenders(geometry: &Geometry) -> Vec<Contender<'static>> {
    match geometry {
        Geometry::Triangles(triangles) => vec![bvh2(triangles), cwbvh(triangles)],
        Geometry::Spheres(spheres) => vec![bvh2_of_spheres(spheres), cwbvh_of_spheres(spheres)],
    }
}

fn prepared(triangles: &[[Vec3; 3]]) -> Vec<Triangle> {
    let corner = |point: Vec3| Vec3A::from(point);
    let each = |&[a, b, c]: &[Vec3; 3]| Triangle {
        v0: corner(a),
        v1: corner(b),
        v2: corner(c),
    };
    triangles.iter().map(each).collect()
}

fn ray(query: &Query) -> Ray {
    Ray::new_inf(query.origin.into(), query.direction.into())
}

macro_rules! obvhs {
    ($name:literal, $structure:expr, $ordered:expr, $started:expr, $bytes:expr) => {{
        let (structure, ordered) = ($structure, $ordered);
        Contender {
            name: $name.to_owned(),
            seconds: $started,
            bytes: $bytes,
            trace: Trace::OfQueries(Box::new(move |queries, any, answers| {
                for (query, answer) in queries.iter().zip(answers) {
                    *answer = if any {
                        let miss = structure
                            .ray_traverse_miss(ray(query), |ray, id| ordered[id].intersect(ray));
                        Answer {
                            t: if miss { f32::INFINITY } else { 0.0 },
                        }
                    } else {
                        let mut hit = RayHit::none();
                        structure.ray_traverse(ray(query), &mut hit, |ray, id| {
                            ordered[id].intersect(ray)
                        });
                        Answer { t: hit.t }
                    };
                }
            })),
        }
    }};
}

fn bvh2(triangles: &[[Vec3; 3]]) -> Contender<'static> {
    let all = prepared(triangles);
    let started = Instant::now();
    let structure = build_bvh2_from_tris(
        &all,
        BvhBuildParams::medium_build(),
        &mut Duration::default(),
    );
    let seconds = started.elapsed().as_secs_f64();
    let order = &structure.primitive_indices;
    let ordered: Vec<Triangle> = order.iter().map(|&it| all[it as usize]).collect();
    let bytes =
        size_of_val(&structure.nodes[..]) + size_of_val(&order[..]) + size_of_val(&ordered[..]);
    obvhs!("obvhs Bvh2", structure, ordered, seconds, bytes)
}

fn cwbvh(triangles: &[[Vec3; 3]]) -> Contender<'static> {
    let all = prepared(triangles);
    let started = Instant::now();
    let structure = build_cwbvh_from_tris(
        &all,
        BvhBuildParams::medium_build(),
        &mut Duration::default(),
    );
    let seconds = started.elapsed().as_secs_f64();
    let order = &structure.primitive_indices;
    let ordered: Vec<Triangle> = order.iter().map(|&it| all[it as usize]).collect();
    let bytes =
        size_of_val(&structure.nodes[..]) + size_of_val(&order[..]) + size_of_val(&ordered[..]);
    obvhs!("obvhs CwBvh", structure, ordered, seconds, bytes)
}

/// A sphere for obvhs, which has none: the textbook's test in the library's own vectors.
#[derive(Clone, Copy)]
struct BoundingSphere {
    center: Vec3A,
    radius: f32,
}

impl Boundable for BoundingSphere {
    fn aabb(&self) -> ::obvhs::aabb::Aabb {
        ::obvhs::aabb::Aabb::new(self.center - self.radius, self.center + self.radius)
    }
}

impl BoundingSphere {
    fn intersect(&self, ray: &Ray) -> f32 {
        let towards = self.center - ray.origin;
        let closest = towards.dot(ray.direction);
        let apart = towards - closest * ray.direction;
        let square = self.radius * self.radius - apart.dot(apart);
        if square < 0.0 {
            return f32::INFINITY;
        }
        let half = square.sqrt();
        let (enter, leave) = (closest - half, closest + half);
        if enter >= ray.tmin {
            enter
        } else if leave >= ray.tmin {
            leave
        } else {
            f32::INFINITY
        }
    }
}

fn balls(spheres: &[(Vec3, f32)]) -> Vec<BoundingSphere> {
    let each = |&(center, radius): &(Vec3, f32)| BoundingSphere {
        center: center.into(),
        radius,
    };
    spheres.iter().map(each).collect()
}

fn bvh2_of_spheres(spheres: &[(Vec3, f32)]) -> Contender<'static> {
    let all = balls(spheres);
    let started = Instant::now();
    let structure = build_bvh2(
        &all,
        BvhBuildParams::medium_build(),
        &mut Duration::default(),
    );
    let seconds = started.elapsed().as_secs_f64();
    let order = &structure.primitive_indices;
    let ordered: Vec<BoundingSphere> = order.iter().map(|&it| all[it as usize]).collect();
    // Center and radius fit 16 bytes.
    let bytes = size_of_val(&structure.nodes[..]) + size_of_val(&order[..]) + 16 * ordered.len();
    obvhs!("obvhs Bvh2", structure, ordered, seconds, bytes)
}

fn cwbvh_of_spheres(spheres: &[(Vec3, f32)]) -> Contender<'static> {
    let all = balls(spheres);
    let started = Instant::now();
    let structure = build_cwbvh(
        &all,
        BvhBuildParams::medium_build(),
        &mut Duration::default(),
    );
    let seconds = started.elapsed().as_secs_f64();
    let order = &structure.primitive_indices;
    let ordered: Vec<BoundingSphere> = order.iter().map(|&it| all[it as usize]).collect();
    let bytes = size_of_val(&structure.nodes[..]) + size_of_val(&order[..]) + 16 * ordered.len();
    obvhs!("obvhs CwBvh", structure, ordered, seconds, bytes)
}

/// Finds the primitive that a ray meets, for its normal.
pub struct Nearest {
    structure: ::obvhs::bvh2::Bvh2,
    triangles: Vec<Triangle>,
    balls: Vec<BoundingSphere>,
}

impl Nearest {
    pub fn of(geometry: &Geometry) -> Self {
        let (mut triangles, mut all) = (Vec::new(), Vec::new());
        let mut time = Duration::default();
        let parameters = BvhBuildParams::medium_build();
        let structure = match geometry {
            Geometry::Triangles(faces) => {
                triangles = prepared(faces);
                build_bvh2_from_tris(&triangles, parameters, &mut time)
            }
            Geometry::Spheres(spheres) => {
                all = balls(spheres);
                build_bvh2(&all, parameters, &mut time)
            }
        };
        Self {
            structure,
            triangles,
            balls: all,
        }
    }

    /// The normal where a ray hits first, of length 1.
    pub fn normal(&self, query: &Query) -> Vec3 {
        let index = |id: usize| self.structure.primitive_indices[id] as usize;
        let mut hit = RayHit::none();
        self.structure
            .ray_traverse(ray(query), &mut hit, |ray, id| {
                match self.triangles.get(index(id)) {
                    Some(triangle) => triangle.intersect(ray),
                    None => self.balls[index(id)].intersect(ray),
                }
            });
        if !hit.t.is_finite() || hit.primitive_id == u32::MAX {
            return -query.direction;
        }
        let met = index(hit.primitive_id as usize);
        match self.triangles.get(met) {
            Some(it) => Vec3::from((it.v1 - it.v0).cross(it.v2 - it.v0)).normalize_or_zero(),
            None => {
                let point = query.origin + query.direction * hit.t;
                (point - Vec3::from(self.balls[met].center)).normalize_or_zero()
            }
        }
    }
}
