//! Finds generalised strips in a mesh: up to 6 triangles on 8 vertices, each on three in a row.
//!
//! Greedy: the triangle with the fewest free neighbors goes first, along a path through it that zigzags over free
//! triangles. Among these paths the builder chooses the one whose box is smallest for the square of its number of
//! triangles. This spares rays one strip in twelve that they would test if it always chose the longest path. The bytes
//! come back where short strips are joined, first the two that make the smallest box. Places between them hold no
//! triangle.

use super::hull::Hull;
use gridel_core::format::cluster::{LANES, STRIP_TRIANGLES, StripMembers};
use gridel_core::format::record::UnitBox;
use heapless::Vec as Few;
use rayon::prelude::*;

/// A strip: its vertices, and its triangles by place. There are very many, so none allocates.
#[derive(Clone, Debug)]
pub struct Strip {
    pub vertices: Few<u32, LANES>,
    /// Triangles at their places.
    pub triangles: Few<Option<u32>, STRIP_TRIANGLES>,
    pub bounds: Hull,
}

/// No triangle, as a neighbor.
const NOBODY: u32 = u32::MAX;
/// Strips that are considered for a join with one, in the order of their places in space.
const REACH: usize = 48;
/// The highest cost of a joined box, the sum of the two being 1. A join saves one strip, and one child of a node. The
/// limit is higher than a ray's time alone would allow, because of these bytes.
const JOINED_COST: f64 = 3.0;

/// Finds strips that hold every triangle once.
pub fn find(vertices: &[[i32; 3]], triangles: &[[u32; 3]]) -> Vec<Strip> {
    let point = |&vertex: &[i32; 3]| UnitBox::around(vertex, vertex).into();
    let mesh = Mesh {
        vertices: vertices.iter().map(point).collect(),
        triangles,
        neighbors: neighbors(vertices.len(), triangles),
    };
    join(mesh.strips())
}

impl Strip {
    /// Returns the arrangement of the corners at every place, as a blob writes it.
    pub fn arrangements(&self, triangles: &[[u32; 3]]) -> [Option<u32>; STRIP_TRIANGLES] {
        let mut arrangements = [None; STRIP_TRIANGLES];
        for (place, triangle) in self.triangles.iter().enumerate() {
            let Some(triangle) = triangle else { continue };
            let corners = triangles[*triangle as usize];
            let number = StripMembers::ARRANGEMENTS
                .iter()
                .position(|it| it.map(|vertex| self.vertices[place + vertex]) == corners);
            arrangements[place] = number.map(|number| number as u32);
        }
        arrangements
    }
}

struct Mesh<'m> {
    /// The box of each vertex.
    vertices: Vec<Hull>,
    triangles: &'m [[u32; 3]],
    /// For each triangle, the neighbor over the edge opposite to each corner.
    neighbors: Vec<[u32; 3]>,
}

/// Pairs triangles over their edges; where more than two meet, in the order of their numbers.
fn neighbors(vertices: usize, triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let edges = || {
        (0..).zip(triangles).flat_map(|(triangle, corners)| {
            [0, 1, 2].map(|corner: usize| {
                let (a, b) = (corners[(corner + 1) % 3], corners[(corner + 2) % 3]);
                (a.min(b) as usize, a.max(b), triangle << 2 | corner as u32)
            })
        })
    };
    // The edges of each lower vertex side by side.
    let mut ends = vec![0; vertices];
    for (low, ..) in edges() {
        ends[low] += 1;
    }
    let mut sum = 0;
    for end in &mut ends {
        sum += *end;
        *end = sum - *end;
    }
    let mut sides = vec![(0, 0); sum];
    for (low, high, side) in edges() {
        sides[ends[low]] = (high, side);
        ends[low] += 1;
    }
    let mut neighbors = vec![[NOBODY; 3]; triangles.len()];
    let mut first = 0;
    for end in ends {
        let edges = &mut sides[first..end];
        first = end;
        edges.sort_unstable();
        let mut rest = &*edges;
        while let [(high, one), tail @ ..] = rest {
            rest = tail;
            if let [(same, other), tail @ ..] = tail
                && same == high
                && one >> 2 != other >> 2
            {
                neighbors[(one >> 2) as usize][(one & 3) as usize] = other >> 2;
                neighbors[(other >> 2) as usize][(other & 3) as usize] = one >> 2;
                rest = tail;
            }
        }
    }
    neighbors
}

