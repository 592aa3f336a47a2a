//! Loads a scene, traces a ray and renders a picture:
//!
//! ```text
//! cargo run --release --example quickstart -- fixtures/glass-chess.toml picture.png
//! ```

use glam::DVec3;
use gridel_core::{Format, Rgb888, Settings, Structure, render::Pixel};
use gridel_host::compile::{Options, compile};
use gridel_host::picture::write_png;
use gridel_host::render::{Job, render};
use gridel_host::scene::{MoleculeOptions, load};
use gridel_host::trace::{Query, SceneHit, SceneRay, trace};
use std::error::Error;
use std::fs::File;
use std::path::Path;

/// Traces a ray straight down, and renders the scene's own picture.
pub fn run(scene_file: &Path, picture_file: &Path) -> Result<SceneHit, Box<dyn Error>> {
    let imported = load(scene_file, &MoleculeOptions::default())?;
    let blob = compile(&imported.scene, &Options::default())?.blob;
    let scene = blob.scene()?;

    let ray = SceneRay {
        origin: DVec3::new(0.5, 100.0, 0.5),
        tmin: 0.0,
        direction: DVec3::NEG_Y,
        tmax: f64::INFINITY,
    };
    let (format, structure) = (Format::F32, Structure::DualSplit);
    let query = Query {
        format,
        structure,
        any: false,
    };
    let mut hits = [SceneHit::MISS];
    trace(&scene, &[ray], query, &mut hits)?;

    let job = Job::whole(format, structure, Settings::of(&scene));
    let picture = render(&scene, &job, &|| ())?;
    let encoded = picture
        .pixels
        .iter()
        .map(|&linear| Rgb888::encode(linear, None).0);
    let pixels: Vec<u8> = encoded.flatten().collect();
    let size = [picture.width.into(), picture.rows.len() as u32];
    write_png(&mut File::create(picture_file)?, size, &pixels, None)?;
    Ok(hits[0])
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut files = std::env::args_os().skip(1);
    let (Some(scene), Some(picture)) = (files.next(), files.next()) else {
        return Err("usage: quickstart SCENE PICTURE.png".into());
    };
    let hit = run(scene.as_ref(), picture.as_ref())?;
    println!("object {} at distance {}", hit.object, hit.t);
    Ok(())
}
