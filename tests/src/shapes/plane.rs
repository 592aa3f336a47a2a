use super::sample::{Named, Room, Sample, around, lattice_point, rounded_direction};
use crate::random::Random;
use glam::DVec3;
use gridel_host::shape::Plane;
use gridel_host::shape::exact::Real;

impl Sample for Plane {
    const NAMES: &[Named] = &[Named {
        name: "plane",
        crossing: (8.0, "t from the plane, as of a disc"),
        normal: (8.0, "its own, normalized; exact along an axis"),
    }];

    fn example() -> Self {
        Self {
            point: DVec3::new(0.0, 0.0, 0.1),
            normal: DVec3::new(0.1, 0.0, 1.0),
        }
    }

    /// Often nearly level.
    fn random(random: &mut Random, _: &str, room: Room) -> Self {
        let mut normal = rounded_direction(random);
        if random.one_in(3) {
            let most = f64::from(1 << 24);
            let lean = DVec3::from_array(random.direction()) * random.magnitude(1e-6, 1e-2);
            let leaning = DVec3::AXES[random.below(3)] + lean;
            normal = (leaning / leaning.abs().max_element() * most).round() / most;
        }
        Self {
            point: lattice_point(room.center),
            normal,
        }
    }

    fn place(&self, random: &mut Random) -> DVec3 {
        let reach = random.magnitude(1.0, 1e4);
        self.point + around(random, self.normal.normalize(), reach)
    }

    fn own_direction(&self, random: &mut Random) -> DVec3 {
        match random.below(2) {
            0 => self.normal,
            _ => self.normal.any_orthonormal_vector(),
        }
    }

    fn surface_point(&self, random: &mut Random) -> DVec3 {
        self.place(random)
    }

    fn distance(&self, point: DVec3) -> f64 {
        (point - self.point).dot(self.normal.normalize()).abs()
    }

    /// Returns the largest number, because a plane has no end.
    fn reach(&self, _: usize, _: f64) -> Real {
        Real::of(f64::MAX)
    }
}
