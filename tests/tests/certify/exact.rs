//! Pixels in 320 bits, by code that shares nothing with the tested code: no kernel, no shape's test and no rule of an
//! effect.

use super::facets::{Facets, WIDE};
use super::media::{Inside, cos_back};
use super::numbers::{black, color, fraction, limited, one, peak, product, real, sum};
use super::placed::{Map, Met, Placed};
use super::random::around;
use super::surface::{Leaving, Ray, Surface, Trail};
use gridel_core::format::record::Material;
use gridel_core::{Effects, RayKind, Scene, Settings};
use gridel_host::shape::exact::{Line, Real, Vector, along, dot, norm, scaled, unit};

/// The dimension of random points for the facet of a rough surface.
const FACET: u16 = 0x1010;
/// The dimension of random points for the direction of indirect light.
const DIRECTION: u16 = 0x1030;

/// A scene.
pub struct Exact<'s> {
    pub scene: &'s Scene<'s>,
    pub solids: Vec<Placed>,
    pub settings: Settings,
    pub is_smooth: bool,
}

impl<'s> Exact<'s> {
    pub fn of(scene: &'s Scene<'s>, settings: Settings) -> Self {
        let mut solids = Placed::all(scene, 0, scene, None);
        for instance in scene.instances() {
            let number = usize::from(instance.part);
            let first = scene.first_primitive_of_part(number).expect("a part");
            let map = Map::of(instance);
            solids.extend(Placed::all(
                &scene.parts()[number],
                first,
                scene,
                Some(&map),
            ));
        }
        Self {
            scene,
            solids,
            settings,
            is_smooth: scene.effects().contains(Effects::SMOOTH),
        }
    }

    /// The linear values of a pixel with one sample.
    pub fn pixel(&self, pixel: [u16; 2]) -> Vector {
        let trail = Trail {
            pixel,
            depth: 0,
            kind: RayKind::Primary,
            reflections: 0,
            inside: Inside::default(),
            length: None,
        };
        let line = self.start_line(&trail);
        let weight = [one(), one(), one()];
        self.shown(self.radiance(&Ray {
            line,
            weight,
            trail,
        }))
    }

