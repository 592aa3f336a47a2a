//! The `[[joint]]` tables, and the room that a scene has for what moves.

use super::item::{InstanceItem, JointItem};
use super::source::{Source, undefined};
use super::value::Value;
use crate::scene::SceneError;
use crate::table::shortened;
use glam::{DAffine3, DVec3};
use std::collections::{HashMap, HashSet};

const KEYS: &[&str] = &["name", "parent", "pivot"];

/// The joints of a file.
#[derive(Default)]
pub(super) struct Joints {
    pub(super) items: Vec<JointItem>,
    numbers: HashMap<String, usize>,
}

/// Reads the joints, each under a name of its own.
pub(super) fn read(list: Value<'_>) -> Result<Joints, SceneError> {
    let mut joints = Joints::default();
    let example = "`[[joint]]` above its keys";
    let mut names = HashSet::new();
    for table in list.items(example)? {
        let fields = table.fields("joint", &[KEYS])?;
        names.insert(fields.require("name")?.filled()?);
    }
    for table in list.items(example)? {
        let fields = table.fields("joint", &[KEYS])?;
        let name = fields.require("name")?.name()?;
        let parent = fields.or("parent", None, |value| {
            let text = value.filled()?;
            if names.contains(text) && !joints.numbers.contains_key(text) {
                return Err(value.error(
                    format!(
                        "the joint {text:?} is not above the joint {:?}",
                        shortened(&name.text),
                        text = shortened(text)
                    ),
                    "write a joint behind its parent; joints cannot hang on each other in a circle",
                ));
            }
            joints.find(value).map(Some)
        })?;
        let number = joints.items.len();
        if joints.numbers.insert(name.text.clone(), number).is_some() {
            return Err(table.source.error(
                &name.span,
                format!("there are two joints {:?}", shortened(&name.text)),
                "give one of them another name",
            ));
        }
        joints.items.push(JointItem {
            parent,
            pivot: fields.or("pivot", DVec3::ZERO, Value::vector)?,
            span: fields.span,
            name,
        });
    }
    Ok(joints)
}

impl Joints {
    /// The number of the joint that a key names.
    pub(super) fn find(&self, value: Value<'_>) -> Result<usize, SceneError> {
        let text = value.filled()?;
        let error = |remedy| {
            value.error(
                format!("there is no joint {text:?}", text = shortened(text)),
                remedy,
            )
        };
        self.number(text).map_err(error)
    }

    /// Returns the number of a joint, or what to do where no joint has the name.
    pub(super) fn number(&self, name: &str) -> Result<usize, String> {
        let found = self.numbers.get(name).copied();
        found.ok_or_else(|| {
            let known = self.items.iter().map(|it| it.name.text.as_str());
            undefined(name, known, "a `[[joint]]` of this name", || {
                let name = shortened(name);
                format!("define it: `[[joint]]` with `name = {name:?}`")
            })
        })
    }
}

/// Warnings about joints that nothing hangs on.
pub(super) fn unused(source: &Source, joints: &Joints, instances: &[InstanceItem]) -> Vec<String> {
    let joints = &joints.items;
    let mut used = vec![false; joints.len()];
    for instance in instances {
        if let Some(joint) = instance.joint {
            used[joint] = true;
        }
    }
    // Parents come first.
    for (number, joint) in joints.iter().enumerate().rev() {
        if let Some(parent) = joint.parent {
            used[parent] |= used[number];
        }
    }
    let unused = joints.iter().zip(used).filter(|(_, used)| !used);
    let warning = |(joint, _): (&JointItem, bool)| {
        let place = source.place(&joint.span);
        let name = &joint.name.text;
        format!(
            "{place}: no instance hangs on the joint {name:?}, so it moves nothing",
            name = shortened(name)
        )
    };
    unused.map(warning).collect()
}

/// Reads `room = [[x, y, z], [x, y, z]]`, two opposite corners.
pub(super) fn room(value: Value<'_>) -> Result<[DVec3; 2], SceneError> {
    let mistyped = || {
        value.mistyped(
            "two opposite corners of a box",
            "`room = [[-1, 0, -1], [1, 2, 1]]`",
        )
    };
    if !value.is_array() {
        return Err(mistyped());
    }
    let corners = value.items("`room = [[-1, 0, -1], [1, 2, 1]]`")?;
    let corners: Vec<_> = corners.collect();
    let [one, other] = corners[..] else {
        return Err(mistyped());
    };
    let (one, other) = (one.vector()?, other.vector()?);
    Ok([one.min(other), one.max(other)])
}

/// The box around a box after a transform.
pub(super) fn moved_room([low, high]: [DVec3; 2], by: &DAffine3) -> [DVec3; 2] {
    let corners = (0..8).map(|corner| {
        let side = |axis: usize| if corner >> axis & 1 == 0 { low } else { high };
        by.transform_point3(DVec3::new(side(0).x, side(1).y, side(2).z))
    });
    let nowhere = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    corners.fold(nowhere, |all, corner| around(all, [corner; 2]))
}

/// The box around two.
pub(super) fn around(one: [DVec3; 2], other: [DVec3; 2]) -> [DVec3; 2] {
    [one[0].min(other[0]), one[1].max(other[1])]
}
