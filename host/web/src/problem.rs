//! Errors, as the program prints them.

use miette::{Diagnostic, GraphicalReportHandler, GraphicalTheme, Report};
use serde_json::{Value, json};
use std::fmt::Display;

/// The reason why a request cannot be answered.
pub struct Problem {
    message: String,
    help: Option<String>,
    /// The message with its excerpt and its remedy, as the program prints it.
    report: String,
}

/// Columns of a report.
const WIDTH: usize = 80;

impl Problem {
    /// An error of the library.
    pub fn of(error: impl Diagnostic + Send + Sync + 'static) -> Self {
        Self::from_report(&Report::new(error), None)
    }

    /// An error of the library about something.
    pub fn about(what: String, error: impl Diagnostic + Send + Sync + 'static) -> Self {
        let report = Report::new(error);
        let message = format!("{what}: {report}");
        Self::from_report(&report.wrap_err(what), Some(message))
    }

    /// An error without an excerpt.
    pub fn new(message: impl Display, help: &str) -> Self {
        let message = message.to_string();
        Self {
            report: format!("  × {message}\n  help: {help}\n"),
            message,
            help: Some(help.to_owned()),
        }
    }

    /// A fault of the page or of this module.
    pub fn fault(error: impl Display) -> Self {
        Self::new(
            error,
            "this is a fault of the page: report it with the scene file",
        )
    }

    fn from_report(report: &Report, message: Option<String>) -> Self {
        let theme = GraphicalTheme::unicode_nocolor();
        let handler = GraphicalReportHandler::new_themed(theme)
            .with_width(WIDTH)
            .with_links(false);
        let mut text = String::new();
        let rendered = handler.render_report(&mut text, report.as_ref());
        let message = message.unwrap_or_else(|| report.to_string());
        Self {
            report: match rendered {
                Ok(()) => text,
                Err(_) => message.clone(),
            },
            message,
            help: report.help().map(|help| help.to_string()),
        }
    }

    pub fn json(&self) -> Value {
        let Self {
            message,
            help,
            report,
        } = self;
        json!({"error": {"message": message, "help": help, "report": report}})
    }
}
