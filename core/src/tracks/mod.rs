//! Tracks: changes of the camera, lights, materials, instances and meshes of a blob with time.
//!
//! A blob can hold tracks, each of which gives a property values at certain times. [`Tracks`] reads them in place, and
//! computes the state at any time in integers: the same on every machine and in every number format. A changed scene
//! borrows the state in the same way as a program's own values. See [`Scene::with_view`](crate::Scene::with_view),
//! [`with_lights`](crate::Scene::with_lights), [`with_materials`](crate::Scene::with_materials) and
//! [`with_poses`](crate::Scene::with_poses); weights of morph targets are for
//! [`Deformation::morph`](crate::deform::DeformationIn::morph).

mod check;
mod interpolate;
mod joints;
mod records;
mod state;

use crate::format::instance::Instance;
use crate::format::record::{Light, Material};
use crate::format::track::{Timeline, Track};
use crate::format::{BlobError, SectionKind, Sections};
use crate::scene::header;
use records::Records;

/// The tracks of a blob, read in place.
///
/// [`Scene::from_bytes`](crate::Scene::from_bytes) ignores them, so a program that does not use tracks costs only the
/// bytes of their sections. [`Scene`](crate::Scene) and tracks are independent: a time changes nothing until a scene is
/// given its state.
///
/// Times are ticks, [`ticks_per_second`](Self::ticks_per_second) of them in a second. Before the first key of a track
/// its first value holds, and behind the last key the last one.
///
/// ```
/// use gridel_core::format::record::Light;
/// use gridel_core::{BlobError, Scene, Tracks};
///
/// /// The radiance of the first light, halfway through the tracks.
/// fn halfway(blob: &[u8]) -> Result<[i32; 3], BlobError> {
///     let scene = Scene::from_bytes(blob)?;
///     let tracks = Tracks::from_bytes(blob)?;
///     let [first, last] = tracks.span();
///     let mut lights = [scene.lights()[0]];
///     tracks.lights_at(&scene, first.midpoint(last), &mut lights)?;
///     Ok(scene.with_lights(&lights)?.lights()[0].color)
/// }
/// # static BLOB: &[u8] =
/// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
/// // In a blob without tracks nothing moves.
/// assert_eq!(halfway(BLOB)?, Scene::from_bytes(BLOB)?.lights()[0].color);
/// # Ok::<(), BlobError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Tracks<'a>(Records<'a>);

/// The timeline of a blob without tracks.
const STILL: Timeline = Timeline {
    ticks_per_second: 1,
    first: 0,
    last: 0,
};

impl<'a> Tracks<'a> {
    /// Checks the tracks of a blob and returns them. A blob without tracks is valid; the result is then empty.
    ///
    /// Proves that tracks use all keys and words in their order, that times ascend, and that every value is in its
    /// range. Proves also that lights, materials, joints and morph targets exist, and that joints hang on those before
    /// them. A moving camera has all tracks that it needs. Costs time linear in the number of keys.
    ///
    /// # Errors
    /// If a proof fails, or the header or the section table is invalid.
    pub fn from_bytes(blob: &'a [u8]) -> Result<Self, BlobError> {
        let header = header(blob)?;
        let sections = Sections::read(blob, header.section_count)?;
        let timelines: &[Timeline] = sections.records(SectionKind::Timeline)?;
        let tracks: &[Track] = sections.records(SectionKind::Tracks)?;
        let expected = usize::from(!tracks.is_empty());
        if timelines.len() != expected {
            return Err(BlobError::Count {
                section: SectionKind::Timeline,
                found: timelines.len(),
                expected,
            });
        }
        let records = Records {
            timeline: timelines.first().copied().unwrap_or(STILL),
            tracks,
            times: sections.records(SectionKind::TrackTimes)?,
            words: sections.records(SectionKind::TrackWords)?,
            joints: sections.records(SectionKind::Joints)?,
            instance_joints: sections.records(SectionKind::InstanceJoints)?,
            weights: sections.records(SectionKind::MorphWeights)?,
        };
        let lights: &[Light] = sections.records(SectionKind::Lights)?;
        let materials: &[Material] = sections.records(SectionKind::Materials)?;
        check::check(&records, lights, materials.len())?;
        let instances: &[Instance] = sections.records(SectionKind::Instances)?;
        check::check_joints(&records, instances.len())?;
        Ok(Self(records))
    }

    /// Returns true if the blob has no tracks: its scene is the same at all times.
    pub fn is_empty(&self) -> bool {
        self.0.tracks.is_empty()
    }

    /// Returns the tracks, in the order of their targets and numbers.
    pub fn tracks(&self) -> &'a [Track] {
        self.0.tracks
    }

    /// Ticks per second; 1 in a blob without tracks.
    pub fn ticks_per_second(&self) -> u32 {
        self.0.timeline.ticks_per_second
    }

    /// Returns the times of the earliest and of the latest key; 0 in a blob without tracks.
    pub fn span(&self) -> [i32; 2] {
        [self.0.timeline.first, self.0.timeline.last]
    }

    /// Returns the time of a frame, given the number of frames per second: the nearest tick to
    /// `number / per_second` seconds, at most the last possible one. A rate of 0 counts as 1.
    ///
    /// ```
    /// # static BLOB: &[u8] =
    /// #     gridel_core::include_blob!(concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel"));
    /// let tracks = gridel_core::Tracks::from_bytes(BLOB)?;
    /// // A tick is a second here.
    /// assert_eq!(tracks.frame_time(48, 24), 2);
    /// assert_eq!(tracks.frame_time(u32::MAX, 1), i32::MAX);
    /// # Ok::<(), gridel_core::BlobError>(())
    /// ```
    pub fn frame_time(&self, number: u32, per_second: u32) -> i32 {
        let rate = u64::from(per_second.max(1));
        // Below 2^63.
        let ticks = u64::from(number) * u64::from(self.0.timeline.ticks_per_second);
        let nearest = ticks.wrapping_add(rate / 2) / rate;
        nearest.min(i32::MAX as u64) as i32
    }
}
