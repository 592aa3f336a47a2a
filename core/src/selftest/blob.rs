//! `from_bytes` reads a blob as it was written and rejects a damaged one.

use crate::format::checksum;
use crate::format::record::Header;
use crate::selftest::checks::Checks;
use crate::selftest::scene::{REQUIRED, TinyBlob};
use crate::{BlobError, Kind, Scene, Structure};
use core::fmt::{self, Write};
use core::mem::offset_of;

pub(super) fn reads(checks: &mut Checks<'_>) {
    let blob = TinyBlob::new();
    let scene = match Scene::from_bytes(blob.bytes()) {
        Ok(scene) => scene,
        Err(error) => return checks.that(format_args!("the blob"), false, format_args!("{error}")),
    };
    for kind in Kind::ALL {
        checks.equal(
            format_args!("number of primitives of kind {}", kind.name()),
            scene.count(kind),
            // Shapes without bounds would be in every picture.
            usize::from(kind.is_bounded()),
        );
    }
    checks.equal(format_args!("effects"), scene.effects(), REQUIRED);
    checks.equal(format_args!("list"), scene.holds(Structure::List), true);
    checks.equal(
        format_args!("hierarchy"),
        scene.holds(Structure::Bvh),
        false,
    );
    checks.equal(format_args!("stack depth"), scene.stack_depth(), 0);
    checks.equal(format_args!("lights"), scene.lights().len(), 2);
    checks.equal(format_args!("materials"), scene.materials().len(), 3);
    checks.equal(format_args!("width"), scene.view().width, TinyBlob::SIZE[0]);
    let corners =
        [[-60, -20, -10], [-20, -20, -10], [-40, 30, -10]].map(|p| p.map(|x: i32| x << 8));
    checks.equal(format_args!("triangle"), scene.triangle(0), Some(corners));
}

pub(super) fn rejects(checks: &mut Checks<'_>) {
    let mut blob = TinyBlob::new();
    let length = blob.bytes().len();
    for cut in 0..length {
        let rejected = Scene::from_bytes(&blob.bytes()[..cut]).is_err();
        checks.equal(format_args!("cut to {cut} bytes, rejected"), rejected, true);
    }
    for bit in 0..8 * length {
        let flip = |blob: &mut TinyBlob| blob.bytes_mut()[bit / 8] ^= 1 << (bit % 8);
        flip(&mut blob);
        let rejected = Scene::from_bytes(blob.bytes()).is_err();
        checks.equal(format_args!("bit {bit} flipped, rejected"), rejected, true);
        flip(&mut blob);
    }
    let misaligned = Scene::from_bytes(&blob.bytes()[1..]).err();
    checks.equal(
        format_args!("misaligned"),
        misaligned,
        Some(BlobError::Magic),
    );
}

pub(super) fn explains(checks: &mut Checks<'_>) {
    let mut blob = TinyBlob::new();
    let mut says = |change: &mut dyn FnMut(&mut [u8]), sentence: &str| {
        change(blob.bytes_mut());
        let sum = checksum(blob.bytes()).to_le_bytes();
        let place = offset_of!(Header, checksum);
        blob.bytes_mut()[place..place + 4].copy_from_slice(&sum);
        let mut text = Text::default();
        if let Err(error) = Scene::from_bytes(blob.bytes()) {
            // A text that is too long is cut, and then differs.
            let _ = write!(text, "{error}");
        }
        checks.equal(format_args!("the error"), text.as_str(), sentence);
        blob = TinyBlob::new();
    };
    says(
        &mut |bytes| bytes[0] = b'g',
        "these bytes are not a Gridel blob: it would begin with \"GRIDEL\". Compile the scene with \
         `gridel build`",
    );
    says(
        &mut |bytes| bytes[offset_of!(Header, version)] = 99,
        "the blob has version 99 of the format and this build reads version 1: compile the scene \
         again with the matching `gridel build`",
    );
    says(
        &mut |bytes| bytes[offset_of!(Header, stack_depth)] = 1,
        "header: its number of stack bytes is 0; it must be 12",
    );
}

/// A short text without a heap.
struct Text {
    bytes: [u8; 256],
    length: usize,
}

impl Default for Text {
    fn default() -> Self {
        Self {
            bytes: [0; 256],
            length: 0,
        }
    }
}

impl Text {
    fn as_str(&self) -> &str {
        str::from_utf8(&self.bytes[..self.length]).unwrap_or_default()
    }
}

impl Write for Text {
    fn write_str(&mut self, part: &str) -> fmt::Result {
        let end = self.length + part.len();
        let room = self.bytes.get_mut(self.length..end).ok_or(fmt::Error)?;
        room.copy_from_slice(part.as_bytes());
        self.length = end;
        Ok(())
    }
}
