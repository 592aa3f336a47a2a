//! `gridel accuracy`: what accuracy costs in time.

use super::arguments::ViewOptions;
use super::arguments::{
    self, GeometryOptions, ImportOptions, SceneOptions, check_quality, quoted, scene_help,
    scene_long_help,
};
use super::failure::Failure;
use super::output::{print, print_json_warned, prove, write_file, write_texts};
use super::progress::Progress;
use super::source::import;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use gridel_core::render::Pixel;
use gridel_core::{Rgb888, Structure};
use gridel_host::accuracy::{
    Bench, Exhibit, MeasureError, Point, Results, Setting, cheapest, frontier,
    least_reference_samples, page, sentences, sweep,
};
use gridel_host::compile::Quality;
use gridel_host::measure::{board as boards, difference_picture};
use gridel_host::picture::write_png;
use gridel_host::table::{Align, Table, counted, grouped, significant};
use serde::Serialize;
use std::fmt::Write;
use std::io;
use std::path::{Path, PathBuf};

/// Files of the output folder.
const RESULTS: &str = "results.json";
const PAGE: &str = "page.html";
const CSV: &str = "results.csv";
/// Most pixels that are measured.
const MOST_PIXELS: usize = 1 << 22;

/// Show what accuracy costs in time
///
/// Changes five settings, each alone and in combinations: number format, lattice bits (10, 12, 16, 20,
/// 24), samples per pixel (1 to 64), ray depth, and the cutoff below which a secondary ray is not
/// traced. Builds and renders the scene with every setting, and compares the picture with a reference:
/// f64, 24 bits, ray depth 16, and the samples of --reference-samples.
///
/// Errors, of display values (sRGB) from 0 to 1:
///   RMSE           root of the mean square difference, over all pixels and channels
///   largest        largest difference
///   pixels off     pixels with a channel that differs by more than 1/255
///   SSIM           mean structural similarity of the grey pictures in windows of 8 by 8; 1 is equal
///   FLIP           mean difference that an eye sees when pictures alternate; 0 is equal
///   other objects  rays through the middles of pixels that hit another object, or none
///   t              error of the distance of the others, in units of the last place of single
///                  precision: the median and the largest
///
/// Costs:
///   time           milliseconds per frame on one thread: the median of the runs, and their spread
///   rays, tests    rays per pixel; boxes and primitives tested per ray
///   bytes          of the blob, and of the workspace on a 32-bit board
///   instructions   per pixel on boards, estimated from the rays and a recorded picture
///
/// A star marks a setting that no other one beats: no other has a smaller error at a cost that is
/// surely not higher. A cost is higher if every run takes longer than every run of the other setting.
/// Where runs overlap, rays and tests decide within a number format.
///
/// Writes a folder: page.html with plots, sentences and pictures, which loads nothing else;
/// results.csv; and results.json, which grows with every step. After an interruption, the same command
/// continues where it stopped.
#[derive(Args)]
#[command(after_help = super::failure::EXIT_CODES, verbatim_doc_comment)]
pub struct Arguments {
    #[arg(help = scene_help(), long_help = scene_long_help())]
    scene: PathBuf,

    /// Folder to write into; it is created if it is missing. A run with the same scene and options
    /// continues there, and no other run is overwritten [default: accuracy-SCENE]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,

    /// Largest RMSE, 0 to 1: find the cheapest setting within it, and print its options of `build`
    /// and `render`
    #[arg(long, value_name = "E", value_parser = share)]
    max_error: Option<f64>,

    /// Cost for --max-error: instructions on this board [default: time on this machine]
    #[arg(long, value_name = "NAME", value_parser = board(), requires = "max_error")]
    board: Option<String>,

    /// Size of the pictures, such as 80x60 [default: that of the scene file, reduced to at most 128
    /// pixels per side]
    #[arg(long, value_name = "WxH", value_parser = arguments::size)]
    size: Option<[u16; 2]>,

