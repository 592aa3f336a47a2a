use super::sample::{
    Named, Room, Sample, around, cylindrical, direction, from_segment, lattice_point, length, part,
    rim,
};
use crate::random::Random;
use glam::DVec3;
use gridel_host::shape::Cone;
use gridel_host::shape::exact::{Real, minus, unit, vector};

const NARROWING: (f64, &str) = (8.0, "and once more near the root where the solid is thin");
const NORMAL: (f64, &str) = (8.0, "times coordinate over the radius at the hit: likewise");

impl Sample for Cone {
    const NAMES: &[Named] = &[
        Named {
            name: "cylinder",
            crossing: (8.0, "the quadric is judged at its vertex"),
            normal: (
                8.0,
                "times coordinate over radius: the hit's point is rounded",
            ),
        },
        Named {
            name: "cone",
            crossing: NARROWING,
            normal: NORMAL,
        },
        Named {
            name: "frustum",
            crossing: NARROWING,
            normal: NORMAL,
        },
    ];

    fn example() -> Self {
        Self {
            base: DVec3::new(0.0, 0.0, 0.2),
            base_radius: 0.8,
            apex: DVec3::new(0.0, 0.0, 1.8),
            apex_radius: 0.3,
        }
    }

    /// Needles and coins.
    fn random(random: &mut Random, name: &str, room: Room) -> Self {
        let Room {
            center,
            size,
            stretch,
        } = room;
        let flat = random.one_in(2);
        let (tall, wide) = if flat {
            (1.0 / stretch, 1.0)
        } else {
            (1.0, 1.0 / stretch)
        };
        let axis = direction(random) * size * tall;
        let radius = length(size * wide * (0.2 + random.unit()));
        let other = length(size * wide * (0.2 + random.unit()));
        let (base, mut apex) = (lattice_point(center - axis), lattice_point(center + axis));
        if base == apex {
            apex[random.below(3)] += 1.0 / 256.0;
        }
        Self {
            base,
            apex,
            base_radius: radius,
            apex_radius: match name {
                "cylinder" => radius,
                "cone" => 0.0,
                _ if other == radius => radius + 1.0 / 256.0,
                _ => other,
            },
        }
    }

    fn place(&self, random: &mut Random) -> DVec3 {
        let up = self.apex - self.base;
        let part = [0.0, 1.0, random.unit(), random.unit()][random.below(4)];
        let radius = self.base_radius + part * (self.apex_radius - self.base_radius);
        let inner = [1.0, 1.0, 0.0, random.unit()][random.below(4)];
        self.base + up * part + around(random, up.normalize(), radius * inner)
    }

    fn own_direction(&self, random: &mut Random) -> DVec3 {
        let up = self.apex - self.base;
        let side = up.normalize().any_orthonormal_vector();
        match random.below(3) {
            0 => up,
            1 => up + side * (self.apex_radius - self.base_radius),
            _ => side,
        }
    }

    fn surface_point(&self, random: &mut Random) -> DVec3 {
        let at_end = random.one_in(2);
        let axis = self.apex - self.base;
        let outward = around(random, axis.normalize(), 1.0);
        let along = random.unit();
        match random.below(3) {
            0 => self.base + outward * self.base_radius * part(random, at_end),
            1 => self.apex + outward * self.apex_radius * part(random, at_end),
            _ => {
                let radius = self.base_radius + (self.apex_radius - self.base_radius) * along;
                self.base + axis * along + outward * radius
            }
        }
    }

    fn distance(&self, point: DVec3) -> f64 {
        let axis = self.apex - self.base;
        let (along, across) = cylindrical(point - self.base, axis);
        let height = axis.length();
        let profile = [
            [0.0, 0.0],
            [0.0, self.base_radius],
            [height, self.apex_radius],
            [height, 0.0],
        ];
        let ends = profile.windows(2);
        ends.map(|ends| {
            let [from, to] = [0, 1].map(|k| DVec3::new(ends[k][0], ends[k][1], 0.0));
            from_segment(DVec3::new(along, across, 0.0), from, to)
        })
        .fold(f64::INFINITY, f64::min)
    }

    fn reach(&self, axis: usize, sign: f64) -> Real {
        let up = unit(&minus(&vector(self.apex), &vector(self.base)));
        let rim = |place: DVec3, radius| rim(place[axis], sign, &up[axis], radius);
        rim(self.base, self.base_radius).max(rim(self.apex, self.apex_radius))
    }
}