/// A path through free triangles. Each shares an edge with the one before.
#[derive(Clone, Copy)]
struct Path {
    vertices: [u32; LANES],
    triangles: [u32; STRIP_TRIANGLES],
    count: usize,
}

impl Mesh<'_> {
    fn strips(&self) -> Vec<Strip> {
        let mut free = vec![true; self.triangles.len()];
        let degree = |triangle: u32, free: &[bool]| {
            let neighbors = self.neighbors[triangle as usize].iter();
            let free = neighbors.filter(|&&it| it != NOBODY && free[it as usize]);
            free.count()
        };
        // By the number of free neighbors; the last entry comes first. Entries may be out of date.
        let mut waiting: [Vec<u32>; 4] = Default::default();
        for triangle in (0..self.triangles.len() as u32).rev() {
            waiting[degree(triangle, &free)].push(triangle);
        }
        let mut strips = Vec::with_capacity(self.triangles.len() / 4);
        let fewest = |waiting: &mut [Vec<u32>; 4]| {
            (0..4).find_map(|known| Some((known, waiting[known].pop()?)))
        };
        while let Some((known, triangle)) = fewest(&mut waiting) {
            if !free[triangle as usize] || degree(triangle, &free) != known {
                continue;
            }
            let strip = self.best_through(triangle, &free);
            let members = || strip.triangles.iter().flatten().copied();
            for member in members() {
                free[member as usize] = false;
            }
            for member in members() {
                for &neighbor in &self.neighbors[member as usize] {
                    if neighbor != NOBODY && free[neighbor as usize] {
                        waiting[degree(neighbor, &free)].push(neighbor);
                    }
                }
            }
            strips.push(strip);
        }
        strips
    }

    /// The best strip of free triangles through one of them.
    fn best_through(&self, triangle: u32, free: &[bool]) -> Strip {
        let [a, b, c] = self.triangles[triangle as usize];
        let mut best: Option<(usize, i64, Path, Hull)> = None;
        // A zigzag backwards is another of the six.
        for vertices in [[a, b, c], [b, c, a], [c, a, b]] {
            let ahead = self.zigzag(triangle, vertices, free);
            let [first, second, third] = vertices;
            let behind = self.zigzag(triangle, [third, second, first], free);
            for back in 0..behind.count {
                let Some(path) = Path::through(&behind, back, &ahead) else {
                    continue;
                };
                let bounds = self.bounds(&path.vertices[..path.count + 2]);
                let cost = bounds.area();
                let better = best.as_ref().is_none_or(|(count, least, ..)| {
                    let square = |count: usize| (count * count) as i64;
                    let (here, there) = (cost * square(*count), least * square(path.count));
                    here < there || here == there && path.count > *count
                });
                if better {
                    best = Some((path.count, cost, path, bounds));
                }
            }
        }
        let (count, _, path, bounds) = best.expect("a triangle is a strip");
        Strip {
            vertices: path.vertices[..count + 2].iter().copied().collect(),
            triangles: path.triangles[..count].iter().copied().map(Some).collect(),
            bounds,
        }
    }

    /// Continues from a triangle over the edge of its last two vertices, as far as triangles are free.
    fn zigzag(&self, start: u32, corners: [u32; 3], free: &[bool]) -> Path {
        let mut path = Path {
            vertices: [0; LANES],
            triangles: [NOBODY; STRIP_TRIANGLES],
            count: 1,
        };
        path.vertices[..3].copy_from_slice(&corners);
        path.triangles[0] = start;
        while path.count < STRIP_TRIANGLES {
            let last = path.triangles[path.count - 1] as usize;
            let left_behind = path.vertices[path.count - 1];
            let corners = self.triangles[last];
            let Some(corner) = corners.iter().position(|&it| it == left_behind) else {
                break;
            };
            let next = self.neighbors[last][corner];
            let taken = &path.triangles[..path.count];
            if next == NOBODY || !free[next as usize] || taken.contains(&next) {
                break;
            }
            let edge = [path.vertices[path.count], path.vertices[path.count + 1]];
            let fresh = self.triangles[next as usize];
            let Some(&fresh) = fresh.iter().find(|it| !edge.contains(it)) else {
                break;
            };
            path.triangles[path.count] = next;
            path.vertices[path.count + 2] = fresh;
            path.count += 1;
        }
        path
    }

    fn bounds(&self, vertices: &[u32]) -> Hull {
        let first = self.vertices[vertices[0] as usize];
        vertices[1..].iter().fold(first, |all, &vertex| {
            all.union(&self.vertices[vertex as usize])
        })
    }
}