    /// Number of timed runs per setting
    #[arg(long, value_name = "N", default_value_t = 3,
        value_parser = clap::value_parser!(u16).range(1..=1000))]
    repeat: u16,

    /// Samples per pixel of the reference, at least twice the most that are measured
    #[arg(long, value_name = "N", default_value_t = 256,
        value_parser = clap::value_parser!(u16).range(1..=256))]
    reference_samples: u16,

    /// Acceleration structure; the figures of boards are those of dual-split
    #[arg(long, value_name = "NAME", value_parser = arguments::structure(),
        default_value = Structure::DualSplit.name())]
    accel: Structure,

    /// Time to spend on building wide [default: good]
    #[arg(long, value_name = "NAME")]
    quality: Option<Quality>,

    /// Print the results as JSON
    #[arg(long)]
    json: bool,

    /// Do not trace secondary rays that change every channel by less than this; 1 is display white
    /// [default: that of the scene file]
    #[arg(long, value_name = "X", value_parser = arguments::cutoff, allow_hyphen_values = true,
        help_heading = "Options for scene files")]
    cutoff: Option<f64>,

    #[command(flatten)]
    import: ImportOptions,
}

/// Reads an error bound.
fn share(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok();
    let value = value.filter(|value| (0.0..=1.0).contains(value));
    value.ok_or_else(|| String::from("write a number from 0 to 1, such as 0.02"))
}

fn board() -> impl TypedValueParser<Value = String> {
    PossibleValuesParser::new(boards::names())
}

/// What is printed as JSON.
#[derive(Serialize)]
struct Told<'t> {
    folder: String,
    size: [u16; 2],
    points: &'t [Point],
    /// Which points nothing beats in cost and RMSE.
    frontier: Vec<bool>,
    sentences: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cheapest: Option<&'t Choice>,
}

/// The setting that was asked for.
#[derive(Serialize)]
struct Choice {
    name: String,
    rmse: f64,
    /// How surely it is the cheapest, where time on this machine decides.
    #[serde(skip_serializing_if = "Option::is_none")]
    noise: Option<String>,
    build: String,
    render: String,
}

/// Sweeps, measures and reports.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let path = &arguments.scene;
    check_quality(arguments.quality, &[arguments.accel])?;
    let options = SceneOptions {
        cutoff: arguments.cutoff,
        view: ViewOptions::default(),
        geometry: GeometryOptions {
            lattice_bits: None,
            import: arguments.import.clone(),
        },
    };
    let imported = import(path, &options)?;
    let stem = path.file_stem().unwrap_or_default().display().to_string();
    let folder = match &arguments.output {
        Some(folder) => folder.clone(),
        None => PathBuf::from(format!("accuracy-{stem}")),
    };
    let stated = imported.scene.render;
    let size = arguments
        .size
        .unwrap_or_else(|| smaller([stated.width, stated.height]));
    let pixels = usize::from(size[0]) * usize::from(size[1]);
    if pixels > MOST_PIXELS {
        return Err(Failure::usage(
            format!(
                "{} pixels exceed the largest size of {}",
                grouped(pixels),
                grouped(MOST_PIXELS)
            ),
            "ask for a smaller `--size`: errors, and times per ray, hardly depend on it",
        ));
    }
    let failed = |error: MeasureError| Failure::in_file(path, error);
    let mut bench = Bench::new(&imported.scene, arguments.accel, size);
    bench.quality = arguments.quality.unwrap_or_default();
    let settings = sweep(bench.base(), bench.is_secondary().map_err(failed)?);
    let least = least_reference_samples(&settings);
    if arguments.reference_samples < least {
        return Err(Failure::usage(
            format!(
                "a reference of {} per pixel is no better than the measured settings",
                counted(arguments.reference_samples.into(), "sample")
            ),
            format!("ask for at least {least} with `--reference-samples`, or leave it out"),
        ));
    }
    let key = format!(
        "gridel {} scene {:08x} size {size:?} structure {} reference {}",
        env!("CARGO_PKG_VERSION"),
        bench.checksum().map_err(failed)?,
        arguments.accel.name(),
        arguments.reference_samples
    );
    let kept = kept(&folder, &key)?;
    std::fs::create_dir_all(folder.join("pictures"))
        .map_err(|error| Failure::writing(&folder, &error))?;
    for name in [PAGE, CSV] {
        prove(&folder.join(name))?;
    }
    let results = measure(arguments, &mut bench, &folder, (key, kept), &settings)?;
    let exhibits = exhibits(&folder, size, &results)?;
    let page = page(&stem, size, &results, &exhibits)
        .map_err(|error| Failure::failed(error.to_string(), "report this as a fault of gridel"))?;
    let csv = csv(&results.points);
    write_texts(&folder, &[(PAGE, page), (CSV, csv)])?;

    let choice = choice(arguments, &stem, &results);
    if arguments.json {
        let told = Told {
            folder: folder.display().to_string(),
            size,
            points: &results.points,
            frontier: frontier(&results.points),
            sentences: sentences(&results.base, &results.points),
            cheapest: choice.as_ref(),
        };
        print_json_warned(&told, &imported.warnings)?;
    } else {
        print(text(&folder, size, &results, choice.as_ref()))?;
    }
    match arguments.max_error {
        Some(most) if choice.is_none() => Err(nothing_within(arguments, most, &results.points)),
        _ => Ok(()),
    }
}

