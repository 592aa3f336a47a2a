//! The files that `gridel render` writes of one picture.

use crate::cli::arguments::{self, distinct};
use crate::cli::failure::Failure;
use crate::cli::input::is_standard;
use crate::cli::output::{Content, check_writable, reject_same, unsupported, write_files};
use clap::Args;
use gridel_core::Scene;
use gridel_core::render::RenderError;
use gridel_host::animation::AnimationFormat;
use gridel_host::layer::{Layer, LinearFormat, Window, write_npy};
use gridel_host::openexr;
use gridel_host::output::place;
use gridel_host::picture::{PictureFormat, RenderMetadata};
use gridel_host::render::{
    Aov, Job, LinearPicture, MOST_PIXELS, Picture, Values, render_aovs, render_linear_moments,
    render_moments,
};
use gridel_host::report::HeatMap;
use serde::{Serialize, Serializer};
use std::path::{Path, PathBuf};

/// The formats of pictures that this build writes, as messages list them.
const FORMATS: &str = if cfg!(feature = "exr") {
    ".png, .ppm, .rgb565, .npy or .exr"
} else {
    ".png, .ppm, .rgb565 or .npy"
};

/// Options for output files.
#[derive(Args)]
pub struct OutputOptions {
    /// Picture to write: .png, .ppm, or .rgb565 (two bytes per pixel, little-endian, without a
    /// header); or linear radiance, 1 being display white and no value limited: .npy (float32, shape
    /// (height, width, 3)) or .exr (with the feature `exr`). With `-` a PNG goes to standard output,
    /// and the report to standard error, behind warnings
    #[arg(short, long, value_name = "PICTURE")]
    pub output: PathBuf,

    /// Write properties of the surfaces too that the rays through the middles of pixels hit first:
    /// depth, normal, albedo, object, primitive, uv, instance, with commas between them. As channels of
    /// an .exr, else to NumPy files named after the picture, such as out.depth.npy
    ///
    /// depth is the distance from the eye; inf where nothing is hit. normal has length 1 and is that of
    /// shading, on the side of the eye; 0 where nothing is hit. albedo is the diffuse color of the material,
    /// also of mirrors and glass; 0 where nothing is hit. object, primitive and instance are numbers as
    /// `gridel trace` prints them; 4294967295 for none. uv are texture coordinates after the texture's scale,
    /// rotation and offset; inf for none
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = arguments::aov(),
        conflicts_with = "frames")]
    aov: Vec<Aov>,

    /// Dither, to hide steps between the colors of a display
    #[arg(long)]
    pub dither: bool,

    /// Count rays and tests; the time then includes the counting
    #[arg(long)]
    pub stats: bool,

    /// Write the work per pixel as a PNG too: the square root of the boxes and primitives tested,
    /// from black (none) over blue, red and yellow to white (the maximum, which is printed and
    /// stored in the file)
    #[arg(long, value_name = "FILE")]
    pub heat_map: Option<PathBuf>,
}

/// The heat map that was written.
#[derive(Serialize)]
pub struct HeatMapFile {
    pub file: String,
    /// Boxes and primitives tested for the pixel with the most.
    pub maximum: u32,
}

/// The storage of the picture.
#[derive(Clone, Copy, PartialEq)]
enum Stored {
    /// As a display shows it.
    Shown(PictureFormat),
    /// As linear radiance.
    Linear(LinearFormat),
}

/// An AOV and its file.
#[derive(Clone, Debug, Serialize)]
pub struct AovFile {
    pub name: &'static str,
    /// The file of the layer: that of the picture itself, if it holds layers.
    #[serde(serialize_with = "serialize_shown")]
    pub file: PathBuf,
    #[serde(skip)]
    aov: Aov,
}

/// Serializes a path as messages show it: JSON has no bytes beyond UTF-8.
fn serialize_shown<S: Serializer>(path: &Path, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(&path.display())
}

/// The file of a picture, and the other files of a run.
pub struct Outputs<'a> {
    picture: &'a Path,
    stored: Stored,
    heat_map: Option<&'a Path>,
    aovs: Vec<AovFile>,
}

/// The rendered pixels.
pub enum Image {
    Shown(Picture),
    Linear(LinearPicture),
}

