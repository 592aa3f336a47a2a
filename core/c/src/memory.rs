//! The caller's memory. Only this file trusts pointers. Each pointer is tested for null, alignment and size before it
//! is used. The caller promises that it leads to the stated number of bytes, as everywhere in C.

use crate::{gridel_buffer, gridel_scene, gridel_status};
use core::mem::MaybeUninit;
use core::slice;
use gridel_core::render::WorkspaceView;
use gridel_core::{Number, Scene, Stack, StackView, Workspace};

/// Marks a `gridel_scene` that was loaded: "GRID", which memory does not hold by chance.
const LOADED: usize = 0x4752_4944;

/// The content of a `gridel_scene`.
struct Loaded {
    mark: usize,
    scene: Scene<'static>,
}

const _: () = assert!(size_of::<Loaded>() <= size_of::<gridel_scene>());
const _: () = assert!(align_of::<Loaded>() <= align_of::<gridel_scene>());

/// A value to read.
///
/// # Safety
/// The pointer is null, or leads to a value that stays as it is for as long as the reference lives.
pub unsafe fn input<'m, T>(value: *const T) -> Result<&'m T, gridel_status> {
    check(value)?;
    // SAFETY: it is not null, and aligned; the caller promises the rest.
    Ok(unsafe { &*value })
}

/// A value to write; what it held is neither read nor dropped.
///
/// # Safety
/// The pointer is null, or leads to memory of that size that nothing else uses for as long as the reference lives.
pub unsafe fn output<'m, T>(value: *mut T) -> Result<&'m mut MaybeUninit<T>, gridel_status> {
    check(value)?;
    // SAFETY: it is not null, and aligned; the caller promises the rest. Any bytes are valid for `MaybeUninit`.
    Ok(unsafe { &mut *value.cast() })
}

fn check<T>(value: *const T) -> Result<(), gridel_status> {
    if value.is_null() {
        Err(gridel_status::NullPointer)
    } else if !value.is_aligned() {
        Err(gridel_status::Misaligned)
    } else {
        Ok(())
    }
}

/// Bytes to read.
///
/// # Safety
/// The pointer is null, or leads to this many bytes that stay as they are for as long as the slice lives.
pub unsafe fn bytes<'m>(first: *const u8, length: usize) -> Result<&'m [u8], gridel_status> {
    check(first)?;
    // No blob is as long as half of all memory.
    if length > isize::MAX as usize {
        return Err(gridel_status::BlobTruncated);
    }
    // SAFETY: it is not null, and no longer than a slice can be; the caller promises the rest.
    Ok(unsafe { slice::from_raw_parts(first, length) })
}

/// Elements to write, such as pixels; what they held is not read.
///
/// # Safety
/// As [`output`], for all bytes of the buffer.
pub unsafe fn elements<'m, T>(
    buffer: gridel_buffer,
    count: usize,
) -> Result<&'m mut [MaybeUninit<T>], gridel_status> {
    let first = buffer.memory.cast::<T>();
    check(first)?;
    let needed = count.checked_mul(size_of::<T>());
    if needed.is_none_or(|needed| needed > buffer.bytes || needed > isize::MAX as usize) {
        return Err(gridel_status::BufferTooSmall);
    }
    // SAFETY: it is not null, aligned, and has this many elements; the caller promises the rest. Any bytes are valid
    // for `MaybeUninit`.
    Ok(unsafe { slice::from_raw_parts_mut(first.cast(), count) })
}

/// Sets elements to 0, because memory that was never written to has no value.
///
/// # Safety
/// Bytes of 0 are a `T`.
pub unsafe fn zeroed<T>(elements: &mut [MaybeUninit<T>]) -> &mut [T] {
    let (first, count) = (elements.as_mut_ptr().cast::<T>(), elements.len());
    // SAFETY: the slice has this many elements.
    unsafe { first.write_bytes(0, count) };
    // SAFETY: they are bytes of 0, and those are a `T` by the caller's promise.
    unsafe { slice::from_raw_parts_mut(first, count) }
}

