//! Blobs that a program proves valid at compile time, so that loading need not.

use crate::accel::hierarchy::order::Order;
use crate::format::limits::MAX_STACK_DEPTH;
use crate::format::record::{Header, SectionEntry};
use crate::format::word::{complete, half, proved, word};
use crate::format::{BlobError, Field, Location, Reason, SectionKind, Structure, checksum};
use core::mem::offset_of;

/// A blob that was verified at compile time: [`Scene::prevalidated`](crate::scene::Scene::prevalidated) loads it in
/// constant time.
///
/// [`Prevalidated::of`] is a `const fn`. Evaluated for a `static`, it runs in the compiler, and a program with an
/// invalid blob does not compile:
///
/// ```
/// # macro_rules! scene { () => { concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/blobs/dual-split.gridel") } }
/// use gridel_core::{Prevalidated, Scene};
///
/// static BLOB: &[u8] = gridel_core::include_blob!(scene!());
/// static PREVALIDATED: Prevalidated<'static> = match Prevalidated::of(BLOB) {
///     Ok(blob) => blob,
///     Err(_) => panic!("the blob was damaged"),
/// };
///
/// let scene = Scene::prevalidated(PREVALIDATED)?;
/// # Ok::<(), gridel_core::BlobError>(())
/// ```
///
/// **Proved at compile time.** The checksum proves that the blob is what `gridel build` wrote, to the byte. The order
/// of the hierarchies whose code is compiled in proves that every walk visits each node at most once. So a walk needs
/// no deeper stack than the header states.
///
/// **Proved at loading**, in constant time: header, section table and view. Every section lies in the blob and has
/// records of the right size. This build has the required effects and kinds of primitives.
///
/// **Not proved**, because `gridel build` is responsible for it: boxes lie in their parents' and primitives in their
/// leaves, and numbers are in their ranges. A blob that is forged there, with a valid checksum, gives wrong answers. It
/// cannot do more. Every look-up from one record to another is checked, and arithmetic wraps or saturates. No loop
/// takes its end from a record, except those that end with an array. Tests check this with records of any content, with
/// overflow checks on. Programs of such a blob hold no code that panics.
///
/// Blobs for boards can be prevalidated if they hold no structures except [`Self::STRUCTURES`].
#[derive(Clone, Copy, Debug)]
pub struct Prevalidated<'a> {
    pub(in crate::scene) blob: &'a [u8],
}

impl<'a> Prevalidated<'a> {
    /// The structures that can be prevalidated.
    pub const STRUCTURES: [Structure; 4] = [
        Structure::List,
        Structure::Bvh,
        Structure::Flagged,
        Structure::DualSplit,
    ];

    /// The bits of these in the header.
    const BITS: u32 = {
        let mut bits = 0;
        let mut index = 0;
        while index < Self::STRUCTURES.len() {
            bits |= Self::STRUCTURES[index].bit();
            index += 1;
        }
        bits
    };

    /// Proves a blob. Linear in its length; constant time in a program that evaluates it at compile time.
    ///
    /// # Errors
    /// If the bytes are not a blob, it is cut off, or its checksum is wrong. If a hierarchy is not in breadth-first
    /// order or deeper than the header states. Also if the header names structures that cannot be prevalidated, or there
    /// are sections of such structures.
    pub const fn of(blob: &'a [u8]) -> Result<Self, BlobError> {
        proved!(complete(blob));
        let expected = proved!(word(blob, offset_of!(Header, checksum)));
        let found = checksum(blob);
        if found != expected {
            return Err(BlobError::Checksum { found, expected });
        }
        let structures = proved!(word(blob, offset_of!(Header, structures)));
        if structures & !Self::BITS != 0 {
            return Err(Location::Header.invalid(Reason::NotPrevalidated));
        }
        let sections = proved!(half(blob, offset_of!(Header, section_count))) as usize;
        let stack_depth = proved!(half(blob, offset_of!(Header, stack_depth))) as usize;
        let mut index = 0;
        while index < sections {
            let entry = size_of::<Header>() + index * size_of::<SectionEntry>();
            let kind = proved!(half(blob, entry + offset_of!(SectionEntry, kind)));
            // The sections between belong to other structures.
            let is_other =
                kind > SectionKind::DualNodes as u16 && kind <= SectionKind::Radii as u16;
            if is_other
                || kind >= SectionKind::Parts as u16 && kind <= SectionKind::InstanceJoints as u16
            {
                return Err(Location::Table(index).invalid(Reason::NotPrevalidated));
            }
            let levels = proved!(levels(blob, entry, kind));
            if levels > stack_depth {
                let range = [levels as i64, MAX_STACK_DEPTH as i64];
                let found = stack_depth as i64;
                return Err(Location::Header.out_of_range(Field::StackDepth, found, range));
            }
            index += 1;
        }
        Ok(Self { blob })
    }
}

/// The levels of a hierarchy, given where its section's entry lies in the table, and its kind; none
/// for other sections.
const fn levels(blob: &[u8], entry: usize, kind: u16) -> Result<usize, BlobError> {
    let section = match kind {
        _ if kind == SectionKind::Pairs as u16 => SectionKind::Pairs,
        _ if kind == SectionKind::FlaggedPairs as u16 => SectionKind::FlaggedPairs,
        _ if kind == SectionKind::DualNodes as u16 => SectionKind::DualNodes,
        _ => return Ok(0),
    };
    let Some(size) = Order::record_size(section) else {
        return Ok(0);
    };
    let count = proved!(word(blob, entry + offset_of!(SectionEntry, count))) as usize;
    let mut end = proved!(word(blob, entry + offset_of!(SectionEntry, offset))) as usize;
    let mut order = Order::new(section, count);
    let mut index = 0;
    while index < count {
        end = end.saturating_add(size);
        let words = [
            proved!(word(blob, end.saturating_sub(8))),
            proved!(word(blob, end.saturating_sub(4))),
        ];
        proved!(order.record(words));
        index += 1;
    }
    order.levels()
}
