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
    /// The longer side of the block that filled each pixel of this picture, 255 where none has.
    sides: Vec<u8>,
    /// For a heat map, the greatest number of tests of a pixel.
    maximum: Option<u32>,
}

/// Up to this maximum, colors come from a table and are not computed for each pixel.
const MOST_LOOKED_UP: u32 = 1 << 12;

impl Frame {
    /// Makes room for another picture. One of the same size and kind stays until it is drawn over.
    pub(super) fn prepare(&mut self, [width, height]: [u16; 2], is_heat_map: bool) {
        if [self.width, self.height] != [width, height] || self.maximum.is_some() != is_heat_map {
            self.values = vec![0; usize::from(width) * usize::from(height)];
        }
        self.sides.clear();
        self.sides.resize(self.values.len(), u8::MAX);
        (self.width, self.height) = (width, height);
        self.maximum = is_heat_map.then_some(0);
    }

    /// Fills a block with the color or the work of its pixel, except where a finer block of this picture came
    /// before.
    pub(super) fn fill(&mut self, block: Block, value: u32) {
        self.maximum = self.maximum.map(|maximum| maximum.max(value));
        let side = block.width.max(block.height) as u8;
        for y in block.y..block.y + block.height {
            let first = usize::from(y) * usize::from(self.width) + usize::from(block.x);
            let row = first..first + usize::from(block.width);
            let before = self.sides[row.clone()].iter_mut();
            for (before, shown) in before.zip(&mut self.values[row]) {
                if *before >= side {
                    (*before, *shown) = (side, value);
                }
            }
        }
    }

    /// Returns the colors of all pixels, row by row, as 0x00RRGGBB.
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

impl Frame {
    /// Copies the colors to a picture of a size above 0, stretched if it has another one.
    pub fn stretch(&self, to: &mut [u32], [width, height]: [usize; 2]) {
        let own = [self.width, self.height].map(usize::from);
        if own.contains(&0) {
            return to.fill(0);
        }
        let colors: Vec<u32> = self.colors().collect();
        if own == [width, height] {
            return to.copy_from_slice(&colors);
        }
        for (y, row) in to.chunks_mut(width).enumerate() {
            let from = &colors[y * own[1] / height * own[0]..][..own[0]];
            for (x, pixel) in row.iter_mut().enumerate() {
                *pixel = from[x * own[0] / width];
            }
        }
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
    fn blocks_fill_their_part_except_where_finer_ones_are() {
        let mut frame = Frame::default();
        frame.prepare([5, 3], false);
        let block = |x, y, width, height| Block {
            x,
            y,
            width,
            height,
        };
        frame.fill(block(4, 0, 1, 3), 8);
        frame.fill(block(2, 1, 2, 2), 9);
        // A thread that was late.
        frame.fill(block(0, 0, 4, 3), 7);
        let colors: Vec<_> = frame.colors().collect();
        assert_eq!(colors, [7, 7, 7, 7, 8, 7, 7, 9, 9, 8, 7, 7, 9, 9, 8]);
        // The next picture of the same size is drawn over this one.
        frame.prepare([5, 3], false);
        assert!(frame.colors().eq(colors));
        frame.fill(block(0, 0, 4, 3), 6);
        assert_eq!(frame.colors().filter(|color| *color == 6).count(), 12);
        frame.prepare([3, 5], false);
        assert!(frame.colors().all(|color| color == 0));
    }

    /// Drawn in the worst order, all pixels are their own.
    #[test]
    fn order_of_blocks_does_not_matter_in_the_end() {
        for size in [[1, 1], [3, 3], [19, 13], [8, 1], [2, 17]] {
            let mut frame = Frame::default();
            frame.prepare(size, false);
            let mut blocks: Vec<_> = gridel_core::render::CoarseToFine::new([0, 0], size).collect();
            blocks.reverse();
            let value = |x: u16, y: u16| 100 * u32::from(y) + u32::from(x);
            for block in blocks {
                frame.fill(block, value(block.x, block.y));
            }
            let places = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
            assert!(
                frame.colors().eq(places.map(|(x, y)| value(x, y))),
                "{size:?}"
            );
        }
    }

    #[test]
    fn frame_of_another_size_fills_the_picture() {
        let stretched = |from: &[u32], size, to_size: [usize; 2]| {
            let mut frame = Frame::default();
            frame.prepare(size, false);
            for (x, &value) in (0..).zip(from) {
                let [width, height] = [1; 2];
                let (x, y) = (x % size[0], x / size[0]);
                frame.fill(
                    Block {
                        x,
                        y,
                        width,
                        height,
                    },
                    value,
                );
            }
            let mut to = vec![9; to_size[0] * to_size[1]];
            frame.stretch(&mut to, to_size);
            to
        };
        assert_eq!(stretched(&[1, 2, 3, 4], [2, 2], [2, 2]), [1, 2, 3, 4]);
        assert_eq!(stretched(&[1, 2], [2, 1], [4, 2]), [1, 1, 2, 2, 1, 1, 2, 2]);
        assert_eq!(stretched(&[1, 2, 3, 4], [2, 2], [1, 1]), [1]);
        assert_eq!(stretched(&[], [0, 0], [2, 1]), [0, 0]);
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
