//! The colors of texels that are not visible.
//!
//! Bilinear look-up mixes colors and alpha apart from each other. So the color of a texel without alpha shows at the
//! edges of what is visible, and many programs leave it black.

use super::stored::{COLORS, Raster, Roots};
use crate::palette::{median_cut, nearest};
use crate::scene::Wrap;
use std::collections::HashSet;

impl Raster {
    /// Gives texels without alpha the mean color of their neighbors, weighted by alpha. Those without a visible
    /// neighbor stay as they are. An image with few enough colors for a palette keeps few enough.
    pub(super) fn fill_hidden(&mut self, wrap: [Wrap; 2]) {
        let (places, mut colors): (Vec<usize>, Vec<Roots>) = (0..self.pixels.len())
            .filter(|&place| self.pixels[place][3] == 0)
            .filter_map(|place| Some((place, self.around(place, wrap)?)))
            .unzip();
        let room = self.room_for(&places, &colors);
        if let Some(room) = room {
            let few = median_cut(&colors, room);
            let numbers = nearest(&few, &colors);
            let of = numbers.into_iter().map(|it| few[usize::from(it)]);
            colors = of.collect();
        }
        if room != Some(0) {
            for (place, color) in places.into_iter().zip(colors) {
                self.pixels[place] = color;
            }
        }
    }

    /// Returns the mean color of the neighbors of a texel; `None` if none is visible.
    fn around(&self, place: usize, wrap: [Wrap; 2]) -> Option<Roots> {
        let (width, height) = (i64::from(self.width), i64::from(self.height));
        let (x, y) = (place as i64 % width, place as i64 / width);
        let along = |at: i64, size: i64, wrap: Wrap| match wrap {
            Wrap::Repeat => at.rem_euclid(size),
            Wrap::Mirror | Wrap::Clamp => at.clamp(0, size - 1),
        };
        let (mut sum, mut all) = ([0_u64; 3], 0);
        for row in y - 1..=y + 1 {
            for column in x - 1..=x + 1 {
                let at = along(row, height, wrap[1]) * width + along(column, width, wrap[0]);
                let [red, green, blue, alpha] = self.pixels[at as usize].map(u64::from);
                all += alpha;
                for (sum, root) in sum.iter_mut().zip([red, green, blue]) {
                    *sum += alpha * root * root;
                }
            }
        }
        let mean = |sum: u64| libm::sqrt(sum as f64 / all as f64).round() as u8;
        let [red, green, blue] = sum.map(mean);
        (all > 0).then_some([red, green, blue, 0])
    }

    /// Returns how many of the new colors of some texels leave the image few enough for a palette; `None` where all do,
    /// or where it has more already.
    fn room_for(&self, places: &[usize], colors: &[Roots]) -> Option<usize> {
        few(self.pixels.iter())?;
        let mut is_new = vec![false; self.pixels.len()];
        for &place in places {
            is_new[place] = true;
        }
        let others = self.pixels.iter().zip(&is_new).filter(|it| !it.1);
        let others = || others.clone().map(|(pixel, _)| pixel);
        match few(others().chain(colors)) {
            Some(_) => None,
            None => few(others()).map(|kept| COLORS - kept.len()),
        }
    }
}

/// Returns the different colors, if they are few enough for a palette.
fn few<'p>(pixels: impl Iterator<Item = &'p Roots>) -> Option<HashSet<Roots>> {
    let mut colors = HashSet::new();
    for pixel in pixels {
        colors.insert(*pixel);
        if colors.len() > COLORS {
            return None;
        }
    }
    Some(colors)
}

#[cfg(test)]
mod tests {
    use super::*;

    const RED: Roots = [200, 0, 0, 255];
    const HIDDEN: Roots = [0, 0, 0, 0];

    fn filled(width: u32, pixels: &[Roots], wrap: Wrap) -> Vec<Roots> {
        let mut raster = Raster {
            width,
            height: pixels.len() as u32 / width,
            pixels: pixels.to_vec(),
        };
        raster.fill_hidden([wrap; 2]);
        raster.pixels
    }

    #[test]
    fn hidden_texels_have_the_color_of_visible_neighbors() {
        let row = [RED, HIDDEN, HIDDEN, HIDDEN];
        let fill = [200, 0, 0, 0];
        assert_eq!(filled(4, &row, Wrap::Clamp), [RED, fill, HIDDEN, HIDDEN]);
        assert_eq!(filled(4, &row, Wrap::Mirror), [RED, fill, HIDDEN, HIDDEN]);
        // The last one is beside the first.
        assert_eq!(filled(4, &row, Wrap::Repeat), [RED, fill, HIDDEN, fill]);
        // A mean of linear light, by alpha.
        let between = filled(3, &[RED, HIDDEN, [0, 100, 0, 85]], Wrap::Clamp);
        assert_eq!(between[1], [173, 50, 0, 0]);
    }

    #[test]
    fn images_without_hidden_texels_keep_their_colors() {
        let row = [RED, [7, 8, 9, 1], [1, 2, 3, 255]];
        assert_eq!(filled(3, &row, Wrap::Repeat), row);
    }

    #[test]
    fn palettes_stay_palettes() {
        // Each visible color has a hidden texel beside it.
        let pixels = |colors: u8| -> Vec<Roots> {
            let pair = |it: u8| [[it, 255 - it, 7, 255], HIDDEN];
            (0..colors).flat_map(pair).collect()
        };
        for (colors, most) in [(100, 256), (200, 256), (255, 256)] {
            let before = pixels(colors);
            let after = filled(2, &before, Wrap::Clamp);
            let different: HashSet<Roots> = after.iter().copied().collect();
            assert!(different.len() <= most, "{}", different.len());
            assert_ne!(before, after);
            let visible = |all: &[Roots]| -> Vec<Roots> {
                all.iter().filter(|it| it[3] > 0).copied().collect()
            };
            assert_eq!(visible(&before), visible(&after));
        }
    }
}
