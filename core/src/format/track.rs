//! The records of tracks: which value moves, when, and between which values.
//!
//! A track gives one number or vector of the scene a value at each of its keys. Values are words, `i32` each. The
//! number of words per key follows from the target and its interpolation: see [`Track::words`].

use crate::format::layout::records;
use crate::format::limits::{FIELD_OF_VIEW, LARGEST_WEIGHT, SCALES};
use crate::format::reason::Field;
use bytemuck::{Pod, Zeroable};

records! {
    /// The times of all tracks together.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(12)]
    pub struct Timeline {
        /// Ticks per second. All times are ticks.
        #[valid(TicksPerSecond: 1..=i32::MAX as i64)]
        pub ticks_per_second: u32,
        /// The time of the earliest key.
        pub first: i32,
        /// The time of the latest key.
        pub last: i32,
    }

    /// A track: its keys are a range of the sections of times and of values.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(20)]
    pub struct Track {
        /// The property that moves: a [`TrackTarget`].
        pub target: u16,
        /// The interpolation between keys: an [`Interpolation`].
        pub interpolation: u16,
        /// The number of the light, material, joint or morph target; 0 for the camera.
        pub index: u32,
        /// Number of keys.
        #[valid(Keys: 1..=u32::MAX as i64)]
        pub keys: u32,
        /// The time of its first key, counted among all times.
        pub first_time: u32,
        /// The first word of its values, counted among all words.
        pub first_word: u32,
    }
}

records! {
    /// A joint: what instances, and further joints, hang on.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
    #[repr(C)]
    #[bytes(16)]
    pub struct Joint {
        /// The place about which it turns and scales, at rest: a [`Position`](crate::Position).
        pub pivot: [i32; 3],
        /// The joint on which it hangs, one that comes before it, or [`Joint::NONE`].
        pub parent: u32,
    }
}

impl Joint {
    /// Marks a missing joint.
    pub const NONE: u32 = u32::MAX;
}

/// The way in which a value moves from a key to the next one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u16)]
pub enum Interpolation {
    /// It stays until the next key.
    Step = 0,
    /// It changes evenly; rotations turn evenly about one axis.
    Linear = 1,
    /// It follows a cubic Hermite spline. Each key has the value, and the changes per segment with which the spline
    /// enters and leaves it.
    Cubic = 2,
}

impl Interpolation {
    /// All of them, by their number in the blob.
    pub const ALL: [Self; 3] = [Self::Step, Self::Linear, Self::Cubic];

    /// Returns the name that scene files and reports use.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Step => "step",
            Self::Linear => "linear",
            Self::Cubic => "cubic",
        }
    }
}

/// The meaning of the words of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ValueKind {
    /// Three scene coordinates: a [`Position`](crate::Position).
    Position,
    /// Three components of a direction of any length but 0, in any one scale.
    Direction,
    /// Three components of a direction of about length 1, with 30 fraction bits.
    UnitDirection,
    /// An [`Angle`](crate::Angle) of which a camera sees something.
    FieldOfView,
    /// A quaternion of about length 1, x, y, z and w with 30 fraction bits. Where it is interpolated linearly, the
    /// [`Angle`](crate::Angle) to that of the next key follows, at most a quarter of a turn.
    Rotation,
    /// Turns, with 24 fraction bits.
    Turns,
    /// Three differences of scene coordinates.
    Shift,
    /// A scale with 24 fraction bits: see [`Motion::SCALES`](crate::Motion::SCALES).
    Scale,
    /// The weight of a morph target, with 24 fraction bits.
    Weight,
    /// Red, green and blue radiance, 20 fraction bits.
    Radiance,
    /// Red, green and blue ratios, 30 fraction bits.
    Ratios,
}

impl ValueKind {
    /// Numbers that are interpolated.
    pub const fn components(self) -> usize {
        match self {
            Self::FieldOfView | Self::Turns | Self::Scale | Self::Weight => 1,
            Self::Rotation => 4,
            _ => 3,
        }
    }

    /// Returns the least and the greatest value of a component.
    pub const fn range(self) -> [i32; 2] {
        const RATIO: i32 = 1 << 30;
        match self {
            Self::Position | Self::Direction | Self::Turns | Self::Shift => [i32::MIN, i32::MAX],
            Self::UnitDirection | Self::Rotation => [-RATIO, RATIO],
            Self::FieldOfView => FIELD_OF_VIEW,
            Self::Scale => SCALES,
            Self::Weight => [-LARGEST_WEIGHT, LARGEST_WEIGHT],
            Self::Radiance => [0, i32::MAX],
            Self::Ratios => [0, RATIO],
        }
    }

    /// Returns true if it is a direction, of any length or of about 1.
    pub const fn is_direction(self) -> bool {
        matches!(self, Self::Direction | Self::UnitDirection)
    }

