//! Findings as JUnit XML.

use super::report::{Finding, Outcome, Report};
use crate::report::escape;
use std::fmt::Write as _;
use std::io::{self, Write};

impl Report {
    /// Writes the findings as JUnit XML: a suite for each check, a case for each finding.
    ///
    /// # Errors
    /// If `out` has one.
    pub fn write_junit(&self, out: &mut dyn Write) -> io::Result<()> {
        out.write_all(document(&self.findings).as_bytes())
    }
}

/// Returns the document: a suite for each check, a case for each finding.
pub(super) fn document(findings: &[Finding]) -> String {
    let mut xml = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let _ = writeln!(
        xml,
        "<testsuites name=\"gridel check\" {}>",
        counts(findings)
    );
    for suite in findings.chunk_by(|a, b| a.check == b.check) {
        let Some(first) = suite.first() else {
            continue;
        };
        let name = escaped(&first.check);
        let _ = writeln!(xml, "    <testsuite name=\"{name}\" {}>", counts(suite));
        for finding in suite {
            case(&mut xml, &name, finding);
        }
        xml += "    </testsuite>\n";
    }
    xml += "</testsuites>\n";
    xml
}

fn case(xml: &mut String, suite: &str, finding: &Finding) {
    let what = escaped(&finding.what);
    let on = finding.on.as_deref();
    let on = on.map_or(String::new(), |on| format!(" on {}", escaped(on)));
    let _ = writeln!(
        xml,
        "        <testcase name=\"{what}{on}\" classname=\"{suite}\">"
    );
    let mut properties = String::new();
    let figures = [("found", &finding.found), ("allowed", &finding.allowed)];
    for (name, figure) in figures {
        if let Some(figure) = figure {
            let value = escaped(&figure.plain());
            let _ = writeln!(
                properties,
                "                <property name=\"{name}\" value=\"{value}\"/>"
            );
        }
    }
    if !properties.is_empty() {
        let _ = write!(
            xml,
            "            <properties>\n{properties}            </properties>\n"
        );
    }
    let reason = match &finding.outcome {
        Outcome::Passed | Outcome::Recorded => None,
        Outcome::Failed(why) => Some(("failure", why)),
        Outcome::NotRun(why) => Some(("skipped", why)),
    };
    if let Some((tag, why)) = reason {
        let why = escaped(why);
        let _ = writeln!(xml, "            <{tag} message=\"{why}\"/>");
    }
    xml.push_str("        </testcase>\n");
}

fn counts(findings: &[Finding]) -> String {
    let count = |kind: fn(&Outcome) -> bool| {
        let of_kind = findings.iter().filter(|finding| kind(&finding.outcome));
        of_kind.count()
    };
    format!(
        "tests=\"{}\" skipped=\"{}\" failures=\"{}\" errors=\"0\"",
        findings.len(),
        count(|outcome| matches!(outcome, Outcome::NotRun(_))),
        count(|outcome| matches!(outcome, Outcome::Failed(_))),
    )
}

/// Text as an attribute's value. Characters that XML cannot hold are left out.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in escape(text).chars() {
        match character {
            '\'' => escaped += "&apos;",
            // Readers would take them for spaces.
            '\t' | '\n' | '\r' => {
                let _ = write!(escaped, "&#{};", u32::from(character));
            }
            '\0'..' ' | '\u{fffe}' | '\u{ffff}' => {}
            _ => escaped.push(character),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attributes_hold_any_text() {
        assert_eq!(
            escaped("a<b>&\"'\n\u{1b}[0m\u{fffe}é"),
            "a&lt;b&gt;&amp;&quot;&apos;&#10;[0mé"
        );
    }
}
