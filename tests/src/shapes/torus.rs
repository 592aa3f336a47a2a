use super::sample::{
    Named, Room, Sample, around, cylindrical, lattice_point, length, rim, rounded_direction,
};
use crate::random::Random;
use glam::{DVec2, DVec3};
use gridel_host::shape::Torus;
use gridel_host::shape::exact::{Real, unit, vector};
use std::f64::consts::TAU;

impl Sample for Torus {
    const NAMES: &[Named] = &[Named {
        name: "torus",
        crossing: (8.0, "Newton's steps from ends of pieces of one curvature"),
        normal: (
            8.0,
            "times coordinate over the minor radius, or over the distance from the axis",
        ),
    }];

    fn example() -> Self {
        Self {
            center: DVec3::new(0.0, 0.0, 1.0),
            axis: DVec3::new(0.3, -1.0, 0.4),
            major_radius: 0.6,
            minor_radius: 0.25,
        }
    }

    /// Rings, thin ones, horns and spindles.
    fn random(random: &mut Random, _: &str, room: Room) -> Self {
        let axis = rounded_direction(random);
        let major_radius = length(room.size * (0.1 + 0.5 * random.unit()));
        let share = [0.5 / room.stretch, 0.9, 1.0, 1.5][random.below(4)];
        Self {
            center: lattice_point(room.center),
            axis,
            major_radius,
            minor_radius: length(major_radius * share),
        }
    }

    fn place(&self, random: &mut Random) -> DVec3 {
        let axis = self.axis.normalize();
        let outward = around(random, axis, 1.0);
        let angle = TAU * [0.0, 0.25, 0.5, random.unit(), random.unit()][random.below(5)];
        let part = [1.0, 1.0, 0.9999, 1.0001, random.unit()][random.below(5)];
        let tube = (outward * angle.cos() + axis * angle.sin()) * self.minor_radius * part;
        match random.below(8) {
            0 => self.center,
            _ => self.center + outward * self.major_radius + tube,
        }
    }

    fn own_direction(&self, random: &mut Random) -> DVec3 {
        match random.below(2) {
            0 => self.axis,
            _ => self.axis.cross(DVec3::from_array(random.direction())),
        }
    }

    fn surface_point(&self, random: &mut Random) -> DVec3 {
        let axis = self.axis.normalize();
        let outward = around(random, axis, 1.0);
        loop {
            let angle = TAU * random.unit();
            let across = self.major_radius + self.minor_radius * angle.cos();
            // The inner sheet of a spindle torus is no surface.
            if across >= 0.0 {
                let along = axis * self.minor_radius * angle.sin();
                break self.center + outward * across + along;
            }
        }
    }

    fn distance(&self, point: DVec3) -> f64 {
        let (major, minor) = (self.major_radius, self.minor_radius);
        let (along, across) = cylindrical(point - self.center, self.axis);
        let from_circle = (across - major).hypot(along);
        if from_circle >= minor || minor <= major {
            return (from_circle - minor).abs();
        }
        // Beneath the surface of a spindle torus: outward, or if that leads to the axis, to the pit.
        let part = minor / from_circle.max(f64::MIN_POSITIVE);
        let above = DVec2::new(major + (across - major) * part, along.abs() * part);
        let pit = DVec2::new(0.0, (minor * minor - major * major).sqrt());
        let nearest = if above.x < 0.0 { pit } else { above };
        nearest.distance(DVec2::new(across, along.abs()))
    }

    fn reach(&self, axis: usize, sign: f64) -> Real {
        let way = unit(&vector(self.axis));
        let circle = rim(self.center[axis], sign, &way[axis], self.major_radius);
        circle + Real::of(self.minor_radius)
    }
}
