"""Scenes, formats, structures, errors, threads."""

import threading
import time
from pathlib import Path

import numpy as np
import pytest

import gridel

FIXTURES = Path(__file__).parents[3] / "fixtures"
CUBE = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
FACES = np.array([t for a, b, c, d in QUADS for t in ((a, b, c), (a, c, d))])


@pytest.fixture(scope="module")
def cube():
    return gridel.Scene.from_arrays(CUBE, FACES, accel=["wide", "dual-split", "bvh"])


def test_cube_gives_hits_with_shapes_and_types(cube):
    rays = np.array([[[0.3, 0.6, -2, 0, 0, 2], [5, 5, 5, 0, 0, 1.0]]])
    hits = cube.cast(rays)
    assert hits.t.shape == (1, 2) and hits.t.dtype == np.float64
    assert hits.t[0].tolist() == [1.0, np.inf]
    assert hits.object.tolist() == [[0, gridel.MISS]]
    assert hits.primitive.dtype == np.uint32 and hits.instance[0, 0] == gridel.MISS
    assert hits.normal.shape == (1, 2, 3) and hits.normal[0, 0].tolist() == [0, 0, -1]
    corners = CUBE[FACES[hits.primitive[0, 0]]]
    u, v = hits.uv[0, 0]
    assert np.allclose((1 - u - v) * corners[0] + u * corners[1] + v * corners[2], [0.3, 0.6, 0])


def test_intervals_limit_hits(cube):
    rays = [[0.3, 0.6, -2, 0, 0, 0, 1, 1.9], [0.3, 0.6, -2, 2.5, 0, 0, 1, np.inf]]
    hits = cube.cast(rays)
    assert hits.t.tolist() == [np.inf, 3.0]
    assert cube.any(rays).tolist() == [False, True]
    assert cube.count(rays).tolist() == [0, 1]


@pytest.mark.parametrize("format", ["fixed", "f32", "f64"])
@pytest.mark.parametrize("accel", ["list", "bvh", "dual-split", "wide"])
def test_every_format_and_structure_counts_edges_once(cube, format, accel):
    center = np.full(3, 0.5)
    directions = np.concatenate([CUBE - center, 0.5 * (CUBE[FACES[:, 0]] + CUBE[FACES[:, 1]]) - center])
    rays = np.hstack([center - 7 * directions, directions])
    assert (cube.count(rays, format=format, accel=accel) % 2 == 0).all()
    inner = np.hstack([np.broadcast_to(center, directions.shape), directions])
    assert (cube.count(inner, format=format, accel=accel) == 1).all()
    every = cube.all(inner, format=format, accel=accel)
    assert every.ray.tolist() == list(range(len(inner)))
    assert cube.contains([center, [1.5, 0.5, 0.5]], format=format, accel=accel).tolist() == [True, False]


def test_all_hits_of_stacked_squares_are_listed_once():
    square = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0.0]])
    vertices = np.concatenate([square + [0, 0, height] for height in range(1000)])
    faces = np.concatenate([np.array([[0, 1, 2], [0, 2, 3]]) + 4 * k for k in range(1000)])
    scene = gridel.Scene.from_arrays(vertices, faces)
    every = scene.all([[0, 0, 2000, 0, 0, -1.0]])
    assert np.array_equal(every.t, 2000 - np.arange(999, -1, -1.0))


def test_arrays_are_read_in_place_in_both_types(cube):
    rays = np.array([[0.3, 0.6, -2, 0, 0, 1]])
    for given in (rays, rays.astype(np.float32), rays[::1], np.asfortranarray(np.repeat(rays, 3, 0))):
        assert (cube.cast(given).t == 2.0).all()
    assert cube.cast(np.zeros((0, 6))).t.shape == (0,)
    assert cube.cast([[0, 0, -1, 0, 0, 1]]).t.tolist() == [1.0]


def test_invalid_rays_are_marked(cube):
    rays = [[0, 0, -1, 0, 0, 0.0], [np.nan, 0, -1, 0, 0, 1], [0.5, 0.5, -1, 0, 0, 1]]
    assert np.isnan(cube.cast(rays).t[:2]).all() and cube.cast(rays).t[2] == 1.0
    assert cube.any(rays).tolist() == [False, False, True]
    assert cube.count(rays).tolist() == [0, 0, 2]


