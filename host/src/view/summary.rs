//! The explanation of a pixel in one line, for the title of a window.

use crate::compile::Names;
use crate::explain::Explanation;
use crate::table::{counted, printable, significant};

/// Returns the pixel's color, the surface that it shows, and its number of rays.
pub fn summary(explanation: &Explanation, names: &Names) -> String {
    let [red, green, blue] = explanation.srgb;
    let [x, y] = explanation.pixel.unwrap_or_default();
    let first = explanation.samples.first();
    let hit = first.and_then(|sample| sample.rays.first()?.hit.as_ref());
    let seen = hit.map_or(String::from("background"), |hit| {
        let object = match names.object(hit.object) {
            Some(name) => format!("{} (object {})", printable(name), hit.object),
            None => format!("object {}", hit.object),
        };
        format!("{object} at distance {}", significant(hit.distance))
    });
    let rays = explanation.samples.iter().map(|sample| sample.rays.len());
    let rays = counted(rays.sum::<usize>(), "ray");
    let of_samples = match (explanation.listed_samples(), explanation.samples.len()) {
        (listed, all) if listed < all => format!(" in {listed} of {all} samples"),
        _ => String::new(),
    };
    format!("pixel {x},{y}: #{red:02x}{green:02x}{blue:02x}, {seen}, {rays}{of_samples}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::explain::{Shown, Subject, explain, explain_first};
    use crate::view::test_scene::quick;
    use gridel_core::{Format, Settings, Structure};

    #[test]
    fn summary_names_what_the_pixel_shows() {
        let blob = quick();
        let scene = blob.scene().unwrap();
        let names = Names::of_blob(&scene, blob.bytes()).unwrap();
        let settings = Settings {
            samples: 1,
            ..Settings::of(&scene)
        };
        let of = |pixel| {
            let subject = Subject::Pixel(pixel);
            let explanation =
                explain(&scene, Format::F64, Structure::Bvh, settings, subject).unwrap();
            (summary(&explanation, &names), explanation)
        };
        let middle = [settings.width / 2, settings.height / 2];
        let (text, explanation) = of(middle);
        let hit = explanation.samples[0].rays[0].hit.as_ref().unwrap();
        let object = format!("object {}", hit.object);
        assert!(
            text.contains(&object) && text.contains(" at distance "),
            "{text}"
        );
        let color = explanation.srgb.map(|channel| format!("{channel:02x}"));
        let place = format!("pixel {},{}: #{}", middle[0], middle[1], color.concat());
        assert!(text.starts_with(&place), "{text}");
    }

    #[test]
    fn first_samples_have_the_color_of_all() {
        let blob = quick();
        let scene = blob.scene().unwrap();
        let names = Names::of_blob(&scene, blob.bytes()).unwrap();
        let settings = Settings {
            samples: 8,
            ..Settings::of(&scene)
        };
        let middle = [settings.width / 2, settings.height / 2];
        let of = |samples| {
            let (format, subject) = (Format::F64, Subject::Pixel(middle));
            explain_first(&scene, format, Structure::Bvh, settings, subject, samples).unwrap()
        };
        let (first, all) = (of(3), of(usize::MAX));
        assert_eq!((first.linear, first.mean()), (all.linear, all.mean()));
        assert_eq!([first.listed_samples(), all.listed_samples()], [3, 8]);
        let shown = |explanation: &Explanation| {
            let names = &names;
            let shown = Shown {
                explanation,
                names,
                all_walks: false,
            };
            shown.to_string()
        };
        let (text, whole) = (shown(&first), shown(&all));
        assert!(
            text.contains("first 3 of 8 samples are explained"),
            "{text}"
        );
        let sample = |text: &str, number| {
            let begin = text.find(&format!("\nSample {number} of 8"));
            begin.map(|begin| text[begin..].lines().nth(1).map(String::from))
        };
        assert_eq!(sample(&text, 3), sample(&whole, 3));
        assert!(sample(&whole, 4).is_some() && sample(&text, 4).is_none());
        assert!(summary(&first, &names).ends_with(" in 3 of 8 samples"));
        assert!(summary(&all, &names).ends_with(" rays"));
    }
}
