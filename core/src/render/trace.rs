//! The ray loop: traces a ray from the camera and all secondary rays.
//!
//! There is no recursion. Rays wait in a work list that the caller owns. Each step removes one ray and adds at most
//! three, one generation deeper; [`Effects::work_depth`](crate::Effects::work_depth) says how many can wait. A ray is
//! added only if the scene's depth allows it and its weight is above the scene's cutoff.
//!
//! Secondary rays start outside the surface, on the side to which they go, at the distance of the hit's own error bound
//! (see [`Hit::error`]). That is close enough to lose no contact, and too far to hit the surface again. A ray that
//! continues inside a solid starts beneath all of its faces (see [`Hit::inside`]).
//!
//! The loop is compiled for a set of effects; others cost neither code nor time. It names no effect, and calls the
//! list of effects at the places that `shade` lists.

use crate::accel::{Accel, Number};
use crate::format::limits::UNBOUNDED;
use crate::format::record::Light;
use crate::observe::count::Observer;
use crate::observe::event::{Event, RayKind, Source};
use crate::query::{Hit, any_hit, closest_hit};
use crate::ray::Ray;
use crate::render::headroom::Headroom;
use crate::render::spread::Spread;
use crate::render::start::Start;
use crate::render::workspace::{Pending, State, WorkspaceView, leave_far};
use crate::scene::Scene;
use crate::scene::textures::Footprint;
use crate::shade::departure::{Far, FarPlace, Origin, depart, secondary_ray};
use crate::shade::effect::{EffectList, Tracer};
use crate::shade::sampler::Sampler;
use crate::shade::surface::{Aim, Arrival, Bounce, Filter, Lighting, Reach, Secondary, Surface};
use crate::shade::{All, Color};
use crate::target::{WIDE, inline_on_boards};
use core::marker::PhantomData;

/// The parts of the scene and the renderer that the ray loop uses.
pub(super) struct RayLoop<'s, 'a> {
    pub(super) scene: &'s Scene<'a>,
    pub(super) depth: u8,
    /// True if rays come from the camera, so that effects of its lens act on them. False for rays of the caller's own.
    pub(super) from_camera: bool,
    /// See [`Tracer::spread`].
    pub(super) spread: Spread,
}

impl RayLoop<'_, '_> {
    inline_on_boards!(
        /// Traces one ray of a sample and the shadow rays of its hit: the last waiting ray, or else the first ray.
        /// Returns true if no ray waits any more.
        pub(super) fn step<N: Number, A: Accel, C: Observer, const EFFECTS: u32>(
            &self,
            sampler: Sampler,
            start: Start<'_, N>,
            radiance: &mut Color<N>,
            workspace: &mut WorkspaceView<'_, N>,
            count: &mut C,
        ) -> bool {
            let causes_rays = const { EFFECTS & All::CASTING != 0 };
            let waiting = if causes_rays {
                workspace.work.pop()
            } else {
                None
            };
            let mut current = self.first_ray::<N, A, C, EFFECTS>(sampler, workspace, count);
            let (ray, weight, kind) = match waiting {
                Some(next) => {
                    let (origin, direction) = (Origin::of(next.origin), next.direction);
                    let ray = secondary_ray(self.scene, &origin, direction.map(N::widen), None);
                    (current.depth, current.kind) = (next.depth, next.kind);
                    current.state = next.state;
                    (ray, next.weight, next.kind)
                }
                None => (start.ray(), Color::WHITE, RayKind::Primary),
            };
            if C::ENABLED {
                current.count.event(Event::RayStarted {
                    kind,
                    depth: current.depth,
                    weight: weight.ratios_to_f64(),
                });
            }
            // A sample without a direction adds no light.
            if let Some(mut ray) = ray {
                if self.from_camera && kind == RayKind::Primary {
                    let mut state = current.state;
                    All::camera::<EFFECTS, N, _>(&mut current, &mut state, &mut ray);
                    current.state = state;
                }
                current.count.ray(kind, &ray);
                current.add(&ray, weight, radiance);
            }
            let done = !causes_rays || current.workspace.work.is_empty();
            if done {
                All::pixel::<EFFECTS, N, _>(&mut current, &mut State::<N>::default(), radiance);
            }
            done
        }
    );
}

