//! Writes a scene as a Rust module. It holds the aligned blob, its limits as constants, and types with exactly the
//! memory that the scene needs.

use crate::measure::Deforming;
use crate::measure::board::Board;
use gridel_core::{Format, Prevalidated, Scene, Structure, Tracks};
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// The names of the module's two files.
pub const MODULE: &str = "scene.rs";
pub const BLOB: &str = "scene.gridel";

/// The first line of every module.
const FIRST: &str = "// Written by `gridel build --emit-rust`";

/// Returns whether a file is such a module.
///
/// # Errors
/// If the file cannot be read.
pub fn is_module(path: &Path) -> io::Result<bool> {
    let mut start = Vec::new();
    let file = File::open(path)?;
    file.take(FIRST.len() as u64).read_to_end(&mut start)?;
    Ok(start == FIRST.as_bytes())
}

/// The target of a module.
#[derive(Clone, Copy, Debug)]
pub struct Emitted<'s> {
    pub scene: &'s Scene<'s>,
    /// The bytes of its blob.
    pub blob: &'s [u8],
    pub structure: Structure,
    pub format: Format,
    /// Bytes that the blob may take, and the board whose they are.
    pub budget: Option<(u64, &'static Board)>,
}

impl Emitted<'_> {
    /// Returns the Cargo features of `gridel-core` that the scene requires.
    pub fn features(&self) -> Vec<&'static str> {
        let structure = Some(self.structure.name()).filter(|_| self.structure != Structure::List);
        structure.into_iter().chain(self.scene.features()).collect()
    }

    /// Returns the module's text.
    ///
    /// ```
    /// # use gridel_host::compile::{Options, compile};
    /// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nname = 'ball'";
    /// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
    /// # let blob = compile(&imported.scene, &Options::default())?.blob;
    /// # let scene = blob.scene()?;
    /// use gridel_core::{Format, Structure};
    /// use gridel_host::emit::Emitted;
    ///
    /// let emitted = Emitted {
    ///     scene: &scene,
    ///     structure: Structure::DualSplit,
    ///     format: Format::Fixed,
    ///     blob: blob.bytes(),
    ///     budget: None,
    /// };
    /// assert!(emitted.features().contains(&"sphere"));
    /// assert!(emitted.module().contains("pub static BLOB"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn module(&self) -> String {
        let scene = self.scene;
        let view = scene.view();
        let (number, structure) = (number(self.format), format!("{:?}", self.structure));
        let mut budget = String::new();
        if let Some((bytes, board)) = self.budget {
            budget = format!(
                "    assert!(\n        BLOB_BYTES <= {bytes},\n        \
                 \"the blob outgrew the flash of {}, of which {bytes} bytes are left for it\"\n    );\n",
                board.name
            );
        }
        let others = Structure::ALL.into_iter().filter(|&it| scene.holds(it));
        let is_prevalidated = others
            .into_iter()
            .all(|it| Prevalidated::STRUCTURES.contains(&it));
        let (parts, effects) = (scene.parts().len(), scene.effects_with_parts());
        // They were checked with the scene.
        let tracks = Tracks::from_bytes(self.blob).ok();
        let joints = tracks.map_or(0, |tracks| tracks.joints().len());
        let with_parts = LOAD_WITH_PARTS
            .replace("INSTANCES_COUNT", &scene.instances().len().to_string())
            .replace("JOINTS_COUNT", &joints.to_string());
        let load = match parts {
            0 if is_prevalidated => LOAD_PREVALIDATED,
            0 => LOAD_CHECKED,
            _ => &with_parts,
        };
        let features: Vec<_> = self.features().iter().map(|it| format!("{it:?}")).collect();
        format!(
            "{FIRST}; the scene is in `{BLOB}` beside this file.\n\
             // In `src`, `mod scene;` takes both in; elsewhere, `#[path = \"...\"]` before it leads here.\n\
             //\n\
             // In Cargo.toml, exactly what the scene requires:\n\
             //\n\
             // gridel-core = {{ default-features = false, features = [{features}] }}\n\
             //\n\
             // The figures of `gridel inspect --target` for flash and RAM hold with lto = \"fat\" and\n\
             // codegen-units = 1 in the profile. Where flash is short, the feature \"small\" beside those above\n\
             // and opt-level = \"z\" halve the code. Rays take longer then, the call stack grows, and every\n\
             // bit stays.\n\
             \n\
             /// The scene blob, aligned, in flash.\n\
             pub static BLOB: &[u8] = gridel_core::include_blob!(\"{BLOB}\");\n\
             /// Bytes of the blob.\n\
             #[allow(dead_code)]\n\
             pub const BLOB_BYTES: usize = BYTES.len();\n\
             /// Entries of the traversal stack.\n\
             pub const STACK_DEPTH: usize = {stack};\n\
             /// Places for rays that wait.\n\
             pub const WORK_DEPTH: usize = {waiting};\n\
             /// Parts that instances place.\n\
             pub const PARTS: usize = {parts};\n\
             /// The effects that the scene requires: {effects}.\n\
             pub const EFFECTS: u32 = {bits};\n\
             /// Pixels of a row.\n\
             pub const WIDTH: usize = {width};\n\
             /// Rows.\n\
             pub const HEIGHT: usize = {height};\n\
             /// A coordinate step, that of `gridel_core::Position`, is 2 to this power scene units.\n\
             #[allow(dead_code)]\n\
             pub const COORDINATE_EXPONENT: i32 = {exponent};\n\
             /// The place from which coordinates are counted, in scene units.\n\
             #[allow(dead_code)]\n\
             pub const COORDINATE_ORIGIN: [f64; 3] = {origin:?};\n\
             {unit}\
             /// A length of `numerator / denominator` scene units in coordinate steps, for constants. One beyond 32\n\
             /// bits does not compile.\n\
             #[allow(dead_code)]\n\
             pub const fn steps(numerator: i64, denominator: i64) -> i32 {{\n    \
             match gridel_core::scene::coordinate_steps(COORDINATE_EXPONENT, numerator, denominator) {{\n        \
             Some(steps) => steps,\n        \
             None => panic!(\"the length is beyond the scene's coordinates\"),\n    \
             }}\n\
             }}\n\
             \n\
             /// The number format.\n\
             pub type Number = {number};\n\
             /// The acceleration structure.\n\
             pub type Accel = gridel_core::{structure};\n\
             /// A traversal stack for other queries, exactly deep enough.\n\
             #[allow(dead_code)]\n\
             pub type Stack = gridel_core::Stack<STACK_DEPTH>;\n\
             /// All memory that rendering writes to, except pixels, exactly large enough.\n\
             #[allow(dead_code)]\n\
             pub type Space = gridel_core::Workspace<Number, STACK_DEPTH, WORK_DEPTH>;\n\
             /// The renderer, with the code of the scene's effects.\n\
             #[allow(dead_code)]\n\
             pub type Picture<'s> = gridel_core::Renderer<'s, 's, Number, Accel, EFFECTS>;\n\
             \n\
             {mesh}\
             {load}\
             \n\
             const BYTES: &[u8] = include_bytes!(\"{BLOB}\");\n\
             \n\
             // A blob that requires more than this was written for does not compile.\n\
             #[allow(long_running_const_eval)]\n\
             const _: () = {{\n    \
             let Ok(required) = gridel_core::Requirements::of(BYTES) else {{\n        \
             panic!(\"the blob was cut off: write it and this module again\")\n    }};\n    \
             assert!(\n        gridel_core::Effects(EFFECTS).contains(required.effects),\n        \
             \"the blob requires effects beyond EFFECTS: write this module again\"\n    );\n    \
             assert!(\n        required.stack_depth <= STACK_DEPTH,\n        \
             \"the blob outgrew STACK_DEPTH: write this module again\"\n    );\n    \
             assert!(\n        required.work_depth <= WORK_DEPTH,\n        \
             \"the blob outgrew WORK_DEPTH: write this module again\"\n    );\n    \
             assert!(\n        required.parts <= PARTS,\n        \
             \"the blob outgrew PARTS: write this module again\"\n    );\n    \
             assert!(\n        required.width == WIDTH && required.height == HEIGHT,\n        \
             \"the blob's picture has another size: write this module again\"\n    );\n    \
             assert!(\n        required.holds(gridel_core::Structure::{structure}),\n        \
             \"the blob does not hold the structure of Accel: write this module again\"\n    );\n    \
             if let Some(missing) = required.missing() {{\n        \
             panic!(\"{{}}\", missing)\n    }}\n\
             {budget}\
             }};\n",
            features = features.join(", "),
            mesh = self.mesh(),
            stack = scene.stack_depth(),
            exponent = scene.coordinate_exponent(),
            origin = scene.header().coordinate_origin(),
            unit = scene_unit(scene.coordinate_exponent()),
            waiting = scene.effects().work_depth(view.depth),
            effects = effects,
            bits = effects.0,
            width = view.width,
            height = view.height,
        )
    }
}

