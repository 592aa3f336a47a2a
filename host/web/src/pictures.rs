//! Errors between pictures, maps, files.

use crate::Answer;
use crate::loaded::Loaded;
use crate::problem::Problem;
use gridel_core::render::Pixel;
use gridel_core::{Format, Rgb888, Settings, Structure};
use gridel_host::measure::{difference_picture, rmse_and_largest};
use gridel_host::picture::{PictureFormat, RenderMetadata};
use gridel_host::render::{Job, Picture};
use gridel_host::report::work_color;
use serde_json::json;
use std::collections::BTreeMap;

/// Linear pixels: three channels of 16 bits.
fn pixels(bytes: &[u8]) -> Vec<[u16; 3]> {
    bytemuck::pod_collect_to_vec(bytes)
}

/// Returns two pictures of the same size: a reference, and one to compare with it.
fn pair(bytes: &[u8]) -> [Vec<[u16; 3]>; 2] {
    let (reference, picture) = bytes.split_at(bytes.len() / 2);
    [pixels(reference), pixels(picture)]
}

/// Compares a picture with a reference.
pub fn errors(bytes: &[u8]) -> Answer {
    let [reference, picture] = pair(bytes);
    let [rmse, largest] = rmse_and_largest(&reference, &picture);
    let shown = |linear: &[u16; 3]| Rgb888::encode(*linear, None).0;
    let pairs = reference.iter().zip(&picture);
    let different = pairs.filter(|(a, b)| shown(a) != shown(b)).count();
    let all = picture.len().max(1);
    Ok((
        json!({
            "rmse": rmse,
            "largest": largest,
            "different": different,
            "share": different as f64 / all as f64,
        }),
        Vec::new(),
    ))
}

/// Shows how a picture differs from a reference.
pub fn difference(bytes: &[u8]) -> Answer {
    let [reference, picture] = pair(bytes);
    Ok((json!({}), difference_picture(&reference, &picture)))
}

/// Colors work; black is no work.
pub fn heat_map(bytes: &[u8]) -> Answer {
    let work: Vec<u32> = bytemuck::pod_collect_to_vec(bytes);
    let maximum = work.iter().copied().max().unwrap_or(0);
    // Many pixels have the same work.
    let mut colors = BTreeMap::new();
    let mut color = |work| {
        *colors
            .entry(work)
            .or_insert_with(|| work_color(work, maximum).0)
    };
    let map = work.iter().flat_map(|&work| color(work)).collect();
    Ok((json!({"maximum": maximum}), map))
}

/// The file that `gridel render` writes.
pub fn png(loaded: &Loaded, [width, height]: [u16; 2], bytes: &[u8]) -> Answer {
    let scene = loaded.scene();
    let settings = Settings {
        width,
        height,
        ..Settings::of(scene)
    };
    let picture = Picture {
        width,
        height,
        rows: 0..height,
        pixels: pixels(bytes),
        counters: None,
        work: Vec::new(),
    };
    // The file of a whole picture states none of these.
    let job = Job::whole(Format::F32, Structure::List, settings);
    let metadata = RenderMetadata::of(scene, &job);
    let mut file = Vec::new();
    let written = PictureFormat::Png.write(&mut file, &picture, &metadata);
    written.map_err(Problem::fault)?;
    Ok((json!({}), file))
}
