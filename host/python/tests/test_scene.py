"""Scenes, formats, structures, errors, threads."""

import copy
import importlib.metadata
import os
import pickle
import subprocess
import sys
import threading
import time
import warnings
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


def test_render_at_another_shape_is_that_of_the_program(tmp_path):
    # A scene without a camera is framed by the shape of the picture.
    text = "[[object]]\nkind = 'box'\nmin = [0, 0, 0]\nmax = [3, 1, 1]\n"
    (tmp_path / "box.toml").write_text(text)
    (tmp_path / "tall.toml").write_text("[render]\nwidth = 20\nheight = 60\n" + text)
    box, tall = (gridel.Scene.load(tmp_path / name) for name in ("box.toml", "tall.toml"))
    assert np.array_equal(box.render(20, 60), tall.render())


def run(code):
    """Runs a program that may hang."""
    head = "import numpy as np, gridel, sys\nsys.path.insert(0, %r)\nfrom test_scene import CUBE, FACES\n"
    program = head % str(Path(__file__).parent) + code
    done = subprocess.run([sys.executable, "-c", program], timeout=60, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_first_contains_of_two_threads_does_not_deadlock():
    run(
        """
import threading
ball = np.random.default_rng(1).normal(size=(3, 3))
for _ in range(20):
    cubes = np.concatenate([CUBE + 2 * k for k in range(2000)])
    faces = np.concatenate([FACES + 8 * k for k in range(2000)])
    scene = gridel.Scene.from_arrays(cubes, faces)
    threads = [threading.Thread(target=scene.contains, args=([[0.5] * 3],)) for _ in range(4)]
    [it.start() for it in threads]
    [it.join() for it in threads]
"""
    )


@pytest.mark.skipif(not hasattr(os, "fork"), reason="the system does not fork")
def test_queries_and_compilation_work_after_fork():
    run(
        """
import os
rays = np.tile([[0.3, 0.6, -2, 0, 0, 1.0]], (10_000, 1))
scene = gridel.Scene.from_arrays(CUBE, FACES)
assert scene.any(rays).all()
child = os.fork()
if child == 0:
    ok = scene.any(rays).all() and scene.any(rays, threads=2).all()
    cubes = np.concatenate([CUBE + 2 * k for k in range(20_000)])
    faces = np.concatenate([FACES + 8 * k for k in range(20_000)])
    ok &= gridel.Scene.from_arrays(cubes, faces).primitives == len(faces)
    ok &= scene.render(64, 48).shape == (48, 64, 3)
    os._exit(0 if ok else 1)
assert os.waitpid(child, 0)[1] == 0
"""
    )


@pytest.mark.parametrize("format", ["fixed", "f32", "f64"])
def test_points_of_nan_and_infinity_are_in_nothing(cube, format):
    points = np.full((5, 3), 0.5)
    points[:4, 1] = [np.nan, np.inf, -np.inf, 1e300]
    assert cube.contains(points, format=format).tolist() == [False] * 4 + [True]
    assert cube.contains(points, closed_only=False, format=format).tolist() == [False] * 4 + [True]


def test_unreferenced_vertices_widen_no_lattice():
    vertices = np.vstack([[[1e9, 1e9, 1e9]], CUBE / 3, [[-1e12, 0, 0]]])
    scene = gridel.Scene.from_arrays(vertices, FACES + 1)
    assert scene.displacement < 1e-7 and np.abs(scene.bounds).max() < 1
    hits = scene.cast([[0.1, 0.2, -2, 0, 0, 1]])
    assert hits.t.tolist() == [2.0]
    corners = vertices[FACES[hits.primitive[0]] + 1]
    u, v = hits.uv[0]
    assert np.allclose((1 - u - v) * corners[0] + u * corners[1] + v * corners[2], [0.1, 0.2, 0])
    around = np.vstack([[[np.nan] * 3], CUBE, [[0, 0, np.inf]]])
    given = around.copy()
    hits = gridel.Scene.from_arrays(around, FACES + 1).cast([[0.1, 0.2, -2, 0, 0, 1]])
    assert np.isfinite(hits.t).all() and np.array_equal(around, given, equal_nan=True)
    with pytest.raises(ValueError, match="vertex 0 is not finite"):
        gridel.Scene.from_arrays(around, FACES)
    empty = gridel.Scene._from_meshes([(CUBE + 1e9, np.zeros((0, 3), int)), (CUBE, FACES)])
    assert empty.displacement < 1e-6 and empty.contains([[0.5] * 3]).all()


def test_collapsed_primitives_are_warned_of_and_count_in_displacement():
    vertices = np.vstack([CUBE, 5000 * CUBE + [10, 0, 0], 1e-5 * CUBE + [5, 0, 0]])
    faces = np.vstack([FACES, FACES + 8, FACES + 16])
    with pytest.warns(UserWarning, match="12 primitives left out: too small for the lattice"):
        scene = gridel.Scene.from_arrays(vertices, faces)
    assert scene.displacement >= 1e-5 and scene.primitives == len(faces)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        gridel.Scene.from_arrays(CUBE, FACES)


@pytest.mark.filterwarnings("ignore:.*left out")
@pytest.mark.parametrize("format", ["fixed", "f32", "f64"])
def test_thin_closed_meshes_are_met_as_flat_ones(format):
    scene = gridel.Scene.from_arrays(CUBE * [1, 1, 1e-9], FACES)
    rays = [[0.3, 0.6, -2, 0, 0, 1], [0.3, 0.6, 2, 0, 0, -1], [3, 0.6, 2, 0, 0, -1]]
    assert np.allclose(scene.cast(rays, format=format).t, [2, 2, np.inf])
    assert scene.any(rays, format=format).tolist() == [True, True, False]
    assert scene.count(rays, format=format).tolist() == [2, 2, 0]
    assert not scene.contains([[0.3, 0.6, 0.5e-9], [0.3, 0.6, 2]], format=format).any()
    assert 0 < scene.displacement < 2e-7
    assert len(scene.to_blob(accel="bvh")) > 0


@pytest.mark.parametrize("format", ["fixed", "f32", "f64"])
@pytest.mark.parametrize("length", [1e-290, 1e290, 1e294, 1e300])
def test_directions_of_extreme_lengths_are_answered(cube, format, length):
    ray = [[0.3, 0.6, -20, 0, 0, length]]
    hits = cube.cast(ray, format=format)
    near = cube.cast([[0.3, 0.6, -20, 0, 0, 1]], format=format)
    assert np.isclose(hits.t[0] * length, near.t[0], rtol=1e-6)
    assert cube.any(ray, format=format).tolist() == [True]
    assert cube.count(ray, format=format).tolist() == [2]


@pytest.mark.parametrize("format", ["fixed", "f32", "f64"])
def test_rays_whose_t_leaves_double_precision_are_invalid_everywhere(cube, format):
    rays = [[0.3, 0.6, -20, 0, 0, 1e-308], [0.3, 0.6, -20, 0, 0, 5e-324], [0.3, 0.6, -2, 0, 0, 1e-300]]
    hits = cube.cast(rays, format=format)
    assert np.isnan(hits.t[:2]).all() and np.isclose(hits.t[2], 2e300)
    assert hits.primitive[:2].tolist() == [gridel.MISS] * 2
    assert cube.any(rays, format=format).tolist() == [False, False, True]
    assert cube.count(rays, format=format).tolist() == [0, 0, 2]
    every = cube.all(rays, format=format)
    assert every.ray.tolist() == [2, 2] and np.isfinite(every.t).all()


@pytest.mark.parametrize("format", ["fixed", "f32", "f64"])
@pytest.mark.parametrize("length", [6e307, 1e308, 1.7e308])
def test_hits_whose_t_is_rounded_to_a_denormal_number_are_kept(cube, format, length):
    rays = [[0.3, 0.6, -2, 0, 0, length]]
    expected = [2 / length, 3 / length]
    assert np.isclose(cube.cast(rays, format=format).t, expected[0], rtol=1e-6, atol=1e-323).all()
    assert cube.any(rays, format=format).tolist() == [True]
    assert cube.count(rays, format=format).tolist() == [2]
    assert np.isclose(cube.all(rays, format=format).t, expected, rtol=1e-6, atol=1e-323).all()


def test_misaligned_arrays_are_copied(cube):
    rays = np.array([[0.3, 0.6, -2, 0, 0, 1]])
    memory = np.zeros(rays.nbytes + 1, dtype=np.uint8)
    memory[1:] = rays.view(np.uint8).ravel()
    misaligned = memory[1:].view(np.float64).reshape(1, 6)
    assert not misaligned.flags.aligned
    assert cube.cast(misaligned).t.tolist() == [2.0]
    assert cube.cast(rays.astype(">f8")).t.tolist() == [2.0]


@pytest.mark.skipif(sys.platform != "linux", reason="counts threads in /proc")
def test_threads_are_at_most_1024_and_no_more_than_chunks(cube):
    rays = np.tile([[0.3, 0.6, -2, 0, 0, 1.0]], (5000, 1))
    before = threads_of_process()
    assert cube.any(rays, threads=1024).all() and threads_of_process() <= before + 8
    for bad in (-1, 1025, 2**70):
        with pytest.raises(ValueError, match=f"threads is {bad}; it must be 0 to 1024"):
            cube.any(rays, threads=bad)
    with pytest.raises(TypeError, match="threads is 'two'"):
        cube.any(rays, threads="two")


def threads_of_process():
    return len(list(Path("/proc/self/task").iterdir()))


def test_blobs_keep_the_bits_of_the_lattice():
    coarse = gridel.Scene.from_arrays(CUBE / 3, FACES, lattice_bits=16)
    again = gridel.Scene.from_arrays(CUBE / 3, FACES, accel="bvh", lattice_bits=16)
    assert coarse.to_blob(accel="bvh") == again.to_blob()
    fine = gridel.Scene.from_arrays(CUBE / 3, FACES, accel="bvh")
    assert coarse.to_blob(accel="bvh", lattice_bits=24) == fine.to_blob()


@pytest.mark.parametrize("scale", [1e-200, 1e-100, 1e100, 1e200])
def test_uv_are_numbers_at_every_scale(scale):
    scene = gridel.Scene.from_arrays(CUBE * scale, FACES)
    hits = scene.cast([[0.3 * scale, 0.6 * scale, -2 * scale, 0, 0, scale]])
    unit = gridel.Scene.from_arrays(CUBE, FACES).cast([[0.3, 0.6, -2, 0, 0, 1]])
    assert np.allclose(hits.t, 2) and np.allclose(hits.uv, unit.uv)


def test_load_says_the_remedy_and_warns(tmp_path):
    (tmp_path / "bad.toml").write_text("[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = -1\n")
    with pytest.raises(ValueError, match=r"bad.toml:4: .*radius.*; \S+"):
        gridel.Scene.load(tmp_path / "bad.toml")
    (tmp_path / "lines.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2\n")
    with pytest.warns(UserWarning, match="lines.obj"):
        scene = gridel.Scene.load(tmp_path / "lines.obj")
    assert scene.primitives == 1


def test_load_gives_the_warnings_of_the_compiler(tmp_path):
    (tmp_path / "in.toml").write_text(
        "[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\n"
        "[[object]]\nname = 'wall'\nkind = 'plane'\npoint = [0, 0, 0]\nnormal = [1, 0, 0]\n"
        "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1e6\n"
        "[[object]]\nkind = 'sphere'\ncenter = [3, 0, 0]\nradius = 1e-3\n"
    )
    with pytest.warns(UserWarning) as warnings:
        gridel.Scene.load(tmp_path / "in.toml")
    said = [str(warning.message) for warning in warnings]
    assert all(sentence.startswith(str(tmp_path / "in.toml: ")) for sentence in said), said
    assert sum("lies in the plane wall" in sentence for sentence in said) == 1
    assert sum("1 primitive too small for the lattice" in sentence for sentence in said) == 1


def test_scenes_pickle_and_copy(cube):
    rays = np.random.default_rng(1).normal(size=(1000, 6))
    coarse = gridel.Scene.from_arrays(CUBE / 3, FACES, accel=["bvh", "wide"], lattice_bits=16)
    for scene in (cube, coarse, gridel.Scene.from_blob(cube.to_blob())):
        assert copy.copy(scene) is scene and copy.deepcopy([scene])[0] is scene
        other = pickle.loads(pickle.dumps(scene))
        assert other.to_blob() == scene.to_blob()
        for one, two in zip(scene.cast(rays), other.cast(rays)):
            assert np.array_equal(one, two, equal_nan=True)


def test_docstring_example_holds():
    import doctest

    assert doctest.testmod(gridel).failed == 0


@pytest.mark.parametrize("format", ["f32", "f64", "fixed"])
@pytest.mark.parametrize("slope", [3e-4, 1e-5, 1e-7])
def test_grazing_rays_get_the_t_of_the_given_vertices(format, slope):
    corners = np.array([[-16, -16, 0], [16, -16, 0], [16, 16, 0], [-16, 16, 0], [0, 0, -16.0]])
    faces = [[0, 1, 2], [0, 2, 3], [0, 4, 1], [1, 4, 2], [2, 4, 3], [3, 4, 0]]
    scene = gridel.Scene.from_arrays(corners, faces)
    assert scene.displacement == 0
    hits = scene.cast([[0.3, 0.1, 3 * slope, 1.0, 0.5, -slope]], format=format)
    assert hits.t[0] == pytest.approx(3, rel=1e-12)
    assert np.isfinite(hits.uv).all()


def test_grazing_hits_stay_at_their_triangle():
    # A far vertex makes the lattice coarse: it moves the small triangle by more than the rays descend above it.
    corners = np.array([[0, 0, 0.3e-3], [1, 0, 0.1e-3], [0, 1, 0.2e-3], [4000, 4000, 4000]])
    scene = gridel.Scene.from_arrays(corners, [[0, 1, 2], [0, 3, 1]], lattice_bits=16)
    direction = np.array([1.0, 0.3, -1e-4])
    heights = np.linspace(-0.2, 0.2, 40001)
    rays = np.array([[*(np.array([0.3, 0.3, z]) - 10 * direction), *direction] for z in heights])
    hits = scene.cast(rays)
    met = hits.primitive == 0
    assert met.sum() > 5
    places = rays[met, :3] + hits.t[met, None] * rays[met, 3:]
    assert (np.abs(places[:, :2] - 0.5) < 0.6).all()
    # Where the rays meet the plane of the given triangle is beside it.
    normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    t = (corners[0] - rays[met, :3]) @ normal / (direction @ normal)
    assert (np.abs(t - hits.t[met]) > 1).all()


@pytest.mark.parametrize("power", [-900, -600, -300, 300, 600, 900])
def test_t_has_double_precision_at_every_length_of_direction(power):
    corners = np.array([[0.1, 0.2, 0.3], [1.7, 0.1, 0.2], [0.3, 1.9, 0.7]])
    scene = gridel.Scene.from_arrays(corners, [[0, 1, 2]])
    origin, direction = np.array([0.5, 0.6, 5.0]), np.array([0.01, -0.02, -1.0])
    t = scene.cast([[*origin, *direction]]).t[0]
    long = scene.cast([[*origin, *(direction * 2.0**power)]]).t[0] * 2.0**power
    assert long == pytest.approx(t, rel=1e-14)
    if abs(power) == 300:
        large = gridel.Scene.from_arrays(corners * 2.0 ** (power / 2), [[0, 1, 2]])
        scaled = np.array([*origin, *direction]) * 2.0 ** (power / 2)
        assert large.cast([scaled]).t[0] == pytest.approx(t, rel=1e-14)


MEMORY = """
import resource, sys
import numpy as np, gridel
scene = gridel.Scene.from_arrays(np.eye(3), [[0, 1, 2]])
rays = np.tile([0.3, 0.3, -2, 0, 0, 1.0], (2000000, 1))
scene.cast(rays[:5000]); scene.all(rays[:5000])
used = int(open("/proc/self/statm").read().split()[0]) * 4096
resource.setrlimit(resource.RLIMIT_AS, (used + {spare} * 1000000,) * 2)
try:
    {call}
except MemoryError:
    sys.exit(7)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="limits memory as Linux does")
@pytest.mark.parametrize(
    "call, spare",
    [
        ("scene.render(40000, 40000, samples=1)", 100),
        ("scene.cast(rays)", 30),
        ("scene.all(rays)", 60),
        ("scene.all(rays)", 100),
    ],
)
def test_results_that_do_not_fit_in_memory_are_an_error(call, spare):
    code = MEMORY.format(call=call, spare=spare)
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert run.returncode == 7, run.stderr


def test_render_is_interrupted():
    # The whole picture would take far longer than the test allows.
    code = (
        "import numpy as np, gridel, os, signal, threading\n"
        # What a shell runs in the background ignores the signal.
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "scene = gridel.Scene.from_arrays(np.eye(3), [[0, 1, 2]])\n"
        "threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()\n"
        "scene.render(1024, 65535, samples=64)\n"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    assert "KeyboardInterrupt" in run.stderr


def test_the_classes_for_other_libraries_need_no_import_of_their_own():
    code = "import gridel; gridel.trimesh.RayMeshIntersector; gridel.open3d.RaycastingScene()"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_meshes_lie_at_up_to_5e8_times_their_size_from_the_origin():
    scene = gridel.Scene.from_arrays(CUBE + 5e8, FACES)
    near = 5e8 + np.array([0.5, 0.5, -2.0])
    assert scene.cast([[*near, 0, 0, 1.0]]).t[0] == 2
    with pytest.raises(ValueError, match="nearer to the origin"):
        gridel.Scene.from_arrays(CUBE + 1e9, FACES)


def test_version_is_that_of_the_package():
    assert gridel.__version__ == importlib.metadata.version("gridel")
