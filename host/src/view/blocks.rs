//! Pixels of a picture, one by one: what all front ends draw with.

use super::shot::{Shot, ViewError};
use crate::render::{Job, chosen, tracer};
use gridel_core::Scene;
use gridel_core::render::Block;
use std::slice::from_ref;

/// The pixel of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Drawn {
    /// Linear, 65535 being white.
    pub linear: [u16; 3],
    /// Boxes and primitives tested, for a heat map.
    pub work: Option<u32>,
}

/// Draws the pixels of some blocks on this thread, in the order of the blocks. It is for front ends without threads, or
/// with their own distribution of blocks. A pixel equals that of [`render`](crate::render::render), bit for bit.
///
/// # Errors
/// If the blob lacks the structure, a setting is out of its range, or the scene cannot be seen with the view.
///
/// ```
/// # use gridel_host::compile::{Options, compile};
/// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
/// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// # let blob = compile(&imported.scene, &Options::default())?.blob;
/// # let scene = blob.scene()?;
/// use gridel_core::render::CoarseToFine;
/// use gridel_core::{Format, Settings, Structure};
/// use gridel_host::view::{Shot, draw};
///
/// let settings = Settings { width: 16, height: 12, ..Settings::of(&scene) };
/// let shot = Shot {
///     view: *scene.view(),
///     format: Format::F32,
///     structure: Structure::DualSplit,
///     settings,
///     heat_map: false,
/// };
/// let mut drawn = 0;
/// draw(&scene, &shot, CoarseToFine::new([0, 0], [16, 12]), |_block, _pixel| drawn += 1)?;
/// assert_eq!(drawn, 16 * 12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn draw(
    scene: &Scene<'_>,
    shot: &Shot,
    blocks: impl IntoIterator<Item = Block>,
    mut put: impl FnMut(Block, Drawn),
) -> Result<(), ViewError> {
    with_brush(scene, shot, |brush| {
        for block in blocks {
            put(block, brush(block));
        }
    })
}

/// Draws the pixel of a block.
pub(super) type Brush<'b> = dyn Fn(Block) -> Drawn + 'b;

/// Calls a function with what draws the pixels of a picture.
pub(super) fn with_brush<R>(
    scene: &Scene<'_>,
    shot: &Shot,
    paint: impl FnOnce(&Brush<'_>) -> R,
) -> Result<R, ViewError> {
    let scene = scene.with_view(&shot.view)?;
    let scene = chosen(&scene, shot.structure)?;
    let job = Job {
        count: shot.heat_map,
        ..Job::whole(shot.format, shot.structure, shot.settings)
    };
    let tracer = tracer(from_ref(&scene), &job)?;
    Ok(paint(&|block| {
        let mut pixel = [[0; 3]];
        let cost = tracer([block.x, block.y], &mut pixel);
        Drawn {
            linear: pixel[0],
            work: cost.and_then(|(_, work)| work.first().copied()),
        }
    }))
}
