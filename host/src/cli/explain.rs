//! `gridel explain`: explains a pixel or a ray.

use super::arguments::TargetPoint;
use super::arguments::{PictureOptions, SceneOptions, TraceOptions, seconds};
use super::failure::Failure;
use super::output::{print, print_json_warned};
use super::source::Source;
use clap::{ArgGroup, Args};
use glam::DVec3;
use gridel_core::{Scene, Settings, Structure};
use gridel_host::certify::{self, World};
use gridel_host::compile::Names;
use gridel_host::explain::{ExplainError, Explanation, LightOutcome, Shown, Subject, explain};
use gridel_host::table::printable;
use gridel_host::trace::SceneRay;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::PathBuf;

/// Explain the color of a pixel, or the hit of a ray
///
/// Prints the rays of a pixel as a tree: what each ray hits and with what error bound, which lights
/// reach the surface and what blocks the others, and what mirrors, glass and each ray contribute.
/// The contributions add up to the samples, each limited to display white, or to 4 or 16 times that
/// where effects need it; tone mapping changes their mean. Then it prints the nodes that the ray visits, the nodes that it skips with the planes
/// that exclude them, and every primitive that is tested.
///
/// The code that renders reports all of this. Points and distances are in scene units, distances
/// along the ray. Colors are linear; 1 is display white.
#[derive(Args)]
#[command(after_help = super::failure::EXIT_CODES, group = ArgGroup::new("subject").required(true))]
pub struct Arguments {
    /// Blob or scene file, or `-` for standard input
    #[arg(value_name = "BLOB|SCENE")]
    input: PathBuf,

    /// Pixel to explain, counted from the upper left corner, which is 0,0
    #[arg(long, value_name = "X,Y", value_parser = pixel, group = "subject",
        allow_hyphen_values = true)]
    pixel: Option<[u16; 2]>,

    /// Ray to explain: origin, direction of any length, and an interval in multiples of the
    /// direction [default interval: 0,inf]
    #[arg(
        long,
        value_name = "OX,OY,OZ,DX,DY,DZ[,TMIN,TMAX]",
        value_parser = ray,
        group = "subject",
        allow_hyphen_values = true
    )]
    ray: Option<SceneRay>,

    #[command(flatten)]
    with: TraceOptions,

    #[command(flatten)]
    picture: PictureOptions,

    /// Show the nodes of every ray, of shadow rays too
    #[arg(long)]
    all_walks: bool,

    /// Show the exact pixel as `certify` encloses it: the intervals along its rays, of linear values
    #[arg(long, conflicts_with_all = ["ray", "all_walks", "format", "accel"])]
    interval: bool,

    /// Show a scene that moves at this time, in seconds [default: as its file states it, without tracks]
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_hyphen_values = true)]
    time: Option<f64>,

    /// Print the results as JSON
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    scene_options: SceneOptions,

    #[command(flatten)]
    target_point: TargetPoint,
}

/// Explains a pixel or a ray.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let scene_options = arguments.target_point.with_target(&arguments.scene_options);
    let of_pixels = || {
        let of_camera = || scene_options.view.given_for_camera();
        arguments.picture.of_pixels().or_else(of_camera)
    };
    if arguments.ray.is_some()
        && let Some(option) = of_pixels()
    {
        return Err(Failure::usage(
            format!("{option} is for pixels, not for --ray"),
            "leave the option out",
        ));
    }
    let source = Source::to_trace(
        &arguments.input,
        &scene_options
            .sized(arguments.picture.size)
            .at(arguments.time),
        &arguments.with,
        Structure::DualSplit,
    )?;
    let scene = source.scene()?;
    let structure = source.structure(&scene, arguments.with.accel)?;
    let settings = arguments.picture.settings(&scene);
    let Settings { width, height, .. } = settings;
    let subject = match (arguments.pixel, arguments.ray) {
        (Some([x, y]), _) if x >= width || y >= height => {
            return Err(Failure::usage(
                format!("pixel {x},{y} is outside of the picture, which is {width} x {height}"),
                format!(
                    "pixels count from 0: ask for one of 0,0 to {},{}",
                    width - 1,
                    height - 1
                ),
            ));
        }
        (Some(pixel), _) => Subject::Pixel(pixel),
        (None, Some(ray)) => Subject::Ray(ray),
        // The command line requires one of them.
        (None, None) => return Ok(()),
    };
    if let (true, Subject::Pixel(pixel)) = (arguments.interval, subject) {
        return intervals(arguments, &source, &scene, &settings, pixel);
    }
    let explanation =
        explain(&scene, arguments.with.format, structure, settings, subject).map_err(failure)?;
    let names = source.names(&scene);
    if arguments.json {
        let objects = named(&explanation, &names);
        let instances = named_instances(&explanation, &names);
        let explanation = Named {
            explanation,
            objects,
            instances,
        };
        return print_json_warned(&explanation, &source.warnings);
    }
    print(Shown {
        explanation: &explanation,
        names: &names,
        all_walks: arguments.all_walks,
    })
}