/// Places a value at the start of a buffer, whose alignment is at least 8 bytes.
///
/// # Safety
/// As [`output`], for all bytes of the buffer.
unsafe fn place<'m, T>(buffer: gridel_buffer, value: T) -> Result<&'m mut T, gridel_status> {
    if !buffer.memory.cast::<u64>().is_aligned() {
        return Err(gridel_status::Misaligned);
    }
    // SAFETY: the caller's promise. Nothing is written before the size is known.
    let memory = unsafe { output(buffer.memory.cast::<T>()) }?;
    if buffer.bytes < size_of::<T>() {
        return Err(gridel_status::BufferTooSmall);
    }
    Ok(memory.write(value))
}

/// Fills in a scene.
///
/// # Safety
/// As [`output`].
pub unsafe fn store(to: *mut gridel_scene, scene: Scene<'static>) -> Result<(), gridel_status> {
    // SAFETY: the caller's promise; a `Loaded` takes no more than a `gridel_scene`, and no other alignment.
    let memory = unsafe { output(to.cast::<Loaded>()) }?;
    memory.write(Loaded {
        mark: LOADED,
        scene,
    });
    Ok(())
}

/// Marks a scene as not loaded.
///
/// # Safety
/// As [`output`].
pub unsafe fn clear(scene: *mut gridel_scene) -> Result<(), gridel_status> {
    // SAFETY: the caller's promise.
    let scene = unsafe { output(scene) }?;
    scene.write(gridel_scene {
        memory: [0; crate::GRIDEL_SCENE_WORDS],
    });
    Ok(())
}

/// A scene that was loaded.
///
/// # Safety
/// As [`input`]; a scene that bears the mark was filled in by [`store`], or copied from one that was. Its blob and the
/// memory of its parts are still where they were.
pub unsafe fn scene<'m>(scene: *const gridel_scene) -> Result<&'m Scene<'static>, gridel_status> {
    check(scene)?;
    let loaded = scene.cast::<Loaded>();
    // SAFETY: it is not null, and aligned for a `Loaded`; the mark is a number, whatever the bytes.
    if unsafe { (&raw const (*loaded).mark).read() } != LOADED {
        return Err(gridel_status::NotLoaded);
    }
    // SAFETY: with the mark, it is what `store` wrote.
    Ok(unsafe { &(*loaded).scene })
}

/// Memory for the views of parts, as a list that grows.
pub struct PartViews {
    first: *mut Scene<'static>,
    room: usize,
    count: usize,
}

impl PartViews {
    /// An empty list at the start of a buffer; a null pointer to no bytes is one without room.
    ///
    /// # Safety
    /// As [`output`], for all bytes of the buffer, for as long as scenes refer to the parts.
    pub unsafe fn new(buffer: gridel_buffer) -> Result<Self, gridel_status> {
        let first = buffer.memory.cast::<Scene<'static>>();
        if buffer.bytes > 0 {
            check(first)?;
        }
        Ok(Self {
            first,
            room: buffer.bytes / size_of::<Scene<'_>>(),
            count: 0,
        })
    }

    pub fn push(&mut self, part: Scene<'static>) -> Result<(), gridel_status> {
        if self.count >= self.room {
            return Err(gridel_status::BufferTooSmall);
        }
        // SAFETY: `new` was promised the buffer, which has room for this one.
        unsafe { self.first.add(self.count).write(part) };
        self.count = self.count.saturating_add(1);
        Ok(())
    }

    pub fn finish(self) -> &'static [Scene<'static>] {
        if self.count == 0 {
            return &[];
        }
        // SAFETY: so many were written, into memory that the caller of `new` promised to leave alone.
        unsafe { slice::from_raw_parts(self.first, self.count) }
    }
}

