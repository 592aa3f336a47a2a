//! Explanations of the pixels that are clicked in a window.

use super::shot::{Shot, ViewError};
use super::summary::summary;
use super::writer::{Texts, UNREAD};
use crate::compile::Names;
use crate::explain::{Shown, Subject, explain_first};
use gridel_core::Scene;
use std::sync::mpsc::Receiver;

/// Number of clicks that may wait for their explanation.
pub(super) const MOST_WAITING: usize = 16;

/// Number of samples whose rays are printed. A thousand take hundreds of megabytes.
const MOST_SAMPLES: usize = 4;

/// A pixel that was clicked, in the view of that moment.
pub(super) struct Click {
    pub(super) number: u64,
    pub(super) shot: Shot,
    pub(super) pixel: [u16; 2],
}

/// Explains the pixels that are clicked, one after the other, until the window is closed. Prints each explanation, and
/// calls `show` with the click's number and a line for the title. It returns false if the window is closed.
pub(super) fn explain_all(
    clicked: &Receiver<Click>,
    scene: &Scene<'_>,
    names: &Names,
    texts: &Texts,
    show: impl Fn(u64, String) -> bool,
) {
    for Click {
        number,
        shot,
        pixel,
    } in clicked
    {
        let line = match text_and_line(scene, names, &shot, pixel) {
            Ok((text, line)) => match texts.write(text) {
                true => line,
                false => format!("{line}; {UNREAD}"),
            },
            Err(error) => error,
        };
        if !show(number, line) {
            return;
        }
    }
}

/// Returns an explanation and its summary. The text ends with the summary, which is seen where the rest scrolls away.
fn text_and_line(
    scene: &Scene<'_>,
    names: &Names,
    shot: &Shot,
    pixel: [u16; 2],
) -> Result<(String, String), String> {
    let scene = scene.with_view(&shot.view).map_err(ViewError::from);
    let scene = scene.map_err(|error| error.to_string())?;
    let (format, structure, settings) = (shot.format, shot.structure, shot.settings);
    let subject = Subject::Pixel(pixel);
    let explanation = explain_first(&scene, format, structure, settings, subject, MOST_SAMPLES)
        .map_err(|error| error.to_string())?;
    let shown = Shown {
        explanation: &explanation,
        names,
        all_walks: false,
    };
    let line = summary(&explanation, names);
    Ok((format!("{shown}\n{line}\n\n"), line))
}
