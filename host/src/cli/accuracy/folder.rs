//! The folder of results, which an interrupted run continues.

use crate::cli::failure::Failure;
use crate::cli::output::{of_another_run, write_file};
use gridel_host::accuracy::{PagePicture, Results};
use gridel_host::check::Image;
use gridel_host::picture::{srgb_of, write_png};
use std::path::{Path, PathBuf};

/// Files of the output folder.
pub const RESULTS: &str = "results.json";
pub const PAGE: &str = "page.html";
pub const CSV: &str = "results.csv";
pub const PLOT: &str = "rmse.svg";
/// The folder of pictures in it.
pub const PICTURES: &str = "pictures";

/// Returns the results of an earlier run with the same key. Results of other runs, and other files, are not replaced.
pub fn kept(folder: &Path, key: &str) -> Result<Option<Results>, Failure> {
    let file = folder.join(RESULTS);
    if !file.exists() {
        let others = [PAGE, CSV, PLOT].map(|name| folder.join(name));
        let pictures = std::fs::read_dir(folder.join(PICTURES))
            .into_iter()
            .flatten();
        let mut others = others
            .into_iter()
            .chain(pictures.flatten().map(|entry| entry.path()));
        return match others.find(|path| path.exists()) {
            Some(path) => Err(of_another_run(&path)),
            None => Ok(None),
        };
    }
    let bytes = std::fs::read(&file).map_err(|error| Failure::reading(&file, &error))?;
    match serde_json::from_slice::<Results>(&bytes) {
        Ok(mut results) if results.key == key => {
            // A setting whose pictures are missing is measured again.
            results.points.retain(|point| {
                let difference = format!("{}-difference", point.name);
                let mut pictures = [&point.name, &difference].into_iter();
                pictures.all(|name| picture(folder, name).exists())
            });
            Ok(Some(results))
        }
        Ok(_) => Err(of_another_run(&file)),
        Err(error) => Err(Failure::usage(
            format!(
                "{} holds no results of `gridel accuracy`, or not all of them ({error}): it would be overwritten",
                file.display()
            ),
            "give another folder with `-o`, or remove that one",
        )),
    }
}

/// The path of a picture.
fn picture(folder: &Path, name: &str) -> PathBuf {
    let pictures = folder.join(PICTURES);
    pictures.join(name).with_added_extension("png")
}

/// Writes a picture into the folder.
pub fn write_picture(
    folder: &Path,
    size: [u16; 2],
    name: &str,
    pixels: &[u8],
) -> Result<(), Failure> {
    let path = picture(folder, name);
    write_file(&path, |out| {
        write_png(out, size.map(u32::from), pixels, None)
    })
}

/// Returns the reference, and the pictures of all settings.
pub fn pictures(
    folder: &Path,
    size: [u16; 2],
    results: &Results,
) -> Result<Vec<PagePicture>, Failure> {
    let read = |name: &str| -> Result<Vec<u8>, Failure> {
        let path = picture(folder, name);
        let image = Image::read(&path).map_err(|error| Failure::reading(&path, &error))?;
        if image.size != size.map(u32::from) {
            let [width, height] = image.size;
            return Err(Failure::failed(
                format!(
                    "{}: the picture has {width} x {height} pixels, and its results are of another size",
                    path.display()
                ),
                "remove the folder, or name another",
            ));
        }
        Ok(image.pixels)
    };
    let mut pictures = vec![PagePicture {
        name: String::new(),
        pixels: srgb_of(&results.reference.pixels),
    }];
    for point in &results.points {
        pictures.push(PagePicture {
            name: point.name.clone(),
            pixels: read(&point.name)?,
        });
    }
    Ok(pictures)
}
