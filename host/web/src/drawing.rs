//! A picture that is being drawn.

use crate::loaded::Loaded;
use crate::problem::Problem;
use gridel_core::Rgb888;
use gridel_core::render::{Block, CoarseToFine, Pixel};
use gridel_host::view::{Drawn, Shot};
use gridel_web_draw::draw;

/// A worker's share of a picture.
pub struct Drawing {
    pub slot: usize,
    shot: Shot,
    blocks: Box<dyn Iterator<Item = Block>>,
    /// True if all blocks of the coarsest size are drawn.
    pub is_seen: bool,
}

/// The side of the coarsest blocks.
const COARSEST: u16 = 8;

impl Drawing {
    /// Returns the pixels of one worker, of `workers`.
    pub fn new(slot: usize, shot: Shot, [worker, workers]: [usize; 2]) -> Self {
        let size = [shot.settings.width, shot.settings.height];
        let blocks = CoarseToFine::new([0, 0], size);
        Self {
            slot,
            shot,
            blocks: Box::new(blocks.skip(worker).step_by(workers.max(1))),
            is_seen: false,
        }
    }

    /// Draws some more pixels: four words for each; none when all are drawn.
    pub fn step(&mut self, loaded: &Loaded, blocks: usize) -> Result<Vec<u8>, Problem> {
        let mut words: Vec<u32> = Vec::with_capacity(4 * blocks);
        let mut put = |block: Block, drawn: Drawn| {
            self.is_seen |= block.width.max(block.height) < COARSEST;
            words.extend(packed(block, &drawn));
        };
        let mut blocks = self.blocks.by_ref().take(blocks);
        draw(loaded.scene(), &self.shot, &mut blocks, &mut put)
            .map_err(|error| Problem::new(error, "choose other settings, or another structure"))?;
        Ok(bytemuck::cast_slice(&words).to_vec())
    }
}

fn packed(block: Block, drawn: &Drawn) -> [u32; 4] {
    let pair = |low: u16, high: u16| u32::from(low) | u32::from(high) << 16;
    let [red, green, blue] = drawn.linear;
    let Rgb888([r, g, b]) = Rgb888::encode(drawn.linear, None);
    let color = u32::from_le_bytes([r, g, b, 0]);
    [
        pair(block.x, block.y),
        drawn.work.unwrap_or(color),
        pair(red, green),
        pair(blue, block.width | block.height << 8),
    ]
}
