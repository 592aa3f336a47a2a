"""tmin and tmax hold for the t that is returned; t, uv and normals are those of the vertices as given."""

from pathlib import Path

import numpy as np
import pytest
from test_scene import cube  # noqa: F401

import gridel

FIXTURES = Path(__file__).parents[3] / "fixtures"
FORMATS = pytest.mark.parametrize("format", ["fixed", "f32", "f64"])


def sphere(count=40):
    """A ball whose vertices are not on the lattice."""
    theta, phi = np.meshgrid(np.linspace(0.01, np.pi - 0.01, count), np.linspace(0, 2 * np.pi, count, endpoint=False))
    x, y, z = np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)
    vertices = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    at = np.arange(count * count).reshape(count, count)
    a, b = at[:, :-1], at[:, 1:]
    c, d = np.roll(a, -1, axis=0), np.roll(b, -1, axis=0)
    faces = [np.stack(it, axis=-1).reshape(-1, 3) for it in ((a, b, c), (c, b, d))]
    # Caps, at the rings nearest to the poles.
    first, last = at[:, 0], at[:, -1]
    poles = [np.full(count, len(vertices)), np.full(count, len(vertices) + 1)]
    faces.append(np.stack([poles[0], first, np.roll(first, -1)], axis=-1))
    faces.append(np.stack([np.roll(last, -1), last, poles[1]], axis=-1))
    return np.vstack([vertices, [[0, 0, 1], [0, 0, -1]]]), np.concatenate(faces)


@pytest.fixture(scope="module")
def ball():
    return gridel.Scene.from_arrays(*sphere())


@pytest.fixture(scope="module")
def rays():
    rng = np.random.default_rng(11)
    origins = rng.normal(size=(4000, 3))
    origins *= 3 / np.linalg.norm(origins, axis=1, keepdims=True)
    return np.hstack([origins, rng.uniform(-0.6, 0.6, (4000, 3)) - origins])


def limited(rays, tmin, tmax):
    columns = [np.broadcast_to(limit, len(rays)) for limit in (tmin, tmax)]
    return np.column_stack([rays[:, :3], columns[0], rays[:, 3:], columns[1]])


@FORMATS
def test_hits_at_the_limits_count_and_those_beyond_do_not(ball, rays, format):
    first = ball.cast(rays, format=format)
    hit = np.isfinite(first.t)
    rays, t, primitive = rays[hit], first.t[hit], first.primitive[hit]
    assert hit.mean() > 0.9
    for tmin, tmax in [(0, t), (t, np.inf), (t, t)]:
        at = limited(rays, tmin, tmax)
        assert ball.any(at, format=format).all()
        found = ball.cast(at, format=format)
        assert np.array_equal(found.t, t) and (found.primitive == primitive).mean() > 0.999
    below = limited(rays, 0, np.nextafter(t, 0))
    assert not ball.any(below, format=format).any() and not ball.count(below, format=format).any()
    assert np.isinf(ball.cast(below, format=format).t).all()
    # Behind the first hit the ray meets the other side, once.
    behind = limited(rays, np.nextafter(t, np.inf), np.inf)
    found = ball.cast(behind, format=format)
    assert (found.t > t).all() and np.isfinite(found.t).all() and (found.primitive != primitive).all()
    assert (ball.count(behind, format=format) == 1).all()
    assert np.allclose(ball.all(behind, format=format).t, found.t, rtol=1e-12)


@FORMATS
def test_all_count_and_any_agree_at_limits(ball, rays, format):
    t = ball.cast(rays, format=format).t
    t = np.where(np.isfinite(t), t, 1.0)
    rng = np.random.default_rng(12)
    # About as far from the surface as the lattice moved it.
    near = limited(rays, t + rng.normal(size=len(t)) * 1e-7, t + 1e-6 + rng.normal(size=len(t)) * 1e-7)
    counts, every = ball.count(near, format=format), ball.all(near, format=format)
    assert np.array_equal(counts, np.bincount(every.ray, minlength=len(near)))
    assert (every.t >= near[every.ray, 3]).all() and (every.t <= near[every.ray, 7]).all()
    hit = np.isfinite(ball.cast(near, format=format).t)
    assert np.array_equal(hit, ball.any(near, format=format)) and np.array_equal(hit, counts > 0)
    assert 0.2 < hit.mean() < 0.8


