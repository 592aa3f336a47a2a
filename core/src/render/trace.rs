//! The ray loop: what one ray from the camera brings, with all the rays that it causes.
//!
//! There is no recursion. Rays wait in a work list that the caller owns. One ray is taken and at
//! most two are put back, one generation deeper, so `depth + 1` places are enough. A ray is put
//! back only if the scene's depth allows and its weight is above the scene's cutoff.
//!
//! Secondary rays start beside the surface, on the side to which they go, at the distance of the
//! hit's own error bound (see [`Hit::error`]): close enough to lose no contact, and too far to meet
//! the surface again.
//! What goes on inside of a solid starts beneath all of its faces (see [`Hit::inside`]).
//!
//! Everything is compiled for a set of effects: what is not in it costs neither code nor time.

use crate::accel::stack::{Stack, StackView};
use crate::accel::{Accel, Number};
use crate::format::Effects;
use crate::format::limits::MAX_RAY_DEPTH;
use crate::format::record::{Light, Material};
use crate::number::extent;
use crate::observe::count::Observer;
use crate::observe::event::{Event, RayKind, Source};
use crate::query::{Hit, any_hit, closest_hit};
use crate::ray::{Ray, RayError};
use crate::scene::Scene;
use crate::shade::glass::Split;
use crate::shade::{Color, glass};
use heapless::{Vec, VecView};

/// A ray that waits for its turn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pending<N: Number> {
    origin: [N; 3],
    direction: [N; 3],
    weight: Color<N>,
    depth: u8,
    kind: RayKind,
}

/// Everything that rendering writes to beside the pixels: the caller owns it, and it is used again
/// for every pixel.
///
/// `STACK` must be at least the blob's [stack depth](Scene::stack_depth), `WORK` at least
/// [`work_depth`](crate::format::limits::work_depth) of the ray depth. It takes 12 bytes an entry of the stack and, in `f32` and
/// `fixed`, 40 bytes a place for a ray.
#[derive(Debug)]
pub struct Workspace<N: Number, const STACK: usize, const WORK: usize> {
    stack: Stack<STACK>,
    work: Vec<Pending<N>, WORK>,
}

impl<N: Number, const STACK: usize, const WORK: usize> Workspace<N, STACK, WORK> {
    /// An empty workspace.
    pub const fn new() -> Self {
        Self {
            stack: Stack::new(),
            work: Vec::new(),
        }
    }

    /// The workspace as renderers take it.
    pub fn as_view(&mut self) -> WorkspaceView<'_, N> {
        WorkspaceView {
            stack: self.stack.as_view(),
            work: &mut self.work,
        }
    }
}

impl<N: Number, const STACK: usize, const WORK: usize> Default for Workspace<N, STACK, WORK> {
    fn default() -> Self {
        Self::new()
    }
}

/// A [`Workspace`] whose sizes are not part of its type.
#[derive(Debug)]
pub struct WorkspaceView<'w, N: Number> {
    pub(super) stack: &'w mut StackView,
    pub(super) work: &'w mut VecView<Pending<N>>,
}

/// How many surfaces of glass a shadow ray passes; light that has to pass more does not arrive.
const SHADOW_SURFACES: usize = 4 * MAX_RAY_DEPTH;

/// What the ray loop needs of the scene and the renderer.
pub(super) struct Loop<'s, 'a> {
    pub(super) scene: &'s Scene<'a>,
    pub(super) depth: u8,
}

