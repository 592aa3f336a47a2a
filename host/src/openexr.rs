//! Layers as OpenEXR, with the feature `exr`.

use crate::layer::{Layer, Window};
#[cfg(feature = "exr")]
use crate::render::{Aov, Values};
#[cfg(feature = "exr")]
use exr::error::Error;
#[cfg(feature = "exr")]
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, ImageAttributes, IntegerBounds,
    LayerAttributes, Text, Vec2, WritableImage,
};
use std::io::{self, Write};

/// Writes layers as OpenEXR. The picture is in the channels `R`, `G` and `B`, and depth in `Z`. Colors and vectors are
/// in channels such as `albedo.R` and `normal.X`, numbers in one channel each. Rows of a picture keep their place in
/// it. `comments` says how the picture was made.
///
/// # Errors
/// If `out` has one, or this build lacks the feature `exr`.
///
/// ```
/// use gridel_host::layer::{Layer, LinearFormat, Window};
/// use gridel_host::openexr;
/// use gridel_host::render::Values;
///
/// let layer = Layer {
///     name: None,
///     values: Values::Vectors(vec![[0.0, 0.5, 2.0]; 6]),
/// };
/// let window = Window {
///     width: 3,
///     height: 2,
///     rows: 0..2,
/// };
/// let mut file = Vec::new();
/// let written = openexr::write(&mut file, &window, &[layer], "by hand");
/// assert_eq!(written.is_ok(), LinearFormat::Exr.is_available());
/// ```
pub fn write(
    out: &mut dyn Write,
    window: &Window,
    layers: &[Layer],
    comments: &str,
) -> io::Result<()> {
    #[cfg(feature = "exr")]
    return encode(out, window, layers, comments);
    #[cfg(not(feature = "exr"))]
    {
        let _ = (out, window, layers, comments);
        Err(io::ErrorKind::Unsupported.into())
    }
}

#[cfg(feature = "exr")]
fn encode(
    out: &mut dyn Write,
    window: &Window,
    layers: &[Layer],
    comments: &str,
) -> io::Result<()> {
    let size = Vec2(usize::from(window.width), window.rows.len());
    let whole = Vec2(usize::from(window.width), usize::from(window.height));
    let mut about = LayerAttributes {
        layer_position: Vec2(0, window.rows.start.into()),
        // Text that does not fit its Latin letters is left out.
        comments: Text::new_or_none(comments),
        ..LayerAttributes::default()
    };
    about.software_name = Text::new_or_none(concat!("gridel ", env!("CARGO_PKG_VERSION")));
    let channels = AnyChannels::sort(layers.iter().flat_map(channels).collect());
    let image = Image::new(
        ImageAttributes::new(IntegerBounds::from_dimensions(whole)),
        exr::prelude::Layer::new(size, about, Encoding::SMALL_LOSSLESS, channels),
    );
    // It goes back to its tables, which streams cannot.
    let mut file = io::Cursor::new(Vec::new());
    let written = image.write().to_buffered(&mut file);
    written.map_err(|error| match error {
        Error::Io(error) => error,
        error => io::Error::other(error),
    })?;
    out.write_all(file.get_ref())
}

/// The channels of a layer.
#[cfg(feature = "exr")]
fn channels(layer: &Layer) -> Vec<AnyChannel<FlatSamples>> {
    let channel = |name: &str, samples| AnyChannel::new(name, samples);
    let name = layer.name.unwrap_or_default();
    match &layer.values {
        Values::Lengths(lengths) => vec![channel("Z", FlatSamples::F32(lengths.clone()))],
        Values::Numbers(numbers) => vec![channel(name, FlatSamples::U32(numbers.clone()))],
        Values::Coordinates(pairs) => {
            let of = |(axis, letter)| {
                let values = pairs.iter().map(|pair| pair[axis]).collect();
                channel(&format!("{name}.{letter}"), FlatSamples::F32(values))
            };
            [(0, "U"), (1, "V")].map(of).into()
        }
        Values::Vectors(vectors) => {
            let letters = if name == Aov::Normal.name() {
                ["X", "Y", "Z"]
            } else {
                ["R", "G", "B"]
            };
            let dot = if name.is_empty() { "" } else { "." };
            let of = |(axis, letter)| {
                let values = vectors.iter().map(|vector| vector[axis]).collect();
                channel(&format!("{name}{dot}{letter}"), FlatSamples::F32(values))
            };
            (0..3).zip(letters).map(of).collect()
        }
    }
}