/// The constant that states a scene unit in coordinate steps; nothing where a step is longer than a unit, or the number
/// is beyond 64 bits.
fn scene_unit(exponent: i32) -> String {
    if !(-62..=0).contains(&exponent) {
        return String::new();
    }
    format!(
        "/// A scene unit in coordinate steps, those of `gridel_core::Position`.\n\
         #[allow(dead_code)]\n\
         pub const UNIT: i64 = 1 << {};\n",
        -exponent
    )
}

impl Emitted<'_> {
    /// Returns the number of morph targets and the type of the scene's own deforming mesh as Rust; nothing if no vertex
    /// moves.
    fn mesh(&self) -> String {
        let tracks = Tracks::from_bytes(self.blob).ok();
        let targets = tracks.map_or(0, |tracks| tracks.weights_at_rest().len());
        let weights = match targets {
            0 => String::new(),
            targets => format!(
                "/// Morph targets, each with a weight.\n\
                 #[allow(dead_code)]\n\
                 pub const MORPH_TARGETS: usize = {targets};\n\n"
            ),
        };
        let Some(mesh) = Deforming::of_scene(self.scene, self.blob) else {
            return weights;
        };
        let vertex = match self.scene.header().storage_bits {
            16 => "Vertex16",
            _ => "Vertex24",
        };
        format!(
            "{weights}/// Vertices and boxes of the mesh in RAM, exactly large enough: {} bytes.\n\
             #[allow(dead_code)]\n\
             pub type Mesh = gridel_core::Deformation<\n    \
             gridel_core::format::record::{vertex},\n    {},\n    {},\n    {},\n>;\n\n",
            mesh.bytes, mesh.vertices, mesh.pairs, mesh.normals
        )
    }
}