impl Loop<'_, '_> {
    /// Traces one ray and the shadow rays of what it meets: the last that waits, or else the one
    /// from the camera. Returns whether none waits any more.
    #[inline(always)]
    pub(super) fn step<N: Number, A: Accel, C: Observer, const EFFECTS: u32>(
        &self,
        camera: impl FnOnce() -> Result<Ray<N>, RayError>,
        radiance: &mut Color<N>,
        space: &mut WorkspaceView<'_, N>,
        count: &mut C,
    ) -> bool {
        let causes_rays = const { Effects(EFFECTS).cast_rays() };
        let waiting = if causes_rays { space.work.pop() } else { None };
        let (ray, weight, depth, kind) = match waiting {
            Some(next) => {
                let (origin, direction) = (next.origin, next.direction.map(N::widen));
                let far = N::FAR.widen();
                let ray = Ray::from_inside(self.scene.bounds(), origin, direction, far);
                (ray, next.weight, next.depth, next.kind)
            }
            None => (camera().ok(), Color::WHITE, 0, RayKind::Primary),
        };
        // A direction that cannot be told brings nothing.
        if C::ENABLED {
            count.event(Event::Taken {
                kind,
                depth,
                weight: weight.ratios_to_f64(),
            });
        }
        if let Some(ray) = ray {
            count.ray(kind, &ray);
            self.add::<N, A, C, EFFECTS>(&ray, weight, depth, radiance, space, count);
        }
        !causes_rays || space.work.is_empty()
    }

    /// Adds what one ray brings, and puts the rays that it causes on the work list.
    #[inline(always)]
    fn add<N: Number, A: Accel, C: Observer, const EFFECTS: u32>(
        &self,
        ray: &Ray<N>,
        mut weight: Color<N>,
        depth: u8,
        radiance: &mut Color<N>,
        space: &mut WorkspaceView<'_, N>,
        count: &mut C,
    ) {
        let effects = Effects(EFFECTS);
        let view = self.scene.view;
        let hit = closest_hit::<N, A, C>(self.scene, ray, space.stack, count);
        let surface = hit.and_then(|hit| Some((hit, self.scene.material(hit.object)?)));
        let Some((hit, material)) = surface else {
            let brought = Color::radiance(view.background).times(weight);
            *radiance = radiance.plus(brought);
            if C::ENABLED {
                count.event(Event::Added {
                    source: Source::Background,
                    radiance: brought.to_f64(),
                });
            }
            return;
        };
        let glass = effects.contains(Effects::GLASS) && material.transmit != [0; 3];
        if effects.contains(Effects::ABSORPTION) && glass && !hit.front {
            weight = weight.times(glass::absorb(material, path_length(ray, &hit)));
            if C::ENABLED {
                count.event(Event::Absorbed {
                    weight: weight.ratios_to_f64(),
                });
            }
        }

        let normal = if hit.front {
            hit.normal
        } else {
            hit.normal.map(|x| -x)
        };
        let needs_direction = Effects::HIGHLIGHT
            .with(Effects::MIRROR)
            .with(Effects::GLASS);
        let direction = if EFFECTS & needs_direction.0 == 0 {
            ray.slope
        } else {
            N::normalize(ray.slope).0
        };

        let diffuse = material.diffuse_at::<N, EFFECTS>(&hit);
        let mut local = Color::radiance(view.ambient).times(diffuse);
        for (number, light) in (0..).zip(self.scene.lights) {
            let lit = self.lit::<N, A, C, EFFECTS>(
                number,
                light,
                material,
                &hit,
                normal,
                direction,
                diffuse,
                space.stack,
                count,
            );
            local = local.plus(lit);
            if C::ENABLED {
                count.event(Event::Lit {
                    number,
                    radiance: lit.to_f64(),
                });
            }
        }
        let brought = local.times(weight);
        *radiance = radiance.plus(brought);
        if C::ENABLED {
            count.event(Event::Added {
                source: Source::Surface,
                radiance: brought.to_f64(),
            });
        }

        if depth >= self.depth {
            if C::ENABLED && (glass || material.mirror != [0; 3]) {
                count.event(Event::TooDeep);
            }
            return;
        }
        let cos_in = -N::from_wide(N::dot(direction, normal));
        let mut mirrored = if effects.contains(Effects::MIRROR) {
            Color::ratios(material.mirror)
        } else {
            Color::BLACK
        };
        if glass {
            let k = N::ratio(material.inverse_ior);
            let Split {
                reflected,
                refracted,
            } = glass::split(k, hit.front, direction, normal, cos_in);
            if C::ENABLED {
                count.event(Event::Split {
                    reflected: reflected.ratio_to_f64(),
                });
            }
            let transmit = Color::ratios(material.transmit);
            mirrored = mirrored.plus_up_to_one(transmit.scaled(reflected));
            let weight = weight.times(transmit.scaled(N::ONE - reflected));
            let kind = RayKind::Refracted;
            self.send(
                space, &hit, refracted, !hit.front, weight, depth, kind, count,
            );
        }
        if glass || effects.contains(Effects::MIRROR) {
            // Half the mirrored direction; its length does not matter.
            let axis = |k: usize| direction[k].half() + cos_in * normal[k];
            let reflected = [axis(0), axis(1), axis(2)];
            let kind = RayKind::Reflected;
            self.send(
                space,
                &hit,
                reflected,
                hit.front,
                weight.times(mirrored),
                depth,
                kind,
                count,
            );
        }
    }

