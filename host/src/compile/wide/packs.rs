//! Packs spheres by eights: split by the surface area heuristic, but only behind a multiple of 8,
//! so that every pack but one is full.

use super::hull::Hull;
use crate::compile::hierarchy::node::Primitive;
use gridel_core::format::cluster::LANES;

/// A pack: the spheres' places among the compiler's.
#[derive(Clone, Debug)]
pub struct Pack {
    pub spheres: Vec<u32>,
    pub bounds: Hull,
}

impl Pack {
    /// Returns whether every lane has a sphere: all packs but one.
    pub fn is_full(&self) -> bool {
        self.spheres.len() == LANES
    }
}

/// Below this depth spheres are halved, so that no scene makes the builder recurse without end.
const DEEP: usize = 96;

/// Packs spheres.
pub fn find(mut spheres: Vec<Primitive>) -> Vec<Pack> {
    let mut packs = Vec::with_capacity(spheres.len().div_ceil(LANES));
    split(&mut spheres, &mut packs, 0);
    packs
}

fn split(spheres: &mut [Primitive], packs: &mut Vec<Pack>, depth: usize) {
    let [first, rest @ ..] = &*spheres else {
        return;
    };
    if spheres.len() <= LANES {
        packs.push(Pack {
            bounds: rest.iter().fold(first.bounds.into(), |all: Hull, it| {
                all.union(&it.bounds.into())
            }),
            spheres: spheres.iter().map(|sphere| sphere.index).collect(),
        });
        return;
    }
    let best = (0..3)
        .map(|axis| {
            sort(spheres, axis);
            let (cost, middle) = cheapest(spheres, depth > DEEP);
            (cost, axis, middle)
        })
        .min_by_key(|split| split.0);
    let Some((_, axis, middle)) = best else {
        return;
    };
    sort(spheres, axis);
    let (left, right) = spheres.split_at_mut(middle);
    split(left, packs, depth + 1);
    split(right, packs, depth + 1);
}

fn sort(spheres: &mut [Primitive], axis: usize) {
    spheres.sort_unstable_by_key(|sphere| (sphere.centroid(axis), sphere.index));
}

/// The cheapest split behind a multiple of 8 spheres, or that in the middle, and its cost.
fn cheapest(spheres: &[Primitive], balanced: bool) -> (i64, usize) {
    let chunks: Vec<Hull> = spheres
        .chunks(LANES)
        .filter_map(|chunk| {
            let hulls = chunk.iter().map(|it| Hull::from(it.bounds));
            hulls.reduce(|a, b| a.union(&b))
        })
        .collect();
    let union = |all: &mut Option<Hull>, next: &Hull| {
        let bounds = all.map_or(*next, |bounds| bounds.union(next));
        *all = Some(bounds);
        Some(bounds.area())
    };
    let left: Vec<i64> = chunks.iter().scan(None, union).collect();
    let right: Vec<i64> = chunks.iter().rev().scan(None, union).collect();
    let middle = chunks.len() / 2;
    let counts = if balanced {
        middle..middle + 1
    } else {
        1..chunks.len()
    };
    counts
        .map(|count| {
            let others = chunks.len() - count;
            let cost = left[count - 1] * count as i64 + right[others - 1] * others as i64;
            (cost, count * LANES)
        })
        .min_by_key(|split| split.0)
        .unwrap_or((0, LANES))
}
