//! Buffers, and what accessors read from them: every range is checked before it is read.

use super::super::SceneError;
use super::super::text::read_file;
use ::gltf::accessor::{DataType, Dimensions};
use ::gltf::buffer::Source;
use ::gltf::{Accessor, Document};
use base64::Engine;
use glam::DVec3;
use percent_encoding::percent_decode_str;
use std::borrow::Cow;
use std::path::Path;

/// The bytes of all buffers of a document.
pub(super) struct Buffers<'d> {
    path: &'d Path,
    bytes: Vec<Cow<'d, [u8]>>,
}

impl<'d> Buffers<'d> {
    pub(super) fn read(
        path: &'d Path,
        document: &'d Document,
        blob: Option<&'d [u8]>,
    ) -> Result<Self, SceneError> {
        let mut bytes = Vec::new();
        for buffer in document.buffers() {
            let index = buffer.index();
            let wrong = |cause: String| {
                SceneError::new(
                    path,
                    format!("buffer {index} {cause}"),
                    "put the file beside this one, or export it again with its data inside (.glb)",
                )
            };
            let content = match buffer.source() {
                Source::Bin => match blob {
                    Some(blob) => Cow::Borrowed(blob),
                    None => return Err(wrong(String::from("has no data: this is no binary file"))),
                },
                Source::Uri(uri) => Cow::Owned(match uri.strip_prefix("data:") {
                    Some(data) => {
                        let text = data.split_once(";base64,").map(|(_, text)| text);
                        let text =
                            text.ok_or_else(|| wrong("is data, but not in base64".into()))?;
                        let decoder = &base64::engine::general_purpose::STANDARD;
                        decoder
                            .decode(text)
                            .map_err(|error| wrong(format!("is broken: {error}")))?
                    }
                    None => {
                        let name = percent_decode_str(uri).decode_utf8_lossy();
                        let folder = path.parent().unwrap_or(Path::new(""));
                        let read = read_file(&folder.join(&*name));
                        read.map_err(|error| wrong(format!("is {name:?}, which {}", error.cause)))?
                    }
                }),
            };
            if content.len() < buffer.length() {
                let (found, expected) = (content.len(), buffer.length());
                return Err(wrong(format!("has {found} bytes of {expected}")));
            }
            bytes.push(content);
        }
        Ok(Self { path, bytes })
    }

    /// Points of three 32-bit floats.
    pub(super) fn positions(&self, accessor: &Accessor<'_>) -> Result<Vec<DVec3>, SceneError> {
        if (accessor.data_type(), accessor.dimensions()) != (DataType::F32, Dimensions::Vec3) {
            return Err(self.wrong(accessor, "holds no points of three 32-bit floats"));
        }
        let point = |bytes: &[u8]| {
            let coordinate = |axis: usize| {
                let bytes = bytes[4 * axis..4 * axis + 4].try_into().unwrap_or_default();
                f64::from(f32::from_le_bytes(bytes))
            };
            DVec3::new(coordinate(0), coordinate(1), coordinate(2))
        };
        Ok(self.items(accessor, 12)?.map(point).collect())
    }

    /// Indices of 8, 16 or 32 bits.
    pub(super) fn indices(&self, accessor: &Accessor<'_>) -> Result<Vec<u32>, SceneError> {
        let size = match (accessor.data_type(), accessor.dimensions()) {
            (DataType::U8, Dimensions::Scalar) => 1,
            (DataType::U16, Dimensions::Scalar) => 2,
            (DataType::U32, Dimensions::Scalar) => 4,
            _ => return Err(self.wrong(accessor, "holds no indices")),
        };
        let index = |bytes: &[u8]| {
            bytes
                .iter()
                .rev()
                .fold(0, |index, &byte| index << 8 | u32::from(byte))
        };
        Ok(self.items(accessor, size)?.map(index).collect())
    }

    /// The items of an accessor, of `size` bytes each.
    fn items<'b>(
        &'b self,
        accessor: &Accessor<'_>,
        size: usize,
    ) -> Result<impl Iterator<Item = &'b [u8]>, SceneError> {
        if accessor.sparse().is_some() {
            return Err(self.wrong(accessor, "is sparse, which is not read"));
        }
        let Some(view) = accessor.view() else {
            return Err(self.wrong(accessor, "has no data"));
        };
        let stride = view.stride().unwrap_or(size);
        let bytes = self.bytes.get(view.buffer().index());
        let end = view.offset().checked_add(view.length());
        let bytes = bytes
            .zip(end)
            .and_then(|(bytes, end)| bytes.get(view.offset()..end));
        let bytes = bytes.and_then(|bytes| bytes.get(accessor.offset()..));
        // The last item may end before its stride does.
        let before_last = accessor.count().saturating_sub(1).checked_mul(stride);
        let needed = before_last.and_then(|before| before.checked_add(size));
        match (bytes, needed) {
            (Some(bytes), Some(needed)) if stride >= size && needed <= bytes.len() => {
                let items =
                    (0..accessor.count()).map(move |number| &bytes[number * stride..][..size]);
                Ok(items)
            }
            _ => Err(self.wrong(accessor, "reaches beyond its buffer")),
        }
    }

    fn wrong(&self, accessor: &Accessor<'_>, cause: &str) -> SceneError {
        SceneError::new(
            self.path,
            format!("accessor {} {cause}", accessor.index()),
            "export the file again, without compression and sparse data",
        )
    }
}
