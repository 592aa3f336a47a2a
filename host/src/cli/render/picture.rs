//! One picture: its moments are rendered, and its files written.

use super::frames::{Shot, TimeOptions};
use super::outputs::{AovFile, HeatMapFile, Outputs};
use super::report::RenderingReport;
use super::shutter::{self, scenes};
use crate::cli::changes::Changes;
use crate::cli::failure::Failure;
use crate::cli::output::{Warned, json, print_about};
use crate::cli::progress::Progress;
use crate::cli::source::tick;
use gridel_core::Counters;
use gridel_host::picture::{Exposure, Moment, RenderMetadata};
use gridel_host::resolution::Unresolved;
use gridel_host::table::{Align, Table, grouped};
use serde::Serialize;
use std::time::{Duration, Instant};

/// The report of `render`.
#[derive(Serialize)]
struct Rendered {
    picture: String,
    width: u16,
    height: u16,
    rows: [u16; 2],
    #[serde(flatten)]
    rendering: RenderingReport,
    #[serde(skip_serializing_if = "Option::is_none")]
    stats: Option<Stats>,
    #[serde(skip_serializing_if = "Option::is_none")]
    heat_map: Option<HeatMapFile>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    aovs: Vec<AovFile>,
    /// Objects that the format does not resolve.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    unresolved: Vec<Unresolved>,
}

#[derive(Serialize)]
struct Stats {
    rays: u64,
    primary: u64,
    shadow: u64,
    reflected: u64,
    refracted: u64,
    diffuse: u64,
    planes: u64,
    boxes: u64,
    cells: u64,
    primitives: u64,
    /// Instances that rays entered.
    instances: u64,
    rays_per_second: f64,
}

/// Renders a picture and writes its files. Its metadata say whether it is a part of one.
pub fn run(
    shot: Shot<'_>,
    outputs: &Outputs<'_>,
    (has_stats, is_part): (bool, bool),
) -> Result<(), Failure> {
    let blurred = blurred(&shot)?;
    let Shot {
        source, job, pool, ..
    } = shot;
    let warnings = match &blurred {
        Some(blurred) => [source.warn_of_unblurred(), blurred.warnings.clone()].concat(),
        None => source.warnings.clone(),
    };
    let moments = match &blurred {
        Some(blurred) => scenes(&blurred.changes, shot.scene)?,
        None => vec![*shot.scene],
    };
    let scene = moments[0];
    let progress = Progress::steps("rendering", job.rows.len() as u64);
    let begun = Instant::now();
    let rendered = pool.install(|| outputs.render(&moments, job, &|| progress.step()));
    let taken = begun.elapsed();
    drop(progress);
    let image = rendered.map_err(Failure::rendering)?;

    let counters = image.shown().and_then(|picture| picture.counters.as_ref());
    let stats = counters.filter(|_| has_stats);
    let time = blurred.as_ref().map(|it| it.time).or(source.time());
    let exposure = blurred.as_ref().map(|it| it.exposure);
    let metadata = RenderMetadata::of(&scene, job)
        .at(time.map(Moment::Time))
        .exposed(exposure)
        .as_part(is_part);
    let written = pool.install(|| outputs.write((&scene, job), &image, &metadata));
    let (heat_map, aovs) = written?;
    let rendered = Rendered {
        picture: shot.output.display().to_string(),
        width: job.settings.width,
        height: job.settings.height,
        rows: [job.rows.start, job.rows.end],
        rendering: RenderingReport::of(job, pool, exposure, taken),
        stats: stats.map(|counters| Stats::of(counters, taken)),
        heat_map,
        aovs,
        unresolved: shot.unresolved,
    };
    let report = match shot.as_json {
        true => json(&Warned {
            value: &rendered,
            warnings: &warnings,
        })?,
        false => rendered.text(),
    };
    print_about(shot.output, report)
}

/// A picture in which motion is blurred.
struct Blurred {
    /// The time at which the shutter opens, in ticks.
    time: i32,
    exposure: Exposure,
    /// The changes at each moment.
    changes: Vec<Changes>,
    /// The warnings of the shutter.
    warnings: Vec<String>,
}

/// The moments of a picture, if motion is to be blurred.
fn blurred(shot: &Shot<'_>) -> Result<Option<Blurred>, Failure> {
    let Shot { source, scene, .. } = shot;
    let TimeOptions { time, shutter, .. } = shot.options;
    let (Some(seconds), Some(_)) = (time, shutter.shutter) else {
        return Ok(None);
    };
    let tracks = source.tracks()?;
    let mut warnings = Vec::new();
    let exposure = shutter.exposure(&tracks, shot.job.settings.samples, &mut warnings)?;
    let Some(exposure) = exposure else {
        return Ok(None);
    };
    let time = tick(&tracks, *seconds)?;
    let changes = shutter::changes(source, (scene, &tracks), time, Some(exposure))?;
    Ok(Some(Blurred {
        time,
        exposure,
        changes,
        warnings,
    }))
}

impl Rendered {
    fn text(&self) -> String {
        let [first, end] = self.rows;
        let rows = if (first, end) == (0, self.height) {
            String::new()
        } else {
            format!(", rows {first}..{end}")
        };
        let mut text = format!(
            "{}: {} x {}{rows}, {}\n",
            self.picture, self.width, self.height, self.rendering
        );
        if let Some(map) = &self.heat_map {
            text.push_str(&format!(
                "{}: white is {} boxes and primitives tested\n",
                map.file,
                grouped(map.maximum)
            ));
        }
        for aov in &self.aovs {
            text.push_str(&format!("{}: {}\n", aov.file.display(), aov.name));
        }
        if let Some(stats) = &self.stats {
            text.push_str(&format!("\n{}", stats.table()));
        }
        text
    }
}

impl Stats {
    fn of(counters: &Counters, time: Duration) -> Self {
        let Counters {
            planes,
            boxes,
            primitives,
            cells,
            instances,
            primary,
            shadow,
            reflected,
            refracted,
            diffuse,
        } = *counters;
        Self {
            rays: counters.rays(),
            primary,
            shadow,
            reflected,
            refracted,
            diffuse,
            planes,
            boxes,
            cells,
            primitives,
            instances,
            rays_per_second: counters.rays() as f64 / time.as_secs_f64(),
        }
    }

    fn table(&self) -> Table {
        let mut table = Table::new([
            ("counted", Align::Left),
            ("number", Align::Right),
            ("per ray", Align::Right),
        ]);
        let per_ray = |count: u64| format!("{:.2}", count as f64 / self.rays.max(1) as f64);
        for (what, count) in [
            ("rays", self.rays),
            ("  primary", self.primary),
            ("  shadow", self.shadow),
            ("  reflected", self.reflected),
            ("  refracted", self.refracted),
            ("  diffuse", self.diffuse),
            ("planes tested", self.planes),
            ("boxes tested", self.boxes),
            ("cells entered", self.cells),
            ("primitives tested", self.primitives),
            ("instances entered", self.instances),
        ] {
            table.row([what.to_owned(), grouped(count), per_ray(count)]);
        }
        table.row([
            String::from("rays per second"),
            grouped(self.rays_per_second.round()),
            String::new(),
        ]);
        table
    }
}
