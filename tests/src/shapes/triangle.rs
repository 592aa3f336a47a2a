use super::sample::{Named, Room, Sample, end, from_segment, lattice_point};
use crate::random::Random;
use glam::DVec3;
use gridel_host::shape::Triangle;
use gridel_host::shape::exact::Real;

impl Sample for Triangle {
    const NAMES: &[Named] = &[Named {
        name: "triangle",
        crossing: (8.0, "exact edge tests; t from the plane"),
        normal: (8.0, "in integers, exact but for one normalization"),
    }];

    fn example() -> Self {
        [
            DVec3::new(-2.0, -2.0, 0.0),
            DVec3::new(2.0, -2.0, 0.0),
            DVec3::new(0.0, 2.0, 0.0),
        ]
    }

    fn random(random: &mut Random, _: &str, room: Room) -> Self {
        loop {
            let first = room.center + room.offset(random);
            let second = room.center + room.offset(random);
            let middle = first + (second - first) * random.unit();
            let third = middle + room.offset(random) / room.stretch;
            let [a, b, c] = [first, second, third].map(lattice_point);
            if (b - a).cross(c - a) != DVec3::ZERO {
                break [a, b, c];
            }
        }
    }

    fn place(&self, random: &mut Random) -> DVec3 {
        let [a, b, c] = *self;
        match random.below(4) {
            0 => a,
            1 => b + (c - b) * random.unit(),
            _ => {
                let inner = b + (c - b) * random.unit();
                a + (inner - a) * random.unit()
            }
        }
    }

    fn own_direction(&self, random: &mut Random) -> DVec3 {
        let [a, b, c] = *self;
        match random.below(2) {
            0 => b - a,
            _ => b + c - 2.0 * a,
        }
    }

    fn surface_point(&self, random: &mut Random) -> DVec3 {
        if random.one_in(2) {
            return self[random.below(3)];
        }
        let mut weights = [0; 3].map(|_| random.unit());
        if random.one_in(2) {
            weights[random.below(3)] = 0.0;
        }
        let sum: f64 = weights.iter().sum();
        (0..3).map(|k| self[k] * (weights[k] / sum)).sum()
    }

    fn distance(&self, point: DVec3) -> f64 {
        let [a, b, c] = *self;
        let normal = (b - a).cross(c - a);
        let edges = [(a, b), (b, c), (c, a)];
        let is_inside = edges
            .iter()
            .all(|(from, to)| (to - from).cross(point - from).dot(normal) >= 0.0);
        if is_inside {
            return (point - a).dot(normal.normalize()).abs();
        }
        edges
            .map(|(from, to)| from_segment(point, from, to))
            .into_iter()
            .fold(f64::INFINITY, f64::min)
    }

    fn reach(&self, axis: usize, sign: f64) -> Real {
        let [a, b, c] = self.map(|corner| end(corner[axis], sign, 0.0));
        a.max(b).max(c)
    }
}
