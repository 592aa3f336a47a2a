//! The pixels of a picture, each enclosed.

use super::camera;
use super::deep::{self, Ball};
use super::interval::Interval;
use super::levels;
use super::number::*;
use super::reason::Reason;
use super::search::{Open, Step, Tracer};
use super::tone;
use super::world::{NONE, World};
use crate::srgb::linear_of_srgb;
use crate::trace::Frame;
use bytemuck::{Pod, Zeroable};
use gridel_core::format::record::View;
use gridel_core::render::Pixel as _;
use gridel_core::{Rgb888, Settings};
use std::cell::{Cell, RefCell};

/// The levels of precision with which a pixel is evaluated: bits of its numbers.
pub const LEVELS: [usize; 3] = [53, 128, 256];

/// Outcomes that are followed at each level.
const BRANCHES: [u32; 3] = [12, 48, 192];

/// An open comparison of 256 bits is one of equals if the enclosure of what it depends on has a radius below this.
const EQUAL: f64 = 1e-40;

/// The known bounds of a pixel: 80 bytes, as they are kept between runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Enclosed {
    /// Linear values that enclose the exact ones, red, green and blue: 1 is display white.
    pub linear: [[f64; 2]; 3],
    /// The point of an open comparison, in lattice units.
    pub point: [f32; 3],
    /// The primitive of an open comparison, or [`NONE`].
    pub primitive: u32,
    /// The 8-bit values of the bounds.
    pub low: [u8; 3],
    pub high: [u8; 3],
    /// The last level that was tried, an index of [`LEVELS`].
    pub level: u8,
    /// The reason for which the pixel is open, or 0.
    pub reason: u8,
    /// Number of reflections and refractions that lead to an open comparison.
    pub depth: u8,
    /// 1 where the exact picture lies on a boundary, as far as 256 bits can decide.
    pub on_boundary: u8,
    /// 1 once it is evaluated.
    pub done: u8,
    /// 1 where there is an open comparison, whose point is known.
    pub has_point: u8,
    pub spare: [u8; 4],
}

impl Enclosed {
    /// Returns the exact 8-bit values, if they are proved.
    pub fn proved(&self) -> Option<[u8; 3]> {
        (self.done == 1 && self.low == self.high).then_some(self.low)
    }

    /// Returns the distance of the bounds of the worst channel.
    pub fn width(&self) -> f64 {
        let widths = self.linear.iter().map(|[low, high]| high - low);
        widths.fold(0.0, f64::max)
    }

    /// Returns the point of an open comparison, in lattice units.
    pub fn point(&self) -> Option<[f64; 3]> {
        (self.has_point == 1).then_some(self.point.map(f64::from))
    }

    /// Takes the reason of an evaluation that left the pixel open, and its place.
    fn note(&mut self, evaluated: &Evaluated, is_last: bool) {
        let open = evaluated.open.first();
        let reason = match open {
            Some(open) => open.reason,
            None if evaluated.linear.is_none() => Reason::Width,
            None => Reason::Rounding,
        };
        self.reason = reason as u8;
        self.primitive = open.map_or(NONE, |open| open.primitive);
        self.depth = open.map_or(0, |open| open.depth);
        self.has_point = open.is_some().into();
        self.point = open.map_or([0.0; 3], |open| open.point.map(|x| x as f32));
        // Numbers that 256 bits cannot distinguish count as equal.
        let is_equal = match (open, reason) {
            (_, Reason::Branches | Reason::Width) => false,
            (Some(open), _) => open.radius < EQUAL,
            (None, _) => self.width() < EQUAL,
        };
        self.on_boundary = u8::from(is_last && is_equal);
    }

    pub fn reason(&self) -> Option<Reason> {
        Reason::of_number(self.reason)
    }

    /// Returns the error of the values of a format: 0 if they are the exact ones; `None` if that is open. A value
    /// outside of the bounds is wrong by its distance at least.
    pub fn error_of(&self, values: [u8; 3]) -> Option<u8> {
        let off = |k: usize| {
            let (low, high) = (self.low[k], self.high[k]);
            low.saturating_sub(values[k])
                .max(values[k].saturating_sub(high))
        };
        let most = off(0).max(off(1)).max(off(2));
        (most > 0 || self.proved().is_some()).then_some(most)
    }
}

/// The linear value of an 8-bit code of sRGB (IEC 61966-2-1), 65535 being white.
fn linear_of_code(code: u16) -> u16 {
    let linear = linear_of_srgb(f64::from(code) / 255.0);
    (linear * 65535.0 + 0.5) as u16
}

/// The linear value of a display value, by the blob's rule.
fn from_display(value: u16) -> u16 {
    let value = u32::from(value);
    let code = (value + (value >> 15)) * 255;
    let (below, part) = (code >> 16, code & 0xffff);
    let low = u32::from(linear_of_code(below as u16));
    let high = u32::from(linear_of_code((below + 1).min(255) as u16));
    (low + (((high - low) * part + 0x8000) >> 16)) as u16
}