impl<'s> RayLoop<'s, '_> {
    /// The first ray of a sample.
    #[inline(always)]
    fn first_ray<'t, 'w, N: Number, A: Accel, C: Observer, const EFFECTS: u32>(
        &self,
        sampler: Sampler,
        workspace: &'t mut WorkspaceView<'w, N>,
        count: &'t mut C,
    ) -> CurrentRay<'t, 'w, 's, N, A, C, EFFECTS> {
        CurrentRay {
            scene: self.scene,
            max_depth: self.depth,
            depth: 0,
            kind: RayKind::Primary,
            sampler,
            spread: self.spread,
            state: State::<N>::default(),
            workspace,
            count,
            structure: PhantomData,
        }
    }

    /// Returns true if the scene has effects of a set whose code is there.
    #[inline(always)]
    fn has_any_of(&self, with_code: u32) -> bool {
        with_code != 0 && self.scene.effects().0 & with_code != 0
    }

    /// Returns true if effects of the scene act on the mean of a pixel's samples.
    #[inline(always)]
    fn develops<const EFFECTS: u32>(&self) -> bool {
        self.has_any_of(const { EFFECTS & All::DEVELOPING })
    }

    /// Returns the most of a sample's radiance that counts, 1 being display white.
    #[inline(always)]
    pub(super) fn headroom<const EFFECTS: u32>(&self) -> Headroom {
        if self.develops::<EFFECTS>() {
            Headroom::WIDE
        } else if self.has_any_of(const { EFFECTS & All::VARYING }) {
            Headroom::NARROW
        } else {
            Headroom::NONE
        }
    }

    /// The displayed value of the mean of a pixel's samples.
    #[inline(always)]
    pub(super) fn developed<N: Number, A: Accel, C: Observer, const EFFECTS: u32>(
        &self,
        mut mean: Color<N>,
        workspace: &mut WorkspaceView<'_, N>,
        count: &mut C,
    ) -> Color<N> {
        if self.develops::<EFFECTS>() {
            let sampler = Sampler::new([0; 2], 0);
            let mut current = self.first_ray::<N, A, C, EFFECTS>(sampler, workspace, count);
            All::develop::<EFFECTS, N, _>(&mut current, &mut State::<N>::default(), &mut mean);
        }
        mean
    }
}

/// The ray that the loop traces.
struct CurrentRay<'t, 'w, 's, N: Number, A, C, const EFFECTS: u32> {
    scene: &'s Scene<'s>,
    /// The largest ray depth.
    max_depth: u8,
    /// Number of secondary rays that led to the ray, of which the ray is the last.
    depth: u8,
    kind: RayKind,
    /// The source of the random points that effects draw.
    sampler: Sampler,
    spread: Spread,
    state: State<N>,
    workspace: &'t mut WorkspaceView<'w, N>,
    count: &'t mut C,
    structure: PhantomData<A>,
}

