//! The rays that a scene's own picture casts, as points in the space of rays.

use crate::picture_rays::PictureRays;
use gridel_core::shared::ClassPoint;
use gridel_core::{Scene, Settings};

/// Pixels along the longer side of the picture whose rays are taken.
const LONGER_SIDE: u32 = 160;

/// Returns the rays of a small picture of a scene, of all kinds. The scene must hold flagged pairs.
/// Returns none where there are too many to keep.
pub fn own_rays(scene: &Scene<'_>) -> Vec<ClassPoint> {
    let settings = Settings::of(scene);
    let [width, height] = [settings.width, settings.height].map(u32::from);
    let smaller = |side: u32| (side * LONGER_SIDE).div_ceil(width.max(height)).max(1) as u16;
    let settings = Settings {
        width: smaller(width),
        height: smaller(height),
        samples: 1,
        ..settings
    };
    let rays = PictureRays::<f32>::of(scene, settings).unwrap_or_default();
    let all = [rays.primary, rays.shadow, rays.bounced];
    let points = all.iter().flatten();
    points
        .filter_map(|ray| ClassPoint::of(scene.bounds(), ray))
        .collect()
}
