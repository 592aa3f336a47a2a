//! Where a line crosses a shape, in arithmetic as good as exact, by textbook formulas.
//!
//! A shape can be made larger or smaller by a length on all sides. That is how errors are judged:
//! an answer is off by no more than a length if some shape that differs by no more than that length
//! gives it. So a ray that barely touches is judged as fairly as one that strikes head on.

use super::exact::{Line, Real, Vector, along, cross, dot, minus, norm, scaled, unit, vector};
use super::torus::Torus;

/// A shape in units, all of its numbers on the lattice.
#[derive(Clone, Debug)]
pub enum Solid {
    Sphere {
        center: [f64; 3],
        radius: f64,
    },
    Box {
        lowest: [f64; 3],
        highest: [f64; 3],
    },
    Cone {
        base: [f64; 3],
        apex: [f64; 3],
        base_radius: f64,
        apex_radius: f64,
    },
    Disc {
        center: [f64; 3],
        normal: [f64; 3],
        radius: f64,
    },
    Torus {
        center: [f64; 3],
        axis: [f64; 3],
        major_radius: f64,
        minor_radius: f64,
    },
    Triangle([[f64; 3]; 3]),
}

/// A normal, and what an error of it is proportional to.
pub struct Normal {
    pub exact: Vector,
    /// How often coordinates are larger than the length that the direction is taken from.
    pub condition: f64,
    /// The length that the angle of a cone is taken from, half of its slanted side.
    pub size: f64,
}

impl Normal {
    fn flat(exact: Vector) -> Self {
        Self {
            exact,
            condition: 1.0,
            size: f64::INFINITY,
        }
    }
}

/// Where a line enters and leaves.
type Span = Option<(Real, Real)>;

fn zero() -> Real {
    Real::of(0.0)
}

/// Beyond everything.
fn far() -> Real {
    Real::of(1e300)
}

fn overlap(a: Span, b: Span) -> Span {
    let ((a, b), (c, d)) = (a?, b?);
    let (enter, leave) = (a.max(c), b.min(d));
    (enter <= leave).then_some((enter, leave))
}

/// Where `-half <= y + t rise <= half`.
fn slab(y: &Real, rise: &Real, half: &Real) -> Span {
    if rise.is_zero() {
        return (y.abs() <= *half).then(|| (-far(), far()));
    }
    let (a, b) = ((-half - y) / rise, (half - y) / rise);
    (!half.is_negative()).then(|| if a <= b { (a, b) } else { (b, a) })
}

/// Roots of `a t^2 + 2 b t + c` in order, `a` not zero.
fn roots(a: &Real, b: &Real, c: &Real) -> Span {
    // Where a is negative, the line is steeper than a cone's mantle and meets both of its nappes,
    // perhaps at the tip.
    let square = b * b - a * c;
    if square.is_negative() && a.is_positive() {
        return None;
    }
    let root = square.sqrt();
    let (first, second) = ((-b - &root) / a, (root - b) / a);
    Some(if first <= second {
        (first, second)
    } else {
        (second, first)
    })
}

impl Solid {
    /// Whether the shape encloses nothing.
    pub fn is_flat(&self) -> bool {
        matches!(self, Solid::Disc { .. } | Solid::Triangle(_))
    }

    /// The crossings with the shape, moved outward by a length (inward by a negative one), in order.
    pub fn spans(&self, line: &Line, grow: &Real) -> Vec<(Real, Real)> {
        let Some(torus) = self.torus() else {
            return self.span(line, grow).into_iter().collect();
        };
        let minor = &torus.minor + grow;
        if minor.is_positive() {
            torus.spans(line, &minor)
        } else {
            Vec::new()
        }
    }

    fn torus(&self) -> Option<Torus> {
        let Solid::Torus {
            center,
            axis,
            major_radius,
            minor_radius,
        } = *self
        else {
            return None;
        };
        Some(Torus::new(center, axis, [major_radius, minor_radius]))
    }

