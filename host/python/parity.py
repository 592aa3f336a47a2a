"""Counts crossings of closed meshes by whole lines through vertices, edges and faces, in each number format and structure.

python parity.py [--rays N] [--threads N]

Coordinates are integers that the lattice holds exactly, so rays that are aimed at a vertex or an edge meet it exactly.
Every count must be even; prints how many are odd, and how many differ from those of brute force in the same format.
"""

import argparse
import time

import numpy as np
import trimesh

import gridel

STRUCTURES = (
    "list bvh flagged dual-split cylinder-cube cylinder-cube-tight cylinder-cube-entry apex ray-classes slabs "
    "flagged-slabs spheres grid octree wide"
).split()


def mesh(rng):
    """Two bumpy balls, one in the other, of even integers."""
    ball = trimesh.creation.icosphere(subdivisions=2)
    shells = [
        np.rint(ball.vertices * rng.uniform(low, high, size=(len(ball.vertices), 1))).astype(np.int64) * 2
        for low, high in ((3000, 4000), (500, 2500))
    ]
    return np.concatenate(shells), np.concatenate([ball.faces, ball.faces + len(ball.vertices)])


def rays(rng, vertices, faces, count):
    """Lines from outside, a third each to vertices, to the middles of edges and into faces."""
    corners = vertices[faces[rng.integers(len(faces), size=count)]]
    third = count // 3
    targets = corners[:, 0].copy()
    targets[third : 2 * third] = (corners[third : 2 * third, 0] + corners[third : 2 * third, 1]) // 2
    inside = corners[2 * third :]
    targets[2 * third :] = inside[:, 0] + (inside[:, 1] - inside[:, 0] + inside[:, 2] - inside[:, 0]) // 4
    origins = rng.integers(-20_000, 20_000, size=(count, 3))
    # Outside of the box, on a side of it.
    axis = rng.integers(3, size=count)
    origins[np.arange(count), axis] = rng.choice([-12_000, 12_000], size=count)
    # One in four along an axis, through the target.
    along = np.arange(count) % 4 == 0
    kept = origins[np.arange(count), axis]
    origins[along] = targets[along]
    origins[np.arange(count), axis] = kept
    return np.hstack([origins, targets - origins]).astype(np.float64)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rays", type=int, default=1_000_000)
    parser.add_argument("--threads", type=int, default=0)
    given = parser.parse_args()
    rng = np.random.default_rng(4)
    vertices, faces = mesh(rng)
    scene = gridel.Scene.from_arrays(vertices.astype(np.float64), faces, accel=STRUCTURES)
    if scene.displacement != 0.0:
        raise SystemExit(f"the lattice moved vertices by {scene.displacement}")
    chunk = 250_000
    totals = {}
    for start in range(0, given.rays, chunk):
        lines = rays(rng, vertices, faces, min(chunk, given.rays - start))
        for number_format in ("f32", "f64", "fixed"):
            expected = None
            for structure in STRUCTURES:
                began = time.process_time()
                found = scene.count(lines, format=number_format, accel=structure, threads=given.threads)
                if expected is None:
                    expected = found
                total = totals.setdefault((number_format, structure), np.zeros(4))
                total += [len(lines), (found % 2 != 0).sum(), (found != expected).sum(), time.process_time() - began]
    print("| format | structure | rays | odd | other than brute force | seconds |\n|---|---|---|---|---|---|")
    for (number_format, structure), (count, odd, different, seconds) in totals.items():
        print(f"| {number_format} | {structure} | {count:,.0f} | {odd:.0f} | {different:.0f} | {seconds:.0f} |")


if __name__ == "__main__":
    main()
