//! Options that several verbs have, and how their values are written.

use super::failure::Failure;
use super::view::{ViewOptions, vector};
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use glam::DVec3;
use gridel_core::accel::hierarchy::direction::DIRECTION_COUNTS;
use gridel_core::format::limits::{MAX_RAY_DEPTH, MAX_SAMPLES};
use gridel_core::{Format, Scene as CoreScene, Settings, Structure};
use gridel_host::board::{BOARDS, Board};
use gridel_host::compile::{self, Builder, Quality, takes_hierarchy};
use gridel_host::report::{Ledger, NotMeasured, Target};
use gridel_host::scene::{self, MoleculeStyle};
use std::ffi::OsStr;
use std::num::NonZeroUsize;
use std::ops::Range;

/// The memory that a scene is to fit into.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Options for boards")]
pub struct TargetOptions {
    /// Board that must hold the scene, by the code and call stack measured for it [default:
    /// stm32vldiscovery, if --ram or --flash is given]
    ///
    /// A point X,Y,Z is not a board, but what the camera of a scene file looks at.
    #[arg(long, value_name = "BOARD|X,Y,Z", value_parser = TargetParser, allow_hyphen_values = true)]
    target: Vec<BoardOrPoint>,

    /// Bytes of RAM, such as 8192 or 8K [default: the board's]
    #[arg(long, value_name = "N", value_parser = bytes)]
    ram: Option<u64>,

    /// Bytes of flash, such as 131072 or 128K [default: the board's]
    #[arg(long, value_name = "N", value_parser = bytes)]
    flash: Option<u64>,
}

impl TargetOptions {
    /// The memory, if any of it is given.
    pub fn target(&self) -> Option<Target> {
        let board = self.target.iter().find_map(BoardOrPoint::board);
        if board.is_none() && self.ram.is_none() && self.flash.is_none() {
            return None;
        }
        let board = board.unwrap_or(&BOARDS[0]);
        Some(Target {
            board,
            flash: self.flash.unwrap_or(board.flash),
            ram: self.ram.unwrap_or(board.ram),
        })
    }

    /// The options for scene files, with the point that the camera is to look at.
    ///
    /// # Errors
    /// If two boards or two points were given.
    pub fn aimed(&self, options: &SceneOptions) -> Result<SceneOptions, Failure> {
        let mut points = self.target.iter().filter_map(BoardOrPoint::point);
        let boards = self.target.iter().filter_map(BoardOrPoint::board);
        if points.clone().count() > 1 || boards.count() > 1 {
            return Err(Failure::usage(
                "--target is given twice for the same",
                "give it once for a board, and once for the point that the camera looks at",
            ));
        }
        let mut options = options.clone();
        options.view.target = points.next();
        Ok(options)
    }

    /// What a scene takes of it, in a number format of the board's.
    ///
    /// # Errors
    /// If the best structure that the blob holds was not measured on boards.
    pub fn ledger(
        &self,
        scene: &CoreScene<'_>,
        blob: &[u8],
        format: Format,
    ) -> Result<Option<Ledger>, Failure> {
        let Some(target) = self.target() else {
            return Ok(None);
        };
        let ledger = Ledger::of(scene, blob, &target, format);
        ledger.map(Some).map_err(|NotMeasured(structure)| {
            Failure::usage(
                format!(
                    "{} was not measured on boards: nothing is known of its code and call stack",
                    structure.name()
                ),
                format!(
                    "build a blob without it, for {}",
                    Ledger::STRUCTURES.map(Structure::name).join(", ")
                ),
            )
        })
    }
}

/// What `--target` names where both make sense.
#[derive(Clone, Copy, Debug)]
enum BoardOrPoint {
    Board(&'static Board),
    Point(DVec3),
}

impl BoardOrPoint {
    fn board(&self) -> Option<&'static Board> {
        match self {
            Self::Board(board) => Some(board),
            Self::Point(_) => None,
        }
    }

    fn point(&self) -> Option<DVec3> {
        match self {
            Self::Board(_) => None,
            Self::Point(point) => Some(*point),
        }
    }
}

/// Points have commas, and boards have none.
#[derive(Clone)]
struct TargetParser;

impl TypedValueParser for TargetParser {
    type Value = BoardOrPoint;

