//! Writes a scene as a Rust module. It holds the aligned blob, its limits as constants, and types with exactly the
//! memory that the scene needs.

mod names;

use crate::compile::Names;
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
    /// Names for constants, which the blob itself need not have.
    pub names: &'s Names,
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
    /// use gridel_host::compile::Names;
    /// use gridel_host::emit::Emitted;
    ///
    /// let emitted = Emitted {
    ///     scene: &scene,
    ///     structure: Structure::DualSplit,
    ///     format: Format::Fixed,
    ///     blob: blob.bytes(),
    ///     names: &Names::of_scene(&imported.scene),
    ///     budget: None,
    /// };
    /// assert!(emitted.features().contains(&"sphere"));
    /// let module = emitted.module();
    /// assert!(module.contains("pub static BLOB"));
    /// assert!(module.contains("pub const BALL: u32 = 0;"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn module(&self) -> String {
        let scene = self.scene;
        let view = scene.view();
        let features: Vec<_> = self.features().iter().map(|it| format!("{it:?}")).collect();
        let effects = scene.effects_with_parts();
        let exponent = scene.coordinate_exponent();
        let values = [
            ("@FIRST", FIRST.to_owned()),
            ("@BLOB", BLOB.to_owned()),
            ("@FEATURES", features.join(", ")),
            ("@STACK_DEPTH", scene.stack_depth().to_string()),
            (
                "@WORK_DEPTH",
                scene.effects().work_depth(view.depth).to_string(),
            ),
            ("@PARTS", scene.parts().len().to_string()),
            ("@EFFECT_NAMES", effects.to_string()),
            ("@EFFECT_BITS", effects.0.to_string()),
            ("@WIDTH", view.width.to_string()),
            ("@HEIGHT", view.height.to_string()),
            ("@EXPONENT", exponent.to_string()),
            (
                "@ORIGIN",
                format!("{:?}", scene.header().coordinate_origin()),
            ),
            ("@UNIT", scene_unit(exponent)),
            ("@NUMBER", number(self.format).to_owned()),
            ("@ACCEL", format!("{:?}", self.structure)),
            ("@OBJECTS", scene.header().objects.to_string()),
            ("@MATERIALS", scene.materials().len().to_string()),
            ("@LIGHTS", scene.lights().len().to_string()),
            ("@NAMES", names::constants(scene, self.names)),
            ("@MESH", self.mesh()),
            ("@LOAD", self.load()),
            ("@CHECKS", self.checks()),
        ];
        filled(TEXT, &values)
    }

    /// The function that loads the blob.
    fn load(&self) -> String {
        if self.scene.parts().is_empty() {
            return match self
                .scene
                .structures()
                .all(|it| Prevalidated::STRUCTURES.contains(&it))
            {
                true => LOAD_PREVALIDATED.to_owned(),
                false => LOAD_CHECKED.to_owned(),
            };
        }
        // They were checked with the scene.
        let tracks = Tracks::from_bytes(self.blob).ok();
        let joints = tracks.map_or(0, |tracks| tracks.joints().len());
        let instances = self.scene.instances().len();
        let values = [
            ("@INSTANCES", instances.to_string()),
            ("@JOINTS", joints.to_string()),
        ];
        filled(LOAD_WITH_PARTS, &values)
    }

    /// The checks that not every module has.
    fn checks(&self) -> String {
        let mut checks = String::new();
        if !self.scene.parts().is_empty() {
            checks += CHECK_PARTS;
        }
        if let Some(mesh) = Deforming::of_scene(self.scene, self.blob) {
            let values = [
                ("@VERTICES", mesh.vertices.to_string()),
                ("@PAIRS", mesh.pairs.to_string()),
                ("@NORMALS", mesh.normals.to_string()),
                ("@BITS", self.scene.header().storage_bits.to_string()),
            ];
            checks += &filled(CHECK_MESH, &values);
        }
        let targets = [("@TARGETS", self.morph_targets().to_string())];
        checks += &filled(CHECK_TARGETS, &targets);
        if let Some((bytes, board)) = self.budget {
            let values = [
                ("@BUDGET", bytes.to_string()),
                ("@BOARD", board.name.to_owned()),
            ];
            checks += &filled(CHECK_BUDGET, &values);
        }
        checks
    }

    fn morph_targets(&self) -> usize {
        let tracks = Tracks::from_bytes(self.blob).ok();
        tracks.map_or(0, |tracks| tracks.weights_at_rest().len())
    }
}

