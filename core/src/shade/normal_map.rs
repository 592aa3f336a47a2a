//! Normal maps: meshes are shaded by the normals of an image, which show bumps.
//!
//! The image is looked up in the same way as textures. Its axes on a triangle are the directions in which its texture
//! coordinates grow. They are made perpendicular to the normal that shades the triangle otherwise: the smooth one, if
//! it has one.
//!
//! The surface itself is unchanged. So, as with [smooth normals](super::smooth), light from behind a triangle does not
//! reach its front. Rays to the wrong side of it are turned into its plane.

use crate::accel::Number;
use crate::format::Effects;
use crate::format::record::Material;
use crate::observe::count::Observer;
use crate::observe::event::Event;
use crate::query::{Hit, Tangent};
use crate::ray::Ray;
use crate::shade::basis::wide_cross;
use crate::shade::effect::{Effect, Tracer};
use crate::shade::smooth::{self, SENDING};
use crate::shade::surface::{Lighting, Secondary, Surface};

pub(crate) struct NormalMap;

impl Effect for NormalMap {
    type State<N: Number> = ();

    const EFFECT: Effects = Effects::NORMAL_MAP;

    #[inline(always)]
    fn is_required_by_material(material: &Material) -> bool {
        material.maps & Material::MAPS_NORMAL != 0
    }

    #[inline(always)]
    fn surface<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        (): &mut (),
        _: &Ray<N>,
        surface: &mut Surface<'_, N>,
    ) {
        if !surface.required.contains(Self::EFFECT) {
            return;
        }
        let scene = tracer.scene();
        let Some(textures) = scene.textures.get() else {
            return;
        };
        let map = textures.normal_map_of(surface.material);
        let (Some((map, texture)), Some(tangent)) = (map, surface.hit.tangent(scene)) else {
            return;
        };
        let texel = textures.normal(texture, tangent.coordinates, surface.footprint);
        let [x, y, z] = texel.color.map(N::ratio);
        let factor = |of_65535: u16| {
            // 65535 is 1 exactly.
            let of_65536 = i32::from(of_65535).wrapping_add(i32::from(of_65535) >> 15);
            N::ratio(of_65536 << 14)
        };
        let (across, along) = (factor(map.across), factor(map.along));
        let bump = [x * across, y * across, z * along];
        let Some(mut normal) = bumped(bump, &tangent, surface.shading_normal, surface.hit.front)
        else {
            return;
        };
        if X::SENDS && surface.required.0 & SENDING != 0 {
            normal = smooth::turned_to_ray(normal, surface.direction);
        }
        surface.shading_normal = normal;
        if X::Observer::ENABLED {
            tracer.count().event(Event::NormalMapped {
                texel: texel.place,
                normal: normal.map(N::ratio_to_f64),
            });
        }
    }

    #[inline(always)]
    fn face<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        (): &mut (),
        surface: &Surface<'_, N>,
        lighting: &mut Lighting<'_, N>,
        is_reached: &mut bool,
    ) {
        // In scenes with smooth normals and shadows, that effect does this.
        let by_smooth = Effects::SMOOTH.with(Effects::SHADOW);
        if !surface.required.contains(Self::EFFECT) || tracer.scene().effects().contains(by_smooth)
        {
            return;
        }
        if smooth::is_behind(surface.hit, lighting.to_light) {
            *is_reached = false;
            if X::Observer::ENABLED {
                tracer.count().event(Event::BehindTriangle);
            }
        }
    }

    #[inline(always)]
    fn leave<'s, N: Number, X: Tracer<'s, N>>(
        tracer: &mut X,
        (): &mut (),
        hit: &Hit<N>,
        secondary: &mut Secondary<N>,
    ) {
        if !tracer.scene().effects().contains(Effects::SMOOTH) {
            smooth::keep_on_its_side(hit, secondary);
        }
    }
}

/// Returns the normal of a bump, given along u, against v and along the normal of a surface. It lies on the side of
/// that normal, which is the front's if `is_front`. `None` if it has no length.
///
/// Out of line, because copies of it took more of the call stack than the call.
#[inline(never)]
fn bumped<N: Number>(
    [x, y, z]: [N; 3],
    tangent: &Tangent<N>,
    normal: [N; 3],
    is_front: bool,
) -> Option<[N; 3]> {
    // Where the back is seen, everything is computed as seen from the front, and then turned around.
    let front = if is_front { normal } else { normal.map(|x| -x) };
    let along = N::from_wide(N::dot(tangent.direction, front));
    let level = |k: usize| tangent.direction[k] - along * front[k];
    let (right, length) = N::normalize([level(0), level(1), level(2)]);
    if length <= N::ZERO {
        return None;
    }
    // Up on an image that is not mirrored.
    let up = wide_cross(front, right);
    let y = if tangent.is_mirrored { -y } else { y };
    // Halves, whose squares fit.
    let part = |k: usize| (x * right[k]).half() + (y * up[k]).half() + (z * front[k]).half();
    let (bumped, length) = N::normalize([part(0), part(1), part(2)]);
    let turned = |normal: [N; 3]| if is_front { normal } else { normal.map(|x| -x) };
    (length > N::ZERO).then(|| turned(bumped))
}
