//! Errors, as the program prints them.

use miette::{Diagnostic, GraphicalReportHandler, GraphicalTheme, LabeledSpan, SourceCode};
use serde_json::{Value, json};
use std::error::Error;
use std::fmt::{self, Display};

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
    pub fn of(error: impl Diagnostic + 'static) -> Self {
        Self::from_diagnostic(&error, error.to_string())
    }

    /// An error of the library about something.
    pub fn about(what: String, error: impl Diagnostic + 'static) -> Self {
        let message = format!("{what}: {error}");
        let error = Box::new(error);
        Self::from_diagnostic(&About { what, error }, message)
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

    // Without `miette::Report`, whose own handler would take 8 KB of the page.
    fn from_diagnostic(error: &dyn Diagnostic, message: String) -> Self {
        let theme = GraphicalTheme::unicode_nocolor();
        let handler = GraphicalReportHandler::new_themed(theme)
            .with_width(WIDTH)
            .with_links(false);
        let mut text = String::new();
        let rendered = handler.render_report(&mut text, error);
        Self {
            report: match rendered {
                Ok(()) => text,
                Err(_) => message.clone(),
            },
            message,
            help: error.help().map(|help| help.to_string()),
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

/// An error about something, with the excerpt and the remedy of the error.
#[derive(Debug)]
struct About {
    what: String,
    error: Box<dyn Diagnostic>,
}

impl Display for About {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.what)
    }
}

impl Error for About {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        Some(&*self.error)
    }
}

impl Diagnostic for About {
    fn help<'a>(&'a self) -> Option<Box<dyn Display + 'a>> {
        self.error.help()
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        self.error.labels()
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.error.source_code()
    }
}