def test_errors_are_of_python(cube, tmp_path):
    with pytest.raises(ValueError, match="last axis must be 6 or 8"):
        cube.cast(np.zeros((2, 5)))
    with pytest.raises(TypeError, match="numbers"):
        cube.cast(np.array([["a"] * 6]))
    with pytest.raises(ValueError, match="f16.*fixed, f32 or f64"):
        cube.cast(np.zeros((1, 6)), format="f16")
    with pytest.raises(ValueError, match="unknown structure `octopus`"):
        cube.cast(np.zeros((1, 6)), accel="octopus")
    with pytest.raises(KeyError, match="octree"):
        cube.cast(np.zeros((1, 6)), accel="octree")
    with pytest.raises(ValueError, match="face 0 is .*numbered 0 to 2"):
        gridel.Scene.from_arrays(np.eye(3), [[0, 1, 3]])
    with pytest.raises(ValueError, match="vertex 1 is not finite"):
        gridel.Scene.from_arrays([[0, 0, 0], [np.inf, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    with pytest.raises(TypeError, match="integers"):
        gridel.Scene.from_arrays(np.eye(3), [[0.0, 1, 2]])
    with pytest.raises(ValueError, match="lattice_bits"):
        gridel.Scene.from_arrays(CUBE, FACES, lattice_bits=30)
    with pytest.raises(ValueError, match="blob"):
        gridel.Scene.from_blob(b"no blob")
    with pytest.raises(FileNotFoundError, match="nothing.toml"):
        gridel.Scene.load(tmp_path / "nothing.toml")
    (tmp_path / "bad.toml").write_text("[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = -1\n")
    with pytest.raises(ValueError, match="radius"):
        gridel.Scene.load(tmp_path / "bad.toml")
    with pytest.raises(ValueError, match="closed"):
        gridel.Scene.from_arrays(np.eye(3), [[0, 1, 2]]).contains([[0.0, 0, 0]])


def test_blobs_give_the_same_answers(cube):
    copy = gridel.Scene.from_blob(cube.to_blob())
    assert copy.accels == cube.accels
    rays = np.random.default_rng(1).normal(size=(1000, 6))
    mine, theirs = cube.cast(rays, format="fixed"), copy.cast(rays, format="fixed")
    assert np.array_equal(mine.primitive, theirs.primitive)
    assert len(cube.to_blob(accel="dual-split", lattice_bits=16)) < len(cube.to_blob())
    with pytest.raises(ValueError, match="compiled anew"):
        copy.to_blob(accel="octree")


def test_solids_contain_points(tmp_path):
    text = "".join(
        f"[[object]]\nkind = 'sphere'\ncenter = [{x}, 0, 0]\nradius = 1\n" for x in (0.0, 1.5, 8.0)
    )
    (tmp_path / "balls.toml").write_text(text)
    scene = gridel.Scene.load(tmp_path / "balls.toml", accel="dual-split")
    points = np.random.default_rng(2).uniform([-2, -2, -2], [10, 2, 2], size=(20_000, 3))
    expected = np.zeros(len(points), dtype=bool)
    # Points in two balls at once are inside as well.
    for x in (0.0, 1.5, 8.0):
        expected |= np.linalg.norm(points - [x, 0, 0], axis=1) < 1
    assert np.array_equal(scene.contains(points), expected)


def test_threads_change_nothing_and_the_gil_is_released(cube):
    rng = np.random.default_rng(3)
    rays = np.hstack([rng.uniform(-2, 3, (300_000, 3)), rng.normal(size=(300_000, 3))])
    one, two = cube.cast(rays, threads=1), cube.cast(rays, threads=2)
    for a, b in zip(one, two):
        assert np.array_equal(a, b, equal_nan=True)
    assert np.array_equal(cube.count(rays, threads=1), cube.count(rays))
    started = threading.Event()
    during = []

    def work():
        started.set()
        during.append(time.perf_counter())
        cube.all(np.tile(rays, (4, 1)), threads=1)
        during.append(time.perf_counter())

    thread = threading.Thread(target=work)
    thread.start()
    started.wait()
    ticks = 0
    while thread.is_alive():
        time.sleep(0.001)
        ticks += 1
    assert ticks > 5, "Python stood still while rays were cast"


def test_render_gives_a_picture():
    scene = gridel.Scene.load(FIXTURES / "quick.toml", accel="dual-split")
    picture = scene.render(64, 48, format="fixed")
    assert picture.shape == (48, 64, 3) and picture.dtype == np.uint8 and picture.std() > 10
    with pytest.raises(ValueError, match="both"):
        scene.render(64)


def test_docstring_example_holds():
    import doctest

    assert doctest.testmod(gridel).failed == 0
