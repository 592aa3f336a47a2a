//! Names for traced rays: the names of the objects whose numbers the hits have.

use gridel_core::Scene;
use gridel_host::compile::Names;
use gridel_host::table::{Align, Table, counted, grouped, printable};
use gridel_host::trace::SceneHit;
use serde::Serialize;
use std::cmp::Reverse;
use std::collections::BTreeMap;

/// The names behind the numbers of objects and primitives; the file of `trace --names`.
#[derive(Serialize)]
pub struct NameTable {
    objects: Vec<ObjectRow>,
    /// `None` for those without a name.
    materials: Vec<Option<String>>,
    lights: Vec<Option<String>>,
    /// In the order of the numbers that hits have; a blob holds no names of instances.
    instances: Vec<Option<String>>,
}

#[derive(Serialize)]
struct ObjectRow {
    object: u32,
    name: Option<String>,
    first_primitive: u32,
    /// Number of primitives, those that collapsed on the lattice included.
    primitives: u32,
    /// `None` in a scene without materials.
    material: Option<u32>,
    material_name: Option<String>,
}

impl NameTable {
    /// Returns the table of a scene.
    pub fn of(scene: &Scene<'_>, names: &Names) -> Self {
        let header = scene.header();
        let mut counts = vec![0; header.objects as usize];
        for primitive in 0..header.primitives {
            counts[scene.object(primitive) as usize] += 1;
        }
        let owned = |name: Option<&str>| name.map(str::to_owned);
        let mut first_primitive = 0;
        let row = |(object, primitives): (u32, u32)| {
            let first = first_primitive;
            first_primitive += primitives;
            ObjectRow {
                object,
                name: owned(names.object(object)),
                first_primitive: first,
                primitives,
                material: scene
                    .material(object)
                    .map(|_| scene.material_number(object)),
                material_name: owned(names.material_of(object)),
            }
        };
        let given = |name: Option<&String>| name.filter(|name| !name.is_empty()).cloned();
        let materials = 0..scene.materials().len();
        let lights = 0..scene.lights().len();
        let instances = 0..scene.instances().len();
        Self {
            objects: (0..).zip(counts).map(row).collect(),
            materials: materials
                .map(|number| given(names.materials.get(number)))
                .collect(),
            lights: lights
                .map(|number| given(names.lights.get(number)))
                .collect(),
            instances: instances
                .map(|number| given(names.instances.get(number)))
                .collect(),
        }
    }
}

/// Counts hits by the names of objects; one without a name is called by its number.
pub fn hits_by_name(hits: &[SceneHit], names: &Names) -> BTreeMap<String, usize> {
    let mut by_object: BTreeMap<u32, usize> = BTreeMap::new();
    for hit in hits.iter().filter(|hit| hit.primitive != u32::MAX) {
        *by_object.entry(hit.object).or_default() += 1;
    }
    let mut by_name = BTreeMap::new();
    for (object, count) in by_object {
        let name = names.object(object);
        let name = name.map_or_else(|| format!("object {object}"), str::to_owned);
        *by_name.entry(name).or_default() += count;
    }
    by_name
}

/// Objects that the table for a terminal names.
const SHOWN: usize = 20;

/// Returns the names with the most hits as a table; the last line counts the others.
pub fn most_hit(hits_by_name: &BTreeMap<String, usize>) -> String {
    let mut rows: Vec<_> = hits_by_name.iter().collect();
    // Equal counts stay in the order of names.
    rows.sort_by_key(|&(_, &hits)| Reverse(hits));
    let mut table = Table::new([("object", Align::Left), ("hits", Align::Right)]);
    for &(name, &hits) in rows.iter().take(SHOWN) {
        table.row([printable(name), grouped(hits)]);
    }
    let mut text = table.to_string();
    if let Some(others @ [_, ..]) = rows.get(SHOWN..) {
        let hits: usize = others.iter().map(|&(_, &hits)| hits).sum();
        text.push_str(&format!(
            "{} with {}; --json counts all\n",
            counted(others.len(), "other name"),
            counted(hits, "hit")
        ));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_has_the_names_with_the_most_hits_and_counts_the_others() {
        let hits = |names: usize| {
            let rows = (0..names).map(|number| (format!("object {number:03}"), 2 * number + 1));
            most_hit(&rows.collect())
        };
        assert_eq!(hits(0), "object  hits\n");
        assert_eq!(
            hits(2),
            "object      hits\nobject 001     3\nobject 000     1\n"
        );
        assert_eq!(hits(20).lines().count(), 21);
        let long = hits(1000);
        assert_eq!(long.lines().count(), 22);
        assert!(long.contains("\nobject 999  1,999\n"));
        // The sum of the first 980 odd numbers.
        let last = long.lines().last().unwrap();
        assert_eq!(last, "980 other names with 960,400 hits; --json counts all");
    }
}
