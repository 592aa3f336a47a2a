//! The directions to lights from a surface, and the light that arrives without anything in the way.

use super::crossing::exact;
use super::directions;
use super::number::*;
use super::path::Path;
use super::reason::Reason;
use super::search::{Stop, Tracer};
use super::sky;
use super::solid_angle::{self, Drawn, Share, length};
use super::world::NONE;
use gridel_core::format::light_form::LightForm;
use gridel_core::format::record::Light;

/// The way to a light, or to the point of it that a sample sees.
#[derive(Clone, Copy, Debug)]
pub struct Aim<N> {
    /// The way to the light. For infinitely far lights its length has no meaning.
    pub way: Three<N>,
    pub is_far: bool,
    /// The light that its point brings, where it was drawn by solid angle.
    share: Option<Share<N>>,
    /// The light's color.
    pub color: Three<N>,
}

impl<N> Aim<N> {
    /// Returns the light as seen along another way.
    pub fn along(self, way: Three<N>) -> Self {
        Self { way, ..self }
    }

    fn at(self, drawn: Drawn<N>) -> Self {
        Self {
            way: drawn.way,
            share: Some(drawn.share),
            ..self
        }
    }
}

impl Tracer<'_, '_> {
    /// Returns the way to a light; `None` where it does not shine on a point.
    ///
    /// # Errors
    /// If the way is open.
    pub fn aim<N: Enclosure>(
        &self,
        (number, light): (u32, &Light),
        point: Three<N>,
        path: &Path<N>,
    ) -> Result<Option<Aim<N>>, Stop> {
        let scene = self.world.scene;
        let color = light.color.map(radiance_of);
        let far = |way, color| {
            Ok(Some(Aim {
                way,
                is_far: true,
                share: None,
                color,
            }))
        };
        let place = (path.depth, NONE);
        // Lights beyond the first 4,096 share points with these.
        let dimension = number as u16 & 0xfff;
        match (light.kind, scene.environment()) {
            (Light::DIRECTIONAL, _) => return far(exact(light.vector), color),
            (Light::ENVIRONMENT, Some(_)) => {
                let drawn = sky::from_map(scene, path.point(sky::DIMENSION));
                let (way, radiance) = self.known(drawn, Reason::Sampling, place, point)?;
                return far(way, radiance);
            }
            (Light::SUN, Some(record)) => {
                let way = sky::in_sun(record, path.point(dimension));
                let way = self.known(way, Reason::Sampling, place, point)?;
                return far(way, color);
            }
            _ => {}
        }
        let way = minus(light.vector.map(length), point);
        let aim = Aim {
            way,
            is_far: false,
            share: None,
            color,
        };
        match scene.light_form(light).filter(|_| light.is_area()) {
            None => Ok(Some(aim)),
            Some(form) if form.shape == LightForm::SPHERE => {
                let radius = length::<N>(form.edges[0][0].into());
                let beyond = positive(norm2(way).sqrt() - radius);
                if !self.known(beyond, Reason::Terminator, place, point)? {
                    // From within a sphere its light is invisible.
                    return Ok(None);
                }
                let drawn = solid_angle::of_sphere(radius, way, path.point(dimension));
                let drawn = self.known(drawn, Reason::Sampling, place, point)?;
                Ok(Some(aim.at(drawn)))
            }
            Some(form) => {
                let [x, y, z] = aim.way.map(N::abs);
                let is_near = positive(length::<N>(form.width.into()) - (x + y + z));
                let is_near = self.known(is_near, Reason::Near, place, point)?;
                let found = on_flat(form, aim, path.point(dimension), is_near);
                self.known(found, Reason::Sampling, place, point).map(Some)
            }
        }
    }
}

/// Returns the way to a random point of a flat light, of one that is near by solid angle; `None` where that is open.
fn on_flat<N: Enclosure>(
    form: &LightForm,
    aim: Aim<N>,
    point: [u32; 2],
    is_near: bool,
) -> Option<Aim<N>> {
    if is_near && let Some(drawn) = solid_angle::of_flat(form, aim.way, point)? {
        return Some(aim.at(drawn));
    }
    let way = plus(aim.way, within(form, point));
    Some(Aim { way, ..aim })
}

/// Returns the vector from the position of a flat light to a random point of it.
fn within<N: Enclosure>(form: &LightForm, [u, v]: [u32; 2]) -> Three<N> {
    let one = 1_u32 << 30;
    let [along, across] = match form.shape {
        LightForm::DISC => {
            let (radius, [sine, cosine]) =
                (directions::ratio::<N>(u).sqrt(), directions::turn::<N>(v));
            [radius * cosine, radius * sine]
        }
        // The half of a parallelogram beyond the third side is turned onto the other half.
        LightForm::TRIANGLE if (u >> 2) + (v >> 2) > one => [
            N::one() - directions::ratio(u),
            N::one() - directions::ratio(v),
        ],
        _ => [directions::ratio(u), directions::ratio(v)],
    };
    let [first, second] = form.edges.map(|edge| edge.map(|it| length::<N>(it.into())));
    plus(scale(first, along), scale(second, across))
}

/// The distance at which a light ends.
fn range<N: Enclosure>(form: &LightForm) -> N {
    match form.range {
        far @ ..0 => length(i64::from(-far) << LightForm::FAR_RANGE_BITS),
        near => length(near.into()),
    }
}

/// Returns the light that arrives from a light with a form, given the direction to it; `None` where that is open.
pub fn arriving<N: Enclosure>(
    form: &LightForm,
    aim: &Aim<N>,
    to_light: Three<N>,
) -> Option<Three<N>> {
    let (zero, one) = (N::zero(), N::one());
    let own = norm2(aim.way).sqrt();
    let distance = aim.share.map_or(own, |share| share.distance);
    let mut part = one;
    if form.reference > 0 {
        // Nothing is nearer than 2^-32 of that distance.
        let ratio = length::<N>(form.reference.into()).div(distance)?;
        part = ratio.at_most(N::int(1 << 32)).square();
    }
    if form.range != 0 {
        let square = own.div(range(form))?.square();
        part = part * (one - square.square()).at_least(zero);
    }
    if let Some(share) = aim.share {
        part = part * (share.half + share.half);
    } else {
        let cosine = -dot(form.normal.map(ratio_of), to_light);
        let cosine = cosine.at_least(-one).at_most(one);
        match form.shape {
            LightForm::RECTANGLE | LightForm::DISC | LightForm::TRIANGLE => {
                part = part * cosine.at_least(zero);
            }
            _ if form.cone_cosine > -(1 << 30) => {
                let within = cosine - ratio_of(form.cone_cosine);
                part = part
                    * match (form.width, positive(within)) {
                        (0, Some(is_inside)) => N::int(is_inside.into()),
                        (0, None) => zero.hull(one),
                        (width, _) => {
                            let within = within.at_least(zero).div(ratio_of(width))?;
                            within.at_most(one).square()
                        }
                    };
            }
            _ => {}
        }
    }
    Some(scale(aim.color, part))
}