impl Image {
    /// Returns the picture with what was counted, if it is one for displays.
    pub fn shown(&self) -> Option<&Picture> {
        match self {
            Self::Shown(picture) => Some(picture),
            Self::Linear(_) => None,
        }
    }
}

impl<'a> Outputs<'a> {
    /// Returns true if the picture is linear radiance.
    pub fn is_linear(&self) -> bool {
        matches!(self.stored, Stored::Linear(_))
    }

    /// Returns the requested files, or an error for names that cannot be written to. `is_mapped` is true if a curve of
    /// tone mapping is given.
    pub fn of(input: &Path, options: &'a OutputOptions, is_mapped: bool) -> Result<Self, Failure> {
        let picture = &*options.output;
        let stored = stored(picture)?;
        if let Stored::Linear(_) = stored {
            reject_options_of_displays(options, is_mapped)?;
        }
        let aovs = distinct(&options.aov).into_iter().map(|aov| {
            let file = match stored {
                Stored::Linear(LinearFormat::Exr) => picture.to_owned(),
                _ => picture.with_extension(format!("{}.npy", aov.name())),
            };
            let name = aov.name();
            AovFile { name, file, aov }
        });
        let outputs = Self {
            picture,
            stored,
            heat_map: options.heat_map.as_deref(),
            aovs: aovs.collect(),
        };
        outputs.check(input)?;
        Ok(outputs)
    }

    /// Proves that no file is written over another one, and that each can be written.
    fn check(&self, input: &Path) -> Result<(), Failure> {
        if let Some(heat_map) = self.heat_map
            && PictureFormat::of(heat_map) != Some(PictureFormat::Png)
        {
            return Err(unsupported(heat_map, "heat map", ".png"));
        }
        if is_standard(self.picture) && !self.aovs.is_empty() {
            return Err(Failure::usage(
                "AOVs go to files named after the picture, and it goes to standard output",
                "name a file with `-o`",
            ));
        }
        let heat_map = self.heat_map.map(|path| ("heat map", path));
        let own_files = self.own_files();
        let aovs = own_files.iter().map(|it| (it.name, &*it.file));
        let mut before: Vec<(&str, &Path)> = Vec::new();
        for (what, path) in [("picture", self.picture)]
            .into_iter()
            .chain(heat_map)
            .chain(aovs)
        {
            reject_same(input, path)?;
            if let Some((other, first)) = before.iter().find(|it| place(it.1) == place(path)) {
                return Err(Failure::usage(
                    format!("{other} and {what} are both {}", first.display()),
                    format!(
                        "give the {} another name",
                        if what == "heat map" { what } else { other }
                    ),
                ));
            }
            check_writable(path)?;
            before.push((what, path));
        }
        Ok(())
    }