    pub fn material(&self, met: &Met<'_>) -> &'s Material {
        self.scene.material(met.object).expect("a material")
    }

    /// Returns the light of a ray, with that of the rays that it causes.
    fn radiance(&self, ray: &Ray) -> Vector {
        let Some(mut met) = self.nearest(&ray.line, None) else {
            let brought = self.missed(ray.trail.kind, &ray.line.slope);
            return product(&brought, &ray.weight);
        };
        let mut trail = ray.trail;
        let face = self.face(trail.inside, &met);
        let mut weight = ray.weight.clone();
        if let Some(medium) = face.before {
            let length = &met.t * norm(&ray.line.slope);
            weight = product(&weight, &self.absorbed(medium, &length));
        }
        let material = self.material(&met);
        trail.length = self.length(trail.length, &met, &ray.line.slope);
        met.footprint = self.footprint((&met, material), trail.length, &ray.line.slope);
        let direction = unit(&ray.line.slope);
        let surface = Surface {
            material,
            interface: face.interface,
            normal: self.shading_normal(&met, material, &direction),
            diffuse: self.diffuse(&met, material),
            direction,
            trail,
            beyond: face.beyond,
            met,
        };
        if face.is_hidden {
            return self.straight_on(&surface, weight);
        }
        let alpha = self.alpha(&surface.met, material);
        let passing = scaled(&weight, &(one() - &alpha));
        let weight = scaled(&weight, &alpha);
        let local = product(&self.local(&surface), &weight);
        let behind = self.straight_on(&surface, passing);
        sum(&sum(&local, &behind), &self.bounced(&surface, &weight))
    }

    /// Returns the light that a surface reflects of the lights, and its own.
    fn local(&self, surface: &Surface<'_>) -> Vector {
        let ambient = color(self.scene.view().ambient, 20);
        let mut local = product(&ambient, &surface.diffuse);
        let is_random = matches!(surface.trail.kind, RayKind::Diffuse | RayKind::Glossy);
        let emission = self.scene.emission(surface.met.object);
        if let Some(emission) = emission.filter(|_| surface.met.front)
            && !(emission.lights == 1 && is_random)
        {
            local = sum(&local, &color(emission.radiance, 20));
        }
        let lights = self.scene.lights().iter().enumerate();
        lights.fold(local, |local, (number, light)| {
            sum(&local, &self.lit(number, light, surface))
        })
    }

    /// Returns the light from behind a surface that is absent, or partly transparent by alpha.
    fn straight_on(&self, surface: &Surface<'_>, weight: Vector) -> Vector {
        let leaving = Leaving {
            kind: RayKind::Refracted,
            slope: surface.direction.clone(),
            outward: !surface.met.front,
            weight,
        };
        self.sent(surface, leaving)
    }

    /// Returns the light of mirrored, refracted and diffuse rays.
    fn bounced(&self, surface: &Surface<'_>, weight: &Vector) -> Vector {
        let Surface {
            met,
            material,
            direction,
            trail,
            ..
        } = surface;
        let mut normal = surface.normal.clone();
        let mut cos = cos_back(direction, &normal);
        let facets = self.scene.roughness(met.object).map(|alpha| {
            let facets = Facets::new(alpha, &normal, cos.clone());
            normal = facets.draw(direction, trail.point(FACET));
            cos = limited(cos_back(direction, &normal), 0.0, 1.0);
            facets
        });
        let leaving = |leaving: Leaving| match &facets {
            Some(facets) => facets.leaving(met, leaving),
            None => leaving,
        };
        let mut result = black();
        let mut mirrored = color(material.mirror, 30);
        if let Some(interface) = &surface.interface {
            let transmit = color(material.transmit, 30);
            let (reflected, refracted) = interface.split(direction, &normal, &cos);
            let more = peak(&transmit) * &reflected;
            mirrored = mirrored.map(|x| (x + &more).min(one()));
            if let Some(slope) = refracted {
                let part = scaled(&transmit, &(one() - &reflected));
                let straight = Leaving {
                    kind: RayKind::Refracted,
                    slope,
                    outward: !met.front,
                    weight: product(weight, &part),
                };
                let refracted = match interface.is_bending() {
                    true => leaving(straight),
                    false => straight,
                };
                result = sum(&result, &self.sent(surface, refracted));
            }
        }
        let reflected = leaving(Leaving {
            kind: RayKind::Reflected,
            slope: along(&scaled(direction, &real(0.5)), &cos, &normal),
            outward: met.front,
            weight: product(weight, &mirrored),
        });
        result = sum(&result, &self.sent(surface, reflected));
        sum(&result, &self.scattered(surface, weight))
    }

    /// Returns the light of a diffuse ray.
    fn scattered(&self, surface: &Surface<'_>, weight: &Vector) -> Vector {
        let trail = &surface.trail;
        if trail.reflections >= self.scene.bounces() {
            return black();
        }
        let leaving = Leaving {
            kind: RayKind::Diffuse,
            slope: around(&surface.normal, trail.point(DIRECTION)),
            outward: surface.met.front,
            weight: product(weight, &surface.diffuse),
        };
        self.sent(surface, leaving)
    }

    /// Returns the light of a ray that leaves a surface, unless it is too weak or too deep.
    fn sent(&self, surface: &Surface<'_>, leaving: Leaving) -> Vector {
        let Surface { met, trail, .. } = surface;
        let most = peak(&leaving.weight);
        let is_weak = !most.is_positive() || most <= fraction(self.scene.view().cutoff, 20);
        if is_weak || trail.depth >= self.settings.depth {
            return black();
        }
        let kind = match (leaving.kind, trail.kind) {
            (RayKind::Reflected, _) => match self.scene.roughness(met.object) {
                Some(alpha) if alpha >= WIDE => RayKind::Glossy,
                Some(_) if self.is_sun_limited() => RayKind::Polished,
                _ => RayKind::Reflected,
            },
            // Lights shine through glass and absent surfaces.
            (
                RayKind::Refracted,
                before @ (RayKind::Glossy | RayKind::Polished | RayKind::Diffuse),
            ) => before,
            (kind, _) => kind,
        };
        let mut trail = Trail {
            depth: trail.depth + 1,
            kind,
            reflections: trail.reflections + u8::from(leaving.kind == RayKind::Diffuse),
            ..*trail
        };
        if leaving.outward != met.front {
            trail.inside = surface.beyond;
        }
        let line = Line {
            origin: met.point.clone(),
            slope: self.on_its_side(met, leaving.slope, leaving.outward),
        };
        self.radiance(&Ray {
            line,
            weight: leaving.weight,
            trail,
        })
    }

    /// In scenes with normals for shading, a direction to the wrong side of a surface is turned into its plane, and up.
    fn on_its_side(&self, met: &Met<'_>, slope: Vector, outward: bool) -> Vector {
        let effects = self.scene.effects();
        if !self.is_smooth && !effects.contains(Effects::NORMAL_MAP) {
            return slope;
        }
        let normal = scaled(&met.normal, &real(if outward { 1.0 } else { -1.0 }));
        let rise: Real = dot(&slope, &normal);
        if rise.is_positive() {
            slope
        } else {
            along(&slope, &(real(1.0 / 4096.0) - rise), &normal)
        }
    }
}