def test_invalid_and_endless_limits_stay_what_they_are(ball):
    ray = [[0.1, 0.2, 5, 0, 0, -1]]
    given = [(6, 5), (np.nan, 9), (0, np.nan), (-np.inf, np.inf), (0, np.inf), (-1, 1e300), (np.inf, np.inf)]
    hits = [ball.cast(limited(np.array(ray), *it)).t[0] for it in given]
    assert np.isnan(hits[:3]).all() and np.allclose(hits[3:6], hits[4]) and np.isinf(hits[6])
    assert ball.cast(ray).t[0] == hits[4]


def test_blobs_have_limits_of_their_own_t(ball, rays):
    blob = gridel.Scene.from_blob(ball.to_blob())
    t = blob.cast(rays, format="f64").t
    found = blob.cast(limited(rays, 0, 2.0), format="f64").t
    assert np.array_equal(np.isfinite(found), t <= 2.0)


@pytest.mark.filterwarnings("ignore:.*left out")
@FORMATS
def test_normals_are_those_of_the_vertices_as_given(format):
    vertices, faces = sphere()
    # A floor by which the lattice is coarse: it turns small triangles by degrees.
    floor = 1e5 * np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0.0]]) - [0, 0, 2]
    scene = gridel.Scene.from_arrays(np.vstack([vertices, floor]), np.vstack([faces, np.array([[0, 1, 2], [0, 2, 3]]) + len(vertices)]))
    corners = vertices[faces]
    expected = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    expected /= np.linalg.norm(expected, axis=1, keepdims=True)
    middles = corners.mean(axis=1)
    rays = np.hstack([middles * 1.5, -middles])
    hits, every = scene.cast(rays, format=format), scene.all(rays, format=format)
    on_ball = hits.primitive < len(faces)
    assert on_ball.mean() > 0.9
    assert np.abs(hits.normal - expected[np.minimum(hits.primitive, len(faces) - 1)])[on_ball].max() < 1e-6
    kept = every.primitive < len(faces)
    assert np.abs(every.normal[kept] - expected[every.primitive[kept]]).max() < 1e-6
    other = gridel.open3d.RaycastingScene()
    other.add_triangles(vertices, faces)
    other.add_triangles(floor, [[0, 1, 2], [0, 2, 3]])
    found = other.cast_rays(rays)
    on_ball = found["geometry_ids"].numpy() == 0
    ids = found["primitive_ids"].numpy()[on_ball]
    assert np.abs(found["primitive_normals"].numpy()[on_ball] - expected[ids]).max() < 1e-6


@pytest.mark.parametrize("scale", [1e-200, 1e-100, 1e-30, 1e30, 1e100, 1e200])
def test_normals_have_length_one_at_every_scale(scale):
    vertices, faces = sphere(12)
    scene = gridel.Scene.from_arrays(vertices * scale, faces)
    rays = np.array([[0.1 * scale, 0.2 * scale, 3 * scale, 0, 0, -scale]])
    normal = gridel.Scene.from_arrays(vertices, faces).cast(rays / scale).normal
    assert np.allclose(scene.cast(rays).normal, normal, atol=1e-6) and np.allclose(np.linalg.norm(normal), 1)


def test_scenes_far_away_are_rejected_with_the_distance():
    vertices, faces = sphere(12)
    with pytest.raises(ValueError, match=r"must lie within 1\.1e9 of the origin on each axis.*nearer") as caught:
        gridel.Scene.from_arrays(vertices + 1e10, faces)
    assert "detail" not in str(caught.value)
    assert gridel.Scene.from_arrays(vertices + 1e9, faces).primitives == len(faces)


