//! The hierarchy of the scene file (the paper, section 2.1: "information supplied by the modelling
//! process"): chains, residues and atoms, or groups and their triangles.

use super::super::hierarchy::Primitive;
use super::tree::Tree;

/// Joins the members of every group, in scene-file order and in balanced halves; then the groups.
pub fn build<'g>(
    primitives: &[Primitive],
    group: impl Fn(&Primitive) -> (Vec<&'g str>, u32),
) -> Tree {
    let mut members: Vec<Member<'g>> = primitives
        .iter()
        .enumerate()
        .map(|(place, primitive)| {
            let (path, number) = group(primitive);
            Member {
                path,
                number,
                place,
            }
        })
        .collect();
    members.sort_by_key(|member| member.number);
    let mut tree = Tree::default();
    tree.root = join_level(&mut tree, primitives, &members, 0);
    tree
}

struct Member<'g> {
    path: Vec<&'g str>,
    /// In scene-file order.
    number: u32,
    place: usize,
}

/// Joins members that share all groups above a level.
fn join_level(
    tree: &mut Tree,
    primitives: &[Primitive],
    members: &[Member<'_>],
    level: usize,
) -> usize {
    if members.iter().all(|member| member.path.len() <= level) {
        let leaves: Vec<usize> = members
            .iter()
            .map(|member| tree.leaf(primitives[member.place].bounds, vec![member.place]))
            .collect();
        return halves(tree, &leaves);
    }
    let groups: Vec<usize> = members
        .chunk_by(|a, b| a.path.get(level) == b.path.get(level))
        .map(|group| join_level(tree, primitives, group, level + 1))
        .collect();
    halves(tree, &groups)
}

fn halves(tree: &mut Tree, nodes: &[usize]) -> usize {
    if let [node] = nodes {
        return *node;
    }
    let (left, right) = nodes.split_at(nodes.len() / 2);
    let children = [halves(tree, left), halves(tree, right)];
    tree.join(children)
}
