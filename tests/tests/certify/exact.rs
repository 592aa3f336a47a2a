//! Pixels in 320 bits, by code that shares nothing with what it tests: no kernel, no shape's test and no rule of an
//! effect. Rays meet the shapes of `verify`, one after the other.

use super::numbers::{black, color, decay, fraction, one, peak, product, real, sum};
use super::placed::{Map, Met, Placed};
use gridel_core::format::record::{Light, Material};
use gridel_core::{Effects, Scene, Settings};
use gridel_host::shape::Solid;
use gridel_host::shape::exact::{
    Line, Real, Vector, along, cross, dot, minus, norm, scaled, unit, vector,
};

/// A scene.
pub struct Exact<'s> {
    scene: &'s Scene<'s>,
    solids: Vec<Placed>,
    settings: Settings,
    is_smooth: bool,
}

/// t of crossings of the surface that a ray starts on are 0, and those of what touches a light 1, but for the roundings
/// of 320 bits.
fn nothing() -> Real {
    real(f64::powi(2.0, -150))
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
    pub fn pixel(&self, [x, y]: [u16; 2]) -> Vector {
        let view = self.scene.view();
        let [width, height] = [self.settings.width, self.settings.height].map(f64::from);
        // From the middle of the picture, in half heights.
        let right = 2.0 * f64::from(x) + 1.0 - width;
        let up = height - 2.0 * f64::from(y) - 1.0;
        let direction = [0, 1, 2].map(|k| {
            real(f64::from(view.forward[k]))
                + real(f64::from(view.right[k])) * real(right) / real(height)
                + real(f64::from(view.up[k])) * real(up) / real(height)
        });
        let line = Line {
            origin: view.eye.map(|x| fraction(x, 13)),
            slope: direction,
        };
        let seen = self.radiance(&line, &[one(), one(), one()], 0);
        seen.map(|x| x.max(real(0.0)).min(one()))
    }

    fn material(&self, met: &Met<'_>) -> &Material {
        self.scene.material(met.object).expect("a material")
    }

    /// The crossings of a line between two t, in any order.
    fn crossings(&self, line: &Line, end: Option<&Real>) -> Vec<(Real, &Placed, bool)> {
        let mut all = Vec::new();
        for placed in &self.solids {
            let line = placed.line(line);
            let origin = line.origin.each_ref().map(Real::to_f64);
            let slope = line.slope.each_ref().map(Real::to_f64);
            if placed
                .bounds
                .is_some_and(|it| !may_meet(origin, slope, &it))
            {
                continue;
            }
            for (enter, leave) in placed.solid.spans(&line, &real(0.0)) {
                let mut keep = |t: Real, leaves: bool| {
                    if t > nothing() && end.is_none_or(|end| &t + nothing() < *end) {
                        all.push((t, placed, leaves));
                    }
                };
                if placed.solid.is_flat() {
                    keep(enter, false);
                } else {
                    keep(enter, false);
                    keep(leave, true);
                }
            }
        }
        all
    }

    fn nearest(&self, line: &Line, end: Option<&Real>) -> Option<Met<'_>> {
        let mut best: Option<(Real, &Placed, bool)> = None;
        for next in self.crossings(line, end) {
            let is_better = match &best {
                None => true,
                Some(best) => {
                    let apart = &next.0 - &best.0;
                    apart < -nothing() || apart < nothing() && next.1.primitive < best.1.primitive
                }
            };
            if is_better {
                best = Some(next);
            }
        }
        let (t, placed, leaves) = best?;
        let point = line.at(&t);
        let line_there = placed.line(line);
        let mut normal = self.normal(placed, (&line_there.at(&t), &line_there.slope), leaves)?;
        if let Some(map) = &placed.map {
            normal = map.normal(&normal);
        }
        let front = if placed.solid.is_flat() {
            dot(&normal, &line.slope).is_negative()
        } else {
            !leaves
        };
        Some(Met {
            placed,
            t,
            point,
            normal,
            front,
            object: placed.object,
        })
    }

    /// The gradient of how far the surface lies inside of the point, by its definition.
    fn normal(
        &self,
        placed: &Placed,
        (point, slope): (&Vector, &Vector),
        leaves: bool,
    ) -> Option<Vector> {
        Some(match &placed.solid {
            Solid::Triangle([a, b, c]) => {
                let [a, b, c] = [a, b, c].map(|corner| vector(corner.to_array()));
                unit(&cross(&minus(&b, &a), &minus(&c, &a)))
            }
            Solid::Sphere(sphere) => unit(&minus(point, &vector(sphere.center.to_array()))),
            Solid::Disc(disc) => unit(&vector(disc.normal.to_array())),
            Solid::Plane(plane) => unit(&vector(plane.normal.to_array())),
            Solid::Box(cuboid) => {
                // The face that the point lies on, of those that the line crosses in that direction; at an edge the
                // first.
                let (low, high) = (vector(cuboid.min.to_array()), vector(cuboid.max.to_array()));
                let mut best: Option<(Real, usize, f64)> = None;
                for k in 0..3 {
                    let towards = match (slope[k].is_positive(), slope[k].is_negative()) {
                        (true, _) => 1.0,
                        (_, true) => -1.0,
                        _ => continue,
                    };
                    let sign = if leaves { towards } else { -towards };
                    let side = if sign > 0.0 { &high } else { &low };
                    let off = (&point[k] - &side[k]).abs();
                    if best.as_ref().is_none_or(|best| &off + nothing() < best.0) {
                        best = Some((off, k, sign));
                    }
                }
                let (_, axis, sign) = best?;
                [0, 1, 2].map(|k| real(if k == axis { sign } else { 0.0 }))
            }
            Solid::Cone(cone) => {
                let (base, apex) = (vector(cone.base.to_array()), vector(cone.apex.to_array()));
                let way = minus(&apex, &base);
                let (height, axis) = (norm(&way), unit(&way));
                let q = minus(point, &base);
                let y = dot(&q, &axis);
                // A cap counts at its rim if the line crosses it in that direction.
                let crosses = |cap: &Vector| {
                    let towards = dot(cap, slope);
                    if leaves {
                        towards.is_positive()
                    } else {
                        towards.is_negative()
                    }
                };
                let below = axis.each_ref().map(|x| -x);
                if y.abs() < nothing() && crosses(&below) {
                    return Some(below);
                }
                if (&y - &height).abs() < nothing() && crosses(&axis) {
                    return Some(axis);
                }
                let out = unit(&along(&q, &-&y, &axis));
                let narrows = real(cone.base_radius) - real(cone.apex_radius);
                unit(&sum(&scaled(&out, &height), &scaled(&axis, &narrows)))
            }
            Solid::Torus(torus) => {
                let axis = unit(&vector(torus.axis.to_array()));
                let q = minus(point, &vector(torus.center.to_array()));
                let y = dot(&q, &axis);
                let outward = unit(&along(&q, &-&y, &axis));
                unit(&along(&q, &real(-torus.major_radius), &outward))
            }
        })
    }

    fn radiance(&self, line: &Line, weight: &Vector, depth: u8) -> Vector {
        let view = self.scene.view();
        let Some(met) = self.nearest(line, None) else {
            return product(&color(view.background, 20), weight);
        };
        let material = self.material(&met);
        let is_glass = material.transmit != [0; 3];
        let mut weight = weight.clone();
        if is_glass && !met.front {
            let length = &met.t * norm(&line.slope);
            weight = product(&weight, &self.absorbed(material, &length));
        }
        let direction = unit(&line.slope);
        let mut normal = met.turned(&met.normal);
        if self.is_smooth
            && let Some(smooth) = met.smooth_normal()
        {
            normal = smooth;
            let behind = dot(&normal, &direction);
            // What reflects or refracts does not show its back.
            if (is_glass || material.mirror != [0; 3]) && !behind.is_negative() {
                normal = unit(&along(&normal, &-behind, &direction));
            }
        }
        let diffuse = self.diffuse(&met, material);
        let mut local = product(&color(view.ambient, 20), &diffuse);
        for light in self.scene.lights() {
            let lit = self.lit(light, &met, &normal, &direction, &diffuse);
            local = sum(&local, &lit);
        }
        let mut result = product(&local, &weight);
        if depth >= self.settings.depth {
            return result;
        }
        let mut mirrored = color(material.mirror, 30);
        let cos = -dot(&direction, &normal);
        if is_glass {
            let transmit = color(material.transmit, 30);
            let index = fraction(material.inverse_ior, 30);
            // From the side of the ray to the other one.
            let ratio = if met.front { index } else { one() / index };
            let sine = &ratio * &ratio * (one() - &cos * &cos);
            let (mut reflected, mut passing) = (one(), None);
            if sine < one() {
                let cos_out = (one() - &sine).sqrt();
                // Perpendicular and parallel polarization, with indices 1 and 1 / ratio.
                let perpendicular = (&ratio * &cos - &cos_out) / (&ratio * &cos + &cos_out);
                let parallel = (&cos - &ratio * &cos_out) / (&cos + &ratio * &cos_out);
                reflected = (&perpendicular * &perpendicular + &parallel * &parallel) * real(0.5);
                let lift = &ratio * &cos - &cos_out;
                let refracted = along(&scaled(&direction, &ratio), &lift, &normal);
                // Lengths count where a triangle with normals lifts a direction: those of the rules.
                let length = if met.front { one() } else { one() / &ratio };
                passing = Some(scaled(&refracted, &length));
            }
            if material.inverse_ior == 1 << 30 {
                (reflected, passing) = (real(0.0), Some(direction.clone()));
            }
            let more = scaled(&transmit, &reflected);
            mirrored = sum(&mirrored, &more).map(|x| x.min(one()));
            if let Some(slope) = passing {
                let part = scaled(&transmit, &(one() - &reflected));
                let part = product(&weight, &part);
                result = sum(&result, &self.sent(&met, (slope, !met.front), part, depth));
            }
        }
        let slope = along(&scaled(&direction, &real(0.5)), &cos, &normal);
        sum(
            &result,
            &self.sent(&met, (slope, met.front), product(&weight, &mirrored), depth),
        )
    }

    fn sent(
        &self,
        met: &Met<'_>,
        (slope, outward): (Vector, bool),
        weight: Vector,
        depth: u8,
    ) -> Vector {
        let most = peak(&weight);
        if !most.is_positive() || most <= fraction(self.scene.view().cutoff, 20) {
            return black();
        }
        let mut slope = slope;
        if self.is_smooth {
            let normal = scaled(&met.normal, &real(if outward { 1.0 } else { -1.0 }));
            let rise = dot(&slope, &normal);
            if !rise.is_positive() {
                slope = along(&slope, &(real(1.0 / 4096.0) - rise), &normal);
            }
        }
        let line = Line {
            origin: met.point.clone(),
            slope,
        };
        self.radiance(&line, &weight, depth + 1)
    }

    fn absorbed(&self, material: &Material, length: &Real) -> Vector {
        material
            .absorption
            .map(|coefficient| decay(&(length * fraction(coefficient, 32))))
    }

    fn diffuse(&self, met: &Met<'_>, material: &Material) -> Vector {
        if material.checker_size <= 0 {
            return color(material.diffuse, 30);
        }
        let size = fraction(material.checker_size, 13);
        let mut odd = false;
        for k in 0..3 {
            // Beneath the surface, by far more than 320 bits round and far less than anything else.
            let inside = &met.point[k] - &met.normal[k] * real(f64::powi(2.0, -120));
            let place = (inside - fraction(material.checker_origin[k], 13)) / &size;
            let near = place.to_f64().floor();
            let below = if place < real(near) {
                near - 1.0
            } else if place >= real(near + 1.0) {
                near + 1.0
            } else {
                near
            };
            odd ^= below.rem_euclid(2.0) == 1.0;
        }
        color(if odd { material.odd } else { material.diffuse }, 30)
    }

    fn lit(
        &self,
        light: &Light,
        met: &Met<'_>,
        normal: &Vector,
        direction: &Vector,
        diffuse: &Vector,
    ) -> Vector {
        let is_far = light.directional == 1;
        let way = if is_far {
            light.vector.map(|x| fraction(x, 30))
        } else {
            minus(&light.vector.map(|x| fraction(x, 13)), &met.point)
        };
        let to_light = unit(&way);
        let cos = dot(normal, &to_light);
        if !cos.is_positive() {
            return black();
        }
        let material = self.material(met);
        let mut reflected = scaled(diffuse, &cos);
        if material.highlight != [0; 3] {
            let halfway = unit(&minus(&to_light, direction));
            let cos = dot(normal, &halfway).max(real(0.0)).min(one());
            let mut power = one();
            for bit in (0..16).rev() {
                power = &power * &power;
                if material.shininess >> bit & 1 == 1 {
                    power = power * &cos;
                }
            }
            let highlight = scaled(&color(material.highlight, 30), &power);
            reflected = sum(&reflected, &highlight).map(|x| x.min(one()));
        }
        let mut line = Line {
            origin: met.point.clone(),
            slope: way,
        };
        let has_shadows = self.scene.effects().contains(Effects::SHADOW);
        if !has_shadows {
            return product(&color(light.color, 20), &reflected);
        }
        if self.is_smooth && !dot(&met.turned(&met.normal), &to_light).is_positive() {
            let Some(step) = met.lift() else {
                return black();
            };
            line.origin = sum(&line.origin, &step);
            if !is_far {
                line.slope = minus(&light.vector.map(|x| fraction(x, 13)), &line.origin);
            }
        }
        let mut rest = (!is_far).then(one);
        let mut left = [one(), one(), one()];
        while let Some(blocker) = self.nearest(&line, rest.as_ref()) {
            let material = self.material(&blocker);
            if material.transmit == [0; 3] {
                return black();
            }
            let k = fraction(material.inverse_ior, 30);
            let mut passed = one();
            if material.inverse_ior != 1 << 30 {
                let cos = dot(&blocker.normal, &to_light).abs();
                let out = (one() - &k * &k * (one() - &cos * &cos)).sqrt();
                let a = (&k * &cos - &out) / (&k * &cos + &out);
                let b = (&cos - &k * &out) / (&cos + &k * &out);
                passed = one() - (&a * &a + &b * &b) * real(0.5);
            }
            left = product(&left, &scaled(&color(material.transmit, 30), &passed));
            if !blocker.front {
                let length = &blocker.t * norm(&line.slope);
                left = product(&left, &self.absorbed(material, &length));
            }
            if peak(&left) <= fraction(self.scene.view().cutoff, 20) {
                return black();
            }
            rest = rest.map(|rest| rest - &blocker.t);
            line.origin = blocker.point;
        }
        product(&product(&color(light.color, 20), &left), &reflected)
    }
}

/// Whether a line can meet a box in units, or one that is larger by a unit.
fn may_meet(origin: [f64; 3], slope: [f64; 3], bounds: &[[f64; 2]; 3]) -> bool {
    let (mut first, mut last) = (f64::NEG_INFINITY, f64::INFINITY);
    for k in 0..3 {
        let [low, high] = bounds[k];
        let (low, high) = (low - 1.0 - origin[k], high + 1.0 - origin[k]);
        if slope[k] == 0.0 {
            if low > 0.0 || high < 0.0 {
                return false;
            }
            continue;
        }
        let (a, b) = (low / slope[k], high / slope[k]);
        (first, last) = (first.max(a.min(b)), last.min(a.max(b)));
    }
    first <= last
}