@FORMATS
@pytest.mark.parametrize("name", ["stress-sphere", "stress-torus", "stress-plane", "stress-triangle", "turntable"])
def test_limits_of_every_shape_leave_out_what_lies_beyond(name, format):
    scene = gridel.Scene.load(FIXTURES / f"{name}.toml")
    # Planes have no bounds.
    low, high = np.minimum(scene.bounds[0], -1), np.maximum(scene.bounds[1], 1)
    rng = np.random.default_rng(15)
    rays = np.hstack([rng.uniform(low, high, (400, 3)), rng.normal(size=(400, 3))])
    size = (high - low).max()
    tmin = rng.uniform(0, 0.3 * size, 400)
    near = limited(rays, tmin, tmin + rng.uniform(0, 0.5 * size, 400))
    every, found = scene.all(rays, format=format), scene.all(near, format=format)
    kept = (every.t >= near[every.ray, 3]) & (every.t <= near[every.ray, 7])
    assert kept.any() and not kept.all()
    for whole, part in zip(every, found):
        assert np.allclose(whole[kept], part, rtol=1e-5, atol=1e-5 * size, equal_nan=True)
    counts = np.bincount(found.ray, minlength=400)
    assert np.array_equal(scene.count(near, format=format), counts)
    # The closed rule has hits at edges that the other one has not.
    assert (scene.any(near, format=format) == (counts > 0)).mean() > 0.99
    first = scene.cast(near, format=format)
    assert np.array_equal(np.isfinite(first.t), scene.any(near, format=format))


@pytest.mark.parametrize("format", ["fixed", "f32", "f64"])
def test_t_is_never_outside_of_the_interval(format):
    corners = np.array([[-1, -1, 1 / 3], [1, -1, 1 / 3], [0, 1, 1 / 3], [0, 0, -1]])
    scene = gridel.Scene.from_arrays(corners, [[0, 1, 2], [0, 1, 3]])
    heights = 1 / 3 + np.linspace(-3e-7, 3e-7, 301)
    rays = np.zeros((301, 8))
    rays[:, :3] = np.column_stack([np.full((301, 2), 0.1), heights])
    rays[:, 6], rays[:, 7] = -1, np.inf
    for least in (0, 1e-9):
        rays[:, 3] = least
        assert (scene.cast(rays, format=format).t >= least).all()
        assert (scene.all(rays, format=format).t >= least).all()
    rays[:, 2] += 1
    rays[:, 3], rays[:, 7] = 0, 1
    t = scene.cast(rays, format=format).t
    assert (t[np.isfinite(t)] <= 1).all() and np.isfinite(t).any()
    # The t of shapes that are not triangles, too.
    assert (scene.all(rays, format=format).t <= 1).all()


@pytest.mark.parametrize("format", ["fixed", "f32", "f64"])
def test_hits_closer_than_the_lattice_come_in_the_order_of_t(format):
    square = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0.0]])
    vertices = np.concatenate([square + [0, 0, 1e-9 * k] for k in range(3)])
    faces = np.concatenate([np.array([[0, 1, 2], [0, 2, 3]]) + 4 * k for k in range(3)])
    scene = gridel.Scene.from_arrays(vertices, faces)
    rays = [[0.1, 0.2, 1, 0, 0, -1], [0.1, 0.2, -1, 0, 0, 1]]
    every = scene.all(rays, format=format)
    assert every.ray.tolist() == [0] * 3 + [1] * 3
    assert (np.diff(every.t[:3]) >= 0).all() and (np.diff(every.t[3:]) >= 0).all()


def test_intervals_limit_hits(cube):
    rays = [[0.3, 0.6, -2, 0, 0, 0, 1, 1.9], [0.3, 0.6, -2, 2.5, 0, 0, 1, np.inf]]
    hits = cube.cast(rays)
    assert hits.t.tolist() == [np.inf, 3.0]
    assert cube.any(rays).tolist() == [False, True]
    assert cube.count(rays).tolist() == [0, 1]


SOLIDS = """
[[object]]
kind = "sphere"
center = [0, 0, 0]
radius = 1
[[object]]
kind = "cone"
base = [3, 0, 0]
apex = [3, 0, 1]
radius = 1
[[object]]
kind = "box"
min = [5, -1, -1]
max = [6, 1, 1]
[[object]]
kind = "torus"
center = [-4, 0, 0]
axis = [0, 0, 1]
major_radius = 1
minor_radius = 0.3
[[part]]
name = "ball"
object = [{ kind = "sphere", center = [0, 0, 0], radius = 1 }]
[[instance]]
part = "ball"
translate = [0, 4, 0]
"""