    /// Puts a ray on the work list unless it would bring too little.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "one secondary ray is this much")]
    fn send<N: Number, C: Observer>(
        &self,
        space: &mut WorkspaceView<'_, N>,
        hit: &Hit<N>,
        direction: [N; 3],
        outward: bool,
        weight: Color<N>,
        depth: u8,
        kind: RayKind,
        count: &mut C,
    ) {
        let peak = weight.peak();
        if peak > N::ZERO && peak * N::radiance(1 << 20) > N::radiance(self.scene.view.cutoff) {
            let origin = depart(self.scene, hit, outward, false);
            // The list is as long as the depth asks for, so there is a place.
            let _ = space.work.push(Pending {
                origin,
                direction,
                weight,
                depth: depth.saturating_add(1),
                kind,
            });
            if C::ENABLED {
                count.event(Event::Sent {
                    kind,
                    weight: weight.ratios_to_f64(),
                });
            }
        } else {
            if C::ENABLED {
                count.event(Event::Dropped {
                    kind,
                    weight: weight.ratios_to_f64(),
                });
            }
        }
    }

    /// What a light adds: diffuse and highlight, if it is not in shadow.
    #[inline(always)]
    #[expect(
        clippy::too_many_arguments,
        reason = "one surface under one light is this much"
    )]
    fn lit<N: Number, A: Accel, C: Observer, const EFFECTS: u32>(
        &self,
        number: u32,
        light: &Light,
        material: &Material,
        hit: &Hit<N>,
        normal: [N; 3],
        direction: [N; 3],
        diffuse: Color<N>,
        stack: &mut StackView,
        count: &mut C,
    ) -> Color<N> {
        let effects = Effects(EFFECTS);
        let origin = depart(self.scene, hit, hit.front, true);
        let (way, distance) = light.seen_from(origin);
        let Some((slopes, _)) = N::slopes(way) else {
            return Color::BLACK;
        };
        let (to_light, _) = N::normalize(slopes);
        let cos = N::from_wide(N::dot(normal, to_light));
        if C::ENABLED {
            count.event(Event::Light {
                number,
                cosine: cos.ratio_to_f64(),
            });
        }
        if cos <= N::ZERO {
            return Color::BLACK;
        }
        let mut reflected = diffuse.scaled(cos);
        if effects.contains(Effects::HIGHLIGHT) && material.highlight != [0; 3] {
            // Halfway between the light and where the ray came from (Blinn-Phong).
            let axis = |k: usize| to_light[k].half() - direction[k].half();
            let (halfway, _) = N::normalize([axis(0), axis(1), axis(2)]);
            let cos = N::from_wide(N::dot(normal, halfway))
                .max(N::ZERO)
                .min(N::ONE);
            let strength = power(cos, material.shininess);
            reflected =
                reflected.plus_up_to_one(Color::ratios(material.highlight).scaled(strength));
        }
        if reflected == Color::BLACK {
            return Color::BLACK;
        }
        let mut arriving = Color::radiance(light.color);
        // No material says so, as with the other effects: the scene itself may do without shadows.
        let shadows = self.scene.effects().contains(Effects::SHADOW);
        if effects.contains(Effects::SHADOW) && shadows {
            let shadow = Shadow {
                origin,
                way,
                distance,
                to_light,
            };
            let through = self.through::<N, A, C, EFFECTS>(shadow, stack, count);
            arriving = arriving.times(through);
        }
        arriving.times(reflected)
    }

    /// What part of a light arrives.
    ///
    /// Opaque things let nothing through. Light goes straight on through glass and loses at every
    /// surface what [`glass::straight_through`] says, and what is absorbed on the way inside.
    fn through<N: Number, A: Accel, C: Observer, const EFFECTS: u32>(
        &self,
        shadow: Shadow<N>,
        stack: &mut StackView,
        count: &mut C,
    ) -> Color<N> {
        let effects = Effects(EFFECTS);
        let zero = N::Wide::default();
        let Shadow {
            mut origin,
            mut way,
            mut distance,
            to_light,
        } = shadow;
        let mut left = Color::WHITE;
        for _ in 0..SHADOW_SURFACES {
            // The light itself, and what touches it, casts no shadow.
            let end = distance.map_or(N::FAR.widen(), |distance| {
                let magnitude = extent(origin).max(N::narrow(distance));
                distance - N::error_bound(magnitude).widen()
            });
            let Some(ray) = Ray::from_inside(self.scene.bounds(), origin, way, end) else {
                return left;
            };
            count.ray(RayKind::Shadow, &ray);
            if !effects.contains(Effects::GLASS) {
                let dark = any_hit::<N, A, C>(self.scene, &ray, stack, count);
                return if dark { Color::BLACK } else { left };
            }
            let Some(hit) = closest_hit::<N, A, C>(self.scene, &ray, stack, count) else {
                return left;
            };
            let material = match self.scene.material(hit.object) {
                Some(material) if material.transmit != [0; 3] => material,
                _ => return Color::BLACK,
            };
            let cos = N::from_wide(N::dot(hit.normal, to_light)).abs().min(N::ONE);
            let passed = glass::straight_through(N::ratio(material.inverse_ior), cos);
            left = left.times(Color::ratios(material.transmit)).scaled(passed);
            if effects.contains(Effects::ABSORPTION) && !hit.front {
                left = left.times(glass::absorb(material, path_length(&ray, &hit)));
            }
            if C::ENABLED {
                count.event(Event::Filtered {
                    left: left.ratios_to_f64(),
                });
            }
            if left.peak() * N::radiance(1 << 20) <= N::radiance(self.scene.view.cutoff) {
                return Color::BLACK;
            }
            origin = depart(self.scene, &hit, !hit.front, false);
            // The way goes on along the same slopes, so its largest component stays the measure.
            distance = distance.map(|distance| distance - hit.t);
            if distance.is_some_and(|rest| rest <= zero) {
                return left;
            }
            way = ray.slope.map(N::widen);
        }
        Color::BLACK
    }
}

