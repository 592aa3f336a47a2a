//! Cameras that a program places at run time.
//!
//! All arithmetic is in integers, with the same bits on every machine and in every number format. The compiler of blobs
//! places the scene file's camera with the same functions.

use crate::format::record::{Header, View};
use crate::number::rotation::columns;
use crate::number::{Angle, Fixed, Products, Scalar, Vectors};
use crate::scene::{Position, Scene};
use core::fmt;

/// A pinhole camera in scene coordinates that replaces the blob's own.
///
/// Cost: one set-up per frame. Placing the camera, its checks and the renderer together take 2,300 to 2,700
/// instructions on Cortex-M3, Cortex-M4F and RV32. On Cortex-M0 they take 8,100.
///
/// ```
/// # static BLOB: &[u8] =
/// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
/// use gridel_core::{Angle, Camera, NoCount, Position, Renderer, Rgb565, Scene, Up, Workspace};
///
/// let scene = Scene::from_bytes(BLOB)?;
/// let mut space = Workspace::for_any_scene();
/// let mut row = [Rgb565(0); 32];
/// // Steps of 2^-25 scene units: around a place one unit above the origin, from 9 units away.
/// let middle = Position([0, 1 << 25, 0]);
/// for dial in 0..24 {
///     let turn = Angle::of_turn(dial, 24);
///     let camera = Camera::orbit(Up::Y, middle, 9 << 25, turn, Angle::degrees(20), Angle::degrees(40))?;
///     let view = camera.view(&scene);
///     let seen = scene.with_view(&view)?;
///     let renderer = Renderer::new(&seen)?;
///     renderer.row(0, 120, &mut row, &mut space.as_view(), &mut NoCount);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Camera {
    eye: Position,
    /// Vectors to the middle of the picture, from there to its right by half of its height, and to its upper edge.
    /// Magnitudes are at most 2^28.
    frame: [[i32; 3]; 3],
}

/// The axis of a scene that points up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Up {
    /// y, as in most formats; the camera of an orbit begins in front, on the side of z.
    #[default]
    Y,
    /// z, as in STL and NFF; the camera of an orbit begins in front, on the side of -y.
    Z,
}

/// The reason why a camera is invalid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum CameraError {
    /// The field of view is below 2, or half a turn or more.
    FieldOfView(Angle),
    /// Eye and target are the same place, or the direction or rotation has no length.
    NoDirection,
    /// The camera looks along the direction that points up, or that has no length, so the rotation of the picture is
    /// undefined.
    AlongUp,
    /// The eye lies beyond the range of scene coordinates.
    EyeOutOfRange,
}

impl fmt::Display for CameraError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::FieldOfView(_) => "the field of view must be at least 2 and below half a turn",
            Self::NoDirection => "the camera looks nowhere: move its eye or its target",
            Self::AlongUp => {
                "the camera looks along the direction that points up, or that is 0: give one across the view"
            }
            Self::EyeOutOfRange => "the eye is beyond the range of scene coordinates",
        })
    }
}

impl core::error::Error for CameraError {}

impl Camera {
    /// Returns a camera at `eye`, with `target` in the middle of its picture and the direction `up` upwards.
    /// `field_of_view` is the angle of the picture's height.
    ///
    /// # Errors
    /// If eye and target are the same place, or the camera looks along `up`, or `up` is 0. Also if the field of view
    /// is below 2, in 2^-32 turn, or half a turn or more. For a picture of one pixel a [renderer](crate::Renderer)
    /// needs about 8 in `fixed` and `f64`, and 500 in `f32`, and more for more pixels.
    pub fn look_at(
        eye: Position,
        target: Position,
        up: [i32; 3],
        field_of_view: Angle,
    ) -> Result<Self, CameraError> {
        let toward = |k: usize| i64::from(target.0[k]) - i64::from(eye.0[k]);
        Self::looking([toward(0), toward(1), toward(2)], eye, up, field_of_view)
    }

