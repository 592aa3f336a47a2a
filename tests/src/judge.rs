//! Judges one answer about one shape by arithmetic of 320 bits.

use crate::bounds::{normal_step, ratio_step, ulp_of_one};
use crate::exact::Line;
use crate::exact::{Real, dot, norm, vector};
use crate::query::{UnitRay, closest, point_of};
use crate::scenes;
use glam::DVec3;
use gridel_core::{Hit, List, NoCount, Number, Scene};
use gridel_host::blob::Blob;
use gridel_host::scene::Shape;
use gridel_host::shape::rounding::step;
use gridel_host::shape::{Normal, Solid, Sphere};
use gridel_host::verify::judge::Crossings;

/// Returns a blob of shapes whose lattice is known: one unit is one scene unit, and its zero is the
/// scene's. Two specks at the ends of the lattice ensure that; they come last.
pub fn blob_of<'s>(solids: impl IntoIterator<Item = &'s Solid>) -> Blob {
    let speck = |corner: f64| {
        Shape::Sphere(Sphere {
            center: DVec3::splat(corner),
            radius: 1.0 / 256.0,
        })
    };
    let specks = [speck(-32_764.0), speck(32_764.0)];
    let shapes = solids.into_iter().cloned().map(Shape::from).chain(specks);
    let blob = scenes::blob(&scenes::of(shapes), 24);
    let scene = blob.scene().expect("a scene");
    let header = scene.header();
    assert_eq!((header.unit_exponent, header.origin), (0, [0.0; 3]));
    blob
}

/// Errors that are tried, in steps; the last means any error.
const LADDER: [f64; 15] = [
    0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 32.0, 64.0, 1024.0, 1e9,
];

/// Returns whether an answer is right for a shape that differs by no more than `error`.
fn is_right(solid: &Solid, line: &Line, answer: Option<f64>, error: f64) -> bool {
    let (crossings, begin) = (Crossings::new(solid, line, error), Real::of(0.0));
    match answer {
        Some(t) => crossings.may_be_met_at(&Real::of(t), &begin),
        None => crossings.are_met_by(&begin).is_none(),
    }
}

/// The errors of an answer, in the units of the table of bounds.
pub struct Verdict<N: Number> {
    pub hit: Option<Hit<N>>,
    /// The least error on a ladder that explains the position of the hit, or a miss.
    pub crossing: f64,
    /// The error, if a hit is missing, or reported where there is none.
    pub flag: f64,
    /// Error of the normal.
    pub normal: f64,
    /// Difference of the normal's length from 1, in units of last place.
    pub length: f64,
    /// Distance of the surface from the hit's point, as a part of the bound that comes with it.
    pub point: f64,
    /// True if a ray that enters the solid was reported to leave it, or the other way.
    pub wrong_side: bool,
}

