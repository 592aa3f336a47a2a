//! Sections, records and fields of `core/FORMAT.md`, which the core's declarations generate.

use super::{FORMAT, holds_table, text};
use gridel_core::format::SectionKind;
use gridel_core::format::layout::{FieldLayout, Form, Layout, RecordLayout, Stored};
use gridel_core::format::record::{Header, SectionEntry};

macro_rules! sections {
    (
        forms { $($form:tt)* }
        records { $(
            $(#[doc = $doc:literal])* $kind:ident = $number:literal, $name:literal, $record:tt,
            [$section:ident = $id:literal, $section_name:literal];
        )* }
    ) => {
        /// The sections of shapes that have one form of records.
        const SHAPES: &[SectionKind] = &[$(SectionKind::$section),*];
    };
}

gridel_core::shapes!(sections);

/// A record with its size.
#[derive(Clone, Copy)]
struct Record {
    bytes: usize,
    layout: &'static RecordLayout,
}

impl Record {
    fn heading(&self) -> String {
        format!("{}: {} bytes", self.layout.name, self.bytes)
    }

    /// The address of its heading in the document.
    fn anchor(&self) -> String {
        let kept = self.heading().replace(':', "").replace(' ', "-");
        format!("#{}", kept.to_lowercase())
    }
}

/// The records that a layout consists of, inner ones first.
fn collect(layout: &Layout, found: &mut Vec<Record>) {
    match layout.form {
        Form::Number(_) => {}
        Form::Array(_, element) => collect(element, found),
        Form::Record(record) => {
            for field in record.fields {
                collect(&field.layout, found);
            }
            if found.iter().all(|known| known.layout.name != record.name) {
                let (bytes, layout) = (layout.bytes, record);
                found.push(Record { bytes, layout });
            }
        }
    }
}

/// All records of blobs.
fn all() -> Vec<Record> {
    let mut found = Vec::new();
    collect(&Header::LAYOUT, &mut found);
    collect(&SectionEntry::LAYOUT, &mut found);
    for kind in SectionKind::ALL {
        for layout in kind.layout().records {
            collect(layout, &mut found);
        }
    }
    found
}

/// The paragraphs of documentation. Links lead to records of the document, and nowhere else.
fn paragraphs(doc: &[&str], records: &[Record]) -> Vec<String> {
    let lines: Vec<_> = doc.iter().map(|line| line.trim()).collect();
    let paragraphs = lines.split(|line| line.is_empty());
    paragraphs
        .map(|lines| linked(&lines.join(" "), records))
        .collect()
}

/// A text whose links lead to records.
fn linked(text: &str, records: &[Record]) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(start) = rest.find(['[', '`']) {
        let (before, from) = rest.split_at(start);
        out += before;
        // Brackets in code are no links.
        let (found, close) = match from.starts_with('`') {
            true => (1, "`"),
            false => (0, "]"),
        };
        let end = from[found..].find(close).expect("an end") + found + 1;
        let (part, after) = from.split_at(end);
        rest = after;
        if found == 1 {
            out += part;
            continue;
        }
        let label = &part[1..part.len() - 1];
        let mut target = label.trim_matches('`');
        if let Some(link) = after.strip_prefix('(') {
            let (path, behind) = link.split_once(')').expect("the end of a link");
            (target, rest) = (path, behind);
        }
        let name = target.rsplit("::").next();
        let record = records.iter().find(|it| Some(it.layout.name) == name);
        out += &match record {
            Some(record) => format!("[{label}]({})", record.anchor()),
            None => label.into(),
        };
    }
    out + rest
}

/// A type as the document writes it.
fn type_name(layout: &Layout) -> String {
    match layout.form {
        Form::Number(name) => name.into(),
        Form::Array(count, element) => format!("[{count}]{}", type_name(element)),
        Form::Record(record) => record.name.into(),
    }
}

/// The numbers that a type has.
fn numbers(layout: &Layout) -> [i64; 2] {
    match layout.form {
        Form::Array(_, element) => numbers(element),
        Form::Number("u8") => [0, u8::MAX.into()],
        Form::Number("u16") => [0, u16::MAX.into()],
        Form::Number("u32") => [0, u32::MAX.into()],
        Form::Number("i16") => [i16::MIN.into(), i16::MAX.into()],
        Form::Number("i32") => [i32::MIN.into(), i32::MAX.into()],
        Form::Number("i64") => [i64::MIN, i64::MAX],
        _ => panic!("{layout:?} has no ranges"),
    }
}

