//! Options for reading and compiling scene files.

use super::light::{LightChange, light};
use super::values::{cutoff, exposure, first_given, quoted, vector};
use super::view::ViewOptions;
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use glam::DVec3;
use gridel_core::Effects;
use gridel_host::scene::{self, Instances, MoleculeStyle, NormalsChoice, ToneMapping};
use std::num::NonZeroUsize;
use std::path::Path;
use std::str::FromStr;

/// Help for the argument that names a scene file.
pub fn scene_help() -> String {
    format!(
        "Scene file: {}; or `-` for standard input",
        scene::extensions()
    )
}

/// Help for the argument that names a scene file, with a line for each format.
pub fn scene_long_help() -> String {
    let lines = scene::IMPORTERS.iter().map(|it| it.to_string());
    format!(
        "Scene file, which may be gzipped; or `-` for standard input:\n{}",
        lines.collect::<Vec<_>>().join("\n")
    )
}

/// Options for reading and compiling a scene file, for commands that make pictures of it.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Options for camera and lights")]
pub struct SceneOptions {
    /// Do not trace secondary rays that change every channel by less than this; 1 is display white
    /// [default: that of the scene file]
    #[arg(long, value_name = "X", value_parser = cutoff, allow_hyphen_values = true)]
    pub cutoff: Option<f64>,

    /// Multiply all light with 2 to the power of this, -32 to 32 [default: that of the scene file, or 0]
    #[arg(long, value_name = "STOPS", value_parser = exposure, allow_hyphen_values = true)]
    pub exposure: Option<f64>,

    /// Map the brightness of pixels to the range of a display [default: that of the scene]
    #[arg(long, value_name = "CURVE", value_parser = tone_mapping())]
    pub tone_mapping: Option<ToneMapping>,

    #[command(flatten)]
    pub view: ViewOptions,

    /// Change the position, direction or color of a light, counted from 0, such as 0.position=1,2.5,-3; may
    /// be repeated. Exposure multiplies the color of a scene file's light; to render a blob, give a color that
    /// includes it
    #[arg(long = "light", value_name = "N.NAME=X,Y,Z", value_parser = light, allow_hyphen_values = true)]
    pub lights: Vec<LightChange>,

    #[command(flatten)]
    pub geometry: GeometryOptions,

    /// The time of `--time`, in seconds.
    #[arg(skip)]
    pub time: Option<f64>,

    /// The time at which a shutter opens, in seconds. Copies of instances are placed for this time, and all else that
    /// moves is blurred.
    #[arg(skip)]
    pub opening: Option<f64>,
}

/// Options for reading and compiling the geometry of a scene file.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Options for scene files")]
pub struct GeometryOptions {
    /// Bits of the lattice for coordinates, 10 to 24; 16 or fewer make the blob smaller [default:
    /// 24]
    #[arg(long, value_name = "N", value_parser = super::values::lattice_bits())]
    pub lattice_bits: Option<u8>,

    /// Scene units by which vertices can move along each axis, for meshes that a program deforms. Builds `bvh` beside
    /// the list; with `--accel`, no other structure can be named [default: 0]
    #[arg(long, value_name = "UNITS", value_parser = super::values::room)]
    pub room: Option<f64>,

    /// Most bytes of all textures, such as 64K; they are stored with fewer colors or fewer texels to fit
    /// [default: no limit]
    #[arg(long, value_name = "N", value_parser = super::values::bytes)]
    pub texture_bytes: Option<u64>,

    #[command(flatten)]
    pub import: ImportOptions,
}

impl GeometryOptions {
    /// Returns the given options as they follow a file's name.
    pub fn written(&self) -> String {
        let Self {
            lattice_bits,
            room,
            texture_bytes,
            import,
        } = self;
        let bits = lattice_bits.map_or(String::new(), |bits| format!(" --lattice-bits {bits}"));
        let room = room.map_or(String::new(), |room| format!(" --room {room}"));
        let textures =
            texture_bytes.map_or(String::new(), |most| format!(" --texture-bytes {most}"));
        format!("{}{bits}{room}{textures}", import.written())
    }

    /// Returns the command that explains the scene of an input, up to the pixel or the ray.
    pub fn explain_command(&self, input: &Path) -> String {
        let input = quoted(&input.to_string_lossy());
        format!("gridel explain {input}{}", self.written())
    }
}

/// Options for reading a scene file.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Options for scene files")]
pub struct ImportOptions {
    /// Allow the scene file to name files outside of its folder
    #[arg(long)]
    pub allow_outside: bool,

