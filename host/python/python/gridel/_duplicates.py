"""Faces that a mesh has more than once: which of them are reported, and which of them bound its inside."""

from __future__ import annotations

from collections import Counter
from typing import Optional, Tuple

import numpy as np
from numpy.typing import NDArray


def firsts_of_equal(
    vertices: NDArray[np.float64], faces: NDArray[np.int64]
) -> Optional[Tuple[NDArray[np.int64], NDArray[np.int64]]]:
    """The numbers of faces without those that an earlier face equals in places and winding, and how often each is there.

    None if all differ.
    """
    # A hash of each place, so that most meshes need one sort of numbers; -0.0 is where 0.0 is.
    bits = (vertices + 0.0).view(np.uint64)
    factors = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], dtype=np.uint64)
    places = ((bits ^ (bits >> np.uint64(29))) * factors).sum(axis=1, dtype=np.uint64)
    places = (places ^ (places >> np.uint64(32))) * factors[0]
    hashes = places[faces].sum(axis=1, dtype=np.uint64)
    order = np.argsort(hashes, kind="stable")
    is_same = hashes[order[1:]] == hashes[order[:-1]]
    if not is_same.any():
        return None
    suspects = np.sort(order[np.append(is_same, False) | np.append(False, is_same)])
    # Compared exactly, each from its first place in order, so that the winding stays.
    ranks = _numbers_of_places(vertices, faces[suspects])
    turns = (ranks.argmin(axis=1)[:, None] + np.arange(3)) % 3
    turned = np.take_along_axis(ranks, turns, axis=1)
    _, kept, counts = np.unique(turned, axis=0, return_index=True, return_counts=True)
    copies = np.ones(len(faces), dtype=np.int64)
    copies[suspects] = 0
    copies[suspects[kept]] = counts
    firsts = np.flatnonzero(copies)
    return None if len(firsts) == len(faces) else (firsts, copies[firsts])


def bounding(
    vertices: NDArray[np.float64], faces: NDArray[np.int64], copies: NDArray[np.int64]
) -> Optional[NDArray[np.bool_]]:
    """Which of faces (m, 3) that all differ bound the inside of a mesh that has each of them ``copies`` times.

    A ray crosses a face that is there an odd number of times as if it were there once. One that is there an even number
    of times may count once, as where an exporter wrote it twice, or not at all, as a wall on which two bodies stand. It
    counts such that every edge gets an even number of faces. Of several ways that is one in which many faces count. Where
    there is none, as in open meshes, all count once. None if all count once.
    """
    corners = _numbers_of_places(vertices, faces)
    ends = np.sort(np.stack([corners, np.roll(corners, -1, axis=1)], axis=2), axis=2)
    _, edges = np.unique(ends[..., 0] * (corners.max() + 1) + ends[..., 1], return_inverse=True)
    edges = edges.reshape(-1, 3)
    # A face with a corner twice has no area, and edges of its own.
    has_area = (ends[..., 0] != ends[..., 1]).all(axis=1)
    is_pair = has_area & (copies % 2 == 0)
    is_counted = np.ones(len(faces), dtype=bool)
    if not (np.bincount(edges[has_area].ravel()) % 2).any():
        return None
    by_others = np.bincount(edges[has_area & ~is_pair].ravel(), minlength=edges.max() + 1) % 2
    pairs = edges[is_pair]
    is_counted[is_pair] = _choose(pairs.tolist(), dict(zip(pairs.ravel().tolist(), by_others[pairs].ravel().tolist())))
    return None if is_counted.all() else is_counted


def _numbers_of_places(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> NDArray[np.int64]:
    """The corners of faces as numbers of places, which vertices share that are in the same place."""
    used, corners = np.unique(faces, return_inverse=True)
    _, places = np.unique(vertices[used] + 0.0, axis=0, return_inverse=True)
    return places.reshape(-1)[corners.reshape(faces.shape)]


def _choose(faces: list[list[int]], by_others: dict[int, int]) -> list[bool]:
    """Returns for each face true if it counts, given the edges of each, and the parity of other faces at each edge."""
    at: dict[int, list[int]] = {}
    for face, edges in enumerate(faces):
        for edge in edges:
            at.setdefault(edge, []).append(face)
    counts = [True] * len(faces)
    links = _Links(len(faces))
    is_reached = [False] * len(faces)
    for first in range(len(faces)):
        if is_reached[first]:
            continue
        # Faces that edges connect.
        group, is_reached[first] = [first], True
        for face in group:
            for near in (other for edge in faces[face] for other in at[edge]):
                if not is_reached[near]:
                    is_reached[near] = True
                    group.append(near)
        edges = dict.fromkeys(edge for face in group for edge in faces[face])
        if any((by_others[edge] + len(at[edge])) % 2 for edge in edges):
            for face, value in _solve(group, [(at[edge], by_others[edge]) for edge in edges], links).items():
                counts[face] = value == 1
    return counts


class _Links:
    """Numbers of one bit that are equal to others or differ from them. The last one is 0."""

    def __init__(self, count: int):
        self._parents = list(range(count + 1))
        self._differs = [0] * (count + 1)

    def find(self, number: int) -> Tuple[int, int]:
        """The number that stands for all that are linked, and whether the given one differs from it."""
        path = []
        while self._parents[number] != number:
            path.append(number)
            number = self._parents[number]
        differs = 0
        for each in reversed(path):
            differs ^= self._differs[each]
            self._parents[each], self._differs[each] = number, differs
        return number, differs

    def link(self, one: int, two: int, differs: int) -> bool:
        """Links two numbers. False if they are linked already, otherwise than they should be."""
        (one, flips), (two, flips_two) = self.find(one), self.find(two)
        differs ^= flips ^ flips_two
        if one == two:
            return differs == 0
        self._parents[one], self._differs[one] = two, differs
        return True


def _solve(group: list[int], sums: list[Tuple[list[int], int]], links: _Links) -> dict[int, int]:
    """Bits of faces, of which some have given sums modulo 2, with as many ones as is easily found; {} if there are none.

    Most edges have one or two of the faces, so that few unknown bits are left for elimination.
    """
    for of, total in sums:
        if len(of) <= 2 and not links.link(of[0], of[1] if len(of) == 2 else -1, total):
            return {}
    # More ones than zeros if a bit that stands for others is 1.
    votes: Counter[int] = Counter()
    for face in group:
        root, differs = links.find(face)
        votes[root] += 1 - 2 * differs
    zero, value_of_root = links.find(-1)
    values = {zero: value_of_root}
    unknown = {root: place for place, root in enumerate(root for root in votes if root != zero)}
    rows: dict[int, Tuple[int, int]] = {}
    for of, total in sums:
        if len(of) <= 2:
            continue
        row = 0
        for root, differs in map(links.find, of):
            total ^= differs
            if root == zero:
                total ^= value_of_root
            else:
                row ^= 1 << unknown[root]
        while row and row.bit_length() - 1 in rows:
            other, total_of_other = rows[row.bit_length() - 1]
            row, total = row ^ other, total ^ total_of_other
        if row:
            rows[row.bit_length() - 1] = row, total
        elif total:
            return {}
    # A row's other bits are lower than that which it is for.
    bits = 0
    for root, place in unknown.items():
        if place in rows:
            row, total = rows[place]
            value = total ^ ((row & bits).bit_count() & 1)
        else:
            value = int(votes[root] >= 0)
        bits |= value << place
        values[root] = value
    found = {face: links.find(face) for face in group}
    return {face: values[root] ^ differs for face, (root, differs) in found.items()}
