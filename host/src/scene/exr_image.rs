//! Pictures of linear radiance in OpenEXR files, with the feature `exr`.

use super::error::CauseAndRemedy;

/// The first bytes of the files.
pub(super) const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// Width, height and pixels.
type Decoded = (usize, usize, Vec<[f32; 3]>);

/// Reads a picture of a size that `check` allows.
#[cfg(feature = "exr")]
pub(super) fn decode(
    bytes: &[u8],
    check: impl Fn(usize, usize) -> Result<(), CauseAndRemedy>,
) -> Result<Decoded, CauseAndRemedy> {
    use exr::meta::MetaData;
    use exr::prelude::{ReadChannels, ReadLayers, Vec2, read};
    use std::io::Cursor;

    const REMEDY: &str = "save the picture again, with the channels R, G and B of numbers";
    let broken = |error: exr::error::Error| {
        CauseAndRemedy::new(
            format!("cannot be read as OpenEXR, or has no channels R, G and B: {error}"),
            REMEDY,
        )
    };
    let about = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(broken)?;
    for header in &about.headers {
        let (whole, own) = (
            header.shared_attributes.display_window.size,
            header.layer_size,
        );
        if whole != own {
            return Err(CauseAndRemedy::new(
                format!(
                    "has {}x{} pixels of a picture of {}x{}",
                    own.x(),
                    own.y(),
                    whole.x(),
                    whole.y()
                ),
                "save all of the picture",
            ));
        }
        check(own.x(), own.y())?;
    }
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            |size, _| (size.x(), vec![[0.0_f32; 3]; size.area()]),
            |(width, pixels), Vec2(x, y), (r, g, b, _): (f32, f32, f32, f32)| {
                pixels[y * *width + x] = [r, g, b];
            },
        )
        .first_valid_layer()
        .all_attributes()
        .from_buffered(Cursor::new(bytes))
        .map_err(broken)?;
    let size = image.layer_data.size;
    let (width, pixels) = image.layer_data.channel_data.pixels;
    let is_wrong = |pixel: &[f32; 3]| !pixel.iter().all(|&it| it.is_finite() && it >= 0.0);
    if let Some(place) = pixels.iter().position(is_wrong) {
        let (x, y, [r, g, b]) = (place % width, place / width, pixels[place]);
        return Err(CauseAndRemedy::new(
            format!(
                "has the radiance {r}, {g}, {b} at {x},{y}; each must be a number of at least 0"
            ),
            "limit the picture's colors to numbers of at least 0",
        ));
    }
    Ok((size.x(), size.y(), pixels))
}

/// Says what is missing.
#[cfg(not(feature = "exr"))]
pub(super) fn decode(
    _: &[u8],
    _: impl Fn(usize, usize) -> Result<(), CauseAndRemedy>,
) -> Result<Decoded, CauseAndRemedy> {
    Err(CauseAndRemedy::new(
        "is OpenEXR, which this build cannot read",
        "convert it to Radiance HDR, or install with `cargo install --features exr`",
    ))
}