/// No setting keeps within the bound.
fn nothing_within(arguments: &Arguments, most: f64, points: &[Point]) -> Failure {
    let on = arguments.board.as_deref();
    let measured = points
        .iter()
        .filter(|point| on.is_none_or(|board| point.instructions(board).is_some()));
    let least = measured
        .map(|point| point.errors.rmse)
        .fold(f64::INFINITY, f64::min);
    Failure::failed(
        format!(
            "no setting keeps within an RMSE of {most}; the least is {}",
            significant(least)
        ),
        "allow a larger error, or give the scene file more samples and depth",
    )
}

/// A picture's size, made smaller.
fn smaller(sides: [u32; 2]) -> [u16; 2] {
    const MOST: u32 = 128;
    let longest = sides[0].max(sides[1]).max(1);
    sides.map(|side| {
        let side = if longest > MOST {
            (side * MOST).div_ceil(longest)
        } else {
            side
        };
        side.clamp(1, MOST) as u16
    })
}

/// Measures what is not measured yet, and writes down every step.
fn measure(
    arguments: &Arguments,
    bench: &mut Bench<'_>,
    folder: &Path,
    (key, kept): (String, Option<Results>),
    settings: &[Setting],
) -> Result<Results, Failure> {
    let failed = |error: MeasureError| Failure::in_file(&arguments.scene, error);
    let file = folder.join(RESULTS);
    let repeats = usize::from(arguments.repeat);
    let progress = Progress::steps("measuring", (settings.len() * (repeats + 1)) as u64 + 1);
    let mut results = match kept {
        Some(results) => results,
        None => Results {
            key,
            base: bench.base(),
            reference: bench
                .reference(arguments.reference_samples)
                .map_err(failed)?,
            points: Vec::new(),
        },
    };
    progress.step();
    let write = |results: &Results| {
        let text = serde_json::to_vec(results).map_err(io::Error::other);
        write_file(&file, |out| text.and_then(|text| out.write_all(&text)))
    };
    write(&results)?;
    // One thread, so that times tell of the work and not of the machine's other work.
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .map_err(|error| Failure::failed(error.to_string(), "end other programs"))?;
    for setting in settings {
        if results.point(setting).is_none() {
            let (point, pixels) = bench.measure(setting, &results.reference).map_err(failed)?;
            let difference = difference_picture(&results.reference.pixels, &pixels);
            let name = setting.name();
            write_picture(folder, bench.size, &name, &encoded(&pixels))?;
            write_picture(
                folder,
                bench.size,
                &format!("{name}-difference"),
                &difference,
            )?;
            results.points.push(point);
            write(&results)?;
        }
        progress.step();
    }
    for repeat in 0..repeats {
        for setting in settings {
            let missing = |point: &&mut Point| point.cost.seconds.len() <= repeat;
            if results.point(setting).filter(missing).is_some() {
                let seconds = pool.install(|| bench.time(setting)).map_err(failed)?;
                if let Some(point) = results.point(setting) {
                    point.cost.seconds.push(seconds);
                }
                write(&results)?;
            }
            progress.step();
        }
    }
    Ok(results)
}

fn encoded(pixels: &[[u16; 3]]) -> Vec<u8> {
    let pixels = pixels
        .iter()
        .flat_map(|&linear| Rgb888::encode(linear, None).0);
    pixels.collect()
}