    /// Returns a camera that looks in a direction of any length.
    ///
    /// # Errors
    /// The errors of [`look_at`](Self::look_at).
    pub fn look_along(
        eye: Position,
        direction: [i32; 3],
        up: [i32; 3],
        field_of_view: Angle,
    ) -> Result<Self, CameraError> {
        Self::looking(direction.map(i64::from), eye, up, field_of_view)
    }

    fn looking(
        direction: [i64; 3],
        eye: Position,
        up: [i32; 3],
        field_of_view: Angle,
    ) -> Result<Self, CameraError> {
        let forward = unit(direction).ok_or(CameraError::NoDirection)?;
        let up = unit(up.map(i64::from)).ok_or(CameraError::AlongUp)?;
        let across = cross(forward, up).map(|product| product.0);
        // Where the sine is below 2^-16, rounding would turn the picture, by 2^-13 and more.
        if across.iter().all(|x| x.unsigned_abs() < 1 << 44) {
            return Err(CameraError::AlongUp);
        }
        let right = unit(across).ok_or(CameraError::AlongUp)?;
        let up = cross(right, forward).map(Fixed::from_wide);
        Self::with_axes([forward, right, up], eye, field_of_view)
    }

    /// Returns a camera turned by a quaternion of any length, x, y, z and w: without a turn it looks along -z, with y
    /// upwards.
    ///
    /// # Errors
    /// If all components of the rotation are 0. Also if the field of view is below 2, in 2^-32 turn, or half a turn or
    /// more.
    pub fn rotated(
        eye: Position,
        rotation: [i32; 4],
        field_of_view: Angle,
    ) -> Result<Self, CameraError> {
        let [right, up, back] = columns(rotation).ok_or(CameraError::NoDirection)?;
        let forward = back.map(|x| -x);
        Self::with_axes([forward, right, up], eye, field_of_view)
    }

    /// Returns a camera on a circle around `target`, for example for a dial. `azimuth` turns it around the axis that
    /// points up, counterclockwise as seen from above. `elevation` raises it; it can pass over the pole. The distance
    /// is in coordinate steps.
    ///
    /// # Errors
    /// If the distance is 0, or the eye leaves the range of coordinates. Also if the field of view is below 2, in
    /// 2^-32 turn, or half a turn or more.
    pub fn orbit(
        up: Up,
        target: Position,
        distance: u32,
        azimuth: Angle,
        elevation: Angle,
        field_of_view: Angle,
    ) -> Result<Self, CameraError> {
        if distance == 0 {
            return Err(CameraError::NoDirection);
        }
        let [sin_azimuth, cos_azimuth] = azimuth.sin_cos().map(Fixed);
        let [sin_elevation, cos_elevation] = elevation.sin_cos().map(Fixed);
        let away = [
            cos_elevation * sin_azimuth,
            sin_elevation,
            cos_elevation * cos_azimuth,
        ];
        let right = [cos_azimuth, Fixed::ZERO, -sin_azimuth];
        let upward = [
            -(sin_elevation * sin_azimuth),
            cos_elevation,
            -(sin_elevation * cos_azimuth),
        ];
        let [away, right, upward] = [away, right, upward].map(|axis| up.turn(axis));
        let mut eye = target;
        for (place, away) in eye.0.iter_mut().zip(away) {
            let way = i64::from(away.0).wrapping_mul(distance.into());
            let way = way.wrapping_add(1 << 29) >> 30;
            let coordinate = i64::from(*place).wrapping_add(way);
            *place = i32::try_from(coordinate).map_err(|_| CameraError::EyeOutOfRange)?;
        }
        let forward = away.map(|x| -x);
        Self::with_axes([forward, right, upward], eye, field_of_view)
    }