impl Path {
    /// Returns the path that starts `back` triangles behind a start and continues ahead as far as it fits. `None` if it
    /// crosses a triangle twice.
    fn through(behind: &Path, back: usize, ahead: &Path) -> Option<Path> {
        let count = (back + ahead.count).min(STRIP_TRIANGLES);
        let mut path = *ahead;
        path.count = count;
        for place in 0..back {
            path.triangles[place] = behind.triangles[back - place];
            path.vertices[place] = behind.vertices[back + 2 - place];
        }
        let forward = count - back;
        path.triangles[back..count].copy_from_slice(&ahead.triangles[..forward]);
        path.vertices[back..count + 2].copy_from_slice(&ahead.vertices[..forward + 2]);
        let (before, after) = path.triangles[..count].split_at(back);
        (!before.iter().any(|it| after.contains(it))).then_some(path)
    }
}

/// Joins short strips that lie side by side.
fn join(strips: Vec<Strip>) -> Vec<Strip> {
    // Two of 3 vertices each are the shortest, so one of 6 or more has no room.
    let (mut short, mut done): (Vec<_>, Vec<_>) = strips
        .into_iter()
        .partition(|strip| strip.vertices.len() <= LANES - 2);
    short.par_sort_by_cached_key(|strip| (morton(&strip.bounds), strip.triangles[0]));
    let mut short: Vec<Option<Strip>> = short.into_iter().map(Some).collect();
    for index in 0..short.len() {
        while let Some(strip) = &short[index] {
            let cost = strip.bounds.area();
            let others = short.iter().enumerate().skip(index + 1).take(REACH);
            let best = others
                .filter_map(|(place, other)| {
                    let other = other.as_ref()?;
                    let alone = (cost + other.bounds.area()).max(1) as f64;
                    let ratio = strip.bounds.union(&other.bounds).area() as f64 / alone;
                    if ratio > JOINED_COST {
                        return None;
                    }
                    Some((ratio, place, strip.and(other)?))
                })
                .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let Some((_, place, joined)) = best else {
                break;
            };
            short[place] = None;
            short[index] = Some(joined);
        }
    }
    done.extend(short.into_iter().flatten());
    done
}

impl Strip {
    /// Returns both strips as one, if it has room for them. They join end to end, over a vertex or an edge that their
    /// ends share.
    fn and(&self, other: &Strip) -> Option<Strip> {
        let turns = [(false, false), (false, true), (true, false), (true, true)];
        let joints = turns.into_iter().map(|(turn, turn_other)| {
            let (_, end) = self.ends(turn);
            let (start, _) = other.ends(turn_other);
            (usize::from(end == start), turn, turn_other)
        });
        let (shared, turn, turn_other) = joints.max_by_key(|joint| joint.0)?;
        let gap = 2 - shared;
        if self.vertices.len() + other.vertices.len() - shared > LANES {
            return None;
        }
        let (mut front, back) = (self.turned(turn), other.turned(turn_other));
        front
            .vertices
            .extend(back.vertices[shared..].iter().copied());
        front.triangles.extend(std::iter::repeat_n(None, gap));
        front.triangles.extend(back.triangles.iter().copied());
        front.bounds = front.bounds.union(&back.bounds);
        Some(front)
    }

    /// The first and the last vertex, the other way round where the strip is turned.
    fn ends(&self, turn: bool) -> (Option<&u32>, Option<&u32>) {
        let (first, last) = (self.vertices.first(), self.vertices.last());
        if turn { (last, first) } else { (first, last) }
    }

    fn turned(&self, turn: bool) -> Strip {
        let mut strip = self.clone();
        if turn {
            strip.vertices.reverse();
            strip.triangles.reverse();
        }
        strip
    }
}

/// The place of a box's middle along a curve that keeps neighbors together.
fn morton(bounds: &Hull) -> u64 {
    let spread = |axis: usize| {
        let mut bits = (bounds.middle(axis) + (1 << 16)) as u64 & 0x1_ffff;
        for shift in [16, 8, 4, 2] {
            let mask = match shift {
                16 => 0x001f_0000_0000_ffff,
                8 => 0x001f_0000_ff00_00ff,
                4 => 0x100f_00f0_0f00_f00f,
                _ => 0x10c3_0c30_c30c_30c3,
            };
            bits = (bits | bits << (2 * shift)) & mask;
        }
        (bits | bits << 2) & 0x1249_2492_4924_9249
    };
    spread(0) | spread(1) << 1 | spread(2) << 2
}
