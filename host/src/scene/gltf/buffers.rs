//! The binary side of a glTF file: buffers, and what accessors read from them.
//!
//! The crate's own readers trust offsets, counts and types; here every read is checked.

use crate::scene::access::{Access, FileError};
use crate::scene::error::COPY_AGAIN;
use crate::scene::{CauseAndRemedy, SceneError};
use crate::table::shortened;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use gltf::Document;
use gltf::accessor::sparse::IndexType;
use gltf::accessor::{Accessor, DataType, Dimensions};
use gltf::buffer::{Source, View};
use std::borrow::Cow;
use std::collections::HashMap;
use std::path::Path;
use std::rc::Rc;

/// Most vertices and triangles of a file, each instance counted. It is the limit of a blob.
pub(super) const MOST: usize = 1 << 24;

/// Reads a component of an element from its bytes.
type Channel = fn(&[u8], usize) -> f64;

/// The bytes of a file's buffers, in their order.
pub(super) struct Buffers<'a> {
    path: &'a Path,
    bytes: Vec<Rc<[u8]>>,
}

/// A number, or 0 where it is not finite: the file was warned of.
fn or_zero(number: f64) -> f64 {
    if number.is_finite() { number } else { 0.0 }
}

impl<'a> Buffers<'a> {
    /// Reads all buffers; `blob` is the one in the file itself.
    pub(super) fn read(
        path: &'a Path,
        document: &Document,
        mut blob: Option<Vec<u8>>,
        access: &Access,
    ) -> Result<Self, SceneError> {
        // Many buffers may name one file.
        let mut files: HashMap<String, Rc<[u8]>> = HashMap::new();
        let bytes = document
            .buffers()
            .map(|buffer| {
                let bytes: Rc<[u8]> = match buffer.source() {
                    Source::Bin => blob.take().unwrap_or_default().into(),
                    Source::Uri(uri) => match files.get(uri) {
                        Some(bytes) => Rc::clone(bytes),
                        None => {
                            let bytes: Rc<[u8]> =
                                fetch(path, &format!("buffer {}", buffer.index()), uri, access)
                                    .map_err(FileError::into_error)?
                                    .into();
                            files.insert(uri.to_owned(), Rc::clone(&bytes));
                            bytes
                        }
                    },
                };
                if bytes.len() < buffer.length() {
                    return Err(SceneError::new(
                        path,
                        format!(
                            "buffer {} has {} bytes, and {} are announced",
                            buffer.index(),
                            bytes.len(),
                            buffer.length()
                        ),
                        COPY_AGAIN,
                    ));
                }
                Ok(bytes)
            })
            .collect::<Result<_, _>>()?;
        Ok(Self { path, bytes })
    }

    /// Reads positions.
    pub(super) fn positions(&self, accessor: &Accessor<'_>) -> Result<Vec<[f32; 3]>, SceneError> {
        self.vectors(accessor, "positions")
    }

    /// Reads positions or normals.
    pub(super) fn vectors(
        &self,
        accessor: &Accessor<'_>,
        what: &str,
    ) -> Result<Vec<[f32; 3]>, SceneError> {
        match (accessor.data_type(), accessor.dimensions()) {
            (DataType::F32, Dimensions::Vec3) => {
                self.values(accessor, [0.0; 3], bytemuck::pod_read_unaligned)
            }
            (kind, dimensions) => Err(self.error(
                accessor,
                format!("is to hold {what} and holds {dimensions:?} of {kind:?}"),
            )),
        }
    }

    /// Reads the times of an animation.
    pub(super) fn times(&self, accessor: &Accessor<'_>) -> Result<Vec<[f64; 1]>, SceneError> {
        if accessor.data_type() != DataType::F32 {
            let cause = format!("is to hold times and holds {:?}", accessor.data_type());
            return Err(self.error(accessor, cause));
        }
        self.numbers(accessor)
    }

    /// Reads the values of an animation: floats, or for rotations and weights integers that mean -1 to 1 or 0 to 1.
    pub(super) fn numbers<const N: usize>(
        &self,
        accessor: &Accessor<'_>,
    ) -> Result<Vec<[f64; N]>, SceneError> {
        let dimensions = match N {
            1 => Dimensions::Scalar,
            3 => Dimensions::Vec3,
            _ => Dimensions::Vec4,
        };
        let number: fn(&[u8], usize) -> f64 = match accessor.data_type() {
            DataType::F32 => |bytes, k| f32::from_bits(narrow::<4>(&bytes[4 * k..])).into(),
            DataType::I8 => |bytes, k| (f64::from(bytes[k] as i8) / 127.0).max(-1.0),
            DataType::U8 => |bytes, k| f64::from(bytes[k]) / 255.0,
            DataType::I16 => {
                |bytes, k| (f64::from(narrow::<2>(&bytes[2 * k..]) as i16) / 32767.0).max(-1.0)
            }
            DataType::U16 => |bytes, k| f64::from(narrow::<2>(&bytes[2 * k..])) / 65535.0,
            DataType::U32 => |_, _| f64::NAN,
        };
        let floats = accessor.data_type() == DataType::F32;
        if accessor.dimensions() != dimensions || !(floats || N != 3 && accessor.normalized()) {
            return Err(self.error(
                accessor,
                format!(
                    "is to hold {dimensions:?} of an animation and holds {:?} of {:?}",
                    accessor.dimensions(),
                    accessor.data_type()
                ),
            ));
        }
        self.values(accessor, [0.0; N], |bytes| {
            std::array::from_fn(|component| number(bytes, component))
        })
    }