    fn parse_ref(
        &self,
        command: &clap::Command,
        argument: Option<&clap::Arg>,
        value: &OsStr,
    ) -> Result<BoardOrPoint, clap::Error> {
        if value.to_string_lossy().contains(',') {
            let point = |text: &str| vector(text).map(BoardOrPoint::Point);
            return point.parse_ref(command, argument, value);
        }
        let board = board().map(BoardOrPoint::Board);
        board.parse_ref(command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(
            BOARDS
                .map(|board| PossibleValue::new(board.name))
                .into_iter(),
        ))
    }
}

fn board() -> impl TypedValueParser<Value = &'static Board> {
    PossibleValuesParser::new(BOARDS.map(|board| board.name))
        .try_map(|name| Board::named(&name).ok_or("no such board"))
}

/// What rays are traced with.
#[derive(Args, Clone, Debug)]
pub struct TraceOptions {
    /// Number format
    #[arg(long, value_name = "NAME", value_parser = format(), default_value = "f32")]
    pub format: Format,

    /// Acceleration structure [default: the best that the blob holds; for a scene file, render and
    /// trace build wide]
    #[arg(long, value_name = "NAME", value_parser = structure())]
    pub accel: Option<Structure>,

    /// Time to spend on building wide, for a scene file [default: good]
    #[arg(long, value_name = "NAME")]
    pub quality: Option<Quality>,
}

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

/// What of a picture's settings is not as the scene states it.
#[derive(Args, Clone, Debug)]
pub struct PictureOptions {
    /// Size of the whole picture, such as 640x480 [default: that of the scene]
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<[u16; 2]>,

    /// Samples per pixel, 1 to 256 [default: that of the scene]
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u16).range(1..=i64::from(MAX_SAMPLES))
    )]
    samples: Option<u16>,

    /// Reflections and refractions of a ray, 0 to 16 [default: that of the scene]
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u8).range(0..=MAX_RAY_DEPTH as i64)
    )]
    depth: Option<u8>,
}

impl PictureOptions {
    /// The name of an option that a ray of one's own has nothing to do with, if one was given.
    pub fn of_pixels(&self) -> Option<&'static str> {
        first_given([
            (self.size.is_some(), "--size"),
            (self.samples.is_some(), "--samples"),
        ])
    }

    /// The settings for a scene's picture, without dither.
    pub fn settings(&self, scene: &CoreScene<'_>) -> Settings {
        let stated = Settings::of(scene);
        let [width, height] = self.size.unwrap_or([stated.width, stated.height]);
        Settings {
            width,
            height,
            samples: self.samples.unwrap_or(stated.samples),
            depth: self.depth.unwrap_or(stated.depth),
            dither: false,
        }
    }
}

/// How a scene file is read and compiled, for verbs that make pictures of it.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Options for scene files")]
pub struct SceneOptions {
    /// Do not trace secondary rays that change every channel by less than this; 1 is display white
    /// [default: that of the scene file]
    #[arg(long, value_name = "X", value_parser = cutoff, allow_hyphen_values = true)]
    pub cutoff: Option<f64>,

    #[command(flatten)]
    pub view: ViewOptions,

    #[command(flatten)]
    pub geometry: GeometryOptions,
}

/// How the geometry of a scene file is read and compiled.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Options for scene files")]
pub struct GeometryOptions {
    /// Bits of the lattice for coordinates, 10 to 24; 16 or fewer make the blob smaller [default:
    /// 24]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(10..=24))]
    pub lattice_bits: Option<u8>,

    #[command(flatten)]
    pub import: ImportOptions,
}

/// How a scene file is read.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Options for scene files")]
pub struct ImportOptions {
    /// Allow the scene file to name files outside of its folder
    #[arg(long)]
    pub allow_outside: bool,

    #[command(flatten)]
    pub molecule: MoleculeOptions,
}

/// How molecules are read.
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
    /// The name of an option that was given, if one was.
    pub fn given(&self) -> Option<&'static str> {
        let Self {
            cutoff,
            view,
            geometry,
        } = self;
        first_given([
            (geometry.lattice_bits.is_some(), "--lattice-bits"),
            (cutoff.is_some(), "--cutoff"),
            (geometry.import.allow_outside, "--allow-outside"),
        ])
        .or(first_given(view.given()))
        .or(geometry.import.molecule.given())
    }
}