    /// A camera that looks along the first of three axes of length 1, with the others to the right and up.
    fn with_axes(
        [forward, right, up]: [[Fixed; 3]; 3],
        eye: Position,
        field_of_view: Angle,
    ) -> Result<Self, CameraError> {
        let half = Angle(field_of_view.0 >> 1);
        if half == Angle(0) || half >= Angle::QUARTER {
            return Err(CameraError::FieldOfView(field_of_view));
        }
        let [sine, cosine] = half.sin_cos().map(Fixed);
        let frame = [(forward, cosine), (right, sine), (up, sine)];
        let frame = frame.map(|(axis, length)| axis.map(|x| (x * length).0));
        // The largest component keeps the 28 bits that records have.
        let magnitudes = frame.iter().flatten().map(|x| x.unsigned_abs());
        let all = magnitudes.fold(0, |all, x| all | x);
        let down = 4_u32.saturating_sub(all.leading_zeros());
        let half = (1 << down) >> 1;
        let round = |x: i32| x.wrapping_add(half).wrapping_shr(down);
        Ok(Self {
            eye,
            frame: frame.map(|axis| axis.map(round)),
        })
    }

    /// Returns the place of the eye.
    pub fn eye(&self) -> Position {
        self.eye
    }

    /// Returns the scene's view with this camera in place of its own, for [`Scene::with_view`].
    pub fn view(&self, scene: &Scene<'_>) -> View {
        self.replace_in(scene.view(), scene.header())
    }

    /// Returns a view with this camera in place of its own, in the scene coordinates that a header states.
    pub fn replace_in(&self, view: &View, header: &Header) -> View {
        let [forward, right, up] = self.frame;
        View {
            eye: header.on_lattice(self.eye),
            forward,
            right,
            up,
            ..*view
        }
    }
}

impl Up {
    /// Returns the axis: 1 for y, 2 for z.
    pub const fn axis(self) -> usize {
        match self {
            Self::Y => 1,
            Self::Z => 2,
        }
    }

    /// A vector given with y upwards.
    fn turn(self, [x, y, z]: [Fixed; 3]) -> [Fixed; 3] {
        match self {
            Self::Y => [x, y, z],
            Self::Z => [x, -z, y],
        }
    }
}

/// The cross product of two vectors of length 1.
fn cross(a: [Fixed; 3], b: [Fixed; 3]) -> [<Fixed as Scalar>::Wide; 3] {
    let ([a_x, a_y, a_z], [b_x, b_y, b_z]) = (a, b);
    [
        a_y.wide(b_z) - a_z.wide(b_y),
        a_z.wide(b_x) - a_x.wide(b_z),
        a_x.wide(b_y) - a_y.wide(b_x),
    ]
}

