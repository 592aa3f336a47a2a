//! Orders of the pixels of a rectangle: row by row, and from coarse to fine.

/// Row by row from the upper left corner: the order of [`Renderer::cursor`](crate::Renderer::cursor).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rows {
    /// The next pixel.
    pub(super) pixel: [u16; 2],
    /// The first column and the last.
    columns: [u16; 2],
    /// Rows that remain.
    rows: u16,
}

impl Rows {
    pub(super) fn new(corner: [u16; 2], [width, height]: [u16; 2]) -> Self {
        // There are no pixels beyond number 65535.
        let [x, y] = corner;
        let rows = if y == 0 {
            height
        } else {
            height.min((u16::MAX - y).saturating_add(1))
        };
        Self {
            pixel: corner,
            columns: [x, x.saturating_add(width.saturating_sub(1))],
            rows: if width == 0 { 0 } else { rows },
        }
    }

    #[inline(always)]
    pub(super) fn is_done(&self) -> bool {
        self.rows == 0
    }

    #[inline(always)]
    pub(super) fn advance(&mut self) {
        let [x, y] = self.pixel;
        let [first, last] = self.columns;
        self.pixel = if x < last {
            [x.saturating_add(1), y]
        } else {
            self.rows = self.rows.saturating_sub(1);
            [first, y.saturating_add(1)]
        };
    }
}

/// The pixel in the upper left corner of a block, and the size of the block that shows its color until finer pixels
/// follow. Blocks end where the rectangle ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Block {
    /// The pixel's column.
    pub x: u16,
    /// The pixel's row.
    pub y: u16,
    /// Columns of the block, 1 to 8.
    pub width: u16,
    /// Rows of the block, 1 to 8.
    pub height: u16,
}

/// The pixels of a rectangle from coarse to fine. First comes one pixel in 64, for blocks of 8 x 8. Then come the
/// others of one in 16, for blocks of 4 x 4, and so on to single pixels. Every pixel comes once.
///
/// The blocks in this order draw the whole rectangle 64 times as fast as all pixels do, and refine it in place. No
/// block covers an earlier pixel, except its own. The next block takes some 20 instructions and no memory except these
/// 14 bytes.
///
/// ```
/// use gridel_core::render::{Block, CoarseToFine};
///
/// let blocks: Vec<Block> = CoarseToFine::new([0, 0], [10, 7]).collect();
/// assert_eq!(blocks.len(), 70);
/// // Two blocks cover all of it; the second ends with the rectangle.
/// let first = Block { x: 0, y: 0, width: 8, height: 7 };
/// let second = Block { x: 8, y: 0, width: 2, height: 7 };
/// assert_eq!(blocks[..2], [first, second]);
/// // The lower right pixel comes last, unless its row and column are even.
/// assert_eq!(blocks[69], Block { x: 9, y: 6, width: 1, height: 1 });
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CoarseToFine {
    corner: [u16; 2],
    size: [u16; 2],
    /// The next pixel, from the corner.
    next: [u16; 2],
    /// The side of its block: 8, 4, 2 or 1; 0 after all pixels.
    side: u16,
}

/// The side of the first blocks.
const COARSEST: u16 = 8;

impl CoarseToFine {
    /// Returns the pixels of a rectangle, without those beyond number 65535.
    pub fn new(corner: [u16; 2], size: [u16; 2]) -> Self {
        let [x, y] = corner;
        let [width, height] = size;
        let room = |first: u16| (u16::MAX - first).saturating_add(1);
        let size = [width.min(room(x)), height.min(room(y))];
        Self {
            corner,
            size,
            next: [0; 2],
            side: if size.contains(&0) { 0 } else { COARSEST },
        }
    }

    /// Returns the side of the next blocks: 8, 4, 2 or 1, and 0 after all pixels.
    pub fn side(&self) -> u16 {
        self.side
    }

    /// Returns the next block; `None` after all pixels.
    #[inline]
    pub(super) fn block(&self) -> Option<Block> {
        if self.side == 0 {
            return None;
        }
        let end = |k: usize| self.size[k].saturating_sub(self.next[k]).min(self.side);
        Some(Block {
            x: self.corner[0].saturating_add(self.next[0]),
            y: self.corner[1].saturating_add(self.next[1]),
            width: end(0),
            height: end(1),
        })
    }

