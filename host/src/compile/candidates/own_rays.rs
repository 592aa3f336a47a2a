//! The rays that a scene's own picture casts, as points in the space of rays.

use crate::compile::error::CompileError;
use crate::compile::instances::Role;
use crate::compile::options::Options;
use crate::compile::structures::context::BuildContext;
use crate::compile::structures::layout::Layout;
use crate::compile::writer;
use crate::picture_rays::PictureRays;
use gridel_core::shared::ClassPoint;
use gridel_core::{Scene, Settings, Structure};

/// Pixels along the longer side of the picture whose rays are taken.
const LONGER_SIDE: u32 = 160;

/// Traces the rays of the scene's own picture, through a blob with the hierarchy only. There are none where they
/// are too many to keep.
pub fn own_rays(context: &BuildContext<'_>) -> Result<Vec<ClassPoint>, CompileError> {
    let hierarchy = Layout::flagged(context.flat);
    let options = Options {
        structures: vec![Structure::Flagged],
        ..context.options.clone()
    };
    // Parts have the structures of the scene that holds them.
    let parts = match context.role {
        Role::Whole(parts) if parts.primitives() > 0 => Some((context.parts_with)(&options)?),
        _ => None,
    };
    let role = match &parts {
        Some(parts) => Role::Whole(parts),
        None => context.role,
    };
    let context = BuildContext { role, ..*context };
    let blob = writer::write(writer::contents(&context, vec![hierarchy]))?;
    Ok(rays_of(&blob.scene()?))
}

/// Returns the rays of a small picture of a scene, of all kinds. The scene must hold flagged pairs.
/// Returns none where there are too many to keep.
fn rays_of(scene: &Scene<'_>) -> Vec<ClassPoint> {
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
