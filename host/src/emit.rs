//! Writes a scene as Rust: a module with the aligned blob, its limits as constants, and the types
//! that have exactly the memory that it needs.

use crate::board::Board;
use gridel_core::render::work_depth;
use gridel_core::{Effects, Format, Kind, Scene, Structure, Vouched};
use std::fmt::Write;

/// The names of the module's two files.
pub const MODULE: &str = "scene.rs";
pub const BLOB: &str = "scene.gridel";

/// What a module is written for.
#[derive(Clone, Copy, Debug)]
pub struct Emitted<'s> {
    pub scene: &'s Scene<'s>,
    pub structure: Structure,
    pub format: Format,
    /// Bytes that the blob may take, and the board whose they are.
    pub budget: Option<(u64, &'static Board)>,
}

impl Emitted<'_> {
    /// The Cargo features of `gridel-core` that the scene calls for.
    pub fn features(&self) -> Vec<&'static str> {
        let structure = Some(self.structure.name()).filter(|_| self.structure != Structure::List);
        structure.into_iter().chain(self.scene.features()).collect()
    }

    /// The module's text.
    pub fn module(&self) -> String {
        let scene = self.scene;
        let view = scene.view();
        let (number, structure) = (number(self.format), format!("{:?}", self.structure));
        let secondary = Effects::MIRROR.with(Effects::GLASS);
        // Where no ray causes another none has to wait.
        let waiting = if scene.effects().0 & secondary.0 == 0 {
            0
        } else {
            work_depth(view.depth)
        };
        let mut kinds = String::new();
        for kind in Kind::ALL.into_iter().filter(|&kind| scene.count(kind) > 0) {
            let name = kind.name();
            // Writing to a string cannot fail.
            let _ = write!(
                kinds,
                "    assert!(\n        gridel_core::Kind::{kind:?}.is_available(),\n        \
                 \"the scene holds primitives of the kind {name}: enable that feature of gridel-core\"\n    );\n"
            );
        }
        if let Some((bytes, board)) = self.budget {
            let _ = write!(
                kinds,
                "    assert!(\n        BLOB_BYTES <= {bytes},\n        \
                 \"the blob outgrew the flash of {}, of which {bytes} bytes are left for it\"\n    );\n",
                board.name
            );
        }
        let others = Structure::ALL.into_iter().filter(|&it| scene.holds(it));
        let vouched = others
            .into_iter()
            .all(|it| Vouched::STRUCTURES.contains(&it));
        let load = if vouched { LOAD_VOUCHED } else { LOAD_CHECKED };
        let features: Vec<_> = self.features().iter().map(|it| format!("{it:?}")).collect();
        format!(
            "// Written by `gridel build --emit-rust`; the scene is in `{BLOB}` beside this file.\n\
             //\n\
             // In Cargo.toml, exactly what the scene calls for:\n\
             //\n\
             // gridel-core = {{ default-features = false, features = [{features}] }}\n\
             //\n\
             // Where flash is short, the feature \"small\" beside them and opt-level = \"z\" in the profile\n\
             // halve the code. Rays take longer then, and every bit stays.\n\
             \n\
             /// The scene blob, aligned, in flash.\n\
             pub static BLOB: &[u8] = gridel_core::include_blob!(\"{BLOB}\");\n\
             /// Bytes of the blob.\n\
             pub const BLOB_BYTES: usize = BYTES.len();\n\
             /// Entries of the traversal stack.\n\
             pub const STACK_DEPTH: usize = {stack};\n\
             /// Places for rays that wait.\n\
             pub const WORK_DEPTH: usize = {waiting};\n\
             /// The effects that the scene calls for: {effects}.\n\
             pub const EFFECTS: u32 = {bits};\n\
             /// Pixels of a row.\n\
             pub const WIDTH: usize = {width};\n\
             /// Rows.\n\
             pub const HEIGHT: usize = {height};\n\
             \n\
             /// The number format.\n\
             pub type Number = {number};\n\
             /// The acceleration structure.\n\
             pub type Accel = gridel_core::{structure};\n\
             /// A traversal stack for rays of one's own, exactly deep enough.\n\
             pub type Stack = gridel_core::Stack<STACK_DEPTH>;\n\
             /// All that pictures write to beside their pixels, exactly large enough.\n\
             pub type Space = gridel_core::Workspace<Number, STACK_DEPTH, WORK_DEPTH>;\n\
             /// The renderer, with the code of the scene's effects.\n\
             pub type Picture<'s> = gridel_core::Renderer<'s, 'static, Number, Accel, EFFECTS>;\n\
             \n\
             {load}\
             \n\
             const BYTES: &[u8] = include_bytes!(\"{BLOB}\");\n\
             \n\
             // A blob that is not the one that this was written for does not compile.\n\
             const _: () = {{\n    \
             use gridel_core::Effects;\n    \
             use gridel_core::blob::record::Header;\n    \
             const fn half(at: usize) -> usize {{\n        \
             BYTES[at] as usize | (BYTES[at + 1] as usize) << 8\n    }}\n    \
             let depth = half(core::mem::offset_of!(Header, stack_depth));\n    \
             assert!(\n        depth <= STACK_DEPTH,\n        \
             \"the blob outgrew STACK_DEPTH: write this module again\"\n    );\n    \
             let called = half(core::mem::offset_of!(Header, effects));\n    \
             assert!(\n        Effects(EFFECTS).contains(Effects(called as u32)),\n        \
             \"the blob calls for effects beyond EFFECTS: write this module again\"\n    );\n    \
             assert!(\n        Effects::AVAILABLE.contains(Effects(EFFECTS)),\n        \
             \"the scene calls for effects whose features of gridel-core are not enabled\"\n    );\n\
             {kinds}\
             }};\n",
            features = features.join(", "),
            stack = scene.stack_depth(),
            effects = scene.effects(),
            bits = scene.effects().0,
            width = view.width,
            height = view.height,
        )
    }
}

/// Loading that was prepared while the module was compiled.
const LOAD_VOUCHED: &str = "\
/// The scene, in constant time: what makes every walk end was proved while this was compiled.
pub fn load() -> Result<gridel_core::Scene<'static>, gridel_core::BlobError> {
    #[allow(long_running_const_eval)]
    static VOUCHED: gridel_core::Vouched<'static> = match gridel_core::Vouched::of(BLOB) {
        Ok(vouched) => vouched,
        Err(_) => panic!(\"the blob was damaged: write it and this module again\"),
    };
    gridel_core::Scene::vouched(VOUCHED)
}
";

/// Loading that proves everything.
const LOAD_CHECKED: &str = "\
/// The scene, checked: of a blob with this structure everything is proved when it is loaded.
pub fn load() -> Result<gridel_core::Scene<'static>, gridel_core::BlobError> {
    gridel_core::Scene::from_bytes(BLOB)
}
";

fn number(format: Format) -> &'static str {
    match format {
        Format::Fixed => "gridel_core::Fixed",
        Format::F32 => "f32",
        Format::F64 => "f64",
    }
}