    /// The crossing with a convex shape.
    fn span(&self, line: &Line, grow: &Real) -> Span {
        match self {
            Solid::Sphere { center, radius } => {
                let radius = Real::of(*radius) + grow;
                let from = minus(&line.origin, &vector(*center));
                let c = dot(&from, &from) - &radius * &radius;
                let span = roots(&dot(&line.slope, &line.slope), &dot(&from, &line.slope), &c);
                span.filter(|_| !radius.is_negative())
            }
            Solid::Box { lowest, highest } => (0..3).try_fold((-far(), far()), |span, axis| {
                let (low, high) = (Real::of(lowest[axis]), Real::of(highest[axis]));
                let half = Real::of(0.5);
                let middle = (&low + &high) * &half;
                let reach = (high - low) * half + grow;
                let place = &line.origin[axis] - middle;
                overlap(Some(span), slab(&place, &line.slope[axis], &reach))
            }),
            Solid::Cone { .. } => self.cone_span(line, grow),
            Solid::Torus { .. } => None,
            Solid::Disc {
                center,
                normal,
                radius,
            } => {
                let normal = unit(&vector(*normal));
                let center = vector(*center);
                let Some((t, tilt)) = plane_crossing(line, &normal, &center) else {
                    return within_plane(line, &normal, &center, grow);
                };
                let apart = norm(&minus(&line.at(&t), &center));
                flat_span(t, Real::of(*radius) - apart, &tilt, line, grow)
            }
            Solid::Triangle(corners) => {
                let [a, b, c] = corners.map(vector);
                let normal = unit(&cross(&minus(&b, &a), &minus(&c, &a)));
                let Some((t, tilt)) = plane_crossing(line, &normal, &a) else {
                    return within_plane(line, &normal, &a, grow);
                };
                let point = line.at(&t);
                let inside = [(&a, &b), (&b, &c), (&c, &a)].map(|(from, to)| {
                    let edge = unit(&minus(to, from));
                    dot(&cross(&normal, &edge), &minus(&point, from))
                });
                let [u, v, w] = inside;
                flat_span(t, u.min(v).min(w), &tilt, line, grow)
            }
        }
    }

    fn cone_span(&self, line: &Line, grow: &Real) -> Span {
        let frame = self.frame()?;
        let from = minus(&line.origin, &frame.middle);
        let d = &line.slope;
        let (y, rise) = (dot(&from, &frame.axis), dot(d, &frame.axis));
        let caps = slab(&y, &rise, &(&frame.half_height + grow));
        // cos rho <= g - e t.
        let cos2 = &frame.cos * &frame.cos;
        let g = &frame.cos * &frame.radius + grow - &frame.sin * &y;
        let e = &frame.sin * &rise;
        let a = &cos2 * (dot(d, d) - &rise * &rise) - &e * &e;
        let b = &cos2 * (dot(&from, d) - &y * &rise) + &g * &e;
        let c = &cos2 * (dot(&from, &from) - &y * &y) - &g * &g;
        let mantle = if a.is_zero() {
            if b.is_zero() {
                (!c.is_positive() && !g.is_negative()).then(|| (-far(), far()))
            } else if b.is_positive() == e.is_positive() {
                let root = -c / (&b + &b);
                Some(if b.is_positive() {
                    (-far(), root)
                } else {
                    (root, far())
                })
            } else {
                None
            }
        } else if a.is_positive() {
            roots(&a, &b, &c).filter(|_| !(&g * &a + &e * &b).is_negative())
        } else {
            let (low, high) = roots(&a, &b, &c)?;
            Some(if e.is_positive() {
                (-far(), low)
            } else {
                (high, far())
            })
        };
        overlap(caps, mantle)
    }

    fn frame(&self) -> Option<Frame> {
        let Solid::Cone {
            base,
            apex,
            base_radius,
            apex_radius,
        } = self
        else {
            return None;
        };
        let half = Real::of(0.5);
        let (base, apex) = (vector(*base), vector(*apex));
        let up = minus(&apex, &base);
        let height = norm(&up);
        let narrowing = Real::of(base_radius - apex_radius);
        let slant = (&height * &height + &narrowing * &narrowing).sqrt();
        Some(Frame {
            axis: unit(&up),
            middle: scaled(&along(&base, &Real::of(1.0), &apex), &half),
            cos: &height / &slant,
            sin: narrowing / slant,
            half_height: height * &half,
            radius: Real::of(base_radius + apex_radius) * half,
        })
    }

