//! Pixels that exact arithmetic proves, compared with a manifest's requirements.

use super::pictures::check_pixels;
use super::report::{Figure, Key, Outcome};
use super::run::{Compared, Run};
use crate::certify::{self, Enclosed, Report, World, certify, pictures};
use gridel_core::{Format, Scene, Structure};
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
        // What is proved does not depend on the formats.
        let formats: &[Format] = match check.max_proved_error {
            Some(_) => &check.formats,
            None => &[],
        };
        let pictures = pictures(scene, structure, settings, formats);
        let pictures = pictures.map_err(|error| failed(error.to_string()))?;
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
                    least_count(least, report.pixels)
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

/// Returns the least number of pixels that is no smaller part of all of them.
fn least_count(least: f64, pixels: usize) -> usize {
    let is_enough = |count: usize| count as f64 / pixels as f64 >= least;
    // The product is rounded, so it may be off by one.
    let near = (least * pixels as f64) as usize;
    let counts = near.saturating_sub(1)..=pixels;
    counts
        .into_iter()
        .find(|&it| is_enough(it))
        .unwrap_or(pixels)
}

#[cfg(test)]
mod tests {
    use super::least_count;

    #[test]
    fn least_count_is_the_first_that_passes() {
        for (least, pixels, expected) in [
            (0.07, 100, 7),
            (0.0, 100, 0),
            (1.0, 100, 100),
            (0.995, 100, 100),
            (0.29, 100, 29),
        ] {
            assert_eq!(least_count(least, pixels), expected, "{least} of {pixels}");
        }
    }
}
