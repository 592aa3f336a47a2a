//! The hierarchy of the scene file (the paper, section 2.1: "information supplied by the modelling
//! process"): chains, residues and atoms, or groups and their triangles.

use super::tree::Tree;
use crate::compile::hierarchy::node::Primitive;

/// Groups in groups that are followed. The trees of a scene with more are too deep.
const MOST_LEVELS: usize = 128;

/// Joins the members of every group, in scene-file order and in balanced halves; then the groups. The groups of a
/// primitive are the parts of its object's name (`A/CYS 3/CA` is the atom CA of the residue CYS 3 of the chain A).
pub fn build<'g>(primitives: &[Primitive], object: impl Fn(&Primitive) -> (&'g str, u32)) -> Tree {
    let mut members: Vec<Member<'g>> = primitives
        .iter()
        .enumerate()
        .map(|(place, primitive)| {
            let (name, number) = object(primitive);
            Member {
                name,
                number,
                place,
            }
        })
        .collect();
    members.sort_by_key(|member| member.number);
    let mut tree = Tree::default();
    let objects = members.chunk_by(|a, b| a.name == b.name);
    let mut groups: Vec<Group<'g>> = objects
        .map(|members| {
            let leaf = |member: &Member<'_>| {
                tree.leaf(primitives[member.place].bounds, vec![member.place])
            };
            let leaves: Vec<usize> = members.iter().map(leaf).collect();
            Group {
                below: Some(members[0].name),
                node: halves(&mut tree, &leaves),
            }
        })
        .collect();
    tree.root = join(&mut tree, &mut groups, MOST_LEVELS);
    tree
}

struct Member<'g> {
    name: &'g str,
    /// In scene-file order.
    number: u32,
    place: usize,
}

/// Members that are joined already.
struct Group<'g> {
    /// The names of the groups that were not compared yet.
    below: Option<&'g str>,
    node: usize,
}

impl<'g> Group<'g> {
    fn name(&self) -> Option<&'g str> {
        self.below.and_then(|names| names.split('/').next())
    }

    fn descend(&mut self) {
        let rest = self.below.and_then(|names| names.split_once('/'));
        self.below = rest.map(|(_, names)| names);
    }
}

/// Joins groups that lie in the same ones so far.
fn join(tree: &mut Tree, groups: &mut [Group<'_>], levels: usize) -> usize {
    // A loop as long as there is one group, because names can have any number of parts.
    while groups.iter().any(|it| it.below.is_some()) {
        let alike = groups
            .windows(2)
            .all(|pair| pair[0].name() == pair[1].name());
        if !alike {
            break;
        }
        groups.iter_mut().for_each(Group::descend);
    }
    let mut nodes = Vec::with_capacity(groups.len());
    for group in groups.chunk_by_mut(|a, b| a.name() == b.name()) {
        if group.len() == 1 || levels == 0 {
            nodes.extend(group.iter().map(|it| it.node));
        } else {
            nodes.push(join(tree, group, levels - 1));
        }
    }
    halves(tree, &nodes)
}

fn halves(tree: &mut Tree, nodes: &[usize]) -> usize {
    if let [node] = nodes {
        return *node;
    }
    let (left, right) = nodes.split_at(nodes.len() / 2);
    let children = [halves(tree, left), halves(tree, right)];
    tree.join(children)
}
