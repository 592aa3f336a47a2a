//! `gridel inspect`: the content of a blob, and its requirements.

mod joints;
mod parts;
mod tracks;

use super::arguments::{SceneOptions, TargetOptions};
use super::effects::CalledFor;
use super::failure::Failure;
use super::output::{print, print_json_warned};
use super::source::{Compiling, Source};
use clap::Args;
use glam::DVec3;
use gridel_core::{Format, Kind, Scene, Structure};
use gridel_host::compile::{self, Names};
use gridel_host::measure::board::{MemoryReport, WorkingRow, working_rows};
use gridel_host::measure::{Deforming, MemoryMap, WorkingMemory, working_memory};
use gridel_host::state::raised_materials;
use gridel_host::table::{Align, Table, counted, grouped, power_of_two, printable};
use joints::JointLine;
use parts::PartLine;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::PathBuf;
use tracks::TrackList;

/// Show the memory map of a blob, its limits and the RAM that it needs
///
/// Compiles a scene file as `gridel build` does by default, without writing a blob. Working memory is what the caller
/// provides besides the call stack: for pictures a workspace and, on boards, the RAM of parts, of meshes that deform,
/// of instances and joints that move, and of lights and materials that tracks change. The workspace is exact for this machine, and for 32-bit boards that align an f64 to 8
/// bytes. A scene that does not fit the board of --target is shown, and the exit code is 3.
#[derive(Args)]
#[command(after_help = super::failure::EXIT_CODES)]
pub struct Arguments {
    /// Blob or scene file, or `-` for standard input
    #[arg(value_name = "BLOB|SCENE")]
    input: PathBuf,

    /// Print the results as JSON
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    target: TargetOptions,

    #[command(flatten)]
    scene_options: SceneOptions,
}

#[derive(Serialize)]
struct Inspection {
    memory_map: MemoryMap,
    limits: Limits,
    contents: Contents,
    /// The parts that instances place.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    parts: Vec<PartLine>,
    /// Present if something moves.
    #[serde(skip_serializing_if = "Option::is_none")]
    tracks: Option<TrackList>,
    /// The joints that instances hang on.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    joints: Vec<JointLine>,
    /// The meshes whose vertices have room to move.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    deforming: Vec<Deforming>,
    /// Empty where the blob has none.
    names: NameLists,
    working_memory: Vec<WorkingMemory>,
    /// RAM of a 32-bit board besides the workspace.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    working_rows: Vec<WorkingRow>,
    effects: Vec<CalledFor>,
    /// Present if a board is given.
    #[serde(rename = "memory_report", skip_serializing_if = "Option::is_none")]
    memory: Option<MemoryReport>,
}

#[derive(Serialize)]
struct Limits {
    stack_depth: usize,
    /// Places for rays that wait, at the ray depth of the blob.
    work_depth: usize,
    longest_leaf: u16,
    lattice_bits: u8,
    /// Bits of a stored coordinate.
    storage_bits: u8,
    /// Scene units of a unit, a step of the 16-bit box lattice.
    unit: f64,
    /// Scene units of a step of the lattice.
    step: f64,
    /// Scene units of a step of the integer coordinates that programs place cameras and rays by.
    coordinate_step: f64,
    /// Scene coordinates from where those are counted.
    coordinate_origin: [f64; 3],
    /// The scene's box in scene units, lowest and highest corner.
    bounds: [[f64; 3]; 2],
}

/// The names in a blob, in the order of the named items. An empty text means no name.
#[derive(Serialize)]
struct NameLists {
    objects: Vec<String>,
    materials: Vec<String>,
    lights: Vec<String>,
    /// The names of a scene file's instances; a blob does not store them.
    instances: Vec<String>,
}

impl From<Names> for NameLists {
    fn from(names: Names) -> Self {
        let Names {
            objects,
            materials,
            lights,
            instances,
            ..
        } = names;
        Self {
            objects,
            materials,
            lights,
            instances,
        }
    }
}

/// Names that the text shows of each list; JSON has all.
const SHOWN: usize = 8;

/// Returns the first names of a list; an item without a name has its number.
fn first_names(names: &[String]) -> String {
    let shown = names.iter().enumerate().take(SHOWN);
    let shown = shown.map(|(number, name)| match name.as_str() {
        "" => format!("(number {number})"),
        name => printable(name),
    });
    let rest = names.len().saturating_sub(SHOWN);
    let more = (rest > 0).then(|| format!("and {} more", grouped(rest)));
    shown.chain(more).collect::<Vec<_>>().join(", ")
}

#[derive(Serialize)]
struct Contents {
    structures: Vec<&'static str>,
    objects: u32,
    /// Number of primitives, including those that collapsed on the lattice.
    primitives: u32,
    collapsed: usize,
    kinds: BTreeMap<&'static str, usize>,
    parts: usize,
    instances: usize,
    lights: usize,
    materials: usize,
}

