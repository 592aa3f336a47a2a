//! Camera, lights, materials and weights of morph targets at a time.

use crate::format::record::{Light, Material};
use crate::format::track::{Track, TrackTarget};
use crate::format::{BlobError, SectionKind};
use crate::number::{Angle, Fixed, Scalar, Vectors};
use crate::render::{Camera, CameraError};
use crate::scene::{Position, Scene};
use crate::tracks::Tracks;
use crate::tracks::interpolate::Sample;

impl Tracks<'_> {
    /// Returns the camera at a time; `None` if the blob's camera does not move. [`Camera::view`] makes a view of it.
    ///
    /// # Errors
    /// If the moving camera looks nowhere or along the direction that points up, or an orbit leads beyond the range of
    /// coordinates.
    pub fn camera_at(&self, time: i32) -> Result<Option<Camera>, CameraError> {
        let eye = self.camera::<3>(TrackTarget::CameraEye, time);
        let field_of_view = self.camera::<1>(TrackTarget::CameraFieldOfView, time);
        let (Some(eye), Some([field_of_view])) = (eye, field_of_view) else {
            return Ok(None);
        };
        let (eye, field_of_view) = (Position(eye), Angle(field_of_view as u32));
        if let Some(rotation) = self.camera(TrackTarget::CameraRotation, time) {
            return Camera::rotated(eye, rotation, field_of_view).map(Some);
        }
        let target = self.camera(TrackTarget::CameraTarget, time).map(Position);
        let (Some(target), Some(up)) = (target, self.camera(TrackTarget::CameraUp, time)) else {
            return Ok(None);
        };
        let eye = match self.camera(TrackTarget::CameraOrbit, time) {
            // An angle has 8 bits more.
            Some([turns]) => around(eye, target, up, Angle((turns as u32) << 8))?,
            None => eye,
        };
        Camera::look_at(eye, target, up, field_of_view).map(Some)
    }

    /// The value of the track that moves a numbered thing.
    pub(super) fn numbered<const N: usize>(
        &self,
        target: TrackTarget,
        number: u32,
        time: i32,
    ) -> Option<[i32; N]> {
        let key = |track: &Track| (track.target, track.index);
        let searched = (target as u16, number);
        let index = self.0.tracks.binary_search_by_key(&searched, key).ok()?;
        let track = self.0.tracks.get(index)?;
        Some(self.sample(track, target.kind(), time)?.value())
    }

    /// The value of a track of the camera. Such tracks come first, so few are looked at.
    fn camera<const N: usize>(&self, target: TrackTarget, time: i32) -> Option<[i32; N]> {
        let mut tracks = self.0.tracks.iter();
        let track = tracks.find(|track| track.target == target as u16)?;
        Some(self.sample(track, target.kind(), time)?.value())
    }

    /// Writes the lights of a scene at a time, for [`Scene::with_lights`](crate::Scene::with_lights).
    ///
    /// Lights and properties without a track keep the scene's values.
    ///
    /// # Errors
    /// If there are more or fewer lights than the scene has.
    pub fn lights_at(
        &self,
        scene: &Scene<'_>,
        time: i32,
        lights: &mut [Light],
    ) -> Result<(), BlobError> {
        copy(SectionKind::Lights, scene.lights(), lights)?;
        for track in self.0.tracks {
            let Some(target) = track.target() else {
                continue;
            };
            let Some(light) = lights.get_mut(track.index as usize) else {
                continue;
            };
            let kind = target.kind();
            let value = || self.sample::<3>(track, kind, time);
            // A program can have replaced it with a light of the other kind.
            match target {
                TrackTarget::LightPosition if light.has_position() => {
                    if let Some(place) = value() {
                        light.vector = scene.on_lattice(Position(place.value()));
                    }
                }
                TrackTarget::LightDirection if light.kind == Light::DIRECTIONAL => {
                    if let Some(direction) = value() {
                        light.vector = towards(direction).map(i64::from);
                    }
                }
                TrackTarget::LightColor => {
                    if let Some(color) = value() {
                        light.color = color.value();
                    }
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Writes the materials of a scene at a time, for [`Scene::with_materials`](crate::Scene::with_materials).
    ///
    /// Materials and properties without a track keep the scene's values. A material whose mirror, highlight or glass is
    /// 0 in the scene requires an [effect](crate::Effects) where a track raises it.
    ///
    /// # Errors
    /// If there are more or fewer materials than the scene has.
    pub fn materials_at(
        &self,
        scene: &Scene<'_>,
        time: i32,
        materials: &mut [Material],
    ) -> Result<(), BlobError> {
        copy(SectionKind::Materials, scene.materials(), materials)?;
        for track in self.0.tracks {
            let Some(target) = track.target().filter(|it| it.is_of_material()) else {
                continue;
            };
            let Some(material) = materials.get_mut(track.index as usize) else {
                continue;
            };
            let Some(color) = self.sample::<3>(track, target.kind(), time) else {
                continue;
            };
            let color = color.value();
            match target {
                TrackTarget::MaterialDiffuse => {
                    material.diffuse = color;
                    if material.checker_size == 0 {
                        material.odd = color;
                    }
                }
                TrackTarget::MaterialOdd => material.odd = color,
                TrackTarget::MaterialHighlight => material.highlight = color,
                TrackTarget::MaterialMirror => material.mirror = color,
                TrackTarget::MaterialTransmit => material.transmit = color,
                _ => {}
            }
        }
        Ok(())
    }

    /// Writes the weights of all morph targets at a time, with 24 fraction bits, for
    /// [`Deformation::morph`](crate::deform::DeformationIn::morph). Those without a track keep their weights at rest.
    ///
    /// # Errors
    /// If there are more or fewer weights than morph targets.
    pub fn weights_at(&self, time: i32, weights: &mut [i32]) -> Result<(), BlobError> {
        copy(SectionKind::MorphWeights, self.0.weights, weights)?;
        for (weight, number) in weights.iter_mut().zip(0..) {
            if let Some([moved]) = self.numbered(TrackTarget::MorphWeight, number, time) {
                *weight = moved;
            }
        }
        Ok(())
    }

    /// Returns the weights of morph targets at rest.
    pub fn weights_at_rest(&self) -> &[i32] {
        self.0.weights
    }
}

/// Copies records into a slice of the same length.
fn copy<T: Copy>(section: SectionKind, from: &[T], to: &mut [T]) -> Result<(), BlobError> {
    if from.len() != to.len() {
        return Err(BlobError::Memory {
            section,
            found: to.len(),
            needed: from.len(),
        });
    }
    for (from, to) in from.iter().zip(to) {
        *to = *from;
    }
    Ok(())
}

/// Returns a direction at length 1, like that of a key; the earlier key's where opposite directions cancel out.
fn towards(sample: Sample<3>) -> [i32; 3] {
    match sample {
        Sample::Key(direction) => direction,
        Sample::Between(between, earlier) => {
            let (unit, length) = Fixed::normalize(between.map(Fixed));
            if length > Fixed::ZERO {
                unit.map(|component| component.0)
            } else {
                earlier
            }
        }
    }
}

/// An eye turned about an axis through its target, counterclockwise as seen from the axis' tip.
fn around(
    eye: Position,
    target: Position,
    axis: [i32; 3],
    angle: Angle,
) -> Result<Position, CameraError> {
    let (axis, length) = Fixed::normalize(Fixed::direction(axis.map(i64::from)));
    if length == Fixed::ZERO {
        return Err(CameraError::AlongUp);
    }
    let [sine, cosine] = angle.sin_cos().map(i64::from);
    let [axis_x, axis_y, axis_z] = axis.map(|component| i64::from(component.0));
    let ([x, y, z], [from_x, from_y, from_z]) = (eye.0.map(i64::from), target.0.map(i64::from));
    // Magnitudes of vectors stay below 2^33, of their products with ratios below 2^63; partial sums can wrap around.
    let (x, y, z) = (
        x.wrapping_sub(from_x),
        y.wrapping_sub(from_y),
        z.wrapping_sub(from_z),
    );
    let rounded = |products: i64| products.wrapping_add(1 << 29) >> 30;
    let sum = |a: i64, b: i64| a.wrapping_add(b);
    let along = sum(
        sum(axis_x.wrapping_mul(x), axis_y.wrapping_mul(y)),
        axis_z.wrapping_mul(z),
    );
    let along = rounded(along);
    let turned = |place: i64, from: i64, axis: i64, across: i64| {
        // The part along the axis stays.
        let stays = rounded(axis.wrapping_mul(along));
        let turns = place.wrapping_sub(stays);
        let turned = rounded(sum(
            turns.wrapping_mul(cosine),
            rounded(across).wrapping_mul(sine),
        ));
        i32::try_from(sum(sum(from, stays), turned)).map_err(|_| CameraError::EyeOutOfRange)
    };
    let minus = |a: i64, b: i64| a.wrapping_sub(b);
    Ok(Position([
        turned(
            x,
            from_x,
            axis_x,
            minus(axis_y.wrapping_mul(z), axis_z.wrapping_mul(y)),
        )?,
        turned(
            y,
            from_y,
            axis_y,
            minus(axis_z.wrapping_mul(x), axis_x.wrapping_mul(z)),
        )?,
        turned(
            z,
            from_z,
            axis_z,
            minus(axis_x.wrapping_mul(y), axis_y.wrapping_mul(x)),
        )?,
    ]))
}
