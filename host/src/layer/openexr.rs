//! Layers as OpenEXR.

use super::{Layer, Window};
use crate::render::{Aov, Values};
use exr::error::Error;
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, ImageAttributes, IntegerBounds,
    LayerAttributes, Text, Vec2, WritableImage,
};
use std::io::{self, Cursor, Write};

pub(super) fn write(
    out: &mut dyn Write,
    window: &Window,
    layers: &[Layer],
    comments: &str,
) -> io::Result<()> {
    let size = Vec2(usize::from(window.width), window.rows.len());
    let whole = Vec2(usize::from(window.width), usize::from(window.height));
    let mut about = LayerAttributes {
        layer_position: Vec2(0, window.rows.start.into()),
        // What does not fit its Latin letters is not said.
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
    let mut file = Cursor::new(Vec::new());
    let written = image.write().to_buffered(&mut file);
    written.map_err(|error| match error {
        Error::Io(error) => error,
        error => io::Error::other(error),
    })?;
    out.write_all(file.get_ref())
}

/// The channels of a layer.
fn channels(layer: &Layer) -> Vec<AnyChannel<FlatSamples>> {
    let channel = |name: &str, samples| AnyChannel::new(name, samples);
    let name = layer.name.unwrap_or_default();
    match &layer.values {
        Values::Lengths(lengths) => vec![channel("Z", FlatSamples::F32(lengths.clone()))],
        Values::Numbers(numbers) => vec![channel(name, FlatSamples::U32(numbers.clone()))],
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
