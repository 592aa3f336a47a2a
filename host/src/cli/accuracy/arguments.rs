//! The options of `gridel accuracy`.

use crate::cli::arguments::{self, ImportOptions, scene_help, scene_long_help};
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use gridel_core::Structure;
use gridel_core::format::limits::MAX_SAMPLES;
use gridel_host::accuracy::Truth;
use gridel_host::compile::Quality;
use gridel_host::measure::board as boards;
use std::path::PathBuf;

/// Show what accuracy costs in time
///
/// Changes six settings, each alone and in combinations: number format, lattice bits (10, 12, 16,
/// 20, 24), samples per pixel (1 to 64, and those of the scene up to 2048), ray depth, the cutoff
/// below which a secondary ray is not traced, and the effects that the scene calls for, each of
/// which is left out. Builds and renders the scene with every setting, and compares the picture
/// with a reference: f64, or the exact picture with --reference exact; 24 bits, ray depth 32, and
/// the samples of --reference-samples. Its cutoff is 2^-14, or the least that is measured; 2^-20
/// where that is 0, because without a cutoff glass sends on too many rays at this depth.
///
/// Errors, of display values (sRGB) from 0 to 1:
///   RMSE           root of the mean square difference, over all pixels and channels
///   largest        largest difference
///   pixels off     pixels with a channel that differs by more than 1/255
///   SSIM           mean structural similarity (Wang and others 2004) of the gray pictures in
///                  windows of 8 by 8 that do not overlap; 1 is equal
///   FLIP           mean difference that an eye sees when pictures alternate; 0 is equal
///   other objects  rays through the middles of pixels that hit another object, or none
///   t              error of the distance of the others, in units of the last place of single
///                  precision: the median and the largest
///
/// The RMSE has two parts:
///   sampling       the picture of f64 with the setting, or its exact picture, against the reference
///   arithmetic     the picture of the setting's number format against that of f64, or the exact one
///
/// Costs:
///   time           milliseconds per frame on one thread: the median of the runs, and their spread
///   rays, tests    rays per pixel; boxes and primitives tested per ray
///   bytes          of the blob, and of the workspace on a 32-bit board
///   instructions   per pixel on boards, estimated from the rays and a recorded picture, which has no instances
///
/// Instances are kept as `gridel render` keeps them, or copied with --instances flatten, in the reference as well. A
/// hit of another instance counts as another object. Each part has as many lattice bits as the scene.
///
/// A star marks a setting that no other one beats: no other has a smaller error at a cost that is
/// surely not higher. A cost is higher if every run takes longer than every run of the other setting.
/// Where runs overlap, rays and tests decide within a number format.
///
/// Effects are listed in the order in which to give them up: first those that change the picture least for the
/// rays and tests that they save. Their instructions are those of the rays that they send.
///
/// Writes a folder: page.html with answers, chart and pictures, which loads nothing else; rmse.svg, a plot;
/// results.csv; and results.json, which is written every few seconds. After an interruption, the same
/// command continues from there.
#[derive(Args)]
#[command(after_help = crate::cli::failure::EXIT_CODES, verbatim_doc_comment)]
#[command(group = clap::ArgGroup::new("limit").args(["max_error", "max_rays"]).multiple(true))]
pub struct Arguments {
    #[arg(help = scene_help(), long_help = scene_long_help())]
    pub scene: PathBuf,

    /// Folder to write into; it is created if it is missing. A run of the same build with the same scene and options
    /// continues there, and no other run is overwritten [default: accuracy-SCENE, accuracy-stdin for standard
    /// input]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    /// Largest RMSE, 0 to 1: find the cheapest setting within it, and print its options of `build`
    /// and `render`
    #[arg(long, value_name = "E", value_parser = share)]
    pub max_error: Option<f64>,

    /// Most rays per pixel: find the most accurate setting within them, or with --max-error the cheapest
    /// within both
    #[arg(long, value_name = "R", value_parser = rays)]
    pub max_rays: Option<f64>,

    /// Cost for --max-error and --max-rays: instructions on this board [default: time on this machine]
    #[arg(long, value_name = "NAME", value_parser = board(), requires = "limit")]
    pub board: Option<String>,

    /// Size of the pictures, such as 80x60 [default: that of the scene file, reduced to at most 128
    /// pixels per side]. At most 1,048,576 pixels, for which about 1 GB of memory is needed
    #[arg(long, value_name = "WxH", value_parser = arguments::size)]
    pub size: Option<[u16; 2]>,

    /// Number of timed runs per setting
    #[arg(long, value_name = "N", default_value_t = 3,
        value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub repeat: u16,

    /// Reference for errors: pictures of f64, or the exact pictures that `certify` proves, which take 10 to 40 times as
    /// long
    #[arg(long, value_name = "NAME", value_parser = truth(), default_value = Truth::F64.name())]
    pub reference: Truth,

    /// Samples per pixel of the reference, at least twice the most that are measured and at most 4096
    /// [default: 256, or what is needed]
    #[arg(long, value_name = "N",
        value_parser = clap::value_parser!(u16).range(1..=i64::from(MAX_SAMPLES)))]
    pub reference_samples: Option<u16>,

    /// Acceleration structure; the figures of boards are those of dual-split
    #[arg(long, value_name = "NAME", value_parser = arguments::structure(),
        default_value = Structure::DualSplit.name())]
    pub accel: Structure,

    /// Time to spend on building wide [default: good]
    #[arg(long, value_name = "NAME")]
    pub quality: Option<Quality>,

    /// Print the results as JSON
    #[arg(long)]
    pub json: bool,

    /// Do not trace secondary rays that change every channel by less than this; 1 is display white
    /// [default: that of the scene file]
    #[arg(long, value_name = "X", value_parser = arguments::cutoff, allow_hyphen_values = true,
        help_heading = "Options for scene files")]
    pub cutoff: Option<f64>,

    #[command(flatten)]
    pub import: ImportOptions,
}

/// Reads an error bound.
fn share(text: &str) -> Result<f64, String> {
    let is_valid = |it| (0.0..=1.0).contains(&it);
    arguments::number(text, is_valid, "write a number from 0 to 1, such as 0.02")
}

/// Reads a limit of rays per pixel.
fn rays(text: &str) -> Result<f64, String> {
    let is_valid = |it: f64| it.is_finite() && it > 0.0;
    arguments::number(text, is_valid, "write a number above 0, such as 12.5")
}

fn truth() -> impl TypedValueParser<Value = Truth> {
    PossibleValuesParser::new(Truth::ALL.map(Truth::name)).map(|name| {
        let mut all = Truth::ALL.into_iter();
        all.find(|it| it.name() == name).unwrap_or_default()
    })
}

fn board() -> impl TypedValueParser<Value = String> {
    PossibleValuesParser::new(boards::names())
}