@pytest.mark.parametrize("of_blob", [False, True])
@FORMATS
def test_solids_and_instances_are_hit_from_near_at_the_t_that_is_returned(tmp_path, of_blob, format):
    (tmp_path / "solids.toml").write_text(SOLIDS)
    scene = gridel.Scene.load(tmp_path / "solids.toml")
    displacement = scene.displacement
    if of_blob:
        scene = gridel.Scene.from_blob(scene.to_blob())
    rng = np.random.default_rng(3)
    origins = rng.uniform([-6, -1.2, -1.2], [7, 5.2, 1.2], size=(40000, 3))
    directions = rng.normal(size=origins.shape)
    hits = scene.cast(np.hstack([origins, directions]))
    hit = np.isfinite(hits.t)
    origins, directions, t = origins[hit], directions[hit], hits.t[hit]
    lengths = np.linalg.norm(directions, axis=1)
    for distance in (1e-5, 1e-4, 1e-3):
        starts = origins + directions * (t - distance / lengths)[:, None]
        near = scene.cast(np.hstack([starts, directions]), format=format)
        # Neither within the displacement of the origin, nor at less than a degree.
        sines = abs((near.normal * directions).sum(axis=1)) / lengths
        far_enough = 3 * displacement < np.where(np.isfinite(near.t), near.t, 0) * lengths * sines
        found = far_enough & (sines > 0.0175)
        starts_found, ways, at = starts[found], directions[found], near.t[found]
        assert len(at) > 1000
        for least in (at, 0.99 * at):
            exactly = np.column_stack([starts_found, least, ways, at])
            assert (scene.cast(exactly, format=format).t == at).all()
            assert scene.any(exactly, format=format).all()


@FORMATS
def test_limits_are_compared_with_t_before_all_raises_it(format):
    # Boxes around each other, nearer than the lattice moves them.
    sizes = np.linspace(1, 1 + 1e-6, 12)
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    sides = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6]]
    sides = np.array(sides + [[0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]])
    vertices = np.vstack([corners * size for size in sizes])
    faces = np.vstack([sides + 8 * k for k in range(len(sizes))])
    scene = gridel.Scene.from_arrays(vertices, faces)
    origin = np.array([3.0, 0.1, 0.2])
    fewer = 0
    for direction in np.random.default_rng(5).uniform(-0.4, 0.4, (40, 3)) - origin:
        every = scene.all([[*origin, *direction]], format=format)
        at = vertices[faces[every.primitive]]
        normal = np.cross(at[:, 1] - at[:, 0], at[:, 2] - at[:, 0])
        own = (normal * (at[:, 0] - origin)).sum(axis=1) / (normal @ direction)
        raised = np.maximum.accumulate(own)
        assert np.allclose(every.t, raised, rtol=1e-15) and (np.diff(every.t) >= 0).all()
        # Away from the last digits of t.
        for limit in every.t[:12:5] + 3e-9:
            for low, high in ((limit, np.inf), (0, limit), (limit - 2e-8, limit)):
                ray = [[*origin, low, *direction, high]]
                count = scene.count(ray, format=format)[0]
                assert count == len(scene.all(ray, format=format).t) == ((own >= low) & (own <= high)).sum()
                fewer += count < ((every.t >= low) & (every.t <= high)).sum()
    assert fewer > 0


def test_edges_have_the_triangle_with_the_least_t_of_the_format():
    # A double cone with coordinates of integers, and a ray exactly through an edge of it, between faces 22 and 23.
    angles = np.linspace(0, 2 * np.pi, 64, endpoint=False)
    rim = np.round(np.column_stack([1000 * np.cos(angles), 1000 * np.sin(angles), 0 * angles]))
    vertices = np.vstack([[[0, 0, 300]], rim, [[0, 0, -300]]])
    around, next_one = 1 + np.arange(64), 1 + (np.arange(64) + 1) % 64
    faces = np.vstack([np.column_stack([0 * around, around, next_one]), np.column_stack([0 * around + 65, next_one, around])])
    scene = gridel.Scene.from_arrays(vertices, faces)
    assert scene.displacement == 0
    ray = [[-652, 737, 9, 2, 4, -1]]
    for format in ("f32", "f64", "fixed"):
        hits = scene.cast(ray, format=format)
        assert hits.t.tolist() == [9] and hits.primitive[0] in (22, 23)
        # The ray touches a silhouette.
        assert scene.count(ray, format=format)[0] in (0, 2)
    # In integers the two are equal.
    assert scene.cast(ray, format="fixed").primitive.tolist() == [22]
