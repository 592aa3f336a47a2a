//! The light of lights at a surface.

use super::exact::Exact;
use super::lights::{Aim, falling, shines, toward};
use super::media::Inside;
use super::numbers::{black, color, decay, fraction, limited, one, peak, product, sum};
use super::placed::Met;
use super::surface::Surface;
use gridel_core::Effects;
use gridel_core::format::limits::MAX_SHADOW_SURFACES;
use gridel_core::format::record::{Light, Material};
use gridel_host::shape::exact::{Line, Real, Vector, dot, minus, norm, scaled, unit};

/// The part of the lights that a highlight adds.
fn highlight(surface: &Surface<'_>, to_light: &Vector) -> Vector {
    let material = surface.material;
    if material.highlight == [0; 3] {
        return black();
    }
    let halfway = unit(&minus(to_light, &surface.direction));
    let cos = limited(dot(&surface.normal, &halfway), 0.0, 1.0);
    let mut power = one();
    for bit in (0..16).rev() {
        power = &power * &power;
        if (material.shininess & 0xfff) >> bit & 1 == 1 {
            power = power * &cos;
        }
    }
    scaled(&color(material.highlight, 30), &power)
}

/// A surface between a point and a light.
struct Passed {
    left: Vector,
    beyond: Inside,
}

impl Exact<'_> {
    pub fn lit(&self, number: usize, light: &Light, surface: &Surface<'_>) -> Vector {
        let Surface { met, normal, .. } = surface;
        let Some(mut aim) = self.aim(number, light, &met.point, &surface.trail) else {
            return black();
        };
        let to_light = unit(&aim.way);
        let cos = dot(normal, &to_light);
        if !cos.is_positive() {
            return black();
        }
        let Some(origin) = self.start(light, met, &mut aim, &to_light) else {
            return black();
        };
        let form = self.scene.light_form(light);
        if form.is_some_and(|form| !shines(form, &aim, &to_light)) {
            return black();
        }
        let mut reflected = scaled(&surface.diffuse, &cos);
        if surface.material.highlight != [0; 3] {
            let bright = highlight(surface, &to_light);
            reflected = sum(&reflected, &bright).map(|x| x.min(one()));
        }
        if let Some(mirrored) = self.mirrored_light(surface, light, &to_light) {
            reflected = sum(&reflected, &mirrored);
        }
        let arriving = match form {
            Some(form) => falling(form, &aim, &to_light),
            None => aim.brought,
        };
        let brought = product(&arriving, &reflected);
        if !peak(&brought).is_positive() || !self.has_shadows() {
            return brought;
        }
        let line = Line {
            origin,
            slope: aim.way,
        };
        product(
            &brought,
            &self.left(line, aim.end, &to_light, surface.trail.inside),
        )
    }

    fn has_shadows(&self) -> bool {
        self.scene.effects().contains(Effects::SHADOW)
    }

    /// Returns where the way to a light starts: on the triangle's curved surface, if the triangle faces away. `None` if
    /// the light does not reach it.
    fn start(
        &self,
        light: &Light,
        met: &Met<'_>,
        aim: &mut Aim,
        to_light: &Vector,
    ) -> Option<Vector> {
        let is_bumpy = self.material(met).maps & Material::MAPS_NORMAL != 0;
        let starts_above = self.is_smooth && self.has_shadows();
        if dot(&met.turned(&met.normal), to_light).is_positive() || !starts_above && !is_bumpy {
            return Some(met.point.clone());
        }
        if !starts_above {
            return None;
        }
        let origin = sum(&met.point, &met.lift()?);
        // Of others a point has been drawn, or they are far away.
        if light.is_point() {
            aim.way = toward(light, &origin);
        }
        Some(origin)
    }

    /// Returns the part of light that remains on its way.
    fn left(
        &self,
        mut line: Line,
        mut end: Option<Real>,
        to_light: &Vector,
        mut inside: Inside,
    ) -> Vector {
        let mut left = [one(), one(), one()];
        for _ in 0..=MAX_SHADOW_SURFACES {
            let Some(blocker) = self.nearest(&line, end.as_ref()) else {
                return match (end, self.around(inside)) {
                    (Some(end), Some(medium)) => {
                        product(&left, &self.absorbed(medium, &(end * norm(&line.slope))))
                    }
                    _ => left,
                };
            };
            let length = &blocker.t * norm(&line.slope);
            let Some(passed) = self.passed(&blocker, to_light, &length, inside) else {
                return black();
            };
            left = product(&left, &passed.left);
            if peak(&left) <= fraction(self.scene.view().cutoff, 20) {
                return black();
            }
            inside = passed.beyond;
            end = end.map(|end| end - &blocker.t);
            line.origin = blocker.point;
        }
        black()
    }

    /// Returns the light that passes a surface after a length of the way to it; `None` if none does.
    fn passed(
        &self,
        met: &Met<'_>,
        to_light: &Vector,
        length: &Real,
        inside: Inside,
    ) -> Option<Passed> {
        let (material, face) = (self.material(met), self.face(inside, met));
        let beyond = face.beyond;
        let absorbed = || match face.before {
            Some(medium) => self.absorbed(medium, length),
            None => [one(), one(), one()],
        };
        if face.is_hidden {
            let left = absorbed();
            return Some(Passed { left, beyond });
        }
        if let Some(interface) = &face.interface {
            let cos = dot(&met.normal, to_light).abs().min(one());
            let through = scaled(
                &color(material.transmit, 30),
                &interface.straight_through(&cos),
            );
            let left = product(&through, &absorbed());
            return Some(Passed { left, beyond });
        }
        let rest = one() - self.alpha(met, material);
        let left = scaled(&absorbed(), &rest);
        rest.is_positive().then_some(Passed { left, beyond })
    }

    pub fn absorbed(&self, material: &Material, length: &Real) -> Vector {
        let bits = 32 - i32::from(material.shininess >> 12);
        material
            .absorption
            .map(|coefficient| decay(&(length * fraction(coefficient, bits))))
    }
}
