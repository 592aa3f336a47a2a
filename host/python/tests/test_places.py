"""Hits of meshes that the lattice moved by more than rays pass beside their triangles."""

import numpy as np
import pytest

import gridel

trimesh = pytest.importorskip("trimesh")

RADIUS = 0.005


@pytest.fixture(scope="module")
def small_ball():
    """A ball of a few dozen steps of the lattice, which a wide ground makes coarse; and how many faces the ball has."""
    ball = trimesh.creation.icosphere(3, radius=RADIUS)
    ground = 1000.0 * np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]) - [0, 0, 1]
    vertices = np.vstack([ball.vertices, ground])
    faces = np.vstack([ball.faces, np.array([[0, 1, 2], [0, 2, 3]]) + len(ball.vertices)])
    return trimesh.Trimesh(vertices, faces, process=False), len(ball.faces)


@pytest.fixture(scope="module")
def rays_at_ball():
    origins = np.random.default_rng(0).normal(size=(15_000, 3))
    origins *= 0.02 / np.linalg.norm(origins, axis=1, keepdims=True)
    return np.hstack([origins, np.random.default_rng(1).normal(size=origins.shape) * 0.003 - origins])


def farthest(rays, t, is_on_ball):
    places = rays[is_on_ball, :3] + t[is_on_ball, None] * rays[is_on_ball, 3:]
    return np.linalg.norm(places, axis=1).max()


@pytest.mark.parametrize("format", ["f32", "f64", "fixed"])
def test_hits_stay_at_triangles_that_the_lattice_turned(small_ball, rays_at_ball, format):
    mesh, count = small_ball
    scene = gridel.Scene.from_arrays(mesh.vertices, mesh.faces)
    hits, every = scene.cast(rays_at_ball, format=format), scene.all(rays_at_ball, format=format)
    most = RADIUS + 2 * scene.displacement
    on_ball = hits.primitive < count
    assert on_ball.mean() > 0.7
    assert farthest(rays_at_ball, hits.t, on_ball) < most
    assert farthest(rays_at_ball[every.ray], every.t, every.primitive < count) < most
    for found in (hits, every):
        uv = found.uv[found.primitive != gridel.MISS]
        assert uv.min() >= 0 and uv.sum(axis=1).max() <= 1
    # Computed from the ray and the vertices as given, they depend on no format.
    other = scene.cast(rays_at_ball, format="f64")
    is_same = on_ball & (hits.primitive == other.primitive)
    assert np.array_equal(hits.t[is_same], other.t[is_same])


def test_locations_stay_at_triangles_that_the_lattice_turned(small_ball, rays_at_ball):
    mesh, count = small_ball
    mine = gridel.trimesh.RayMeshIntersector(mesh)
    places, _, triangles = mine.intersects_location(rays_at_ball[:, :3], rays_at_ball[:, 3:])
    on_ball = np.linalg.norm(places[triangles < count], axis=1)
    assert on_ball.max() < RADIUS + 2 * mine.scene.displacement


def test_bounds_are_those_of_the_vertices_as_given(tmp_path):
    vertices = np.random.default_rng(2).normal(size=(60, 3)) * [1, 20, 300] + [1, 2, 3]
    faces = np.arange(60).reshape(20, 3)
    expected = np.array([vertices.min(axis=0), vertices.max(axis=0)])
    around = np.vstack([vertices, [[1e9, 0, np.nan]]])
    assert np.array_equal(gridel.Scene.from_arrays(around, faces).bounds, expected)
    lines = ["v %r %r %r" % tuple(map(float, place)) for place in vertices] + ["f %d %d %d" % tuple(face) for face in faces + 1]
    (tmp_path / "mesh.obj").write_text("\n".join(lines))
    loaded = gridel.Scene.load(tmp_path / "mesh.obj")
    assert np.array_equal(loaded.bounds, expected)
    # Those of a blob are wider, by as much as is documented.
    wide = gridel.Scene.from_blob(loaded.to_blob()).bounds
    most = np.ptp(expected, axis=0).max() * 2.0**-15
    assert (np.abs(wide - expected) < most).all() and not np.array_equal(wide, expected)
    box = "[[object]]\nkind = 'box'\nmin = [0, 0, 0]\nmax = [3, 1, 1]\n"
    (tmp_path / "box.toml").write_text(box)
    assert np.allclose(gridel.Scene.load(tmp_path / "box.toml").bounds, [[0, 0, 0], [3, 1, 1]], atol=3 * 2.0**-15)


def narrow_triangles(rng, height):
    """Triangles of about a length of 1, as narrow as a height."""
    corners = rng.normal(size=(1000, 3, 3))
    along = rng.uniform(size=(1000, 1))
    corners[:, 2] = corners[:, 0] * along + corners[:, 1] * (1 - along) + height * rng.normal(size=(1000, 3))
    return corners


@pytest.mark.filterwarnings("ignore:.*left out")
@pytest.mark.parametrize("format", ["f32", "f64", "fixed"])
@pytest.mark.parametrize("bits", [12, 24])
def test_uv_of_narrow_triangles_are_those_of_the_hit(bits, format):
    rng = np.random.default_rng(bits)
    corners = narrow_triangles(rng, 2.0 ** (2 - bits))
    scene = gridel.Scene.from_arrays(corners.reshape(-1, 3), np.arange(3000).reshape(-1, 3), lattice_bits=bits)
    aimed = corners[rng.integers(1000, size=30_000)]
    targets = (aimed * rng.dirichlet([0.5] * 3, len(aimed))[:, :, None]).sum(axis=1)
    origins = rng.normal(size=targets.shape)
    origins *= 9 / np.linalg.norm(origins, axis=1, keepdims=True)
    rays = np.hstack([origins, targets + scene.displacement * rng.normal(size=targets.shape) - origins])
    for found, of in ((scene.cast(rays, format=format), rays), (scene.all(rays, format=format), None)):
        of = rays[found.ray] if of is None else of
        hit = found.primitive != gridel.MISS
        assert hit.sum() > 3000
        places = of[hit, :3] + found.t[hit, None] * of[hit, 3:]
        u, v = found.uv[hit].astype(float).T
        assert u.min() >= 0 and v.min() >= 0 and (u + v).max() < 1 + 1e-6
        named = (corners[found.primitive[hit]] * np.stack([1 - u - v, u, v], axis=1)[:, :, None]).sum(axis=1)
        assert np.linalg.norm(named - places, axis=1).max() < 4 * scene.displacement
