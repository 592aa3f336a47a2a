//! The report of `build`, as a table and as JSON.

use crate::cli::effects::CalledFor;
use gridel_core::Scene;
use gridel_host::compile::{
    EnvironmentFigures, Figures, KeptNames, LeftOut, Report, Supplied, TableStats, TextureFigures,
};
use gridel_host::measure::board::{Account, MemoryReport};
use gridel_host::measure::{InstanceCount, longest_leaf, structure_names};
use gridel_host::resolution::Unresolved;
use gridel_host::table::{Align, Table, counted, grouped, power_of_two};
use serde::Serialize;

/// The report of `build`.
#[derive(Serialize)]
pub(super) struct Built<'r> {
    blob: &'r str,
    bytes: usize,
    /// `None` without primitives.
    bytes_per_primitive: Option<f64>,
    objects: u32,
    primitives: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) instances: Option<InstanceCount>,
    /// Bytes with the other treatment of instances, where that was compiled as well.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) bytes_otherwise: Option<usize>,
    structures: Vec<&'static str>,
    stack_depth: usize,
    longest_leaf: u16,
    lattice_bits: u8,
    /// Scene units.
    step: f64,
    /// Scene units.
    largest_displacement: f64,
    collapsed: &'r LeftOut,
    without_area: &'r LeftOut,
    sah_cost: Option<f64>,
    pub(super) effects: Vec<CalledFor>,
    /// The storage of each texture image.
    textures: &'r [TextureFigures],
    /// The storage of the environment.
    #[serde(skip_serializing_if = "Option::is_none")]
    environment: Option<EnvironmentFigures>,
    supplied: &'r [Supplied],
    tables: &'r [TableStats],
    /// Present if the scene has names that the blob is to have.
    #[serde(skip_serializing_if = "Option::is_none")]
    names: Option<KeptNames>,
    warnings: &'r [String],
    /// Objects that some formats do not resolve.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    pub(super) unresolved: &'r [Unresolved],
    /// Present if a board is given.
    #[serde(rename = "memory_report", skip_serializing_if = "Option::is_none")]
    pub(super) memory: Option<&'r MemoryReport>,
}

/// Left-out primitives that are named in the text; JSON names more.
const NAMED: usize = 5;

/// A line of the text: a word, and its value.
type Line<'l> = (&'l str, String);

impl<'r> Built<'r> {
    pub(super) fn new(
        blob: &'r str,
        scene: &Scene<'_>,
        report: &'r Report,
        warnings: &'r [String],
    ) -> Self {
        let header = scene.header();
        Self {
            blob,
            bytes: report.bytes,
            bytes_per_primitive: (header.primitives > 0)
                .then(|| report.bytes as f64 / f64::from(header.primitives)),
            objects: header.objects,
            primitives: header.primitives,
            instances: None,
            bytes_otherwise: None,
            structures: structure_names(scene),
            stack_depth: scene.stack_depth(),
            longest_leaf: longest_leaf(scene),
            lattice_bits: header.lattice_bits,
            step: report.step,
            largest_displacement: report.largest_displacement,
            collapsed: &report.collapsed,
            without_area: &report.without_area,
            sah_cost: report.sah_cost,
            effects: Vec::new(),
            textures: &report.textures,
            environment: report.environment,
            supplied: &report.supplied,
            tables: &report.tables,
            names: report.names,
            warnings,
            unresolved: &[],
            memory: None,
        }
    }

    pub(super) fn text(&self) -> String {
        let mut table = Table::untitled([Align::Left, Align::Left]);
        let groups = [
            self.size_lines(),
            self.structure_lines(),
            self.table_lines(),
            self.scene_lines(),
            self.effect_lines(),
            self.memory_line().into_iter().collect(),
        ];
        for (what, value) in groups.into_iter().flatten() {
            table.row([what.to_owned(), value]);
        }
        table.to_string()
    }

