//! The options for reading a scene file, and the result.

use super::model::Scene;
use super::normals::NormalsChoice;
use serde::{Deserialize, Serialize};
use std::fmt::Display;
use std::path::PathBuf;

/// Choices that a molecule file leaves to a person.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MoleculeOptions {
    pub style: MoleculeStyle,
    /// The model of the file, counted from 1.
    pub model: usize,
    /// The alternate location; without one the first that each residue has.
    pub altloc: Option<char>,
}

/// The drawing of atoms and bonds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MoleculeStyle {
    /// Atoms as spheres of their van der Waals radius.
    SpaceFilling,
    /// Small spheres, and bonds as cylinders in the colors of the atoms at their ends.
    BallAndStick,
}

impl MoleculeStyle {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::SpaceFilling, Self::BallAndStick];

    /// Returns its name in scene files and options.
    pub const fn name(self) -> &'static str {
        match self {
            Self::SpaceFilling => "space-filling",
            Self::BallAndStick => "ball-and-stick",
        }
    }
}

impl Default for MoleculeOptions {
    fn default() -> Self {
        Self {
            style: MoleculeStyle::SpaceFilling,
            model: 1,
            altloc: None,
        }
    }
}

/// A scene, and warnings of the parts that its importer ignored.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    pub scene: Scene,
    /// Sentences for the user, each with file and line.
    pub warnings: Vec<String>,
    /// The kinds of the files that were read.
    pub kinds: FileKinds,
    /// The placements at which moving instances were copied, if they were.
    pub posed: Option<Posed>,
    /// Number of instances that were copied, as [`ImportOptions::instances`] requires.
    pub copied: usize,
    /// The files of a disk that were read: the scene's, and those that it names.
    pub files: Vec<PathBuf>,
}

impl Imported {
    /// A scene from a file of a kind that takes no options of its own.
    pub(super) fn of(scene: Scene, warnings: Vec<String>) -> Self {
        Self {
            scene,
            warnings,
            kinds: FileKinds::default(),
            posed: None,
            copied: 0,
            files: Vec::new(),
        }
    }
}

/// The kinds of a file and of those that it imports, as far as options are for some of them alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FileKinds {
    /// True if there is a molecule, to which [`MoleculeOptions`] apply.
    pub molecules: bool,
    /// True if there is a glTF file, to which [`GltfOptions`] apply.
    pub gltf: bool,
    /// True if there is a file that can hold assemblies, to which [`ImportOptions::assembly`] applies.
    pub assemblies: bool,
}

impl FileKinds {
    /// Returns the kinds of two files together.
    pub(super) fn with(self, other: Self) -> Self {
        Self {
            molecules: self.molecules || other.molecules,
            gltf: self.gltf || other.gltf,
            assemblies: self.assemblies || other.assemblies,
        }
    }

    /// Returns why an option does not apply to a file of these kinds; `None` if it applies. Options have the names that
    /// they have in TOML and in Python.
    ///
    /// ```
    /// use gridel_host::scene::FileKinds;
    ///
    /// let why = FileKinds::default().inapplicable("assembly", &"ball.toml");
    /// let expected = "is for PDB and mmCIF files, and ball.toml is none of these";
    /// assert_eq!(why.as_deref(), Some(expected));
    /// ```
    pub fn inapplicable(&self, option: &str, file: &dyn Display) -> Option<String> {
        let (applies, kinds) = match option {
            "style" | "model" | "altloc" => {
                (self.molecules, "molecules (PDB, mmCIF and XYZ files)")
            }
            "camera" | "animation" => (self.gltf, "glTF files"),
            "assembly" => (self.assemblies, "PDB and mmCIF files"),
            _ => return None,
        };
        (!applies).then(|| format!("is for {kinds}, and {file} is none of these"))
    }
}

/// The placements of [copies](Instances::Flatten) of moving instances.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Posed {
    /// The placements at rest.
    AtRest,
    /// The placements at [a time](ImportOptions::time).
    AtTime,
    /// The placements at any time: no instance hangs on the joints that tracks move.
    Always,
}

/// The camera and the animation of a glTF file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GltfOptions {
    /// The name of a camera or of its node; without one the first that has a perspective.
    pub camera: Option<String>,
    /// The name of an animation, or its number from 0; `none` for no animation, unless one has this name; without one
    /// the first.
    pub animation: Option<String>,
}

/// The treatment of instances.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Instances {
    /// Parts are stored once, and instances place them.
    #[default]
    Keep,
    /// Each instance becomes objects of its own.
    Flatten,
}

impl Instances {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Keep, Self::Flatten];

    /// Returns its name in manifests and options.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Keep => "keep",
            Self::Flatten => "flatten",
        }
    }
}

/// Options for reading a scene file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ImportOptions {
    /// Choices that a molecule file leaves open.
    pub molecule: MoleculeOptions,
    /// The assembly of a PDB or mmCIF file, by its number or name. Default: the atoms that the file
    /// lists.
    pub assembly: Option<String>,
    /// The camera and the animation of a glTF file.
    pub gltf: GltfOptions,
    /// The treatment of instances.
    pub instances: Instances,
    /// The time in seconds at which instances are copied where they move; without one they are copied at rest.
    pub time: Option<f64>,
    /// The normals with which meshes are shaded.
    pub normals: NormalsChoice,
    /// True if the file may name files outside of its folder: imports, materials, buffers. A scene from elsewhere could
    /// then read any file of the user.
    pub allow_outside: bool,
}