/// What an earlier run measured of the same. Another's results, or files of other sorts, are not replaced.
fn kept(folder: &Path, key: &str) -> Result<Option<Results>, Failure> {
    let file = folder.join(RESULTS);
    let foreign = |path: &Path| {
        Err(Failure::usage(
            format!(
                "{} is not of a run with this scene and these options: it would be lost",
                path.display()
            ),
            "give another folder with `-o`, or remove that one",
        ))
    };
    if !file.exists() {
        let mut others = [PAGE, CSV].map(|name| folder.join(name)).into_iter();
        return match others.find(|path| path.exists()) {
            Some(path) => foreign(&path),
            None => Ok(None),
        };
    }
    let bytes = std::fs::read(&file).map_err(|error| Failure::reading(&file, &error))?;
    match serde_json::from_slice::<Results>(&bytes) {
        Ok(mut results) if results.key == key => {
            // What has lost its pictures is measured again.
            results.points.retain(|point| {
                let difference = format!("{}-difference", point.name);
                let mut pictures = [&point.name, &difference].into_iter();
                pictures.all(|name| picture(folder, name).exists())
            });
            Ok(Some(results))
        }
        _ => foreign(&file),
    }
}

/// The path of a picture.
fn picture(folder: &Path, name: &str) -> PathBuf {
    let pictures = folder.join("pictures");
    pictures.join(name).with_added_extension("png")
}

fn write_picture(folder: &Path, size: [u16; 2], name: &str, pixels: &[u8]) -> Result<(), Failure> {
    let path = picture(folder, name);
    write_file(&path, |out| {
        write_png(out, size.map(u32::from), pixels, None)
    })
}

/// The reference, and the pictures of levers that were turned alone.
fn exhibits(folder: &Path, size: [u16; 2], results: &Results) -> Result<Vec<Exhibit>, Failure> {
    let read = |name: &str| -> Result<Vec<u8>, Failure> {
        let path = picture(folder, name);
        let pixels = || -> io::Result<Vec<u8>> {
            let file = io::BufReader::new(std::fs::File::open(&path)?);
            let mut reader = png::Decoder::new(file).read_info()?;
            let mut pixels = vec![0; 3 * usize::from(size[0]) * usize::from(size[1])];
            reader.next_frame(&mut pixels)?;
            Ok(pixels)
        };
        pixels().map_err(|error| Failure::reading(&path, &error))
    };
    let mut exhibits = vec![Exhibit {
        name: String::from("the reference"),
        picture: encoded(&results.reference.pixels),
        difference: Vec::new(),
    }];
    for (number, point) in results.points.iter().enumerate() {
        if point.setting.differs(&results.base).len() <= 1 {
            exhibits.push(Exhibit {
                name: format!("{} {}", number + 1, point.name),
                picture: read(&point.name)?,
                difference: read(&format!("{}-difference", point.name))?,
            });
        }
    }
    Ok(exhibits)
}

/// The cheapest setting within the bound that was asked for, as options.
fn choice(arguments: &Arguments, stem: &str, results: &Results) -> Option<Choice> {
    let most = arguments.max_error?;
    let point = cheapest(&results.points, most, arguments.board.as_deref())?;
    let setting = &point.setting;
    let stated = setting.cutoff == results.base.cutoff && arguments.cutoff.is_none();
    let cutoff = match stated {
        true => String::new(),
        false => format!(" --cutoff {}", setting.cutoff),
    };
    let quality = arguments.quality.and_then(|it| it.to_possible_value());
    let quality = quality.map_or(String::new(), |it| format!(" --quality {}", it.get_name()));
    let [blob, picture] = ["gridel", "png"].map(|end| quoted(&format!("{stem}.{end}")));
    Some(Choice {
        name: point.name.clone(),
        rmse: point.errors.rmse,
        noise: arguments
            .board
            .is_none()
            .then(|| noise(point, &results.points, most)),
        build: format!(
            "gridel build {}{} -o {blob} --accel {}{quality} --lattice-bits {}{cutoff}",
            quoted(&arguments.scene.to_string_lossy()),
            arguments.import.written(),
            arguments.accel.name(),
            setting.lattice_bits
        ),
        render: format!(
            "gridel render {blob} -o {picture} --format {} --samples {} --depth {}",
            setting.format.name(),
            setting.samples,
            setting.depth
        ),
    })
}

/// How surely a point is the fastest within a bound.
fn noise(fastest: &Point, points: &[Point], most: f64) -> String {
    let Some(repeats) = fastest.cost.interval() else {
        return String::from(", timed once, so its noise is unknown");
    };
    let within = points.iter().filter(|point| point.errors.rmse <= most);
    let others = within.filter(|point| !fastest.cost.is_below(&point.cost));
    let [least, largest] = repeats.map(|seconds| 1e3 * seconds);
    let took = format!(" in {least:.2} to {largest:.2} ms");
    match others.count().saturating_sub(1) {
        0 => took,
        others => format!(
            "{took}; {} within the bound differ from it by no more than the noise",
            counted(others, "other setting")
        ),
    }
}

