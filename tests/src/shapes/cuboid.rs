use super::sample::{Named, Room, Sample, end, lattice_point, part};
use crate::random::Random;
use glam::DVec3;
use gridel_host::shape::Cuboid;
use gridel_host::shape::exact::Real;

impl Sample for Cuboid {
    const NAMES: &[Named] = &[Named {
        name: "box",
        crossing: (8.0, "one difference and one quotient per axis"),
        normal: (0.0, "exact"),
    }];

    fn example() -> Self {
        Self {
            min: DVec3::new(-0.7, -0.7, 0.3),
            max: DVec3::new(0.7, 0.7, 1.7),
        }
    }

    fn random(random: &mut Random, _: &str, room: Room) -> Self {
        let mut reach = room.offset(random).abs();
        reach[random.below(3)] /= room.stretch;
        Self {
            min: lattice_point(room.center - reach),
            max: lattice_point(room.center + reach),
        }
    }

    fn place(&self, random: &mut Random) -> DVec3 {
        let side = |k: usize| match random.below(3) {
            0 => self.min[k],
            1 => self.max[k],
            _ => self.min[k] + random.unit() * (self.max[k] - self.min[k]),
        };
        DVec3::from_array([0, 1, 2].map(side))
    }

    fn own_direction(&self, random: &mut Random) -> DVec3 {
        DVec3::AXES[random.below(3)]
    }

    fn surface_point(&self, random: &mut Random) -> DVec3 {
        let at_end = random.one_in(2);
        let mut point = DVec3::from_array([0; 3].map(|_| part(random, at_end)));
        for k in 0..3 {
            if random.one_in(2) {
                point[k] = 1.0 - point[k];
            }
        }
        point[random.below(3)] = random.below(2) as f64;
        self.min + (self.max - self.min) * point
    }

    fn distance(&self, point: DVec3) -> f64 {
        let outside = (self.min - point).max(point - self.max);
        if outside.max_element() <= 0.0 {
            -outside.max_element()
        } else {
            outside.max(DVec3::ZERO).length()
        }
    }

    fn reach(&self, axis: usize, sign: f64) -> Real {
        let side = if sign < 0.0 { self.min } else { self.max };
        end(side[axis], sign, 0.0)
    }
}