    /// Camera of a glTF file, by its name or that of its node [default: the first with a perspective]
    #[arg(long, value_name = "NAME")]
    camera: Option<String>,

    /// Animation of a glTF file, by its name or its number from 0; moves objects, cameras and lights; `none` leaves
    /// all out [default: the first]
    #[arg(long, value_name = "ID")]
    animation: Option<String>,

    /// Keep parts that are placed several times as instances, or copy their objects [default: keep]
    #[arg(long, value_parser = instances())]
    instances: Option<Instances>,

    /// Normals of meshes: those of the file, those of the faces, or smooth where faces meet at less than an angle in
    /// degrees, such as smooth=40 [default: file]
    #[arg(long, value_name = "file|flat|smooth=DEG", value_parser = NormalsChoice::from_str)]
    normals: Option<NormalsChoice>,

    /// Biological assembly of a PDB or mmCIF file, by its number or name [default: the atoms that the file lists]
    #[arg(long, value_name = "ID")]
    assembly: Option<String>,

    /// Effects to leave out, separated by commas. The blob and its program have no code for them; the output says what
    /// the picture loses
    #[arg(long, value_name = "EFFECT", value_parser = effect(), value_delimiter = ',')]
    pub without: Vec<Effects>,

    #[command(flatten)]
    pub molecule: MoleculeOptions,
}

/// Options for reading molecules.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Options for scene files")]
pub struct MoleculeOptions {
    /// Style of molecules [default: space-filling]
    #[arg(long, value_parser = style())]
    style: Option<MoleculeStyle>,

    /// Model of a molecule file, counted from 1 [default: 1]
    #[arg(long, value_name = "N")]
    model: Option<NonZeroUsize>,

    /// Alternate location of atoms [default: the first of each residue]
    #[arg(long, value_name = "C")]
    altloc: Option<char>,
}

impl SceneOptions {
    /// Returns the name of an option that was given, if one was.
    pub fn given(&self) -> Option<&'static str> {
        self.geometry.given().or(self.given_for_pictures())
    }

    /// Returns the name of a given option that concerns the content of a blob other than its geometry.
    pub fn given_for_pictures(&self) -> Option<&'static str> {
        first_given([
            (self.cutoff.is_some(), "--cutoff"),
            (self.exposure.is_some(), "--exposure"),
            (self.tone_mapping.is_some(), "--tone-mapping"),
            (!self.lights.is_empty(), "--light"),
        ])
        .or(first_given(self.view.given()))
    }
}

impl GeometryOptions {
    /// Returns the name of an option that was given, if one was.
    pub fn given(&self) -> Option<&'static str> {
        first_given([
            (self.lattice_bits.is_some(), "--lattice-bits"),
            (self.room.is_some(), "--room"),
            (self.texture_bytes.is_some(), "--texture-bytes"),
            (self.import.allow_outside, "--allow-outside"),
            (self.import.instances.is_some(), "--instances"),
            (self.import.normals.is_some(), "--normals"),
            (self.import.assembly.is_some(), "--assembly"),
            (!self.import.without.is_empty(), "--without"),
        ])
        .or(self.import.given_for_gltf())
        .or(self.import.molecule.given())
    }
}

impl SceneOptions {
    /// Returns the options for importers.
    pub fn for_import(&self) -> scene::ImportOptions {
        scene::ImportOptions {
            time: self.time.or(self.opening),
            ..self.geometry.import.for_import()
        }
    }

    /// Sets the size of the picture, if one is given.
    pub fn sized(mut self, size: Option<[u16; 2]>) -> Self {
        self.view.size = size;
        self
    }

    /// Sets the time that a scene is shown at, if one is given.
    pub fn at(mut self, time: Option<f64>) -> Self {
        self.time = time;
        self
    }

    /// Sets the time at which a shutter opens, if one does.
    pub fn opening_at(mut self, time: Option<f64>) -> Self {
        self.opening = time;
        self
    }
}

impl From<GeometryOptions> for SceneOptions {
    fn from(geometry: GeometryOptions) -> Self {
        Self {
            geometry,
            ..Self::default()
        }
    }
}

