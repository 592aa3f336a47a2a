//! Random chains of joints for tests.

use crate::scene::{
    Attributes, Instance, Interpolation, Joint, Key, Material, Normals, Object, Part, Placement,
    Scene, SourceSpan, Track, TrackTarget,
};
use crate::shape::{Shape, Sphere};
use glam::{DQuat, DVec3, DVec4};

/// Random numbers, the same in each run.
pub struct Random(pub u64);

impl Random {
    /// Returns a number from -1 to 1.
    pub fn number(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    pub fn vector(&mut self) -> DVec3 {
        DVec3::new(self.number(), self.number(), self.number())
    }

    pub fn below(&mut self, count: usize) -> usize {
        ((self.number() * 0.5 + 0.5) * count as f64) as usize % count
    }
}

fn track(random: &mut Random, target: TrackTarget, index: usize, hinge: bool) -> Track {
    let interpolation = Interpolation::ALL[random.below(3)];
    let axis = random.vector();
    let keys = (0..2 + random.below(3)).map(|number| {
        let mut value = |size: f64| match target {
            TrackTarget::JointRotation if hinge => (axis * random.number()).extend(0.0) * size,
            TrackTarget::JointRotation => random.vector().extend(0.0) * size,
            TrackTarget::JointShift => random.vector().extend(0.0) * size,
            _ => DVec4::X * (0.9 * random.number() * size),
        };
        let rest = match target {
            TrackTarget::JointScale => DVec4::X,
            // Splines of rotations stay away from 0.
            TrackTarget::JointRotation => DVec4::W,
            _ => DVec4::ZERO,
        };
        let keyed = rest + value(1.0);
        let keyed = match target {
            TrackTarget::JointRotation => keyed.normalize(),
            _ => keyed,
        };
        Key {
            seconds: number as f64 * 0.5,
            value: keyed.to_array(),
            entering: value(1.0).to_array(),
            leaving: value(1.0).to_array(),
        }
    });
    Track {
        target,
        index,
        interpolation,
        keys: keys.collect(),
        place: SourceSpan::default(),
    }
}

/// Returns a scene of a chain of joints with an instance at its end, of a sphere. All joints have scales, or the first
/// alone.
pub fn chain(random: &mut Random, all_scale: bool) -> Scene {
    let joints = 1 + random.below(5);
    let mut scene = Scene::default();
    for number in 0..joints {
        scene.joints.push(Joint {
            name: String::new(),
            parent: number.checked_sub(1),
            pivot: random.vector() * 3.0,
            place: SourceSpan::default(),
        });
        for target in [
            TrackTarget::JointRotation,
            TrackTarget::JointShift,
            TrackTarget::JointScale,
        ] {
            let scales = target == TrackTarget::JointScale && !all_scale && number > 0;
            if random.number() > 0.0 && !scales {
                let hinge = random.number() > 0.0;
                scene.tracks.push(track(random, target, number, hinge));
            }
        }
    }
    scene.materials.push(Material::default());
    scene.parts.push(Part {
        name: String::new(),
        objects: vec![Object {
            normals: Normals::default(),
            attributes: Attributes::default(),
            name: String::new(),
            material: 0,
            shape: Shape::Sphere(Sphere {
                center: random.vector(),
                radius: 0.5,
            }),
            place: SourceSpan::default(),
        }],
        place: SourceSpan::default(),
    });
    scene.instances.push(Instance {
        name: String::new(),
        part: 0,
        placement: Placement {
            rotation: DQuat::from_vec4(random.vector().extend(0.5)).normalize(),
            translation: random.vector() * 4.0,
            scale: 1.5,
        },
        joint: Some(joints - 1),
        place: SourceSpan::default(),
    });
    scene
}
