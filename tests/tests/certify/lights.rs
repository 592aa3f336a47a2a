//! Directions and distances of lights from a surface, and the falloff of their light.

use super::exact::Exact;
use super::numbers::{black, color, fraction, limited, mixed, one, real};
use super::random::{beside, part, turn};
use super::sky::in_sun;
use super::surface::Trail;
use gridel_core::format::light_form::LightForm;
use gridel_core::format::record::Light;
use gridel_host::shape::exact::{Real, Vector, cross, dot, minus, norm, scaled, unit};

/// The light that a point brings which was drawn by solid angle: that at a distance, times twice a ratio.
pub struct Share {
    distance: Real,
    half: Real,
}

/// The way to a point of a light.
pub struct Aim {
    pub way: Vector,
    /// The distance of the light along the way; `None` for infinitely far.
    pub end: Option<Real>,
    /// Present if the point was drawn by solid angle.
    pub share: Option<Share>,
    /// Its radiance, before it falls off.
    pub brought: Vector,
}

impl Aim {
    pub fn far(way: Vector, brought: Vector) -> Self {
        Self {
            way,
            end: None,
            share: None,
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
    let [first, second] = form.edges.map(|edge| color(edge, 13));
    if form.shape == LightForm::SPHERE {
        return on_sphere(form, middle, [u, v]);
    }
    let [x, y, z] = middle.way.clone().map(|it| it.abs());
    if x + y + z < fraction(form.width, 13)
        && let Some(near) = on_near(form, &middle, [&first, &second], [u, v])
    {
        return Some(near);
    }
    let (along, across) = match form.shape {
        LightForm::DISC => {
            let (radius, [sine, cosine]) = (part(u).sqrt(), turn(v));
            (&radius * cosine, radius * sine)
        }
        // The half of a parallelogram beyond the third side is turned onto the other half.
        LightForm::TRIANGLE if part(u) + part(v) > one() => (one() - part(u), one() - part(v)),
        _ => (part(u), part(v)),
    };
    let way = mixed([&middle.way, &first, &second], [&one(), &along, &across]);
    Some(Aim::at(way, middle.brought))
}

/// The way to a random point of a flat light: a row of it by the tangent of half its angle, and a place in the row by
/// the sine of its angle. `None` behind it.
fn on_near(
    form: &LightForm,
    middle: &Aim,
    [first, second]: [&Vector; 2],
    [u, v]: [u32; 2],
) -> Option<Aim> {
    let toward = color(form.normal, 30);
    let (right, side) = (unit(first), norm(first));
    let up = cross(&toward, &right);
    let (height, depth) = (-dot(&toward, &middle.way), dot(&up, second));
    if !height.is_positive() || !depth.is_positive() {
        return None;
    }
    let [x, y] = [&right, &up].map(|axis| dot(axis, &middle.way));
    let hypotenuse = |a: &Real, b: &Real| (a * a + b * b).sqrt();
    let is_disc = form.shape == LightForm::DISC;
    let near = if is_disc { &y - &side } else { y.clone() };
    let half_tangent = |row: Real| &row / (&height + hypotenuse(&height, &row));
    let nearest = half_tangent(near);
    let turn = half_tangent(&y + &depth) - &nearest;
    let tangent = &nearest + &turn * part(u);
    let square = &tangent * &tangent;
    let row = real(2.0) * &height * &tangent / (one() - &square);

    let place = (&row - &y) / &depth;
    let start = x.clone() + dot(&right, second) * &place;
    let (left, end) = if is_disc {
        let chord = &side * (one() - &place * &place).max(real(0.0)).sqrt();
        (&x - &chord, &x + &chord)
    } else if form.shape == LightForm::TRIANGLE {
        (start.clone(), start + &side * (one() - &place))
    } else {
        (start.clone(), start + &side)
    };
    let away = hypotenuse(&height, &row);
    let leftmost = &left / hypotenuse(&left, &away);
    let width = &end / hypotenuse(&end, &away) - &leftmost;
    let sine = leftmost + &width * part(v);
    let along = &away * &sine / (one() - &sine * &sine).sqrt();
    let area = &side
        * &depth
        * real(match form.shape {
            LightForm::DISC => std::f64::consts::PI,
            LightForm::TRIANGLE => 0.5,
            _ => 1.0,
        });
    Some(Aim {
        share: Some(Share {
            distance: area.sqrt() / real(2.0),
            half: turn * width / (real(4.0) * (one() + square)),
        }),
        ..Aim::at(
            mixed([&right, &up, &toward], [&along, &row, &-height]),
            middle.brought.clone(),
        )
    })
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
    let half = one() / (one() + (one() - &square).sqrt());
    // 1 less the cosine of the direction's angle.
    let sag = &square * &half * part(u);
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
        share: Some(Share { distance, half }),
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

/// The distance at which the light ends.
fn range(form: &LightForm) -> Real {
    match form.range {
        far @ ..0 => fraction(-far, 8),
        near => fraction(near, 13),
    }
}

/// Returns whether a light shines towards a surface that lies in its range.
pub fn shines(form: &LightForm, aim: &Aim, to_light: &Vector) -> bool {
    let is_shone_on = if is_flat(form) {
        cos_from(form, to_light).is_positive()
    } else {
        !has_cone(form) || cos_from(form, to_light) > fraction(form.cone_cosine, 30)
    };
    let is_near = |distance: Real| distance < range(form);
    is_shone_on && (form.range == 0 || aim.distance().is_some_and(is_near))
}

/// Returns the light that arrives from a light.
pub fn falling(form: &LightForm, aim: &Aim, to_light: &Vector) -> Vector {
    let Some(own) = aim.distance() else {
        return black();
    };
    let share = aim.share.as_ref();
    let distance = share.map_or(&own, |share| &share.distance);
    let mut factor = one();
    if form.reference > 0 {
        let ratio = fraction(form.reference, 13) / distance;
        factor = &ratio * &ratio;
    }
    if form.range != 0 {
        let ratio = &own / range(form);
        let square = &ratio * &ratio;
        factor = factor * (one() - &square * &square).max(real(0.0));
    }
    if let Some(share) = share {
        factor = factor * &share.half * real(2.0);
    } else if is_flat(form) {
        factor = factor * cos_from(form, to_light).max(real(0.0));
    } else if has_cone(form) {
        let within = cos_from(form, to_light) - fraction(form.cone_cosine, 30);
        let width = fraction(form.width, 30);
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
        match light.kind {
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