/// Returns the 8-bit values of a picture's own 16-bit values.
pub fn code(linear: [u16; 3]) -> [u8; 3] {
    let Rgb888(code) = Rgb888::encode(linear, None);
    code
}

/// One evaluation of a pixel.
struct Evaluated {
    /// `None` where it ended without a result.
    linear: Option<[[f64; 2]; 3]>,
    open: Vec<Open>,
}

fn evaluate<N: Enclosure>(
    world: &World<'_>,
    settings: &Settings,
    pixel: [u16; 2],
    level: usize,
    steps: Option<&mut Vec<Step>>,
) -> Evaluated {
    let mut tracer = Tracer {
        world,
        depth: settings.depth,
        spread: levels::spread(world, settings),
        is_slow: level > 0,
        left: Cell::new(BRANCHES[level]),
        open: RefCell::new(Vec::new()),
        steps: steps.is_some().then(RefCell::default),
    };
    let black = [N::zero(); 3];
    let mut sum = black;
    let mut is_known = true;
    let brightest = N::int(tone::brightest(world.scene.effects()));
    for sample in 0..settings.samples {
        tracer.left.set(BRANCHES[level]);
        let path = camera::path::<N>(world, settings, pixel, sample);
        let eye = world.scene.view().eye.map(|x| N::scaled(x, 5));
        let path = tracer.known(path, Reason::Sampling, (0, NONE), eye);
        match path.and_then(|path| tracer.radiance(&path)) {
            Ok(seen) => {
                let limit = |x: N| x.at_least(N::zero()).at_most(brightest);
                sum = plus(sum, seen.map(limit));
            }
            Err(_) => {
                is_known = false;
                break;
            }
        }
    }
    if settings.samples > 1 {
        let part = (1 << 30) / i64::from(settings.samples);
        sum = scale(sum, N::scaled(part, 30));
    }
    let encoding = world.scene.view().encoding;
    let [red, green, blue] = sum.map(|channel| tone::developed(encoding, channel));
    let shown = (|| Some([red?, green?, blue?]))();
    if let Some(steps) = steps {
        steps.extend(
            tracer
                .steps
                .take()
                .into_iter()
                .flat_map(RefCell::into_inner),
        );
    }
    let open = tracer.open.take();
    Evaluated {
        linear: shown.filter(|_| is_known).map(|shown| {
            shown.map(|x| {
                let [low, high] = x.bounds();
                [low.clamp(0.0, 1.0), high.clamp(0.0, 1.0)]
            })
        }),
        open,
    }
}

/// The 16-bit values of the bounds.
fn rounded(world: &World<'_>, linear: &[[f64; 2]; 3]) -> [[u16; 3]; 2] {
    // The rounding of the sum and of the product does not reach the value that is cut off.
    let value = |x: f64, by: f64| {
        let value = ((x + by).clamp(0.0, 1.0) * 65535.0 + 0.5).clamp(0.0, 65535.0) as u16;
        if world.scene.view().encoding == View::DISPLAY_VALUES {
            from_display(value)
        } else {
            value
        }
    };
    [
        linear.map(|[low, _]| value(low, -1e-15)),
        linear.map(|[_, high]| value(high, 1e-15)),
    ]
}

/// Intersects the bounds with those of another evaluation. Both hold the exact value, so what they share does.
fn narrow(known: &mut [[f64; 2]; 3], evaluated: &Evaluated) {
    if let Some(linear) = evaluated.linear {
        for (known, [low, high]) in known.iter_mut().zip(linear) {
            *known = [known[0].max(low), known[1].min(high)];
        }
    }
}

/// Returns the linear values of a pixel as a picture has them, 65535 being white, and whether they are proved. Values
/// that are not proved are the middle of their interval.
pub fn linear(world: &World<'_>, settings: &Settings, pixel: [u16; 2]) -> ([u16; 3], bool) {
    let mut known = [[0.0, 1.0]; 3];
    for level in 0..LEVELS.len() {
        narrow(&mut known, &at_level(world, settings, pixel, level, None));
        let [low, high] = rounded(world, &known);
        if low == high {
            return (low, true);
        }
    }
    let [low, high] = rounded(world, &known);
    ([0, 1, 2].map(|k| low[k].midpoint(high[k])), false)
}

/// Encloses a pixel: with more bits until its 8-bit values are proved.
pub fn enclose(world: &World<'_>, settings: &Settings, pixel: [u16; 2], levels: usize) -> Enclosed {
    let mut enclosed = Enclosed {
        linear: [[0.0, 1.0]; 3],
        primitive: NONE,
        high: [255; 3],
        done: 1,
        ..Enclosed::default()
    };
    for level in 0..levels.clamp(1, LEVELS.len()) {
        let evaluated = at_level(world, settings, pixel, level, None);
        enclosed.level = level as u8;
        narrow(&mut enclosed.linear, &evaluated);
        [enclosed.low, enclosed.high] = rounded(world, &enclosed.linear).map(code);
        if enclosed.low == enclosed.high {
            enclosed.reason = 0;
            enclosed.has_point = 0;
            enclosed.on_boundary = 0;
            return enclosed;
        }
        let is_last = level + 1 == LEVELS.len();
        enclosed.note(&evaluated, is_last);
    }
    enclosed
}