/// A shadow ray to be cast.
struct Shadow<N: Number> {
    origin: [N; 3],
    way: [N::Wide; 3],
    /// How far the light is along the largest component of `way`; `None` for infinitely far.
    distance: Option<N::Wide>,
    to_light: [N; 3],
}

/// Where a ray starts that leaves a hit. On its way to a light it may start on the surface itself, because it is
/// known to lead away from it; what is mirrored may be rounded into the surface.
///
/// Out of line, because copies of it took more of the call stack than the call.
#[inline(never)]
fn depart<N: Number>(scene: &Scene<'_>, hit: &Hit<N>, outward: bool, to_light: bool) -> [N; 3] {
    match (outward, to_light) {
        (true, true) => hit.beside(),
        (true, false) => hit.outside(),
        _ => hit.inside(scene),
    }
}

/// The length of a ray up to its hit.
fn path_length<N: Number>(ray: &Ray<N>, hit: &Hit<N>) -> N {
    // |slope| lies between 1 and the square root of 3.
    let (_, norm) = N::normalize(ray.slope);
    // From far away it is longer than a length can be.
    N::from_wide(N::narrow(hit.t).wide(norm))
}

/// A ratio in \[0, 1\] to the power of a positive integer.
fn power<N: Number>(base: N, exponent: u16) -> N {
    let (mut result, mut square, mut rest) = (N::ONE, base, exponent);
    while rest > 0 {
        if rest & 1 == 1 {
            result = result * square;
        }
        square = square * square;
        rest >>= 1;
    }
    result
}