impl ImportOptions {
    pub fn written(&self) -> String {
        let outside = if self.allow_outside {
            " --allow-outside"
        } else {
            ""
        };
        let choice = |option: &str, name: &Option<String>| match name {
            Some(name) => format!(" --{option} {}", quoted(name)),
            None => String::new(),
        };
        let camera = choice("camera", &self.camera);
        let animation = choice("animation", &self.animation);
        let instances = self
            .instances
            .map_or(String::new(), |it| format!(" --instances {}", it.name()));
        let assembly = choice("assembly", &self.assembly);
        let normals = match self.normals {
            Some(NormalsChoice::File) => String::from(" --normals file"),
            Some(NormalsChoice::Flat) => String::from(" --normals flat"),
            Some(NormalsChoice::Smooth(degrees)) => format!(" --normals smooth={degrees}"),
            None => String::new(),
        };
        let without: Vec<_> = self.without.iter().map(|it| it.to_string()).collect();
        let without = match without.is_empty() {
            true => String::new(),
            false => format!(" --without {}", without.join(",")),
        };
        let molecule = self.molecule.written();
        format!("{outside}{camera}{animation}{instances}{assembly}{normals}{without}{molecule}")
    }

    /// Returns the name of an option for glTF files, if one was given.
    pub fn given_for_gltf(&self) -> Option<&'static str> {
        first_given([
            (self.camera.is_some(), "--camera"),
            (self.animation.is_some(), "--animation"),
        ])
    }

    /// Returns the name of an option for files with assemblies, if one was given.
    pub fn given_for_assemblies(&self) -> Option<&'static str> {
        first_given([(self.assembly.is_some(), "--assembly")])
    }

    /// Returns the effects to leave out.
    pub fn left_out(&self) -> Effects {
        let each = self.without.iter();
        each.fold(Effects::NONE, |all, effect| all.with(*effect))
    }

    /// The options for importers.
    fn for_import(&self) -> scene::ImportOptions {
        scene::ImportOptions {
            time: None,
            molecule: self.molecule.for_import(),
            assembly: self.assembly.clone(),
            instances: self.instances.unwrap_or_default(),
            gltf: scene::GltfOptions {
                camera: self.camera.clone(),
                animation: self.animation.clone(),
            },
            normals: self.normals.unwrap_or_default(),
            allow_outside: self.allow_outside,
        }
    }
}

impl MoleculeOptions {
    /// Returns the name of an option that was given, if one was.
    pub fn given(&self) -> Option<&'static str> {
        first_given([
            (self.style.is_some(), "--style"),
            (self.model.is_some(), "--model"),
            (self.altloc.is_some(), "--altloc"),
        ])
    }

    fn written(&self) -> String {
        let style = self.style.map(|style| format!(" --style {}", style.name()));
        let model = self.model.map(|model| format!(" --model {model}"));
        let altloc = self.altloc.map(String::from);
        let altloc = altloc.map(|place| format!(" --altloc {}", quoted(&place)));
        [style, model, altloc].into_iter().flatten().collect()
    }

    fn for_import(&self) -> scene::MoleculeOptions {
        let default = scene::MoleculeOptions::default();
        scene::MoleculeOptions {
            style: self.style.unwrap_or(default.style),
            model: self.model.map_or(default.model, NonZeroUsize::get),
            altloc: self.altloc,
        }
    }
}

/// The option `--target` of commands that take no board.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Options for camera and lights")]
pub struct TargetPoint {
    /// Look at this point. With a track `camera.orbit` the orbit of a scene file turns about it, that of a blob does
    /// not [default: the file's, or the middle of the scene]
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true,
        display_order = 101)]
    target: Option<DVec3>,
}

impl TargetPoint {
    /// Returns the options for scene files, with this point.
    pub fn with_target(&self, options: &SceneOptions) -> SceneOptions {
        let mut options = options.clone();
        options.view.target = self.target;
        options
    }
}

fn effect() -> impl TypedValueParser<Value = Effects> {
    PossibleValuesParser::new(Effects::NAMED.map(|(_, name)| name))
        .try_map(|name| scene::effect_named(&name).ok_or("no such effect"))
}

fn tone_mapping() -> impl TypedValueParser<Value = ToneMapping> {
    one_of(ToneMapping::ALL, ToneMapping::name)
}

fn instances() -> impl TypedValueParser<Value = Instances> {
    one_of(Instances::ALL, Instances::name)
}

fn style() -> impl TypedValueParser<Value = MoleculeStyle> {
    one_of(MoleculeStyle::ALL, MoleculeStyle::name)
}

/// Returns a parser of the name of one of some things.
fn one_of<T: Copy + Send + Sync + 'static, const N: usize>(
    all: [T; N],
    name: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(all.map(name)).try_map(move |word| {
        let found = all.into_iter().find(|&it| name(it) == word);
        found.ok_or("no such value")
    })
}