/// Loading that was prepared while the module was compiled.
const LOAD_PREVALIDATED: &str = "\
/// The scene, in constant time: what makes every walk end was proved while this was compiled.
#[allow(dead_code)]
pub fn load() -> Result<gridel_core::Scene<'static>, gridel_core::BlobError> {
    #[allow(long_running_const_eval)]
    static PREVALIDATED: gridel_core::Prevalidated<'static> = match gridel_core::Prevalidated::of(BLOB) {
        Ok(prevalidated) => prevalidated,
        Err(_) => panic!(\"the blob was damaged, or has other structures: write it and this module again\"),
    };
    gridel_core::Scene::prevalidated(PREVALIDATED)
}
";

/// Loading that proves everything.
const LOAD_CHECKED: &str = "\
/// The scene, checked: of a blob with this structure everything is proved when it is loaded.
#[allow(dead_code)]
pub fn load() -> Result<gridel_core::Scene<'static>, gridel_core::BlobError> {
    gridel_core::Scene::from_bytes(BLOB)
}
";

/// Loading of a scene that places parts, which are loaded before.
const LOAD_WITH_PARTS: &str = "\
/// Instances of the scene.
#[allow(dead_code)]
pub const INSTANCES: usize = INSTANCES_COUNT;
/// Joints on which they hang.
#[allow(dead_code)]
pub const JOINTS: usize = JOINTS_COUNT;
/// Room for the instances where they move.
#[allow(dead_code)]
pub type Poses = gridel_core::Poses<INSTANCES>;

/// Room for the views of the parts that instances place: `Parts::new()`.
pub type Parts = gridel_core::Parts<'static, PARTS>;

/// The scene, checked, with its parts, which are loaded in place.
#[allow(dead_code)]
pub fn load(parts: &mut Parts) -> Result<gridel_core::Scene<'_>, gridel_core::BlobError> {
    parts.load(BLOB)?;
    gridel_core::Scene::with_parts(BLOB, parts)
}
";

fn number(format: Format) -> &'static str {
    match format {
        Format::Fixed => "gridel_core::Fixed",
        Format::F32 => "f32",
        Format::F64 => "f64",
    }
}