/// Explains the intervals of the exact pixel.
fn intervals(
    arguments: &Arguments,
    source: &Source,
    scene: &Scene<'_>,
    settings: &Settings,
    pixel: [u16; 2],
) -> Result<(), Failure> {
    let world = World::of(scene).map_err(|unknown| {
        Failure::rejected(
            format!("{}: {unknown}", arguments.input.display()),
            "leave out `--interval`",
        )
    })?;
    let (enclosed, steps, open) = certify::explain(&world, settings, pixel);
    let intervals = Intervals {
        pixel,
        bits: certify::LEVELS[usize::from(enclosed.level)],
        linear: enclosed.linear,
        low: enclosed.low,
        high: enclosed.high,
        proved: enclosed.proved().is_some(),
        open,
        lights: light_names(&steps, &source.names(scene)),
        steps,
    };
    if arguments.json {
        return print_json_warned(&intervals, &source.warnings);
    }
    print(intervals.text())
}

/// The intervals of the exact pixel.
#[derive(Serialize)]
struct Intervals {
    pixel: [u16; 2],
    /// Bits of the numbers that decided the pixel, or were the last.
    bits: usize,
    linear: [[f64; 2]; 3],
    low: [u8; 3],
    high: [u8; 3],
    proved: bool,
    open: Vec<certify::Open>,
    /// Names of lights by number; those without a name are missing.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    lights: BTreeMap<u32, String>,
    steps: Vec<certify::Step>,
}

fn light_names(steps: &[certify::Step], names: &Names) -> BTreeMap<u32, String> {
    let numbers = steps.iter().filter_map(|step| step.light);
    let named = numbers.filter_map(|it| Some((it, names.light(it)?.to_owned())));
    named.collect()
}

impl Intervals {
    fn text(&self) -> String {
        let Self {
            pixel: [x, y],
            bits,
            low,
            high,
            ..
        } = self;
        let mut text = if self.proved {
            format!("pixel {x},{y} is {low:?}, proved with {bits} bits\n")
        } else {
            format!("pixel {x},{y} lies between {low:?} and {high:?}, open with {bits} bits\n")
        };
        // Writing to a string cannot fail.
        for open in &self.open {
            let [px, py, pz] = open.point;
            let _ = writeln!(
                text,
                "open: {} at depth {}, at {px}, {py}, {pz} in scene units",
                open.reason.text(),
                open.depth
            );
        }
        if !self.steps.is_empty() {
            text.push_str("points and distances are in scene units\n");
        }
        for step in &self.steps {
            let indent = "  ".repeat(usize::from(step.depth) + 1);
            let _ = write!(text, "{indent}{}", step.event);
            if let Some(light) = step.light {
                let _ = write!(text, " {light}");
                if let Some(name) = self.lights.get(&light) {
                    let _ = write!(text, " `{}`", printable(name));
                }
            }
            if let (Some(primitive), Some(object)) = (step.primitive, step.object) {
                let _ = write!(text, ", primitive {primitive} of object {object}");
            }
            text.push('\n');
            for (name, numbers) in &step.values {
                let _ = write!(text, "{indent}  {name}");
                for [low, high] in numbers {
                    let _ = write!(text, " [{low:?}, {high:?}]");
                }
                text.push('\n');
            }
        }
        text
    }
}