impl<N: Number, A: Accel, C: Observer, const EFFECTS: u32>
    CurrentRay<'_, '_, '_, N, A, C, EFFECTS>
{
    /// Adds the radiance of one ray, and puts the rays that it causes on the work list.
    #[inline(always)]
    fn add(&mut self, ray: &Ray<N>, weight: Color<N>, radiance: &mut Color<N>) {
        let (scene, mut state) = (self.scene, self.state);
        let hit = self.closest_hit(ray);
        let surface = hit.and_then(|hit| Some((hit, scene.material(hit.object)?)));
        let Some((hit, material)) = surface else {
            let mut incoming = Color::radiance(scene.view.background);
            All::miss::<EFFECTS, N, _>(self, &mut state, ray, &mut incoming);
            self.add_radiance(Source::Background, incoming.times(weight), radiance);
            return;
        };
        let far = match UNBOUNDED {
            true => FarPlace::of(ray, &hit),
            false => None,
        };
        let required = All::required_by_material(material);
        let mut arrival = Arrival {
            hit: &hit,
            material,
            medium: None,
            weight,
        };
        All::arrive::<EFFECTS, N, _>(self, &mut state, ray, &mut arrival);
        let shading_normal = hit.facing_normal();
        let direction = if const { EFFECTS & All::DIRECTED == 0 } {
            ray.slope
        } else {
            N::normalize(ray.slope).0
        };
        let mut surface = Surface {
            hit: &hit,
            far: Far::of(far.as_ref()),
            material,
            required,
            shading_normal,
            direction,
            diffuse: Color::ratios(material.diffuse),
            weight: arrival.weight,
            passing: Color::BLACK,
            interface: None,
            footprint: Footprint::point(),
        };
        All::surface::<EFFECTS, N, _>(self, &mut state, ray, &mut surface);
        self.state = state;

        // Nothing is seen of a surface that alpha hides: what it would reflect costs nothing.
        let is_seen = const { EFFECTS & All::PASSING == 0 } || surface.weight != Color::BLACK;
        let incoming = match is_seen {
            true => self.local(&mut state, &surface).times(surface.weight),
            false => Color::BLACK,
        };
        self.add_radiance(Source::Surface, incoming, radiance);

        if self.depth >= self.max_depth {
            if C::ENABLED && required.0 & EFFECTS & All::CASTING != 0 {
                self.count.event(Event::TooDeep);
            }
            return;
        }
        let waiting = self.workspace.work.len();
        if const { EFFECTS & All::PASSING != 0 } && surface.passing != Color::BLACK {
            let secondary = Secondary {
                kind: RayKind::Refracted,
                direction,
                outward: !hit.front,
                weight: surface.passing,
            };
            self.send(&hit, secondary);
        }
        let mut bounce = Bounce {
            normal: surface.shading_normal,
            cos_in: -N::from_wide(N::dot(direction, surface.shading_normal)),
            mirrored: None,
            facets: None,
        };
        All::bounce::<EFFECTS, N, _>(self, &mut state, &surface, &mut bounce);
        if let Some(mirrored) = bounce.mirrored {
            // Half the mirrored direction; its length does not matter.
            let normal = bounce.normal;
            let axis = |k: usize| direction[k].half() + bounce.cos_in * normal[k];
            let secondary = Secondary {
                kind: RayKind::Reflected,
                direction: [axis(0), axis(1), axis(2)],
                outward: hit.front,
                weight: surface.weight.times(mirrored),
            };
            self.send(&hit, bounce.leaving(&hit, secondary));
        }
        if const { UNBOUNDED && EFFECTS & (All::CASTING | All::PASSING) != 0 }
            && let Some(far) = &far
        {
            leave_far(self.scene, far, &hit, self.workspace.work, waiting);
        }
    }

    /// The radiance that a surface reflects of ambient light and of the lights, and its own.
    #[inline(always)]
    fn local(&mut self, state: &mut State<N>, surface: &Surface<'_, N>) -> Color<N> {
        let scene = self.scene;
        let mut local = Color::radiance(scene.view.ambient).times(surface.diffuse);
        if C::ENABLED && local != Color::BLACK {
            self.count.event(Event::Ambient {
                radiance: local.to_f64(),
            });
        }
        All::emit::<EFFECTS, N, _>(self, state, surface, &mut local);
        let mut number = 0_u32;
        for light in scene.lights {
            let lit = self.lit(number, light, surface);
            // Light can change it on its way.
            self.state = *state;
            local = local.plus(lit);
            if C::ENABLED {
                self.count.event(Event::Lit {
                    number,
                    radiance: lit.to_f64(),
                });
            }
            number = number.wrapping_add(1);
        }
        local
    }

    /// Adds radiance to the sample.
    #[inline(always)]
    fn add_radiance(&mut self, source: Source, incoming: Color<N>, radiance: &mut Color<N>) {
        // Without effects that cause waiting rays, one ray brings all the light.
        *radiance = if const { EFFECTS & All::CASTING != 0 } {
            radiance.plus(incoming)
        } else {
            incoming
        };
        self.count.radiance(|| incoming.to_f64());
        if C::ENABLED {
            self.count.event(Event::Added {
                source,
                radiance: incoming.to_f64(),
            });
        }
    }

    /// The radiance that a light adds to a surface that it reaches.
    #[inline(always)]
    fn lit(&mut self, number: u32, light: &Light, surface: &Surface<'_, N>) -> Color<N> {
        let mut state = self.state;
        let origin = Origin::to_lights(self.scene, surface.hit, surface.far);
        let (way, distance) = light.seen_from(&origin);
        let mut aim = Aim {
            way,
            distance,
            apparent_distance: None,
        };
        All::aim::<EFFECTS, N, _>(self, &mut state, number, light, &mut aim);
        let Aim {
            way,
            distance,
            apparent_distance,
        } = aim;
        let Some((slopes, _)) = N::slopes(way) else {
            return Color::BLACK;
        };
        let (to_light, norm) = N::normalize(slopes);
        let cos = N::from_wide(N::dot(surface.shading_normal, to_light));
        let [red, green, blue] = light.color;
        let is_off = red | green | blue == 0;
        if C::ENABLED && !is_off {
            self.count.event(Event::Light {
                number,
                cosine: cos.ratio_to_f64(),
            });
        }
        if cos <= N::ZERO || is_off {
            return Color::BLACK;
        }
        let mut lighting = Lighting {
            light,
            origin,
            way,
            distance,
            to_light,
            norm,
            apparent_distance,
            facing: N::ONE,
        };
        let mut reflected = surface.diffuse.scaled(cos);
        let mut is_reached = true;
        All::face::<EFFECTS, N, _>(self, &mut state, surface, &mut lighting, &mut is_reached);
        if !is_reached {
            return Color::BLACK;
        }
        let mut gleam = None;
        All::reflect::<EFFECTS, N, _>(
            self,
            &mut state,
            surface,
            &lighting,
            &mut reflected,
            &mut gleam,
        );
        if reflected == Color::BLACK && gleam.is_none() {
            return Color::BLACK;
        }
        let mut arriving = Color::radiance(lighting.light.color);
        All::light::<EFFECTS, N, _>(self, &mut state, surface, &lighting, &mut arriving);
        let diffuse = arriving.times(reflected);
        match gleam {
            None => diffuse,
            Some(gleam) => diffuse.plus(gleam.of(arriving)),
        }
    }
}