impl From<GeometryOptions> for SceneOptions {
    fn from(geometry: GeometryOptions) -> Self {
        Self {
            cutoff: None,
            view: ViewOptions::default(),
            geometry,
        }
    }
}

impl ImportOptions {
    /// What was given, as it is written behind a file's name.
    pub fn written(&self) -> String {
        let outside = if self.allow_outside {
            " --allow-outside"
        } else {
            ""
        };
        format!("{outside}{}", self.molecule.written())
    }

    /// The options for importers.
    pub fn for_import(&self) -> scene::ImportOptions {
        scene::ImportOptions {
            molecule: self.molecule.for_import(),
            allow_outside: self.allow_outside,
        }
    }
}

impl MoleculeOptions {
    /// The name of an option that was given, if one was.
    pub fn given(&self) -> Option<&'static str> {
        first_given([
            (self.style.is_some(), "--style"),
            (self.model.is_some(), "--model"),
            (self.altloc.is_some(), "--altloc"),
        ])
    }

    fn written(&self) -> String {
        let style = self.style.map(|style| match style {
            MoleculeStyle::SpaceFilling => format!(" --style {SPACE_FILLING}"),
            MoleculeStyle::BallAndStick => format!(" --style {BALL_AND_STICK}"),
        });
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

/// The name of the first option that was given.
fn first_given<const N: usize>(options: [(bool, &'static str); N]) -> Option<&'static str> {
    let mut given = options.into_iter().filter(|(given, _)| *given);
    given.next().map(|(_, name)| name)
}

fn style() -> impl TypedValueParser<Value = MoleculeStyle> {
    PossibleValuesParser::new([SPACE_FILLING, BALL_AND_STICK]).map(|name| match name.as_str() {
        BALL_AND_STICK => MoleculeStyle::BallAndStick,
        _ => MoleculeStyle::SpaceFilling,
    })
}

const SPACE_FILLING: &str = "space-filling";
const BALL_AND_STICK: &str = "ball-and-stick";

/// A word as shells take it for one.
pub fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "/._-+,:=@%".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

/// Reads a cutoff.
pub fn cutoff(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok();
    let value = value.filter(|value| (0.0..=1.0).contains(value));
    value.ok_or_else(|| String::from("write a number from 0 to 1, such as 0.002"))
}

/// How structures are built.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Options for structures")]
pub struct StructureOptions {
    /// Number of directions of slabs [default: 7]
    #[arg(long, value_name = "N", value_parser = directions())]
    slabs: Option<usize>,

    /// Divisions of the grid, 1 to 1024: one number for all axes, or three, such as 8x8x2 [default:
    /// four cells per primitive, fewer if their build needs more than 256M]
    #[arg(long, value_name = "N|NxNxN", value_parser = divisions)]
    grid: Option<[u32; 3]>,

    /// Gridels (rectangles) per side of a cylinder cube's faces, 1 to 64 [default: as many as
    /// --budget allows; at most 4, as in the paper, for `cylinder-cube`]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=64))]
    gridels: Option<u32>,

    /// Largest size in bytes of a table of candidate lists, such as 64K or 1M; for `apex`, per
    /// point or direction [default: 48M for `cylinder-cube`, 4M for `cylinder-cube-tight` and
    /// `ray-classes`, 2M for `cylinder-cube-entry`, 1M for `apex`]
    #[arg(long, value_name = "N", value_parser = bytes)]
    budget: Option<u64>,

    /// Time to spend on building wide [default: good]
    #[arg(long, value_name = "NAME")]
    quality: Option<Quality>,
}

impl StructureOptions {
    /// The options for the compiler.
    ///
    /// # Errors
    /// If an option was given that none of the options' structures takes.
    pub fn apply(&self, options: compile::Options) -> Result<compile::Options, Failure> {
        let structures = &options.structures;
        let cubes = |it| {
            use Structure::{CylinderCube, CylinderCubeEntry, CylinderCubeTight};
            matches!(it, CylinderCube | CylinderCubeTight | CylinderCubeEntry)
        };
        check_takers("--slabs", self.slabs.is_some(), structures, |it| {
            matches!(it, Structure::Slabs | Structure::FlaggedSlabs)
        })?;
        check_takers("--grid", self.grid.is_some(), structures, |it| {
            it == Structure::Grid
        })?;
        check_takers("--gridels", self.gridels.is_some(), structures, cubes)?;
        check_takers("--budget", self.budget.is_some(), structures, |it| {
            cubes(it) || matches!(it, Structure::RayClasses | Structure::Apex)
        })?;
        check_quality(self.quality, structures)?;
        Ok(compile::Options {
            slab_directions: self.slabs.unwrap_or(options.slab_directions),
            grid: self.grid,
            gridels: self.gridels,
            budget: self.budget,
            quality: self.quality.unwrap_or_default(),
            ..options
        })
    }
}

/// Refuses an option that only structures take of which none is built.
///
/// # Errors
/// If it was given.
pub fn check_takers(
    option: &str,
    given: bool,
    built: &[Structure],
    takes: impl Fn(Structure) -> bool,
) -> Result<(), Failure> {
    if !given || built.iter().any(|&structure| takes(structure)) {
        return Ok(());
    }
    let takers = Structure::ALL.into_iter().filter(|&it| takes(it));
    let takers: Vec<_> = takers.map(Structure::name).collect();
    let built: Vec<_> = built.iter().map(|it| it.name()).collect();
    Err(Failure::usage(
        format!(
            "{option} is for {}, and what is built is {}",
            takers.join(", "),
            built.join(", ")
        ),
        "leave the option out, or choose with `--accel` a structure that it is for",
    ))
}

/// Refuses `--quality` where the structure wide is not built.
///
/// # Errors
/// If it was given.
pub fn check_quality(quality: Option<Quality>, built: &[Structure]) -> Result<(), Failure> {
    check_takers("--quality", quality.is_some(), built, |it| {
        it == Structure::Wide
    })
}

/// Refuses an option of hierarchies where none is built.
///
/// # Errors
/// If it was given.
pub fn check_hierarchy(option: &str, given: bool, built: &[Structure]) -> Result<(), Failure> {
    check_takers(option, given, built, takes_hierarchy)
}

/// Names without repetition, in the order in which they come first.
pub fn distinct<T: Copy + PartialEq>(names: &[T]) -> Vec<T> {
    let mut distinct = Vec::new();
    for &name in names {
        if !distinct.contains(&name) {
            distinct.push(name);
        }
    }
    distinct
}

fn directions() -> impl TypedValueParser<Value = usize> {
    PossibleValuesParser::new(DIRECTION_COUNTS.map(|count| match count {
        3 => "3",
        7 => "7",
        _ => "13",
    }))
    .try_map(|count| count.parse())
}

/// Reads divisions of three axes, such as `8` or `8x8x2`.
fn divisions(text: &str) -> Result<[u32; 3], String> {
    let numbers: Option<Vec<u32>> = text
        .split(['x', 'X'])
        .map(|number| {
            number
                .parse()
                .ok()
                .filter(|number| (1..=1024).contains(number))
        })
        .collect();
    match numbers.as_deref() {
        Some(&[all]) => Ok([all; 3]),
        Some(&[x, y, z]) => Ok([x, y, z]),
        _ => Err(String::from(
            "write one number or three, each 1 to 1024, such as 8 or 8x8x2",
        )),
    }
}

/// The name of a builder of hierarchies.
pub fn builder() -> impl TypedValueParser<Value = Builder> {
    PossibleValuesParser::new(Builder::ALL.map(Builder::name)).try_map(|name| {
        let mut all = Builder::ALL.into_iter();
        all.find(|builder| builder.name() == name)
            .ok_or("no such builder")
    })
}

/// The name of an acceleration structure.
pub fn structure() -> impl TypedValueParser<Value = Structure> {
    PossibleValuesParser::new(Structure::ALL.map(Structure::name)).try_map(|name| {
        let mut all = Structure::ALL.into_iter();
        all.find(|structure| structure.name() == name)
            .ok_or("no such structure")
    })
}

/// The name of a number format.
pub fn format() -> impl TypedValueParser<Value = Format> {
    PossibleValuesParser::new(Format::ALL.map(Format::name)).try_map(|name| {
        let mut all = Format::ALL.into_iter();
        all.find(|format| format.name() == name)
            .ok_or("no such number format")
    })
}

/// A number of threads: beyond some hundreds none helps, and far beyond they cannot be started.
pub fn threads() -> impl TypedValueParser<Value = usize> {
    clap::value_parser!(u16).range(1..=1024).map(usize::from)
}

/// Reads a number of bytes, such as `65536`, `64K` or `1M`.
pub fn bytes(text: &str) -> Result<u64, String> {
    let (digits, unit) = match text.char_indices().last() {
        Some((end, 'k' | 'K')) => (&text[..end], 1 << 10),
        Some((end, 'm' | 'M')) => (&text[..end], 1 << 20),
        Some((end, 'g' | 'G')) => (&text[..end], 1 << 30),
        _ => (text, 1),
    };
    digits
        .parse::<u64>()
        .ok()
        .filter(|_| digits.bytes().all(|byte| byte.is_ascii_digit()))
        .and_then(|number| number.checked_mul(unit))
        .ok_or_else(|| String::from("write a number of bytes, such as 65536, 64K or 1M"))
}

/// Reads the size of a picture, such as `640x480`.
pub fn size(text: &str) -> Result<[u16; 2], String> {
    let sides = text
        .split_once(['x', 'X'])
        .map(|(width, height)| [width, height].map(|side| side.parse::<u32>()));
    let Some([Ok(width), Ok(height)]) = sides else {
        return Err(String::from("write width and height, such as 640x480"));
    };
    if width == 0 || height == 0 {
        return Err(String::from("a picture has at least one pixel each way"));
    }
    let (Ok(width), Ok(height)) = (u16::try_from(width), u16::try_from(height)) else {
        return Err(String::from(
            "neither width nor height can be more than 65535",
        ));
    };
    if u32::from(width) > 64 * u32::from(height) {
        return Err(String::from("the width can be at most 64 times the height"));
    }
    Ok([width, height])
}

/// Reads a range of rows, such as `100..200`, whose end is not part of it.
pub fn rows(text: &str) -> Result<Range<u16>, String> {
    let ends = text
        .split_once("..")
        .map(|(first, end)| [first, end].map(|row| row.parse::<u16>()));
    match ends {
        Some([Ok(first), Ok(end)]) if first < end => Ok(first..end),
        Some([Ok(first), Ok(end)]) => Err(format!(
            "the range from {first} to {end} (not included) is empty"
        )),
        _ => Err(String::from(
            "write the first row and the one behind the last, such as 100..200; rows count from 0",
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_have_units_of_1024() {
        assert_eq!(bytes("0"), Ok(0));
        assert_eq!(bytes("1000"), Ok(1000));
        assert_eq!(bytes("64K"), Ok(65536));
        assert_eq!(bytes("2m"), Ok(2 << 20));
        assert_eq!(bytes("3G"), Ok(3 << 30));
        for wrong in ["", "K", "-1", "+1", "1.5M", "64KB", "20000000000G", "1é"] {
            assert!(bytes(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn sizes_have_two_sides() {
        assert_eq!(size("640x480"), Ok([640, 480]));
        assert_eq!(size("64X1"), Ok([64, 1]));
        let wrongs = [
            "",
            "x",
            "640",
            "0x0",
            "1x0",
            "0x1",
            "65x1",
            "65536x1",
            "70000x70000",
            "-1x5",
            "99999999999x1",
        ];
        for wrong in wrongs {
            assert!(size(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn grids_have_one_number_or_three() {
        assert_eq!(divisions("8"), Ok([8; 3]));
        assert_eq!(divisions("1x2X1024"), Ok([1, 2, 1024]));
        for wrong in ["", "0", "1025", "8x8", "8x8x8x8", "8x0x8", "-1", "a"] {
            assert!(divisions(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn rows_are_a_range() {
        assert_eq!(rows("0..1"), Ok(0..1));
        assert_eq!(rows("5..480"), Ok(5..480));
        for wrong in ["", "5..3", "5..5", "5", "..", "5..", "-1..2", "0..70000"] {
            assert!(rows(wrong).is_err(), "{wrong}");
        }
    }
}