fn at_level(
    world: &World<'_>,
    settings: &Settings,
    pixel: [u16; 2],
    level: usize,
    steps: Option<&mut Vec<Step>>,
) -> Evaluated {
    if level == 0 {
        return evaluate::<Interval>(world, settings, pixel, level, steps);
    }
    deep::with_bits(LEVELS[level], || {
        evaluate::<Ball>(world, settings, pixel, level, steps)
    })
}

/// Returns the rays behind a pixel and the numbers along them, at the level at which the pixel was decided. Points and
/// distances are in scene units.
pub fn explain(
    world: &World<'_>,
    settings: &Settings,
    pixel: [u16; 2],
) -> (Enclosed, Vec<Step>, Vec<Open>) {
    let enclosed = enclose(world, settings, pixel, LEVELS.len());
    let mut steps = Vec::new();
    let level = usize::from(enclosed.level);
    let mut evaluated = at_level(world, settings, pixel, level, Some(&mut steps));
    let frame = Frame::of(world.scene);
    for step in &mut steps {
        to_scene_units(&frame, step);
    }
    for open in &mut evaluated.open {
        open.point = frame.place(open.point).to_array();
    }
    (enclosed, steps, evaluated.open)
}

/// Converts the points and distances of a step, which are in lattice units.
fn to_scene_units(frame: &Frame, step: &mut Step) {
    for (name, bounds) in &mut step.values {
        match *name {
            "distance" => {
                for [low, high] in bounds {
                    [*low, *high] = [*low, *high].map(|it| frame.length(it));
                }
            }
            "point" => {
                let places = [0, 1].map(|end| {
                    let end: Vec<f64> = bounds.iter().map(|it| it[end]).collect();
                    <[f64; 3]>::try_from(end).map(|it| frame.place(it).to_array())
                });
                if let [Ok(low), Ok(high)] = places {
                    // The sum with the origin is rounded.
                    let outward = |axis: usize| [low[axis].next_down(), high[axis].next_up()];
                    *bounds = [0, 1, 2].map(outward).to_vec();
                }
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::{Options, compile};

    #[test]
    fn pixels_lie_on_a_boundary_only_where_256_bits_know_the_ray() {
        let noted = |open: Option<(Reason, f64)>, is_last: bool| {
            let open = open.map(|(reason, radius)| Open {
                reason,
                depth: 0,
                primitive: 0,
                point: [0.0; 3],
                radius,
            });
            let evaluated = Evaluated {
                linear: None,
                open: open.into_iter().collect(),
            };
            let mut enclosed = Enclosed {
                high: [255; 3],
                ..Enclosed::default()
            };
            enclosed.note(&evaluated, is_last);
            (enclosed.reason(), enclosed.on_boundary, enclosed.has_point)
        };
        let hit = |radius: f64| Some((Reason::Hit, radius));
        assert_eq!(noted(hit(1e-60), true), (Some(Reason::Hit), 1, 1));
        assert_eq!(noted(hit(1e-60), false).1, 0);
        // Mirrors have made the ray so wide that it says nothing about a boundary.
        assert_eq!(noted(hit(1e-3), true).1, 0);
        assert_eq!(noted(Some((Reason::Branches, 0.0)), true).1, 0);
        assert_eq!(noted(None, true), (Some(Reason::Width), 0, 0));
    }

    #[test]
    fn explained_points_and_distances_are_in_scene_units() {
        let file = "[camera]\neye = [100, 0, 50]\ntarget = [100, 0, 0]\n[render]\nwidth = 1\nheight = 1\n\
            [[light]]\nkind = 'point'\nposition = [100, 50, 50]\n\
            [[light]]\nkind = 'point'\nposition = [100, 50, 60]\n\
            [[object]]\nkind = 'box'\nmin = [90, -10, -20]\nmax = [110, 10, 0]\n";
        let imported = crate::scene::read("box.toml".as_ref(), file.into(), &Default::default());
        let blob = compile(&imported.unwrap().scene, &Options::default());
        let blob = blob.unwrap().blob;
        let scene = blob.scene().unwrap();
        let world = World::of(&scene).unwrap_or_else(|unknown| panic!("{unknown}"));
        let (_, steps, _) = explain(&world, &Settings::of(&scene), [0, 0]);
        let hit = steps.iter().find(|step| step.event == "hit").unwrap();
        let near = |[low, high]: [f64; 2], to: f64| {
            assert!(
                low <= high && (low - to).abs().max((high - to).abs()) < 1e-3,
                "{low} {high}"
            );
        };
        assert_eq!((hit.values[0].0, hit.values[1].0), ("distance", "point"));
        near(hit.values[0].1[0], 50.0);
        for (bounds, to) in hit.values[1].1.iter().zip([100.0, 0.0, 0.0]) {
            near(*bounds, to);
        }
        let lights: Vec<_> = steps.iter().filter_map(|step| step.light).collect();
        assert_eq!(lights, [0, 1]);
    }
}
