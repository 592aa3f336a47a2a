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
use gridel_core::{Format, Kind, Scene};
use gridel_host::compile::{self, Names};
use gridel_host::measure::board::{MemoryReport, WorkingRow, working_rows};
use gridel_host::measure::{
    Deforming, MemoryMap, WorkingMemory, longest_leaf, structure_names, working_memory,
};
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
/// of instances and joints that move, and of lights and materials that tracks change. The workspace is exact for this
/// machine, and for 32-bit boards that align an f64 to 8 bytes. A scene that does not fit the board of --target is
/// shown, and the exit code is 3.
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
    let (scene, blob) = (source.scene()?, source.blob.bytes());
    let target = arguments.target.target();
    let format = target.map_or(Format::Fixed, |target| target.board.format());
    // Whoever plays the blob's tracks needs the effects of all times.
    let raised = raised_materials(&scene, blob);
    let moving = scene.with_materials(&raised);
    let moving = moving.as_ref().unwrap_or(&scene);
    let inspection = Inspection {
        memory_map: MemoryMap::of(&scene, blob),
        limits: limits(moving),
        contents: contents(&scene),
        parts: PartLine::all(&scene, blob),
        tracks: TrackList::of(blob),
        joints: JointLine::all(&scene, blob),
        deforming: Deforming::all(&scene, blob),
        names: NameLists {
            instances: source.names(&scene).instances,
            ..Names::of_blob(&scene, blob).unwrap_or_default().into()
        },
        working_memory: working_memory(moving),
        working_rows: working_rows(moving, blob),
        effects: CalledFor::at_all_times(source.report.as_ref(), &scene, moving, blob),
        memory: arguments.target.memory_report(&scene, blob, format)?,
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
        structures: structure_names(scene),
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

/// A line of the text: a word, and its value.
type Line = (&'static str, String);

impl Contents {
    fn primitives_text(&self) -> String {
        let kinds = self.kinds.iter();
        let kinds = kinds.map(|(kind, count)| format!("{kind} {}", grouped(count)));
        let kinds = kinds.collect::<Vec<_>>().join(", ");
        let primitives = grouped(self.primitives);
        match (kinds.is_empty(), self.collapsed) {
            (true, 0) => String::from("0"),
            (true, collapsed) => {
                format!("{}, which collapsed on the lattice", grouped(collapsed))
            }
            (_, 0) => format!("{primitives}: {kinds}"),
            (_, collapsed) => {
                format!("{primitives}: {kinds}, and {collapsed} that collapsed on the lattice")
            }
        }
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
        let groups = [
            self.content_lines(),
            self.name_lines(),
            self.motion_lines(),
            self.limit_lines(),
            self.effect_lines(),
        ];
        let mut table = Table::untitled([Align::Left, Align::Left]);
        for (what, value) in groups.into_iter().flatten() {
            table.row([what.to_owned(), value]);
        }
        table
    }

    fn content_lines(&self) -> Vec<Line> {
        let contents = &self.contents;
        let mut lines = vec![
            ("structures", contents.structures.join(", ")),
            ("objects", grouped(contents.objects)),
            ("primitives", contents.primitives_text()),
        ];
        if contents.instances > 0 {
            let parts = counted(contents.parts, "part");
            let instances = grouped(contents.instances);
            lines.push(("instances", format!("{instances} of {parts}")));
        }
        let parts = self.parts.iter().enumerate();
        lines.extend(parts.map(|(number, part)| ("part", part.text(number))));
        lines.push(("materials", contents.materials.to_string()));
        lines.push(("lights", contents.lights.to_string()));
        lines
    }

    fn name_lines(&self) -> Vec<Line> {
        let lists = [
            ("object names", &self.names.objects),
            ("material names", &self.names.materials),
            ("light names", &self.names.lights),
        ];
        let has_one = |(_, names): &(_, &Vec<String>)| names.iter().any(|name| !name.is_empty());
        let lists = lists.into_iter().filter(has_one);
        lists
            .map(|(what, names)| (what, first_names(names)))
            .collect()
    }

    /// Joints, tracks, and meshes whose vertices move.
    fn motion_lines(&self) -> Vec<Line> {
        let joints = self.joints.iter().enumerate();
        let joints = joints.map(|(number, joint)| ("joint", joint.text(number)));
        let mut lines: Vec<Line> = joints.collect();
        if let Some(moves) = &self.tracks {
            lines.push((
                "tracks",
                format!(
                    "{} from {} s to {} s, {} bytes",
                    moves.tracks.len(),
                    moves.first,
                    moves.last,
                    grouped(moves.bytes)
                ),
            ));
            lines.extend(moves.tracks.iter().map(|track| ("track", track.text())));
        }
        let deforming = self.deforming.iter();
        lines.extend(deforming.map(|mesh| ("deforming mesh", mesh.to_string())));
        lines
    }

    fn limit_lines(&self) -> Vec<Line> {
        let limits = &self.limits;
        let lattice = format!(
            "{} bits, stored in {}; step {} and unit {} scene units",
            limits.lattice_bits,
            limits.storage_bits,
            power_of_two(limits.step),
            power_of_two(limits.unit)
        );
        let [low, high] = limits.bounds;
        let corner = |[x, y, z]: [f64; 3]| format!("({x}, {y}, {z})");
        let coordinate_step = format!(
            "{} scene units, counted from {}",
            power_of_two(limits.coordinate_step),
            corner(limits.coordinate_origin)
        );
        let bounds = format!("{} to {} scene units", corner(low), corner(high));
        vec![
            ("stack depth", limits.stack_depth.to_string()),
            ("work depth", limits.work_depth.to_string()),
            ("longest leaf", limits.longest_leaf.to_string()),
            ("lattice", lattice),
            ("coordinate step", coordinate_step),
            ("bounds", bounds),
        ]
    }

    fn effect_lines(&self) -> Vec<Line> {
        if self.effects.is_empty() {
            return vec![("effects", String::from("none"))];
        }
        let effects = self.effects.iter();
        effects.map(|it| ("effect", it.to_string())).collect()
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