/// Shows the content of a blob.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let compiling = compile::Options {
        names: arguments.target.target().is_none(),
        ..compile::Options::default()
    };
    let scene_options = arguments.target.with_target(&arguments.scene_options)?;
    let compiling = Compiling {
        options: compiling,
        chosen: false,
    };
    let source = Source::open(&arguments.input, &scene_options, None, compiling)?;
    let scene = source.scene()?;
    let target = arguments.target.target();
    let format = target.map_or(Format::Fixed, |target| target.board.format());
    // Whoever plays the blob's tracks needs the effects of all times.
    let raised = raised_materials(&scene, source.blob.bytes());
    let moving = scene.with_materials(&raised);
    let moving = moving.as_ref().unwrap_or(&scene);
    let inspection = Inspection {
        memory_map: MemoryMap::of(&scene, source.blob.bytes()),
        limits: limits(moving),
        contents: contents(&scene),
        parts: PartLine::all(&scene, source.blob.bytes()),
        tracks: TrackList::of(source.blob.bytes()),
        joints: JointLine::all(&scene, source.blob.bytes()),
        deforming: Deforming::all(&scene, source.blob.bytes()),
        names: NameLists {
            instances: source.names(&scene).instances,
            ..Names::of_blob(&scene, source.blob.bytes())
                .unwrap_or_default()
                .into()
        },
        working_memory: working_memory(moving),
        working_rows: working_rows(moving, source.blob.bytes()),
        effects: CalledFor::at_all_times(
            source.report.as_ref(),
            &scene,
            moving,
            source.blob.bytes(),
        ),
        memory: arguments
            .target
            .memory_report(&scene, source.blob.bytes(), format)?,
    };
    if arguments.json {
        print_json_warned(&inspection, &source.warnings)?;
    } else {
        print(inspection.text())?;
    }
    let memory = inspection.memory.as_ref();
    memory.map_or(Ok(()), |report| source.check_fits(&scene, report))
}

fn limits(scene: &Scene<'_>) -> Limits {
    let header = scene.header();
    let unit = f64::powi(2.0, header.unit_exponent.into());
    let corner = |side: usize| {
        let units = header.bounds.0.map(|planes| f64::from(planes[side]));
        (DVec3::from_array(header.origin) + unit * DVec3::from_array(units)).to_array()
    };
    Limits {
        stack_depth: scene.stack_depth(),
        work_depth: scene.effects().work_depth(scene.view().depth),
        longest_leaf: longest_leaf(scene),
        lattice_bits: header.lattice_bits,
        storage_bits: header.storage_bits,
        unit,
        step: unit * f64::powi(2.0, 16 - i32::from(header.lattice_bits)),
        coordinate_step: f64::powi(2.0, header.coordinate_exponent()),
        coordinate_origin: header.coordinate_origin(),
        bounds: [corner(0), corner(1)],
    }
}

/// Most primitives in a leaf, of the scene and of its parts.
pub fn longest_leaf(scene: &Scene<'_>) -> u16 {
    let parts = scene.parts().iter().map(|part| part.header().longest_leaf);
    parts.fold(scene.header().longest_leaf, u16::max)
}

fn contents(scene: &Scene<'_>) -> Contents {
    let header = scene.header();
    let all = || std::iter::once(scene).chain(scene.parts());
    let mut kinds = Kind::ALL.map(|kind| (kind.name(), 0));
    // A triangle that was cut has several slots.
    let mut kept = vec![false; header.primitives as usize];
    let parts = (0..).map_while(|part| scene.first_primitive_of_part(part));
    for (scene, first) in all().zip(std::iter::once(0).chain(parts)) {
        for (kind, (_, count)) in Kind::ALL.into_iter().zip(&mut kinds) {
            for slot in 0..scene.count(kind) as u32 {
                let kept = &mut kept[(first + scene.primitive(kind, slot)) as usize];
                *count += usize::from(!*kept);
                *kept = true;
            }
        }
    }
    Contents {
        structures: Structure::ALL
            .into_iter()
            .filter(|&structure| scene.holds(structure))
            .map(Structure::name)
            .collect(),
        objects: header.objects,
        primitives: header.primitives,
        collapsed: kept.into_iter().filter(|kept| !kept).count(),
        kinds: kinds.into_iter().filter(|&(_, count)| count > 0).collect(),
        parts: scene.parts().len(),
        instances: scene.instances().len(),
        lights: scene.lights().len(),
        materials: scene.materials().len(),
    }
}

