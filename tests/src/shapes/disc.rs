use super::sample::{
    Named, Room, Sample, around, cylindrical, lattice_point, length, part, rim, rounded_direction,
};
use crate::random::Random;
use glam::DVec3;
use gridel_host::shape::Disc;
use gridel_host::shape::exact::{Real, unit, vector};

impl Sample for Disc {
    const NAMES: &[Named] = &[Named {
        name: "disc",
        crossing: (8.0, "t from the plane, then the distance"),
        normal: (8.0, "its own, normalized"),
    }];

    fn example() -> Self {
        Self {
            center: DVec3::new(0.0, 0.0, 1.0),
            normal: DVec3::new(0.3, -1.0, 0.4),
            radius: 0.9,
        }
    }

    fn random(random: &mut Random, _: &str, room: Room) -> Self {
        Self {
            normal: rounded_direction(random),
            center: lattice_point(room.center),
            radius: length(room.size * (0.2 + random.unit())),
        }
    }

    fn place(&self, random: &mut Random) -> DVec3 {
        let part = [1.0, 0.9999, 1.0001, random.unit()][random.below(4)];
        self.center + around(random, self.normal.normalize(), self.radius * part)
    }

    fn own_direction(&self, random: &mut Random) -> DVec3 {
        match random.below(2) {
            0 => self.normal,
            _ => self.normal.any_orthonormal_vector(),
        }
    }

    fn surface_point(&self, random: &mut Random) -> DVec3 {
        let at_end = random.one_in(2);
        self.center + around(random, self.normal.normalize(), self.radius) * part(random, at_end)
    }

    fn distance(&self, point: DVec3) -> f64 {
        let (along, across) = cylindrical(point - self.center, self.normal);
        along.hypot((across - self.radius).max(0.0))
    }

    fn reach(&self, axis: usize, sign: f64) -> Real {
        let normal = unit(&vector(self.normal));
        rim(self.center[axis], sign, &normal[axis], self.radius)
    }
}