    /// Moves on to the next block.
    #[inline]
    pub(super) fn advance(&mut self) {
        let [width, height] = self.size;
        let [x, y] = self.next;
        let mut side = self.side;
        // Where rows of coarser blocks begin, every second pixel came with those blocks.
        let holds_coarser = |y: u16, side: u16| side < COARSEST && y & side == 0;
        let stride = side << u32::from(holds_coarser(y, side));
        let mut place = match x.checked_add(stride) {
            Some(x) => [x, y],
            None => [width, y],
        };
        // Rows that hold only coarser pixels are skipped, and so are passes of such rows. That is at most two steps for
        // each side of blocks.
        while place[0] >= width {
            let y = match place[1].checked_add(side).filter(|&y| y < height) {
                Some(y) => y,
                None => {
                    side >>= 1;
                    if side == 0 {
                        break;
                    }
                    0
                }
            };
            place = [if holds_coarser(y, side) { side } else { 0 }, y];
        }
        (self.next, self.side) = (place, side);
    }
}

impl Iterator for CoarseToFine {
    type Item = Block;

    fn next(&mut self) -> Option<Block> {
        let block = self.block()?;
        self.advance();
        Some(block)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Draws a rectangle, and checks the order, the blocks, and that each pass covers everything.
    fn check(corner: [u16; 2], size: [u16; 2]) {
        let [width, height] = size.map(usize::from);
        let at = |x: usize, y: usize| y * width + x;
        let mut came = vec![false; width * height];
        let mut order = CoarseToFine::new(corner, size);
        for side in [8, 4, 2, 1] {
            let wide = usize::from(side);
            let mut covered = vec![false; width * height];
            let mut fill = |x: usize, y: usize| {
                for y in y..height.min(y + wide) {
                    covered[at(x, y)..at(width.min(x + wide), y)].fill(true);
                }
            };
            // Earlier pixels stay in their own blocks.
            for place in (0..width * height).filter(|&it| came[it]) {
                fill(place % width, place / width);
            }
            while order.side() == side {
                let block = order.next().unwrap();
                let [x, y] = [block.x - corner[0], block.y - corner[1]];
                assert_eq!([x % side, y % side], [0, 0]);
                let rest = [size[0] - x, size[1] - y].map(|rest| rest.min(side));
                assert_eq!([block.width, block.height], rest, "{size:?} {block:?}");
                let [x, y] = [x, y].map(usize::from);
                for row in y..y + usize::from(block.height) {
                    let hidden = &came[at(x, row)..][..block.width.into()];
                    assert!(!hidden.contains(&true), "{size:?}: {block:?} hides a pixel");
                }
                fill(x, y);
                came[at(x, y)] = true;
            }
            assert!(!covered.contains(&false), "{size:?} {side}");
            let blocks = width.div_ceil(wide) * height.div_ceil(wide);
            let count = came.iter().filter(|it| **it).count();
            assert_eq!(count, blocks, "{size:?} {side}");
        }
        assert_eq!((order.next(), order.side()), (None, 0));
    }

    #[test]
    fn coarse_to_fine_has_every_pixel_once_and_refines_in_place() {
        for width in 1..=19 {
            for height in 1..=19 {
                check([0, 0], [width, height]);
            }
        }
        for size in [
            [64, 48],
            [1, 300],
            [u16::MAX, 1],
            [1, u16::MAX],
            [u16::MAX, 9],
        ] {
            check([0, 0], size);
        }
        check([3, 5], [17, 9]);
    }

    #[test]
    fn coarse_to_fine_ends_with_pixel_65535() {
        let end = u16::MAX;
        let places = |corner, size| {
            let blocks = CoarseToFine::new(corner, size);
            let places: Vec<_> = blocks.map(|block| [block.x, block.y]).collect();
            places
        };
        assert_eq!(places([end, end], [end, end]), [[end, end]]);
        assert_eq!(places([end - 1, 7], [9, 1]), [[end - 1, 7], [end, 7]]);
        assert_eq!(places([0, end], [1, 2]), [[0, end]]);
        for size in [[0, 0], [0, 5], [5, 0]] {
            assert!(places([0, 0], size).is_empty());
        }
        check([end - 20, end - 8], [21, 9]);
    }
}
