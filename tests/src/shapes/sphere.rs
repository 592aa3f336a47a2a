use super::sample::{Named, Room, Sample, end, lattice_point, length};
use crate::random::Random;
use glam::DVec3;
use gridel_host::shape::Sphere;
use gridel_host::shape::exact::Real;

impl Sample for Sphere {
    const NAMES: &[Named] = &[Named {
        name: "sphere",
        crossing: (8.0, "judged at the point closest to the center"),
        normal: (8.0, "the hit's point less the center, normalized"),
    }];

    fn example() -> Self {
        Self {
            center: DVec3::new(0.0, 0.0, 1.0),
            radius: 0.8,
        }
    }

    fn random(random: &mut Random, _: &str, room: Room) -> Self {
        Self {
            center: lattice_point(room.center),
            radius: length(room.size * (0.2 + random.unit())),
        }
    }

    fn place(&self, random: &mut Random) -> DVec3 {
        let direction = DVec3::from_array(random.direction());
        self.center + direction * self.radius * [1.0, 1.0, 0.999, 0.5][random.below(4)]
    }

    fn own_direction(&self, random: &mut Random) -> DVec3 {
        DVec3::AXES[random.below(3)]
    }

    fn surface_point(&self, random: &mut Random) -> DVec3 {
        self.center + DVec3::from_array(random.direction()) * self.radius
    }

    fn distance(&self, point: DVec3) -> f64 {
        (point.distance(self.center) - self.radius).abs()
    }

    fn reach(&self, axis: usize, sign: f64) -> Real {
        end(self.center[axis], sign, self.radius)
    }
}