fn text(folder: &Path, size: [u16; 2], results: &Results, choice: Option<&Choice>) -> String {
    let best = frontier(&results.points);
    let mut table = Table::new([
        ("", Align::Left),
        ("setting", Align::Left),
        ("ms", Align::Right),
        ("spread", Align::Right),
        ("RMSE", Align::Right),
        ("largest", Align::Right),
        ("pixels off", Align::Right),
        ("SSIM", Align::Right),
        ("FLIP", Align::Right),
        ("other objects", Align::Right),
        ("t", Align::Right),
        ("rays per pixel", Align::Right),
        ("tests per ray", Align::Right),
        ("blob", Align::Right),
        ("RAM", Align::Right),
    ]);
    for (point, best) in results.points.iter().zip(best) {
        let (errors, cost) = (&point.errors, &point.cost);
        table.row([
            String::from(if best { "*" } else { "" }),
            point.name.clone(),
            format!("{:.2}", 1e3 * cost.time()),
            cost.spread_text(),
            format!("{:.5}", errors.rmse),
            format!("{:.4}", errors.largest),
            grouped(errors.pixels_off),
            format!("{:.4}", errors.ssim),
            format!("{:.4}", errors.flip),
            grouped(errors.other_objects),
            format!("{:.1}, {:.0}", errors.t_ulps[0], errors.t_ulps[1]),
            format!("{:.2}", cost.rays as f64 / cost.pixels.max(1) as f64),
            format!("{:.1}", cost.tests as f64 / cost.rays.max(1) as f64),
            grouped(cost.blob_bytes),
            grouped(cost.working_bytes),
        ]);
    }
    let mut text = format!(
        "{}, {} x {} pixels; * no other is as right at a cost that is surely no higher\n{table}\n",
        counted(results.points.len(), "setting"),
        size[0],
        size[1]
    );
    // Writing to a string cannot fail.
    for sentence in sentences(&results.base, &results.points) {
        let _ = writeln!(text, "{sentence}");
    }
    let _ = writeln!(
        text,
        "\n{}: plots and pictures",
        folder.join("page.html").display()
    );
    if let Some(choice) = choice {
        let _ = writeln!(
            text,
            "\nThe cheapest within the bound is {}, with an RMSE of {}{}:\n  {}\n  {}",
            choice.name,
            significant(choice.rmse),
            choice.noise.as_deref().unwrap_or_default(),
            choice.build,
            choice.render
        );
    }
    text
}

fn csv(points: &[Point]) -> String {
    let mut csv = String::from(
        "name,format,lattice_bits,samples,depth,cutoff,rmse,largest,pixels_off,ssim,flip,\
         other_objects,t_ulps_median,t_ulps_largest,seconds,spread,rays,tests,pixels,blob_bytes,\
         working_bytes",
    );
    for board in boards::core_names() {
        let _ = write!(csv, ",{board}_least,{board}_most");
    }
    csv.push('\n');
    for point in points {
        let Point {
            name,
            setting,
            errors,
            cost,
        } = point;
        let _ = write!(
            csv,
            "{name},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}",
            setting.format.name(),
            setting.lattice_bits,
            setting.samples,
            setting.depth,
            setting.cutoff,
            errors.rmse,
            errors.largest,
            errors.pixels_off,
            errors.ssim,
            errors.flip,
            errors.other_objects,
            errors.t_ulps[0],
            errors.t_ulps[1],
            cost.time(),
            cost.spread()
                .map_or(String::new(), |spread| spread.to_string()),
            cost.rays,
            cost.tests,
            cost.pixels,
            cost.blob_bytes,
            cost.working_bytes
        );
        for board in boards::core_names() {
            match point.instructions(board) {
                Some([least, most]) => {
                    let _ = write!(csv, ",{least:.0},{most:.0}");
                }
                None => csv.push_str(",,"),
            }
        }
        csv.push('\n');
    }
    csv
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_made_smaller_and_never_larger() {
        assert_eq!(smaller([400, 300]), [128, 96]);
        assert_eq!(smaller([64, 20]), [64, 20]);
        assert_eq!(smaller([60_000, 1]), [128, 1]);
    }
}