    /// Returns true if some component must differ from 0.
    pub(crate) const fn has_length(self) -> bool {
        matches!(self, Self::Direction | Self::UnitDirection | Self::Rotation)
    }

    /// The name of a component in errors.
    pub(crate) const fn field(self) -> Field {
        match self {
            Self::Position | Self::Shift => Field::Coordinate,
            Self::Scale => Field::Scale,
            Self::Weight => Field::Weight,
            Self::Direction | Self::UnitDirection => Field::Direction,
            Self::FieldOfView => Field::FieldOfView,
            Self::Rotation | Self::Turns => Field::Rotation,
            Self::Radiance | Self::Ratios => Field::Color,
        }
    }
}

macro_rules! targets {
    ($($(#[doc = $doc:literal])* $target:ident = $number:literal, $name:literal, $kind:ident;)*) => {
        /// The property that a track moves.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(u16)]
        pub enum TrackTarget {
            $($(#[doc = $doc])* $target = $number,)*
        }

        impl TrackTarget {
            /// All of them, by their number in the blob.
            pub const ALL: [Self; [$($number),*].len()] = [$(Self::$target),*];

            /// Whose property it is, and its name; the camera is one, lights, materials, joints and morph
            /// targets have numbers.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$target => $name,)*
                }
            }

            /// Returns the kind of its values.
            pub const fn kind(self) -> ValueKind {
                match self {
                    $(Self::$target => ValueKind::$kind,)*
                }
            }
        }
    };
}

targets! {
    /// The camera's place.
    CameraEye = 0, "camera.eye", Position;
    /// The place in the middle of the camera's picture.
    CameraTarget = 1, "camera.target", Position;
    /// The direction that points up in the camera's picture.
    CameraUp = 2, "camera.up", Direction;
    /// The full vertical angle that the camera sees.
    CameraFieldOfView = 3, "camera.fov", FieldOfView;
    /// The rotation of the camera, in place of a target and an up direction.
    CameraRotation = 4, "camera.rotation", Rotation;
    /// The angle by which the eye is turned about the axis through the target along the up direction.
    CameraOrbit = 5, "camera.orbit", Turns;
    /// The place of a point light.
    LightPosition = 6, "light.position", Position;
    /// The direction towards a directional light.
    LightDirection = 7, "light.direction", UnitDirection;
    /// The color of a light.
    LightColor = 8, "light.color", Radiance;
    /// The diffuse color of a material; of the even cells where there is a checkerboard.
    MaterialDiffuse = 9, "material.diffuse", Ratios;
    /// The diffuse color of the odd cells of a checkerboard.
    MaterialOdd = 10, "material.checker.odd", Ratios;
    /// The color of a material's highlights.
    MaterialHighlight = 11, "material.highlight", Ratios;
    /// The weight of a material's mirrored ray.
    MaterialMirror = 12, "material.mirror", Ratios;
    /// The weight of what a material's glass brings.
    MaterialTransmit = 13, "material.transmit", Ratios;
    /// The rotation of a joint about its pivot.
    JointRotation = 14, "joint.rotation", Rotation;
    /// The shift of a joint.
    JointShift = 15, "joint.shift", Shift;
    /// The scale of a joint relative to rest.
    JointScale = 16, "joint.scale", Scale;
    /// The weight of a morph target.
    MorphWeight = 17, "morph.weight", Weight;
}

impl TrackTarget {
    /// Returns true if it is a property of the camera.
    pub const fn is_of_camera(self) -> bool {
        (self as u16) < Self::LightPosition as u16
    }

    /// Returns true if it is a property of a light.
    pub const fn is_of_light(self) -> bool {
        self as u16 >= Self::LightPosition as u16 && (self as u16) < Self::MaterialDiffuse as u16
    }

    /// Returns true if it is a property of a material.
    pub const fn is_of_material(self) -> bool {
        self as u16 >= Self::MaterialDiffuse as u16 && (self as u16) < Self::JointRotation as u16
    }

    /// Returns true if it is a property of a joint.
    pub const fn is_of_joint(self) -> bool {
        self as u16 >= Self::JointRotation as u16 && (self as u16) < Self::MorphWeight as u16
    }
}

impl Track {
    /// Returns the target; `None` if its number is invalid.
    pub fn target(&self) -> Option<TrackTarget> {
        TrackTarget::ALL.get(usize::from(self.target)).copied()
    }

    /// Returns the interpolation; `None` if its number is invalid.
    pub fn interpolation(&self) -> Option<Interpolation> {
        Interpolation::ALL
            .get(usize::from(self.interpolation))
            .copied()
    }

    /// Words of a key.
    pub const fn words(kind: ValueKind, interpolation: Interpolation) -> usize {
        let components = kind.components();
        match interpolation {
            Interpolation::Cubic => 3 * components,
            Interpolation::Linear if matches!(kind, ValueKind::Rotation) => components + 1,
            _ => components,
        }
    }
}
