//! The diffuse color of surfaces, and how much of them is there.

use super::exact::Exact;
use super::numbers::{color, floor, fraction, one, product, real};
use super::placed::Met;
use gridel_core::format::record::Material;
use gridel_host::shape::exact::{Real, Vector};

/// The ratio 1.
const ONE: i64 = 1 << 30;

/// Returns the mean of the corners' values, by their weights in a triangle.
fn interpolated(met: &Met<'_>, corners: [i64; 3]) -> Option<Real> {
    let (_, parts) = met.corners()?;
    let mut sum = real(0.0);
    for (part, corner) in parts.iter().zip(corners) {
        sum = sum + part * fraction(corner, 0);
    }
    Some(sum)
}

/// The color of the vertices, if there is one: the mean of squares of roots of 8 bits.
fn vertex_color(met: &Met<'_>) -> Option<Vector> {
    let corners = met.placed.colors?;
    let channel = |channel: usize| {
        let squares = corners.map(|corner| i64::from(corner[channel]).pow(2));
        Some(interpolated(met, squares)? / real(255.0 * 255.0))
    };
    Some([channel(0)?, channel(1)?, channel(2)?])
}

/// The texture coordinates, if there are some, rounded down to 20 fraction bits.
pub fn coordinates(met: &Met<'_>) -> Option<[i32; 2]> {
    let corners = met.placed.coordinates?;
    let along = |axis: usize| {
        let along = interpolated(met, corners.map(|corner| corner[axis].into()))?;
        Some(floor(&along) as i32)
    };
    Some([along(0)?, along(1)?])
}

fn checker(met: &Met<'_>, material: &Material) -> Vector {
    if material.checker_size <= 0 {
        return color(material.diffuse, 30);
    }
    let size = fraction(material.checker_size, 13);
    let mut odd = false;
    for k in 0..3 {
        // Beneath the surface, by far more than 320 bits round and far less than anything else.
        let inside = &met.point[k] - &met.normal[k] * real(f64::powi(2.0, -120));
        let place = (inside - fraction(material.checker_origin[k], 13)) / &size;
        odd ^= floor(&place).rem_euclid(2) == 1;
    }
    color(if odd { material.odd } else { material.diffuse }, 30)
}

impl Exact<'_> {
    pub fn diffuse(&self, met: &Met<'_>, material: &Material) -> Vector {
        let mut diffuse = checker(met, material);
        if let Some(color) = vertex_color(met) {
            diffuse = product(&diffuse, &color);
        }
        let texel =
            coordinates(met).and_then(|at| self.scene.texture_color(material, at, met.footprint));
        if let Some(texel) = texel {
            diffuse = product(&diffuse, &color(texel, 30));
        }
        diffuse
    }

    /// Returns the part of a surface that is there.
    pub fn alpha(&self, met: &Met<'_>, material: &Material) -> Real {
        // Glass lets light through by itself.
        if material.transmit != [0; 3] {
            return one();
        }
        let found = coordinates(met).and_then(|at| {
            let alpha = self.scene.texture_alpha(material, at, met.footprint)?;
            Some((alpha, self.scene.surface_maps(material)?))
        });
        let Some((alpha, maps)) = found else {
            return one();
        };
        let ratio = |of_255: u8| i64::from(of_255) * ONE / 255;
        if maps.cutoff == 0 {
            return fraction(alpha, 30) * fraction(ratio(maps.opacity), 30);
        }
        let is_there = i64::from(alpha) >= ratio(maps.cutoff);
        real(f64::from(u8::from(is_there)))
    }
}
