//! The report of `build`, as a table and as JSON.

use crate::cli::effects::CalledFor;
use crate::cli::inspect::longest_leaf;
use gridel_core::{Scene, Structure};
use gridel_host::compile::{
    EnvironmentFigures, Figures, KeptNames, LeftOut, Report, Supplied, TableStats, TextureFigures,
};
use gridel_host::measure::InstanceCount;
use gridel_host::measure::board::{Account, MemoryReport};
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
            structures: Structure::ALL
                .into_iter()
                .filter(|&structure| scene.holds(structure))
                .map(Structure::name)
                .collect(),
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
        let mut line = |what: &str, value: String| table.row([what.to_owned(), value]);
        line("blob", self.blob.to_owned());
        let each = match (&self.instances, self.bytes_per_primitive) {
            (Some(instances), _) if instances.are_kept() => {
                let each = self.bytes as f64 / instances.placed_primitives.max(1) as f64;
                format!(", {each:.1} per placed primitive")
            }
            (_, Some(each)) => format!(", {each:.1} per primitive"),
            (_, None) => String::new(),
        };
        line("bytes", grouped(self.bytes) + &each);
        line(
            "holds",
            format!(
                "{} of {}",
                counted(self.primitives as usize, "primitive"),
                counted(self.objects as usize, "object")
            ),
        );
        if let Some(instances) = &self.instances {
            let otherwise = self
                .bytes_otherwise
                .map(|bytes| format!(", in {} bytes", grouped(bytes)));
            line(
                "instances",
                instances.text() + &otherwise.unwrap_or_default(),
            );
        }
        line("structures", self.structures.join(", "));
        line(
            "limits",
            format!(
                "stack depth {}, longest leaf {}",
                self.stack_depth, self.longest_leaf
            ),
        );
        if let Some(cost) = self.sah_cost {
            line("SAH cost", format!("{cost:.2}"));
        }
        line(
            "lattice",
            format!(
                "{} bits, step {}, largest displacement {}",
                self.lattice_bits,
                power_of_two(self.step),
                match self.largest_displacement {
                    0.0 => String::from("0"),
                    moved => format!("{moved:.3e} scene units"),
                }
            ),
        );
        for lists in self.tables {
            let Figures {
                cells,
                lists: different,
                entries,
                longest,
                bytes,
                ..
            } = lists.figures;
            line(
                "table",
                format!(
                    "{}: {}, {}, {}, {} in the longest, {}",
                    lists.structure,
                    counted(cells as usize, "cell"),
                    counted(different as usize, "list"),
                    counted(entries as usize, "entry"),
                    grouped(longest),
                    counted(bytes as usize, "byte")
                ),
            );
        }
        if let Some(KeptNames { names, bytes, .. }) = self.names.filter(|kept| kept.names > 0) {
            line(
                "names",
                format!(
                    "{}, {}; --strip-names leaves them out",
                    counted(names, "name"),
                    counted(bytes, "byte")
                ),
            );
        }
        for what in self.supplied {
            line("supplied", what.to_string());
        }
        for name in self.collapsed.names(NAMED) {
            line("collapsed", name);
        }
        for name in self.without_area.names(NAMED) {
            line("no area", name);
        }
        if self.effects.is_empty() {
            line("effects", String::from("none"));
        }
        for effect in &self.effects {
            line("effect", effect.to_string());
        }
        for texture in self.textures {
            line("texture", texture.to_string());
        }
        if let Some(environment) = self.environment {
            line("environment", environment.to_string());
        }
        if let Some(report) = self.memory {
            let remains = |account: &Account| {
                let rest = account.remains();
                let rest = rest.map_or(String::from("an unknown part"), grouped);
                format!("{rest} of {}", grouped(account.available))
            };
            line(
                report.board,
                format!(
                    "{} bytes of flash remain, and {} of RAM; `gridel inspect` shows what takes the \
                     others, and for which builds of the program that holds",
                    remains(&report.flash),
                    remains(&report.ram)
                ),
            );
        }
        table.to_string()
    }
}
