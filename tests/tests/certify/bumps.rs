//! Normals for shading: those of vertices, interpolated, and those of an image.

use super::exact::Exact;
use super::numbers::{color, fraction, mixed};
use super::paint::coordinates;
use super::placed::Met;
use gridel_core::format::record::Material;
use gridel_host::shape::exact::{Real, Vector, along, cross, dot, minus, scaled, unit};

/// Returns a normal without its part behind a ray, for a surface that sends rays on: such surfaces do not show their
/// back.
fn turned_to_ray(normal: Vector, material: &Material, direction: &Vector) -> Vector {
    let behind = dot(&normal, direction);
    let sends = material.transmit != [0; 3] || material.mirror != [0; 3];
    if sends && !behind.is_negative() {
        return unit(&along(&normal, &-behind, direction));
    }
    normal
}

/// Returns the direction in which u grows over a triangle, and whether its image appears mirrored from the front.
/// `None` where there are no coordinates, or they lie on a line.
fn along_u(met: &Met<'_>) -> Option<(Vector, bool)> {
    let [a, b, c] = met.placed.coordinates?.map(|at| at.map(i128::from));
    let ([at_a, at_b, at_c], _) = met.corners()?;
    let [b, c] = [b, c].map(|to| [to[0] - a[0], to[1] - a[1]]);
    let area = b[0] * c[1] - b[1] * c[0];
    if area == 0 {
        return None;
    }
    let factor = |v: i128| fraction((v * area.signum()) as i64, 20);
    let grows = minus(
        &scaled(&minus(&at_b, &at_a), &factor(c[1])),
        &scaled(&minus(&at_c, &at_a), &factor(b[1])),
    );
    let grows = match &met.placed.map {
        Some(map) => map.normal(&grows),
        None => grows,
    };
    Some((grows, area > 0))
}

impl Exact<'_> {
    /// The normal for shading, on the side of the ray.
    pub fn shading_normal(&self, met: &Met<'_>, material: &Material, direction: &Vector) -> Vector {
        let mut normal = met.turned(&met.normal);
        if let Some(smooth) = met.smooth_normal().filter(|_| self.is_smooth) {
            normal = turned_to_ray(smooth, material, direction);
        }
        match self.bumped(met, material, &normal) {
            Some(bumped) => turned_to_ray(bumped, material, direction),
            None => normal,
        }
    }

    /// The normal of the material's map, on the side of the normal that it is given by; `None` without one.
    fn bumped(&self, met: &Met<'_>, material: &Material, normal: &Vector) -> Option<Vector> {
        let (texel, map) = self
            .scene
            .mapped_normal(material, coordinates(met)?, met.footprint)?;
        let (grows, is_mirrored) = along_u(met)?;
        // The back is as the front is, turned around.
        let front = met.turned(normal);
        let right = along(&grows, &-dot(&grows, &front), &front);
        if dot(&right, &right).is_zero() {
            return None;
        }
        let right = unit(&right);
        let up = cross(&front, &right);
        // 65535 is 1 exactly.
        let factor = |it: u16| fraction(u32::from(it) + u32::from(it >> 15), 16);
        let (across, outward) = (factor(map.across), factor(map.along));
        let [x, y, z] = color(texel, 30);
        let y: Real = if is_mirrored { -y } else { y };
        let bump = mixed(
            [&right, &up, &front],
            [&(x * &across), &(y * &across), &(z * &outward)],
        );
        let has_length = !dot(&bump, &bump).is_zero();
        has_length.then(|| met.turned(&unit(&bump)))
    }
}
