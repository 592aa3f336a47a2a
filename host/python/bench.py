"""Compares this package with trimesh with embreex and with Open3D: the same rays, one thread each,
in turns. Seconds are those of the processor, so that other programs count little.

python bench.py MESH [--rays N] [--repeats N]

Prints tables for host/docs/PYTHON.md: millions of rays or points per second, the median of the repeats, and wrong
answers of `contains_points` at several scales.
"""

import argparse
import statistics
import time

import numpy as np
import trimesh
from trimesh.ray.ray_pyembree import RayMeshIntersector as Embree

import gridel.trimesh
from gridel.open3d import RaycastingScene

try:
    import open3d
except ImportError:
    open3d = None


def coherent(mesh, count):
    """Rays of a camera in front of the mesh, row by row."""
    side = int(count**0.5)
    middle, size = mesh.bounds.mean(axis=0), mesh.extents.max()
    x, y = np.meshgrid(np.linspace(-0.6, 0.6, side), np.linspace(-0.6, 0.6, side))
    origins = np.tile(middle + [0, 0, 2 * size], (side * side, 1))
    targets = middle + size * np.stack([x.ravel(), y.ravel(), np.zeros(side * side)], axis=1)
    return origins, targets - origins


def bounced(mesh, rays):
    """From where rays hit, in random directions away from the surface."""
    places, _, triangles = gridel.trimesh.RayMeshIntersector(mesh).intersects_location(*rays, multiple_hits=False)
    normals = mesh.face_normals[triangles]
    directions = np.random.default_rng(1).normal(size=normals.shape)
    directions *= np.sign((directions * normals).sum(axis=1))[:, None]
    places = np.concatenate([places] * (len(rays[0]) // len(places) + 1))[: len(rays[0])]
    directions = np.concatenate([directions] * (len(rays[0]) // len(directions) + 1))[: len(rays[0])]
    return places + 1e-4 * mesh.scale * directions / np.linalg.norm(directions, axis=1)[:, None], directions


def race(contenders, count, repeats):
    """Millions per second of each contender, which take turns."""
    seconds = {name: [] for name in contenders}
    for _ in range(repeats):
        for name, work in contenders.items():
            started = time.process_time()
            work()
            seconds[name].append(time.process_time() - started)
    return {name: count / statistics.median(times) / 1e6 for name, times in seconds.items()}


def rates(mesh, count, repeats):
    mine, embree = gridel.trimesh.RayMeshIntersector(mesh, threads=1), Embree(mesh)
    scene = RaycastingScene()
    scene.add_triangles(mesh.vertices, mesh.faces)
    peer = None
    if open3d:
        peer = open3d.t.geometry.RaycastingScene(nthreads=1)
        peer.add_triangles(
            open3d.core.Tensor(mesh.vertices.astype(np.float32)), open3d.core.Tensor(mesh.faces.astype(np.uint32))
        )
    first = coherent(mesh, count)
    print("| query | rays | gridel | trimesh, embreex | Open3D |")
    print("|---|---|---|---|---|")
    for kind, (origins, directions) in (("coherent", first), ("bounced", bounced(mesh, first))):
        joined = np.hstack([origins, directions]).astype(np.float32)
        tensor = open3d.core.Tensor(joined) if open3d else joined

        def row(query, own, of_trimesh=None, of_open3d=None):
            contenders = {"gridel": own, "trimesh": of_trimesh, "Open3D": peer and of_open3d}
            found = race({name: it for name, it in contenders.items() if it}, len(origins), repeats)
            cells = [f"{found[name]:.2f}" if name in found else "-" for name in contenders]
            print(f"| `{query}` | {kind} | {' | '.join(cells)} |", flush=True)

        for name in ("intersects_first", "intersects_any"):
            row(
                name,
                lambda: getattr(mine, name)(origins, directions),
                lambda: getattr(embree, name)(origins, directions),
            )
        for multiple in (False, True):
            row(
                f"intersects_location(multiple_hits={multiple})",
                lambda: mine.intersects_location(origins, directions, multiple),
                lambda: embree.intersects_location(origins, directions, multiple),
            )
        for name in ("cast_rays", "test_occlusions", "count_intersections", "list_intersections"):
            row(
                name,
                lambda: getattr(scene, name)(joined, nthreads=1),
                None,
                lambda: getattr(peer, name)(tensor, nthreads=1),
            )
    points = np.random.default_rng(2).uniform(*mesh.bounds, size=(count // 5, 3))
    found = race(
        {"gridel": lambda: mine.contains_points(points), "trimesh": lambda: embree.contains_points(points)},
        len(points),
        repeats,
    )
    occupancy = "-"
    if peer:
        single = points.astype(np.float32)
        work = {"Open3D": lambda: peer.compute_occupancy(open3d.core.Tensor(single), nthreads=1)}
        occupancy = f"{race(work, len(points), repeats)['Open3D']:.2f}"
    print(f"| `contains_points` | points in the box | {found['gridel']:.2f} | {found['trimesh']:.2f} | {occupancy} |")


def many_hits(repeats):
    """Rays and points inside of boxes around each other, which come in no order: ms per ray."""
    box = trimesh.creation.box()
    print("\n| query | hits per ray | gridel | trimesh, embreex | Open3D |")
    print("|---|---|---|---|---|")
    for count in (100, 1000, 4000):
        vertices = np.concatenate([box.vertices * (1 + 1e-3 * k) for k in range(count)])
        faces = np.concatenate([box.faces + 8 * k for k in range(count)])
        mesh = trimesh.Trimesh(vertices, faces, process=False)
        points = np.random.default_rng(4).uniform(-0.4, 0.4, (200, 3))
        directions = np.tile([0.3, 0.5, 1.0], (200, 1))
        rays = np.hstack([points, directions]).astype(np.float32)
        mine, embree = gridel.trimesh.RayMeshIntersector(mesh, threads=1), Embree(mesh)
        scenes = [RaycastingScene()] + ([open3d.t.geometry.RaycastingScene(nthreads=1)] if open3d else [])
        for scene in scenes:
            scene.add_triangles(vertices.astype(np.float32), faces.astype(np.uint32))
            scene.cast_rays(rays[:1])
        of_scenes = dict(zip(("gridel", "Open3D"), scenes))
        queries = {
            "intersects_id": [lambda it: it.intersects_id(points, directions, max_hits=2 * count), None],
            "intersects_id(max_hits=1)": [lambda it: it.intersects_id(points, directions, max_hits=1), None],
            "contains_points": [lambda it: it.contains_points(points), None],
            "count_intersections": [None, lambda it: it.count_intersections(rays, nthreads=1)],
            "list_intersections": [None, lambda it: it.list_intersections(rays, nthreads=1)],
        }
        for name, (of_trimesh, of_open3d) in queries.items():
            peers = {"gridel": mine, "trimesh": embree} if of_trimesh else of_scenes
            work = {peer: (lambda it=it: (of_trimesh or of_open3d)(it)) for peer, it in peers.items()}
            found = race(work, len(points), repeats)
            cells = [f"{1e-3 / found[peer]:.3f}" if peer in found else "-" for peer in ("gridel", "trimesh", "Open3D")]
            print(f"| `{name}` | {count:,} | {' | '.join(cells)} |", flush=True)


def accuracy():
    ball = trimesh.creation.icosphere(subdivisions=4)
    rng = np.random.default_rng(3)
    print("\n| scale | moved by | distance over scale | points | gridel | trimesh, embreex | Open3D |")
    print("|---|---|---|---|---|---|---|")
    for scale, offset in [(1e-6, 0), (1e-3, 0), (1, 0), (1e7, 0), (1, 1e7)]:
        mesh = trimesh.Trimesh(ball.vertices * scale + offset, ball.faces, process=False)
        corners = mesh.triangles[rng.integers(len(mesh.faces), size=10_000)]
        weights = rng.dirichlet(np.ones(3), size=len(corners))
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        mine = gridel.trimesh.RayMeshIntersector(mesh)
        depth = 1.1 * mine.scene.displacement + 4e-16 * offset
        surface = (corners * weights[:, :, None]).sum(axis=1)
        points = np.concatenate([surface - depth * normals, surface + depth * normals])
        truth = np.arange(len(points)) < len(surface)
        wrong = [(mine.contains_points(points) != truth).sum(), (Embree(mesh).contains_points(points) != truth).sum()]
        if open3d:
            peer = open3d.t.geometry.RaycastingScene()
            peer.add_triangles(
                open3d.core.Tensor(mesh.vertices.astype(np.float32)), open3d.core.Tensor(mesh.faces.astype(np.uint32))
            )
            inside = peer.compute_occupancy(open3d.core.Tensor(points.astype(np.float32))).numpy() > 0.5
            wrong.append((inside != truth).sum())
        cells = " | ".join(f"{it:,}" for it in wrong)
        print(f"| {scale:g} | {offset:g} | {depth / scale:.1e} | {len(points):,} | {cells} |", flush=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("mesh")
    parser.add_argument("--rays", type=int, default=1_000_000)
    parser.add_argument("--repeats", type=int, default=5)
    given = parser.parse_args()
    loaded = trimesh.load(given.mesh, force="mesh")
    print(f"{len(loaded.faces):,} triangles, {given.rays:,} rays, one thread\n")
    rates(loaded, given.rays, given.repeats)
    many_hits(given.repeats)
    accuracy()
