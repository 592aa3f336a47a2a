//! The memory map of a blob, and the writable memory that it needs.

use gridel_core::accel::Entry;
use gridel_core::format::SectionKind;
use gridel_core::format::record::{Header, SectionEntry};
use gridel_core::shared::bytes_per_ray;
use gridel_core::{Fixed, Format, Number, Scene};
use serde::Serialize;

/// The content of a blob by bytes; the parts add up to the blob.
#[derive(Clone, Debug, Serialize)]
pub struct MemoryMap {
    /// Length of the blob.
    pub bytes: usize,
    /// `None` without primitives.
    pub bytes_per_primitive: Option<f64>,
    pub parts: Vec<Part>,
}

/// Header, section table, a section, or all padding.
#[derive(Clone, Debug, Serialize)]
pub struct Part {
    pub kind: &'static str,
    /// Offset from the blob's first byte; `None` for padding, which lies between all others.
    pub offset: Option<usize>,
    /// Number of records.
    pub count: usize,
    /// Bytes of a record.
    pub stride: usize,
    pub bytes: usize,
    /// Share of the blob, 0 to 1.
    pub share: f64,
    /// `None` without primitives.
    pub bytes_per_primitive: Option<f64>,
}

impl MemoryMap {
    /// Returns the map of a blob that `scene` is the checked view of.
    ///
    /// ```
    /// # use gridel_host::compile::{Options, compile};
    /// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
    /// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
    /// # let blob = compile(&imported.scene, &Options::default())?.blob;
    /// # let scene = blob.scene()?;
    /// use gridel_host::measure::MemoryMap;
    ///
    /// let map = MemoryMap::of(&scene, blob.bytes());
    /// let sum: usize = map.parts.iter().map(|part| part.bytes).sum();
    /// assert_eq!(sum, blob.bytes().len());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of(scene: &Scene<'_>, blob: &[u8]) -> Self {
        let header = scene.header();
        let primitives = f64::from(header.primitives);
        let each = |bytes: usize| (primitives > 0.0).then(|| bytes as f64 / primitives);
        let part = |kind, offset, count, stride| Part {
            kind,
            offset,
            count,
            stride,
            bytes: count * stride,
            share: (count * stride) as f64 / blob.len() as f64,
            bytes_per_primitive: each(count * stride),
        };
        let table_bytes = usize::from(header.section_count) * size_of::<SectionEntry>();
        let table = &blob[size_of::<Header>()..][..table_bytes];
        let entries: &[SectionEntry] = bytemuck::cast_slice(table);
        let mut parts = vec![
            part("header", Some(0), 1, size_of::<Header>()),
            part(
                "section table",
                Some(size_of::<Header>()),
                entries.len(),
                size_of::<SectionEntry>(),
            ),
        ];
        parts.extend(entries.iter().map(|entry| {
            part(
                SectionKind::of_number(entry.kind).map_or("unknown", SectionKind::name),
                Some(entry.offset as usize),
                entry.count as usize,
                entry.stride.into(),
            )
        }));
        let used: usize = parts.iter().map(|part| part.bytes).sum();
        parts.push(part("padding", None, blob.len() - used, 1));
        Self {
            bytes: blob.len(),
            bytes_per_primitive: each(blob.len()),
            parts,
        }
    }
}

/// The memory that the caller provides in one number format, in bytes, besides the call stack.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct WorkingMemory {
    /// Name of the number format.
    pub format: &'static str,
    /// Bits of a machine word: 32 as on boards, or what this machine has.
    pub word_bits: usize,
    /// Bytes for rays of the caller's own: a [`Stack`](gridel_core::Stack) as deep as the blob needs.
    pub stack: usize,
    /// Bytes for pictures: a [`Workspace`](gridel_core::Workspace) for the blob's stack and the scene's ray depth,
    /// including the stack.
    pub workspace: usize,
}

/// Returns the working memory of every format, on machines of 32 bits and on this one.
///
/// For 32 bits an `f64` is taken to be aligned to 8 bytes, as on Arm and RISC-V.
///
/// ```
/// # use gridel_host::compile::{Options, compile};
/// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
/// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
/// # let blob = compile(&imported.scene, &Options::default())?.blob;
/// # let scene = blob.scene()?;
/// for need in gridel_host::measure::working_memory(&scene) {
///     println!("{}, {} bits: {} bytes", need.format, need.word_bits, need.workspace);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn working_memory(scene: &Scene<'_>) -> Vec<WorkingMemory> {
    let bits = [4, size_of::<usize>()];
    let words = if bits[0] == bits[1] {
        &bits[..1]
    } else {
        &bits[..]
    };
    let depth = scene.view().depth;
    let of = |&word| Format::ALL.map(|format| WorkingMemory::new(scene, format, depth, word));
    words.iter().flat_map(of).collect()
}