    /// The bytes of a view; `None` where its buffer is shorter.
    pub(super) fn view(&self, view: &View<'_>) -> Option<&[u8]> {
        let bytes = self.bytes.get(view.buffer().index())?;
        bytes.get(view.offset()..)?.get(..view.length())
    }

    /// Reads linear colors; alpha is 1 where it is missing.
    pub(super) fn colors(&self, accessor: &Accessor<'_>) -> Result<Vec<[f64; 4]>, SceneError> {
        let count = match accessor.dimensions() {
            Dimensions::Vec3 => 3,
            Dimensions::Vec4 => 4,
            _ => 0,
        };
        let number = self.channel(accessor, count > 0, "colors")?;
        self.values(accessor, [0.0; 4], |bytes| {
            std::array::from_fn(|k| {
                if k < count {
                    or_zero(number(bytes, k))
                } else {
                    1.0
                }
            })
        })
    }

    /// Reads texture coordinates.
    pub(super) fn coordinates(&self, accessor: &Accessor<'_>) -> Result<Vec<[f64; 2]>, SceneError> {
        let is_pair = accessor.dimensions() == Dimensions::Vec2;
        let number = self.channel(accessor, is_pair, "texture coordinates")?;
        let found = self.values(accessor, [0.0; 2], |bytes| {
            [number(bytes, 0), number(bytes, 1)]
        })?;
        Ok(found.into_iter().map(|it| it.map(or_zero)).collect())
    }

    /// Reads a component of colors or coordinates: a float, or an integer that means 0 to 1.
    fn channel(
        &self,
        accessor: &Accessor<'_>,
        fits: bool,
        what: &str,
    ) -> Result<Channel, SceneError> {
        let found: Option<Channel> = match accessor.data_type() {
            DataType::F32 => Some(|bytes, k| f32::from_bits(narrow::<4>(&bytes[4 * k..])).into()),
            DataType::U8 => Some(|bytes, k| f64::from(bytes[k]) / 255.0),
            DataType::U16 => Some(|bytes, k| f64::from(narrow::<2>(&bytes[2 * k..])) / 65535.0),
            _ => None,
        };
        found.filter(|_| fits).ok_or_else(|| {
            let (kind, dimensions) = (accessor.data_type(), accessor.dimensions());
            self.error(
                accessor,
                format!("is to hold {what} and holds {dimensions:?} of {kind:?}"),
            )
        })
    }

    /// Reads the numbers of vertices.
    pub(super) fn indices(&self, accessor: &Accessor<'_>) -> Result<Vec<u32>, SceneError> {
        match (accessor.data_type(), accessor.dimensions()) {
            (DataType::U8, Dimensions::Scalar) => self.values(accessor, 0, narrow::<1>),
            (DataType::U16, Dimensions::Scalar) => self.values(accessor, 0, narrow::<2>),
            (DataType::U32, Dimensions::Scalar) => self.values(accessor, 0, narrow::<4>),
            (kind, dimensions) => Err(self.error(
                accessor,
                format!("is to hold numbers of vertices and holds {dimensions:?} of {kind:?}"),
            )),
        }
    }

    /// The first element of an accessor that holds a number that is not finite.
    pub(super) fn first_not_finite(
        &self,
        accessor: &Accessor<'_>,
    ) -> Result<Option<usize>, SceneError> {
        if accessor.data_type() != DataType::F32 {
            return Ok(None);
        }
        let finite = |bytes: &[u8]| {
            let mut numbers = bytes.chunks_exact(4);
            numbers.all(|bytes| f32::from_bits(narrow::<4>(bytes)).is_finite())
        };
        let elements = self.values(accessor, true, finite)?;
        Ok(elements.iter().position(|finite| !finite))
    }

    /// Reads all elements of an accessor, those that are replaced included.
    fn values<T: Clone>(
        &self,
        accessor: &Accessor<'_>,
        zero: T,
        parse: impl Fn(&[u8]) -> T,
    ) -> Result<Vec<T>, SceneError> {
        let count = accessor.count();
        if count > MOST {
            return Err(self.error(
                accessor,
                format!("has {count} elements, and {MOST} are the most"),
            ));
        }
        let size = accessor.size();
        let mut values: Vec<T> = match accessor.view() {
            Some(view) => {
                let elements = self.elements(accessor, &view, accessor.offset(), count, size)?;
                elements.map(&parse).collect()
            }
            None => vec![zero; count],
        };
        let Some(sparse) = accessor.sparse() else {
            return Ok(values);
        };
        let (indices, replaced) = (sparse.indices(), sparse.values());
        let (width, number): (usize, fn(&[u8]) -> u32) = match indices.index_type() {
            IndexType::U8 => (1, narrow::<1>),
            IndexType::U16 => (2, narrow::<2>),
            IndexType::U32 => (4, narrow::<4>),
        };
        let count = sparse.count();
        let places = self.elements(accessor, &indices.view(), indices.offset(), count, width)?;
        let elements = self.elements(accessor, &replaced.view(), replaced.offset(), count, size)?;
        for (place, element) in places.map(number).zip(elements.map(&parse)) {
            let value = values.get_mut(place as usize).ok_or_else(|| {
                self.error(
                    accessor,
                    format!("replaces element {place}, which it lacks"),
                )
            })?;
            *value = element;
        }
        Ok(values)
    }