/// Asks the list about one ray and judges the answer. `None` if the ray hits a speck.
///
/// Origins lie on the lattice and slopes have at most 23 fraction bits, so that every number format
/// gets the same ray.
pub fn verdict<N: Number>(
    solid: &Solid,
    scene: &Scene<'_>,
    (origin, slope): ([f64; 3], [f64; 3]),
) -> Option<Verdict<N>> {
    let ray = UnitRay::new(origin, slope);
    let Some(ready) = ray.ready::<N>(scene) else {
        panic!("{ray:?} is rejected");
    };
    assert_eq!(
        ready.slope().map(N::ratio_to_f64),
        slope.map(|x| x + 0.0),
        "{ray:?}"
    );
    let hit = closest::<N, List>(scene, &ready, &mut NoCount);
    if hit.is_some_and(|hit| hit.primitive != 0) {
        return None;
    }
    let line = Line::new(origin, slope);
    let t = hit.map(|hit| N::far_to_f64(hit.t));
    assert!(t.is_none_or(|t| t >= 0.0), "behind: {ray:?}");
    let place = origin.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let step = step(N::FORMAT, place.max(solid.extent()).max(t.unwrap_or(0.0)));
    let explains = |&&error: &&f64| is_right(solid, &line, t, error * step);
    let crossing = *LADDER.iter().find(explains).unwrap_or(&f64::INFINITY);
    let spans = solid.spans(&line, &Real::of(0.0));
    let exists = spans.iter().any(|span| !span.1.is_negative());
    let mut verdict = Verdict {
        hit,
        crossing,
        flag: if exists == t.is_some() { 0.0 } else { crossing },
        normal: 0.0,
        length: 0.0,
        point: 0.0,
        wrong_side: false,
    };
    let Some(hit) = hit else {
        return Some(verdict);
    };
    let point = point_of(&hit);
    assert!(point.iter().all(|x| x.is_finite()), "{ray:?}");
    let normal = hit.normal.map(N::ratio_to_f64);
    let apart = |face: &Normal| {
        let apart = |k: usize| (&face.exact[k] - Real::of(normal[k])).to_f64().abs();
        apart(0).max(apart(1)).max(apart(2)) / normal_step::<N>(face)
    };
    let within = solid.normals_within(point, hit.error.length_to_f64());
    let faces = within.unwrap_or_else(|| solid.normals(point));
    let off = faces.into_iter().map(|face| {
        let off = apart(&face);
        // Where the point's rounding turned the normal to the wrong side of the ray, the hit's is
        // level with the ray.
        let against = dot(&face.exact, &line.slope).is_negative();
        if solid.is_flat() || against == hit.front {
            return off;
        }
        let level = dot(&vector(normal), &line.slope) / norm(&line.slope);
        off.min(level.to_f64().abs() / ratio_step::<N>())
    });
    let towards = solid.normal_towards(normal, point, hit.error.length_to_f64());
    let towards = towards
        .filter(|face| dot(&face.exact, &line.slope).is_negative() == hit.front)
        .map_or(f64::INFINITY, |face| apart(&face));
    verdict.normal = off.fold(towards, f64::min);
    let length: f64 = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
    verdict.length = (length - 1.0).abs() / ulp_of_one::<N>();
    verdict.point = solid.excess(point).abs() / hit.error.length_to_f64();
    // Entering or leaving is distinguished where a solid smaller by the bound is met, too.
    let t = Real::of(N::far_to_f64(hit.t));
    let smaller = solid.spans(&line, &Real::of(-8.0 * step));
    // The next one, and of a ray that starts inside that it is in.
    let ahead = smaller.into_iter().find(|(_, leave)| !leave.is_negative());
    if let (false, Some((enter, leave))) = (solid.is_flat(), ahead) {
        verdict.wrong_side = if hit.front {
            t > enter
        } else if !solid.is_convex() {
            // A ray that starts next to the surface may leave it and come to another part.
            let around = solid.spans(&line, &Real::of(8.0 * step));
            let around = around.iter().find(|it| it.0 <= t && t <= it.1);
            enter <= t && t < leave || around.is_none_or(|it| it.0.is_positive())
        } else {
            t < leave
        };
    }
    Some(verdict)
}

/// The worst of many verdicts, with the rays that caused them.
#[derive(Default)]
pub struct Worst {
    pub rays: usize,
    pub hits: usize,
    pub crossing: (f64, String),
    pub flag: (f64, String),
    pub normal: (f64, String),
    pub length: (f64, String),
    pub point: (f64, String),
    pub wrong_sides: (f64, String),
}

impl Worst {
    /// Takes a verdict into account; `about` describes its case.
    pub fn take<N: Number>(&mut self, verdict: &Verdict<N>, about: impl Fn() -> String) {
        self.rays += 1;
        self.hits += usize::from(verdict.hit.is_some());
        let worse = |worst: &mut (f64, String), value: f64| {
            if value.is_nan() || value > worst.0 {
                *worst = (value, format!("{} gives {:?}", about(), verdict.hit));
            }
        };
        worse(&mut self.crossing, verdict.crossing);
        worse(&mut self.flag, verdict.flag);
        worse(&mut self.normal, verdict.normal);
        worse(&mut self.length, verdict.length);
        worse(&mut self.point, verdict.point);
        let sides = self.wrong_sides.0 + f64::from(u8::from(verdict.wrong_side));
        worse(&mut self.wrong_sides, sides);
    }
}

/// Shapes of every kind with a box whose numbers lie on the lattice, around the scene's zero.
pub fn lattice_soup(seed: u64, count: usize) -> gridel_host::scene::Scene {
    let solids = (0..count).map(|number| {
        let bounded = &*crate::cases::BOUNDED;
        let shape = bounded[number % bounded.len()];
        let case = crate::cases::cases(seed * 1000 + number as u64, shape, 1, 0);
        Shape::from(case[0].solid.clone())
    });
    // Specks hold the lattice's place and step, as in `blob_of`.
    let speck = |corner: f64| {
        Shape::Sphere(Sphere {
            center: DVec3::splat(corner),
            radius: 1.0 / 256.0,
        })
    };
    scenes::of(solids.chain([speck(-32_764.0), speck(32_764.0)]))
}
