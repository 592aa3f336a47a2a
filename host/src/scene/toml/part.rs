//! The `[[part]]` and `[[instance]]` tables.

use super::item::{InstanceItem, PartItem};
use super::joint::Joints;
use super::object::Reader;
use super::source::{Source, undefined};
use super::transform;
use super::value::Value;
use crate::scene::SceneError;
use crate::table::shortened;
use std::collections::{HashMap, HashSet};

impl Reader<'_> {
    /// Reads the parts, each under a name of its own.
    pub(super) fn parts(&mut self, list: Value<'_>) -> Result<Vec<PartItem>, SceneError> {
        let mut parts: Vec<PartItem> = Vec::new();
        let mut names = HashSet::new();
        for table in list.items("`[[part]]` above its name and its objects")? {
            let fields = table.fields("part", &[&["name", "object"]])?;
            let name = fields.require("name")?.name()?;
            if !names.insert(name.text.clone()) {
                return Err(self.source.error(
                    &name.span,
                    format!("there are two parts {:?}", shortened(&name.text)),
                    "give one of them another name",
                ));
            }
            parts.push(PartItem {
                items: self.members(&fields, "part")?,
                span: fields.span,
                name,
            });
        }
        Ok(parts)
    }
}

/// Reads the instances of these parts, which hang on these joints.
pub(super) fn instances(
    list: Value<'_>,
    parts: &[PartItem],
    joints: &Joints,
) -> Result<Vec<InstanceItem>, SceneError> {
    let numbers = parts.iter().enumerate();
    let numbers: HashMap<&str, usize> = numbers
        .map(|(at, it)| (it.name.text.as_str(), at))
        .collect();
    let mut names = HashSet::new();
    let mut instances = Vec::new();
    for table in list.items("`[[instance]]` above its keys")? {
        let fields = table.fields("instance", &[&["part", "name", "joint"], transform::KEYS])?;
        let part = fields.require("part")?;
        let text = part.filled()?;
        let number = numbers.get(text).copied().ok_or_else(|| {
            let known = parts.iter().map(|it| it.name.text.as_str());
            let remedy = undefined(text, known, "a `[[part]]` of this name", || {
                let name = shortened(text);
                format!("define it: `[[part]]` with `name = {name:?}`")
            });
            part.error(
                format!("there is no part {text:?}", text = shortened(text)),
                remedy,
            )
        })?;
        let (name, named) = match fields.get("name") {
            None => (format!("{text} {}", instances.len() + 1), part),
            Some(value) => (value.filled()?.to_owned(), value),
        };
        if !names.insert(name.clone()) {
            return Err(named.error(
                format!("there are two instances {name:?}", name = shortened(&name)),
                "give one of them another name; one without a name has that of its part and its number",
            ));
        }
        instances.push(InstanceItem {
            name,
            part: number,
            placement: transform::placement(&fields)?,
            joint: fields.or("joint", None, |value| joints.find(value).map(Some))?,
            span: fields.span,
        });
    }
    Ok(instances)
}

/// Warnings about parts that no instance places.
pub(super) fn unplaced(
    source: &Source,
    parts: &[PartItem],
    instances: &[InstanceItem],
) -> Vec<String> {
    let placed: HashSet<usize> = instances.iter().map(|it| it.part).collect();
    let parts = parts.iter().enumerate();
    let unplaced = parts.filter(|(number, _)| !placed.contains(number));
    let warning = |(_, part): (usize, &PartItem)| {
        let place = source.place(&part.span);
        format!(
            "{place}: no instance places the part {:?}; it is left out",
            shortened(&part.name.text)
        )
    };
    unplaced.map(warning).collect()
}