    /// The bytes of each of `count` elements of `size` bytes in a view, from an offset on.
    fn elements<'s>(
        &'s self,
        accessor: &Accessor<'_>,
        view: &View<'_>,
        offset: usize,
        count: usize,
        size: usize,
    ) -> Result<impl Iterator<Item = &'s [u8]> + use<'s>, SceneError> {
        let stride = view.stride().unwrap_or(size).max(1);
        let bytes = self.bytes.get(view.buffer().index());
        let bytes = bytes
            .and_then(|bytes| {
                bytes
                    .get(view.offset()..)?
                    .get(..view.length())?
                    .get(offset..)
            })
            .unwrap_or(&[]);
        // The padding of an element may be missing behind the last.
        let before_last = stride.checked_mul(count.saturating_sub(1));
        let needed = before_last.and_then(|bytes| bytes.checked_add(size));
        if count > 0 && (stride < size || needed.is_none_or(|needed| needed > bytes.len())) {
            return Err(self.error(
                accessor,
                format!(
                    "reads {count} elements of {size} bytes, {stride} bytes apart, of which \
                     buffer view {} has {} bytes",
                    view.index(),
                    bytes.len()
                ),
            ));
        }
        let elements = bytes.chunks(stride).take(count);
        Ok(elements.map(move |element| &element[..size]))
    }

    fn error(&self, accessor: &Accessor<'_>, cause: String) -> SceneError {
        SceneError::new(
            self.path,
            format!("accessor {} {cause}", accessor.index()),
            "export the file again",
        )
    }
}

/// A number of `N` bytes, the lowest first.
fn narrow<const N: usize>(bytes: &[u8]) -> u32 {
    let bytes = bytes[..N].iter().rev();
    bytes.fold(0, |number, &byte| number << 8 | u32::from(byte))
}

/// Returns the rest of a text that begins with a word, in small or capital letters.
fn without_start<'t>(text: &'t str, word: &str) -> Option<&'t str> {
    let (start, rest) = text.split_at_checked(word.len())?;
    start.eq_ignore_ascii_case(word).then_some(rest)
}

/// The bytes of a data URI behind its scheme, in base 64. Characters may be escaped as `%2B`, as in any URI.
fn decoded(data: &str) -> Option<Vec<u8>> {
    let (kind, encoded) = data.split_once(',')?;
    let (_, encoding) = kind.rsplit_once(';')?;
    let encoded = Cow::from(percent_encoding::percent_decode_str(encoded));
    let is_base64 = encoding.eq_ignore_ascii_case("base64");
    is_base64.then(|| STANDARD.decode(encoded).ok())?
}

/// Reads a URI: bytes in base 64, or a file in the scene's folder.
pub(super) fn fetch(
    path: &Path,
    what: &str,
    uri: &str,
    access: &Access,
) -> Result<Vec<u8>, FileError<SceneError>> {
    let error =
        |cause: String, remedy: &str| SceneError::new(path, format!("{what} {cause}"), remedy);
    let wrong = |cause, remedy: &str| FileError::Unusable(error(cause, remedy));
    if let Some(data) = without_start(uri, "data:") {
        return decoded(data).ok_or_else(|| {
            let uri = shortened(uri);
            wrong(
                format!("is a data URI that is not in base 64: {uri:?}"),
                "export the file again, or as .glb",
            )
        });
    }
    let local = uri.strip_prefix("file:").map(|file| {
        let file = file.strip_prefix("//localhost").unwrap_or(file);
        file.strip_prefix("//").unwrap_or(file)
    });
    if local.is_none() && uri.contains("://") {
        return Err(wrong(
            format!(
                "lies at {uri:?}, and nothing is fetched from a network",
                uri = shortened(uri)
            ),
            "put the file beside the scene file and name it there",
        ));
    }
    let name = percent_encoding::percent_decode_str(local.unwrap_or(uri)).decode_utf8_lossy();
    let file = access
        .resolve(path, &name)
        .map_err(|CauseAndRemedy { cause, remedy }| {
            wrong(format!("is in a file: {cause}"), &remedy)
        })?;
    access.read(&file).map_err(|read| {
        FileError::Unreadable(error(
            format!("is in {}, which {}", file.display(), read.cause),
            "put that file beside the scene file",
        ))
    })
}