/// Runs code with the smallest of some sizes, all constants, that is at least as large as a number.
macro_rules! with_least {
    ($needed:expr, [$($size:literal)*], $most:literal, $use:ident) => {
        match $needed {
            $(0..=$size => $use!($size),)*
            _ => $use!($most),
        }
    };
}

/// Runs code with the number of entries of the smallest stack that is deep enough. The library has no other list of
/// stacks, so that what it says to be needed is what it uses. `GRIDEL_STACK_ENTRIES` of the header repeats it: the test
/// `header_has_the_stacks_of_the_library` compares both.
macro_rules! with_stack {
    ($depth:expr, $use:ident) => {
        with_least!($depth, [8 16 24 32 48 96], 160, $use)
    };
}

/// Like `with_stack`, for the number of waiting rays.
macro_rules! with_waiting {
    ($depth:expr, $use:ident) => {
        with_least!($depth, [0 5 9 17 33], 65, $use)
    };
}

/// Bytes of the stack that a scene needs.
pub fn stack_bytes(scene: &Scene<'_>) -> usize {
    macro_rules! bytes {
        ($depth:literal) => {
            size_of::<Stack<$depth>>()
        };
    }
    with_stack!(scene.stack_depth(), bytes)
}

/// A stack in the caller's memory that is deep enough for a scene.
///
/// # Safety
/// As [`output`], for all bytes of the buffer.
pub unsafe fn stack<'m>(
    scene: &Scene<'_>,
    buffer: gridel_buffer,
) -> Result<&'m mut StackView, gridel_status> {
    macro_rules! stack {
        ($depth:literal) => {
            // SAFETY: the caller's promise.
            unsafe { place(buffer, Stack::<$depth>::new()) }?.as_view()
        };
    }
    Ok(with_stack!(scene.stack_depth(), stack))
}

/// Entries of a workspace: of the stack, and places for rays that wait.
type Depths = [usize; 2];

/// Bytes of a workspace.
pub fn workspace_bytes<N: Number>([stack, work]: Depths) -> usize {
    macro_rules! with_work {
        ($stack:literal) => {{
            macro_rules! bytes {
                ($work:literal) => {
                    size_of::<Workspace<N, $stack, $work>>()
                };
            }
            with_waiting!(work, bytes)
        }};
    }
    with_stack!(stack, with_work)
}

/// A workspace in the caller's memory.
///
/// # Safety
/// As [`output`], for all bytes of the buffer.
pub unsafe fn workspace<'m, N: Number>(
    [stack, work]: Depths,
    buffer: gridel_buffer,
) -> Result<WorkspaceView<'m, N>, gridel_status> {
    macro_rules! with_work {
        ($stack:literal) => {{
            macro_rules! workspace {
                ($work:literal) => {
                    // SAFETY: the caller's promise.
                    unsafe { place(buffer, Workspace::<N, $stack, $work>::new()) }?.as_view()
                };
            }
            with_waiting!(work, workspace)
        }};
    }
    Ok(with_stack!(stack, with_work))
}

// Every scene fits the largest of either list.
const _: () = assert!(gridel_core::format::limits::MAX_STACK_DEPTH <= 160);
const _: () = assert!(gridel_core::Effects::MAX_WORK_DEPTH <= 65);
const _: () = assert!(size_of::<Stack<160>>() <= crate::GRIDEL_STACK_BYTES_MAX);
const _: () = assert!(size_of::<Workspace<f32, 160, 65>>() <= crate::GRIDEL_WORKSPACE_BYTES_MAX);
const _: () = assert!(
    size_of::<Workspace<gridel_core::Fixed, 160, 65>>() <= crate::GRIDEL_WORKSPACE_BYTES_MAX
);
const _: () =
    assert!(size_of::<Workspace<f64, 160, 65>>() <= crate::GRIDEL_WORKSPACE_BYTES_MAX_F64);
