//! Rays without shading: one a pixel, and one to the first light from each hit.

use crate::scene::{Accel, Number as N, SceneRenderer};
use core::hint::black_box;
use gridel_core::format::record::Light;
use gridel_core::number::{Convert, ErrorBounds, Products, Scalar};
use gridel_core::{Hit, NoCount, Ray, Scene, StackView, any_hit, closest_primitive};

/// The results of tracing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rays {
    /// Number of rays: one per pixel.
    pub rays: u32,
    /// Number of rays that hit something.
    pub hits: u32,
    /// Number of hits that face the first light.
    pub facing: u32,
    /// Number of these that are in shadow.
    pub shadows: u32,
}

/// The last step to which pixels are followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Until {
    /// The primary ray, which is not traced.
    Camera,
    /// The first hit of the primary ray.
    Primitive,
    /// The surface at the hit, and the ray from it to the first light, which is not traced.
    Surface,
    /// The shadow ray to that light.
    Light,
}

impl Rays {
    /// Traces a ray per pixel of a row, and what follows from it.
    pub fn row(
        &mut self,
        until: Until,
        renderer: &SceneRenderer<'_>,
        scene: &Scene<'static>,
        y: u16,
        stack: &mut StackView,
    ) {
        for x in 0..renderer.settings().width {
            let Ok(ray) = renderer.primary_ray(x, y) else {
                continue;
            };
            self.rays = self.rays.wrapping_add(1);
            if until == Until::Camera {
                black_box(&ray);
                continue;
            }
            let found = closest_primitive::<N, Accel, _>(scene, &ray, stack, &mut NoCount);
            let Some(found) = found else {
                continue;
            };
            self.hits = self.hits.wrapping_add(1);
            if until == Until::Primitive {
                continue;
            }
            let hit = found.hit(scene, &ray);
            let light = hit.zip(scene.lights().first());
            let Some(ray) = light.and_then(|(hit, light)| to(light, hit, scene)) else {
                continue;
            };
            self.facing = self.facing.wrapping_add(1);
            if until == Until::Surface {
                black_box(&ray);
                continue;
            }
            let dark = any_hit::<N, Accel, _>(scene, &ray, stack, &mut NoCount);
            self.shadows = self.shadows.wrapping_add(dark.into());
        }
    }
}

/// The ray from a hit to a light, as pictures cast it: none from a surface that is turned away.
fn to(light: &Light, hit: Hit<N>, scene: &Scene<'static>) -> Option<Ray<N>> {
    let [x, y, z] = hit.normal;
    let (start, normal) = if hit.front {
        (hit.outside(), [x, y, z])
    } else {
        (hit.inside(scene), [-x, -y, -z])
    };
    let start = start.map(N::widen);
    let far = light.vector.map(N::far);
    let (way, end) = if light.kind == Light::DIRECTIONAL {
        (far, N::far(1 << 60))
    } else {
        let way = [far[0] - start[0], far[1] - start[1], far[2] - start[2]];
        let longest = way.iter().fold(N::far(0), |longest, &part| {
            let length = if part < N::far(0) { -part } else { part };
            if length > longest { length } else { longest }
        });
        let part = |axis: usize| Scalar::abs(N::narrow(start[axis]));
        let larger = |a: N, b: N| if a < b { b } else { a };
        let magnitude = larger(
            larger(part(0), part(1)),
            larger(part(2), N::narrow(longest)),
        );
        (way, longest - N::error_bound(magnitude).widen())
    };
    let ray = Ray::new(scene.bounds(), start, way, N::far(0), end).ok()?;
    (N::from_wide(N::dot(normal, ray.slope())) > N::from_unit(0)).then_some(ray)
}
