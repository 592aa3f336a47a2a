//! Camera rays, and the conversion of their light to a pixel.

use super::exact::Exact;
use super::numbers::{color, fraction, limited, mixed, one, real, sum};
use super::random::{part, turn};
use super::surface::Trail;
use gridel_core::Effects;
use gridel_core::format::lens::Lens;
use gridel_core::format::record::View;
use gridel_host::shape::exact::{Line, Real, Vector, dot, minus, scaled, unit};

/// The dimension of random points of the lens.
const LENS: u16 = 0x1000;

/// The brightest that counts of a sample where effects act on the mean, and with lights that have an area.
const BRIGHTEST: [f64; 2] = [16.0, 4.0];

impl Exact<'_> {
    /// The line from the eye through the middle of a pixel, or that from a point of the lens to where it is sharp.
    pub fn start_line(&self, trail: &Trail) -> Line {
        let view = self.scene.view();
        let [width, height] = [self.settings.width, self.settings.height].map(f64::from);
        let [x, y] = trail.pixel.map(f64::from);
        // From the middle of the picture, in half heights.
        let right = real(2.0 * x + 1.0 - width) / real(height);
        let up = real(height - 2.0 * y - 1.0) / real(height);
        let [forward, across, upward] = [view.forward, view.right, view.up].map(|it| color(it, 0));
        let line = Line {
            origin: view.eye.map(|x| fraction(x, 13)),
            slope: mixed([&forward, &across, &upward], [&one(), &right, &up]),
        };
        match self.scene.lens() {
            Some(lens) => refracted(view, lens, line, trail.point(LENS)),
            None => line,
        }
    }

    /// Returns the display value of the radiance of the only sample.
    pub fn shown(&self, radiance: Vector) -> Vector {
        let of_the_mean = [
            Effects::ENVIRONMENT,
            Effects::GLOSSY,
            Effects::INDIRECT,
            Effects::TONE_MAPPING,
        ];
        let effects = self.scene.effects();
        let acts = of_the_mean.iter().any(|&it| effects.contains(it));
        let most = match effects.contains(Effects::AREA_LIGHT) {
            _ if acts => BRIGHTEST[0],
            true => BRIGHTEST[1],
            false => 1.0,
        };
        let encoding = self.scene.view().encoding;
        radiance.map(|x| limited(toned(limited(x, 0.0, most), encoding), 0.0, 1.0))
    }
}

/// The line from a random point of a lens to where one from the eye meets the plane of focus.
fn refracted(view: &View, lens: &Lens, line: Line, [u, v]: [u32; 2]) -> Line {
    let [forward, right, up] = [view.forward, view.right, view.up].map(|it| unit(&color(it, 0)));
    let radius = part(u).sqrt() * fraction(lens.radius, 13);
    let [sine, cosine] = turn(v);
    let offset = sum(
        &scaled(&right, &(&radius * cosine)),
        &scaled(&up, &(&radius * sine)),
    );
    let cos = dot(&forward, &line.slope);
    let sharp = scaled(&line.slope, &fraction(lens.focus, 13));
    Line {
        origin: sum(&line.origin, &offset),
        slope: minus(&sharp, &scaled(&offset, &cos)),
    }
}

/// A channel by the curve of Reinhard, or by that like ACES's, whose constants have 30 fraction bits.
fn toned(x: Real, encoding: u8) -> Real {
    let ratio = &x / (one() + &x);
    match encoding {
        View::REINHARD => ratio,
        View::ACES => {
            let constant = |of: f64| fraction((of * f64::powi(2.0, 30)).round() as i64, 30);
            // Both parts of the fraction x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14), over 2 (1 + x)².
            let rest = one() - &ratio;
            let above = &ratio * (constant(1.24) * &ratio + constant(0.015));
            let below = &ratio * (constant(0.92) * &ratio + constant(0.295))
                + constant(0.07) * &rest * &rest;
            above / below
        }
        _ => x,
    }
}