    /// By how much the shape would have to grow for a point to be on each of its faces; the point
    /// is on the surface where the largest is 0. Of flat shapes, their plane alone.
    pub fn excesses(&self, point: [f64; 3]) -> Vec<f64> {
        let p = vector(point);
        let mut excesses: Vec<f64> = match self {
            Solid::Sphere { center, radius } => {
                vec![(norm(&minus(&p, &vector(*center))) - Real::of(*radius)).to_f64()]
            }
            Solid::Box { lowest, highest } => (0..3)
                .flat_map(|k| [lowest[k] - point[k], point[k] - highest[k]])
                .collect(),
            Solid::Disc { center, normal, .. } => {
                let apart = minus(&p, &vector(*center));
                vec![dot(&unit(&vector(*normal)), &apart).abs().to_f64()]
            }
            Solid::Triangle([a, ..]) => self.normals(point).first().map_or(Vec::new(), |normal| {
                vec![dot(&normal.exact, &minus(&p, &vector(*a))).abs().to_f64()]
            }),
            Solid::Cone { .. } => self.frame().map_or(Vec::new(), |frame| {
                let q = minus(&p, &frame.middle);
                let y = dot(&q, &frame.axis);
                let distance = norm(&along(&q, &-&y, &frame.axis));
                let mantle = &frame.cos * (distance - &frame.radius) + &frame.sin * &y;
                [mantle, &y - &frame.half_height, -y - &frame.half_height]
                    .map(|x| x.to_f64())
                    .to_vec()
            }),
            Solid::Torus { .. } => {
                let excess = |torus: Torus| (torus.distance(&p) - &torus.minor).to_f64();
                self.torus().map(excess).into_iter().collect()
            }
        };
        excesses.sort_by(|a, b| b.total_cmp(a));
        excesses
    }

    /// About how large the shape is.
    pub fn size(&self) -> f64 {
        let apart = |a: &[f64; 3], b: &[f64; 3]| norm(&minus(&vector(*a), &vector(*b))).to_f64();
        match self {
            Solid::Sphere { radius, .. } | Solid::Disc { radius, .. } => *radius,
            Solid::Box { lowest, highest } => apart(lowest, highest),
            Solid::Cone {
                base,
                apex,
                base_radius,
                apex_radius,
            } => apart(base, apex).max(*base_radius).max(*apex_radius),
            Solid::Torus {
                major_radius,
                minor_radius,
                ..
            } => major_radius + minor_radius,
            Solid::Triangle([a, b, c]) => apart(a, b).max(apart(b, c)),
        }
    }

    /// The outward (or front) normals at a point, one for each face that it may be on.
    pub fn normals(&self, point: [f64; 3]) -> Vec<Normal> {
        let p = vector(point);
        match self {
            Solid::Sphere { center, .. } => vec![Normal::flat(unit(&minus(&p, &vector(*center))))],
            Solid::Box { .. } => (0..6)
                .map(|face| {
                    let mut normal = [0.0; 3];
                    normal[face / 2] = if face % 2 == 0 { -1.0 } else { 1.0 };
                    Normal::flat(vector(normal))
                })
                .collect(),
            Solid::Disc { normal, .. } => vec![Normal::flat(unit(&vector(*normal)))],
            Solid::Triangle([a, b, c]) => {
                let [a, b, c] = [*a, *b, *c].map(vector);
                vec![Normal::flat(unit(&cross(&minus(&b, &a), &minus(&c, &a))))]
            }
            Solid::Torus { minor_radius, .. } => {
                let normal = |torus: Torus| Normal {
                    exact: torus.normal(&p),
                    condition: 1.0 + self.extent() / minor_radius.min(torus.distance_from_axis(&p)),
                    size: f64::INFINITY,
                };
                self.torus().map(normal).into_iter().collect()
            }
            Solid::Cone { .. } => {
                let Some(frame) = self.frame() else {
                    return Vec::new();
                };
                let q = minus(&p, &frame.middle);
                let axial = dot(&q, &frame.axis);
                let across = along(&q, &-&axial, &frame.axis);
                let distance = norm(&across).to_f64();
                let radial = scaled(&unit(&across), &frame.cos);
                let mantle = along(&radial, &frame.sin, &frame.axis);
                let condition = 1.0 + norm(&q).to_f64() / distance.max(1e-300);
                let size = (&frame.half_height / &frame.cos).to_f64();
                vec![
                    Normal {
                        exact: mantle,
                        condition,
                        size,
                    },
                    Normal::flat(frame.axis.clone()),
                    Normal::flat(frame.axis.map(|x| -x)),
                ]
            }
        }
    }