impl Inspection {
    fn text(&self) -> String {
        let each = |bytes: Option<f64>| bytes.map_or(String::from("-"), |b| format!("{b:.2}"));
        let mut map = Table::new([
            ("section", Align::Left),
            ("offset", Align::Right),
            ("records", Align::Right),
            ("stride", Align::Right),
            ("bytes", Align::Right),
            ("share", Align::Right),
            ("bytes per primitive", Align::Right),
        ]);
        for part in &self.memory_map.parts {
            map.row([
                part.kind.to_owned(),
                part.offset.map_or(String::from("-"), grouped),
                grouped(part.count),
                part.stride.to_string(),
                grouped(part.bytes),
                format!("{:.1} %", 100.0 * part.share),
                each(part.bytes_per_primitive),
            ]);
        }
        map.row([
            String::from("total"),
            String::new(),
            String::new(),
            String::new(),
            grouped(self.memory_map.bytes),
            String::from("100.0 %"),
            each(self.memory_map.bytes_per_primitive),
        ]);
        format!(
            "{map}\n{}\n{}{}",
            self.facts(),
            working_memory_table(&self.working_memory),
            working_rows_text(&self.working_rows)
        ) + &self
            .memory
            .as_ref()
            .map(|report| format!("\n{report}"))
            .unwrap_or_default()
    }

    fn facts(&self) -> Table {
        let Self {
            limits,
            contents,
            names,
            ..
        } = self;
        let mut table = Table::untitled([Align::Left, Align::Left]);
        let mut line = |what: &str, value: String| table.row([what.to_owned(), value]);
        line("structures", contents.structures.join(", "));
        line("objects", grouped(contents.objects));
        let kinds: Vec<_> = contents
            .kinds
            .iter()
            .map(|(kind, count)| format!("{kind} {}", grouped(count)))
            .collect();
        line(
            "primitives",
            match (kinds.is_empty(), contents.collapsed) {
                (true, 0) => String::from("0"),
                (true, collapsed) => format!(
                    "{}, which collapsed on the lattice",
                    grouped(collapsed as u64)
                ),
                (_, 0) => format!("{}: {}", grouped(contents.primitives), kinds.join(", ")),
                (_, collapsed) => format!(
                    "{}: {}, and {collapsed} that collapsed on the lattice",
                    grouped(contents.primitives),
                    kinds.join(", ")
                ),
            },
        );
        if contents.instances > 0 {
            line(
                "instances",
                format!(
                    "{} of {}",
                    grouped(contents.instances),
                    counted(contents.parts, "part")
                ),
            );
        }
        for (number, part) in self.parts.iter().enumerate() {
            line("part", part.text(number));
        }
        line("materials", contents.materials.to_string());
        line("lights", contents.lights.to_string());
        for (what, names) in [
            ("object names", &names.objects),
            ("material names", &names.materials),
            ("light names", &names.lights),
        ] {
            if names.iter().any(|name| !name.is_empty()) {
                line(what, first_names(names));
            }
        }
        for (number, joint) in self.joints.iter().enumerate() {
            line("joint", joint.text(number));
        }
        if let Some(moves) = &self.tracks {
            line(
                "tracks",
                format!(
                    "{} from {} s to {} s, {} bytes",
                    moves.tracks.len(),
                    moves.first,
                    moves.last,
                    grouped(moves.bytes)
                ),
            );
            for track in &moves.tracks {
                line("track", track.text());
            }
        }
        for mesh in &self.deforming {
            line("deforming mesh", mesh.to_string());
        }
        line("stack depth", limits.stack_depth.to_string());
        line("work depth", limits.work_depth.to_string());
        line("longest leaf", limits.longest_leaf.to_string());
        line(
            "lattice",
            format!(
                "{} bits, stored in {}; step {} and unit {} scene units",
                limits.lattice_bits,
                limits.storage_bits,
                power_of_two(limits.step),
                power_of_two(limits.unit)
            ),
        );
        let [low, high] = limits.bounds;
        let corner = |[x, y, z]: [f64; 3]| format!("({x}, {y}, {z})");
        line(
            "coordinate step",
            format!(
                "{} scene units, counted from {}",
                power_of_two(limits.coordinate_step),
                corner(limits.coordinate_origin)
            ),
        );
        line(
            "bounds",
            format!("{} to {} scene units", corner(low), corner(high)),
        );
        if self.effects.is_empty() {
            line("effects", String::from("none"));
        }
        for effect in &self.effects {
            line("effect", effect.to_string());
        }
        table
    }
}

/// Returns the memory that a 32-bit board needs for the scene besides a workspace, as text.
fn working_rows_text(rows: &[WorkingRow]) -> String {
    let line = |row: &WorkingRow| {
        let bytes = row.bytes.map_or(String::from("unknown"), grouped);
        format!(
            "32-bit board, beside the workspace: {bytes} for {}\n",
            row.what
        )
    };
    rows.iter().map(line).collect()
}

fn working_memory_table(needs: &[WorkingMemory]) -> Table {
    let mut table = Table::new([
        ("working memory, bytes", Align::Left),
        ("format", Align::Left),
        ("rays (stack)", Align::Right),
        ("pictures (workspace)", Align::Right),
    ]);
    for need in needs {
        table.row([
            match need.word_bits {
                32 => String::from("32-bit board"),
                bits => format!("this machine, {bits} bits"),
            },
            need.format.to_owned(),
            grouped(need.stack),
            grouped(need.workspace),
        ]);
    }
    table
}