impl<'s, N: Number, A: Accel, C: Observer, const EFFECTS: u32> Tracer<'s, N>
    for CurrentRay<'_, '_, 's, N, A, C, EFFECTS>
{
    type Observer = C;

    const SENDS: bool = EFFECTS & All::CASTING != 0;

    // Builds for boards hold one kind of query for shadows, those with `wide` the faster one for opaque scenes too.
    #[inline(always)]
    fn filters(&self) -> bool {
        let filtering = EFFECTS & All::FILTERING;
        filtering != 0 && (!WIDE || self.scene.effects().0 & filtering != 0)
    }

    #[inline(always)]
    fn scene(&self) -> &'s Scene<'s> {
        self.scene
    }

    #[inline(always)]
    fn count(&mut self) -> &mut C {
        self.count
    }

    #[inline(always)]
    fn kind(&self) -> RayKind {
        self.kind
    }

    #[inline(always)]
    fn point(&self, dimension: u16) -> [u32; 2] {
        // A hit sends at most one ray of a kind, or two that are glossy or diffuse and draw the same points.
        let bounce = u16::from(self.depth) << 8 | self.kind as u16;
        self.sampler.point(bounce, dimension)
    }

    #[inline(always)]
    fn spread(&self) -> Option<i32> {
        self.spread.get().copied().flatten()
    }

    #[inline(always)]
    fn any_hit(&mut self, ray: &Ray<N>) -> bool {
        any_hit::<N, A, C>(self.scene, ray, self.workspace.stack, self.count)
    }

    #[inline(always)]
    fn closest_hit(&mut self, ray: &Ray<N>) -> Option<Hit<N>> {
        closest_hit::<N, A, C>(self.scene, ray, self.workspace.stack, self.count)
    }

    #[inline(always)]
    fn filter(&mut self, ray: &Ray<N>, filter: &mut Filter<'s, '_, N>) {
        let mut state = self.state;
        All::filter::<EFFECTS, N, _>(self, &mut state, ray, filter);
        self.state = state;
    }

    #[inline(always)]
    fn reach(&mut self, reach: &mut Reach<'s, N>) {
        let mut state = self.state;
        All::reach::<EFFECTS, N, _>(self, &mut state, reach);
    }

    #[inline(always)]
    fn send(&mut self, hit: &Hit<N>, mut secondary: Secondary<N>) {
        let mut state = self.state;
        All::leave::<EFFECTS, N, _>(self, &mut state, hit, &mut secondary);
        let Secondary {
            kind,
            direction,
            outward,
            weight,
        } = secondary;
        let peak = weight.peak();
        if peak > N::ZERO && peak * N::radiance(1 << 20) > N::radiance(self.scene.view.cutoff) {
            let origin = depart(self.scene, hit, outward, false);
            // A list that `check_workspace` accepts has a place for it. In a shorter one it is lost.
            let sent = self.workspace.work.push(Pending {
                origin,
                direction,
                weight,
                depth: self.depth.saturating_add(1),
                kind,
                state,
            });
            if sent.is_ok() {
                if C::ENABLED {
                    let weight = weight.ratios_to_f64();
                    self.count.event(Event::Sent { kind, weight });
                }
                return;
            }
        }
        if C::ENABLED {
            let weight = weight.ratios_to_f64();
            self.count.event(Event::Dropped { kind, weight });
        }
    }
}