/// The vector at length 1, as ratios; `None` if it has no length.
fn unit(vector: [i64; 3]) -> Option<[Fixed; 3]> {
    let (unit, length) = Fixed::normalize(Fixed::direction(vector));
    (length > Fixed::ZERO).then_some(unit)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const FIELD: Angle = Angle::degrees(40);

    type Vector = [f64; 3];

    fn dot(a: Vector, b: Vector) -> f64 {
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    }

    fn cross_of(a: Vector, b: Vector) -> Vector {
        [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ]
    }

    fn scaled(a: Vector, factor: f64) -> Vector {
        a.map(|x| x * factor)
    }

    fn normalized(a: Vector) -> Vector {
        scaled(a, 1.0 / libm::sqrt(dot(a, a)))
    }

    /// Forward, right and up of a camera, with forward's length 1.
    fn axes(camera: &Camera) -> [Vector; 3] {
        let axes = camera.frame.map(|axis| axis.map(f64::from));
        let length = libm::sqrt(dot(axes[0], axes[0]));
        axes.map(|axis| scaled(axis, 1.0 / length))
    }

    fn assert_near(found: [Vector; 3], expected: [Vector; 3], bound: f64) {
        for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
            assert!(
                (found - expected).abs() <= bound,
                "{found} is not {expected}"
            );
        }
    }

    /// The exact camera, in doubles.
    fn exact(direction: Vector, up: Vector, field: Angle) -> [Vector; 3] {
        let half = f64::from(field.0) / 4_294_967_296.0 * core::f64::consts::PI;
        let forward = normalized(direction);
        let right = normalized(cross_of(forward, normalized(up)));
        let up = cross_of(right, forward);
        [
            forward,
            scaled(right, libm::tan(half)),
            scaled(up, libm::tan(half)),
        ]
    }

    /// Two roundings of 2^-29 and one of the record's 28 bits, over the shortest forward vector.
    const BOUND: f64 = 4e-8;

    #[test]
    fn cameras_look_from_end_to_end_of_the_coordinates() {
        let ends = [i32::MIN, -1, 0, 1, i32::MAX];
        for (eye, target) in ends.into_iter().flat_map(|eye| ends.map(|to| (eye, to))) {
            let (eye, target) = (Position([eye; 3]), Position([target; 3]));
            let camera = Camera::look_at(eye, target, [0, 1, 0], FIELD);
            if eye == target {
                assert_eq!(camera, Err(CameraError::NoDirection));
                continue;
            }
            let direction = [f64::from(target.0[0]) - f64::from(eye.0[0]); 3];
            let expected = exact(direction, [0.0, 1.0, 0.0], FIELD);
            assert_near(axes(&camera.unwrap()), expected, BOUND);
        }
    }

    #[test]
    fn cameras_that_look_nowhere_are_rejected() {
        let (eye, target) = (Position([0; 3]), Position([0, 0, -100]));
        let look = |up, field| Camera::look_at(eye, target, up, field);
        assert_eq!(look([0; 3], FIELD), Err(CameraError::AlongUp));
        assert_eq!(look([0, 0, 7], FIELD), Err(CameraError::AlongUp));
        assert_eq!(look([0, 1, i32::MAX], FIELD), Err(CameraError::AlongUp));
        assert!(look([0, 1 << 14, i32::MIN], FIELD).is_err());
        assert!(look([0, 1 << 16, i32::MIN], FIELD).is_ok());
        for field in [Angle(0), Angle(1), Angle::HALF, Angle::degrees(-1)] {
            assert_eq!(look([0, 1, 0], field), Err(CameraError::FieldOfView(field)));
        }
        assert!(look([0, 1, 0], Angle(2)).is_ok());
        assert!(look([0, 1, 0], Angle(Angle::HALF.0 - 1)).is_ok());
        let still = Camera::rotated(eye, [0; 4], FIELD);
        assert_eq!(still, Err(CameraError::NoDirection));
        let orbit = |at, distance| Camera::orbit(Up::Y, at, distance, Angle(0), Angle(0), FIELD);
        assert_eq!(orbit(eye, 0), Err(CameraError::NoDirection));
        let end = Position([0, 0, i32::MAX - 5]);
        assert!(orbit(end, 5).is_ok());
        assert_eq!(orbit(end, 6), Err(CameraError::EyeOutOfRange));
        assert_eq!(orbit(eye, u32::MAX), Err(CameraError::EyeOutOfRange));
    }

    #[test]
    fn an_orbit_begins_in_front_and_turns_counterclockwise() {
        let middle = Position([1000, 2000, 3000]);
        for (up, front, right, top) in [
            (Up::Y, [0, 0, 500], [500, 0, 0], [0, 500, 0]),
            (Up::Z, [0, -500, 0], [500, 0, 0], [0, 0, 500]),
        ] {
            let eye = |azimuth, elevation| {
                let [azimuth, elevation] = [azimuth, elevation].map(Angle::degrees);
                let camera = Camera::orbit(up, middle, 500, azimuth, elevation, FIELD).unwrap();
                let [x, y, z] = camera.eye().0;
                [x - 1000, y - 2000, z - 3000]
            };
            assert_eq!(eye(0, 0), front);
            assert_eq!(eye(90, 0), right);
            assert_eq!(eye(0, 90), top);
            assert_eq!(eye(180, 180), front);
        }
    }

    proptest! {
        #[test]
        fn cameras_are_within_their_bound(
            direction: [i32; 3],
            up: [i32; 3],
            field in 1_000_000_u32..1_500_000_000,
            shift in 0_u32..31,
        ) {
            let direction = direction.map(|x| x >> shift);
            let camera = Camera::look_along(Position([0; 3]), direction, up, Angle(field));
            let (to, above) = (direction.map(f64::from), up.map(f64::from));
            if dot(to, to) == 0.0 || dot(above, above) == 0.0 {
                prop_assert!(camera.is_err());
                return Ok(());
            }
            let across = cross_of(normalized(to), normalized(above));
            let sine = libm::sqrt(dot(across, across));
            prop_assume!(sine > 0.01);
            // A wide field's forward vector is short.
            let tangent = libm::tan(f64::from(field) / 4_294_967_296.0 * core::f64::consts::PI);
            let bound = BOUND / sine * (1.0 + tangent) * (1.0 + tangent);
            assert_near(axes(&camera.unwrap()), exact(to, above, Angle(field)), bound);
        }

        #[test]
        fn an_orbit_looks_at_its_middle(azimuth: u32, elevation: u32, z_up: bool) {
            let (azimuth, elevation) = (Angle(azimuth), Angle(elevation));
            let up = if z_up { Up::Z } else { Up::Y };
            let middle = Position([5, -7, 11]);
            let distance = 1_000_000_000;
            let camera = Camera::orbit(up, middle, distance, azimuth, elevation, FIELD).unwrap();
            let axis = |k: usize| f64::from(middle.0[k] - camera.eye.0[k]);
            let [sine, cosine] = elevation.sin_cos().map(|x| f64::from(x) / f64::from(1 << 30));
            prop_assume!(cosine.abs() > 0.01);
            // Beyond the pole the camera is upside down.
            let above = up.turn([Fixed(0), Fixed(1), Fixed(0)]).map(|x| f64::from(x.0) * cosine);
            let expected = exact([axis(0), axis(1), axis(2)], above, FIELD);
            assert_near(axes(&camera), expected, BOUND / cosine.abs());
            let height = up.turn([Fixed(0), Fixed(1), Fixed(0)]).map(|x| f64::from(x.0));
            let rise = -dot([axis(0), axis(1), axis(2)], height) / f64::from(distance);
            prop_assert!((rise - sine).abs() < 1e-8);
        }

        #[test]
        fn rotations_are_those_of_quaternions(rotation: [i32; 4], shift in 0_u32..29) {
            let rotation = rotation.map(|x| x >> shift);
            let q = rotation.map(f64::from);
            let length = libm::sqrt(q.iter().map(|x| x * x).sum());
            let camera = Camera::rotated(Position([0; 3]), rotation, Angle::QUARTER);
            if length == 0.0 {
                prop_assert!(camera.is_err());
                return Ok(());
            }
            let [x, y, z, w] = q.map(|component| component / length);
            // v + 2 u x (u x v + w v)
            let turn = |v: Vector| {
                let u = [x, y, z];
                let inner = cross_of(u, v);
                let inner = [inner[0] + w * v[0], inner[1] + w * v[1], inner[2] + w * v[2]];
                let outer = cross_of(u, inner);
                [v[0] + 2.0 * outer[0], v[1] + 2.0 * outer[1], v[2] + 2.0 * outer[2]]
            };
            let expected = [
                turn([0.0, 0.0, -1.0]),
                turn([1.0, 0.0, 0.0]),
                turn([0.0, 1.0, 0.0]),
            ];
            assert_near(axes(&camera.unwrap()), expected, 2.0 * BOUND);
        }
    }
}
