//! Pictures of the host, compared with recorded hashes and reference pictures.

use super::image::Image;
use super::manifest::Reference;
use super::report::{Evidence, Figure, Key, Outcome, Record, ReferencePicture};
use super::run::Run;
use crate::explained;
use crate::measure::Rendered;
use crate::picture::hash;
use crate::render::{MOST_PIXELS, too_many_pixels};
use gridel_core::{Format, Scene, Settings, Structure};
use std::io;

impl Run<'_> {
    /// Measures the scene in one number format.
    pub(super) fn format(
        &mut self,
        scene: &Scene<'_>,
        (structure, blob): (Structure, &[u8]),
        format: Format,
        name: &str,
    ) -> Result<(), String> {
        let check = self.check;
        let on = Some(format.name().to_owned());
        self.working_memory(scene, format, blob);
        let tests = check.budget.tests_per_ray;
        if check.hash.is_none() && check.reference.is_none() && tests.is_none() {
            return Ok(());
        }
        let settings = self.settings(scene);
        let with = (structure, format);
        let rendered = self.render(scene, with, settings, tests.is_some())?;
        if let Some(most) = tests {
            let mean = Figure::Mean(rendered.tests_per_ray());
            self.budget(on.clone(), "tests_per_ray", mean, Some(Figure::Mean(most)));
        }
        let picture = &rendered.picture;
        let image = Image::of(picture);
        let reference = check
            .reference
            .as_ref()
            .map(|reference| (reference, Image::read(&reference.picture.path)));
        if let Some(hashes) = &check.hash {
            let expected = reference
                .as_ref()
                .and_then(|(_, image)| image.as_ref().ok().cloned());
            let recorded = hashes.get(format.name()).cloned().map(Figure::Hash);
            let found = Figure::Hash(hash(&picture.pixels));
            let evidence = Evidence::new(name, &image, expected);
            self.hash(format, found, recorded, evidence);
        }
        if let Some((reference, expected)) = reference {
            self.reference(format, reference, expected, image, name);
        }
        Ok(())
    }

    pub(super) fn settings(&self, scene: &Scene<'_>) -> Settings {
        let mut settings = Settings::of(scene);
        if let Some([width, height]) = self.check.size {
            (settings.width, settings.height) = (width, height);
        }
        settings.samples = self.check.samples.unwrap_or(settings.samples);
        settings
    }

    pub(super) fn render(
        &self,
        scene: &Scene<'_>,
        with: (Structure, Format),
        settings: Settings,
        count: bool,
    ) -> Result<Rendered, String> {
        check_pixels(&settings, MOST_PIXELS)?;
        Rendered::new(scene, with, settings, count)
            .map_err(|error| format!("{}: {error}", self.check.scene.path.display()))
    }

    fn hash(
        &mut self,
        format: Format,
        found: Figure,
        recorded: Option<Figure>,
        evidence: Evidence,
    ) {
        let outcome = match &recorded {
            Some(recorded) if found.within(recorded) => Outcome::Passed,
            Some(_) => Outcome::Failed(String::from("the picture is not the recorded one")),
            None => Outcome::Failed(String::from("no hash is recorded for this format")),
        };
        let keys = vec![Key::Name("hash".into()), Key::Name(format.name().into())];
        let broken = outcome != Outcome::Passed;
        let record = self.value(keys, &found);
        let on = Some(format.name().to_owned());
        let finding = self.push(on, "hash", Some(found), recorded, outcome);
        if broken {
            finding.record = Some(record);
            finding.evidence = Some(evidence);
        }
    }

    fn reference(
        &mut self,
        format: Format,
        reference: &Reference,
        expected: io::Result<Image>,
        image: Image,
        name: &str,
    ) {
        let has_folder = reference.picture.has_folder();
        let not_found = |error: &io::Error| error.kind() == io::ErrorKind::NotFound;
        // A file that exists and is not a picture was not meant to become one.
        let may_be_recorded = has_folder && expected.as_ref().map_or_else(not_found, |_| true);
        let to_expected = |expected| image.difference(expected, reference.channel);
        let difference = expected.as_ref().map(to_expected);
        let (found, outcome) = match difference {
            Err(error) => {
                let remedy = if may_be_recorded {
                    "check the path, or let `gridel check --bless` record the picture there"
                } else if !has_folder {
                    "check the path, or create its folder, and let `gridel check --bless` record the picture there"
                } else {
                    "write the path of an RGB or gray PNG with 8 bits per channel; `--bless` overwrites no others"
                };
                let cause = format!("cannot be read: {error}");
                let error = self.manifest.error(&reference.picture, cause, remedy);
                (None, Outcome::Failed(explained(&error)))
            }
            Ok(None) => {
                let [width, height] = image.size;
                let why = format!("the reference is not {width} by {height} pixels large");
                (None, Outcome::Failed(why))
            }
            Ok(Some(difference)) => {
                let outcome = if difference.beyond <= reference.pixels {
                    Outcome::Passed
                } else {
                    Outcome::Failed(format!(
                        "{} pixels differ by more than {} of 255, and the largest difference is {}",
                        difference.beyond, reference.channel, difference.largest
                    ))
                };
                (Some(Figure::Count(difference.beyond)), outcome)
            }
        };
        let broken = outcome != Outcome::Passed;
        let evidence = Evidence::new(name, &image, expected.ok());
        let (on, allowed) = (
            Some(format.name().to_owned()),
            Some(Figure::Count(reference.pixels)),
        );
        let finding = self.push(on, "reference", found, allowed, outcome);
        if broken {
            finding.evidence = Some(evidence);
        }
        finding.record =
            may_be_recorded.then(|| Record::Picture(ReferencePicture::new(reference, image)));
    }
}

/// Rejects a picture of too many pixels.
pub(super) fn check_pixels(settings: &Settings, most: usize) -> Result<(), String> {
    match too_many_pixels([settings.width, settings.height], most) {
        Some(clause) => Err(format!("{clause}; choose a smaller `size`")),
        None => Ok(()),
    }
}
