"""Rays with many hits, and what they cost."""

import time

import numpy as np
import pytest

import gridel

SQUARE = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0.0]])


def stack(count):
    """Squares above each other."""
    vertices = np.concatenate([SQUARE + [0, 0, height] for height in range(count)])
    return vertices, np.concatenate([np.array([[0, 1, 2], [0, 2, 3]]) + 4 * k for k in range(count)])


def boxes(count):
    """Boxes around each other, as many as a point in the middle is in."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    vertices = np.concatenate([corners * (1 + k) for k in range(count)])
    return vertices, np.concatenate([faces + 8 * k for k in range(count)])


# Around the lengths of the lists in which hits are found, and far behind them.
@pytest.mark.parametrize("count", [15, 16, 17, 63, 64, 65, 1000, 8193])
def test_every_hit_is_listed_once_at_any_number(count):
    scene = gridel.Scene.from_arrays(*stack(count))
    ray = [[0.1, 0.2, 2 * count, 0, 0, -1.0]]
    every = scene.all(ray)
    assert np.allclose(every.t, 2 * count - np.arange(count)[::-1], rtol=1e-12)
    assert np.array_equal(every.primitive // 2, np.arange(count)[::-1])
    for format in ("f32", "f64", "fixed"):
        assert scene.count(ray, format=format).tolist() == [count]


def test_points_in_many_boxes_are_inside_by_parity():
    for count in (17, 256, 257, 600):
        scene = gridel.open3d.RaycastingScene()
        scene.add_triangles(*boxes(count))
        points = [[0.1, 0.2, 0.3], [1.1, 0.2, 0.3]]
        assert scene.compute_occupancy(points).tolist() == [count % 2, (count - 1) % 2]
        # Of boxes that are one object, it is the parity as well.
        assert gridel.Scene.from_arrays(*boxes(count)).contains(points).tolist() == [count % 2, (count - 1) % 2]


def test_time_grows_with_the_hits_and_not_with_their_square():
    rays = np.tile([0.1, 0.2, 1e4, 0, 0, -1.0], (20, 1))

    def seconds(count, query):
        scene = gridel.Scene.from_arrays(*stack(count))
        return min(timed(lambda: query(scene)) for _ in range(3))

    def timed(work):
        begin = time.process_time()
        work()
        return time.process_time() - begin

    for query in (lambda scene: scene.count(rays, threads=1), lambda scene: scene.all(rays, threads=1)):
        # Eight times the hits: 64 times the time by the square.
        assert seconds(4000, query) < 24 * seconds(500, query)


@pytest.mark.parametrize("format", ["fixed", "f32", "f64"])
def test_every_structure_lists_the_same_hits(format):
    structures = ["list", "wide", "bvh", "dual-split", "grid", "octree"]
    scene = gridel.Scene.from_arrays(*boxes(40), accel=structures)
    rng = np.random.default_rng(14)
    rays = np.hstack([rng.uniform(-1, 1, (200, 3)), rng.normal(size=(200, 3))])
    rays[:50, :3] -= 100 * rays[:50, 3:]
    expected = scene.all(rays, format=format, accel="list")
    assert np.bincount(expected.ray).min() > 30
    for accel in structures[1:]:
        found = scene.all(rays, format=format, accel=accel)
        for a, b in zip(found, expected):
            assert np.array_equal(a, b), accel
