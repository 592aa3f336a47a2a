//! The pixels that are shown so far: colors, or the work of a heat map.

use crate::report::work_color;
use gridel_core::Rgb888;
use gridel_core::render::Block;

/// A picture that is being drawn.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Frame {
    pub width: u16,
    pub height: u16,
    /// Row by row: colors as 0x00RRGGBB, or boxes and primitives tested.
    values: Vec<u32>,
    /// For a heat map, the most that any pixel had tested.
    maximum: Option<u32>,
}

/// Shares of the maximum up to this many are looked up, in place of computed for each pixel.
const MOST_LOOKED_UP: u32 = 1 << 12;

impl Frame {
    /// Makes room for another picture. One of the same size and kind stays until it is drawn over.
    pub(super) fn prepare(&mut self, [width, height]: [u16; 2], is_heat_map: bool) {
        if [self.width, self.height] != [width, height] || self.maximum.is_some() != is_heat_map {
            self.values = vec![0; usize::from(width) * usize::from(height)];
        }
        (self.width, self.height) = (width, height);
        self.maximum = is_heat_map.then_some(0);
    }

    /// Fills a block with the color or the work of its pixel.
    pub(super) fn fill(&mut self, block: Block, value: u32) {
        self.maximum = self.maximum.map(|maximum| maximum.max(value));
        let width = usize::from(self.width);
        let rows = self.values.chunks_mut(width.max(1));
        for row in rows.skip(block.y.into()).take(block.height.into()) {
            row[block.x.into()..][..block.width.into()].fill(value);
        }
    }

    /// The colors of all pixels, row by row, as 0x00RRGGBB.
    pub fn colors(&self) -> impl Iterator<Item = u32> + '_ {
        let color = |work, maximum: u32| packed(work_color(work, maximum));
        let looked_up: Vec<u32> = match self.maximum {
            Some(maximum) if maximum < MOST_LOOKED_UP => {
                (0..=maximum).map(|work| color(work, maximum)).collect()
            }
            _ => Vec::new(),
        };
        self.values.iter().map(move |&value| match self.maximum {
            None => value,
            // Pixels of the picture before can exceed this one's maximum.
            Some(maximum) => match looked_up.get(value as usize) {
                Some(&color) => color,
                None => color(value.min(maximum), maximum),
            },
        })
    }
}

/// A color as 0x00RRGGBB.
pub(super) fn packed(Rgb888([red, green, blue]): Rgb888) -> u32 {
    u32::from_be_bytes([0, red, green, blue])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_fill_their_part_alone() {
        let mut frame = Frame::default();
        frame.prepare([5, 3], false);
        let block = |x, y, width, height| Block {
            x,
            y,
            width,
            height,
        };
        frame.fill(block(0, 0, 4, 3), 7);
        frame.fill(block(4, 0, 1, 3), 8);
        frame.fill(block(2, 1, 2, 2), 9);
        let colors: Vec<_> = frame.colors().collect();
        assert_eq!(colors, [7, 7, 7, 7, 8, 7, 7, 9, 9, 8, 7, 7, 9, 9, 8]);
        // The next picture of the same size is drawn over this one.
        frame.prepare([5, 3], false);
        assert_eq!(frame.colors().next(), Some(7));
        frame.prepare([3, 5], false);
        assert!(frame.colors().all(|color| color == 0));
    }

    #[test]
    fn heat_maps_are_white_at_their_maximum() {
        for maximum in [1, 70, MOST_LOOKED_UP, 1 << 20] {
            let mut frame = Frame::default();
            frame.prepare([3, 1], true);
            for (x, work) in [(0, 0), (1, maximum / 2), (2, maximum)] {
                let block = Block {
                    x,
                    y: 0,
                    width: 1,
                    height: 1,
                };
                frame.fill(block, work);
            }
            let colors: Vec<_> = frame.colors().collect();
            let half = packed(work_color(maximum / 2, maximum));
            assert_eq!(colors[..2], [0, half], "{maximum}");
            assert_eq!(colors[2], packed(work_color(1, 1)), "{maximum}");
            // The maximum of a new map is its own.
            frame.prepare([3, 1], true);
            assert_eq!(frame.maximum, Some(0));
        }
    }
}
