//! Pixels that exact arithmetic proves, compared with a manifest's requirements.

use super::pictures::check_pixels;
use super::report::{Figure, Key, Outcome};
use super::run::{Compared, Run};
use crate::certify::{self, Enclosed, Report, World, certify};
use crate::render::{Job, render};
use gridel_core::{Scene, Structure};
use std::convert::Infallible;

impl Run<'_> {
    /// Encloses the picture, and compares the part that is proved and the largest proved error of each format.
    pub(super) fn certify(
        &mut self,
        scene: &Scene<'_>,
        structure: Structure,
        progress: &dyn Fn(),
    ) -> Result<(), String> {
        let check = self.check;
        if !check.is_certified() {
            return Ok(());
        }
        let failed = |error: String| format!("{}: {error}", check.scene.path.display());
        let settings = self.settings(scene);
        check_pixels(&settings, certify::MOST_PIXELS)?;
        let mut pictures = Vec::new();
        for &format in &check.formats {
            let job = Job::whole(format, structure, settings);
            let picture = render(scene, &job, &|| ());
            let picture = picture.map_err(|error| failed(error.to_string()))?;
            pictures.push((format, picture.pixels));
        }
        let world = World::of(scene).map_err(|error| failed(error.to_string()))?;
        let count = usize::from(settings.width) * usize::from(settings.height);
        let mut pixels = vec![Enclosed::default(); count];
        let Ok(()) = certify(&world, &settings, &mut pixels, &|| (), |_| {
            Ok::<_, Infallible>(())
        });
        let report = Report::of(&world, &settings, &pixels, &pictures);
        if let Some(least) = check.certified {
            let outcome = if report.certified >= least {
                Outcome::Passed
            } else {
                Outcome::Failed(format!(
                    "{} of {} pixels are proved, and {} have to be: `gridel certify` lists the others",
                    report.proved,
                    report.pixels,
                    (least * report.pixels as f64).ceil()
                ))
            };
            let (found, least) = (Figure::Mean(report.certified), Figure::Mean(least));
            self.push(None, "certified", Some(found), Some(least), outcome);
        }
        if let Some(most) = check.max_proved_error {
            for format in &report.formats {
                let compared = Compared {
                    what: "max_proved_error",
                    found: Figure::Count(format.max_proved_error.into()),
                    most: Some(Figure::Count(most)),
                };
                let keys = vec![Key::Name("max_proved_error".into())];
                self.held_to(Some(format.format.to_owned()), compared, keys, None);
            }
        }
        progress();
        Ok(())
    }
}