    /// The normals where a torus meets its axis, if that is as near to a point as it may be off by: the
    /// axis, either way.
    pub fn pit_normals(&self, point: [f64; 3], off: f64) -> Option<Vec<Normal>> {
        let torus = self.torus()?;
        let axis = torus.axis_within(&vector(point), off)?;
        Some(vec![
            Normal::flat(axis.clone()),
            Normal::flat(axis.map(|x| -x)),
        ])
    }

    /// The mantle's normal on the side of a direction, where a point is as near to the axis as it may be
    /// off by: there the side is not to be told, and at a tip every one of the mantle's normals supports
    /// the solid.
    pub fn normal_towards(&self, direction: [f64; 3], point: [f64; 3], off: f64) -> Option<Normal> {
        let frame = self.frame()?;
        let across = |v: &Vector| along(v, &-dot(v, &frame.axis), &frame.axis);
        if norm(&across(&minus(&vector(point), &frame.middle))).to_f64() > off {
            return None;
        }
        let radial = scaled(&unit(&across(&vector(direction))), &frame.cos);
        Some(Normal {
            exact: along(&radial, &frame.sin, &frame.axis),
            condition: 1.0,
            size: (&frame.half_height / &frame.cos).to_f64(),
        })
    }

    /// The largest magnitude of a coordinate of the shape.
    pub fn extent(&self) -> f64 {
        let largest = |v: &[f64; 3]| v.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        match self {
            Solid::Sphere { center, radius } | Solid::Disc { center, radius, .. } => {
                largest(center) + radius
            }
            Solid::Box { lowest, highest } => largest(lowest).max(largest(highest)),
            Solid::Cone {
                base,
                apex,
                base_radius,
                apex_radius,
            } => largest(base).max(largest(apex)) + base_radius.max(*apex_radius),
            Solid::Torus {
                center,
                major_radius,
                minor_radius,
                ..
            } => largest(center) + major_radius + minor_radius,
            Solid::Triangle(corners) => corners.iter().map(largest).fold(0.0, f64::max),
        }
    }
}

/// A solid of revolution: its middle, axis and half angle.
struct Frame {
    axis: Vector,
    middle: Vector,
    half_height: Real,
    radius: Real,
    cos: Real,
    sin: Real,
}

/// Where a line crosses a plane, and the cosine between them times the slope's length.
fn plane_crossing(line: &Line, normal: &Vector, point: &Vector) -> Option<(Real, Real)> {
    let tilt = dot(normal, &line.slope);
    if tilt.is_zero() {
        return None;
    }
    Some((dot(normal, &minus(point, &line.origin)) / &tilt, tilt.abs()))
}

/// The span of a flat shape on a line along its plane: none, or with a thickness perhaps anywhere.
fn within_plane(line: &Line, normal: &Vector, point: &Vector, grow: &Real) -> Span {
    let apart = dot(normal, &minus(point, &line.origin)).abs();
    (grow.is_positive() && apart <= *grow).then(|| (-far(), far()))
}

/// The span of a flat shape with a thickness. `inside` is how far inside its rim it is crossed; the
/// rim's place is as uncertain as the plane's, times the tangent of the angle of incidence.
fn flat_span(t: Real, inside: Real, tilt: &Real, line: &Line, grow: &Real) -> Span {
    let across = norm(&line.slope) / tilt;
    let rim = grow * (Real::of(1.0) + across);
    if (inside + rim).is_negative() {
        return None;
    }
    let thickness = grow.clone().max(zero()) / tilt;
    Some((&t - &thickness, t + thickness))
}