/// A text with values in place of its markers, but not of those within values: names can be anything.
fn filled(text: &str, values: &[(&str, String)]) -> String {
    let mut filled = String::new();
    let mut rest = text;
    while let Some(start) = rest.find('@') {
        let (before, from) = rest.split_at(start);
        let markers = values.iter().filter(|(marker, _)| from.starts_with(marker));
        let (marker, value) = markers
            .max_by_key(|(marker, _)| marker.len())
            .map_or(("@", "@"), |(marker, value)| (*marker, value));
        filled.extend([before, value]);
        rest = &from[marker.len()..];
    }
    filled + rest
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
        let weights = match self.morph_targets() {
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

/// The module, whose markers begin with `@`.
const TEXT: &str = "\
@FIRST; the scene is in `@BLOB` beside this file.
// In `src`, `mod scene;` takes both in; elsewhere, `#[path = \"...\"]` before it leads here.
//
// In Cargo.toml, exactly what the scene requires:
//
// gridel-core = { default-features = false, features = [@FEATURES] }
//
// The figures of `gridel inspect --target` for flash and RAM hold with lto = \"fat\" and
// codegen-units = 1 in the profile. Where flash is short, the feature \"small\" beside those above
// and opt-level = \"z\" halve the code. Rays take longer then, the call stack grows, and every
// bit stays.

/// The scene blob, aligned, in flash.
pub static BLOB: &[u8] = gridel_core::include_blob!(\"@BLOB\");
/// Bytes of the blob.
#[allow(dead_code)]
pub const BLOB_BYTES: usize = BYTES.len();
/// Entries of the traversal stack.
pub const STACK_DEPTH: usize = @STACK_DEPTH;
/// Places for rays that wait.
pub const WORK_DEPTH: usize = @WORK_DEPTH;
/// Parts that instances place.
pub const PARTS: usize = @PARTS;
/// The effects that the scene requires: @EFFECT_NAMES.
pub const EFFECTS: u32 = @EFFECT_BITS;
/// Pixels of a row.
pub const WIDTH: usize = @WIDTH;
/// Rows.
pub const HEIGHT: usize = @HEIGHT;
/// Objects of the scene.
#[allow(dead_code)]
pub const OBJECTS: usize = @OBJECTS;
/// Materials of the scene.
#[allow(dead_code)]
pub const MATERIALS: usize = @MATERIALS;
/// Lights of the scene.
#[allow(dead_code)]
pub const LIGHTS: usize = @LIGHTS;
/// A coordinate step, that of `gridel_core::Position`, is 2 to this power scene units.
#[allow(dead_code)]
pub const COORDINATE_EXPONENT: i32 = @EXPONENT;
/// The place from which coordinates are counted, in scene units.
#[allow(dead_code)]
pub const COORDINATE_ORIGIN: [f64; 3] = @ORIGIN;
@UNIT\
/// A length of `numerator / denominator` scene units in coordinate steps, for constants. One beyond 32
/// bits does not compile.
#[allow(dead_code)]
pub const fn steps(numerator: i64, denominator: i64) -> i32 {
    match gridel_core::scene::coordinate_steps(COORDINATE_EXPONENT, numerator, denominator) {
        Some(steps) => steps,
        None => panic!(\"the length is beyond the scene's coordinates\"),
    }
}

/// The number format.
pub type Number = @NUMBER;
/// The acceleration structure.
pub type Accel = gridel_core::@ACCEL;
/// A traversal stack for other queries, exactly deep enough.
#[allow(dead_code)]
pub type Stack = gridel_core::Stack<STACK_DEPTH>;
/// All memory that rendering writes to, except pixels, exactly large enough.
#[allow(dead_code)]
pub type Space = gridel_core::Workspace<Number, STACK_DEPTH, WORK_DEPTH>;
/// The renderer, with the code of the scene's effects.
#[allow(dead_code)]
pub type Picture<'s> = gridel_core::Renderer<'s, 's, Number, Accel, EFFECTS>;

@NAMES\
@MESH\
@LOAD
const BYTES: &[u8] = include_bytes!(\"@BLOB\");

// A blob that requires more than this was written for does not compile. Limits of 0 are compared as others are.
#[allow(long_running_const_eval, clippy::absurd_extreme_comparisons)]
const _: () = {
    let Ok(required) = gridel_core::Requirements::of(BYTES) else {
        panic!(\"the blob was cut off: write it and this module again\")
    };
    assert!(
        gridel_core::Effects(EFFECTS).contains(required.effects),
        \"the blob requires effects beyond EFFECTS: write this module again\"
    );
    assert!(
        required.stack_depth <= STACK_DEPTH,
        \"the blob outgrew STACK_DEPTH: write this module again\"
    );
    assert!(
        required.work_depth <= WORK_DEPTH,
        \"the blob outgrew WORK_DEPTH: write this module again\"
    );
    assert!(
        required.parts <= PARTS,
        \"the blob outgrew PARTS: write this module again\"
    );
    assert!(
        required.width == WIDTH && required.height == HEIGHT,
        \"the blob's picture has another size: write this module again\"
    );
    assert!(
        required.holds(gridel_core::Structure::@ACCEL),
        \"the blob does not hold the structure of Accel: write this module again\"
    );
    if let Some(missing) = required.missing() {
        panic!(\"{}\", missing)
    }
    assert!(
        required.counts_as(COORDINATE_EXPONENT, COORDINATE_ORIGIN),
        \"the blob has another COORDINATE_EXPONENT or COORDINATE_ORIGIN: write this module again\"
    );
@CHECKS\
};
";

/// Checks of a scene that places parts.
const CHECK_PARTS: &str = "    \
    assert!(
        required.instances <= INSTANCES,
        \"the blob outgrew INSTANCES: write this module again\"
    );
    assert!(
        required.joints <= JOINTS,
        \"the blob outgrew JOINTS: write this module again\"
    );
";

/// The check of a scene whose vertices move.
const CHECK_MESH: &str = "    \
    assert!(
        required.vertices <= @VERTICES
            && required.pairs <= @PAIRS
            && required.moving_normals <= @NORMALS
            && required.vertex_bits() == @BITS,
        \"the blob outgrew Mesh: write this module again\"
    );
";

/// The check of morph targets, of which a program sets the weights.
const CHECK_TARGETS: &str = "    \
    assert!(
        required.morph_targets == @TARGETS,
        \"the blob has other morph targets: write this module again\"
    );
";

/// The check of what flash has left.
const CHECK_BUDGET: &str = "    \
    assert!(
        BLOB_BYTES <= @BUDGET,
        \"the blob outgrew the flash of @BOARD, of which @BUDGET bytes are left for it\"
    );
";

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
pub const INSTANCES: usize = @INSTANCES;
/// Joints on which they hang.
#[allow(dead_code)]
pub const JOINTS: usize = @JOINTS;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markers_within_values_are_text() {
        let values = [
            ("@NAMES", String::from("a @LOAD b@")),
            ("@LOAD", String::from("fn load")),
            ("@LOADS", String::from("2")),
        ];
        let text = filled("@NAMES, @LOAD, @LOADS, x@LOADER, @", &values);
        assert_eq!(text, "a @LOAD b@, fn load, 2, xfn loadER, @");
    }
}
