//! Every builder on every sort of scene.

use super::*;
use gridel_core::Kind;
use gridel_core::format::limits::MAX_LEVELS;
use gridel_core::format::record::UnitBox;

fn primitives(boxes: impl IntoIterator<Item = [[i16; 2]; 3]>) -> Vec<Primitive> {
    boxes
        .into_iter()
        .zip(0..)
        .map(|(bounds, index)| Primitive {
            bounds: UnitBox(bounds),
            kind: if index % 7 == 0 {
                Kind::Sphere
            } else {
                Kind::Triangle
            },
            index,
        })
        .collect()
}

/// A cloud of small boxes.
fn cloud(count: usize) -> Vec<Primitive> {
    let mut state = 0x9e37_79b9_u32;
    let mut random = move || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        (state >> 17) as i16 - 16_000
    };
    primitives((0..count).map(|_| [0; 3].map(|_| random()).map(|low| [low, low + 300])))
}

/// Boxes that each lie next to all before it, so that one after the other makes a chain.
fn chain(count: usize) -> Vec<Primitive> {
    primitives((0..count).map(|step| [[(step * 3) as i16, (step * 3) as i16 + 1], [0, 1], [0, 1]]))
}

fn groups(primitive: &Primitive) -> (Vec<&'static str>, u32) {
    let names = ["a", "b", "c"];
    let name = |part: u32| names[(part % 3) as usize];
    (
        vec![name(primitive.index / 100), name(primitive.index / 10)],
        primitive.index,
    )
}

/// The depth below a node, and that everything is in its place.
fn check(node: &Node, primitives: &[Primitive], next: &mut usize) -> usize {
    match node {
        Node::Leaf {
            bounds,
            first,
            count,
            ..
        } => {
            assert_eq!(first, next);
            *next += count;
            let leaf = &primitives[*first..*next];
            assert!(
                leaf.iter()
                    .all(|p| bounds.contains(&p.bounds) && p.kind == leaf[0].kind)
            );
            assert!((1..=31).contains(count));
            0
        }
        Node::Inner { bounds, children } => {
            assert!(children.iter().all(|child| bounds.contains(child.bounds())));
            let depths = [0, 1].map(|child: usize| check(&children[child], primitives, next));
            1 + depths[0].max(depths[1])
        }
    }
}

#[test]
fn every_builder_keeps_every_primitive_and_the_depth() {
    let same = primitives(vec![[[5, 9]; 3]; 5000]);
    for (name, scene) in [
        ("cloud", cloud(3000)),
        ("chain", chain(3000)),
        ("same", same),
        ("two", cloud(2)),
        ("one", cloud(1)),
        ("none", Vec::new()),
    ] {
        for builder in Builder::ALL {
            let mut order = scene.clone();
            let Some(root) = build(builder, &mut order, 0, groups) else {
                assert!(scene.is_empty());
                continue;
            };
            let about = format!("{name}, {}", builder.name());
            let mut next = 0;
            let depth = check(&root, &order, &mut next);
            assert!(depth <= MAX_LEVELS, "{about}: {depth}");
            assert_eq!(next, scene.len(), "{about}");
            let mut places: Vec<u32> = order.iter().map(|p| p.index).collect();
            places.sort_unstable();
            assert!(
                places
                    .iter()
                    .zip(0..)
                    .all(|(&place, number)| place == number),
                "{about}"
            );
        }
    }
}

#[test]
fn better_builders_cost_less() {
    let cost = |builder| {
        let mut order = cloud(3000);
        hierarchy::sah_cost(&build(builder, &mut order, 0, groups).unwrap())
    };
    let [sah, binned, best, insertion, nearest, random] = [
        Builder::Sah,
        Builder::Binned,
        Builder::Reinsertion,
        Builder::Insertion,
        Builder::NearestPairing,
        Builder::RandomPairing,
    ]
    .map(cost);
    eprintln!("{sah:.1} {binned:.1} {best:.1} {insertion:.1} {nearest:.1} {random:.1}");
    assert!(best < sah && sah <= 1.05 * binned);
    assert!(insertion < 0.5 * random && nearest < 0.5 * random);
}