    /// Returns all files that are written.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        let aovs = self.own_files().iter().map(|it| &*it.file);
        [self.picture].into_iter().chain(self.heat_map).chain(aovs)
    }

    /// The AOVs that have files of their own.
    fn own_files(&self) -> &[AovFile] {
        match self.stored {
            Stored::Linear(LinearFormat::Exr) => &[],
            _ => &self.aovs,
        }
    }

    /// Returns the largest number of pixels in memory at once.
    pub fn most_pixels(&self) -> usize {
        match self.stored {
            Stored::Shown(_) if self.aovs.is_empty() => MOST_PIXELS,
            // Some ten times as many bytes each.
            _ => MOST_PIXELS / 8,
        }
    }

    /// Renders the picture, at one moment or at several while a shutter is open.
    pub fn render(
        &self,
        moments: &[Scene<'_>],
        job: &Job,
        progress: &(dyn Fn() + Sync),
    ) -> Result<Image, RenderError> {
        match self.stored {
            Stored::Shown(_) => render_moments(moments, job, progress).map(Image::Shown),
            Stored::Linear(_) => render_linear_moments(moments, job, progress).map(Image::Linear),
        }
    }

    /// Writes all files or none. Returns the heat map and the AOVs that were written.
    pub fn write(
        &self,
        (scene, job): (&Scene<'_>, &Job),
        image: &Image,
        metadata: &RenderMetadata,
    ) -> Result<(Option<HeatMapFile>, Vec<AovFile>), Failure> {
        let asked: Vec<Aov> = self.aovs.iter().map(|it| it.aov).collect();
        let mut layers = layers(scene, job, &asked)?;
        let map = self.heat_map.zip(image.shown());
        let map = map.map(|(path, picture)| (path, HeatMap::of(picture)));
        let heat_map = map.as_ref().map(|(path, map)| HeatMapFile {
            file: path.display().to_string(),
            maximum: map.maximum,
        });
        let window = Window {
            width: job.settings.width,
            height: job.settings.height,
            rows: job.rows.clone(),
        };
        if let Image::Linear(picture) = image {
            let picture = Layer {
                name: None,
                values: Values::Vectors(picture.pixels.clone()),
            };
            layers.insert(0, picture);
        }
        let write_picture: Content<'_> = &|out| match (self.stored, image) {
            (Stored::Shown(format), Image::Shown(picture)) => format.write(out, picture, metadata),
            (Stored::Linear(LinearFormat::Exr), _) => {
                openexr::write(out, &window, &layers, &metadata.to_string())
            }
            _ => layers
                .iter()
                .filter(|layer| layer.name.is_none())
                .try_for_each(|layer| write_npy(out, &window, layer)),
        };
        let write_map = map.as_ref().map(|(path, map)| {
            let write = move |out: &mut dyn std::io::Write| map.write(out);
            (*path, write)
        });
        let named = layers.iter().filter(|layer| layer.name.is_some());
        let write_aovs: Vec<_> = self
            .own_files()
            .iter()
            .zip(named)
            .map(|(it, layer)| {
                let window = &window;
                let write = move |out: &mut dyn std::io::Write| write_npy(out, window, layer);
                (&*it.file, write)
            })
            .collect();
        let mut files = vec![(self.picture, write_picture)];
        files.extend(
            write_map
                .iter()
                .map(|(path, write)| (*path, write as Content<'_>)),
        );
        files.extend(
            write_aovs
                .iter()
                .map(|(path, write)| (*path, write as Content<'_>)),
        );
        write_files(&files)?;
        Ok((heat_map, self.aovs.clone()))
    }
}

/// The layers of AOVs.
fn layers(scene: &Scene<'_>, job: &Job, aovs: &[Aov]) -> Result<Vec<Layer>, Failure> {
    if aovs.is_empty() {
        return Ok(Vec::new());
    }
    let values = render_aovs(scene, job, aovs).map_err(Failure::rendering)?;
    let layers = aovs.iter().zip(values).map(|(aov, values)| Layer {
        name: Some(aov.name()),
        values,
    });
    Ok(layers.collect())
}

/// Returns the format that a picture's name requests.
fn stored(output: &Path) -> Result<Stored, Failure> {
    if is_standard(output) {
        return Ok(Stored::Shown(PictureFormat::Png));
    }
    if let Some(format) = PictureFormat::of(output) {
        return Ok(Stored::Shown(format));
    }
    if AnimationFormat::of(output).is_some() {
        return Err(Failure::usage(
            format!("{}: an animation has several frames", output.display()),
            format!("say which with `--frames`, such as `--frames 0..48`, or write {FORMATS}"),
        ));
    }
    let format = LinearFormat::of(output).ok_or_else(|| unsupported(output, "image", FORMATS))?;
    if !format.is_available() {
        return Err(Failure::usage(
            format!("{}: this build does not write .exr", output.display()),
            "write .npy, or install with `cargo install --features exr`",
        ));
    }
    Ok(Stored::Linear(format))
}

/// Rejects what only pictures for displays have.
fn reject_options_of_displays(options: &OutputOptions, is_mapped: bool) -> Result<(), Failure> {
    let given = [
        (is_mapped, "--tone-mapping"),
        (options.dither, "--dither"),
        (options.stats, "--stats"),
        (options.heat_map.is_some(), "--heat-map"),
    ];
    match given.into_iter().find(|(is_given, _)| *is_given) {
        Some((_, option)) => Err(Failure::usage(
            format!(
                "{}: `{option}` is for pictures of displays, and this one is linear radiance",
                options.output.display()
            ),
            format!("leave out `{option}`, or write .png, .ppm or .rgb565"),
        )),
        None => Ok(()),
    }
}