    /// Its file, and the number of bytes and primitives.
    fn size_lines(&self) -> Vec<Line<'_>> {
        let each = match (&self.instances, self.bytes_per_primitive) {
            (Some(instances), _) if instances.are_kept() => {
                let each = self.bytes as f64 / instances.placed_primitives.max(1) as f64;
                format!(", {each:.1} per placed primitive")
            }
            (_, Some(each)) => format!(", {each:.1} per primitive"),
            (_, None) => String::new(),
        };
        let primitives = counted(self.primitives as usize, "primitive");
        let objects = counted(self.objects as usize, "object");
        let mut lines = vec![
            ("blob", self.blob.to_owned()),
            ("bytes", grouped(self.bytes) + &each),
            ("holds", format!("{primitives} of {objects}")),
        ];
        if let Some(instances) = &self.instances {
            let otherwise = self
                .bytes_otherwise
                .map(|bytes| format!(", in {} bytes", grouped(bytes)));
            lines.push((
                "instances",
                instances.text() + &otherwise.unwrap_or_default(),
            ));
        }
        lines
    }

    /// The structures, their limits and the lattice.
    fn structure_lines(&self) -> Vec<Line<'_>> {
        let limits = format!(
            "stack depth {}, longest leaf {}",
            self.stack_depth, self.longest_leaf
        );
        let mut lines = vec![
            ("structures", self.structures.join(", ")),
            ("limits", limits),
        ];
        if let Some(cost) = self.sah_cost {
            lines.push(("SAH cost", format!("{cost:.2}")));
        }
        let moved = match self.largest_displacement {
            0.0 => String::from("0"),
            moved => format!("{moved:.3e} scene units"),
        };
        let lattice = format!(
            "{} bits, step {}, largest displacement {moved}",
            self.lattice_bits,
            power_of_two(self.step)
        );
        lines.push(("lattice", lattice));
        lines
    }

    /// The tables of candidates.
    fn table_lines(&self) -> Vec<Line<'_>> {
        let line = |lists: &TableStats| {
            let Figures {
                cells,
                lists: different,
                entries,
                longest,
                bytes,
                ..
            } = lists.figures;
            let text = format!(
                "{}: {}, {}, {}, {} in the longest, {}",
                lists.structure,
                counted(cells as usize, "cell"),
                counted(different as usize, "list"),
                counted(entries as usize, "entry"),
                grouped(longest),
                counted(bytes as usize, "byte")
            );
            ("table", text)
        };
        self.tables.iter().map(line).collect()
    }

    /// Names, and what was supplied or left out.
    fn scene_lines(&self) -> Vec<Line<'_>> {
        let mut lines = Vec::new();
        if let Some(KeptNames { names, bytes, .. }) = self.names.filter(|kept| kept.names > 0) {
            let text = format!(
                "{}, {}; --strip-names leaves them out",
                counted(names, "name"),
                counted(bytes, "byte")
            );
            lines.push(("names", text));
        }
        lines.extend(self.supplied.iter().map(|it| ("supplied", it.to_string())));
        let collapsed = self.collapsed.names(NAMED).into_iter();
        lines.extend(collapsed.map(|name| ("collapsed", name)));
        let without_area = self.without_area.names(NAMED).into_iter();
        lines.extend(without_area.map(|name| ("no area", name)));
        lines
    }

    /// Effects, and the storage of images.
    fn effect_lines(&self) -> Vec<Line<'_>> {
        let mut lines = Vec::new();
        if self.effects.is_empty() {
            lines.push(("effects", String::from("none")));
        }
        lines.extend(self.effects.iter().map(|it| ("effect", it.to_string())));
        lines.extend(self.textures.iter().map(|it| ("texture", it.to_string())));
        let environment = self.environment.iter();
        lines.extend(environment.map(|it| ("environment", it.to_string())));
        lines
    }

    /// The line about the memory that a board has left.
    fn memory_line(&self) -> Option<Line<'_>> {
        let report = self.memory?;
        let remains = |account: &Account| {
            let rest = account.remains();
            let rest = rest.map_or(String::from("an unknown part"), grouped);
            format!("{rest} of {}", grouped(account.available))
        };
        let text = format!(
            "{} bytes of flash remain, and {} of RAM; `gridel inspect` shows what takes the others, and for which \
             builds of the program that holds",
            remains(&report.flash),
            remains(&report.ram)
        );
        Some((report.board, text))
    }
}