/// Returns the working memory of one format on a board of 32 bits, for pictures of some ray depth.
pub fn board_memory(scene: &Scene<'_>, format: Format, depth: u8) -> WorkingMemory {
    WorkingMemory::new(scene, format, depth, 4)
}

impl WorkingMemory {
    /// Returns the memory for a machine word of `word` bytes.
    fn new(scene: &Scene<'_>, format: Format, depth: u8, word: usize) -> Self {
        let effects = scene.effects();
        let places = effects.work_depth(depth);
        let entries = scene.stack_depth();
        let (stack, workspace) = match format {
            Format::Fixed => {
                bytes::<Fixed>(word, entries, [places, bytes_per_ray::<Fixed>(effects)])
            }
            Format::F32 => bytes::<f32>(word, entries, [places, bytes_per_ray::<f32>(effects)]),
            Format::F64 => bytes::<f64>(word, entries, [places, bytes_per_ray::<f64>(effects)]),
        };
        Self {
            format: format.name(),
            word_bits: 8 * word,
            stack,
            workspace,
        }
    }
}

/// Returns the sizes of a stack and of a workspace where a machine word has `word` bytes. Both are arrays, each
/// followed by its length, a word. `rays` is the number of waiting rays, and the bytes of each.
fn bytes<N: Number>(word: usize, depth: usize, rays: [usize; 2]) -> (usize, usize) {
    let array = |count: usize, record: usize, alignment: usize| {
        (count * record + word).next_multiple_of(alignment.max(word))
    };
    let [places, place] = rays;
    let stack = array(depth, size_of::<Entry>(), align_of::<Entry>());
    let work = array(places, place, align_of::<N>());
    let workspace = (stack + work).next_multiple_of(align_of::<N>().max(word));
    (stack, workspace)
}

#[cfg(test)]
mod tests {
    use super::*;
    use gridel_core::{Effects, Stack, Workspace};

    /// The sizes equal the compiler's for the machine that runs the test.
    #[test]
    fn sizes_are_the_compilers() {
        let word = size_of::<usize>();
        fn workspaces<N: Number>(word: usize) {
            let ray = bytes_per_ray::<N>(Effects::ALL);
            assert_eq!(
                bytes::<N>(word, 0, [0, ray]),
                (size_of::<Stack<0>>(), size_of::<Workspace<N, 0, 0>>())
            );
            assert_eq!(
                bytes::<N>(word, 7, [6, ray]),
                (size_of::<Stack<7>>(), size_of::<Workspace<N, 7, 6>>())
            );
            assert_eq!(
                bytes::<N>(word, 12, [1, ray]),
                (size_of::<Stack<12>>(), size_of::<Workspace<N, 12, 1>>())
            );
            assert_eq!(
                bytes::<N>(word, 48, [17, ray]),
                (size_of::<Stack<48>>(), size_of::<Workspace<N, 48, 17>>())
            );
        }
        workspaces::<Fixed>(word);
        workspaces::<f32>(word);
        workspaces::<f64>(word);
    }

    /// The figures that the core's documentation states.
    #[test]
    fn boards_need_12_bytes_per_entry_and_40_per_ray() {
        let [none, nested] = [Effects::NONE, Effects::NESTED];
        assert_eq!(
            bytes::<f32>(4, 10, [6, bytes_per_ray::<f32>(none)]),
            (124, 124 + 244)
        );
        assert_eq!(
            bytes::<Fixed>(4, 10, [6, bytes_per_ray::<Fixed>(none)]),
            (124, 124 + 244)
        );
        assert_eq!(
            bytes::<f64>(4, 10, [6, bytes_per_ray::<f64>(none)]),
            (124, 128 + 488)
        );
        assert_eq!(bytes_per_ray::<f32>(nested), 44);
        assert_eq!(bytes_per_ray::<Fixed>(nested), 44);
        assert_eq!(bytes_per_ray::<f64>(nested), 80);
    }
}
