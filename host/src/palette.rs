//! Few colors in place of many.

use std::cmp::Reverse;
use std::collections::HashMap;

/// A color and its alpha, or another four numbers.
type Rgba = [u8; 4];

/// Returns the squared perceived distance of two colors.
pub(crate) fn distance(a: &Rgba, b: &Rgba) -> u32 {
    let apart = |k: usize| u32::from(a[k].abs_diff(b[k])).pow(2);
    // Green looks brightest, and blue darkest.
    3 * apart(0) + 6 * apart(1) + apart(2) + 6 * apart(3)
}

/// The number of the color of a palette that is nearest to each pixel; of equal ones the first.
pub(crate) fn nearest(palette: &[Rgba], pixels: &[Rgba]) -> Vec<u8> {
    let mut known: HashMap<Rgba, u8> = HashMap::new();
    let number = |pixel: &Rgba| {
        *known.entry(*pixel).or_insert_with(|| {
            let entries = (0..).zip(palette);
            let best = entries.min_by_key(|(_, entry)| distance(pixel, entry));
            best.map_or(0, |(number, _): (usize, _)| number as u8)
        })
    };
    pixels.iter().map(number).collect()
}

/// At most so many colors for pixels: all of theirs, or the means of boxes by Heckbert's median cut (1982).
pub(crate) fn median_cut(pixels: &[Rgba], most: usize) -> Vec<Rgba> {
    let mut counts: HashMap<Rgba, u64> = HashMap::new();
    for pixel in pixels {
        *counts.entry(*pixel).or_default() += 1;
    }
    let mut all: Vec<(Rgba, u64)> = counts.into_iter().collect();
    all.sort_unstable();
    let mut boxes = vec![(sides(&all), all)];
    while boxes.len() < most {
        // The longest side of all boxes is cut.
        let all_sides = boxes.iter().enumerate().flat_map(|(number, (sides, _))| {
            [0, 1, 2, 3].map(|k: usize| (sides[k], Reverse(number), k))
        });
        let Some((1.., Reverse(number), axis)) = all_sides.max() else {
            break;
        };
        let (_, mut colors) = std::mem::take(&mut boxes[number]);
        colors.sort_unstable_by_key(|(color, _)| (color[axis], *color));
        let half = colors.iter().map(|(_, count)| count).sum::<u64>() / 2;
        let mut sum = 0;
        let middle = colors.iter().position(|(_, count)| {
            sum += count;
            sum > half
        });
        let middle = middle.unwrap_or(1).clamp(1, colors.len() - 1);
        let others = colors.split_off(middle);
        boxes.push((sides(&others), others));
        boxes[number] = (sides(&colors), colors);
    }
    let mean = |colors: &Vec<(Rgba, u64)>| {
        let count: u64 = colors.iter().map(|(_, count)| count).sum();
        [0, 1, 2, 3].map(|k: usize| {
            let sum: u64 = colors
                .iter()
                .map(|(color, count)| u64::from(color[k]) * count)
                .sum();
            ((sum + count / 2) / count.max(1)) as u8
        })
    };
    let boxes = boxes.iter().map(|(_, colors)| colors);
    boxes.filter(|it| !it.is_empty()).map(mean).collect()
}

/// The sides of the box around colors.
fn sides(colors: &[(Rgba, u64)]) -> Rgba {
    [0, 1, 2, 3].map(|k: usize| {
        let channel = colors.iter().map(|(color, _)| color[k]);
        let highest = channel.clone().max().unwrap_or(0);
        highest - channel.min().unwrap_or(0)
    })
}
