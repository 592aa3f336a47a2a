//! Where lights are from a surface, and how their light falls off.

use super::exact::Exact;
use super::numbers::{black, color, fraction, limited, mixed, one, real};
use super::random::{beside, part, turn};
use super::sky::in_sun;
use super::surface::Trail;
use gridel_core::format::light_form::LightForm;
use gridel_core::format::record::Light;
use gridel_host::shape::exact::{Real, Vector, dot, minus, norm, scaled, unit};

/// The cone of directions to a sphere.
pub struct Cone {
    /// How far its middle is.
    distance: Real,
    /// 1 / (1 + cos) of the angle between its axis and its side.
    widening: Real,
}

/// The way to a point of a light.
pub struct Aim {
    pub way: Vector,
    /// How far along the way the light is; `None` for infinitely far.
    pub end: Option<Real>,
    /// Where the light is a sphere.
    pub cone: Option<Cone>,
    /// Its radiance, before it falls off.
    pub brought: Vector,
}

impl Aim {
    pub fn far(way: Vector, brought: Vector) -> Self {
        Self {
            way,
            end: None,
            cone: None,
            brought,
        }
    }

    /// At the end of a way.
    fn at(way: Vector, brought: Vector) -> Self {
        Self {
            end: Some(one()),
            ..Self::far(way, brought)
        }
    }

    fn distance(&self) -> Option<Real> {
        Some(self.end.as_ref()? * norm(&self.way))
    }
}

/// The way to the position of a light.
pub fn toward(light: &Light, from: &Vector) -> Vector {
    minus(&light.vector.map(|x| fraction(x, 13)), from)
}

/// The way to a random point of an area; `None` if it is hidden.
fn on_area(form: &LightForm, middle: Aim, [u, v]: [u32; 2]) -> Option<Aim> {
    let (along, across) = match form.shape {
        LightForm::SPHERE => return on_sphere(form, middle, [u, v]),
        LightForm::DISC => {
            let (radius, [sine, cosine]) = (part(u).sqrt(), turn(v));
            (&radius * cosine, radius * sine)
        }
        // The half of a parallelogram beyond the third side is turned onto the other half.
        LightForm::TRIANGLE if part(u) + part(v) > one() => (one() - part(u), one() - part(v)),
        _ => (part(u), part(v)),
    };
    let [first, second] = form.edges.map(|edge| color(edge, 13));
    let way = mixed([&middle.way, &first, &second], [&one(), &along, &across]);
    Some(Aim::at(way, middle.brought))
}

/// The way to where a random direction meets a sphere; `None` within it.
fn on_sphere(form: &LightForm, middle: Aim, [u, v]: [u32; 2]) -> Option<Aim> {
    let distance = norm(&middle.way);
    let radius = fraction(form.edges[0][0], 13);
    if !radius.is_positive() || radius >= distance {
        return None;
    }
    let axis = unit(&middle.way);
    let widest = &radius / &distance;
    let square = &widest * &widest;
    let widening = one() / (one() + (one() - &square).sqrt());
    // 1 less the cosine of the direction's angle.
    let sag = &square * &widening * part(u);
    let away = (&sag * (real(2.0) - &sag)).sqrt().min(widest.clone());
    let near = one() - &sag;
    let [sine, cosine] = turn(v);
    let [first, second] = beside(&axis);
    let way = mixed(
        [&axis, &first, &second],
        [&near, &(&away * cosine), &(&away * sine)],
    );
    // From the middle of the chord to the surface.
    let off = (&away / &widest).min(one());
    let inward = &radius * (one() - &off * &off).sqrt();
    Some(Aim {
        way,
        end: Some(&distance * &near - inward),
        cone: Some(Cone { distance, widening }),
        brought: middle.brought,
    })
}

/// The cosine between a light's direction and the way to a surface.
fn cos_from(form: &LightForm, to_light: &Vector) -> Real {
    limited(-dot(&color(form.normal, 30), to_light), -1.0, 1.0)
}

fn is_flat(form: &LightForm) -> bool {
    matches!(
        form.shape,
        LightForm::RECTANGLE | LightForm::DISC | LightForm::TRIANGLE
    )
}

/// Returns whether a spot ends at some angle.
fn has_cone(form: &LightForm) -> bool {
    form.shape == 0 && form.cone_cosine > -(1 << 30)
}

/// Returns whether a light shines towards a surface that lies in its range.
pub fn shines(form: &LightForm, aim: &Aim, to_light: &Vector) -> bool {
    let is_shone_on = if is_flat(form) {
        cos_from(form, to_light).is_positive()
    } else {
        !has_cone(form) || cos_from(form, to_light) > fraction(form.cone_cosine, 30)
    };
    let is_near = |distance: Real| distance < fraction(form.range, 13);
    is_shone_on && (form.range == 0 || aim.distance().is_some_and(is_near))
}

/// Returns the light that arrives from a light.
pub fn falling(form: &LightForm, aim: &Aim, to_light: &Vector) -> Vector {
    let middle = aim.cone.as_ref().map(|cone| cone.distance.clone());
    let Some(distance) = middle.or_else(|| aim.distance()) else {
        return black();
    };
    let mut factor = one();
    if form.reference > 0 {
        let ratio = fraction(form.reference, 13) / &distance;
        factor = &ratio * &ratio;
    }
    if form.range > 0 {
        let ratio = &distance / fraction(form.range, 13);
        let square = &ratio * &ratio;
        factor = factor * (one() - &square * &square).max(real(0.0));
    }
    if let Some(cone) = &aim.cone {
        factor = factor * &cone.widening * real(2.0);
    } else if is_flat(form) {
        factor = factor * cos_from(form, to_light).max(real(0.0));
    } else if has_cone(form) {
        let within = cos_from(form, to_light) - fraction(form.cone_cosine, 30);
        let width = fraction(form.cone_width, 30);
        if within < width {
            let ratio = within.max(real(0.0)) / width;
            factor = factor * &ratio * &ratio;
        }
    }
    scaled(&aim.brought, &factor)
}

impl Exact<'_> {
    /// The way from a point to a light, by its number; `None` if no light comes from there.
    pub fn aim(&self, number: usize, light: &Light, from: &Vector, trail: &Trail) -> Option<Aim> {
        let brought = color(light.color, 20);
        let point = || trail.point(number as u16 & 0xfff);
        match light.directional {
            1 => Some(Aim::far(light.vector.map(|x| fraction(x, 30)), brought)),
            Light::ENVIRONMENT => self.map_light(|dimension| trail.point(dimension)),
            Light::SUN => {
                let record = self.scene.environment().expect("a sun");
                Some(Aim::far(in_sun(record, point()), brought))
            }
            _ => {
                let middle = Aim::at(toward(light, from), brought);
                match self.scene.light_form(light) {
                    Some(form) if light.is_area() => on_area(form, middle, point()),
                    _ => Some(middle),
                }
            }
        }
    }
}