/// A number, as a power of two where it is large.
fn number(value: i64) -> String {
    let power = |value: i64| value >= 1 << 16 && value & (value - 1) == 0;
    match value {
        _ if power(value) => format!("2^{}", value.trailing_zeros()),
        _ if power(value + 1) => format!("2^{} - 1", (value + 1).trailing_zeros()),
        _ => value.to_string(),
    }
}

/// The range of a field.
fn valid(field: &FieldLayout) -> String {
    match field.valid {
        None => String::new(),
        Some([0, 1]) => "0 or 1".into(),
        Some([low, high]) if low == -high => format!("at most {} in magnitude", number(high)),
        Some([low, high]) if high == numbers(&field.layout)[1] => format!("{low} or more"),
        Some([low, high]) => format!("{} to {}", number(low), number(high)),
    }
}

/// Joins words, the last by a word of its own.
fn joined(words: &[String], last_by: &str) -> String {
    match words.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, rest)) => format!("{} {last_by} {last}", rest.join(", ")),
        None => String::new(),
    }
}

/// Heading, sections, documentation and fields of a record.
fn chapter(record: &Record, level: &str, records: &[Record]) -> String {
    let name = record.layout.name;
    let holds = |kind: &SectionKind| {
        let is_this = |form: &Layout| matches!(form.form, Form::Record(it) if it.name == name);
        kind.layout().records.iter().any(is_this)
    };
    let sections = SectionKind::ALL.into_iter().filter(holds);
    let sections: Vec<_> = sections.map(|kind| format!("`{}`", kind.name())).collect();
    let mut text = format!("{level} {}\n", record.heading());
    for paragraph in paragraphs(record.layout.doc, records) {
        text += &format!("{paragraph}\n\n");
    }
    if !sections.is_empty() {
        let plural = if sections.len() > 1 { "s" } else { "" };
        text += &format!("Section{plural}: {}.\n\n", joined(&sections, "and"));
    }
    let ranges = record
        .layout
        .fields
        .iter()
        .any(|field| field.valid.is_some());
    text += "| offset | type | field | meaning |";
    text += if ranges { " valid |\n" } else { "\n" };
    text += if ranges {
        "|---|---|---|---|---|\n"
    } else {
        "|---|---|---|---|\n"
    };
    for field in record.layout.fields {
        let name = match field.name {
            "0" => String::new(),
            name => format!("`{name}`"),
        };
        let doc = paragraphs(field.doc, records).join(" ");
        let kind = type_name(&field.layout);
        text += &format!("| {} | {kind} | {name} | {doc} |", field.offset);
        text += &if ranges {
            format!(" {} |\n", valid(field))
        } else {
            "\n".into()
        };
    }
    text
}

#[test]
fn format_lists_every_section() {
    let records = all();
    let mut table =
        String::from("| kind | name | records | bytes of a record |\n|---|---|---|---|\n");
    for kind in SectionKind::ALL {
        let layout = kind.layout();
        let strides = layout.records.iter().map(|form| form.bytes.to_string());
        let (number, name) = (kind as u16, kind.name());
        let doc = paragraphs(layout.doc, &records).join(" ");
        let strides = joined(&strides.collect::<Vec<_>>(), "or");
        table += &format!("| {number} | {name} | {doc} | {strides} |\n");
    }
    holds_table(FORMAT, "sections", &table);
}

/// Each record is between marks of its own, those of shapes together in the order of their registry.
#[test]
fn format_lists_every_field_of_every_record() {
    let records = all();
    let shapes: Vec<_> = SHAPES
        .iter()
        .flat_map(|kind| kind.layout().records)
        .filter_map(|layout| match layout.form {
            Form::Record(record) => Some(record.name),
            _ => None,
        })
        .collect();
    let mut together = String::new();
    for record in &records {
        let name = record.layout.name;
        if shapes.contains(&name) {
            together += &format!("{}\n", chapter(record, "###", &records));
            continue;
        }
        let level = match name {
            "Header" | "SectionEntry" => "##",
            _ => "###",
        };
        holds_table(
            FORMAT,
            &format!("record {name}"),
            &chapter(record, level, &records),
        );
    }
    holds_table(FORMAT, "shapes", &together);
    let marks = text(FORMAT).matches("<!-- record ").count();
    assert_eq!(
        marks,
        records.len() - shapes.len(),
        "a record that does not exist"
    );
}

/// The offsets of the fields leave no byte out, so a reader in another language needs only the table.
#[test]
fn fields_of_records_follow_each_other_without_padding() {
    for record in all() {
        let mut end = 0;
        for field in record.layout.fields {
            assert_eq!(field.offset, end, "{}.{}", record.layout.name, field.name);
            end += field.layout.bytes;
        }
        assert_eq!(end, record.bytes, "{}", record.layout.name);
    }
}
