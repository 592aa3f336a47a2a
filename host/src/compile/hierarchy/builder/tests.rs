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

fn object(primitive: &Primitive) -> (&'static str, u32) {
    let names = [
        ["a/a", "a/b", "a/c"],
        ["b/a", "b/b", "b/c"],
        ["c/a", "c/b", "c/c"],
    ];
    let part = |of: u32| (of % 3) as usize;
    let [group, inner] = [primitive.index / 100, primitive.index / 10].map(part);
    (names[group][inner], primitive.index)
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
            let Some(root) = build(builder, &mut order, 0, object) else {
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
        sah::sah_cost(&build(builder, &mut order, 0, object).unwrap())
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

/// The primitives of every node of the modelled tree of objects with these names, one each.
fn modelled(names: &[String]) -> Vec<Vec<u32>> {
    let primitives = chain(names.len());
    let object =
        |primitive: &Primitive| (names[primitive.index as usize].as_str(), primitive.index);
    let mut order = primitives;
    let root = build(Builder::Modelled, &mut order, 0, object).unwrap();
    let mut found = Vec::new();
    collect(&root, &order, &mut found);
    found
}

/// Adds the primitives of a node and of all below it, and returns its own.
fn collect(node: &Node, order: &[Primitive], found: &mut Vec<Vec<u32>>) -> Vec<u32> {
    let own = match node {
        Node::Leaf { first, count, .. } => {
            let leaf = &order[*first..first + count];
            leaf.iter().map(|it| it.index).collect()
        }
        Node::Inner { children, .. } => {
            let [left, right] = [0, 1].map(|child: usize| collect(&children[child], order, found));
            let mut both = [left, right].concat();
            both.sort_unstable();
            both
        }
    };
    found.push(own.clone());
    own
}

#[test]
fn modelled_groups_are_nodes() {
    let names = ["a/x/1", "a/x/2", "a/y", "b", "a/z"].map(String::from);
    let nodes = modelled(&names);
    for group in [vec![0, 1], vec![0, 1, 2], vec![3, 4], vec![0, 1, 2, 3, 4]] {
        assert!(nodes.contains(&group), "{group:?} of {nodes:?}");
    }
}

/// Names have any number of parts, and the program's stack is small.
#[test]
fn names_of_many_parts_are_followed_without_recursion() {
    let deep = "a/".repeat(200_000);
    let nodes = modelled(&[format!("{deep}b"), format!("{deep}c"), String::from("d")]);
    assert!(nodes.contains(&vec![0, 1]));
    // Each in a group of the one before.
    let staircase: Vec<String> = (0..2000)
        .map(|it| format!("{}b", "a/".repeat(it)))
        .collect();
    assert_eq!(modelled(&staircase).last().unwrap().len(), 2000);
}