/// An explanation, with the names of its objects.
#[derive(Serialize)]
struct Named {
    #[serde(flatten)]
    explanation: Explanation,
    /// Names of objects by number; those without a name are missing.
    objects: BTreeMap<u32, ObjectNames>,
    /// Names of instances by number; those without a name are missing.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    instances: BTreeMap<u32, String>,
}

#[derive(Serialize)]
struct ObjectNames {
    name: Option<String>,
    material: Option<String>,
}

fn named(explanation: &Explanation, names: &Names) -> BTreeMap<u32, ObjectNames> {
    let rays = explanation.samples.iter().flat_map(|sample| &sample.rays);
    let objects = rays.flat_map(|ray| {
        let blocking = ray.lights.iter().filter_map(|light| match light.outcome {
            LightOutcome::Blocked { object, .. } => Some(object),
            _ => None,
        });
        blocking.chain(ray.hit.as_ref().map(|hit| hit.object))
    });
    let named = objects.map(|object| {
        let name = names.object(object).map(str::to_owned);
        let material = names.material_of(object).map(str::to_owned);
        (object, ObjectNames { name, material })
    });
    named
        .filter(|(_, it)| it.name.is_some() || it.material.is_some())
        .collect()
}

fn named_instances(explanation: &Explanation, names: &Names) -> BTreeMap<u32, String> {
    let rays = explanation.samples.iter().flat_map(|sample| &sample.rays);
    let instances = rays.flat_map(|ray| {
        let blocking = ray.lights.iter().filter_map(|light| match light.outcome {
            LightOutcome::Blocked { instance, .. } => instance,
            _ => None,
        });
        blocking.chain(ray.hit.as_ref().and_then(|hit| hit.instance))
    });
    let named = instances.filter_map(|it| Some((it, names.instance(it)?.to_owned())));
    named.collect()
}

fn failure(error: ExplainError) -> Failure {
    match error {
        ExplainError::Render(error) => Failure::rendering(error),
        ExplainError::Ray(why) => Failure::usage(error.to_string(), why.remedy()),
    }
}

/// Reads a pixel, such as `200,150`.
fn pixel(text: &str) -> Result<[u16; 2], String> {
    let numbers: Result<Vec<u16>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    match numbers.as_deref() {
        Ok(&[x, y]) => Ok([x, y]),
        _ => Err(String::from("write column and row, such as 200,150")),
    }
}

/// Reads a ray of six or eight numbers.
pub fn ray(text: &str) -> Result<SceneRay, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    let (six, interval) = match numbers.as_deref() {
        Ok(six @ &[_, _, _, _, _, _]) => (six, [0.0, f64::INFINITY]),
        Ok(&[ref six @ .., tmin, tmax]) if six.len() == 6 => (six, [tmin, tmax]),
        _ => {
            return Err(String::from(
                "write origin and direction, six numbers with commas between them, and perhaps tmin \
                 and tmax",
            ));
        }
    };
    Ok(SceneRay {
        origin: DVec3::from_slice(&six[..3]),
        direction: DVec3::from_slice(&six[3..]),
        tmin: interval[0],
        tmax: interval[1],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_and_rays_are_numbers_with_commas() {
        assert_eq!(pixel("3, 4"), Ok([3, 4]));
        for wrong in ["", "3", "3,4,5", "-1,2", "3;4", "70000,0"] {
            assert!(pixel(wrong).is_err(), "{wrong}");
        }
        let short = ray("1,2,3,-0.5,0,1e-300").unwrap();
        assert_eq!((short.tmin, short.tmax), (0.0, f64::INFINITY));
        assert_eq!(short.direction, DVec3::new(-0.5, 0.0, 1e-300));
        let long = ray("1,2,3,4,5,6,-inf,7").unwrap();
        assert_eq!((long.tmin, long.tmax), (f64::NEG_INFINITY, 7.0));
        for wrong in [
            "",
            "1,2,3,4,5",
            "1,2,3,4,5,6,7",
            "a,2,3,4,5,6",
            "1,2,3,4,5,6,7,8,9",
        ] {
            assert!(ray(wrong).is_err(), "{wrong}");
        }
    }
}
