//! Every error: its line, its cause and its remedy.

use super::rejection;
use miette::{GraphicalReportHandler, GraphicalTheme};

#[test]
fn every_error_shows_line_cause_and_remedy() {
    let corpus = include_str!("errors.txt");
    let cases = corpus.split("\n---").skip(1);
    let mut count = 0;
    for case in cases {
        // The rest of the line of dashes is a heading.
        let (_, text) = case.split_once('\n').unwrap();
        let marks = text.lines().enumerate();
        let marks = marks.filter_map(|(index, line)| Some((index + 1, line.split_once("#!")?.1)));
        let [(line, words)] = marks.collect::<Vec<_>>()[..] else {
            panic!("not one mark in:\n{text}")
        };
        let (cause, remedy) = words.split_once('|').unwrap();
        let error = rejection(text);
        let message = format!("{error}; {}\n{text}", error.remedy);
        assert_eq!(error.line, Some(line), "{message}");
        assert!(error.file.ends_with("scene.toml"), "{message}");
        assert!(error.cause.contains(cause.trim()), "{message}");
        assert!(error.remedy.contains(remedy.trim()), "{message}");
        count += 1;
    }
    assert!(count > 100, "{count} cases");
}

#[test]
fn miette_underlines_the_value() {
    let error = rejection("[material.red]\ndiffuse = [1, 0, -2]\n");
    let mut report = String::new();
    let handler = GraphicalReportHandler::new_themed(GraphicalTheme::unicode_nocolor());
    handler.render_report(&mut report, &error).unwrap();
    let underlined = "2 │ diffuse = [1, 0, -2]\n   ·           ──────────";
    assert!(report.contains(underlined), "{report}");
    assert!(report.contains("write numbers at or above 0"), "{report}");
}
