//! Rays without shading: one a pixel, and one to the first light from each hit.

use crate::scene::{Accel, Number as N, SceneRenderer};
use gridel_core::blob::record::Light;
use gridel_core::{Hit, NoCount, Number, Ray, Scene, StackView, any_hit, closest_primitive};

/// What was traced.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rays {
    /// One a pixel.
    pub rays: u32,
    /// Those that met something.
    pub hits: u32,
    /// Those of the hits that the first light does not reach.
    pub shadows: u32,
}

impl Rays {
    /// Traces a ray a pixel of a row.
    pub fn row(
        &mut self,
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
            let found = closest_primitive::<N, Accel, _>(scene, &ray, stack, &mut NoCount);
            self.hits = self.hits.wrapping_add(found.is_some().into());
        }
    }

    /// Traces the same rays and, from what they hit, one to the first light.
    pub fn shadowed_row(
        &mut self,
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
            let Some(found) = closest_primitive::<N, Accel, _>(scene, &ray, stack, &mut NoCount)
            else {
                continue;
            };
            self.hits = self.hits.wrapping_add(1);
            let hit = found.hit(scene, &ray);
            let ray = hit
                .zip(scene.lights().first())
                .and_then(|(hit, light)| to(light, hit, scene));
            let dark =
                ray.is_some_and(|ray| any_hit::<N, Accel, _>(scene, &ray, stack, &mut NoCount));
            self.shadows = self.shadows.wrapping_add(dark.into());
        }
    }
}

/// The ray from a hit to a light, which lies beyond everything.
fn to(light: &Light, hit: Hit<N>, scene: &Scene<'static>) -> Option<Ray<N>> {
    let [x, y, z] = hit.normal;
    let normal = if hit.front { [x, y, z] } else { [-x, -y, -z] };
    let start = |axis: usize| hit.point[axis] + hit.error * normal[axis];
    let origin = [start(0), start(1), start(2)].map(N::widen);
    let far = light.vector.map(N::far);
    let way = if light.directional == 1 {
        far
    } else {
        [far[0] - origin[0], far[1] - origin[1], far[2] - origin[2]]
    };
    Ray::new(scene.bounds(), origin, way, N::far(0), N::far(1 << 60)).ok()
}
